//! Items 1 and 5: speeds from 1e-30 m/s to a million.

use crate::common::lab::*;
use crate::common::{rolling, slope};
use crate::{digits, form, lab};
use discjump_core::input::Input;
use discjump_core::movement::Movement;
use discjump_core::real::Scalar;

/// Speeds whose squares are no numbers any more are none at all, or the same small way: nothing divides by them.
#[test]
fn e01_speeds_down_to_1e_30() {
    fn check<M: Movement, T: Scalar>() {
        for degrees in [0.0, 30.0] {
            let lab = lab::<M, T>(&slope(degrees), 32);
            for exponent in 1..=44 {
                let tiny = 10f64.powi(-exponent);
                for (lift, keys) in [(0.64, 0), (0.32, 0), (0.0, 0), (0.64, 1), (0.0, -1)] {
                    let velocity = [tiny, -tiny, lift + tiny];
                    let mut p: Body<T> = lab.player([1.0, 2.0, lab.ground(1.0, 2.0)], velocity);
                    (p.touched, p.friction) = (true, T::from_f64(tiny));
                    for jump in [false, true, false] {
                        p = lab.tick_as::<M, _>(&p, &input(keys, keys, jump, false, 0));
                        let finite = numbers(&p).iter().all(|x| x.is_finite());
                        assert!(finite, "{} at {tiny} m/s: {p:?}", form::<M, T>());
                    }
                    let moved = floats(p.position);
                    assert!((moved[0] - 1.0).abs() < 0.5 && (moved[1] - 2.0).abs() < 0.5, "{moved:?}");
                }
            }
        }
    }
    in_every_form!(check);
}

/// Four kilometres a second are 128 slices a tick, a million metres a second a few kilometres of them: whoever
/// comes down so fast is stopped by the ground all the same, slantwise too, at any tick length.
#[test]
fn e05_no_speed_goes_through_the_ground() {
    fn check<M: Movement, T: Scalar>() {
        let name = form::<M, T>();
        let engine = name.contains("Engine");
        for tick_ms in [1, 32, 1000] {
            let flat = lab::<M, T>(&slope(0.0), tick_ms);
            for speed in [1e3, 4e3, 3e4, 1e5, 1e6] {
                // Sub-steps of the engine stop at 65,536 a tick: beyond 2 r each they could miss the ground.
                if engine && speed * f64::from(tick_ms) / 1000.0 > 65_536.0 * 1.15 {
                    continue;
                }
                for (slant, height) in [(0.0, 5.0), (0.7, 0.01), (0.99, 300.0)] {
                    let down = f64::sqrt(1.0 - slant * slant);
                    let velocity = [0.1 * speed * slant, speed * slant, -speed * down];
                    let mut p: Body<T> = flat.player([0.0, 0.0, height], velocity);
                    for _ in 0..4 {
                        p = flat.tick_as::<M, _>(&p, &Input::idle());
                        let z = p.position.z.to_f64();
                        let what = format!("{name}: {speed} m/s, {tick_ms} ms, slant {slant}: {z} m");
                        assert!(numbers(&p).iter().all(|x| x.is_finite()), "{what}");
                        // One sweep of so many metres is rounded by so much of them.
                        let rounding = digits::<T>(1e-15, 3e-7) * speed * f64::from(tick_ms) / 1000.0;
                        assert!(z >= -rounding - digits::<T>(1e-9, 1e-4), "{what}");
                    }
                    let hurt = p.damage.0.to_f64();
                    assert!((hurt > 0.0) == (p.touched || hurt > 0.0) && hurt.is_finite());
                }
            }
        }
    }
    in_forms!(check, Sliced, Swept, Fast, Engine);
}

/// The same over hills, whichever of them the way meets. (Not `engine`: a centre that gets below a neighbouring
/// face's plane meets nothing.)
#[test]
fn e05_no_speed_goes_through_a_hill() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&rolling(), 32);
        let mut deepest = 0.0f64;
        for k in 0..300 {
            let speed = 10f64.powf(3.0 + f64::from(k % 31) / 10.0);
            let angle = f64::from(k) * 0.7;
            let dive = 0.05 + 0.9 * f64::from(k % 7) / 7.0;
            let velocity = [angle.cos() * speed, angle.sin() * speed, -dive * speed];
            let mut p: Body<T> = lab.player([200.0 * angle.sin(), 150.0 * angle.cos(), 60.0], velocity);
            for _ in 0..6 {
                p = lab.tick_as::<M, _>(&p, &Input::idle());
                assert!(numbers(&p).iter().all(|x| x.is_finite()), "{}: {p:?}", form::<M, T>());
                deepest = deepest.max(-lab.clearance(&p));
            }
        }
        println!("{}: {deepest:e} m", form::<M, T>());
        // The unswept fix-up's dip is its own; what it is in creases is measured in creases.rs.
        let dip = if form::<M, T>().contains("Swept") { 2.0 } else { 0.0 };
        assert!(deepest <= dip + digits::<T>(1e-9, 5e-3), "{}: {deepest} m", form::<M, T>());
    }
    in_forms!(check, Sliced, Swept, Fast);
}
