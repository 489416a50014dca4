//! Boxes that slide, rest and fly fast: no inner edge is ever met, and nothing is ever passed through.

use crate::common::random::Random;
use crate::common::solids::{block, built};
use discjump_core::solids::{Placement, Solid, Solids};
use glam::{DQuat, DVec3};

const UP: DVec3 = DVec3::Z;

/// A deck 40 m square and 1 m thick, its upper side cut into triangles of 40 / `cuts` m, tilted by `tilt` radians.
fn deck(cuts: u32, tilt: f64) -> Solids {
    let side = cuts + 1;
    let at = |i: u32, j: u32, lower: u32| lower * side * side + j * side + i;
    let mut vertices = Vec::new();
    for lower in 0..2 {
        for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
            let place = |k: u32| 40.0 * f64::from(k) / f64::from(cuts) - 20.0;
            vertices.push(DVec3::new(place(i), place(j), -f64::from(lower)));
        }
    }
    let mut faces = Vec::new();
    let mut quad = |a, b, c, d| faces.extend([[a, b, c], [a, c, d]]);
    for (j, i) in (0..cuts).flat_map(|j| (0..cuts).map(move |i| (j, i))) {
        quad(at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0));
        quad(at(i, j, 1), at(i, j + 1, 1), at(i + 1, j + 1, 1), at(i + 1, j, 1));
    }
    for i in 0..cuts {
        quad(at(i + 1, 0, 0), at(i, 0, 0), at(i, 0, 1), at(i + 1, 0, 1));
        quad(at(i, cuts, 0), at(i + 1, cuts, 0), at(i + 1, cuts, 1), at(i, cuts, 1));
        quad(at(0, i, 0), at(0, i + 1, 0), at(0, i + 1, 1), at(0, i, 1));
        quad(at(cuts, i + 1, 0), at(cuts, i, 0), at(cuts, i, 1), at(cuts, i + 1, 1));
    }
    let rotation = DQuat::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), tilt);
    let placement = Placement { rotation, ..Placement::default() };
    built(&[Solid::mesh("deck", vertices, faces, placement)])
}

/// Plays the contact response of docs/physics.md on a box under gravity, and checks every normal.
fn slides(
    solids: &Solids,
    mut feet: DVec3,
    mut velocity: DVec3,
    normal: DVec3,
    round: impl Fn(DVec3) -> DVec3,
) {
    let dt = 0.032;
    let mut contacts = 0;
    for _ in 0..60 {
        velocity.z -= 20.0 * dt;
        let mut left = dt;
        for _ in 0..4 {
            let path = velocity * left;
            let Some(hit) = solids.sweep_box(feet, path, 0.5, 2.3) else {
                feet = round(feet + path);
                break;
            };
            contacts += 1;
            let turned = (hit.normal - normal).length();
            assert!(turned < 1e-9, "met {:?} at {feet:?}, moving {path:?}", hit.normal);
            feet = round(feet + path * hit.fraction);
            left *= 1.0 - hit.fraction;
            velocity += hit.normal * (0.001 - velocity.dot(hit.normal));
        }
        if feet.truncate().abs().max_element() > 18.0 {
            break;
        }
    }
    assert!(contacts > 5, "only {contacts} contacts");
}

#[test]
fn inner_edges_of_a_deck_are_never_met() {
    let mut random = Random::new(7);
    for (cuts, tilt) in [(1, 0.0), (3, 0.0), (40, 0.0), (1, 0.3), (7, 0.3), (40, 0.7)] {
        let solids = deck(cuts, tilt);
        let rotation = DQuat::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), tilt);
        let normal = rotation * UP;
        for _ in 0..60 {
            let flat = rotation * DVec3::new(10.0 * random.wide(), 10.0 * random.wide(), 0.0);
            // The lowest corner of the box on the plane, to a rounding either way.
            let lift = 0.5 * (normal.x.abs() + normal.y.abs()) / normal.z + 1e-12 * random.wide();
            let speed = 10f64.powf(random.within(-1.0, 1.7));
            let velocity = rotation * DVec3::new(random.wide(), random.wide(), 0.0).normalize() * speed;
            slides(&solids, flat + UP * lift, velocity, normal, |feet| feet);
        }
    }
}

/// Solids that lie flush, and a player kept in `f32`, as the authentic tier has him.
#[test]
fn seams_between_flush_solids_are_never_met() {
    let planks: Vec<Solid> = (-10..10)
        .map(|k| block([2.0 * f64::from(k), -20.0, 39.0], [2.0 * f64::from(k + 1), 20.0, 40.3]))
        .collect();
    let solids = built(&planks);
    let mut random = Random::new(8);
    let single = |v: DVec3| v.as_vec3().as_dvec3();
    for _ in 0..300 {
        let feet = single(DVec3::new(10.0 * random.wide(), 10.0 * random.wide(), 40.3));
        let velocity = single(30.0 * DVec3::new(random.wide(), random.wide(), 0.0));
        slides(&solids, feet, velocity, UP, single);
    }
}

#[test]
fn along_a_wall_of_flush_solids() {
    let wall: Vec<Solid> = (-10..10)
        .map(|k| block([2.0 * f64::from(k), 0.0, 0.0], [2.0 * f64::from(k + 1), 1.0, 5.0]))
        .collect();
    let solids = built(&wall);
    let mut random = Random::new(9);
    for _ in 0..1000 {
        // Up to 60 micrometres inside: an f32 at 1 km.
        let feet = DVec3::new(10.0 * random.wide(), -0.5 + 6e-5 * random.wide(), 1.0);
        let path = DVec3::new(random.wide(), -1e-5 * random.within(0.0, 1.0), 0.1 * random.wide());
        assert_eq!(solids.sweep_box(feet, path, 0.5, 2.3), None, "{feet:?} {path:?}");
        let into = path.with_y(0.01);
        let hit = solids.sweep_box(feet, into, 0.5, 2.3).unwrap();
        assert_eq!(hit.normal, DVec3::NEG_Y, "{feet:?} {into:?}");
    }
}

#[test]
fn touching_is_not_meeting() {
    let solids = built(&[block([-5.0, -5.0, -1.0], [5.0, 5.0, 0.0])]);
    let sweep = |feet: [f64; 3], path: [f64; 3]| solids.sweep_box(feet.into(), path.into(), 0.5, 2.3);
    // Resting: down is met at once, along and up are free, and so is no movement at all.
    let down = sweep([0.0; 3], [1.0, 0.0, -0.1]).unwrap();
    assert_eq!((down.fraction, down.normal, down.solid), (0.0, UP, 0));
    assert_eq!(sweep([0.0; 3], [1.0, 1.0, 0.0]), None);
    assert_eq!(sweep([0.0; 3], [1.0, 0.0, 0.1]), None);
    assert_eq!(sweep([0.0; 3], [0.0; 3]), None);
    // A path that ends on it.
    assert_eq!(sweep([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), None);
    assert_eq!(sweep([0.0, 0.0, 1.0], [0.0, 0.0, -2.0]).unwrap().fraction, 0.5);
    // Beside it, exactly and by half a skin.
    assert_eq!(sweep([5.5, 0.0, 1.0], [0.0, 0.0, -4.0]), None);
    assert_eq!(sweep([5.5 - 5e-5, 0.0, 1.0], [0.0, 0.0, -4.0]), None);
    assert_eq!(sweep([5.5 - 2e-4, 0.0, 1.0], [0.0, 0.0, -4.0]).unwrap().fraction, 0.25);
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(sweep([bad, 0.0, 1.0], [0.0, 0.0, -4.0]), None);
        assert_eq!(sweep([0.0, 0.0, 1.0], [0.0, 0.0, bad]), None);
    }
}

#[test]
fn nothing_is_passed_at_any_speed() {
    let plate = Solid::cuboid("plate", DVec3::new(0.001, 60.0, 60.0), DVec3::ZERO, 0.0);
    let mut random = Random::new(10);
    for turned in [false, true] {
        let placement = Placement {
            rotation: if turned { DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9).normalize() } else { DQuat::IDENTITY },
            ..Placement::default()
        };
        let solids = built(&[Solid { placement, ..plate.clone() }]);
        let normal = placement.rotation * DVec3::NEG_X;
        for _ in 0..2000 {
            let speed = 10f64.powf(random.within(0.0, 5.0));
            let aim = placement.rotation * DVec3::new(0.0, 20.0 * random.wide(), 20.0 * random.wide());
            let away =
                placement.rotation * DVec3::new(-random.within(3.0, 10.0), random.wide(), random.wide());
            let path = -away.normalize() * (speed * 0.032 + 20.0);
            let hit = solids.sweep_box(aim + away, path, 0.5, 2.3).expect("a plate is in the way");
            assert!((hit.normal - normal).length() < 1e-9);
            // A closed form: the gap between plane and nearest corner over the speed towards it.
            let centre = aim + away + DVec3::new(0.0, 0.0, 1.15);
            let reach = DVec3::new(0.5, 0.5, 1.15).dot(normal.abs());
            let gap = centre.dot(normal) - 0.0005 - reach;
            assert!((hit.fraction * -path.dot(normal) - gap).abs() < 1e-8);
        }
    }
}

#[test]
fn the_order_of_solids_and_triangles_does_not_matter() {
    let mut random = Random::new(11);
    let blocks: Vec<Solid> = (0..40)
        .map(|_| {
            let centre = 6.0 * DVec3::new(random.wide(), random.wide(), random.wide());
            Solid::cuboid("block", DVec3::splat(random.within(0.5, 2.0)), centre.round(), 0.0)
        })
        .collect();
    let turned: Vec<Solid> = blocks.iter().rev().cloned().collect();
    let (a, b) = (built(&blocks), built(&turned));
    assert_ne!(a.digest(), b.digest());
    assert_eq!(a.digest(), built(&blocks).digest());
    for _ in 0..5000 {
        let feet = (10.0 * DVec3::new(random.wide(), random.wide(), random.wide())).round();
        let path = (10.0 * DVec3::new(random.wide(), random.wide(), random.wide())).round();
        let [a, b] = [&a, &b].map(|s| s.sweep_box(feet, path, 0.5, 2.0).map(|h| (h.fraction, h.normal)));
        assert_eq!(a, b, "{feet:?} {path:?}");
    }
}

/// Up a ramp and on to the floor that it leads to, whose own side stands hidden in the ramp.
#[test]
fn from_a_ramp_on_to_a_floor() {
    let profile = [(-0.5, 40.3), (0.0, 40.3), (12.0, 36.0), (-0.5, 36.0)];
    let points = profile.iter().flat_map(|&(y, z)| [DVec3::new(-5.0, y, z), DVec3::new(5.0, y, z)]).collect();
    let floor = block([-5.0, -20.0, 36.0], [5.0, 0.0, 40.3]);
    let solids = built(&[floor, Solid::hull("ramp", points, Placement::default())]);
    let mut random = Random::new(12);
    for k in 0..400 {
        let single = |v: DVec3| if k % 2 == 0 { v } else { v.as_vec3().as_dvec3() };
        let mut feet = DVec3::new(3.0 * random.wide(), 10.0, 40.3);
        let mut velocity = DVec3::new(0.0, -random.within(3.0, 40.0), -5.0);
        let mut ticks = 0;
        while feet.y > -5.0 {
            ticks += 1;
            assert!(ticks < 300 && feet.z > 36.0, "{feet:?} {velocity:?}");
            velocity.z -= 0.64;
            velocity.y = velocity.y.min(-3.0);
            let mut left = 0.032;
            for _ in 0..4 {
                let path = velocity * left;
                let Some(hit) = solids.sweep_box(feet, path, 0.5, 2.3) else {
                    feet = single(feet + path);
                    break;
                };
                assert!(hit.normal.z > 0.9, "{:?} at {feet:?}", hit.normal);
                feet = single(feet + path * hit.fraction);
                left *= 1.0 - hit.fraction;
                velocity += hit.normal * (0.001 - velocity.dot(hit.normal));
            }
        }
        assert!(feet.z > 40.2999, "{feet:?}");
    }
}
