//! `SkiBatch`: many ski environments stepped together.
//!
//! * `step`: a decision, as each front end wants it back
//! * `request`: resets
//! * `actions`: actions from numpy
//! * `info`: the dictionaries of info, from `columns`
//! * `life`: whether a step may be taken

use crate::arrays::{array1, structured};
use crate::errors::refused;
use crate::physics::PhysicsArgument;
use crate::pools::pool;
use crate::simulator::state_fields;
use crate::terrain::Terrain;
use discjump_core::batch::{Autoreset, Environments, SkiEnvironments};
use discjump_core::observe::{CLIP, SkiObservation};
use discjump_core::task::{ACTION_BINS, ACTION_SIZE, ActionKind, Reward, SkiTask};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

mod actions;
mod columns;
mod info;
mod life;
mod request;
mod step;

use life::Life;
use step::{FlatStep, Outputs, SingleStep, Step};

/// Private: a batch of ski environments.
#[pyclass(module = "discjump._native")]
pub struct SkiBatch {
    pub(crate) batch: Box<dyn Environments>,
    terrains: usize,
    frame_skip: usize,
    autoreset: Autoreset,
    life: Life,
    outputs: Outputs,
    /// A copy of the last observations where resets of a few are to be expected, so that the other rows
    /// need not be observed again; empty where there is none.
    kept: Vec<f32>,
}

#[pymethods]
impl SkiBatch {
    #[new]
    #[pyo3(signature = (terrains, num_envs, *, fidelity, armor, energy_pack, physics, tick_ms, frame_skip, actions,
        turn_rate, time_limit, arrival_radius, goal_distance, start_speed, reward, fan_bearings, fan_ranges, landing,
        autoreset, threads, lanes))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments that the package fills from its options"
    )]
    fn new(
        py: Python<'_>,
        terrains: Vec<PyRef<'_, Terrain>>,
        num_envs: usize,
        fidelity: String,
        armor: String,
        energy_pack: bool,
        physics: PhysicsArgument,
        tick_ms: u32,
        frame_skip: u32,
        actions: &str,
        turn_rate: f64,
        time_limit: f64,
        arrival_radius: f64,
        goal_distance: (f64, f64),
        start_speed: f64,
        reward: (f64, f64, f64),
        fan_bearings: Vec<f64>,
        fan_ranges: Vec<f64>,
        landing: bool,
        autoreset: &str,
        threads: Option<usize>,
        lanes: Option<usize>,
    ) -> PyResult<Self> {
        let ticks = time_limit * 1000.0 / f64::from(tick_ms.max(1));
        if !(1.0..=1e9).contains(&ticks) {
            return Err(PyValueError::new_err(format!(
                "time_limit: expected 1 to 1e9 ticks of {tick_ms} ms, got {time_limit} s"
            )));
        }
        let (progress, time, arrival) = reward;
        let fields: Vec<_> = terrains.iter().map(|t| &t.heightfield).collect();
        let autoreset = autoreset_mode(autoreset)?;
        let setup = SkiEnvironments {
            maps: pool(&fields)?,
            areas: terrains.iter().map(|t| t.area()).collect(),
            count: num_envs,
            fidelity,
            armor,
            energy_pack,
            physics: physics.switches()?,
            tick_ms,
            task: SkiTask {
                frame_skip,
                time_limit: ticks.round() as i32,
                arrival_radius,
                goal_distance,
                start_speed,
                turn_rate,
                reward: Reward { progress, time, arrival },
            },
            actions: action_kind(actions)?,
            observation: SkiObservation::new(&fan_bearings, &fan_ranges, landing).map_err(refused)?,
            autoreset,
            threads,
            lanes,
        };
        let batch = setup.build().map_err(refused)?;
        Ok(Self {
            terrains: fields.len(),
            frame_skip: frame_skip as usize,
            autoreset,
            life: Life::new(num_envs, autoreset),
            outputs: Outputs::new(py, num_envs, batch.observation_size())?,
            kept: Vec::new(),
            batch,
        })
    }

    /// How many environments.
    #[getter]
    fn num_envs(&self) -> usize {
        self.batch.len()
    }

    /// Players stepped side by side.
    #[getter]
    fn lanes(&self) -> usize {
        self.batch.lanes()
    }

    /// Whether a reset must come before the next step.
    #[getter]
    fn halted(&self) -> bool {
        self.life.halted()
    }

    /// Whether some environment was never reset.
    #[getter]
    fn fresh(&self) -> bool {
        self.life.fresh()
    }

    /// Numbers in an observation.
    #[getter]
    fn observation_size(&self) -> usize {
        self.batch.observation_size()
    }

    /// Observations lie within plus and minus this.
    #[getter]
    fn observation_clip(&self) -> f32 {
        CLIP
    }

    /// Numbers in an action.
    #[getter]
    fn action_size(&self) -> usize {
        ACTION_SIZE
    }

    /// Choices of each number of a discrete action: forward, strafe, jump, jet, turn.
    #[getter]
    fn action_bins(&self) -> Vec<i64> {
        ACTION_BINS.to_vec()
    }

    /// (name, first, end, unit, scale) of every stretch of an observation.
    #[getter]
    fn layout(&self) -> Vec<(&'static str, usize, usize, &'static str, f64)> {
        let mut at = 0;
        self.batch
            .layout()
            .iter()
            .map(|f| {
                let first = at;
                at += f.count;
                (f.name, first, at, f.unit, f.scale)
            })
            .collect()
    }

    /// Bytes that one environment takes in memory, beside its observation row.
    #[getter]
    fn bytes_per_env(&self) -> usize {
        self.batch.bytes_per_environment()
    }

    /// Begins episodes and returns all observations, float32 (num_envs, observation_size).
    #[pyo3(signature = (seeds=None, mask=None, *, start=None, goal=None, terrain=None))]
    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        seeds: Option<PyReadonlyArray1<'py, u64>>,
        mask: Option<PyReadonlyArray1<'py, bool>>,
        start: Option<Bound<'py, PyAny>>,
        goal: Option<Bound<'py, PyAny>>,
        terrain: Option<PyReadonlyArray1<'py, i64>>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let courses = request::courses(py, self.batch.len(), self.terrains, start, goal, terrain)?;
        self.begin(py, seeds, mask, courses)
    }

    /// One decision of every environment: (observations, rewards, terminated, truncated, info), info in
    /// columns with gymnasium's `_key` masks.
    fn step<'py>(&mut self, py: Python<'py>, actions: &Bound<'py, PyAny>) -> PyResult<Step<'py>> {
        self.step_columns(py, actions)
    }

    /// The same as (observations, rewards as float32, dones, whether an episode ended).
    fn step_dones<'py>(&mut self, py: Python<'py>, actions: &Bound<'py, PyAny>) -> PyResult<FlatStep<'py>> {
        self.step_flat(py, actions)
    }

    /// One decision of a batch of one: (observation, reward, terminated, truncated, info) without the
    /// dimension of the batch.
    fn step_one<'py>(&mut self, py: Python<'py>, action: &Bound<'py, PyAny>) -> PyResult<SingleStep<'py>> {
        self.step_single(py, action)
    }

    /// Columns of info, with masks, of the environments in a mask as they are now; of all where None.
    #[pyo3(signature = (mask=None))]
    fn info<'py>(
        &mut self,
        py: Python<'py>,
        mask: Option<PyReadonlyArray1<'py, bool>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mask = mask.as_ref().map(|mask| request::entries("mask", mask, self.batch.len())).transpose()?;
        self.outputs.infos.columns(py, self.batch.as_ref(), mask.as_deref())
    }

    /// The info of every environment as it is now.
    fn infos<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.batch.status().iter().map(|status| self.outputs.infos.row(py, status)).collect()
    }

    /// Indices of the environments whose episode ended in the last step, ascending, int64.
    fn finished<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        array1(py, self.batch.finished().iter().map(|&(i, _)| i as i64).collect())
    }

    /// Their last observations, float32 (len(finished), observation_size).
    fn final_observations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.final_rows(py)
    }

    /// Their last infos.
    fn final_infos<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.batch.finished().iter().map(|(_, outcome)| self.outputs.infos.last_row(py, outcome)).collect()
    }

    /// The infos of their next episodes' beginnings, where those began in the same step.
    fn begun_infos<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let envs = self.batch.finished().iter().map(|&(env, _)| env);
        envs.map(|env| self.outputs.infos.row(py, &self.batch.status_of(env))).collect()
    }

    /// A byte per environment: 1 where it was reset once, and 2 where its episode is over.
    fn flags<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        array1(py, self.life.flags())
    }

    /// What names each episode: its environment's seed, and its number from 0 on since that seed was given;
    /// both uint64 (num_envs,).
    fn episodes<'py>(&self, py: Python<'py>) -> (Bound<'py, PyArray1<u64>>, Bound<'py, PyArray1<u64>>) {
        let (seeds, numbers) = self.batch.episodes().into_iter().unzip();
        (array1(py, seeds), array1(py, numbers))
    }

    /// Which terrain each episode runs on, int64 (num_envs,).
    fn terrain_index<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        array1(py, self.batch.status().iter().map(|status| status.terrain as i64).collect())
    }

    /// All players' states, as `Simulator.state()`.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        structured(py, &state_fields(&self.batch.state_fields()), &self.batch.state())
    }

    /// World positions of the beacons, float64 (num_envs, 3), m; z is the ground's height.
    fn goals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let goals = self.batch.goals();
        array1(py, goals.concat()).reshape([goals.len(), 3])
    }

    /// Everything, as bytes that `restore` takes.
    fn snapshot<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.batch.snapshot())
    }

    /// Goes back to a snapshot of a batch with the same arguments; `set_flags` goes back to its flags.
    fn restore(&mut self, snapshot: &[u8]) -> PyResult<()> {
        self.batch.restore(snapshot).map_err(refused)?;
        self.kept.clear();
        Ok(())
    }

    /// Overwrites what `flags` gives, as bytes.
    fn set_flags(&mut self, flags: &[u8]) -> PyResult<()> {
        let (n, got) = (self.batch.len(), flags.len());
        if got != n {
            return Err(PyValueError::new_err(format!(
                "flags: expected {n}, one per environment, got {got}"
            )));
        }
        self.life.restore(flags);
        Ok(())
    }

    /// 32 hexadecimal digits that name the environments' exact bits.
    fn digest(&self) -> String {
        self.batch.digest()
    }
}

impl SkiBatch {
    fn final_rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let rows = self.batch.finished().len();
        array1(py, self.batch.final_observations().to_vec()).reshape([rows, self.batch.observation_size()])
    }

    /// Keeps a copy of the observations that were just written, where that pays.
    fn remember(&mut self, observations: &[f32]) {
        if self.autoreset == Autoreset::Disabled && self.batch.len() > 1 {
            self.kept.clear();
            self.kept.extend_from_slice(observations);
        }
    }
}

fn action_kind(name: &str) -> PyResult<ActionKind> {
    match name {
        "multi_discrete" => Ok(ActionKind::MultiDiscrete),
        "box" => Ok(ActionKind::Box),
        _ => Err(PyValueError::new_err(format!(
            "actions: expected \"multi_discrete\" or \"box\", got {name:?}"
        ))),
    }
}

fn autoreset_mode(name: &str) -> PyResult<Autoreset> {
    match name {
        "next_step" => Ok(Autoreset::NextStep),
        "same_step" => Ok(Autoreset::SameStep),
        "disabled" => Ok(Autoreset::Disabled),
        _ => Err(PyValueError::new_err(format!(
            "autoreset: expected \"next_step\", \"same_step\" or \"disabled\", got {name:?}"
        ))),
    }
}
