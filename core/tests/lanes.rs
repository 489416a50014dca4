//! Lanes are no choice of physics: simulators of 1, 8, 16 and 32 players side by side agree in every bit, at
//! any number of players, in every scene, and take each other's snapshots.
#![allow(missing_docs)]

mod common;

use common::crowd::keys;
use common::{crew::Crew, rolling, setup, widths};
use discjump_core::batch::{Bodies, RawInput, SimulatorSetup};
use discjump_core::random::{Purpose, unit};
use discjump_core::rules::{DiscFlight, Physics};
use discjump_core::solids::{Solid, Solids};
use discjump_core::terrain::{Edge, Heightfield, SurfaceKind};
use glam::DVec3;
use std::sync::Arc;

const TIERS: [&str; 3] = ["authentic", "swept", "fast"];
const SCENES: [&str; 4] = ["ski", "sandbox", "disc_jump", "mission"];

/// Steep hills on a map whose sides are no powers of two.
fn odd(edge: Edge) -> Heightfield {
    let (rows, cols) = (24, 31);
    let wave =
        |i: usize, n: usize| (core::f64::consts::TAU * 3.0 * (i % (n - 1)) as f64 / (n - 1) as f64).sin();
    let heights = (0..rows * cols).map(|k| 20.0 * wave(k % cols, cols) * wave(k / cols, rows)).collect();
    Heightfield::new(heights, rows, cols, 6.5, [-10.0, 30.0], edge).unwrap()
}

/// Boxes about the map's centre, where players start.
fn blocks(terrain: &Heightfield) -> Arc<Solids> {
    let solid = |k: usize| {
        let (x, y) = ((k % 4) as f64 * 40.0 + 180.0, (k / 4) as f64 * 40.0 + 180.0);
        Solid::cuboid("block", DVec3::new(9.0, 7.0, 60.0), DVec3::new(x, y, 30.0), k as f64)
    };
    Arc::new(Solids::new(&(0..16).map(solid).collect::<Vec<_>>(), terrain.grid()).unwrap())
}

fn inputs(players: usize, tick: u64) -> Vec<RawInput> {
    let fire = |k: u64| u8::from((tick / 40 + k).is_multiple_of(3));
    (0..players as u64)
        .map(|k| RawInput { fire: fire(k), pitch: (k % 5) as f64 * 0.3 - 1.4, ..keys(k, tick) })
        .collect()
}

/// Spreads the players over the map and beyond it, some fast, some still, some below the ground, some
/// a thousand tiles away.
fn scatter(crew: &mut Crew, players: usize) {
    for k in 0..players {
        let draw = |counter| unit(9, k as u64, Purpose::Start, counter) - 0.5;
        let far = if k % 5 == 4 { 1e5 } else { 0.0 };
        let place = [256.0 + 300.0 * draw(0) + far, 256.0 + 300.0 * draw(1), 30.0 + 60.0 * draw(2)];
        let speed = [0.0, 10.0, 60.0, 300.0][k % 4];
        crew.put(k, place, [speed * draw(3), speed * draw(4), speed * draw(5)]);
    }
}

/// Plays the same ticks at every width and compares all bits as they go; half-way everybody goes on from
/// another's snapshot. Returns how many bursts were seen, and the last digest.
fn agree(setup: &SimulatorSetup<'_>, ticks: u64) -> (usize, String) {
    let players = setup.players;
    let make = |lanes| {
        let mut crew = Crew::new(&SimulatorSetup { lanes: Some(lanes), ..*setup });
        // Two registers side by side are compiled where they are used most.
        let wide = (setup.scene, setup.fidelity) == ("ski", "authentic");
        assert_eq!(crew.sim.lanes(), if wide { lanes } else { lanes.min(16) });
        scatter(&mut crew, players);
        crew.sim
    };
    let mut one = make(1);
    let mut wide: Vec<Box<dyn Bodies>> = widths().map(make).collect();
    let what = |sim: &dyn Bodies, tick: u64| {
        format!("{} {} {players} players, {} lanes, tick {tick}", setup.scene, setup.fidelity, sim.lanes())
    };
    let mut bursts = 0;
    for tick in 0..ticks {
        let inputs = inputs(players, tick);
        one.step(&inputs, 1).unwrap();
        bursts += one.blasts().len();
        for sim in &mut wide {
            sim.step(&inputs, 1).unwrap();
            if tick % 10 == 0 || tick + 1 == ticks {
                assert!(sim.snapshot() == one.snapshot(), "{}", what(&**sim, tick));
                assert!(sim.state() == one.state() && sim.blasts() == one.blasts(), "{}", what(&**sim, tick));
            }
        }
        if tick == ticks / 2 {
            let snapshots: Vec<_> = wide.iter().map(|sim| sim.snapshot()).collect();
            for (sim, snapshot) in wide.iter_mut().zip(snapshots.iter().rev()) {
                one.restore(snapshot).unwrap();
                sim.restore(snapshot).unwrap();
            }
        }
    }
    (bursts, one.digest())
}

#[test]
fn every_number_of_players_fills_its_blocks_and_no_more() {
    let map = rolling();
    let solids = blocks(&map);
    for players in 1..=70 {
        let (tier, scene) = (TIERS[players % 3], SCENES[players / 3 % 4]);
        let s = SimulatorSetup { players, scene, solids: Some(&solids), ..setup(&map, tier) };
        agree(&s, 60);
    }
}

#[test]
fn every_scene_and_tier_over_hundreds_of_ticks() {
    let map = rolling();
    let solids = blocks(&map);
    for tier in TIERS {
        for scene in SCENES {
            let s = SimulatorSetup { players: 37, scene, solids: Some(&solids), ..setup(&map, tier) };
            let (bursts, digest) = agree(&s, 300);
            assert!(bursts > 40 || scene == "ski" || scene == "sandbox", "{bursts} bursts");
            if scene == "mission" {
                let (_, bare) = agree(&SimulatorSetup { solids: None, ..s }, 300);
                assert_ne!(digest, bare, "the blocks stood in nobody's way");
            }
        }
    }
}

#[test]
fn every_edge_weapon_and_switch() {
    let literal = Physics { disc: DiscFlight::Engine, hysteresis: false, ..Physics::default() };
    let strict = Physics { ski_bug: Some(true), clamp_fixup: true, fixup_swept: true, ..Physics::default() };
    for edge in [Edge::Tile, Edge::Clamp, Edge::Void] {
        let map = odd(edge);
        for (tier, physics, weapon) in
            [("authentic", literal, "disc"), ("swept", strict, "grenade"), ("fast", literal, "mortar")]
        {
            let s = SimulatorSetup {
                players: 21,
                scene: "disc_jump",
                physics,
                weapon,
                energy_pack: true,
                tick_ms: 16,
                ..setup(&map, tier)
            };
            agree(&s, 200);
        }
    }
}

/// Bilinear ground under every scene and tier, and at every edge.
#[test]
fn bilinear_ground() {
    let map = rolling().with_surface(SurfaceKind::Bilinear);
    let solids = blocks(&map);
    for tier in TIERS {
        for scene in SCENES {
            let s = SimulatorSetup { players: 37, scene, solids: Some(&solids), ..setup(&map, tier) };
            let (bursts, digest) = agree(&s, 200);
            assert!(bursts > 20 || scene == "ski" || scene == "sandbox", "{bursts} bursts");
            let (_, cut) = agree(&SimulatorSetup { terrain: &rolling(), ..s }, 20);
            assert_ne!(digest, cut);
        }
    }
    for edge in [Edge::Tile, Edge::Clamp, Edge::Void] {
        let map = odd(edge).with_surface(SurfaceKind::Bilinear);
        for (tier, weapon) in [("authentic", "disc"), ("swept", "grenade"), ("fast", "mortar")] {
            let s = SimulatorSetup { players: 21, scene: "disc_jump", weapon, ..setup(&map, tier) };
            agree(&s, 200);
        }
    }
}

/// What has no lanes takes the argument and runs as ever.
#[test]
fn worlds_of_several_players_and_the_other_tiers_are_scalar() {
    let map = rolling();
    for tier in ["reference", "engine", "anyway"] {
        assert_eq!(SimulatorSetup { lanes: Some(1), ..setup(&map, tier) }.build().unwrap().lanes(), 1);
        for lanes in widths() {
            let s = SimulatorSetup { players: 64, lanes: Some(lanes), ..setup(&map, tier) };
            assert_eq!(s.build().unwrap().lanes(), 1);
        }
    }
    for lanes in widths() {
        let s = setup(&map, "authentic");
        let s = SimulatorSetup { players: 64, players_per_world: 2, lanes: Some(lanes), ..s };
        assert_eq!(s.build().unwrap().lanes(), 1);
    }
}

#[test]
fn a_width_that_there_is_not_is_refused() {
    let map = rolling();
    for lanes in [0, 2, 3, 64, usize::MAX] {
        let refused =
            SimulatorSetup { lanes: Some(lanes), ..setup(&map, "authentic") }.build().err().unwrap();
        assert!(refused.0.starts_with("lanes: expected one of "), "{refused}");
        assert!(refused.0.ends_with(&format!("got {lanes}")), "{refused}");
    }
}
