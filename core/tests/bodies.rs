//! Every tier in a world with a body in it: a thin wall that nobody passes at any speed, and a ledge that is
//! stepped onto. The wall is exact by hand, so that the moves are tested and not a sweep of solids.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::*;
use discjump_core::movement::{Engine, Fast, Movement, Obstacles, Sliced, Swept};
use discjump_core::player::Place;
use discjump_core::real::V3;
use discjump_core::rules::Physics;
use discjump_core::terrain::{Hit, Surface};
use discjump_core::tick::tick;

/// The western face of a wall at x = 10, as high as `top`, met by a box of half a metre about the feet.
struct Walled<'a> {
    ground: Surface<'a, f64>,
    top: f64,
    ledge: bool,
}

const FACE: f64 = 10.0 - 0.5;

impl Obstacles<f64> for Walled<'_> {
    const BODIES: bool = true;
    fn surface(&self) -> &Surface<'_, f64> {
        &self.ground
    }
    fn sweep_bodies(&self, at: &Place<f64>, path: V3<f64>, active: bool) -> Hit<f64> {
        let gap = FACE - at.position.x;
        let fraction = (gap / path.x).max(0.0);
        let meets = active && path.x > 0.0 && gap > -1e-9 && gap < path.x;
        let low = at.position.z + path.z * fraction.min(1.0) < self.top;
        if !(meets && low) {
            return Hit::none();
        }
        Hit { hit: true, fraction, normal: V3 { x: -1.0, y: 0.0, z: 0.0 }, body: true }
    }
    fn line_bodies(&self, _at: &Place<f64>, _path: V3<f64>, _active: bool) -> Hit<f64> {
        Hit::none()
    }
    fn step_up(&self, at: &Place<f64>, _path: V3<f64>, hit: &Hit<f64>, active: bool) -> f64 {
        let lift = self.top + 1e-3 - at.position.z;
        if active && hit.body && self.ledge { lift.max(0.0) } else { 0.0 }
    }
}

fn run<M: Movement>(speed: f64, top: f64, ledge: bool) -> Vec<Body<f64>> {
    let lab = Lab::<f64>::of(M::MODEL, &slope(0.0), Physics::default());
    let world = Walled { ground: lab.maps.surface(), top, ledge };
    let mut p: Body<f64> = lab.player([0.0, 0.0, 0.3], [speed, 0.3 * speed, 0.0]);
    (0..150)
        .map(|t| {
            p = tick::<_, M, f64, _>(&p, &input(0, 1, t % 3 == 0, t % 50 < 20, 0), &world, &lab.rules);
            p
        })
        .collect()
}

fn nobody_passes<M: Movement>() {
    for speed in [1.0, 8.0, 31.0, 90.0, 400.0, 5000.0] {
        let track = run::<M>(speed, f64::MAX, false);
        let farthest = track.iter().fold(f64::MIN, |x, p| x.max(p.position.x));
        // The strafe key pushes on into the wall: he gets there, and stays.
        assert!((FACE - 1.5..=FACE + 1e-9).contains(&farthest), "{speed} m/s: {farthest} m");
        // Landing damage is for walls as well.
        let hurt = track[149].damage.0;
        assert!((hurt > 0.0) == (speed > 25.0), "{speed} m/s: {hurt}");
        assert!(track.iter().all(possible), "{speed} m/s");
    }
}

/// Above the ground, and finite.
fn possible(p: &Body<f64>) -> bool {
    p.position.z > -1e-6 && numbers(p).iter().all(|x| x.is_finite())
}

#[test]
fn nobody_passes_a_wall_at_any_speed() {
    nobody_passes::<Sliced>();
    nobody_passes::<Swept>();
    nobody_passes::<Fast>();
    nobody_passes::<Engine>();
}

#[test]
fn a_ledge_is_stepped_onto_without_losing_speed() {
    fn check<M: Movement>() {
        for speed in [5.0, 20.0, 60.0] {
            let track = run::<M>(speed, 0.6, true);
            let over = track.iter().find(|p| p.position.x > 10.5).expect("he goes on over the ledge");
            assert!(over.velocity.x > speed - 3.0, "{speed} m/s: {:?}", over.velocity);
            let stopped = run::<M>(speed, f64::MAX, false);
            assert!(stopped.iter().all(|p| p.position.x < 10.5));
        }
    }
    check::<Sliced>();
    check::<Swept>();
    check::<Fast>();
    check::<Engine>();
}
