//! What sets the engine's model apart from the article's (docs/physics.md, sections 3.2, 5.3 and 5.4). Laws
//! that both have are in closed_forms.rs and skiing.rs.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::*;
use discjump_core::batch::RawInput;
use discjump_core::input::Input;
use discjump_core::movement::Engine;
use discjump_core::rules::{Model, Physics};
use discjump_core::scene::Has;
use discjump_core::terrain::Heightfield;

/// The stop speed shrinks with n.up, so on steep slopes a resting player does not rest.
#[test]
fn a_resting_player_creeps_at_60_degrees_and_slides_off_at_75() {
    for (degrees, seconds, expected, tolerance) in
        [(30.0, 6.4, 0.0, 0.0), (45.0, 6.4, 0.0, 0.0), (60.0, 6.4, 2.2, 0.05), (75.0, 6.4, 73.0, 0.5)]
    {
        let plane = slope(degrees);
        let mut w = world(&plane, "engine");
        (0..(seconds / 0.032) as u32).for_each(|_| w.step(IDLE));
        near(&format!("{degrees} degrees"), w.speed(), expected, tolerance);
    }
}

/// Feet height right after the tick of a contact, over falls that begin at any height up to 8 m.
fn hovers(tier: &str, speed: f64) -> Vec<f64> {
    let flat = slope(0.0);
    (1..1600)
        .map(|k| {
            let mut w = world(&flat, tier);
            w.set(&[("position", &[0.0, 0.0, 0.005 * f64::from(k)]), ("velocity", &[0.0, 0.0, -speed])]);
            while w.get("touched")[0] == 0.0 {
                w.step(IDLE);
            }
            w.position()[2]
        })
        .collect()
}

/// A fast landing leaves the player in the air, by less than the slice that was not made. The
/// specification's row gives one landing of each speed without its phase: such a landing must exist.
#[test]
fn a_landing_hovers_by_up_to_a_slice() {
    for (speed, article, engine) in [(8.0, 0.36, 0.17), (25.0, 0.84, 0.28), (60.0, 0.78, 0.27)] {
        for (tier, row, slice) in [("reference", article, 1.0), ("engine", engine, 0.3)] {
            let all = hovers(tier, speed);
            assert!(all.iter().all(|h| (-1e-4..slice).contains(h)), "{tier} at {speed} m/s");
            let nearest = all.iter().map(|h| (h - row).abs()).fold(f64::MAX, f64::min);
            near(tier, nearest, 0.0, 0.006);
        }
    }
}

#[test]
fn directions_weigh_the_keys_alike() {
    // The article's diagonal leans forward by atan(10/11); the jets push along it.
    for tier in ["reference", "engine"] {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        w.set(&[("position", &[0.0, 0.0, 500.0])]);
        w.step(RawInput { forward: 1, strafe: 1, jet: 1, ..IDLE });
        let v = w.velocity();
        near(tier, v[0] / v[1], by_model(tier, 10.0 / 11.0, 1.0), 1e-6);
    }
}

#[test]
fn friction_remembers_through_the_air_and_forgets_below_a_tenth() {
    let flat = slope(0.0);
    let mut w = world(&flat, "engine");
    w.set(&[("position", &[0.0, 0.0, 500.0]), ("friction", &[1.0])]);
    for expected in [0.6, 0.36, 0.216, 0.1296, 0.0, 0.0] {
        w.step(IDLE);
        near("memory", w.get("friction")[0], expected, 1e-6);
    }
}

#[test]
fn ages_count_ticks_at_any_tick_length() {
    let flat = slope(0.0);
    for tick_ms in [8, 32, 64] {
        let mut w = World {
            sim: discjump_core::batch::SimulatorSetup { tick_ms, ..setup(&flat, "engine") }.build().unwrap(),
        };
        assert_eq!(w.get("jump_age"), [100.0]);
        w.step(IDLE);
        assert_eq!(w.get("jump_age"), [1.0]);
        w.step(IDLE);
        assert_eq!(w.get("jump_age"), [2.0]);
    }
}

/// The player one tick later, by the engine's loop.
fn tick(terrain: &Heightfield, ski_bug: Option<bool>, p: &Body<f64>) -> Body<f64> {
    let lab = Lab::<f64>::of(Model::Engine, terrain, Physics { ski_bug, ..Physics::default() });
    lab.tick_as::<Engine, _>(p, &Input::idle())
}

/// The engine prefers the flatter of two contacts in successive ticks, and 0.2 itself is too steep.
#[test]
fn the_flatter_of_two_contacts_is_remembered() {
    for (old_up, remembered) in [(0.9, true), (0.3, true), (1.0, false)] {
        let flat = slope(0.0);
        let lab = Lab::<f64>::of(Model::Engine, &flat, Physics::default());
        let mut p: Body<f64> = lab.player([0.0, 0.0, 0.1], [0.0, 0.0, -10.0]);
        let Has(contact) = &mut p.contact;
        (contact.normal.z, contact.normal.x, contact.age) = (old_up, f64::sqrt(1.0 - old_up * old_up), 1);
        let q = tick(&flat, None, &p);
        assert_eq!(
            (q.contact().normal.z, q.contact().age),
            (1.0, if remembered { 1 } else { 2 }),
            "{old_up}"
        );
    }
}

/// Three attempts blocked are the dead stop, unless it is switched off; either is counted.
#[test]
fn a_crease_stops_dead_by_default() {
    for (ski_bug, dead) in [(None, true), (Some(true), true), (Some(false), false)] {
        let terrain = valley(75.0);
        let lab = Lab::<f64>::of(Model::Engine, &terrain, Physics::default());
        let (sin, cos) = 75f64.to_radians().sin_cos();
        let p: Body<f64> = lab.player([0.02, 1.0, 0.3], [-40.0 * cos, 0.0, -40.0 * sin]);
        let q = tick(&terrain, ski_bug, &p);
        let Has(limits) = q.bump_limits;
        assert_eq!((limits, floats(q.velocity) == [0.0; 3]), (1, dead), "{ski_bug:?}: {q:?}");
    }
}

/// A centre below the plane meets nothing: whoever is that deep falls out of the world.
#[test]
fn who_is_deep_under_the_ground_falls() {
    let flat = slope(0.0);
    for (depth, falls) in [(1.0, false), (1.2, true)] {
        let mut w = world(&flat, "engine");
        w.set(&[("position", &[0.0, 0.0, -depth])]);
        (0..100).for_each(|_| w.step(IDLE));
        assert_eq!(w.position()[2] < -10.0, falls, "{depth} m: {:?}", w.position());
    }
}
