//! Items 9 to 13: contacts in a row, the jump window, energy, sideways thrust, friction's cap.

use crate::common::lab::*;
use crate::common::slope;
use crate::{by_model, form, lab, next};
use discjump_core::armor::LIGHT;
use discjump_core::input::Input;
use discjump_core::movement::Movement;
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::{Model, Physics, Rules};
use discjump_core::scene::Group;

const AIR: [f64; 3] = [0.0, 0.0, 500.0];

/// A second contact within a tick of the first is remembered if it is steeper, in the engine if it is flatter; later
/// any is.
#[test]
fn e09_the_steeper_or_the_flatter_of_two_contacts() {
    fn check<M: Movement, T: Scalar>() {
        let engine = M::MODEL == Model::Engine;
        for degrees in [0.0f64, 30.0] {
            let lab = lab::<M, T>(&slope(degrees), 32);
            let up = degrees.to_radians().cos();
            let one = if engine { 1 } else { 32 };
            for (old_up, age) in
                [(0.3, 0), (0.95, 0), (0.3, one), (0.95, one), (0.3, 2 * one), (0.95, 2 * one)]
            {
                let mut p: Body<T> = lab.player([0.0, 0.0, 0.05], [0.0, 0.0, -10.0]);
                let mut contact = p.contact();
                contact.normal =
                    V3::new(T::from_f64(f64::sqrt(1.0 - old_up * old_up)), T::zero(), T::from_f64(old_up));
                contact.age = age;
                p.contact.set(contact);
                let q = lab.tick_as::<M, _>(&p, &Input::idle());
                let what = format!("{}: {old_up} then {up}, age {age}", form::<M, T>());
                assert!(q.touched, "{what}");
                let remembered = (q.contact().normal.z.to_f64() - up).abs() < 1e-6;
                // The age is counted before the contact in the article's order, after it in the engine's.
                let older = if engine { age > 1 } else { age + 32 > 32 };
                let preferred = if engine { up > old_up } else { up < old_up };
                assert_eq!(remembered, older || preferred, "{what}: {:?}", q.contact());
                let fresh = if engine { 1 } else { 0 };
                assert_eq!(q.contact().age == fresh, remembered || age == 0 && engine, "{what}");
            }
        }
    }
    in_every_form!(check);
}

/// Jumps at ages below 256 ms, in the engine below 8 ticks, and at no other.
#[test]
fn e10_the_jump_window_ends_at_256_ms_or_8_ticks() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        let edge = by_model::<M>(256.0, 8.0) as i32;
        for age in [0, 1, 7, 8, 9, 31, 32, 224, 255, 256, 257, 1 << 30] {
            let mut p: Body<T> = lab.player(AIR, [0.0; 3]);
            let mut contact = p.contact();
            contact.age = age;
            p.contact.set(contact);
            let q = lab.tick_as::<M, _>(&p, &input(0, 0, true, false, 0));
            assert_eq!(q.velocity.z > T::zero(), age < edge, "{}: age {age}", form::<M, T>());
            // At once expired, and counted on; and the oldest does not run over.
            let counted = by_model::<M>(32.0, 1.0) as i32;
            let expected = if age < edge { edge + counted } else { (age + counted).min(1 << 30) };
            assert_eq!(q.contact().age, expected, "{}: age {age}", form::<M, T>());
        }
    }
    in_every_form!(check);
}

/// A player in the air with so much energy, one tick later: whether he burns, and what is left.
fn burn<M: Movement, T: Scalar>(physics: Physics, pack: bool, energy: f64, burning: bool) -> (bool, f64) {
    let mut lab = lab::<M, T>(&slope(0.0), 32);
    lab.rules = Rules::new(M::MODEL, &LIGHT, pack, 32, physics);
    let mut p: Body<T> = lab.player(AIR, [0.0; 3]);
    p.energy.set(T::from_f64(energy));
    p.jetting.set(burning);
    let q = lab.tick_as::<M, _>(&p, &input(0, 0, false, true, 0));
    let pushed = q.velocity.z > T::zero();
    assert_eq!(pushed, q.jetting.get(false), "{}: what is reported is what pushed", form::<M, T>());
    (pushed, q.energy.get(T::zero()).to_f64())
}

/// Out at 1, lit at 5, at the very numbers and an ulp beside them; without hysteresis at anything above 0.
#[test]
fn e11_energy_at_0_1_5_and_full() {
    fn check<M: Movement, T: Scalar>() {
        let (bare, kept) = (Physics { hysteresis: false, ..Physics::default() }, Physics::default());
        for burning in [false, true] {
            let edge = if burning { 1.0 } else { 5.0 };
            for energy in [0.0, 0.4, next::<T>(edge, false), edge, next::<T>(edge, true), 3.0, 59.9, 60.0] {
                let lit = if burning { energy > 1.0 } else { energy >= 5.0 };
                let what = format!("{}: {energy}, burning {burning}", form::<M, T>());
                let (burns, left) = burn::<M, T>(kept, false, energy, burning);
                assert_eq!(burns, lit, "{what}");
                let expected = (energy + 0.256 - if lit { 0.8 } else { 0.0 }).clamp(0.0, 60.0);
                assert!((left - expected).abs() < 1e-5 && (0.0..=60.0).contains(&left), "{what}: {left}");
                // Less than a tick's drain burns too, and leaves nothing.
                let (burns, left) = burn::<M, T>(bare, false, energy, burning);
                assert_eq!(burns, energy > 0.0, "{what}");
                assert!((0.0..=60.0).contains(&left), "{what}: {left}");
            }
        }
        assert_eq!(burn::<M, T>(bare, false, 0.2, false), (true, 0.0), "{}", form::<M, T>());
    }
    in_every_form!(check);
}

/// The engine's pack is served before the jets ask: it lights them a little earlier. In the article all of the
/// recharge comes after.
#[test]
fn e11_the_pack_comes_before_the_question_in_the_engine() {
    fn check<M: Movement, T: Scalar>() {
        let lights = |energy: f64| burn::<M, T>(Physics::default(), true, energy, false).0;
        assert_eq!(lights(4.95), by_model::<M>(0.0, 1.0) == 1.0, "{}", form::<M, T>());
        assert!(!lights(4.9) && lights(5.0), "{}", form::<M, T>());
        // What the pack adds is 0.096 a tick, burning or not, and a full tank takes nothing.
        let (_, with) = burn::<M, T>(Physics::default(), true, 30.0, true);
        let (_, without) = burn::<M, T>(Physics::default(), false, 30.0, true);
        assert!((with - without - 0.096).abs() < 1e-5, "{}: {with} {without}", form::<M, T>());
        assert!(burn::<M, T>(Physics::default(), true, 60.0, true).1 <= 60.0);
    }
    in_every_form!(check);
}

/// 0.8 up to 4.4 m/s, then down in a line to nothing at 22 m/s exactly, and never less.
#[test]
fn e12_sideways_thrust_at_its_corners() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        let gain = |speed: f64| {
            let p: Body<T> = lab.player(AIR, [3.0, speed, 0.0]);
            lab.tick_as::<M, _>(&p, &input(1, 0, false, true, 0)).velocity.y.to_f64() - speed
        };
        let thrust = 236.0 / 9.0 * 0.032;
        for speed in [-1e6, -30.0, 0.0, next::<T>(0.0, true), next::<T>(0.0, false), 4.4, 13.2, 21.9] {
            let share = (1.0 - speed / 22.0).clamp(0.0, 0.8);
            let rounding = 1e-5 + 1e-7 * f64::abs(speed);
            assert!((gain(speed) - share * thrust).abs() < rounding, "{}: {speed} m/s", form::<M, T>());
        }
        for speed in [22.0, next::<T>(22.0, true), 23.0, 1e6] {
            assert_eq!(gain(speed), 0.0, "{}: {speed} m/s", form::<M, T>());
        }
        assert!(gain(next::<T>(22.0, false)) >= 0.0, "{}", form::<M, T>());
    }
    in_every_form!(check);
}

/// Friction that reaches the wish exactly is crawling, a hair more is not; without memory there is none; and
/// from a third of the memory on there is no more.
#[test]
fn e13_friction_at_its_cap() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        let cap = lab.rules.grip.to_f64();
        assert!((cap - 1.28).abs() < 1e-6);
        let after = |speed: f64, memory: f64, forward: i8| {
            let mut p: Body<T> = lab.player(AIR, [0.0, speed, 0.0]);
            (p.touched, p.friction) = (true, T::from_f64(memory));
            let q = lab.tick_as::<M, _>(&p, &input(forward, 0, false, false, 0));
            (q.velocity.y.to_f64(), q.crawled)
        };
        let name = form::<M, T>();
        assert_eq!(after(cap, 1.0, 0), (0.0, true), "{name}: exactly the cap");
        let (left, crawled) = after(next::<T>(cap, true), 1.0, 0);
        assert!((0.0..1e-6).contains(&left) && !crawled, "{name}: a hair more leaves {left}");
        assert_eq!(after(next::<T>(cap, false), 1.0, 0), (0.0, true), "{name}: a hair less");
        assert_eq!(after(11.0, 1.0, 1), (11.0, true), "{name}: the wish itself");
        assert_eq!(after(11.0, 0.0, 1), (11.0, true), "{name}: the wish itself, without grip");
        assert_eq!(after(0.0, 0.0, 0), (0.0, true), "{name}: nothing of nothing");
        assert_eq!(after(5.0, 0.0, 0), (5.0, false), "{name}: no memory, no friction");
        let third = T::from_f64(1.0 / 3.0).to_f64();
        for (memory, share) in [(third / 2.0, 0.5), (next::<T>(third, false), 1.0), (third, 1.0), (1.0, 1.0)]
        {
            let (left, crawled) = after(20.0, memory, 0);
            assert!((20.0 - left - share * 1.28).abs() < 1e-5 && !crawled, "{name}: {memory} leaves {left}");
        }
        let (left, _) = after(20.0, next::<T>(third, true), 0);
        assert_eq!(left, after(20.0, 1.0, 0).0, "{name}: no more than all");
    }
    in_every_form!(check);
}
