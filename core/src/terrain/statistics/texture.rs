//! The fine texture that no power spectrum shows: level benches, steep flanks, tiny pits.
//!
//! - `lap_exkurt`: excess kurtosis, m4 / m2^2 - 3, of the Laplacian (E + W + N + S - 4 H) / 64 m^2.
//! - `pits_per_km2`: samples with no strictly lower one among their eight neighbours (every sample of a level
//!   floor counts), over the tile's 4.194304 km^2.
//! - `flat_edge_x`: share of the 65,536 pairs of east-west neighbours that differ by less than 1 mm.

use super::Values;
use super::grid::{Grid, SIDE, TILE};
use super::order::sum;

pub(super) const TILE_KM2: f64 = TILE * TILE * 1e-6;

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    let (mut pits, mut flat) = (0_usize, 0_usize);
    let mut laplacian = vec![0.0; SIDE * SIDE];
    // Lowest of three in a row, for the row below, this one and the one above.
    let mut lows = [[0.0; SIDE]; 3];
    lowest_of_three(grid.row(SIDE - 1), &mut lows[0]);
    lowest_of_three(grid.row(0), &mut lows[1]);
    for y in 0..SIDE {
        let (south, row, north) = (grid.row(y + SIDE - 1), grid.row(y), grid.row(y + 1));
        lowest_of_three(north, &mut lows[2]);
        for x in 0..SIDE {
            let (east, west) = (row[(x + 1) % SIDE], row[(x + SIDE - 1) % SIDE]);
            laplacian[y * SIDE + x] = (east + west + north[x] + south[x] - 4.0 * row[x]) / 64.0;
            flat += usize::from((east - row[x]).abs() < 0.001);
            let none_lower = lows[0][x] >= row[x] && lows[1][x] >= row[x] && lows[2][x] >= row[x];
            pits += usize::from(none_lower);
        }
        lows.rotate_left(1);
    }
    values.push("lap_exkurt", excess_kurtosis(&laplacian));
    values.push("pits_per_km2", pits as f64 / TILE_KM2);
    values.push("flat_edge_x", flat as f64 / (SIDE * SIDE) as f64);
}

fn lowest_of_three(row: &[f64], lows: &mut [f64; SIDE]) {
    for x in 0..SIDE {
        lows[x] = row[x].min(row[(x + 1) % SIDE]).min(row[(x + SIDE - 1) % SIDE]);
    }
}

fn excess_kurtosis(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = sum(values, |value| value) / count;
    let m2 = sum(values, |value| (value - mean) * (value - mean)) / count;
    let m4 = sum(values, |value| {
        let square = (value - mean) * (value - mean);
        square * square
    }) / count;
    m4 / (m2 * m2) - 3.0
}
