//! Items 1 to 4: moves of no length, of whole slices, from the surface and along it.

use crate::common::lab::*;
use crate::common::slope;
use crate::{by_model, digits, form, lab};
use discjump_core::armor::{ENGINE_STEP, SLICE};
use discjump_core::input::Input;
use discjump_core::movement::Movement;
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::Model;

/// The velocity at which gravity takes away the whole of a tick's way; the engine makes the mean of the
/// speeds before and after.
fn standstill<M: Movement, T: Scalar>(lab: &Lab<T>) -> T {
    -lab.rules.fall * T::lit(by_model::<M>(1.0, 0.5))
}

/// No way is no slice, and no division by their number: the player stays where he is to the last bit, on the
/// ground, under it and in the air, and nothing is touched.
#[test]
fn e01_nothing_to_move_is_no_contact() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        for z in [0.0, -0.375, 7.25] {
            let mut p: Body<T> = lab.player([3.0, 2.0, z], [0.0; 3]);
            p.velocity.z = standstill::<M, T>(&lab);
            p.friction = T::lit(0.5);
            let q = lab.tick_as::<M, _>(&p, &Input::idle());
            // `fast` holds the end of every tick on or above the ground.
            let fast = core::any::type_name::<M>().ends_with("Fast");
            let expected = if fast { z.max(0.0) } else { z };
            assert_eq!(floats(q.position), [3.0, 2.0, expected], "{}", form::<M, T>());
            let left = by_model::<M>(0.0, 0.5) * lab.rules.fall.to_f64();
            assert_eq!(floats(q.velocity), [0.0, 0.0, left], "{}", form::<M, T>());
            assert!(!q.touched && q.damage.0 == T::zero(), "{}", form::<M, T>());
            // Friction's memory: forgotten without a contact, by the engine not at once.
            assert_eq!(q.friction.to_f64(), T::lit(by_model::<M>(0.0, 0.3)).to_f64(), "{}", form::<M, T>());
        }
    }
    in_every_form!(check);
}

/// Who was stopped stays so, tick by tick, to the last bit.
#[test]
fn e01_a_stopped_player_never_stirs() {
    fn check<M: Movement, T: Scalar>() {
        for degrees in [0.0, 20.0] {
            let lab = lab::<M, T>(&slope(degrees), 32);
            let mut p: Body<T> = lab.player([1.0, 2.0, lab.ground(1.0, 2.0)], [0.0; 3]);
            (0..50).for_each(|_| p = lab.tick_as::<M, _>(&p, &Input::idle()));
            let rest = p.position;
            assert_eq!(floats(p.velocity), [0.0; 3], "{} on {degrees} degrees", form::<M, T>());
            for _ in 0..200 {
                p = lab.tick_as::<M, _>(&p, &Input::idle());
                assert_eq!(floats(p.position), floats(rest), "{} on {degrees} degrees", form::<M, T>());
                assert_eq!(floats(p.velocity), [0.0; 3]);
            }
        }
    }
    // `anyway` makes the slice that hits, and `fast` puts the second contact where the move ends.
    in_forms!(check, Sliced, Engine);
}

/// A hair over a whole number of slices is a slice more. Either number gives the place that its slices give:
/// the whole ones before the contact, and the rest of the tick at the speed after it.
#[test]
fn e02_a_hair_over_whole_slices() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        let longest = by_model::<M>(SLICE, ENGINE_STEP);
        let push = by_model::<M>(0.001, 0.0001);
        for whole in 1..=6u32 {
            let (height, dt) = (0.55 * f64::from(whole) * longest, 0.032);
            let mut seen = [false; 2];
            for ulps in -40..=40 {
                let metres = f64::from(whole) * longest * (1.0 + f64::from(ulps) * digits::<T>(1e-16, 5e-8));
                // What the tick begins with, so that it moves so far.
                let speed = metres / dt - by_model::<M>(0.64, 0.32);
                let p: Body<T> = lab.player([0.0, 0.0, height], [0.0, 0.0, -speed]);
                let z = lab.tick_as::<M, _>(&p, &Input::idle()).position.z.to_f64();
                let place = |count: u32| {
                    let slice = metres / f64::from(count);
                    let made = (height / slice).floor();
                    height - made * slice + push * dt * (1.0 - made / f64::from(count))
                };
                let same = |count: u32| (z - place(count)).abs() < digits::<T>(1e-9, 1e-5);
                assert!(same(whole) || same(whole + 1), "{}: {metres} m end at {z}", form::<M, T>());
                seen[0] |= same(whole);
                seen[1] |= same(whole + 1);
            }
            assert_eq!(seen, [true; 2], "{}: {whole} slices", form::<M, T>());
        }
    }
    in_every_form!(check);
}

/// A contact at once charges nothing before it: on the ground and under it the fall is over, and what
/// brings a player up again is the form's own.
#[test]
fn e03_a_start_on_or_under_the_surface() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        let name = form::<M, T>();
        let push = by_model::<M>(0.001, 0.0001);
        // The engine's sphere is no longer held once its middle is at the surface.
        for depth in [0.0, 0.3, 0.9] {
            let p: Body<T> = lab.player([0.0, 0.0, -depth], [0.0, 0.0, -4.36]);
            let q = lab.tick_as::<M, _>(&p, &Input::idle());
            let z = q.position.z.to_f64();
            // Swept pushes by the slice (the whole tick: it is 0.16 m) of what the ground took.
            let up = if name.contains("Swept") { 5.0 * 0.032 } else { push * 0.032 };
            let expected = if name.contains("Fast") { (up - depth).max(0.0) } else { up - depth };
            assert!((z - expected).abs() < 1e-4, "{name}, {depth} m: {z}, not {expected}");
            assert!(q.touched && (q.velocity.z.to_f64() - push).abs() < 1e-6, "{name}, {depth} m: {q:?}");
        }
    }
    in_every_form!(check);
}

/// Contacts at the end of a slice belong to it or to the next one, and the end of the move is no contact or
/// one: never anything else, and never below the ground.
#[test]
fn e03_a_contact_at_the_very_end_of_a_slice() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        let slice = by_model::<M>(1.0, 0.3);
        for made in 0..=4 {
            // Four slices a tick; the ground is at the end of one of them.
            let speed = 4.0 * slice / 0.032 - by_model::<M>(0.64, 0.32);
            let height = slice * f64::from(made);
            let p: Body<T> = lab.player([0.0, 0.0, height], [0.0, 0.0, -speed]);
            let z = lab.tick_as::<M, _>(&p, &Input::idle()).position.z.to_f64();
            let off = [0.0, slice, 0.8 * slice, 1.6 * slice].map(|end| (z - end).abs());
            let near = off.into_iter().fold(f64::MAX, f64::min);
            let what = form::<M, T>();
            assert!(near < 1e-3 && z > -1e-5, "{what}: {height} m above the ground, ends at {z}");
        }
    }
    in_forms!(check, Sliced, Fast, Anyway, Engine);
}

/// Along a face, or out of it: no contact, no damage, and the velocity keeps its bits.
#[test]
fn e04_parallel_and_leaving_are_no_contacts() {
    fn check<M: Movement, T: Scalar>() {
        let lab = lab::<M, T>(&slope(0.0), 32);
        let name = form::<M, T>();
        for (z, rise) in [(0.0, 0.0), (0.0, 2.0), (-0.3, 0.0), (-0.3, 2.0), (-1.0, 30.0)] {
            let mut p: Body<T> = lab.player([0.0, 0.0, z], [40.0, 3.0, 0.0]);
            p.velocity.z = T::from_f64(rise) + standstill::<M, T>(&lab);
            let q = lab.tick_as::<M, _>(&p, &Input::idle());
            let engine = M::MODEL == Model::Engine;
            // In the engine an overlap alone is a touch; the velocity may still point down by half of gravity.
            if engine && rise == 0.0 {
                continue;
            }
            assert_eq!(q.touched, engine && z < 0.0, "{name} at {z}, rising {rise}");
            let kept = p.velocity + V3::new(T::zero(), T::zero(), lab.rules.fall);
            assert_eq!(floats(q.velocity), floats(kept), "{name} at {z}, rising {rise}");
            assert_eq!(q.damage.0, T::zero());
        }
    }
    in_every_form!(check);
}
