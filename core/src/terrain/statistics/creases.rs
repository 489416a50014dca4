//! How sharply neighbouring triangles meet.
//!
//! - `crease_p50_deg`, `crease_p99_deg`: percentiles of the angle between the unit normals of the two
//!   triangles that share an edge, over all 196,608 edges: diagonals, east sides, north sides.

use super::Values;
use super::grid::{Grid, SIDE};
use super::order::quantiles;
use super::triangles::{Gradients, Row};

/// Unit normals of one triangle of each square in a row.
struct Normals {
    x: [f64; SIDE],
    y: [f64; SIDE],
    z: [f64; SIDE],
}

impl Normals {
    fn of(gradients: &Gradients) -> Self {
        let (x, y) = (&gradients.x, &gradients.y);
        let z: [f64; SIDE] = std::array::from_fn(|k| 1.0 / (1.0 + x[k] * x[k] + y[k] * y[k]).sqrt());
        Self { x: std::array::from_fn(|k| -x[k] * z[k]), y: std::array::from_fn(|k| -y[k] * z[k]), z }
    }

    /// One less the cosine of the angle to others in the same columns, or those `ahead` to the east.
    fn versines(&self, others: &Self, ahead: usize) -> [f64; SIDE] {
        std::array::from_fn(|k| {
            let other = (k + ahead) % SIDE;
            1.0 - (self.x[k] * others.x[other] + self.y[k] * others.y[other] + self.z[k] * others.z[other])
        })
    }
}

fn normals(grid: &Grid, y: usize) -> [Normals; 2] {
    let row = Row::of(grid, y);
    [Normals::of(&row.west), Normals::of(&row.east)]
}

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    // It grows with the angle, so quantiles of it need four arc cosines instead of 196,608.
    let mut versines = Vec::with_capacity(3 * SIDE * SIDE);
    let mut here = normals(grid, 0);
    for y in 0..SIDE {
        let above = normals(grid, y + 1);
        let [west, east] = &here;
        versines.extend_from_slice(&west.versines(east, 0));
        versines.extend_from_slice(&east.versines(west, 1));
        // The north side of an even square and the south side of the odd one above it both belong to
        // their west triangles; with the parities swapped to their east ones.
        let (both_west, both_east) = (west.versines(&above[0], 0), east.versines(&above[1], 0));
        versines.extend((0..SIDE).map(|x| if (x ^ y) & 1 == 0 { both_west[x] } else { both_east[x] }));
        here = above;
    }
    let angle = |versine: f64| libm::acos((1.0 - versine).clamp(-1.0, 1.0)).to_degrees();
    let [median, p99] = quantiles(&versines, [0.50, 0.99], angle);
    values.push("crease_p50_deg", median);
    values.push("crease_p99_deg", p99);
}
