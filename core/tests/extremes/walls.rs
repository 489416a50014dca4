//! Items 8, 14 and 15: steep faces, walls and ceilings; the stop rule; landings.

use crate::common::crew::Crew;
use crate::common::lab::*;
use crate::common::{ARTICLE, FORWARD, IDLE, JUMP, TIERS, flat, setup, slope, valley};
use crate::{by_model, digits, form, lab, next};
use discjump_core::armor::LIGHT;
use discjump_core::batch::RawInput;
use discjump_core::input::Input;
use discjump_core::movement::Movement;
use discjump_core::real::Scalar;
use discjump_core::rules::{Physics, Rules};
use discjump_core::solids::{Solid, Solids};
use discjump_core::terrain::{Edge, Heightfield};
use std::sync::Arc;

/// A face through the origin that falls towards +x, 64 m wide.
fn face(degrees: f64) -> Heightfield {
    let fall = 8.0 * degrees.to_radians().tan();
    let heights = (0..81).map(|k| -fall * (f64::from(k % 9) - 4.0)).collect();
    Heightfield::new(heights, 9, 9, 8.0, [-32.0, -32.0], Edge::Clamp).unwrap()
}

/// From an n.up of 0.2 down there is no jumping off a face (78.46 degrees); it turns and hurts like any other.
#[test]
fn e08_faces_steeper_than_78_degrees() {
    fn check<M: Movement, T: Scalar>() {
        for (degrees, jumpable) in [(78.0, true), (78.4, true), (78.5, false), (85.0, false), (88.0, false)] {
            let lab = lab::<M, T>(&face(degrees), 32);
            let name = format!("{} on {degrees} degrees", form::<M, T>());
            let up = degrees.to_radians().cos();
            // The engine's sphere is thicker than a sub-step is long, if its middle begins outside.
            let p: Body<T> = lab.player([by_model::<M>(0.3, 1.5), 0.0, 0.0], [-40.0, 0.0, 0.0]);
            let q = lab.tick_as::<M, _>(&p, &Input::idle());
            assert!(q.touched && q.damage.0 > T::zero(), "{name}");
            // Nothing of 40 m/s into the face is left.
            let into = floats(q.velocity)[0] * degrees.to_radians().sin() + floats(q.velocity)[2] * up;
            assert!(into > -digits::<T>(1e-6, 1e-4), "{name}: {into} m/s");
            let limit = by_model::<M>(32.0, 2.0) as i32;
            assert_eq!(q.contact().age < limit, jumpable, "{name}: age {}", q.contact().age);
            let jumped = lab.tick_as::<M, _>(&q, &input(0, 0, true, false, 0));
            let stayed = lab.tick_as::<M, _>(&q, &Input::idle());
            assert_eq!(jumped.velocity.z > stayed.velocity.z, jumpable, "{name}");
        }
    }
    in_forms!(check, Sliced, Swept, Fast, Engine);
}

/// A player among boxes, in a tier.
fn among(boxes: &[([f64; 3], [f64; 3])], tier: &str) -> Crew {
    let solids: Vec<Solid> =
        boxes.iter().map(|&(size, at)| Solid::cuboid("box", size.into(), at.into(), 0.0)).collect();
    let map = flat();
    let built = Arc::new(Solids::new(&solids, map.grid()).unwrap());
    let mut s = setup(&map, tier);
    (s.scene, s.solids) = ("mission", Some(&built));
    Crew::new(&s)
}

/// A wall (n.up = 0) and a ceiling (n.up = -1): damage by the speed into them, no grip, no jump.
#[test]
fn e08_walls_and_ceilings_hurt_and_give_no_hold() {
    let boxes = [([1.0, 40.0, 40.0], [10.5, 0.0, 30.0]), ([40.0, 40.0, 1.0], [0.0, 0.0, 30.5])];
    for tier in TIERS {
        for (place, velocity, axis) in
            [([9.0, 0.0, 20.0], [60.0, 0.0, 0.0], 0), ([0.0, 0.0, 27.0], [0.0, 0.0, 60.64], 2)]
        {
            let mut one = among(&boxes, tier);
            one.put(0, place, velocity);
            one.sim.step(&[IDLE], 1).unwrap();
            assert_eq!(one.get(0, "touched"), [1.0], "{tier}");
            let damage = one.get(0, "damage")[0];
            assert!((damage - 0.005 * 35.0).abs() < 1e-5, "{tier}, axis {axis}: {damage}");
            let left = one.velocity(0)[axis];
            assert!((-0.01..=1e-4).contains(&left), "{tier}, axis {axis}: {left} m/s");
            assert_eq!(one.get(0, "friction"), [0.0], "{tier}");
            // No memory of it to jump from.
            let before = one.velocity(0)[2];
            one.sim.step(&[JUMP], 1).unwrap();
            assert!(one.velocity(0)[2] < before, "{tier}, axis {axis}");
        }
        // Pressed on against the wall he falls along it and goes nowhere else.
        let mut one = among(&boxes, tier);
        one.put(0, [9.4, 0.0, 20.0], [0.0; 3]);
        one.set(0, &[("yaw", &[-core::f64::consts::FRAC_PI_2])]);
        one.sim.step(&[RawInput { jet: 0, ..FORWARD }], 20).unwrap();
        let p = one.position(0);
        assert!(p[0] <= 9.5 + 1e-4 && p[2] < 19.0, "{tier}: {p:?}");
    }
}

/// Caught: the engine moves by the mean of the speeds before and after, so its way may lead into a wall that the
/// player already leaves; that contact took from him the speed away from it, as if walls were sticky.
#[test]
fn e04_a_wall_does_not_hold_who_leaves_it() {
    for tier in TIERS {
        let mut one = among(&[([1.0, 40.0, 40.0], [10.5, 0.0, 0.0])], tier);
        one.put(0, [9.499, 0.0, 0.0], [1.0, 0.0, 0.0]);
        one.set(0, &[("touched", &[1.0]), ("friction", &[1.0])]);
        // Friction turns 1 m/s towards the wall into 0.28 m/s away from it.
        one.sim.step(&[RawInput { strafe: -1, ..IDLE }], 1).unwrap();
        let left = one.velocity(0)[0];
        assert!((left + 0.28).abs() < 1e-3, "{tier}: {left} m/s");
        assert!(one.position(0)[0] < 9.5, "{tier}: {:?}", one.position(0));
    }
}

/// From rest gravity makes g dt sin along the slope: below 0.75 m/s a crawler stops and is put back, above he
/// goes. In the engine the limit shrinks with n.up.
#[test]
fn e14_a_crawler_at_0_75_m_s_on_a_slope() {
    fn check<M: Movement, T: Scalar>() {
        // At 50 ms gravity makes 1 m/s: the limits are at sin = 0.75 and tan = 0.75.
        let limit = by_model::<M>(0.75f64.asin(), 0.75f64.atan()).to_degrees();
        for off in [-10.0, -1.0, -0.2, 0.2, 1.0, 10.0] {
            let lab = lab::<M, T>(&slope(limit + off), 50);
            let p: Body<T> = lab.player([0.0; 3], [0.0; 3]);
            let q = lab.tick_as::<M, _>(&p, &Input::idle());
            let stopped = floats(q.velocity) == [0.0; 3];
            let name = format!("{} on {} degrees", form::<M, T>(), limit + off);
            assert!(q.touched && q.crawled, "{name}");
            assert_eq!(stopped, off < 0.0, "{name}: {:?}", q.velocity);
            if stopped {
                assert!(floats(q.position).iter().all(|x| x.abs() < 1e-4), "{name}: {:?}", q.position);
            }
            // Who was faster than a crawl before goes on whatever the speed after.
            let p: Body<T> = lab.player([0.0; 3], [0.0, 0.2, 0.0]);
            let q = lab.tick_as::<M, _>(&p, &Input::idle());
            assert!(!q.crawled && q.velocity.y > T::zero(), "{name}");
        }
    }
    in_every_form!(check);
}

/// Free at 25 m/s, an ulp more costs its share, for every armor.
#[test]
fn e15_a_landing_at_25_m_s() {
    fn check<M: Movement, T: Scalar>() {
        for armor in discjump_core::armor::ARMORS {
            let mut lab = lab::<M, T>(&slope(0.0), 32);
            lab.rules = Rules::new(M::MODEL, armor, false, 32, Physics::default());
            let damage = |speed: f64| {
                // Gravity comes first.
                let mut p: Body<T> = lab.player([0.0, 0.0, 0.01], [0.0; 3]);
                p.velocity.z = T::from_f64(-speed) - lab.rules.fall;
                let q = lab.tick_as::<M, _>(&p, &Input::idle());
                assert!(q.touched, "{}", form::<M, T>());
                q.damage.0.to_f64()
            };
            for speed in [1.0, 24.9, 24.999_99] {
                assert_eq!(damage(speed), 0.0, "{} {}: {speed}", form::<M, T>(), armor.name);
            }
            // At 25 the sum with gravity decides by an ulp.
            assert!(damage(25.0) < 1e-7 && damage(next::<T>(25.0, false)) < 1e-7);
            let scale = if armor.name == "heavy" { 0.006 } else { 0.005 };
            for speed in [25.1, 60.0, 4000.0] {
                let wanted = scale * (speed - 25.0);
                let rounding = digits::<T>(1e-9, 2e-6 * (1.0 + wanted));
                assert!((damage(speed) - wanted).abs() < rounding, "{} {speed}", form::<M, T>());
            }
        }
    }
    in_every_form!(check);
}

/// In a crease the second face hurts as well, in the same tick.
#[test]
fn e15_two_landings_in_one_tick_are_two_damages() {
    fn check<M: Movement, T: Scalar>() {
        let lab = Lab::<T>::of(M::MODEL, &valley(60.0), Physics::default());
        assert_eq!(lab.rules.mass.to_f64(), LIGHT.mass);
        // Straight down beside the crease: 100 m/s have a normal part of 50, and what is left, 100 sin 60 along
        // the face, meets the other one with another sin 60.
        let p: Body<T> = lab.player([0.02, 1.0, lab.ground(0.02, 1.0) + 0.3], [0.0, 0.0, 0.64 - 100.0]);
        let q = lab.tick_as::<M, _>(&p, &Input::idle());
        let (first, second) = (0.005 * (50.0 - 25.0), 0.005 * (75.0 - 25.0));
        let damage = q.damage.0.to_f64();
        // Along the second face 100 sin 60 cos 60 = 43.3 are left, 37.5 of which meet the first again.
        let third = 0.005 * (37.5 - 25.0);
        let wanted = [first + second, first + second + third];
        let near = wanted.iter().any(|w| (damage - w).abs() < 1e-4);
        assert!(near, "{}: {damage}, expected one of {wanted:?}", form::<M, T>());
    }
    in_forms!(check, Sliced, Swept, Fast, Engine);
    // The tiers of the simulator are these forms.
    assert_eq!(ARTICLE.len() + 1, TIERS.len());
}
