//! Creases, where the two faces throw a player to and fro until the bumps of the tick are used up
//! (docs/physics.md, sections 5 and 11).
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::valley;
use discjump_core::input::Input;
use discjump_core::real::Scalar;
use discjump_core::rules::Physics;
use discjump_core::scene::Has;

/// A player who slides down the eastern face at `speed` in this very tick, with `metres` to go to
/// the crease, and what the tick makes of him.
fn slide<T: Scalar>(degrees: f64, speed: f64, metres: f64, ski_bug: bool) -> (Lab<T>, Body<T>) {
    let lab = Lab::<T>::with(&valley(degrees), Physics { ski_bug: Some(ski_bug), ..Physics::default() });
    let (sin, cos) = degrees.to_radians().sin_cos();
    let place = [metres * cos, 1.0, metres * sin + 1e-4];
    // Gravity comes first.
    let p: Body<T> = lab.player(place, [-speed * cos, 0.0, -speed * sin + 0.64]);
    let p = lab.tick(&p, &Input::idle());
    (lab, p)
}

fn speed<T: Scalar>(p: &Body<T>) -> f64 {
    floats(p.velocity).iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Projecting a velocity from face to face multiplies it by |cos 2 theta|, and for more than 45 degrees
/// turns it back into the crease: so four bumps in a tick leave the fourth power.
fn four_bumps_leave_the_fourth_power<T: Scalar>() {
    for degrees in [60.0f64, 75.0] {
        let (_, p) = slide::<T>(degrees, 20.0, 0.05, false);
        let left = 20.0 * (2.0 * degrees.to_radians()).cos().abs().powi(4);
        // Four outward pushes of a millimetre a second.
        assert!((speed(&p) - left).abs() < 0.005, "{degrees} degrees: {} m/s, expected {left}", speed(&p));
        assert!(p.touched && p.velocity.y == T::zero());
    }
}

#[test]
fn four_bumps_in_a_crease_leave_the_fourth_power() {
    four_bumps_leave_the_fourth_power::<f32>();
    four_bumps_leave_the_fourth_power::<f64>();
}

/// Below 45 degrees one bump turns him up the other face, and the tick goes on.
#[test]
fn a_gentle_crease_takes_one_bump() {
    let (_, p) = slide::<f64>(30.0, 20.0, 0.3, true);
    let left = 20.0 * 60f64.to_radians().cos();
    assert!((speed(&p) - left).abs() < 0.005 && p.velocity.z > 0.0, "{:?}", p.velocity);
}

#[test]
fn the_ski_bug_stops_dead_and_its_absence_does_not() {
    fn check<T: Scalar>() {
        for degrees in [60.0, 75.0] {
            let (_, with) = slide::<T>(degrees, 20.0, 0.05, true);
            let (_, without) = slide::<T>(degrees, 20.0, 0.05, false);
            assert_eq!(floats(with.velocity), [0.0; 3]);
            assert!(speed(&without) > 1.0);
            // Neither moves him: the slices that hit were not made.
            assert_eq!(floats(with.position), floats(without.position));
            let (Has(a), Has(b)) = (with.damage, without.damage);
            assert_eq!(a, b);
        }
    }
    check::<f32>();
    check::<f64>();
}

/// Two landings in one tick are two damages.
#[test]
fn every_bump_costs() {
    let (_, p) = slide::<f64>(75.0, 200.0, 0.3, false);
    let mut expected = 0.0;
    let mut v = 200.0;
    let (cos, sin) = (150f64.to_radians().cos().abs(), 150f64.to_radians().sin());
    for _ in 0..4 {
        expected += 0.005 * (v * sin - 25.0f64).max(0.0);
        v *= cos;
    }
    let Has(damage) = p.damage;
    assert!((damage - expected).abs() < 1e-4 && expected > 1.0, "{damage}, expected {expected}");
}

/// Dropped, thrown and skied into creases: nothing is lost below, and nothing becomes NaN.
#[test]
fn nobody_falls_through_a_crease() {
    fn check<T: Scalar>(deepest: f64) {
        let mut lowest = 0.0f64;
        for degrees in [45.0, 60.0, 75.0] {
            for ski_bug in [false, true] {
                for k in 0..40 {
                    let speed = 3.0 + 2.0 * f64::from(k);
                    let (lab, mut p) = slide::<T>(degrees, speed, 0.1 + 0.4 * f64::from(k % 7), ski_bug);
                    for tick in 0..150 {
                        let jump = tick % 2 == 0;
                        p = lab.tick(&p, &input(1, 0, jump, tick > 75, 10));
                        assert!(numbers(&p).iter().all(|x| x.is_finite()), "{p:?}");
                        lowest = lowest.min(lab.clearance(&p));
                    }
                }
            }
        }
        println!("lowest {lowest:e} m");
        assert!(lowest >= -deepest, "{lowest}");
    }
    check::<f32>(1e-3);
    check::<f64>(1e-9);
}
