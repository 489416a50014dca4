//! The bits of `discjump/Ski-v0` and of a scene with discs, on whatever this was compiled for.
//!
//! Contract: another instruction set, another target feature, another profile, another lane width compute the same
//! bits. The digests are those of the wheel (`tests/golden/test_across_builds.py` plays the same from Python), so a
//! run of this test on another target compares two instruction sets:
//!
//! ```text
//! cargo test -p discjump-core --test golden --target aarch64-unknown-linux-musl
//! ```
//!
//! `DISCJUMP_GOLDEN=print` prints the lines of the file instead of comparing them.
#![allow(missing_docs)]

mod common;

use common::envs::{self, Envs};
use common::setup;
use core::fmt::Write;
use discjump_core::batch::{Autoreset, EnvironmentsSetup, RawInput, ResetRequest, SimulatorSetup};
use discjump_core::observe::Observation;
use discjump_core::task::{Level, Pitch, TaskRules};
use discjump_core::terrain::mission::Area;
use discjump_core::terrain::raindance::{Options, generate};
use discjump_core::terrain::{Edge, Heightfield, Maps};
use xxhash_rust::xxh3::Xxh3;

const COUNT: usize = 48;
const DECISIONS: usize = 480;
const TIERS: [&str; 5] = ["reference", "authentic", "swept", "fast", "engine"];

fn ground() -> (Heightfield, Area) {
    let made = generate(0, Options { repeating: false }).unwrap();
    let field = Heightfield::new(made.heights, 257, 257, 8.0, [-1024.0, -1024.0], Edge::Tile).unwrap();
    (field, made.mission.area)
}

/// Five keys of an environment by plain arithmetic, as in `tests/golden/regenerate.py`.
fn keys(env: usize, decision: usize) -> [i8; 5] {
    let drawn = core::array::from_fn(|key| {
        let mixed = ((env * 5 + key) as u64 * 2_654_435_761 + (decision / 5) as u64 * 40_503) % 65_521;
        (mixed % [3, 3, 2, 2, 7][key]) as i8
    });
    let [_, _, _, jet, turn]: [i8; 5] = drawn;
    if env.is_multiple_of(2) { [2, 1, 1, jet, turn] } else { drawn }
}

/// Digest of all environments at the end, and of all that they returned.
fn ski(field: &Heightfield, area: Area, fidelity: &str, lanes: Option<usize>) -> (String, String) {
    let base = envs::ski(COUNT, fidelity);
    let mut envs = Envs::new(EnvironmentsSetup {
        maps: Maps::new(core::slice::from_ref(field)).unwrap().into(),
        pitches: vec![Pitch::bare(area)],
        task: TaskRules {
            time_limit: 1875,
            capture: false,
            levels: vec![Level::beacons((300.0, 800.0), 10.0)],
            turn_rate: 2.34375,
            ..base.task
        },
        observation: Observation::new(&[0.0, 30.0, -30.0], &[10.0, 25.0, 50.0, 90.0], true).unwrap(),
        autoreset: Autoreset::NextStep,
        lanes,
        ..base
    });
    envs.reset(&ResetRequest { seeds: (0..COUNT as u64).collect(), ..ResetRequest::default() });
    let (mut hash, mut ended) = (Xxh3::new(), 0);
    for decision in 0..DECISIONS {
        let actions: Vec<i8> = (0..COUNT).flat_map(|env| keys(env, decision)).collect();
        envs.step(&actions);
        envs.observations.iter().for_each(|x| hash.update(&x.to_bits().to_le_bytes()));
        envs.rewards.iter().for_each(|x| hash.update(&x.to_bits().to_le_bytes()));
        envs.terminated.iter().chain(&envs.truncated).for_each(|&flag| hash.update(&[u8::from(flag)]));
        ended += envs.truncated.iter().filter(|&&flag| flag).count();
    }
    assert!(ended > 24, "{fidelity}: {ended} episodes ended by the clock");
    (envs.batch.digest(), format!("{:032x}", hash.digest128()))
}

/// Digest of players who ski, jet and fire from the middle of the map.
fn discs(field: &Heightfield, fidelity: &str, lanes: Option<usize>) -> String {
    let base = setup(field, fidelity);
    let mut sim = SimulatorSetup { players: COUNT, scene: "disc_jump", lanes, ..base }.build().unwrap();
    for decision in 0..DECISIONS / 4 {
        let pressed = |player| {
            let [forward, strafe, jump, jet, turn] = keys(player, decision);
            RawInput {
                forward: forward - 1,
                strafe: strafe - 1,
                jump: jump as u8,
                jet: jet as u8,
                fire: u8::from(turn > 2),
                turn: 0.25 * f64::from(turn - 3),
                pitch: 0.25 * (player % 5) as f64 - 0.75,
            }
        };
        sim.step(&(0..COUNT).map(pressed).collect::<Vec<_>>(), 4).unwrap();
    }
    sim.digest()
}

fn lines(lanes: Option<usize>) -> String {
    let (field, area) = ground();
    let mut text = String::new();
    for tier in TIERS {
        let (state, returned) = ski(&field, area, tier, lanes);
        writeln!(text, "ski {tier} {state}").unwrap();
        writeln!(text, "returned {tier} {returned}").unwrap();
        writeln!(text, "disc_jump {tier} {}", discs(&field, tier, lanes)).unwrap();
    }
    text
}

#[test]
fn every_target_computes_the_committed_bits() {
    let golden = include_str!("golden/episodes.txt");
    let widest = lines(None);
    if std::env::var("DISCJUMP_GOLDEN").is_ok_and(|asked| asked == "print") {
        print!("{widest}");
        return;
    }
    assert_eq!(widest, golden, "bits of discjump/Ski-v0 need a new id to change: see CHANGELOG.md");
    assert_eq!(lines(Some(1)), golden, "in scalar");
}
