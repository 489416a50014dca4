//! Projectiles and bodies: a wall and a deck that stand in a world made for these tests.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::range::*;
use common::*;
use discjump_core::arms::{DISC, GRENADE, MORTAR, Projectile, Weapon};
use discjump_core::flight::fly;
use discjump_core::movement::Obstacles;
use discjump_core::player::Place;
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::{DiscFlight, Physics};
use discjump_core::terrain::{Hit, Surface};

/// Flat ground, and a plane: the wall y = 10 or the deck z = 5, met from both sides.
struct World<'a, T: Scalar> {
    ground: Surface<'a, T>,
    axis: usize,
    at: T,
}

impl<T: Scalar> Obstacles<T> for World<'_, T> {
    const BODIES: bool = true;

    fn surface(&self) -> &Surface<'_, T> {
        &self.ground
    }

    fn sweep_bodies(&self, _at: &Place<T>, _path: V3<T>, _active: bool) -> Hit<T> {
        panic!("a projectile is no player")
    }

    fn line_bodies(&self, at: &Place<T>, path: V3<T>, active: bool) -> Hit<T> {
        let pick = |v: V3<T>| if self.axis == 1 { v.y } else { v.z };
        let (gap, step) = (self.at - pick(at.position), pick(path));
        let fraction = gap / step;
        if !active || !(T::zero()..=T::lit(1.0)).contains(&fraction) {
            return Hit::none();
        }
        let side = if T::zero() < step { -1.0 } else { 1.0 };
        let normal = if self.axis == 1 { [0.0, side, 0.0] } else { [0.0, 0.0, side] };
        Hit { hit: true, fraction, normal: v3(normal), body: true }
    }

    fn step_up(&self, _at: &Place<T>, _path: V3<T>, _hit: &Hit<T>, _active: bool) -> T {
        panic!("a projectile does not step")
    }
}

const WALL: (usize, f64) = (1, 10.0);
const DECK: (usize, f64) = (2, 5.0);

fn flight<T: Scalar>(
    (axis, at): (usize, f64),
    weapon: &Weapon,
    disc: DiscFlight,
    (place, pitch): ([f64; 3], f64),
) -> Vec<Projectile<T>> {
    let field = flat();
    let mut range = Range::<T>::new(&field, weapon, Physics { disc, ..Physics::default() }, 32);
    range.place(place, [0.0; 3]);
    range.aim(0.0, pitch);
    range.shoot();
    let world = World { ground: range.lab.maps.surface::<T>(), axis, at: T::from_f64(at) };
    let mut seen = Vec::new();
    loop {
        fly(&mut range.arms, 0, &world, &range.arsenal);
        let slot = range.arms.slots[0];
        if slot.phase == 0 {
            return seen;
        }
        seen.push(slot);
        if slot.burst() {
            return seen;
        }
    }
}

#[test]
fn discs_burst_on_a_wall() {
    let start = ([0.0, -3.0, 2.0], 0.0);
    let swept = flight::<f64>(WALL, &DISC, DiscFlight::Surface, start);
    let last = swept.last().unwrap();
    assert!(last.burst() && (last.position.y - 10.0).abs() < 1e-12);
    assert_eq!(floats(last.axis), [0.0, -1.0, 0.0]);
    // The engine's: five steps of 65/30 m from -2.5 m on, and the sixth would hit.
    let clocked = flight::<f64>(WALL, &DISC, DiscFlight::Engine, start);
    let last = clocked.last().unwrap();
    assert!((last.position.y - (-2.5 + 5.0 * 65.0 / 30.0)).abs() < 1e-9);
    assert_eq!(floats(last.axis), [0.0, -1.0, 0.0]);
}

fn check_wall<T: Scalar>() {
    for weapon in [&GRENADE, &MORTAR] {
        let seen = flight::<T>(WALL, weapon, DiscFlight::Surface, ([0.0, 3.0, 1.0], 0.3));
        assert!(seen.iter().all(|s| s.position.y.to_f64() < 10.0), "before the wall");
        assert!(seen.iter().any(|s| s.velocity.y < T::zero()), "and back from it");
        assert!(seen.last().unwrap().burst());
    }
}

/// On the deck it bounces, comes to rest, and bursts in its time; it never falls through.
fn check_deck<T: Scalar>() {
    for weapon in [&GRENADE, &MORTAR] {
        for pitch in [-1.5, -0.9, 0.1] {
            let seen = flight::<T>(DECK, weapon, DiscFlight::Surface, ([0.0, 0.0, 5.0], pitch));
            assert!(seen.iter().all(|s| s.position.z.to_f64() > 5.0 - 1e-5), "{pitch}");
            let last = seen.last().unwrap();
            assert!(last.burst() && (last.position.z.to_f64() - 5.0).abs() < 1e-5);
            assert_eq!(floats(last.axis), [0.0, 0.0, 1.0]);
        }
        // From below it bounces off its underside.
        let seen = flight::<T>(DECK, weapon, DiscFlight::Surface, ([0.0, 0.0, 0.0], 1.2));
        assert!(seen.iter().all(|s| s.position.z.to_f64() < 5.0));
        assert!(seen.last().unwrap().burst());
    }
}

#[test]
fn shells_bounce_off_a_wall() {
    check_wall::<f64>();
    check_wall::<f32>();
}

#[test]
fn shells_come_to_rest_on_a_deck() {
    check_deck::<f64>();
    check_deck::<f32>();
}
