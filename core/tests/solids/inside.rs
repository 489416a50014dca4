//! Boxes that start inside solids: pushed out the shortest way, and never held back on it.

use crate::common::random::Random;
use crate::common::solids::{block, built};
use discjump_core::solids::{Placement, Solid};
use glam::{DQuat, DVec3};

#[test]
fn a_thin_plate_through_the_box_lets_it_out_the_nearer_way() {
    let solids = built(&[block([-5.0, -5.0, 1.0], [5.0, 5.0, 1.001])]);
    let sweep =
        |z: f64, path: f64| solids.sweep_box(DVec3::new(0.0, 0.0, z), DVec3::new(0.0, 0.0, path), 0.5, 2.3);
    // Its middle above the plate: out upwards, and pushed that way when it moves down.
    assert_eq!(sweep(0.5, 0.1), None);
    let hit = sweep(0.5, -0.1).unwrap();
    assert_eq!((hit.fraction, hit.normal), (0.0, DVec3::Z));
    // And below it.
    assert_eq!(sweep(-0.8, -0.1), None);
    let hit = sweep(-0.8, 0.1).unwrap();
    assert_eq!((hit.fraction, hit.normal), (0.0, DVec3::NEG_Z));
}

#[test]
fn a_box_within_a_solid_leaves_it_freely() {
    let solids = built(&[block([-20.0, -20.0, -20.0], [20.0, 20.0, 20.0])]);
    assert_eq!(solids.overlap(DVec3::ZERO, 0.5, 2.3), Some(0));
    let mut random = Random::new(20);
    for _ in 0..1000 {
        let path = 100.0 * DVec3::new(random.wide(), random.wide(), random.wide());
        assert_eq!(solids.sweep_box(DVec3::ZERO, path, 0.5, 2.3), None);
    }
}

/// The response of docs/physics.md for a contact at once is a push along the normal: repeated, it gets everyone out of
/// every convex solid that is thinner than his box, or in which he is not deep, and no step is ever refused for ever.
#[test]
fn pushes_free_whoever_overlaps() {
    let mut random = Random::new(21);
    let mut pushed = 0;
    for _ in 0..400 {
        let rotation =
            DQuat::from_xyzw(random.wide(), random.wide(), random.wide(), random.wide()).normalize();
        let size = DVec3::new(random.within(0.01, 3.0), random.within(0.01, 3.0), random.within(0.01, 3.0));
        let placement = Placement { rotation, ..Placement::default() };
        let solid = Solid::new("block", discjump_core::solids::Shape::Box { size }, placement);
        let solids = built(&[solid]);
        let mut feet = DVec3::new(random.wide(), random.wide(), -1.15 + random.wide());
        if solids.overlap(feet, 0.5, 2.3).is_none() {
            continue;
        }
        pushed += 1;
        let mut velocity = 5.0 * DVec3::new(random.wide(), random.wide(), random.wide());
        for tick in 0.. {
            velocity.z -= 0.64;
            let path = velocity * 0.032;
            match solids.sweep_box(feet, path, 0.5, 2.3) {
                Some(hit) => {
                    let impact = -velocity.dot(hit.normal) + 0.001;
                    feet += path * hit.fraction + hit.normal * (impact * 0.032);
                    velocity += hit.normal * impact;
                }
                None => feet += path,
            }
            assert!(feet.is_finite() && velocity.is_finite());
            if solids.overlap(feet, 0.5, 2.3).is_none() {
                break;
            }
            assert!(tick < 400, "still inside {size:?} {rotation:?} at {feet:?}, {velocity:?}");
        }
    }
    assert!(pushed > 200, "{pushed}");
}
