//! One tile of heights as the statistics read it: 256 x 256 samples, 8 m apart, repeated for ever.

use std::fmt;

/// Squares along a side of the tile.
pub const SIDE: usize = 256;
/// Side of a square, metres.
pub const SQUARE: f64 = 8.0;
/// Side of the tile, metres.
pub const TILE: f64 = 2048.0;
/// World x and y of the sample in row 0, column 0, metres.
pub const ORIGIN: f64 = -1024.0;

const MASK: usize = SIDE - 1;

/// Why heights cannot be measured.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The slice is neither 256 x 256 nor 257 x 257 heights long.
    Length {
        /// The length that came.
        found: usize,
    },
    /// A height is infinite or not a number.
    NotFinite {
        /// Row of the first such height.
        row: usize,
        /// Its column.
        column: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { found } => write!(
                f,
                "heights: expected 256 x 256 = 65536 or 257 x 257 = 66049 values (rows of y, columns of x), got {found}"
            ),
            Self::NotFinite { row, column } => {
                write!(
                    f,
                    "heights: expected finite metres, got a value that is not finite at row {row}, column {column}"
                )
            }
        }
    }
}

impl std::error::Error for Error {}

/// A periodic tile of 256 x 256 heights in metres, row-major: row `y` (north), column `x` (east).
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    heights: Vec<f64>,
}

impl Grid {
    /// Takes 256 x 256 heights as they are.
    ///
    /// # Panics
    /// If there are not 65,536 of them.
    pub(crate) fn from_square(heights: Vec<f64>) -> Self {
        assert_eq!(heights.len(), SIDE * SIDE, "a tile has 256 x 256 heights");
        Self { heights }
    }

    /// Reads 256 x 256 heights, or 257 x 257 of which the last row and column are left out, and says
    /// whether those repeat the first ones bit for bit (256 x 256 heights always do).
    ///
    /// # Errors
    /// [`Error::Length`] and [`Error::NotFinite`].
    pub fn read(heights: &[f64]) -> Result<(Self, bool), Error> {
        let stride = match heights.len() {
            65_536 => SIDE,
            66_049 => SIDE + 1,
            found => return Err(Error::Length { found }),
        };
        if let Some(at) = heights.iter().position(|height| !height.is_finite()) {
            return Err(Error::NotFinite { row: at / stride, column: at % stride });
        }
        let same = |a: usize, b: usize| heights[a].to_bits() == heights[b].to_bits();
        let seamless = stride == SIDE
            || (0..stride).all(|k| same(k, SIDE * stride + k) && same(k * stride, k * stride + SIDE));
        let rows = heights.chunks_exact(stride).take(SIDE);
        let heights = rows.flat_map(|row| row[..SIDE].iter().copied()).collect();
        Ok((Self { heights }, seamless))
    }

    /// The 65,536 heights, row by row.
    #[must_use]
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    pub(crate) fn heights_mut(&mut self) -> &mut [f64] {
        &mut self.heights
    }

    /// Row `y` modulo 256.
    #[must_use]
    pub fn row(&self, y: usize) -> &[f64] {
        let start = (y & MASK) * SIDE;
        &self.heights[start..start + SIDE]
    }

    /// The height at column `x`, row `y`, both modulo 256.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> f64 {
        self.heights[index(x, y)]
    }

    /// Ground height at a world position: the plane of the triangle it falls in. Squares whose column
    /// and row differ in parity are cut from south-east to north-west, the others from south-west to
    /// north-east.
    #[must_use]
    pub fn ground(&self, position: [f64; 2]) -> f64 {
        let (x, u) = split(position[0]);
        let (y, v) = split(position[1]);
        let south_west = self.at(x, y);
        let south_east = self.at(x + 1, y);
        let north_west = self.at(x, y + 1);
        let north_east = self.at(x + 1, y + 1);
        let (dx, dy) = if (x ^ y) & 1 == 0 {
            if v > u {
                (north_east - north_west, north_west - south_west)
            } else {
                (south_east - south_west, north_east - south_east)
            }
        } else if u + v <= 1.0 {
            (south_east - south_west, north_west - south_west)
        } else {
            let north_east_down = (north_east - north_west, north_east - south_east);
            return north_east - north_east_down.0 * (1.0 - u) - north_east_down.1 * (1.0 - v);
        };
        south_west + dx * u + dy * v
    }

    /// The same heights as 257 x 257 values, the first row and column repeated at the end.
    #[must_use]
    pub fn closed(&self) -> Vec<f64> {
        let mut heights = Vec::with_capacity((SIDE + 1) * (SIDE + 1));
        for y in 0..=SIDE {
            heights.extend_from_slice(self.row(y));
            heights.push(self.row(y)[0]);
        }
        heights
    }
}

/// Where column `x`, row `y` (modulo 256) is stored.
pub(crate) fn index(x: usize, y: usize) -> usize {
    (y & MASK) * SIDE + (x & MASK)
}

/// The square a world coordinate falls in, and how far into it, in 0..1.
fn split(coordinate: f64) -> (usize, f64) {
    let squares = (coordinate - ORIGIN) / SQUARE;
    let whole = squares.floor();
    // A tile is a power of two squares, so a negative whole number wraps rightly in two's complement.
    (whole as i64 as usize & MASK, squares - whole)
}
