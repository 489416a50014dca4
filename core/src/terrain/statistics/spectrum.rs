//! Which wavelengths the height variance sits in, and how fast heights forget each other.
//!
//! With P the squared modulus of the discrete Fourier transform of the heights less their mean:
//!
//! - `band_*`: share of P by wavelength, 2048 m / sqrt(a^2 + b^2) for mode (a, b). Edges at 600, 240, 125, 63
//!   and 31.5 m: no mode of the tile, nor a harmonic of a 512 m cell, sits on one. The longer edge is excluded.
//! - `acf_1e_m`, `acf_zero_m`: the circular autocorrelation (inverse transform of P over its value at lag 0),
//!   averaged over all lags whose length in squares rounds to the same whole number; where it first falls below
//!   1/e and 0, linear between whole lags, in metres. NaN where it never does.
//! - `acf_min`: its lowest value at whole lags up to 63 squares.
//! - repetition: the autocorrelation at a lag of 512 m, the lower of east and north.

use super::Values;
use super::fft::{Direction, transform};
use super::grid::{Grid, SIDE, SQUARE};
use super::order::mean;
use std::sync::OnceLock;

/// 2048 m over the shorter wavelength of each band but the last, squared: compared with a^2 + b^2.
const BANDS: [(&str, f64); 6] = [
    ("band_gt600", 2048.0 / 600.0),
    ("band_240_600", 2048.0 / 240.0),
    ("band_125_240", 2048.0 / 125.0),
    ("band_63_125", 2048.0 / 63.0),
    ("band_31_63", 2048.0 / 31.5),
    ("band_lt31", 1e9),
];
/// Lags go to the corner of the half tile: sqrt(128^2 + 128^2) rounds to 181.
const RINGS: usize = 182;

/// Measures the bands and the autocorrelation; returns the repetition.
pub(super) fn measure(grid: &Grid, values: &mut Values) -> f64 {
    let centre = mean(grid.heights());
    let mut re: Vec<f64> = grid.heights().iter().map(|height| height - centre).collect();
    let mut im = vec![0.0; re.len()];
    transform(&mut re, &mut im, SIDE, Direction::Forward);
    for (re, im) in re.iter_mut().zip(&mut im) {
        *re = *re * *re + *im * *im;
        *im = 0.0;
    }
    bands(&re, values);
    transform(&mut re, &mut im, SIDE, Direction::Inverse);
    let curve = rings(&re);
    values.push("acf_1e_m", crossing(&curve, 1.0 / std::f64::consts::E));
    values.push("acf_zero_m", crossing(&curve, 0.0));
    values.push("acf_min", curve[..64].iter().copied().fold(f64::NAN, f64::min));
    (re[64] / re[0]).min(re[64 * SIDE] / re[0])
}

/// Distance of index `k` from index 0, the shortest way round.
fn wrapped(k: usize) -> f64 {
    k.min(SIDE - k) as f64
}

fn bands(power: &[f64], values: &mut Values) {
    let mut sums = [0.0; BANDS.len()];
    for (y, row) in power.chunks_exact(SIDE).enumerate() {
        for (x, power) in row.iter().enumerate() {
            let modulus = wrapped(x) * wrapped(x) + wrapped(y) * wrapped(y);
            let band = BANDS.iter().position(|(_, limit)| modulus <= limit * limit).unwrap_or(5);
            sums[band] += power;
        }
    }
    let total: f64 = sums.iter().sum();
    for ((name, _), sum) in BANDS.iter().zip(sums) {
        values.push(name, sum / total);
    }
}

/// The normalised autocorrelation averaged over rings of lags.
fn rings(correlation: &[f64]) -> [f64; RINGS] {
    let (numbers, counts) = ring_numbers();
    let mut sums = [0.0; RINGS];
    for (value, &ring) in correlation.iter().zip(numbers) {
        sums[usize::from(ring)] += value;
    }
    std::array::from_fn(|ring| sums[ring] / f64::from(counts[ring]) / correlation[0])
}

/// The ring of every lag, and how many lags each ring has.
fn ring_numbers() -> &'static (Vec<u8>, [u32; RINGS]) {
    static NUMBERS: OnceLock<(Vec<u8>, [u32; RINGS])> = OnceLock::new();
    NUMBERS.get_or_init(|| {
        let mut counts = [0; RINGS];
        let mut numbers = Vec::with_capacity(SIDE * SIDE);
        for y in 0..SIDE {
            for x in 0..SIDE {
                let length = (wrapped(x) * wrapped(x) + wrapped(y) * wrapped(y)).sqrt();
                // Never half-way between two rings: the square of such a length is no whole number.
                let ring = (length + 0.5).floor() as u8;
                counts[usize::from(ring)] += 1;
                numbers.push(ring);
            }
        }
        (numbers, counts)
    })
}

/// Where the curve first falls below a level, metres.
fn crossing(curve: &[f64], level: f64) -> f64 {
    let Some(below) = curve.iter().position(|&value| value < level) else { return f64::NAN };
    if below == 0 {
        return 0.0;
    }
    let (high, low) = (curve[below - 1], curve[below]);
    SQUARE * ((below - 1) as f64 + (high - level) / (high - low))
}
