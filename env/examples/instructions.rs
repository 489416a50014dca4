//! Work whose instructions `.ci/instructions.py` counts: the same on every machine, on one thread, and
//! twice as long with twice the calls, so that the difference of two lengths is the steps and nothing else.
//!
//! `instructions ticks|steps CALLS`: so many calls of 4 ticks of 256 players without a task, or decisions of 1
//! tick of 256 environments. The environment variable `DISCJUMP_LANES` chooses the kernel. It prints the
//! final digest, which is the same for every kernel.
//!
//! An example of this package and not a bench of the core, because here the core is the very one that is in
//! the extension: compiled once, with the same features.

use discjump_core::batch::{
    Autoreset, Bodies, Environments, EnvironmentsSetup, RawInput, ResetRequest, Rewards, SimulatorSetup,
    StepOutput,
};
use discjump_core::observe::Observation;
use discjump_core::random::{Purpose, bits, uniform};
use discjump_core::rules::Physics;
use discjump_core::task::{
    ACTION_BINS, ACTION_SIZE, ActionKind, Actions, Grounds, Level, Pitch, Reward, TaskRules,
};
use discjump_core::terrain::mission::Area;
use discjump_core::terrain::raindance::{Options, generate};
use discjump_core::terrain::{Edge, Heightfield, Maps};

const COUNT: usize = 256;
/// Ticks of a call without a task.
const TICKS: u32 = 4;
/// Sets of keys, taken in turn.
const SETS: usize = 16;
const START: Area = Area { min: [-700.0; 2], max: [700.0; 2] };

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (what, calls) = match &arguments[..] {
        [what, calls] => (what.as_str(), calls.parse().expect("CALLS is a number")),
        _ => panic!("usage: instructions ticks|steps CALLS"),
    };
    let digest = match what {
        "ticks" => ticks(calls),
        "steps" => steps(calls),
        other => panic!("expected ticks or steps, got {other}"),
    };
    println!("{digest}");
}

fn terrain() -> Heightfield {
    let generated = generate(7, Options::default()).expect("seed 7 has a terrain");
    Heightfield::new(generated.heights, 257, 257, 8.0, [-1024.0, -1024.0], Edge::Tile).expect("valid heights")
}

/// Players scattered over the map who ski, run and jet as the dice say.
fn ticks(calls: usize) -> String {
    let terrain = terrain();
    let maps = Maps::new(std::slice::from_ref(&terrain)).expect("one map");
    let setup = SimulatorSetup {
        terrain: &terrain,
        solids: None,
        players: COUNT,
        players_per_world: 1,
        scene: "ski",
        armor: "light",
        energy_pack: false,
        weapon: "disc",
        ammo: None,
        fidelity: "authentic",
        precision: None,
        physics: Physics::default(),
        tick_ms: 32,
        threads: Some(1),
        lanes: None,
    };
    let mut sim: Box<dyn Bodies> = setup.build().expect("a valid setup");
    let mut states = sim.state();
    let stride = sim.state_bytes();
    for (k, state) in states.chunks_exact_mut(stride).enumerate() {
        let draw = |counter| uniform(1, k as u64, Purpose::Start, counter, START.min[0], START.max[0]);
        let (x, y) = (draw(0), draw(1));
        let z = maps.surface::<f64>().ground::<f64>(0, x, y).height;
        for (at, value) in [x, y, z].into_iter().enumerate() {
            state[8 * at..8 * at + 8].copy_from_slice(&value.to_le_bytes());
        }
    }
    sim.set_state(&(0..COUNT).collect::<Vec<_>>(), &states).expect("valid states");
    let inputs: Vec<RawInput> = (0..(SETS * COUNT) as u64).map(keys).collect();
    for inputs in inputs.chunks_exact(COUNT).cycle().take(calls) {
        sim.step(inputs, TICKS).expect("valid inputs");
    }
    sim.digest()
}

fn keys(k: u64) -> RawInput {
    let draw = bits(2, k, Purpose::Velocity, 0);
    RawInput {
        forward: (draw % 3) as i8 - 1,
        strafe: (draw / 3 % 3) as i8 - 1,
        jump: u8::from(!(draw / 9).is_multiple_of(4)),
        jet: (draw / 36 % 2) as u8,
        fire: 0,
        turn: (draw / 72 % 7) as f64 - 3.0,
        pitch: 0.0,
    }
}

/// The default ski task on two maps, actions as the dice say, one tick a decision.
fn steps(calls: usize) -> String {
    let first = terrain();
    let heights = first.heights().iter().map(|h| 0.8 * h).collect();
    let second =
        Heightfield::new(heights, 257, 257, 8.0, first.origin(), first.edge()).expect("valid heights");
    let setup = EnvironmentsSetup {
        maps: Maps::new(&[first, second]).expect("maps of one grid").into(),
        grounds: Grounds::Beacon,
        pitches: vec![Pitch::bare(START); 2],
        solids: Vec::new(),
        ammo: 0,
        count: COUNT,
        fidelity: "authentic".into(),
        armor: "light".into(),
        energy_pack: false,
        physics: Physics::default(),
        tick_ms: 32,
        task: TaskRules {
            frame_skip: 1,
            time_limit: 1875,
            arrival_radius: 8.0,
            capture: false,
            levels: vec![Level::beacons((300.0, 800.0), 10.0)],
            turn_rate: 2.34375,
            reward: Reward::default(),
        },
        actions: ActionKind::MultiDiscrete,
        observation: Observation::new(&[0.0, 30.0, -30.0], &[10.0, 25.0, 50.0, 90.0], true)
            .expect("a valid fan"),
        autoreset: Autoreset::NextStep,
        threads: Some(1),
        lanes: None,
    };
    let mut batch: Box<dyn Environments> = setup.build().expect("a valid setup");
    let mut observations = vec![0.0; COUNT * batch.observation_size()];
    let (mut rewards, mut terminated, mut truncated) =
        (vec![0.0; COUNT], vec![false; COUNT], vec![false; COUNT]);
    let seeds = (0..COUNT as u64).collect();
    batch.reset(&ResetRequest { seeds, ..ResetRequest::default() }, &mut observations).expect("valid seeds");
    let actions: Vec<i8> = (0..SETS * COUNT * ACTION_SIZE)
        .map(|k| (bits(3, k as u64, Purpose::Velocity, 0) % ACTION_BINS[k % ACTION_SIZE] as u64) as i8)
        .collect();
    for actions in actions.chunks_exact(COUNT * ACTION_SIZE).cycle().take(calls) {
        let output = StepOutput {
            observations: &mut observations,
            rewards: Rewards::F64(&mut rewards),
            terminated: &mut terminated,
            truncated: &mut truncated,
            status: None,
        };
        batch.step(Actions::Int8(actions), output).expect("valid actions");
    }
    batch.digest()
}
