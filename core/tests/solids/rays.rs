//! Rays against parry3d's, and at seams, where parry's slip through.

use crate::common::random::Random;
use crate::common::solids::built;
use discjump_core::solids::{Placement, Solid};
use glam::{DQuat, DVec3};
use parry3d_f64::query::{Ray, RayCast};
use parry3d_f64::shape::TriMesh;

#[test]
fn rays_agree_with_parry_and_slip_nowhere() {
    let mut random = Random::new(30);
    let (mut slips, mut hits) = (0, 0);
    for _ in 0..50 {
        let points: Vec<DVec3> =
            (0..30).map(|_| 5.0 * DVec3::new(random.wide(), random.wide(), random.wide())).collect();
        let solids = built(&[Solid::hull("hull", points, Placement::default())]);
        let corners: Vec<DVec3> = solids.faces().flat_map(|(_, corners)| corners).collect();
        let numbers = (0..corners.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = TriMesh::new(corners.clone(), numbers).unwrap();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        for _ in 0..2000 {
            let from = middle + 20.0 * DVec3::new(random.wide(), random.wide(), random.wide());
            // Through the middle of an edge, a corner, or anywhere: all within the hull.
            let k = 3 * random.index(corners.len() / 3);
            let on = match random.index(3) {
                0 => corners[k],
                1 => corners[k].lerp(corners[k + 1], random.within(0.0, 1.0)),
                _ => middle + 2.0 * DVec3::new(random.wide(), random.wide(), random.wide()),
            };
            let path = (middle.lerp(on, 0.999) - from) * 3.0;
            let ours = solids.ray(from, path);
            let other = mesh.cast_local_ray_and_get_normal(&Ray::new(from, path), 1.0, false);
            match (ours, other) {
                (Some(hit), Some(cast)) => {
                    hits += 1;
                    assert!((hit.fraction - cast.time_of_impact).abs() * path.length() < 1e-9);
                    assert!(hit.normal.dot(path) <= 0.0);
                }
                (Some(_), None) => slips += 1,
                (None, None) => (),
                (None, Some(_)) => panic!("{from:?} {path:?} slipped"),
            }
        }
    }
    println!("{hits} hits, parry slipped {slips} times");
    assert!(hits > 50_000 && slips < 10);
}

#[test]
fn rays_see_both_sides_and_both_ends() {
    let turn = DQuat::IDENTITY;
    let placement = Placement { rotation: turn, position: DVec3::ZERO, scale: 2.0 };
    let cube = discjump_core::solids::Shape::Box { size: DVec3::ONE };
    let solids = built(&[Solid::new("cube", cube, placement)]);
    let ray = |from: [f64; 3], path: [f64; 3]| {
        solids.ray(from.into(), path.into()).map(|hit| (hit.fraction, hit.normal.to_array()))
    };
    assert_eq!(ray([-3.0, 0.1, 0.2], [4.0, 0.0, 0.0]), Some((0.5, [-1.0, 0.0, 0.0])));
    assert_eq!(ray([0.0, 0.1, 0.2], [4.0, 0.0, 0.0]), Some((0.25, [-1.0, 0.0, 0.0])));
    assert_eq!(ray([1.0, 0.1, 0.2], [4.0, 0.0, 0.0]), Some((0.0, [-1.0, 0.0, 0.0])));
    assert_eq!(ray([-2.0, 0.1, 0.2], [1.0, 0.0, 0.0]), Some((1.0, [-1.0, 0.0, 0.0])));
    assert_eq!(ray([-2.0, 0.1, 0.2], [0.999, 0.0, 0.0]), None);
    assert_eq!(ray([-2.0, 0.1, 0.2], [0.0; 3]), None);
    assert_eq!(ray([f64::NAN, 0.1, 0.2], [4.0, 0.0, 0.0]), None);
}
