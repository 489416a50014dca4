//! Items 16 and 19 in every tier: explosions at the edges of their reach, and discs of odd shooters.

use crate::common::crew::Crew;
use crate::common::{IDLE, TIERS, flat, setup};
use discjump_core::batch::{RawInput, Shot};
use discjump_core::rules::{Cutoff, DiscFlight, Knockback, Physics};
use discjump_core::solids::{Solid, Solids};
use std::sync::Arc;

fn alone(tier: &str, physics: Physics) -> Crew {
    let map = flat();
    let mut s = setup(&map, tier);
    (s.scene, s.physics) = ("disc_jump", physics);
    Crew::new(&s)
}

/// Speed and damage of a light in the air by a disc so far below his box's centre.
fn blown(tier: &str, physics: Physics, d0: f64) -> (f64, f64) {
    let mut one = alone(tier, physics);
    one.put(0, [0.0, 0.0, 14.85], [0.0; 3]);
    one.sim.explode(&[[0.0, 0.0, 16.0 - d0]], "disc").unwrap();
    let [x, y, z] = one.velocity(0);
    assert_eq!((x, y), (0.0, 0.0), "{tier}");
    (z, one.get(0, "damage")[0])
}

/// In the centre it hurts and does not push; it is strongest a box side beyond a metre; 7.5 m and 8.5 m are the
/// two ends; below the ground nothing is felt.
#[test]
fn e16_explosions_in_every_tier() {
    let tribes = Physics::default();
    let near = |a: f64, b: f64| (a - b).abs() < 2e-4;
    for tier in TIERS {
        for knockback in [Knockback::Tribes, Knockback::Basic, Knockback::LinearBoosted] {
            let (speed, damage) = blown(tier, Physics { knockback, ..tribes }, 0.0);
            // 16 - 1.15 is not quite 14.85 in f32: a hair of a distance is no more than a hair of a push.
            let hair = speed.abs() < 1e-4 || knockback != Knockback::Tribes;
            assert!(hair && near(damage, 0.5 * (1.0 - 1.0 / 7.5)), "{tier}: {speed} m/s, {damage}");
        }
        let power = |d0: f64| d0 / f64::max(d0 - 1.0, 1.0) - d0 / 7.5;
        for d0 in [0.5, 1.0, 1.999, 2.0, 2.001, 5.0, 7.499, 7.5, 7.501, 8.4, 8.499] {
            let (speed, damage) = blown(tier, tribes, d0);
            assert!(near(speed, 150.0 / 9.0 * power(d0)), "{tier}, {d0} m: {speed}");
            assert!(near(damage, 0.5 * (1.0 - f64::max(d0 - 1.0, 1.0) / 7.5)), "{tier}, {d0} m: {damage}");
            let cut = blown(tier, Physics { cutoff: Cutoff::Radius, ..tribes }, d0);
            assert!(
                d0 == 7.5 || cut == if d0 < 7.5 { (speed, damage) } else { (0.0, 0.0) },
                "{tier}, {d0} m"
            );
        }
        for d0 in [8.501, 9.0, 15.9] {
            assert_eq!(blown(tier, tribes, d0), (0.0, 0.0), "{tier}, {d0} m");
        }
        let mut one = alone(tier, tribes);
        one.put(0, [0.0; 3], [0.0; 3]);
        let before = one.bytes(0);
        for none in [[0.0, 0.0, -0.06], [0.0, 0.0, -90_000.0], [f64::NAN, 0.0, 0.0], [1e9, -1e9, 9e4]] {
            one.sim.explode(&[none], "mortar").unwrap();
            assert_eq!(one.bytes(0), before, "{tier}: {none:?}");
        }
        one.sim.explode(&[[0.0, 0.0, -0.04]], "mortar").unwrap();
        assert!(one.velocity(0)[2] > 5.0, "{tier}");
    }
}

/// The first shot of a shooter who moves, looking north, high over the ground: all places until it is gone.
fn flight(tier: &str, disc: DiscFlight, z: f64, velocity: [f64; 3], pitch: f64) -> (Vec<Shot>, Option<Shot>) {
    let mut one = alone(tier, Physics { disc, ..Physics::default() });
    one.put(0, [0.0, 0.0, z], velocity);
    let mut seen = Vec::new();
    for tick in 0..260 {
        one.sim.step(&[RawInput { fire: u8::from(tick == 0), pitch, ..IDLE }], 1).unwrap();
        if let Some(blast) = one.sim.blasts().first() {
            return (seen, Some(*blast));
        }
        match one.sim.projectiles().first() {
            Some(shot) => seen.push(*shot),
            None => break,
        }
    }
    (seen, None)
}

const FORMS: [DiscFlight; 2] = [DiscFlight::Surface, DiscFlight::Engine];

/// 203 steps of life, then nothing, whatever the tier and the form.
#[test]
fn e19_a_disc_lives_for_203_ticks() {
    for tier in TIERS {
        for disc in FORMS {
            let (seen, blast) = flight(tier, disc, 5000.0, [0.0; 3], 0.0);
            assert!(seen.len() == 203 && blast.is_none(), "{tier}, {disc:?}: {}", seen.len());
            assert_eq!(seen.iter().map(|s| s.age).collect::<Vec<_>>(), (1..=203).collect::<Vec<_>>());
        }
    }
}

/// At 30 m/s along the aim the engine's disc snaps to 80 m/s and loses what it had sideways; the other never jumps.
#[test]
fn e19_a_shooter_at_30_m_s_along_the_aim() {
    for tier in TIERS {
        for (along, snaps) in [(29.9, false), (30.0, true), (31.0, true), (500.0, true)] {
            let (seen, _) = flight(tier, DiscFlight::Engine, 5000.0, [12.0, along, 0.0], 0.0);
            let wanted = if snaps { [0.0, 80.0] } else { [6.0, 65.0 + 0.5 * along] };
            let got = seen[2].velocity;
            // Falling is not inherited: the shot is fired before the tick's gravity.
            let near = (0..2).all(|k| (got[k] - wanted[k]).abs() < 1e-4) && got[2] == 0.0;
            assert!(near, "{tier}, {along} m/s: {got:?}");
            let (seen, _) = flight(tier, DiscFlight::Surface, 5000.0, [12.0, along, 0.0], 0.0);
            let first = (65.0 + 0.5 * along + 0.16).min(f64::max(80.0, 65.0 + 0.5 * along));
            let got = seen[0].velocity;
            assert!((got[0] - 6.0).abs() < 1e-4 && (got[1] - first).abs() < 1e-4, "{tier}, {along}: {got:?}");
        }
    }
}

/// Faster backwards than 130 m/s, the disc follows its shooter; at 130 it stands still.
#[test]
fn e19_a_disc_that_flies_backwards() {
    for tier in TIERS {
        for disc in FORMS {
            // The engine's snap asks for the size of the components and not for their signs: at 290 m/s it turns
            // a disc that flies backwards into one that flies off along its aim.
            let fast = if disc == DiscFlight::Engine { 1.0 } else { -1.0 };
            for (back, sign) in [(129.0, 1.0), (140.0, -1.0), (289.0, -1.0), (291.0, fast), (1e5, fast)] {
                let (seen, blast) = flight(tier, disc, 90_000.0, [0.0, -back, 0.0], 0.0);
                assert!(seen.len() == 203 && blast.is_none(), "{tier}, {disc:?}, {back}: {}", seen.len());
                let way = seen[10].position[1] - seen[3].position[1];
                assert!(way * sign > 0.0, "{tier}, {disc:?}, {back} m/s: {way} m");
            }
        }
    }
}

/// From below the ground upwards it bursts on the surface from underneath (the engine's a step before); downwards
/// it meets nothing and vanishes in its time.
#[test]
fn e19_a_disc_from_below_the_ground() {
    for tier in TIERS {
        for disc in FORMS {
            let (seen, blast) = flight(tier, disc, -12.0, [0.0, 0.0, 0.64], 0.5);
            let blast = blast.unwrap_or_else(|| panic!("{tier}, {disc:?}: no blast in {}", seen.len()));
            let z = blast.position[2];
            let step = if disc == DiscFlight::Engine { 65.0 / 30.0 * 0.5f64.sin() } else { 0.0 };
            assert!((-step - 1e-3..=1e-3).contains(&z), "{tier}, {disc:?}: {z}");
            let (seen, blast) = flight(tier, disc, -12.0, [0.0; 3], -0.5);
            assert!(seen.len() == 203 && blast.is_none(), "{tier}, {disc:?}: {blast:?}");
        }
    }
}

/// A wall nearer than the first step: the disc bursts on it, the engine's at the muzzle.
#[test]
fn e19_a_wall_within_the_first_step() {
    let map = flat();
    let wall = Solid::cuboid("wall", [40.0, 0.01, 40.0].into(), [0.0, 1.2, 0.0].into(), 0.0);
    let built = Arc::new(Solids::new(&[wall], map.grid()).unwrap());
    for tier in TIERS {
        for disc in FORMS {
            let mut s = setup(&map, tier);
            (s.scene, s.solids, s.physics.disc) = ("mission", Some(&built), disc);
            let mut one = Crew::new(&s);
            one.put(0, [0.0, 0.0, 0.0], [0.0; 3]);
            let ticks = if disc == DiscFlight::Engine { 3 } else { 1 };
            for tick in 0..ticks {
                assert!(one.sim.blasts().is_empty(), "{tier}, {disc:?}, tick {tick}");
                one.sim.step(&[RawInput { fire: u8::from(tick == 0), ..IDLE }], 1).unwrap();
            }
            let blasts = one.sim.blasts();
            let at = blasts.first().unwrap_or_else(|| panic!("{tier}, {disc:?}: no blast")).position;
            let y = if disc == DiscFlight::Engine { 0.5 } else { 1.195 };
            assert!((at[1] - y).abs() < 1e-4 && (at[2] - 1.5).abs() < 1e-2, "{tier}, {disc:?}: {at:?}");
            assert!(one.get(0, "damage")[0] > 0.4, "{tier}, {disc:?}");
        }
    }
}
