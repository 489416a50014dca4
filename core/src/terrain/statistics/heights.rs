//! How the heights spread.
//!
//! - `sigma_m`: population standard deviation of the heights.
//! - `spread_p1_p99_m`: 99th minus 1st percentile; percentiles are linear between order statistics.
//! - `range_m`: highest minus lowest.

use super::Values;
use super::grid::Grid;
use super::order::{extremes, mean_and_deviation, quantiles};

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    values.push("sigma_m", mean_and_deviation(grid.heights()).1);
    let heights = grid.heights();
    let [low, high] = quantiles(heights, [0.01, 0.99], |height| height);
    values.push("spread_p1_p99_m", high - low);
    let (lowest, highest) = extremes(heights);
    values.push("range_m", highest - lowest);
}
