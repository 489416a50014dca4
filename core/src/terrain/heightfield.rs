//! One terrain as its user gave it.

use super::kind::SurfaceKind;
use crate::error::{InputError, refuse};

/// What lies beyond a map's rim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The map again, for ever, with a period of one square less than it has vertices.
    Tile,
    /// A vertex outside has the height of the nearest rim vertex.
    Clamp,
    /// Nothing: free fall, height NaN.
    Void,
}

impl Edge {
    /// Its public name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tile => "tile",
            Self::Clamp => "clamp",
            Self::Void => "void",
        }
    }
}

impl core::str::FromStr for Edge {
    type Err = InputError;
    fn from_str(name: &str) -> Result<Self, InputError> {
        match name {
            "tile" => Ok(Self::Tile),
            "clamp" => Ok(Self::Clamp),
            "void" => Ok(Self::Void),
            _ => Err(InputError(format!("edge: expected \"tile\", \"clamp\" or \"void\", got {name:?}"))),
        }
    }
}

/// Largest magnitude of a height, m.
pub const MAX_HEIGHT: f64 = 10_000.0;
/// Smallest and largest side of a square, m.
pub const SQUARE_RANGE: (f64, f64) = (0.01, 10_000.0);
/// Most vertices of one map.
pub const MAX_VERTICES: usize = 1 << 28;

/// The shape, squares, place and edge of a heightfield.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Vertices north.
    pub rows: usize,
    /// Vertices east.
    pub cols: usize,
    /// Side of a square, m.
    pub square_size: f64,
    /// Place of the first vertex, m.
    pub origin: [f64; 2],
    /// What lies beyond the rim.
    pub edge: Edge,
}

impl Grid {
    /// Vertices in all.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.rows * self.cols
    }

    /// Column and row of the vertex nearest the centre: local coordinates count from it.
    #[must_use]
    pub fn centre_vertex(&self) -> [usize; 2] {
        [(self.cols - 1) / 2, (self.rows - 1) / 2]
    }

    /// Sides of the map along x and y, m: the period of a tiling one.
    #[must_use]
    pub fn size(&self) -> [f64; 2] {
        [(self.cols - 1) as f64 * self.square_size, (self.rows - 1) as f64 * self.square_size]
    }
}

/// A heightfield: vertex heights, `heights[row y * cols + column x]`, metres.
///
/// Between them lie triangles, unless [`Heightfield::with_surface`] says otherwise: square (i, j), i east
/// and j north, is cut from its low-x low-y corner to the opposite one where i + j is even, and across where
/// it is odd (docs/physics.md, section 8).
#[derive(Clone, Debug, PartialEq)]
pub struct Heightfield {
    heights: Vec<f64>,
    grid: Grid,
    surface: SurfaceKind,
}

impl Heightfield {
    /// Checks and takes a heightfield. `origin` is the place of `heights[0]`, in metres.
    ///
    /// # Errors
    /// Fewer than 2 x 2 heights, a count that is not `rows * cols`, a height that is not finite or
    /// beyond 10 km, a square size outside 0.01 to 10,000 m, an origin beyond 1e9 m, or, on
    /// [`Edge::Tile`], a last row or column that does not repeat the first.
    pub fn new(
        heights: Vec<f64>,
        rows: usize,
        cols: usize,
        square_size: f64,
        origin: [f64; 2],
        edge: Edge,
    ) -> Result<Self, InputError> {
        if rows < 2 || cols < 2 {
            refuse!("heights: expected at least 2 x 2, got {rows} x {cols}");
        }
        if rows.checked_mul(cols).is_none_or(|n| n > MAX_VERTICES) {
            refuse!("heights: expected at most {MAX_VERTICES} vertices, got {rows} x {cols}");
        }
        if heights.len() != rows * cols {
            refuse!("heights: expected {rows} x {cols} values, got {}", heights.len());
        }
        if let Some(at) = heights.iter().position(|h| h.is_nan() || h.abs() > MAX_HEIGHT) {
            refuse!(
                "heights: expected finite values within +-{MAX_HEIGHT} m, got {} at row {}, column {}",
                heights[at],
                at / cols,
                at % cols
            );
        }
        if !(SQUARE_RANGE.0..=SQUARE_RANGE.1).contains(&square_size) {
            refuse!("square_size: expected {} to {} m, got {square_size}", SQUARE_RANGE.0, SQUARE_RANGE.1);
        }
        if origin.iter().any(|x| x.is_nan() || x.abs() > 1e9) {
            refuse!("origin: expected two finite numbers within +-1e9 m, got {origin:?}");
        }
        if edge == Edge::Tile {
            let row = (0..cols).find(|&i| heights[i] != heights[(rows - 1) * cols + i]);
            let col = (0..rows).find(|&j| heights[j * cols] != heights[j * cols + cols - 1]);
            if let Some(i) = row {
                refuse!(
                    "heights: on edge \"tile\" expected the last row to repeat the first, got another height at column {i}"
                );
            }
            if let Some(j) = col {
                refuse!(
                    "heights: on edge \"tile\" expected the last column to repeat the first, got another height at row {j}"
                );
            }
        }
        let grid = Grid { rows, cols, square_size, origin, edge };
        Ok(Self { heights, grid, surface: SurfaceKind::Triangles })
    }

    /// The same heights with another surface between them.
    #[must_use]
    pub fn with_surface(mut self, surface: SurfaceKind) -> Self {
        self.surface = surface;
        self
    }

    /// Vertex heights, row by row, m.
    #[must_use]
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// Its shape, squares, place and edge.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Vertices north.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.grid.rows
    }

    /// Vertices east.
    #[must_use]
    pub fn cols(&self) -> usize {
        self.grid.cols
    }

    /// Side of a square, m.
    #[must_use]
    pub fn square_size(&self) -> f64 {
        self.grid.square_size
    }

    /// Place of the first vertex, m.
    #[must_use]
    pub fn origin(&self) -> [f64; 2] {
        self.grid.origin
    }

    /// What lies beyond the rim.
    #[must_use]
    pub fn edge(&self) -> Edge {
        self.grid.edge
    }

    /// What lies between its vertices.
    #[must_use]
    pub fn surface(&self) -> SurfaceKind {
        self.surface
    }

    /// XXH3-128 of shape, grid, heights and surface, as 32 hexadecimal digits.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut bytes = Vec::with_capacity(self.heights.len() * 8 + 64);
        bytes.extend((self.grid.rows as u64).to_le_bytes());
        bytes.extend((self.grid.cols as u64).to_le_bytes());
        for x in [self.grid.square_size, self.grid.origin[0], self.grid.origin[1]] {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend(self.grid.edge.name().as_bytes());
        self.heights.iter().for_each(|h| bytes.extend(h.to_le_bytes()));
        // Triangles are not named: their digests are older than any other surface.
        if self.surface != SurfaceKind::Triangles {
            bytes.extend(self.surface.name().as_bytes());
        }
        format!("{:032x}", xxhash_rust::xxh3::xxh3_128(&bytes))
    }
}
