//! The exact edges of the rules: energy at 1 and 5, speeds at which something stops.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::*;
use discjump_core::input::Input;
use discjump_core::real::Scalar;
use discjump_core::rules::Physics;
use discjump_core::scene::{Group, Has};
use discjump_core::terrain::{Edge, Heightfield};

/// The neighbours of a number in the tier's own arithmetic, below and above.
fn neighbours<T: Scalar>(x: f64) -> (f64, f64) {
    if T::DOUBLE {
        (x.next_down(), x.next_up())
    } else {
        (f64::from((x as f32).next_down()), f64::from((x as f32).next_up()))
    }
}

/// Whether the jets burn in a tick, and the energy after it.
fn burn<T: Scalar>(energy: f64, burning: bool, key: bool, hysteresis: bool) -> (bool, f64) {
    let lab = Lab::<T>::with(&slope(0.0), Physics { hysteresis, ..Physics::default() });
    let mut p: Body<T> = lab.player([0.0, 0.0, 500.0], [0.0; 3]);
    p.energy.set(T::from_f64(energy));
    p.jetting.set(burning);
    let p = lab.tick(&p, &input(0, 0, false, key, 0));
    let (Has(burns), Has(energy)) = (p.jetting, p.energy);
    // What is reported is what pushed.
    let pushed = p.velocity.z.to_f64() + 0.64 > 0.5;
    assert_eq!(pushed, burns);
    (burns, energy.to_f64())
}

fn energy_thresholds<T: Scalar>() {
    let (below_1, above_1) = neighbours::<T>(1.0);
    let (below_5, above_5) = neighbours::<T>(5.0);
    for (energy, burning, expected) in [
        (1.0, true, false),
        (above_1, true, true),
        (below_1, true, false),
        (5.0, false, true),
        (above_5, false, true),
        (below_5, false, false),
        (3.0, true, true),
        (3.0, false, false),
        (0.0, true, false),
        (60.0, false, true),
    ] {
        assert_eq!(burn::<T>(energy, burning, true, true).0, expected, "energy {energy}, burning {burning}");
        assert!(!burn::<T>(energy, burning, false, true).0, "no key");
        // Without the hysteresis any energy will do.
        assert_eq!(burn::<T>(energy, burning, true, false).0, energy > 0.0);
    }
}

#[test]
fn jets_go_out_at_1_and_light_at_5() {
    energy_thresholds::<f32>();
    energy_thresholds::<f64>();
}

#[test]
fn the_tank_has_a_bottom_and_a_brim() {
    fn check<T: Scalar>() {
        // Drain is 0.8 a tick, recharge 0.256.
        assert_eq!(burn::<T>(0.1, true, true, false), (true, 0.0));
        assert_eq!(burn::<T>(59.9, false, false, true), (false, 60.0));
        assert_eq!(burn::<T>(60.0, false, false, true), (false, 60.0));
        let (_, left) = burn::<T>(30.0, true, true, true);
        assert!((left - (30.0 + 0.256 - 0.8)).abs() < 1e-5);
    }
    check::<f32>();
    check::<f64>();
}

/// A tap of the key below 5 loses the flame for good.
#[test]
fn a_released_key_puts_the_jets_out() {
    let lab = Lab::<f32>::new(&slope(0.0));
    let mut p: Body<f32> = lab.player([0.0, 0.0, 500.0], [0.0; 3]);
    p.energy.set(3.0);
    p.jetting.set(true);
    let keys = [true, true, false, true, true];
    let burns: Vec<bool> = keys
        .iter()
        .map(|&key| {
            p = lab.tick(&p, &input(0, 0, false, key, 0));
            p.jetting.get(false)
        })
        .collect();
    assert_eq!(burns, [true, true, false, false, false]);
}

/// Sideways thrust fades out at 22 m/s exactly: ">" and not ">=", so both give none there.
#[test]
fn sideways_thrust_ends_at_22_m_s() {
    fn sideways<T: Scalar>(speed: f64) -> f64 {
        let lab = Lab::<T>::new(&slope(0.0));
        let p: Body<T> = lab.player([0.0, 0.0, 500.0], [0.0, speed, 0.0]);
        let q = lab.tick(&p, &input(1, 0, false, true, 0));
        q.velocity.y.to_f64() - speed
    }
    fn check<T: Scalar>() {
        let (below, above) = neighbours::<T>(22.0);
        assert_eq!((sideways::<T>(22.0), sideways::<T>(above)), (0.0, 0.0));
        assert!(sideways::<T>(below) >= 0.0 && sideways::<T>(21.9) > 1e-3);
    }
    check::<f32>();
    check::<f64>();
}

/// Landing at 25 m/s is free, and what is beyond costs 0.005 each.
#[test]
fn a_landing_at_25_m_s_is_free() {
    fn damage<T: Scalar>(speed: f64) -> f64 {
        let lab = Lab::<T>::new(&slope(0.0));
        // Gravity's 0.64 m/s come first; the ground is half a metre below.
        let p: Body<T> = lab.player([0.0, 0.0, 0.5], [0.0, 0.0, 0.64 - speed]);
        let q = lab.tick(&p, &Input::idle());
        assert!(q.touched);
        q.damage.get(T::zero()).to_f64()
    }
    fn check<T: Scalar>() {
        assert_eq!(damage::<T>(24.999), 0.0);
        assert!((damage::<T>(26.0) - 0.005).abs() < 1e-6);
        assert!((damage::<T>(157.0) - 0.66).abs() < 1e-5);
    }
    check::<f32>();
    check::<f64>();
}

/// A plane through the origin that falls towards +x by `degrees`, 64 m wide.
fn wall(degrees: f64) -> Heightfield {
    let fall = 8.0 * degrees.to_radians().tan();
    let heights = (0..81).map(|k| -fall * (f64::from(k % 9) - 4.0)).collect();
    Heightfield::new(heights, 9, 9, 8.0, [-32.0, -32.0], Edge::Clamp).unwrap()
}

/// Contacts whose n.up is below 0.2 (78.5 degrees) cannot be jumped from, and still turn and hurt.
#[test]
fn walls_cannot_be_jumped_from() {
    for (degrees, jumpable) in [(78.0, true), (78.4, true), (78.5, false), (85.0, false)] {
        let lab = Lab::<f64>::new(&wall(degrees));
        let p: Body<f64> = lab.player([0.2, 0.0, 0.2], [-30.0, 0.0, 0.0]);
        let q = lab.tick(&p, &Input::idle());
        let age = q.contact().age;
        assert!(q.touched && q.damage.get(0.0) > 0.0, "{degrees}");
        assert_eq!(age == 0, jumpable, "{degrees} degrees: age {age}");
        let jumped = lab.tick(&q, &input(0, 0, true, false, 0));
        let gain = jumped.velocity.z - q.velocity.z;
        assert_eq!(gain > 0.0, jumpable, "{degrees} degrees: gained {gain} m/s");
    }
}

/// The first touch is remembered; a second within a tick only if it is steeper.
#[test]
fn the_steeper_of_two_contacts_is_remembered() {
    for (old_up, expected_new) in [(0.9, false), (0.3, false), (1.0, false)] {
        let lab = Lab::<f64>::new(&slope(0.0));
        let mut p: Body<f64> = lab.player([0.0, 0.0, 0.1], [0.0, 0.0, -10.0]);
        let mut contact = p.contact();
        contact.normal.z = old_up;
        contact.normal.x = f64::sqrt(1.0 - old_up * old_up);
        contact.age = 0;
        p.contact.set(contact);
        let q = lab.tick(&p, &Input::idle());
        assert_eq!(q.contact().normal.z == 1.0, expected_new || old_up == 1.0, "{old_up}");
    }
    // On a slope that is steeper than what is remembered the new normal counts.
    let lab = Lab::<f64>::new(&slope(30.0));
    let mut p: Body<f64> = lab.player([0.0, 0.0, 0.1], [0.0, 0.0, -10.0]);
    let mut contact = p.contact();
    contact.age = 0;
    p.contact.set(contact);
    let q = lab.tick(&p, &Input::idle());
    assert!((q.contact().normal.z - 30f64.to_radians().cos()).abs() < 1e-12 && q.contact().age == 0);
}
