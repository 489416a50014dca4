//! Creases, where the two faces throw a player to and fro until the bumps of the tick are used up
//! (docs/physics.md, sections 5 and 11).
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::valley;
use discjump_core::input::Input;
use discjump_core::movement::{Anyway, Engine, Fast, Movement, Sliced, Swept};
use discjump_core::real::Scalar;
use discjump_core::rules::Physics;
use discjump_core::scene::Has;

/// A player who slides down the eastern face at `speed` in the next tick, with `metres` to go to the crease.
fn sliding<T: Scalar>(lab: &Lab<T>, degrees: f64, speed: f64, metres: f64) -> Body<T> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    // Gravity comes first.
    lab.player([metres * cos, 1.0, metres * sin + 1e-4], [-speed * cos, 0.0, -speed * sin + 0.64])
}

/// What that tick makes of him.
fn slide<M: Movement, T: Scalar>(degrees: f64, speed: f64, metres: f64, ski_bug: bool) -> (Lab<T>, Body<T>) {
    let physics = Physics { ski_bug: Some(ski_bug), ..Physics::default() };
    let lab = Lab::<T>::of(M::MODEL, &valley(degrees), physics);
    let p = lab.tick_as::<M, _>(&sliding(&lab, degrees, speed, metres), &Input::idle());
    (lab, p)
}

fn speed<T: Scalar>(p: &Body<T>) -> f64 {
    floats(p.velocity).iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Projecting a velocity from face to face multiplies it by |cos 2 theta|, and for more than 45 degrees
/// turns it back into the crease: so four bumps in a tick leave the fourth power.
fn four_bumps_leave_the_fourth_power<T: Scalar>() {
    for degrees in [60.0f64, 75.0] {
        let (_, p) = slide::<Sliced, T>(degrees, 20.0, 0.05, false);
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
    let (_, p) = slide::<Sliced, f64>(30.0, 20.0, 0.3, true);
    let left = 20.0 * 60f64.to_radians().cos();
    assert!((speed(&p) - left).abs() < 0.005 && p.velocity.z > 0.0, "{:?}", p.velocity);
}

/// The fourth contact of a tick is counted, and with the bug it is the last thing that happens. Returns how
/// many of 200 slides into a crease meet it.
fn ski_bug<M: Movement, T: Scalar>(degrees: f64) -> i32 {
    let mut met = 0;
    for start in 0..200 {
        let (speed_before, metres) = ([5.0, 60.0][start % 2], 0.01 * (start / 2) as f64);
        let (_, with) = slide::<M, T>(degrees, speed_before, metres, true);
        let (_, without) = slide::<M, T>(degrees, speed_before, metres, false);
        assert_eq!(with.bump_limits.0, without.bump_limits.0);
        // Neither moves him: what is left of the tick is dropped.
        assert_eq!(floats(with.position), floats(without.position));
        let (Has(a), Has(b)) = (with.damage, without.damage);
        assert_eq!(a, b);
        if with.bump_limits.0 == 1 {
            assert!(floats(with.velocity) == [0.0; 3] && speed(&without) > 0.0);
        } else {
            assert_eq!(floats(with.velocity), floats(without.velocity));
        }
        met += with.bump_limits.0;
    }
    met
}

#[test]
fn the_ski_bug_stops_dead_and_its_absence_does_not() {
    fn check<M: Movement>(least: i32) {
        let met = [30.0, 60.0, 75.0].map(|degrees| [ski_bug::<M, f32>(degrees), ski_bug::<M, f64>(degrees)]);
        println!("{}: {met:?}", core::any::type_name::<M>());
        assert!(met[0] == [0, 0] && met[2].iter().all(|&n| n > least), "{met:?}");
    }
    check::<Sliced>(50);
    check::<Swept>(50);
    check::<Engine>(5);
}

/// `fast` meets two faces a tick: there is no limit to reach, and so no dead stop.
#[test]
fn fast_has_no_bump_limit() {
    for ski_bug in [false, true] {
        let (_, p) = slide::<Fast, f32>(75.0, 20.0, 0.05, ski_bug);
        let left = 20.0 * 150f64.to_radians().cos().powi(2);
        assert!(p.bump_limits.0 == 0 && (speed(&p) - left).abs() < 0.005, "{} m/s", speed(&p));
    }
}

/// Two landings in one tick are two damages.
#[test]
fn every_bump_costs() {
    let (_, p) = slide::<Sliced, f64>(75.0, 200.0, 0.3, false);
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

/// Dropped, thrown and skied into creases for 4.8 s: how deep under the ground anybody was at the end of
/// a tick, and how deep anybody was at the very end.
fn depths<M: Movement, T: Scalar>(degrees: f64, physics: Physics) -> (f64, f64) {
    let (mut deepest, mut last) = (0.0f64, 0.0f64);
    for ski_bug in [false, true] {
        let physics = Physics { ski_bug: Some(ski_bug), ..physics };
        let lab = Lab::<T>::of(M::MODEL, &valley(degrees), physics);
        for k in 0..40 {
            let speed = 3.0 + 2.0 * f64::from(k);
            let mut p = sliding(&lab, degrees, speed, 0.1 + 0.4 * f64::from(k % 7));
            for tick in 0..150 {
                let jump = tick % 2 == 0;
                p = lab.tick_as::<M, _>(&p, &input(1, 0, jump, tick > 75, 10));
                assert!(numbers(&p).iter().all(|x| x.is_finite()), "{p:?}");
                deepest = deepest.max(-lab.clearance(&p));
            }
            last = last.max(-lab.clearance(&p));
        }
    }
    (deepest, last)
}

const STEEP: [f64; 3] = [45.0, 60.0, 75.0];

#[test]
fn nobody_falls_through_a_crease() {
    fn check<M: Movement, T: Scalar>(deepest: f64) {
        for degrees in STEEP {
            let (deep, _) = depths::<M, T>(degrees, Physics::default());
            println!("{} {degrees} degrees: {deep:e} m", core::any::type_name::<(M, T)>());
            assert!(deep <= deepest, "{degrees} degrees: {deep} m");
        }
    }
    check::<Sliced, f32>(1e-3);
    check::<Sliced, f64>(1e-9);
    check::<Fast, f32>(1e-3);
    check::<Fast, f64>(1e-9);
    check::<Engine, f64>(1e-3);
}

/// The unswept fix-up goes below the other face, and the push of the next contact at once brings the
/// player up again; a swept one does not.
#[test]
fn swept_dips_in_creases_and_recovers() {
    for (degrees, dip) in [(45.0, 0.0), (60.0, 0.5), (75.0, 1.0)] {
        let (deep, last) = depths::<Swept, f64>(degrees, Physics::default());
        let swept = Physics { fixup_swept: true, ..Physics::default() };
        println!("{degrees} degrees: {deep:.3} m");
        assert!(0.8 * dip - 1e-9 <= deep && deep <= dip + 1e-9 && last < 1e-9, "{deep} m, then {last} m");
        assert!(depths::<Swept, f64>(degrees, swept).0 < 1e-9);
    }
}

/// The literal reading goes through the floor of any crease of 45 degrees and more: what the form is kept
/// to show. In gentler ones it gets under the ground too, and stays there.
#[test]
fn anyway_tunnels_through_creases() {
    for (degrees, tunnels) in
        [(15.0, false), (30.0, false), (40.0, false), (45.0, true), (60.0, true), (75.0, true)]
    {
        let lab = Lab::<f64>::with(&valley(degrees), Physics::default());
        let depth = |k: i32| {
            let mut p = sliding(&lab, degrees, f64::from(k), 20.0);
            (0..300).for_each(|_| p = lab.tick_as::<Anyway, _>(&p, &Input::idle()));
            -lab.clearance(&p)
        };
        let deepest = (0..100).map(depth).fold(0.0, f64::max);
        println!("{degrees} degrees: {deepest:.2} m below after 9.6 s");
        assert_eq!(deepest > 5.0, tunnels, "{degrees} degrees: {deepest} m");
        assert!(deepest > 0.3, "{deepest} m");
    }
}
