//! What a step of the ski environment costs: ns per agent step of every lane width this processor has,
//! `cargo bench --bench episodes -- [tier] [environments] [frame skip] [threads] [maps]`
//! (authentic, 4096, 1, 1 and 1 where absent), with full observation, reward, ends and resets.
//!
//! Random keys on generated maps; the widths take turns, call by call, with the same keys, so that the
//! ratios of one run can be trusted. `--only lanes calls` plays one width and nothing else, for a profiler.

use discjump_core::batch::{Autoreset, Environments, EnvironmentsSetup, ResetRequest, Rewards, StepOutput};
use discjump_core::observe::Observation;
use discjump_core::random::{Purpose, bits};
use discjump_core::rules::Physics;
use discjump_core::task::{ACTION_BINS, ActionKind, Actions, Grounds, Level, Pitch, Reward, TaskRules};
use discjump_core::terrain::raindance::{Options, generate};
use discjump_core::terrain::{Edge, Heightfield, Maps};
use std::sync::Arc;
use std::time::Instant;

const WARM_UP: usize = 40;
const CALLS: usize = 60;
/// Sets of keys, drawn beforehand.
const SETS: usize = 16;

struct Bench {
    tier: String,
    environments: usize,
    frame_skip: u32,
    threads: usize,
    maps: Arc<Maps>,
    pitches: Vec<Pitch>,
    actions: Vec<Vec<i8>>,
}

struct Runner {
    batch: Box<dyn Environments>,
    observations: Vec<f32>,
    rewards: Vec<f64>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
}

impl Bench {
    /// The ski task with the options that the Python package has by default.
    fn runner(&self, lanes: usize) -> Option<Runner> {
        let setup = EnvironmentsSetup {
            maps: self.maps.clone(),
            grounds: Grounds::Beacon,
            pitches: self.pitches.clone(),
            solids: Vec::new(),
            ammo: 0,
            count: self.environments,
            fidelity: self.tier.clone(),
            armor: "light".into(),
            energy_pack: false,
            physics: Physics::default(),
            tick_ms: 32,
            task: TaskRules {
                frame_skip: self.frame_skip,
                time_limit: 1875,
                arrival_radius: 8.0,
                capture: false,
                levels: vec![Level::beacons((300.0, 800.0), 20.0)],
                turn_rate: 2.34375,
                reward: Reward::default(),
            },
            actions: ActionKind::MultiDiscrete,
            observation: Observation::new(&[0.0, 30.0, -30.0], &[10.0, 25.0, 50.0, 90.0], true)
                .expect("a valid fan"),
            autoreset: Autoreset::NextStep,
            threads: Some(self.threads),
            lanes: Some(lanes),
        };
        let mut batch = setup.build().ok()?;
        let n = self.environments;
        let mut observations = vec![0.0; n * batch.observation_size()];
        let seeds = (0..n as u64).collect();
        batch.reset(&ResetRequest { seeds, ..ResetRequest::default() }, &mut observations).expect("seeds");
        let flags = vec![false; n];
        Some(Runner {
            batch,
            observations,
            rewards: vec![0.0; n],
            terminated: flags.clone(),
            truncated: flags,
        })
    }

    /// Nanoseconds per agent step.
    fn step(&self, runner: &mut Runner, call: usize) -> f64 {
        let output = StepOutput {
            observations: &mut runner.observations,
            rewards: Rewards::F64(&mut runner.rewards),
            terminated: &mut runner.terminated,
            truncated: &mut runner.truncated,
            status: None,
        };
        let start = Instant::now();
        runner.batch.step(Actions::Int8(&self.actions[call % SETS]), output).expect("valid actions");
        start.elapsed().as_secs_f64() * 1e9 / self.environments as f64
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let only = arguments.iter().position(|a| a == "--only");
    let at = |k: usize, absent: &str| {
        arguments.get(k).filter(|_| only.is_none_or(|o| k < o)).map_or(absent.into(), String::clone)
    };
    let number = |k: usize, absent: &str| at(k, absent).parse::<usize>().expect("a number");
    let (environments, maps) = (number(1, "4096"), number(4, "1"));
    let generated: Vec<_> =
        (0..maps as u64).map(|seed| generate(seed, Options::default()).expect("a terrain")).collect();
    let fields: Vec<_> = generated
        .iter()
        .map(|g| {
            Heightfield::new(g.heights.clone(), 257, 257, 8.0, [-1024.0, -1024.0], Edge::Tile)
                .expect("valid heights")
        })
        .collect();
    let key = |set: usize, k: usize| {
        let draw = bits(set as u64, (k / 5) as u64, Purpose::Velocity, (k % 5) as u32) >> 8;
        (draw % ACTION_BINS[k % 5] as u64) as i8
    };
    let bench = Bench {
        tier: at(0, "authentic"),
        environments,
        frame_skip: number(2, "1") as u32,
        threads: number(3, "1"),
        maps: Arc::new(Maps::new(&fields).expect("maps of one size")),
        pitches: generated.iter().map(|g| Pitch::bare(g.mission.area)).collect(),
        actions: (0..SETS).map(|set| (0..environments * 5).map(|k| key(set, k)).collect()).collect(),
    };
    if let Some(only) = only {
        let number = |k: usize| arguments[only + k].parse::<usize>().expect("--only lanes calls");
        let mut runner = bench.runner(number(1)).expect("a width that this processor has");
        let time: f64 = (0..number(2)).map(|call| bench.step(&mut runner, call)).sum();
        println!("{} {:.2} ns per agent step", runner.batch.digest(), time / number(2) as f64);
        return;
    }
    let mut runners: Vec<_> = [1, 8, 16].into_iter().filter_map(|lanes| bench.runner(lanes)).collect();
    let mut times = vec![Vec::new(); runners.len()];
    for call in 0..WARM_UP + CALLS {
        for (runner, times) in runners.iter_mut().zip(&mut times) {
            let time = bench.step(runner, call);
            if call >= WARM_UP {
                times.push(time);
            }
        }
    }
    println!(
        "{}, {} environments on {maps} maps, frame skip {}, {} threads: ns per agent step, quartiles of {CALLS} calls",
        bench.tier, bench.environments, bench.frame_skip, bench.threads
    );
    times.iter_mut().for_each(|t| t.sort_by(f64::total_cmp));
    let quartile = |t: &[f64], k: usize| t[k * (t.len() - 1) / 4];
    for (runner, t) in runners.iter_mut().zip(&times) {
        runner.batch.time_parts(true);
        (0..CALLS).for_each(|call| {
            bench.step(runner, call);
        });
        let parts = runner.batch.parts();
        let whole: f64 = parts.iter().map(|part| part.1).sum();
        let shares: Vec<_> = parts.iter().map(|p| format!("{} {:.0}%", p.0, 100.0 * p.1 / whole)).collect();
        println!(
            "{:2} lanes: {:6.1} ({:.1} to {:.1}), {:.2} times as fast as one; {}; {} bytes",
            runner.batch.lanes(),
            quartile(t, 2),
            quartile(t, 1),
            quartile(t, 3),
            quartile(&times[0], 2) / quartile(t, 2),
            shares.join(", "),
            runner.batch.bytes_per_environment(),
        );
    }
}
