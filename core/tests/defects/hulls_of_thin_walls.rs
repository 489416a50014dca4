//! The hull of a wall's eight corners was refused, "no convex hull: point 4 was left outside", where the wall was some
//! thousand times thinner than long and stood aslant: the finder of hulls tells corners from rounding by the points'
//! largest spread. And the hull of the 65,536 points that are allowed took ten seconds, each point held against each face.

use crate::common::random::Random;
use crate::common::solids::built;
use discjump_core::solids::{Placement, Solid};
use glam::{DQuat, DVec3};
use std::time::Instant;

#[test]
fn walls_of_any_thickness_have_a_hull() {
    let mut random = Random::new(1);
    for round in 0..3000 {
        let thick = 10f64.powf(random.within(-5.0, 0.0));
        let [lean, skew] = [random.wide(), random.wide()];
        let turn = DQuat::from_xyzw(random.wide(), random.wide(), random.wide(), random.wide()).normalize();
        let bit = |k: u32, n: u32| f64::from(k >> n & 1);
        let corner = |k: u32| {
            let (y, z) = (20.0 * bit(k, 1) - 10.0, 10.0 * bit(k, 2));
            turn * DVec3::new(z * lean + y * skew + thick * bit(k, 0), y, z)
        };
        let solids = built(&[Solid::hull("wall", (0..8).map(corner).collect(), Placement::default())]);
        assert_eq!(solids.triangle_count(), 12, "round {round}, {thick} m thick");
        // A closed form: a parallelepiped.
        let volume: f64 = solids.faces().map(|(_, [a, b, c])| a.dot(b.cross(c)) / 6.0).sum();
        assert!((volume / (thick * 200.0) - 1.0).abs() < 1e-6, "{volume} m^3, {thick} m thick");
    }
}

#[test]
fn a_hull_of_many_points_does_not_hold_each_against_each_face() {
    let mut random = Random::new(2);
    // The best of three: others may be at work on the machine.
    let mut time = |count: usize| (0..3).map(|_| once(count, &mut random)).fold(f64::MAX, f64::min);
    let (some, many) = (time(4_000), time(32_000));
    assert!(many < 30.0 * some, "8 times the points took {} times as long", many / some);
}

/// Seconds to build a ball.
fn once(count: usize, random: &mut Random) -> f64 {
    let mut point = || 5.0 * DVec3::new(random.wide(), random.wide(), random.wide()).normalize();
    let ball = Solid::hull("ball", (0..count).map(|_| point()).collect(), Placement::default());
    let begin = Instant::now();
    assert_eq!(built(&[ball]).triangle_count(), 2 * count - 4);
    begin.elapsed().as_secs_f64()
}
