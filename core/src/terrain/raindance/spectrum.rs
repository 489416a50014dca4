//! The base field by spectral synthesis: chosen amplitudes, random phases.
//!
//! Frequencies n are in cycles per 512 m, the side of the reference's repeated cell; the same spectrum is laid on
//! a 64 x 64 cell, whose modes are whole n, or on the 256 x 256 tile, whose modes are quarters.

use super::draws::{Draws, MODES, TEXTURE};
use crate::terrain::statistics::fft::{Direction, transform};
use crate::terrain::statistics::grid::SIDE;
use std::sync::OnceLock;

/// No wavelength is longer than this lets: the reference has no relief above its cell.
const LOWEST: f64 = 0.86;
/// The modes between LOWEST and here are weaker by [`DAMPED`]: few of them, so each shows.
const DAMPED_BELOW: f64 = 1.5;
const DAMPED: f64 = 0.6;
/// Where the hills' power falls off, and how fast.
const HILLS_CUT: f64 = 3.1;
/// Factor of the detail's power law: gives it 0.17 of the hills' standard deviation, before the shares are pinned.
const DETAIL: f64 = 2.4;
const DETAIL_EXPONENT: f64 = -3.9;
const DETAIL_FROM: f64 = 5.0;
/// How much the texture field moves the detail's amplitude, as an exponent.
const MODULATION: f64 = 0.25;
/// Highest frequency of the texture field.
const TEXTURE_CUT: f64 = 5.0;
/// Standard deviation of the logarithm of the modes' amplitudes.
const JITTER: f64 = 0.3;
/// Upper ends of the bands whose shares of energy are pinned, and the shares. Without it the few long modes
/// would let seeds wander out of the windows.
const PINNED: [(f64, f64); 3] = [(2.13, 0.270), (4.09, 0.594), (f64::INFINITY, 0.136)];

/// A periodic field and the smooth field that goes with its texture, `side` x `side` each.
pub(super) struct Base {
    pub side: usize,
    pub heights: Vec<f64>,
    pub texture: Vec<f64>,
}

/// Amplitudes of one mode, before the shares are pinned.
#[derive(Clone, Copy)]
struct Amplitude {
    hills: f64,
    detail: f64,
    band: usize,
}

/// A mode of the upper half plane, with its place and its amplitude.
struct Mode {
    at: usize,
    opposite: usize,
    amplitude: Amplitude,
    texture: bool,
}

/// Synthesises the base field of an attempt: one 512 m cell, or the whole tile.
pub(super) fn base(draws: Draws, repeating: bool) -> Base {
    let side = if repeating { SIDE / 4 } else { SIDE };
    let modes = modes(repeating);
    // Two real fields share one complex transform: hills in the real part, detail in the imaginary one.
    let (mut re, mut im) = (vec![0.0; side * side], vec![0.0; side * side]);
    let mut texture = (vec![0.0; side * side], vec![0.0; side * side]);
    let mut coefficients = Vec::with_capacity(modes.len());
    let mut energy = [0.0; PINNED.len()];
    for (mode, counter) in modes.iter().zip(0..) {
        let bits = draws.bits(MODES + counter);
        let jitter = libm::exp(JITTER * nearly_normal(bits));
        let scaled =
            |amplitude: f64, (cos, sin): (f64, f64)| (amplitude * jitter * cos, amplitude * jitter * sin);
        let hills = scaled(mode.amplitude.hills, phase(bits));
        let detail = scaled(mode.amplitude.detail, phase(bits >> 12));
        let (sum_re, sum_im) = (hills.0 + detail.0, hills.1 + detail.1);
        energy[mode.amplitude.band] += sum_re * sum_re + sum_im * sum_im;
        coefficients.push((hills, detail));
        if mode.texture {
            let (cos, sin) = phase(draws.bits(TEXTURE + counter));
            put(&mut texture, mode, (cos, sin), (0.0, 0.0));
        }
    }
    let gains: [f64; 3] = std::array::from_fn(|band| (PINNED[band].1 / energy[band]).sqrt());
    let mut spectrum = (std::mem::take(&mut re), std::mem::take(&mut im));
    for (mode, (hills, detail)) in modes.iter().zip(coefficients) {
        let gain = gains[mode.amplitude.band];
        put(&mut spectrum, mode, (gain * hills.0, gain * hills.1), (gain * detail.0, gain * detail.1));
    }
    transform(&mut spectrum.0, &mut spectrum.1, side, Direction::Inverse);
    transform(&mut texture.0, &mut texture.1, side, Direction::Inverse);
    let (mut heights, detail) = spectrum;
    let texture = unit_variance(texture.0);
    for (height, (detail, k)) in heights.iter_mut().zip(detail.iter().zip(&texture)) {
        *height += detail * libm::exp(MODULATION * k);
    }
    Base { side, heights, texture }
}

/// Puts the modes of two real fields, the second one times i, into a spectrum: a mode and its mirror image.
fn put(spectrum: &mut (Vec<f64>, Vec<f64>), mode: &Mode, first: (f64, f64), second: (f64, f64)) {
    spectrum.0[mode.at] = first.0 - second.1;
    spectrum.1[mode.at] = first.1 + second.0;
    spectrum.0[mode.opposite] = first.0 + second.1;
    spectrum.1[mode.opposite] = second.0 - first.1;
}

fn unit_variance(mut field: Vec<f64>) -> Vec<f64> {
    let mean_square = field.iter().map(|value| value * value).sum::<f64>() / field.len() as f64;
    let scale = 1.0 / mean_square.sqrt();
    field.iter_mut().for_each(|value| *value *= scale);
    field
}

/// The modes inside the circle of the Nyquist frequency, one of each pair of opposite ones, in a fixed order.
fn modes(repeating: bool) -> &'static [Mode] {
    static CELL: OnceLock<Vec<Mode>> = OnceLock::new();
    static TILE: OnceLock<Vec<Mode>> = OnceLock::new();
    if repeating {
        CELL.get_or_init(|| list_modes(SIDE / 4, 1.0))
    } else {
        TILE.get_or_init(|| list_modes(SIDE, 0.25))
    }
}

fn list_modes(side: usize, step: f64) -> Vec<Mode> {
    let half = side as i64 / 2;
    let wrap = |k: i64| k.rem_euclid(side as i64) as usize;
    let mut modes = Vec::new();
    for b in 0..half {
        for a in 1 - half..half {
            let inside = a * a + b * b < half * half;
            if !inside || b == 0 && a <= 0 {
                continue;
            }
            let n = step * ((a * a + b * b) as f64).sqrt();
            modes.push(Mode {
                at: wrap(b) * side + wrap(a),
                opposite: wrap(-b) * side + wrap(-a),
                amplitude: amplitude(n),
                texture: LOWEST < n && n < TEXTURE_CUT,
            });
        }
    }
    modes
}

fn amplitude(n: f64) -> Amplitude {
    let power = |x: f64, exponent: usize| (0..exponent).fold(1.0, |power, _| power * x);
    let damping = if n < LOWEST {
        0.0
    } else if n < DAMPED_BELOW {
        DAMPED
    } else {
        1.0
    };
    let detail = libm::pow(n, DETAIL_EXPONENT) / (1.0 + power(DETAIL_FROM / n, 6));
    Amplitude {
        hills: damping / (1.0 + power(n / HILLS_CUT, 10)).sqrt(),
        detail: damping * (DETAIL * detail).sqrt(),
        band: PINNED.iter().position(|(end, _)| n < *end).unwrap_or(2),
    }
}

/// Cosine and sine of one of 4,096 phases, by the lowest 12 bits.
fn phase(bits: u64) -> (f64, f64) {
    static TABLE: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / 4096.0;
        (0..4096).map(|k| (libm::cos(angle(k)), libm::sin(angle(k)))).collect()
    });
    table[(bits & 4095) as usize]
}

/// The sum of four uniform numbers of ten bits each, from the topmost 40 bits, scaled to mean 0 and variance 1.
fn nearly_normal(bits: u64) -> f64 {
    let parts = [24, 34, 44, 54].map(|shift| (bits >> shift & 1023) as f64);
    let sum = parts.iter().sum::<f64>() / 1024.0 + 2.0 / 1024.0;
    (sum - 2.0) * 3.0_f64.sqrt()
}
