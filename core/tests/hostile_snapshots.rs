//! Snapshots with a right checksum and wrong content: a checksum tells damage, not what a stranger wrote.
//!
//! Any four bytes of the players may be anything. Such a snapshot is refused, and nothing changes; or what it
//! holds can be played on: no panic, no hang. (A speed of -2e34 m/s once hung in the next step, deaf to Ctrl-C,
//! and a map that does not exist panicked half-way through.)
#![allow(missing_docs)]

mod common;

use common::crowd::simulator;
use common::envs::{Envs, ski};
use common::*;
use discjump_core::batch::RawInput;
use xxhash_rust::xxh3::xxh3_128;

const HEADER: usize = 36;
const CHECKSUM: usize = 16;

/// The snapshot with four bytes at a place in its body replaced, and a checksum that says so; none at its end.
fn forged(snapshot: &[u8], at: usize, with: [u8; 4]) -> Option<Vec<u8>> {
    let mut bytes = snapshot[..snapshot.len() - CHECKSUM].to_vec();
    bytes.get_mut(HEADER + at..HEADER + at + 4)?.copy_from_slice(&with);
    bytes.extend(xxh3_128(&bytes).to_le_bytes());
    Some(bytes)
}

fn words() -> Vec<[u8; 4]> {
    let reals = [f32::NAN, f32::INFINITY, -2e34, 1e7, -3e9, 1e-40].map(f32::to_le_bytes);
    let whole = [i32::MIN, i32::MAX, -1, 7, 1_999_999_999].map(i32::to_le_bytes);
    // The upper half of an f64 of 1e300, and of a NaN.
    reals.into_iter().chain(whole).chain([[0x3c, 0xe4, 0x37, 0x7e], [0, 0, 0xf8, 0x7f]]).collect()
}

#[test]
fn forged_players_are_refused_or_play_on() {
    for tier in ["authentic", "reference", "fast", "engine"] {
        let map = rolling();
        let base = setup(&map, tier);
        let mut sim = discjump_core::batch::SimulatorSetup { scene: "disc_jump", ..base }.build().unwrap();
        let keys = [RawInput { forward: 1, fire: 1, jet: 1, ..RawInput::default() }];
        sim.step(&keys, 60).unwrap();
        let snapshot = sim.snapshot();
        let (mut refused, mut played) = (0, 0);
        for word in words() {
            for bytes in (0..).map_while(|at| forged(&snapshot, at, word)) {
                let before = sim.digest();
                if let Err(error) = sim.restore(&bytes) {
                    assert!(error.to_string().starts_with("snapshot: player 0"), "{error}");
                    assert_eq!(sim.digest(), before);
                    refused += 1;
                } else {
                    sim.step(&keys, 1).unwrap();
                    let _ = sim.contacts(0, &keys[0]).unwrap();
                    played += 1;
                }
                sim.restore(&snapshot).unwrap();
            }
        }
        assert!(refused > 500 && played > 500, "{tier}: {refused} refused, {played} played");
    }
}

#[test]
fn forged_episodes_are_refused_or_play_on() {
    for tier in ["authentic", "reference", "fast", "engine"] {
        let mut envs = Envs::seeded(ski(1, tier), &[9]);
        (0..10).for_each(|_| envs.play());
        let snapshot = envs.batch.snapshot();
        let actions = envs.actions();
        let (mut refused, mut played) = (0, 0);
        for word in words() {
            for bytes in (0..).map_while(|at| forged(&snapshot, at, word)) {
                let before = envs.batch.digest();
                if let Err(error) = envs.batch.restore(&bytes) {
                    assert!(error.to_string().starts_with("snapshot: environment 0"), "{error}");
                    assert_eq!(envs.batch.digest(), before);
                    refused += 1;
                } else {
                    // What is over, or was never reset, refuses a step.
                    if envs.batch.ready() {
                        envs.step(&actions);
                        let _ = envs.batch.status();
                    }
                    played += 1;
                }
                envs.batch.restore(&snapshot).unwrap();
            }
        }
        assert!(refused > 200 && played > 200, "{tier}: {refused} refused, {played} played");
    }
}

#[test]
fn who_was_played_is_taken_back() {
    // Falling beside a map for an hour, and fresh ones.
    for tier in ["authentic", "reference", "swept", "fast"] {
        let map = discjump_core::terrain::Heightfield::new(
            vec![0.0; 9],
            3,
            3,
            8.0,
            [0.0; 2],
            discjump_core::terrain::Edge::Void,
        )
        .unwrap();
        let mut sim = setup(&map, tier).build().unwrap();
        let fresh = sim.snapshot();
        sim.restore(&fresh).unwrap();
        let keys = [RawInput { forward: 1, jet: 1, ..RawInput::default() }];
        sim.step(&keys, 120_000).unwrap();
        let fallen = sim.snapshot();
        sim.restore(&fallen).unwrap();
        assert_eq!(sim.snapshot(), fallen);
    }
    // A disc that burst beyond its tile was once refused: a tick may take it there.
    let map = rolling();
    let base = setup(&map, "authentic");
    let made = discjump_core::batch::SimulatorSetup { scene: "disc_jump", players: 40, tick_ms: 400, ..base };
    let mut shooters = made.build().unwrap();
    for tick in 0..60 {
        let keys: Vec<_> = (0..40)
            .map(|k| RawInput {
                fire: 1,
                turn: 0.1 * f64::from(k),
                pitch: 0.02 * f64::from(k),
                ..RawInput::default()
            })
            .collect();
        shooters.step(&keys, 1).unwrap();
        let snapshot = shooters.snapshot();
        shooters.restore(&snapshot).unwrap_or_else(|error| panic!("tick {tick}: {error}"));
    }
    let mut many = simulator(64, 2, "authentic");
    many.step(&vec![RawInput { jet: 1, forward: 1, ..RawInput::default() }; 64], 4000).unwrap();
    let snapshot = many.snapshot();
    many.restore(&snapshot).unwrap();
}
