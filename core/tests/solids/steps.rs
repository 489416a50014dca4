//! Stepping up (docs/physics.md, section 5): a low ledge yes, a high one no, and none where there is no room.

use crate::common::solids::{block, built};
use discjump_core::solids::{Placement, Solid};
use glam::DVec3;

/// Light armor: 0.6 of half its height.
const LIFT: f64 = 0.6 * 1.15;

fn floor() -> Solid {
    block([-10.0, -10.0, -1.0], [10.0, 10.0, 0.0])
}

fn ledge(height: f64) -> Solid {
    block([1.0, -10.0, -0.5], [10.0, 10.0, height])
}

/// The lift on the way east, 0.7 m before what stands at x = 1.
fn lift(solids: &[Solid]) -> Option<f64> {
    let solids = built(solids);
    let (feet, path) = (DVec3::new(-0.2, 0.0, 0.0), DVec3::new(1.0, 0.1, 0.0));
    let hit = solids.sweep_box(feet, path, 0.5, 2.3).expect("something in the way");
    assert!(hit.normal.z < 0.2 && (hit.fraction - 0.7).abs() < 1e-6, "{hit:?}");
    let lift = solids.step_up(feet, path, 0.5, 2.3, LIFT, &hit)?;
    // What was promised: the box is free there, and goes on.
    let up = feet + path * hit.fraction + DVec3::new(0.0, 0.0, lift);
    assert_eq!(solids.overlap(up, 0.5, 2.3), None);
    assert_eq!(solids.sweep_box(up, path * 0.01, 0.5, 2.3), None);
    Some(lift)
}

#[test]
fn low_ledges_are_stepped_up_on() {
    for height in [0.01, 0.1, 0.4, 0.68] {
        let got = lift(&[floor(), ledge(height)]).expect("a low ledge");
        assert!((got - height - 1e-3).abs() < 1e-6, "{height}: {got}");
    }
}

#[test]
fn high_ledges_are_not() {
    for height in [0.7, 1.0, 10.0] {
        assert_eq!(lift(&[floor(), ledge(height)]), None, "{height}");
    }
}

#[test]
fn no_step_where_there_is_no_room() {
    // Above the box now, above the ledge, and both far enough.
    let above = |low: f64, x: f64| block([x, -10.0, low], [x + 5.0, 10.0, low + 1.0]);
    assert_eq!(lift(&[floor(), ledge(0.4), above(2.5, -4.5)]), None);
    assert_eq!(lift(&[floor(), ledge(0.4), above(2.5, 1.001)]), None);
    assert!(lift(&[floor(), ledge(0.4), above(2.8, -4.5), above(2.8, 1.001)]).is_some());
    // Room for the lift that the ledge needs, though not for the largest one.
    assert!(lift(&[floor(), ledge(0.1), above(2.45, -4.5), above(2.45, 1.001)]).is_some());
}

#[test]
fn steep_tops_are_not_stepped_up_on() {
    // From a lip 0.2 m high up at 60 degrees (n.up 0.5), and at 30 (0.87).
    for (rise, stepped) in [(3.0f64.sqrt(), false), (1.0 / 3.0f64.sqrt(), true)] {
        let profile = [(1.0, -0.5), (1.0, 0.2), (3.0, 0.2 + 2.0 * rise), (3.0, -0.5)];
        let points = profile.iter().flat_map(|&(x, z)| [DVec3::new(x, -5.0, z), DVec3::new(x, 5.0, z)]);
        let ramp = Solid::hull("ramp", points.collect(), Placement::default());
        assert_eq!(lift(&[floor(), ramp]).is_some(), stepped);
    }
}
