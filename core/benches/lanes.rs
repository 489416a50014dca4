//! What side by side gains: ns per player-tick of every lane width this processor has, one thread,
//! `cargo bench --bench lanes -- [tier] [scene] [players] [ticks per call]`
//! (authentic, ski, 16384 and 4 where absent).
//!
//! Skiers with random keys all over a generated map. The widths take turns, call by call, with the same
//! keys, so that what else the machine does touches all alike: the ratios of one run can be trusted, its
//! times only roughly. `--only lanes calls` plays one width and nothing else, for a profiler, or
//! for two builds that take turns.

#[path = "../tests/common/mod.rs"]
mod common;

use common::crowd::keys;
use common::{setup, write_fields};
use discjump_core::batch::Bodies;
use discjump_core::random::{Purpose, unit};
use discjump_core::terrain::raindance::{Options, generate};
use discjump_core::terrain::{Edge, Heightfield, Maps};
use std::time::Instant;

const WARM_UP: u64 = 50;
const CALLS: u64 = 60;

struct Bench {
    tier: String,
    scene: String,
    players: usize,
    ticks: u32,
    terrain: Heightfield,
    maps: Maps,
}

impl Bench {
    /// Players scattered over the map, at the speed of good skiers, up to 20 m above the ground.
    fn simulator(&self, lanes: usize) -> Option<Box<dyn Bodies>> {
        let mut s = setup(&self.terrain, &self.tier);
        (s.scene, s.players, s.lanes) = (&self.scene, self.players, Some(lanes));
        let mut sim = s.build().ok()?;
        let mut states = sim.state();
        let stride = sim.state_bytes();
        for (k, state) in states.chunks_exact_mut(stride).enumerate() {
            let draw = |counter| unit(5, k as u64, Purpose::Start, counter);
            let place = [1800.0 * (draw(0) - 0.5), 1800.0 * (draw(1) - 0.5)];
            let surface = self.maps.surface::<f64>();
            let height = surface.ground::<f64>(0, place[0], place[1]).height;
            let position = [place[0], place[1], height + 20.0 * draw(2)];
            let velocity = [60.0 * (draw(3) - 0.5), 60.0 * (draw(4) - 0.5), 0.0];
            write_fields(&*sim, state, &[("position", &position), ("velocity", &velocity)]);
        }
        sim.set_state(&(0..self.players).collect::<Vec<_>>(), &states).expect("valid states");
        Some(sim)
    }

    fn step(&self, sim: &mut dyn Bodies, call: u64) -> f64 {
        let inputs: Vec<_> =
            (0..self.players as u64).map(|k| keys(k, call * u64::from(self.ticks))).collect();
        let start = Instant::now();
        sim.step(&inputs, self.ticks).expect("valid inputs");
        start.elapsed().as_secs_f64() * 1e9 / (self.players as f64 * f64::from(self.ticks))
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let only = arguments.iter().position(|a| a == "--only");
    let at = |k: usize, absent: &str| {
        arguments.get(k).filter(|_| only.is_none_or(|o| k < o)).map_or(absent.into(), String::clone)
    };
    let number = |k: usize, absent: &str| at(k, absent).parse::<usize>().expect("a number");
    let heights = generate(7, Options::default()).expect("seed 7 has a terrain").heights;
    let terrain =
        Heightfield::new(heights, 257, 257, 8.0, [-1024.0, -1024.0], Edge::Tile).expect("valid heights");
    let maps = Maps::new(std::slice::from_ref(&terrain)).expect("one map");
    let bench = Bench {
        tier: at(0, "authentic"),
        scene: at(1, "ski"),
        players: number(2, "16384"),
        ticks: number(3, "4") as u32,
        terrain,
        maps,
    };
    if let Some(only) = only {
        let number = |k: usize| arguments[only + k].parse::<usize>().expect("--only lanes calls");
        let mut sim = bench.simulator(number(1)).expect("a width that this processor has");
        let mut times: Vec<f64> = (0..number(2) as u64).map(|call| bench.step(&mut *sim, call)).collect();
        times.sort_by(f64::total_cmp);
        println!("{} {:.2} ns per player-tick, the lowest tenth", sim.digest(), times[times.len() / 10]);
        return;
    }
    let mut sims: Vec<_> = [1, 8, 16].into_iter().filter_map(|lanes| bench.simulator(lanes)).collect();
    let mut times = vec![Vec::new(); sims.len()];
    for call in 0..WARM_UP + CALLS {
        for (sim, times) in sims.iter_mut().zip(&mut times) {
            let time = bench.step(&mut **sim, call);
            if call >= WARM_UP {
                times.push(time);
            }
        }
    }
    println!(
        "{} {}, {} players, {} ticks a call, one thread: ns per player-tick, quartiles of {CALLS} calls",
        bench.tier, bench.scene, bench.players, bench.ticks
    );
    times.iter_mut().for_each(|t| t.sort_by(f64::total_cmp));
    let quartile = |t: &[f64], k: usize| t[k * (t.len() - 1) / 4];
    for (sim, t) in sims.iter().zip(&times) {
        assert_eq!(sim.digest(), sims[0].digest(), "{} lanes have the bits of one", sim.lanes());
        println!(
            "{:2} lanes: {:6.2} ({:.2} to {:.2}), {:.2} times as fast as one, {} bytes a player",
            sim.lanes(),
            quartile(t, 2),
            quartile(t, 1),
            quartile(t, 3),
            quartile(&times[0], 2) / quartile(t, 2),
            sim.player_bytes()
        );
    }
}
