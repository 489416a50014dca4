//! How far water runs.
//!
//! - `descent_len_mean_m`: from every sample in an even row and even column, follow the steepest strictly
//!   descending step among the eight neighbours (drop over distance, 8 or 11.31 m; of equal ones the first from
//!   south-west to north-east, row by row) until there is none; mean length on the map.

use super::Values;
use super::grid::{Grid, SIDE, SQUARE, index};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

/// No way down.
const PIT: u8 = 8;
/// Column and row steps to the eight neighbours, modulo 256.
const NEIGHBOURS: [(usize, usize); 8] =
    [(255, 255), (0, 255), (1, 255), (255, 0), (1, 0), (255, 1), (0, 1), (1, 1)];

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    let steps = steps(grid);
    let (mut straight, mut diagonal) = (0_u64, 0_u64);
    for y in (0..SIDE).step_by(2) {
        for x in (0..SIDE).step_by(2) {
            let mut at = index(x, y);
            while steps[at] != PIT {
                let (dx, dy) = NEIGHBOURS[usize::from(steps[at])];
                if dx == 0 || dy == 0 {
                    straight += 1
                } else {
                    diagonal += 1
                }
                at = index(at % SIDE + dx, at / SIDE + dy);
            }
        }
    }
    let length = SQUARE * (straight as f64 + SQRT_2 * diagonal as f64);
    values.push("descent_len_mean_m", length / (SIDE * SIDE / 4) as f64);
}

/// The steepest way down from every sample: an index into [`NEIGHBOURS`] or [`PIT`].
fn steps(grid: &Grid) -> Vec<u8> {
    let mut steps = Vec::with_capacity(SIDE * SIDE);
    for y in 0..SIDE {
        let rows = [grid.row(y + SIDE - 1), grid.row(y), grid.row(y + 1)];
        for x in 0..SIDE {
            let (west, east) = ((x + SIDE - 1) % SIDE, (x + 1) % SIDE);
            let here = rows[1][x];
            let neighbours = [
                (here - rows[0][west]) * FRAC_1_SQRT_2,
                here - rows[0][x],
                (here - rows[0][east]) * FRAC_1_SQRT_2,
                here - rows[1][west],
                here - rows[1][east],
                (here - rows[2][west]) * FRAC_1_SQRT_2,
                here - rows[2][x],
                (here - rows[2][east]) * FRAC_1_SQRT_2,
            ];
            let (mut best, mut steepest) = (PIT, 0.0);
            for (k, steepness) in (0_u8..).zip(neighbours) {
                best = if steepness > steepest { k } else { best };
                steepest = if steepness > steepest { steepness } else { steepest };
            }
            steps.push(best);
        }
    }
    steps
}
