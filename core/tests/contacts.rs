//! The fine print of contacts (docs/physics.md, sections 4.4 and 5), on numbers that are exact.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::*;
use discjump_core::input::Input;
use discjump_core::real::{Scalar, V3};
use discjump_core::terrain::{Edge, Heightfield};

/// A sweep over flat ground at height 0, or over a plane that rises by 1 in 2 towards +x.
fn sweep<T: Scalar>(rising: bool, start: [f64; 3], path: [f64; 3]) -> Option<f64> {
    let heights = (0..25).map(|k| if rising { 4.0 * (f64::from(k % 5) - 2.0) } else { 0.0 }).collect();
    let lab = Lab::<T>::new(&Heightfield::new(heights, 5, 5, 8.0, [-16.0; 2], Edge::Clamp).unwrap());
    let v = |a: [f64; 3]| V3::new(T::from_f64(a[0]), T::from_f64(a[1]), T::from_f64(a[2]));
    let hit = lab.maps.surface::<T>().sweep::<T>(0, v(start), v(path), true);
    hit.hit.then(|| hit.fraction.to_f64())
}

fn sweeps_at_their_edges<T: Scalar>() {
    for (start, path, expected) in [
        // It ends on the ground: no contact. A hair longer: one.
        ([1.0, 2.0, 1.0], [0.0, 0.0, -1.0], None),
        ([1.0, 2.0, 1.0], [0.0, 0.0, -1.000_001], Some(1.0 / 1.000_001)),
        ([1.0, 2.0, 1.0], [5.0, 3.0, -1.0], None),
        ([1.0, 2.0, 1.0], [5.0, 3.0, -2.0], Some(0.5)),
        // It begins on the ground.
        ([1.0, 2.0, 0.0], [0.0, 0.0, -1.0], Some(0.0)),
        ([1.0, 2.0, 0.0], [3.0, 0.0, -1.0], Some(0.0)),
        ([1.0, 2.0, 0.0], [3.0, 0.0, 0.0], None),
        ([1.0, 2.0, 0.0], [0.0, 0.0, 1.0], None),
        // It begins below: level and upward paths leave it alone.
        ([1.0, 2.0, -3.0], [20.0, 0.0, 0.0], None),
        ([1.0, 2.0, -3.0], [20.0, 0.0, 9.0], None),
        ([1.0, 2.0, -3.0], [2.0, 0.0, -0.5], Some(0.0)),
        // No path at all.
        ([1.0, 2.0, -3.0], [0.0, 0.0, 0.0], None),
    ] {
        let got = sweep::<T>(false, start, path);
        let same = match (got, expected) {
            (Some(a), Some(b)) => (a - b).abs() < 1e-6,
            (a, b) => a.is_none() && b.is_none(),
        };
        assert!(same, "{start:?} {path:?}: {got:?}, expected {expected:?}");
    }
    for (start, path, expected) in [
        // Along the rising plane, on it and below it.
        ([1.0, 2.0, 0.5], [4.0, 1.0, 2.0], None),
        ([1.0, 2.0, -0.5], [4.0, 1.0, 2.0], None),
        // Into it, from below, though upwards.
        ([1.0, 2.0, -0.5], [4.0, 0.0, 1.0], Some(0.0)),
        ([1.0, 2.0, 1.5], [4.0, 0.0, 0.0], Some(0.5)),
    ] {
        assert_eq!(sweep::<T>(true, start, path), expected, "{start:?} {path:?}");
    }
}

#[test]
fn a_path_that_only_just_reaches_the_ground_does_not_meet_it() {
    sweeps_at_their_edges::<f32>();
    sweeps_at_their_edges::<f64>();
}

/// A player who crawls and is slow after a bounce goes back to where this bump's slices began, and stops
/// there: one who drops from a metre above without wishing to go anywhere hangs where he was.
fn the_stop_rule<T: Scalar>() {
    let lab = Lab::<T>::new(&slope(0.0));
    let drop = |touched: bool, sideways: f64| {
        let mut p: Body<T> = lab.player([0.0, 0.0, 1.0], [sideways, 0.0, -39.36]);
        (p.touched, p.friction) = (touched, T::from_f64(1.0));
        lab.tick(&p, &Input::idle())
    };
    // Gravity makes it 40 m/s: two slices of 0.64 m, the second of which hits.
    let stopped = drop(true, 0.0);
    assert_eq!((floats(stopped.position), floats(stopped.velocity)), ([0.0, 0.0, 1.0], [0.0; 3]));
    // The friction cap is 1.28 m/s a tick: what it takes away counts as crawling, more does not.
    assert_eq!(floats(drop(true, 1.2).velocity), [0.0; 3]);
    let fast = drop(true, 2.5);
    assert!((fast.velocity.x.to_f64() - 1.22).abs() < 1e-6 && fast.position.z.to_f64() < 0.5);
    // Without the touch before there is no friction, and no crawling at 40 m/s.
    let bounced = drop(false, 0.0);
    assert!(bounced.velocity.z.to_f64() > 0.0 && bounced.position.z.to_f64() < 0.5);
}

#[test]
fn a_crawler_stops_where_his_slices_began() {
    the_stop_rule::<f32>();
    the_stop_rule::<f64>();
}

/// 0.6 of the memory remains from contact to contact, n.up if that is more, and nothing in the air.
fn friction_memory<T: Scalar>() {
    let after = |degrees: f64, height: f64, memory: f64| {
        let lab = Lab::<T>::new(&slope(degrees));
        let mut p: Body<T> = lab.player([0.0, 0.0, height], [0.0, 0.0, -20.0]);
        p.friction = T::from_f64(memory);
        let p = lab.tick(&p, &Input::idle());
        assert_eq!(p.touched, height < 1.0);
        p.friction.to_f64()
    };
    for (degrees, height, memory, expected) in [
        (0.0, 0.1, 0.0, 1.0),
        (0.0, 0.1, 1.0, 1.0),
        (70.0, 0.1, 0.0, 70f64.to_radians().cos()),
        (70.0, 0.1, 1.0, 0.6),
        (70.0, 0.1, 0.3, 70f64.to_radians().cos()),
        (70.0, 100.0, 1.0, 0.0),
    ] {
        let got = after(degrees, height, memory);
        assert!((got - expected).abs() < 1e-6, "{degrees} degrees, {memory} before: {got}");
    }
}

#[test]
fn friction_remembers_contacts_and_forgets_in_the_air() {
    friction_memory::<f32>();
    friction_memory::<f64>();
}
