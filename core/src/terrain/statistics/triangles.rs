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
    pub const ZERO: Self = Self { west: Gradients::ZERO, east: Gradients::ZERO };

    /// Becomes the triangles of row `y` of squares, modulo 256. In place: returned by value, the rows would be
    /// copied, which takes longer than computing them.
    pub fn fill(&mut self, grid: &Grid, y: usize) {
        let (south, north) = (grid.row(y), grid.row(y + 1));
        for x in 0..SIDE {
            let next = (x + 1) % SIDE;
            let along_south = (south[next] - south[x]) / SQUARE;
            let along_north = (north[next] - north[x]) / SQUARE;
            let even = (x ^ y) & 1 == 0;
            self.west.x[x] = if even { along_north } else { along_south };
            self.east.x[x] = if even { along_south } else { along_north };
            self.west.y[x] = (north[x] - south[x]) / SQUARE;
            self.east.y[x] = (north[next] - south[next]) / SQUARE;
        }
    }
}

impl Gradients {
    const ZERO: Self = Self { x: [0.0; SIDE], y: [0.0; SIDE] };
}
