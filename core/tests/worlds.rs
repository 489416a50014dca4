//! Several players in one world: they block each other, what they fire acts on all of them, and no
//! world notices another one, in bits.
#![allow(missing_docs)]

mod common;

use common::crew::Crew;
use common::crowd::keys;
use common::*;
use discjump_core::batch::RawInput;
use discjump_core::terrain::{Edge, Heightfield};

const TIERS: [&str; 5] = ["reference", "authentic", "swept", "fast", "engine"];

fn crew(terrain: &Heightfield, tier: &str, players: usize, per_world: usize) -> Crew {
    let mut s = setup(terrain, tier);
    (s.scene, s.players, s.players_per_world) = ("disc_jump", players, per_world);
    Crew::new(&s)
}

fn flat() -> Heightfield {
    Heightfield::new(vec![0.0; 65 * 65], 65, 65, 8.0, [-256.0, -256.0], Edge::Tile).unwrap()
}

/// Keys that fire now and then beside everything else: one half at the ground, the other far away.
fn armed(name: u64, tick: u64) -> RawInput {
    let pitch = if name.is_multiple_of(2) { -0.7 } else { 0.4 };
    RawInput { fire: u8::from(tick % 60 < 3), pitch, ..keys(name, tick) }
}

#[test]
fn worlds_do_not_notice_each_other() {
    let map = rolling();
    for tier in ["authentic", "reference"] {
        let mut alone: Vec<_> = (0..4).map(|_| crew(&map, tier, 3, 3)).collect();
        let mut s = setup(&map, tier);
        (s.scene, s.players, s.players_per_world, s.threads) = ("disc_jump", 3 * 400, 3, Some(2));
        let mut together = Crew::new(&s);
        for tick in 0..150 {
            let inputs: Vec<_> = (0..1200).map(|i| armed(i % 12, tick)).collect();
            together.sim.step(&inputs, 1).unwrap();
            for (k, world) in alone.iter_mut().enumerate() {
                world.sim.step(&inputs[3 * k..3 * k + 3], 1).unwrap();
            }
        }
        for world in 0..400 {
            for k in 0..3 {
                assert_eq!(together.bytes(3 * world + k), alone[world % 4].bytes(k), "{tier}, world {world}");
            }
        }
        assert!(!alone[0].sim.projectiles().is_empty());
    }
}

#[test]
fn company_far_away_changes_no_bit() {
    let map = rolling();
    for tier in TIERS {
        let mut alone = crew(&map, tier, 1, 1);
        let mut company = crew(&map, tier, 2, 2);
        company.put(1, [5000.0, 5000.0, 100.0], [0.0; 3]);
        for tick in 0..200 {
            alone.sim.step(&[armed(1, tick)], 1).unwrap();
            company.sim.step(&[armed(1, tick), armed(2, tick)], 1).unwrap();
        }
        assert_eq!(alone.bytes(0), company.bytes(0), "{tier}");
    }
}

#[test]
fn nobody_passes_through_anybody_at_any_speed() {
    let map = flat();
    for tier in TIERS {
        for speed in [3.0, 30.0, 300.0, 3000.0, 30_000.0] {
            for gap in [2.5, 3.0, 7.0, 40.0] {
                let mut pair = crew(&map, tier, 2, 2);
                pair.put(0, [0.0, 0.0, 50.0], [speed, 0.0, 0.0]);
                pair.put(1, [gap, 0.0, 50.0], [-speed, 0.0, 0.0]);
                for tick in 1..=8 {
                    pair.sim.step(&[IDLE, IDLE], 1).unwrap();
                    let (a, b) = (pair.position(0), pair.position(1));
                    let apart = (0..3).map(|k| (b[k] - a[k]).powi(2)).sum::<f64>().sqrt();
                    let what = format!("{tier}, {speed} m/s from {gap} m, tick {tick}: {a:?} {b:?}");
                    assert!(apart > 2.29, "{what}");
                    let met = 2.0 * speed * 0.032 * f64::from(tick) > gap;
                    let closing = pair.velocity(0)[0] - pair.velocity(1)[0];
                    assert!(!met || closing < 0.1 * speed + 0.5, "{what}: {closing} m/s");
                }
            }
        }
    }
}

#[test]
fn a_player_lands_on_another_ones_head_and_can_jump_there() {
    let map = flat();
    for tier in ["reference", "authentic", "swept"] {
        let mut pair = crew(&map, tier, 2, 2);
        pair.put(0, [0.0, 0.0, 2.5], [0.0; 3]);
        pair.put(1, [0.0, 0.0, 0.0], [0.0; 3]);
        (0..10).for_each(|_| pair.sim.step(&[IDLE, IDLE], 1).unwrap());
        let z = pair.position(0)[2];
        assert!((2.299..2.5).contains(&z), "{tier}: stands at {z}");
        pair.sim.step(&[JUMP, IDLE], 1).unwrap();
        assert!(pair.velocity(0)[2] > 7.0, "{tier}: {:?}", pair.velocity(0));
    }
}

#[test]
fn a_disc_bursts_on_another_player_and_pushes_him() {
    for tier in TIERS {
        let mut pair = crew(&flat(), tier, 2, 2);
        // Yaw 0 looks north, and the muzzle is 0.2 m to the right.
        pair.put(0, [0.0, 0.0, 0.0], [0.0; 3]);
        pair.put(1, [0.0, 20.0, 0.0], [0.0; 3]);
        let mut blast = None;
        for tick in 0..20 {
            let fire = RawInput { fire: u8::from(tick == 0), ..IDLE };
            pair.sim.step(&[fire, IDLE], 1).unwrap();
            blast = blast.or(pair.sim.blasts().first().copied());
            if blast.is_some() {
                break;
            }
        }
        let blast = blast.unwrap_or_else(|| panic!("{tier}: no blast"));
        assert_eq!(blast.player, 0);
        let near = |x: f64, y: f64| (x - y).abs() < 1e-4;
        assert!(near(blast.position[1], 19.5), "{tier}: on his near face, {blast:?}");
        assert!(near(blast.position[0], 0.2) && near(blast.normal_y(), -1.0), "{tier}: {blast:?}");
        // d0 from (0.2, 19.5, 1.5) to (0, 20, 1.15): 0.641, power 0.641 (1 - 1/7.5).
        let v = pair.velocity(1);
        let speed = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let d0 = (0.2f64.powi(2) + 0.5f64.powi(2) + 0.35f64.powi(2)).sqrt();
        let expected = 150.0 / 9.0 * d0 * (1.0 - 1.0 / 7.5);
        assert!((speed - expected).abs() < 1e-3, "{tier}: {speed} instead of {expected}");
        assert!(v[1] > 0.0 && v[0] < 0.0 && v[2] < 0.0, "{tier}: away from the blast, {v:?}");
        assert!(near(pair.get(1, "damage")[0], 0.5 * (1.0 - 1.0 / 7.5)), "{tier}");
        assert!(pair.velocity(0)[1].abs() < 1e-6, "{tier}: the shooter is out of reach");
    }
}

trait NormalY {
    fn normal_y(&self) -> f64;
}

impl NormalY for discjump_core::batch::Shot {
    fn normal_y(&self) -> f64 {
        self.axis[1]
    }
}

#[test]
fn an_explosion_acts_on_everyone_of_its_world_and_on_no_other() {
    let mut crowd = crew(&flat(), "reference", 6, 3);
    for i in 0..6 {
        crowd.put(i, [3.0 * i as f64, 0.0, 0.0], [0.0; 3]);
    }
    let none = [f64::NAN; 3];
    // Player 1's, at his feet; players 3 to 5 are a world of their own.
    crowd.sim.explode(&[none, [3.0, 0.0, 0.0], none, none, none, none], "disc").unwrap();
    let v: Vec<_> = (0..6).map(|i| crowd.velocity(i)).collect();
    assert!((v[1][2] - 16.611).abs() < 1e-3 && v[1][0] == 0.0, "{v:?}");
    assert!(v[0][0] < -1.0 && v[2][0] > 1.0 && v[0][0] == -v[2][0], "{v:?}");
    assert!(v[3..].iter().all(|v| v == &[0.0; 3]), "{v:?}");
    assert!(crowd.sim.blasts().is_empty(), "what is set off by hand does not stay");
}

#[test]
fn players_meet_alike_a_thousand_million_metres_away() {
    let map = flat();
    for tier in ["authentic", "reference"] {
        let states = [0.0, 512.0 * 1_900_000.0].map(|far| {
            let mut pair = crew(&map, tier, 2, 2);
            pair.put(0, [far - 3.0, 0.25, 0.0], [20.0, 0.0, 0.0]);
            pair.put(1, [far + 3.0, 0.0, 0.0], [-5.0, 0.0, 0.0]);
            (0..40).for_each(|t| pair.sim.step(&[armed(1, t), armed(2, t)], 1).unwrap());
            let stride = 24;
            (pair.bytes(0)[stride..].to_vec(), pair.bytes(1)[stride..].to_vec())
        });
        assert_eq!(states[0], states[1], "{tier}");
    }
}

#[test]
fn a_world_goes_on_from_a_snapshot_with_everything_in_the_air() {
    let map = rolling();
    let mut whole = crew(&map, "authentic", 4, 2);
    let play = |crew: &mut Crew, ticks: core::ops::Range<u64>| {
        for tick in ticks {
            let inputs: Vec<_> = (0..4).map(|i| armed(i, tick)).collect();
            crew.sim.step(&inputs, 1).unwrap();
        }
    };
    play(&mut whole, 0..63);
    assert!(whole.sim.projectiles().len() > 1);
    let snapshot = whole.sim.snapshot();
    play(&mut whole, 63..160);
    let mut other = crew(&map, "authentic", 4, 2);
    other.sim.restore(&snapshot).unwrap();
    play(&mut other, 63..160);
    assert_eq!(whole.sim.digest(), other.sim.digest());
    assert_eq!(whole.sim.blasts(), other.sim.blasts());
}
