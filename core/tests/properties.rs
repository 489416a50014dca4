//! What must hold of every tick, whatever the terrain, the state and the keys.
#![allow(missing_docs)]

mod common;

use common::draws::*;
use common::lab::*;
use discjump_core::movement::{Anyway, Engine, Fast, Movement, Sliced, Swept};
use discjump_core::real::Scalar;
use discjump_core::rules::Physics;
use discjump_core::scene::Has;
use discjump_core::terrain::{Heightfield, SurfaceKind};
use proptest::prelude::*;

/// How deep an unswept fix-up may dip, m: a slice down one face of a pit ends 2 sin(slope) slices under the
/// opposite one.
const DIP: f64 = 2.0;

fn check_invariants<M: Movement, T: Scalar>(
    terrain: &Heightfield,
    (mut place, velocity, yaw): Start,
    keys: &[Keys],
    deepest: f64,
) -> Result<(), TestCaseError> {
    let lab = Lab::<T>::of(M::MODEL, terrain, Physics::default());
    place[2] += lab.ground(place[0], place[1]);
    let mut p: Body<T> = lab.player(place, velocity);
    p.yaw = T::from_f64(yaw);
    let speed = |p: &Body<T>| floats(p.velocity).iter().map(|v| v * v).sum::<f64>().sqrt();
    // Gravity, jets, jump, walking, and the outward push of four contacts.
    let gain = 20.0 * 0.032 + 236.0 / 9.0 * 0.032 + 75.0 / 9.0 + 360.0 / 9.0 * 0.032 + 4.0 * 0.001;
    for &(forward, strafe, jump, jet, turn) in keys {
        for _ in 0..10 {
            let before = p;
            p = lab.tick_as::<M, _>(&p, &input(forward, strafe, jump, jet, turn));
            prop_assert!(numbers(&p).iter().all(|x| x.is_finite()), "{before:?} {p:?}");
            let deep = lab.clearance(&p);
            prop_assert!(deep >= -deepest, "{deep} m below: {before:?} {p:?}");
            let (Has(energy), Has(damage), Has(old)) = (p.energy, p.damage, before.damage);
            prop_assert!((0.0..=60.0).contains(&energy.to_f64()));
            prop_assert!(damage >= old && old >= T::zero());
            prop_assert!((0.0..=1.0).contains(&p.friction.to_f64()));
            prop_assert!(
                p.yaw.to_f64().abs() <= core::f64::consts::PI + 1e-6 && p.pitch.to_f64().abs() < 1.54
            );
            prop_assert!(speed(&p) <= speed(&before) + gain + 1e-4, "{before:?} {p:?}");
            prop_assert!((-64.0..64.0).contains(&p.position.x.to_f64()));
            prop_assert!((-64.0..64.0).contains(&p.position.y.to_f64()));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_tick_leaves_a_possible_player(seed in 0..1000u64, start in start(), keys in keys()) {
        let terrain = rough(seed);
        check_invariants::<Sliced, f32>(&terrain, start, &keys, 1e-3)?;
        check_invariants::<Sliced, f64>(&terrain, start, &keys, 1e-9)?;
        check_invariants::<Fast, f32>(&terrain, start, &keys, 1e-3)?;
        check_invariants::<Fast, f64>(&terrain, start, &keys, 1e-9)?;
    }

    /// On bilinear ground as on triangles.
    #[test]
    fn every_tick_on_bilinear_ground_too(seed in 0..1000u64, start in start(), keys in keys()) {
        let terrain = rough(seed).with_surface(SurfaceKind::Bilinear);
        check_invariants::<Sliced, f32>(&terrain, start, &keys, 1e-3)?;
        check_invariants::<Sliced, f64>(&terrain, start, &keys, 1e-9)?;
        check_invariants::<Fast, f32>(&terrain, start, &keys, 1e-3)?;
        check_invariants::<Fast, f64>(&terrain, start, &keys, 1e-9)?;
        check_invariants::<Swept, f32>(&terrain, start, &keys, DIP)?;
        check_invariants::<Engine, f32>(&terrain, start, &keys, f64::MAX)?;
    }

    /// `swept` dips in steep pits. `anyway` falls through them, and so may a sphere whose centre gets
    /// below the plane of a neighbouring face.
    #[test]
    fn every_tick_of_the_other_tiers_too(seed in 0..1000u64, start in start(), keys in keys()) {
        let terrain = rough(seed);
        check_invariants::<Swept, f32>(&terrain, start, &keys, DIP)?;
        check_invariants::<Engine, f32>(&terrain, start, &keys, f64::MAX)?;
        check_invariants::<Engine, f64>(&terrain, start, &keys, f64::MAX)?;
        check_invariants::<Anyway, f64>(&terrain, start, &keys, f64::MAX)?;
    }
}
