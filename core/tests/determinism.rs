//! The contract of determinism, in bits.
//!
//! * An environment with a seed gives the same observations, rewards, flags and outcomes alone or among
//!   a thousand, at any index, on any number of threads, in either tier (the tiers themselves differ).
//! * So does a player of a simulator.
//! * Different seeds give different episodes.
//! * A snapshot holds everything (see `snapshots.rs`).
#![allow(missing_docs)]

mod common;

use common::crowd::{play, simulator};
use common::envs::{Envs, ski};
use common::*;

const TIERS: [&str; 5] = ["authentic", "reference", "swept", "fast", "engine"];
const DECISIONS: usize = 120;

/// What environments with some seeds return over a run, in a batch of `count` at some indices.
fn traces(count: usize, threads: usize, tier: &str, tracked: &[(usize, u64)]) -> Vec<String> {
    let mut setup = ski(count, tier);
    setup.threads = Some(threads);
    let mut seeds: Vec<u64> = (0..count as u64).map(|k| 50_000 + k).collect();
    tracked.iter().for_each(|&(at, seed)| seeds[at] = seed);
    let mut envs = Envs::seeded(setup, &seeds);
    let mut traces: Vec<String> =
        tracked.iter().map(|&(at, _)| format!("{:?}", envs::bits(envs.row(at)))).collect();
    for _ in 0..DECISIONS {
        envs.play();
        for (trace, &(at, _)) in traces.iter_mut().zip(tracked) {
            trace.push_str(&format!("{:?}", envs.returned(at)));
        }
    }
    traces
}

#[test]
fn an_environment_does_not_know_its_batch_its_index_or_its_threads() {
    for tier in TIERS {
        let seeds: Vec<u64> = vec![7, 8, 1 << 40];
        let alone: Vec<String> = seeds.iter().flat_map(|&s| traces(1, 1, tier, &[(0, s)])).collect();
        let count = |what: &str| alone.iter().map(|t| t.matches(what).count()).min().unwrap();
        assert!(count("success: true") >= 1 && count("success:") >= 2, "episodes end, and others begin");
        assert!(alone[0] != alone[1] && alone[1] != alone[2], "different seeds give different episodes");
        for (count, threads, places) in [
            (3, 1, [2, 0, 1]),
            (64, 2, [0, 63, 31]),
            (1000, 1, [999, 0, 512]),
            (1000, 2, [511, 31, 32]),
            (1000, 3, [64, 999, 700]),
        ] {
            let tracked: Vec<_> = places.into_iter().zip(seeds.iter().copied()).collect();
            let among = traces(count, threads, tier, &tracked);
            assert!(among == alone, "{tier}: {count} environments, {threads} threads");
        }
    }
}

#[test]
fn the_tiers_differ() {
    assert_ne!(traces(1, 1, "authentic", &[(0, 7)]), traces(1, 1, "reference", &[(0, 7)]));
}

#[test]
fn a_player_does_not_know_his_batch_his_index_or_his_threads() {
    for tier in TIERS {
        let alone = |name: u64| {
            let mut sim = simulator(1, 1, tier);
            play(&mut *sim, &[name], 0..200);
            sim.state()
        };
        let expected = [alone(3), alone(4)];
        assert_ne!(expected[0], expected[1]);
        for (players, threads) in [(2, 1), (3, 2), (64, 1), (1000, 1), (1000, 2), (1000, 3)] {
            let mut names: Vec<u64> = (100..100 + players as u64).collect();
            let at = [players - 1, players / 2 - 1];
            (names[at[0]], names[at[1]]) = (3, 4);
            let mut sim = simulator(players, threads, tier);
            play(&mut *sim, &names, 0..200);
            let (state, size) = (sim.state(), sim.state_bytes());
            for k in 0..2 {
                let got = &state[at[k] * size..(at[k] + 1) * size];
                assert!(got == expected[k], "{tier}: {players} players, {threads} threads");
            }
        }
    }
}

/// Ticks taken one by one or at once are the same ticks.
#[test]
fn ten_ticks_are_ten_times_one() {
    for tier in TIERS {
        let (mut a, mut b) = (simulator(3, 1, tier), simulator(3, 1, tier));
        for input in [SKI, JET, FORWARD, IDLE] {
            (0..10).for_each(|_| a.step(&[input; 3], 1).unwrap());
            b.step(&[input; 3], 10).unwrap();
        }
        assert_eq!(a.digest(), b.digest());
        assert_eq!(a.snapshot(), b.snapshot());
    }
}
