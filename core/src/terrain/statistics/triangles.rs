//! Gradients of the 131,072 triangles, a row of squares at a time.
//!
//! Every square is cut in two; an even one (column and row of equal parity) from south-west to
//! north-east, an odd one from south-east to north-west. In both kinds one triangle holds the west side and
//! the other the east side, so triangles are stored as `west` and `east`. Of these the west one holds the north side
//! of an even square and the south side of an odd one.

use super::grid::{Grid, SIDE, SQUARE};

/// The gradients of one triangle of each square in a row.
pub(super) struct Gradients {
    pub x: [f64; SIDE],
    pub y: [f64; SIDE],
}

/// Both triangles of each square in a row.
pub(super) struct Row {
    pub west: Gradients,
    pub east: Gradients,
}

impl Row {
    /// The triangles of row `y` of squares, modulo 256.
    pub fn of(grid: &Grid, y: usize) -> Self {
        let (south, north) = (grid.row(y), grid.row(y + 1));
        let next = |x: usize| (x + 1) % SIDE;
        let along = |row: &[f64], x: usize| (row[next(x)] - row[x]) / SQUARE;
        let even = |x: usize| (x ^ y) & 1 == 0;
        let up = |x: usize| (north[x] - south[x]) / SQUARE;
        Self {
            west: Gradients {
                x: std::array::from_fn(|x| if even(x) { along(north, x) } else { along(south, x) }),
                y: std::array::from_fn(up),
            },
            east: Gradients {
                x: std::array::from_fn(|x| if even(x) { along(south, x) } else { along(north, x) }),
                y: std::array::from_fn(|x| up(next(x))),
            },
        }
    }
}
