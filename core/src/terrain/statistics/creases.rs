//! How sharply neighbouring triangles meet.
//!
//! - `crease_p50_deg`, `crease_p99_deg`: percentiles of the angle between the unit normals of the two
//!   triangles that share an edge, over all 196,608 edges: diagonals, east sides, north sides.

use super::Values;
use super::grid::{Grid, SIDE};
use super::order::quantiles;
use super::triangles::{Gradients, Row};

/// Unit normals of one triangle of each square in a row.
#[derive(Clone, Copy)]
struct Normals {
    x: [f64; SIDE],
    y: [f64; SIDE],
    z: [f64; SIDE],
}

impl Normals {
    const ZERO: Self = Self { x: [0.0; SIDE], y: [0.0; SIDE], z: [0.0; SIDE] };

    fn fill(&mut self, gradients: &Gradients) {
        for k in 0..SIDE {
            let (x, y) = (gradients.x[k], gradients.y[k]);
            let z = 1.0 / (1.0 + x * x + y * y).sqrt();
            (self.x[k], self.y[k], self.z[k]) = (-x * z, -y * z, z);
        }
    }

    /// One less the cosine of the angle between the normal in a column and that of others in another.
    #[inline(always)]
    fn versine(&self, column: usize, others: &Self, other: usize) -> f64 {
        1.0 - (self.x[column] * others.x[other]
            + self.y[column] * others.y[other]
            + self.z[column] * others.z[other])
    }
}

/// The normals of two rows of squares: the even row first.
struct Rows {
    west: [Normals; 2],
    east: [Normals; 2],
}

impl Rows {
    fn fill(&mut self, grid: &Grid, y: usize) {
        let mut row = Row::ZERO;
        row.fill(grid, y);
        self.west[y % 2].fill(&row.west);
        self.east[y % 2].fill(&row.east);
    }
}

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    let mut rows = Box::new(Rows { west: [Normals::ZERO; 2], east: [Normals::ZERO; 2] });
    rows.fill(grid, 0);
    // It grows with the angle, so quantiles of it need four arc cosines instead of 196,608.
    let mut versines = vec![0.0; 3 * SIDE * SIDE];
    for (y, versines) in versines.chunks_exact_mut(3 * SIDE).enumerate() {
        rows.fill(grid, y + 1);
        let (west, east) = (&rows.west[y % 2], &rows.east[y % 2]);
        let (west_above, east_above) = (&rows.west[(y + 1) % 2], &rows.east[(y + 1) % 2]);
        let (diagonals, sides) = versines.split_at_mut(SIDE);
        let (easts, norths) = sides.split_at_mut(SIDE);
        for x in 0..SIDE {
            diagonals[x] = west.versine(x, east, x);
            easts[x] = east.versine(x, west, (x + 1) % SIDE);
            // The north side of an even square and the south side of the odd one above it both belong to
            // their west triangles; with the parities swapped to their east ones.
            let (by_west, by_east) = (west.versine(x, west_above, x), east.versine(x, east_above, x));
            norths[x] = if (x ^ y) & 1 == 0 { by_west } else { by_east };
        }
    }
    let angle = |versine: f64| libm::acos((1.0 - versine).clamp(-1.0, 1.0)).to_degrees();
    let [median, p99] = quantiles(&versines, [0.50, 0.99], angle);
    values.push("crease_p50_deg", median);
    values.push("crease_p99_deg", p99);
}
