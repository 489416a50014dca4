//! The number type: sine and cosine against libm, conversions to integers at their edges, order, and
//! angles.
#![allow(missing_docs)]

use discjump_core::real::{Real, Scalar, V3};
use discjump_core::tick::wrap_angle;
use proptest::prelude::*;

/// Largest error of sine and cosine over some angles, as a multiple of what is claimed: 2 ulp of the
/// result, or `beside_zero`.
fn worst_claim<T: Scalar>(angles: impl Iterator<Item = T>, beside_zero: f64) -> f64 {
    let ulp = |x: f64| {
        let x = x.abs();
        if T::DOUBLE { x.next_up() - x } else { f64::from((x as f32).next_up() - x as f32) }
    };
    let mut worst = 0.0f64;
    for angle in angles {
        let x = angle.to_f64();
        assert!(x.abs() <= 6.283_186);
        let (sin, cos) = angle.sin_cos();
        for (got, exact) in [(sin.to_f64(), libm::sin(x)), (cos.to_f64(), libm::cos(x))] {
            worst = worst.max((got - exact).abs() / (2.0 * ulp(exact)).max(beside_zero));
        }
    }
    worst
}

/// Angles from -2 pi to 2 pi, evenly; and crowded about the multiples of pi/2, where the result
/// passes through zero and the reduction of the angle loses digits.
fn angles() -> impl Iterator<Item = f64> {
    let even = (-500_000..=500_000).map(|k| core::f64::consts::TAU * f64::from(k) / 500_000.0);
    let crowded = (-4..=4).flat_map(|k| {
        let middle = f64::from(k) * core::f64::consts::FRAC_PI_2;
        (0..2000).map(move |m| {
            let off = 10f64.powf(-f64::from(m % 1000) / 60.0);
            middle + if m < 1000 { off } else { -off }
        })
    });
    even.chain(crowded).filter(|x| x.abs() <= core::f64::consts::TAU)
}

#[test]
fn sine_and_cosine_are_within_2_ulp_of_libm() {
    let double = worst_claim(angles(), 0.0);
    let single = worst_claim(angles().map(|x| x as f32), 1e-10);
    println!("of the claim: f64 {double:.3}, f32 {single:.3}");
    assert!(double <= 1.0 && single <= 1.0, "{double} {single}");
}

#[test]
fn the_whole_numbers_of_the_circle_are_exact() {
    assert_eq!(0.0f64.sin_cos(), (0.0, 1.0));
    assert_eq!(Real::sin_cos(0.0f32), (0.0, 1.0));
    // No quarter flips a sign: the four corners of a yaw of a whole circle.
    for (quarter, sin, cos) in [(1, 1.0, 0.0), (2, 0.0, -1.0), (3, -1.0, 0.0), (4, 0.0, 1.0)] {
        for sign in [1.0, -1.0] {
            let (s, c) = Real::sin_cos(sign * f64::from(quarter) * core::f64::consts::FRAC_PI_2);
            assert!((s - sign * sin).abs() < 1e-15 && (c - cos).abs() < 1e-15, "{quarter} {sign}");
        }
    }
}

/// The numbers at which a conversion to `i32` can go wrong.
fn edges() -> Vec<f64> {
    let mut edges = vec![0.0, -0.0, 5e-324, -5e-324, 1e-45, -1e-45, 0.5, -0.5, 1.0, -1.0, 7.999_999_9, 1e30];
    edges.extend([f64::INFINITY, 16_777_216.0, 16_777_217.0, -16_777_217.0, 2_147_483_520.0, 1e10]);
    for whole in [1.0, 2.0, 256.0, 2_147_483_647.0, 2_147_483_648.0f64] {
        for x in [whole, whole.next_up(), whole.next_down(), whole + 0.5, whole - 0.5] {
            edges.extend([x, -x]);
        }
    }
    edges.extend([-1e30, f64::NEG_INFINITY, -2_147_483_649.0]);
    edges
}

/// Caught: rounding down below the smallest `i32` wrapped around to the largest one, which put a
/// player far to the west of a clamped map on the ground of its eastern rim; and rounding up at the
/// largest one overflowed on the way to the right answer.
#[test]
fn floor_and_ceiling_saturate() {
    // `as` saturates, and takes NaN to 0.
    for x in edges() {
        assert_eq!(x.floor_int(), x.floor() as i32, "floor of {x:?}");
        assert_eq!((x as f32).floor_int(), (x as f32).floor() as i32, "floor of {x:?} in f32");
        assert_eq!(x.truncate(), x as i32, "{x:?}");
        // The ceiling is only for what is not negative: slices of a move.
        if x >= 0.0 {
            assert_eq!(x.ceil_int(), x.ceil() as i32, "ceiling of {x:?}");
            assert_eq!((x as f32).ceil_int(), (x as f32).ceil() as i32, "ceiling of {x:?} in f32");
        } else {
            assert!(x.ceil_int() <= 0, "ceiling of {x:?}");
        }
    }
    assert_eq!((f64::NAN.floor_int(), f64::NAN.ceil_int(), f64::NAN.truncate()), (0, 0, 0));
    assert_eq!((f32::NAN.floor_int(), f32::NAN.ceil_int(), f32::NAN.truncate()), (0, 0, 0));
}

/// The order of the operands decides what NaN and zeros of both signs give: it is part of the bits.
#[test]
fn least_and_greatest_keep_the_second_where_neither_is_less() {
    let bits = f64::to_bits;
    assert_eq!(bits(Real::min(0.0, -0.0)), bits(-0.0));
    assert_eq!(bits(Real::min(-0.0, 0.0)), bits(0.0));
    assert_eq!(bits(Real::max(0.0, -0.0)), bits(-0.0));
    assert_eq!(bits(Real::max(-0.0, 0.0)), bits(0.0));
    assert_eq!(Real::min(f64::NAN, 1.0), 1.0);
    assert_eq!(Real::max(f64::NAN, 1.0), 1.0);
    assert!(Real::min(1.0, f64::NAN).is_nan() && Real::max(1.0, f64::NAN).is_nan());
    assert_eq!((Real::min(1.0f32, 2.0), Real::min(2.0f32, 1.0)), (1.0, 1.0));
    assert_eq!((Real::max(1.0f32, 2.0), Real::max(2.0f32, 1.0)), (2.0, 2.0));
    assert!(!f64::NAN.lt(1.0) && !1.0.lt(f64::NAN) && !f64::NAN.le(f64::NAN));
}

#[test]
fn a_vector_sums_from_x_to_z() {
    let (a, b) = (V3::new(1e8f32, 1.0, -1e8), V3::splat(V3::new(1.0f32, 1.0, 1.0)));
    assert_eq!(a.dot(b), (1e8f32 + 1.0) + -1e8);
    assert_eq!(V3::new(2.0, 3.0, 6.0).length(), 7.0);
}

fn check_wrapped<T: Scalar>(angle: f64) -> Result<(), TestCaseError> {
    let angle = T::from_f64(angle);
    let wrapped = wrap_angle(angle).to_f64();
    let pi = T::from_f64(core::f64::consts::PI).to_f64();
    prop_assert!((-pi..pi).contains(&wrapped), "{angle:?} became {wrapped:?}");
    let turns = (angle.to_f64() - wrapped) / core::f64::consts::TAU;
    // Of an angle of a million radians f32 keeps three digits after the point, and 2 pi is rounded too.
    let digits = (angle.to_f64().abs() + 4.0) * if T::DOUBLE { 4e-16 } else { 2e-7 };
    prop_assert!((turns - turns.round()).abs() <= digits, "{angle:?} became {wrapped:?}");
    // What is in range stays as it is, but for what the rounding of pi + angle loses.
    if (-pi..pi).contains(&angle.to_f64()) {
        prop_assert!((wrapped - angle.to_f64()).abs() == 0.0, "{angle:?} became {wrapped:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Every yaw that a state or a turn of one tick may bring.
    #[test]
    fn angles_wrap_into_the_circle(
        angle in prop_oneof![
            -1e6..1e6f64,
            -1010.0..1010.0f64,
            -3.2..3.2f64,
            (-200_000..200_000i32, -4..5i32).prop_map(|(turns, ulps)| {
                let edge = core::f64::consts::PI * f64::from(turns);
                edge + f64::from(ulps) * 2e-16 * edge
            }),
            (-400..400i32, -4..5i32).prop_map(|(turns, ulps)| {
                let edge = core::f32::consts::PI * turns as f32;
                f64::from(edge + ulps as f32 * 6e-8 * edge)
            }),
        ],
    ) {
        check_wrapped::<f64>(angle)?;
        check_wrapped::<f32>(angle)?;
    }
}
