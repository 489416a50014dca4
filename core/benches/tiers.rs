//! What a player's tick costs in each movement tier: `cargo bench --bench tiers`.
//!
//! Divan's times are of 1,000 ticks of 64 players on one thread. Times of a shared machine wander; instruction counts
//! do not: `cargo bench --bench tiers -- --once fast 2000` plays so many ticks and nothing else, so the
//! difference of two lengths under `valgrind --tool=callgrind` is the cost of the ticks between.

#[path = "../tests/common/mod.rs"]
mod common;

use common::SKI;
use common::crowd::simulator;
use discjump_core::batch::{Bodies, RawInput};

const TIERS: [&str; 6] = ["reference", "authentic", "swept", "fast", "engine", "anyway"];
const PLAYERS: usize = 64;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    match arguments.iter().position(|a| a == "--once").map(|k| &arguments[k + 1..]) {
        Some([tier, ticks, ..]) => {
            let mut sim = simulator(PLAYERS, 1, tier);
            run(sim.as_mut(), ticks.parse().expect("--once takes a tier and a number of ticks"));
            println!("{}", sim.digest());
        }
        Some(_) => panic!("--once takes a tier and a number of ticks"),
        None => divan::main(),
    }
}

/// Skiers with a heading each, who jet a third of the time. Keys last 10 ticks, so that a step's own cost
/// hardly counts.
fn run(sim: &mut dyn Bodies, ticks: u64) {
    for decision in 0..ticks / 10 {
        let keys = |k: usize| {
            let phase = decision + k as u64;
            RawInput {
                jet: u8::from(phase % 12 < 4),
                turn: if decision == 0 { k as f64 * 0.3 } else { 0.05 },
                ..SKI
            }
        };
        let inputs: Vec<_> = (0..PLAYERS).map(keys).collect();
        sim.step(&inputs, 10).expect("valid inputs");
    }
}

#[divan::bench(args = TIERS, sample_count = 20, sample_size = 1)]
fn ticks(bencher: divan::Bencher, tier: &str) {
    let fresh = || simulator(PLAYERS, 1, tier);
    bencher.with_inputs(fresh).bench_local_values(|mut sim| {
        run(sim.as_mut(), 1000);
        sim
    });
}
