//! How steep the triangles are, all weighted equally. Steepness g is the length of the gradient, slope its
//! arc tangent in degrees.
//!
//! - `slope_mean_deg`, `slope_p99_deg`: mean and 99th percentile of the slope.
//! - `frac_lt5`, `frac_gt30`, `frac_gt45`: share flatter than 5 degrees, steeper than 30 and 45.
//! - `grad_cv`: standard deviation of g over its mean. An isotropic Gaussian field has
//!   sqrt(4/pi - 1) = 0.523 (g is Rayleigh distributed); level benches between steep flanks raise it.
//! - `grad_ratio_xy`: root mean square of the east-west gradient over that of the north-south one.

use super::Values;
use super::grid::{Grid, SIDE};
use super::order::{mean_and_deviation, quantile, sum};
use super::triangles::Row;

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    let mut steepness = Vec::with_capacity(2 * SIDE * SIDE);
    let (mut along_x, mut along_y) = (0.0, 0.0);
    let mut row = Row::ZERO;
    for y in 0..SIDE {
        row.fill(grid, y);
        for triangles in [&row.west, &row.east] {
            steepness.extend((0..SIDE).map(|k| {
                let (x, y) = (triangles.x[k], triangles.y[k]);
                (x * x + y * y).sqrt()
            }));
            along_x += sum(&triangles.x, |g| g * g);
            along_y += sum(&triangles.y, |g| g * g);
        }
    }
    let count = steepness.len() as f64;
    let (mean, deviation) = mean_and_deviation(&steepness);
    values.push("grad_cv", deviation / mean);
    let [five, thirty] = [5.0_f64, 30.0].map(|degrees| libm::tan(degrees.to_radians()));
    // One is exact, and quantised heights do come to slopes of exactly 45 degrees.
    let (mut flat, mut steep, mut very_steep) = (0_u32, 0_u32, 0_u32);
    for &g in &steepness {
        flat += u32::from(g < five);
        steep += u32::from(g > thirty);
        very_steep += u32::from(g > 1.0);
    }
    values.push("frac_lt5", f64::from(flat) / count);
    values.push("frac_gt30", f64::from(steep) / count);
    values.push("frac_gt45", f64::from(very_steep) / count);
    values.push("slope_mean_deg", (sum(&steepness, libm::atan) / count).to_degrees());
    values.push("slope_p99_deg", quantile(&steepness, 0.99, |g| libm::atan(g).to_degrees()));
    values.push("grad_ratio_xy", (along_x / along_y).sqrt());
}
