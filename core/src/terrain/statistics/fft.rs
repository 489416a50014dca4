//! A two-dimensional Fourier transform that gives the same bits on every machine.
//!
//! Library transforms choose their vector instructions, and with them the order of their roundings, at
//! run time. This one is the plain radix-2 scheme in one fixed order. Four lines are transformed side by side
//! in lanes (their samples then fit the first-level cache), which the compiler may vectorise freely: lanes do not mix.

use std::sync::OnceLock;

const LANES: usize = 4;
const LONGEST: usize = 256;

/// One part of a sample of each of the lines that go abreast.
type Lane = [f64; LANES];

/// Lines of up to 256 complex samples.
struct Lines {
    re: [Lane; LONGEST],
    im: [Lane; LONGEST],
}

/// Which way a transform goes. Neither scales.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// exp(-i k x): from samples to modes.
    Forward,
    /// exp(+i k x): from modes to samples.
    Inverse,
}

/// Transforms a `side` x `side` complex array in place, along x and y.
///
/// # Panics
/// If `side` is not a power of two from 8 to 256, or a slice is not `side * side` long.
pub fn transform(re: &mut [f64], im: &mut [f64], side: usize, direction: Direction) {
    assert!(side.is_power_of_two() && (LANES..=LONGEST).contains(&side), "side {side}");
    assert!(re.len() == side * side && im.len() == side * side, "expected {side} x {side} samples");
    let mut lines = Box::new(Lines { re: [[0.0; LANES]; LONGEST], im: [[0.0; LANES]; LONGEST] });
    // Where each sample of a line goes before the butterflies: its index with the bits reversed.
    let reversed: [usize; LONGEST] =
        std::array::from_fn(|k| (k % side).reverse_bits() >> (usize::BITS - side.trailing_zeros()));
    for first in (0..side).step_by(LANES) {
        let zero =
            |part: &[f64]| part.chunks_exact(side).all(|row| row[first..first + LANES] == [0.0; LANES]);
        if zero(im) && zero(re) {
            // As in most lines of a spectrum that ends early.
            continue;
        }
        for (k, &to) in reversed[..side].iter().enumerate() {
            lines.re[to].copy_from_slice(&re[k * side + first..][..LANES]);
            lines.im[to].copy_from_slice(&im[k * side + first..][..LANES]);
        }
        lines.transform(side, direction);
        for k in 0..side {
            re[k * side + first..][..LANES].copy_from_slice(&lines.re[k]);
            im[k * side + first..][..LANES].copy_from_slice(&lines.im[k]);
        }
    }
    let rows = re.chunks_exact_mut(LANES * side).zip(im.chunks_exact_mut(LANES * side));
    for (re, im) in rows {
        for lane in 0..LANES {
            let (re, im) = (&re[lane * side..][..side], &im[lane * side..][..side]);
            for ((&to, re), im) in reversed.iter().zip(re).zip(im) {
                lines.re[to][lane] = *re;
                lines.im[to][lane] = *im;
            }
        }
        lines.transform(side, direction);
        for lane in 0..LANES {
            let (re, im) = (&mut re[lane * side..][..side], &mut im[lane * side..][..side]);
            for (k, (re, im)) in re.iter_mut().zip(im).enumerate() {
                *re = lines.re[k][lane];
                *im = lines.im[k][lane];
            }
        }
    }
}

impl Lines {
    /// The butterflies, on lines that are already in bit-reversed order.
    fn transform(&mut self, side: usize, direction: Direction) {
        let turns = turns();
        let sign = if direction == Direction::Forward { -1.0 } else { 1.0 };
        let mut half = 1;
        while half < side {
            let pairs =
                self.re[..side].chunks_exact_mut(2 * half).zip(self.im[..side].chunks_exact_mut(2 * half));
            for (re, im) in pairs {
                let ((re, re_far), (im, im_far)) = (re.split_at_mut(half), im.split_at_mut(half));
                let near = re.iter_mut().zip(im);
                let far = re_far.iter_mut().zip(im_far);
                for ((a, b), &(cos, sin)) in near.zip(far).zip(turns.iter().step_by(LONGEST / 2 / half)) {
                    butterfly(a, b, cos, sign * sin);
                }
            }
            half *= 2;
        }
    }
}

#[inline(always)]
fn butterfly(a: (&mut Lane, &mut Lane), b: (&mut Lane, &mut Lane), cos: f64, sin: f64) {
    for lane in 0..LANES {
        let re = b.0[lane] * cos - b.1[lane] * sin;
        let im = b.0[lane] * sin + b.1[lane] * cos;
        b.0[lane] = a.0[lane] - re;
        b.1[lane] = a.1[lane] - im;
        a.0[lane] += re;
        a.1[lane] += im;
    }
}

/// Cosine and sine of k / 256 turns, k below 128.
fn turns() -> &'static [(f64, f64); LONGEST / 2] {
    static TURNS: OnceLock<[(f64, f64); LONGEST / 2]> = OnceLock::new();
    TURNS.get_or_init(|| {
        std::array::from_fn(|k| {
            let angle = std::f64::consts::TAU * k as f64 / LONGEST as f64;
            (libm::cos(angle), libm::sin(angle))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{Direction, transform};

    /// Against the defining sum, and back again.
    #[test]
    fn equals_the_defining_sum_and_inverts() {
        let side = 16;
        let samples: Vec<f64> = (0..side * side).map(|k| ((k * 37 + k * k * 11) % 101) as f64).collect();
        let (mut re, mut im) = (samples.clone(), vec![0.0; side * side]);
        transform(&mut re, &mut im, side, Direction::Forward);
        for (b, a) in [(0, 0), (0, 3), (5, 0), (7, 11), (15, 15)] {
            let (mut sum_re, mut sum_im) = (0.0, 0.0);
            for y in 0..side {
                for x in 0..side {
                    let angle = -std::f64::consts::TAU * (a * x + b * y) as f64 / side as f64;
                    sum_re += samples[y * side + x] * angle.cos();
                    sum_im += samples[y * side + x] * angle.sin();
                }
            }
            assert!((re[b * side + a] - sum_re).abs() < 1e-9);
            assert!((im[b * side + a] - sum_im).abs() < 1e-9);
        }
        transform(&mut re, &mut im, side, Direction::Inverse);
        for (k, sample) in samples.iter().enumerate() {
            assert!((re[k] / (side * side) as f64 - sample).abs() < 1e-10);
            assert!(im[k].abs() < 1e-8);
        }
    }
}
