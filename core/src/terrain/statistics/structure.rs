//! How much heights differ over a distance.
//!
//! - `S8_m` ... `S128_m`: structure function: root of the mean squared height difference between samples
//!   r metres apart, east-west and north-south pairs weighted equally.

use super::Values;
use super::grid::{Grid, SIDE};
use super::order::sum;

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    for (name, lag) in [("S8_m", 1), ("S16_m", 2), ("S32_m", 4), ("S64_m", 8), ("S128_m", 16)] {
        values.push(name, structure(grid, lag));
    }
}

fn structure(grid: &Grid, lag: usize) -> f64 {
    let mut total = 0.0;
    let mut squares = [0.0; SIDE];
    for y in 0..SIDE {
        let (row, above) = (grid.row(y), grid.row(y + lag));
        for x in 0..SIDE {
            let east = row[(x + lag) % SIDE] - row[x];
            let north = above[x] - row[x];
            squares[x] = east * east + north * north;
        }
        total += sum(&squares, |square| square);
    }
    (total / (2 * SIDE * SIDE) as f64).sqrt()
}
