//! Boxes that start inside solids: pushed out the shortest way, and never held back on it.

use crate::common::random::Random;
use crate::common::solids::{block, built};
use discjump_core::solids::{Placement, Shape, Solid};
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

/// Contacts at once push along their normals: whoever goes where he is pushed comes out of every convex solid, and
/// nobody is held.
#[test]
fn pushes_free_whoever_overlaps() {
    let mut random = Random::new(21);
    let mut pushed = 0;
    for _ in 0..2000 {
        let rotation =
            DQuat::from_xyzw(random.wide(), random.wide(), random.wide(), random.wide()).normalize();
        let size = DVec3::new(random.within(0.01, 3.0), random.within(0.01, 3.0), random.within(0.01, 3.0));
        let placement = Placement { rotation, ..Placement::default() };
        let solids = built(&[Solid::new("block", Shape::Box { size }, placement)]);
        let mut feet = DVec3::new(random.wide(), random.wide(), -1.15 + random.wide());
        if solids.overlap(feet, 0.5, 2.3).is_none() {
            continue;
        }
        pushed += 1;
        let mut velocity = 5.0 * DVec3::new(random.wide(), random.wide(), random.wide()).normalize();
        let mut ticks = 0;
        while solids.overlap(feet, 0.5, 2.3).is_some() {
            ticks += 1;
            assert!(ticks < 100, "still inside {size:?} {rotation:?} at {feet:?}, {velocity:?}");
            let mut left = 0.032;
            for _ in 0..4 {
                let path = velocity * left;
                let Some(hit) = solids.sweep_box(feet, path, 0.5, 2.3) else {
                    feet += path;
                    break;
                };
                feet += path * hit.fraction;
                left *= 1.0 - hit.fraction;
                velocity += hit.normal * (5.0 - velocity.dot(hit.normal));
            }
        }
    }
    assert!(pushed > 1000, "{pushed}");
}

/// Bigger than the player's box and turned: he is anywhere in it, and leaves it through whichever side he wants.
#[test]
fn every_straight_way_out_of_a_solid_is_open_or_pushed_aside() {
    let mut random = Random::new(22);
    for _ in 0..500 {
        let rotation =
            DQuat::from_xyzw(random.wide(), random.wide(), random.wide(), random.wide()).normalize();
        let placement = Placement { rotation, ..Placement::default() };
        let solids = built(&[Solid::new("block", Shape::Box { size: DVec3::splat(4.0) }, placement)]);
        let mut feet = DVec3::new(random.wide(), random.wide(), -1.15 + random.wide());
        let wish = DVec3::new(random.wide(), random.wide(), random.wide()).normalize() * 0.3;
        let mut ticks = 0;
        while solids.overlap(feet, 0.5, 2.3).is_some() {
            ticks += 1;
            assert!(ticks < 200, "still inside at {feet:?}, {wish:?}");
            let mut path = wish;
            for _ in 0..4 {
                let Some(hit) = solids.sweep_box(feet, path, 0.5, 2.3) else {
                    feet += path;
                    break;
                };
                feet += path * hit.fraction;
                path += hit.normal * (0.001 - path.dot(hit.normal));
            }
        }
    }
}
