//! Batches of small ski episodes, played by a script that sees nothing but its own row.

use super::rolling;
use discjump_core::batch::{Autoreset, Environments, EnvironmentsSetup, ResetRequest, Rewards, StepOutput};
use discjump_core::observe::Observation;
use discjump_core::rules::Physics;
use discjump_core::task::{
    ACTION_SIZE, ActionKind, Actions, Grounds, Level, Outcome, Pitch, Reward, TaskRules,
};
use discjump_core::terrain::mission::Area;
use discjump_core::terrain::{Heightfield, Maps};
use glam::DVec3;

/// Two tiling maps of 512 m, beacons 25 to 60 m away, 8 s to reach them.
pub fn ski(count: usize, fidelity: &str) -> EnvironmentsSetup {
    let first = rolling();
    let heights = first.heights().iter().map(|h| 0.5 * h).collect();
    let (rows, cols) = (first.rows(), first.cols());
    let second = Heightfield::new(heights, rows, cols, 8.0, first.origin(), first.edge()).unwrap();
    EnvironmentsSetup {
        maps: Maps::new(&[first, second]).unwrap().into(),
        grounds: Grounds::Beacon,
        pitches: vec![Pitch::bare(Area { min: [50.0, 50.0], max: [450.0, 450.0] }); 2],
        solids: Vec::new(),
        ammo: 0,
        count,
        fidelity: fidelity.into(),
        armor: "light".into(),
        energy_pack: false,
        physics: Physics::default(),
        tick_ms: 32,
        task: TaskRules {
            frame_skip: 4,
            time_limit: 250,
            arrival_radius: 8.0,
            capture: false,
            levels: vec![Level::beacons((25.0, 60.0), 20.0)],
            turn_rate: 2.0,
            reward: Reward::default(),
        },
        actions: ActionKind::MultiDiscrete,
        observation: Observation::new(&[-30.0, 0.0, 30.0], &[10.0, 40.0], true).unwrap(),
        autoreset: Autoreset::SameStep,
        threads: Some(1),
        lanes: None,
    }
}

/// A batch with its outputs.
pub struct Envs {
    pub batch: Box<dyn Environments>,
    pub observations: Vec<f32>,
    pub rewards: Vec<f64>,
    pub terminated: Vec<bool>,
    pub truncated: Vec<bool>,
}

impl Envs {
    pub fn new(setup: EnvironmentsSetup) -> Self {
        let count = setup.count;
        let batch = setup.build().unwrap();
        let row = batch.observation_size();
        Self {
            batch,
            observations: vec![0.0; count * row],
            rewards: vec![0.0; count],
            terminated: vec![false; count],
            truncated: vec![false; count],
        }
    }

    pub fn seeded(setup: EnvironmentsSetup, seeds: &[u64]) -> Self {
        let mut envs = Self::new(setup);
        envs.reset(&ResetRequest { seeds: seeds.to_vec(), ..ResetRequest::default() });
        envs
    }

    pub fn reset(&mut self, request: &ResetRequest) {
        self.batch.reset(request, &mut self.observations).unwrap();
    }

    pub fn row(&self, env: usize) -> &[f32] {
        let size = self.batch.observation_size();
        &self.observations[env * size..(env + 1) * size]
    }

    /// World place of a player's feet.
    pub fn place(&self, env: usize) -> DVec3 {
        let bytes = self.batch.state();
        let row = bytes.len() / self.batch.len() * env;
        let number = |k: usize| f64::from_le_bytes(bytes[row + 8 * k..row + 8 * k + 8].try_into().unwrap());
        DVec3::new(number(0), number(1), number(2))
    }

    /// Where a part of the observation begins.
    pub fn at(&self, name: &str) -> usize {
        let mut at = 0;
        for field in self.batch.layout() {
            if field.name == name {
                return at;
            }
            at += field.count;
        }
        panic!("no {name} in the observation");
    }

    /// The script: skis towards the beacon, and jets while its tank is all but full.
    pub fn actions(&self) -> Vec<i8> {
        let (beacon, energy) = (self.at("beacon_direction"), self.at("energy"));
        let action = |env: usize| -> [i8; ACTION_SIZE] {
            let row = self.row(env);
            let right = row[beacon + 1];
            let turn = if right > 0.1 {
                1
            } else if right < -0.1 {
                5
            } else {
                3
            };
            [2, 1, 1, i8::from(row[energy] > 0.95), turn]
        };
        (0..self.batch.len()).flat_map(action).collect()
    }

    pub fn step(&mut self, actions: &[i8]) {
        let output = StepOutput {
            observations: &mut self.observations,
            rewards: Rewards::F64(&mut self.rewards),
            terminated: &mut self.terminated,
            truncated: &mut self.truncated,
            status: None,
        };
        self.batch.step(Actions::Int8(actions), output).unwrap();
        for env in 0..self.batch.len() {
            assert!(!(self.terminated[env] && self.truncated[env]), "both flags in environment {env}");
        }
    }

    pub fn play(&mut self) {
        let actions = self.actions();
        self.step(&actions);
    }

    /// How an environment's episode ended in the last step, and its last observation.
    pub fn ended(&self, env: usize) -> Option<(Outcome, Vec<u32>)> {
        let size = self.batch.observation_size();
        let k = self.batch.finished().iter().position(|(at, _)| *at == env)?;
        let row = &self.batch.final_observations()[k * size..(k + 1) * size];
        Some((self.batch.finished()[k].1, bits(row)))
    }

    /// Everything that a step returned for an environment, as bits.
    pub fn returned(&self, env: usize) -> (Vec<u32>, u64, [bool; 2], Option<String>) {
        let ended = self.ended(env).map(|e| format!("{e:?}"));
        let flags = [self.terminated[env], self.truncated[env]];
        (bits(self.row(env)), self.rewards[env].to_bits(), flags, ended)
    }
}

pub fn bits(row: &[f32]) -> Vec<u32> {
    row.iter().map(|x| x.to_bits()).collect()
}
