//! Sine and cosine as polynomials, so that every lane width and every machine gives the same bits.
//!
//! The angle is reduced to [-pi/4, pi/4] by multiples of pi/2 held in two parts; there the Taylor
//! series are cut where the next term is below half an ulp.

use super::{Int, Mask, Real, Scalar};

/// 1/3!, 1/5!, ... with alternating signs, for sin r = r + r^3 (S[0] + r^2 (S[1] + ...)).
const S: [f64; 8] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
];
/// 1/4!, 1/6!, ... with alternating signs, for cos r = 1 - r^2/2 + r^4 (C[0] + r^2 (C[1] + ...)).
const C: [f64; 7] = [
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];
/// pi/2 in two parts for `f32`: the first has 11 bits, so small multiples of it are exact.
const HALF_PI_F32: (f64, f64) = (1.570_312_5, core::f64::consts::FRAC_PI_2 - 1.570_312_5);
/// pi/2 in two parts for `f64`: the nearest double and what it leaves out.
const HALF_PI_F64: (f64, f64) = (core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);

#[inline(always)]
fn horner<R: Real>(x: R, coefficients: &[f64]) -> R {
    let mut sum = R::lit(coefficients[coefficients.len() - 1]);
    for &c in coefficients[..coefficients.len() - 1].iter().rev() {
        sum = sum * x + R::lit(c);
    }
    sum
}

#[inline(always)]
pub(super) fn sin_cos<R: Real>(angle: R) -> (R, R) {
    // f32 needs r^9 and r^10, f64 r^17 and r^16.
    let (s_terms, c_terms, half_pi) =
        if R::Scalar::DOUBLE { (8, 7, HALF_PI_F64) } else { (4, 4, HALF_PI_F32) };
    let quarter = (angle * R::lit(core::f64::consts::FRAC_2_PI) + R::lit(0.5)).floor_int();
    let k = R::from_int(quarter);
    let r = (angle - k * R::lit(half_pi.0)) - k * R::lit(half_pi.1);
    let r2 = r * r;
    let sin = r + r * r2 * horner(r2, &S[..s_terms]);
    let cos = (R::lit(1.0) - r2 * R::lit(0.5)) + r2 * r2 * horner(r2, &C[..c_terms]);
    let turn = quarter.wrap(4);
    let swap = turn.is_odd();
    let (a, b) = (R::select(swap, cos, sin), R::select(swap, sin, cos));
    let sin_negative = R::Int::splat(1).lt(turn);
    let cos_negative = turn.eq(R::Int::splat(1)).or(turn.eq(R::Int::splat(2)));
    (R::select(sin_negative, -a, a), R::select(cos_negative, -b, b))
}
