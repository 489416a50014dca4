//! `TaskBatch`: many environments of a task stepped together.
//!
//! * `step`: a decision, as each front end wants it back
//! * `request`: resets
//! * `actions`: actions from numpy
//! * `info`: the dictionaries of info, from `columns`
//! * `life`: whether a step may be taken

use crate::arrays::{array1, structured};
use crate::calls::{Stepped, changing, exclusive, here, reading, shared};
use crate::errors::refused;
use crate::physics::PhysicsArgument;
use crate::pools::pool;
use crate::simulator::state_fields;
use crate::terrain::Terrain;
use discjump_core::batch::{Autoreset, Environments, EnvironmentsSetup};
use discjump_core::error::InputError;
use discjump_core::observe::{CLIP, Observation};
use discjump_core::task::{ActionKind, Grounds, Level, Pitch, Reward, TaskRules};
use glam::DVec3;
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

/// Name, first number, end, unit and scale of a stretch of an observation.
type Stretch = (&'static str, usize, usize, &'static str, f64);

/// Seeds and numbers of episodes.
type Names<'py> = (Bound<'py, PyArray1<u64>>, Bound<'py, PyArray1<u64>>);

/// Private: a batch of environments.
#[pyclass(module = "discjump._native")]
pub struct TaskBatch {
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
impl TaskBatch {
    #[new]
    #[pyo3(signature = (terrains, num_envs, *, grounds, fidelity, armor, energy_pack, physics, tick_ms, frame_skip,
        actions, turn_rate, time_limit, arrival_radius, levels, capture, ammo, flags, reward, fan_bearings,
        fan_ranges, landing, jet_landings, autoreset, threads, lanes))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments that the package fills from its options"
    )]
    fn new(
        py: Python<'_>,
        terrains: Vec<PyRef<'_, Terrain>>,
        num_envs: usize,
        grounds: &str,
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
        levels: Vec<LevelArgument>,
        capture: bool,
        ammo: i32,
        flags: Option<[[f64; 3]; 2]>,
        reward: (f64, f64, f64, f64, f64),
        fan_bearings: Vec<f64>,
        fan_ranges: Vec<f64>,
        landing: bool,
        jet_landings: bool,
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
        let (progress, time, arrival, death, climb) = reward;
        let grounds = grounds_of(grounds)?;
        let pitches = terrains.iter().enumerate().map(|(k, t)| pitch(k, t, grounds, flags));
        let mission = grounds == Grounds::Stands && terrains.iter().any(|t| t.solids.built.is_some());
        let solids = terrains.iter().filter(|_| mission).map(|t| t.solids.built.clone().unwrap_or_default());
        let fields: Vec<_> = terrains.iter().map(|t| &t.heightfield).collect();
        let autoreset = autoreset_mode(autoreset)?;
        let setup = EnvironmentsSetup {
            maps: pool(&fields)?,
            grounds,
            pitches: pitches.collect::<PyResult<_>>()?,
            solids: solids.collect(),
            ammo,
            count: num_envs,
            fidelity,
            armor,
            energy_pack,
            physics: physics.switches()?,
            tick_ms,
            task: TaskRules {
                frame_skip,
                time_limit: ticks.round() as i32,
                arrival_radius,
                turn_rate,
                reward: Reward { progress, time, arrival, death, climb },
                capture,
                levels: levels.into_iter().map(Level::from).collect(),
            },
            actions: action_kind(actions)?,
            observation: Observation::new(&fan_bearings, &fan_ranges, landing)
                .map_err(refused)?
                .with_jet_landings(jet_landings),
            autoreset,
            threads,
            lanes,
        };
        let columns = info::columns(grounds, setup.task.levels.len());
        let batch = setup.build().map_err(refused)?;
        Ok(Self {
            terrains: fields.len(),
            frame_skip: frame_skip as usize,
            autoreset,
            life: Life::new(num_envs, autoreset),
            outputs: Outputs::new(py, num_envs, batch.observation_size(), &columns)?,
            kept: Vec::new(),
            batch,
        })
    }

    /// How many environments.
    #[getter]
    fn num_envs(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.batch.len())
    }

    /// Players stepped side by side.
    #[getter]
    fn lanes(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.batch.lanes())
    }

    /// Whether a reset must come before the next step.
    #[getter]
    fn halted(slf: &Bound<'_, Self>) -> PyResult<bool> {
        Ok(shared(slf)?.life.halted())
    }

    /// Whether some environment was never reset.
    #[getter]
    fn fresh(slf: &Bound<'_, Self>) -> PyResult<bool> {
        Ok(shared(slf)?.life.fresh())
    }

    /// Numbers in an observation.
    #[getter]
    fn observation_size(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.batch.observation_size())
    }

    /// Observations lie within plus and minus this.
    #[getter]
    fn observation_clip(&self) -> f32 {
        CLIP
    }

    /// Numbers in an action.
    #[getter]
    fn action_size(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.batch.action_bins().len())
    }

    /// Choices of each number of a discrete action: forward, strafe, jump, jet, turn; with a launcher also fire
    /// and pitch.
    #[getter]
    fn action_bins(slf: &Bound<'_, Self>) -> PyResult<Vec<i64>> {
        Ok(shared(slf)?.batch.action_bins().to_vec())
    }

    /// (name, first, end, unit, scale) of every stretch of an observation.
    #[getter]
    fn layout(slf: &Bound<'_, Self>) -> PyResult<Vec<Stretch>> {
        let mut at = 0;
        let fields = shared(slf)?.batch.layout();
        let stretches = fields
            .iter()
            .map(|f| {
                let first = at;
                at += f.count;
                (f.name, first, at, f.unit, f.scale)
            })
            .collect();
        Ok(stretches)
    }

    /// Bytes that one environment takes in memory, beside its observation row.
    #[getter]
    fn bytes_per_env(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.batch.bytes_per_environment())
    }

    /// Begins episodes and returns all observations, float32 (num_envs, observation_size).
    #[pyo3(signature = (seeds=None, mask=None, *, start=None, goal=None, terrain=None))]
    fn reset<'py>(
        slf: &Bound<'py, Self>,
        seeds: Option<PyReadonlyArray1<'py, u64>>,
        mask: Option<PyReadonlyArray1<'py, bool>>,
        start: Option<Bound<'py, PyAny>>,
        goal: Option<Bound<'py, PyAny>>,
        terrain: Option<PyReadonlyArray1<'py, i64>>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (py, mut this) = (slf.py(), changing(slf)?);
        let courses = request::courses(py, this.batch.len(), this.terrains, start, goal, terrain)?;
        this.begin(py, seeds, mask, courses)
    }

    /// One decision of every environment: (observations, rewards, terminated, truncated, info), info in
    /// columns with gymnasium's `_key` masks.
    fn step<'py>(slf: &Bound<'py, Self>, actions: &Bound<'py, PyAny>) -> PyResult<Step<'py>> {
        changing(slf)?.step_columns(slf.py(), actions)
    }

    /// The same as (observations, rewards as float32, dones, whether an episode ended).
    fn step_dones<'py>(slf: &Bound<'py, Self>, actions: &Bound<'py, PyAny>) -> PyResult<FlatStep<'py>> {
        changing(slf)?.step_flat(slf.py(), actions)
    }

    /// One decision of a batch of one: (observation, reward, terminated, truncated, info) without the
    /// dimension of the batch.
    fn step_one<'py>(slf: &Bound<'py, Self>, action: &Bound<'py, PyAny>) -> PyResult<SingleStep<'py>> {
        changing(slf)?.step_single(slf.py(), action)
    }

    /// Columns of info, with masks, of the environments in a mask as they are now; of all where None.
    #[pyo3(signature = (mask=None))]
    fn info<'py>(
        slf: &Bound<'py, Self>,
        mask: Option<PyReadonlyArray1<'py, bool>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut this = changing(slf)?;
        let this = &mut *this;
        let mask = mask.as_ref().map(|mask| request::entries("mask", mask, this.batch.len())).transpose()?;
        this.outputs.infos.columns(slf.py(), this.batch.as_ref(), mask.as_deref())
    }

    /// The info of every environment as it is now.
    fn infos<'py>(slf: &Bound<'py, Self>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let this = reading(slf)?;
        this.batch.status().iter().map(|status| this.outputs.infos.row(slf.py(), status)).collect()
    }

    /// Indices of the environments whose episode ended in the last step, ascending, int64.
    fn finished<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let finished = reading(slf)?.batch.finished().iter().map(|&(i, _)| i as i64).collect();
        Ok(array1(slf.py(), finished))
    }

    /// Their last observations, float32 (len(finished), observation_size).
    fn final_observations<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        reading(slf)?.final_rows(slf.py())
    }

    /// Their last infos.
    fn final_infos<'py>(slf: &Bound<'py, Self>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let this = reading(slf)?;
        let ends = this.batch.finished().iter();
        ends.map(|(_, outcome)| this.outputs.infos.last_row(slf.py(), outcome)).collect()
    }

    /// The infos of their next episodes' beginnings, where those began in the same step.
    fn begun_infos<'py>(slf: &Bound<'py, Self>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let this = reading(slf)?;
        let envs = this.batch.finished().iter().map(|&(env, _)| env);
        envs.map(|env| this.outputs.infos.row(slf.py(), &this.batch.status_of(env))).collect()
    }

    /// A byte per environment: 1 where it was reset once, and 2 where its episode is over.
    fn flags<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<u8>>> {
        Ok(array1(slf.py(), shared(slf)?.life.flags()))
    }

    /// What names each episode: its environment's seed, and its number from 0 on since that seed was given;
    /// both uint64 (num_envs,).
    fn episodes<'py>(slf: &Bound<'py, Self>) -> PyResult<Names<'py>> {
        let (seeds, numbers) = reading(slf)?.batch.episodes().into_iter().unzip();
        Ok((array1(slf.py(), seeds), array1(slf.py(), numbers)))
    }

    /// Which terrain each episode runs on, int64 (num_envs,).
    fn terrain_index<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let indices = reading(slf)?.batch.status().iter().map(|status| status.terrain as i64).collect();
        Ok(array1(slf.py(), indices))
    }

    /// All players' states, as `Simulator.state()`.
    fn state<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let this = reading(slf)?;
        structured(slf.py(), &state_fields(&this.batch.state_fields()), &this.batch.state())
    }

    /// World positions of the goals, float64 (num_envs, 3), m; a beacon's z is the ground's height.
    fn goals<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let goals = reading(slf)?.batch.goals();
        array1(slf.py(), goals.concat()).reshape([goals.len(), 3])
    }

    /// Everything, or everything of one environment, as bytes that `restore` takes.
    #[pyo3(signature = (index=None))]
    fn snapshot<'py>(slf: &Bound<'py, Self>, index: Option<usize>) -> PyResult<Bound<'py, PyBytes>> {
        let this = reading(slf)?;
        let bytes = match index {
            Some(index) => this.batch.snapshot_one(index).map_err(refused)?,
            None => this.batch.snapshot(),
        };
        Ok(PyBytes::new(slf.py(), &bytes))
    }

    /// Goes back to a snapshot of a batch with the same arguments, or puts one environment there.
    #[pyo3(signature = (snapshot, index=None))]
    fn restore(slf: &Bound<'_, Self>, snapshot: &[u8], index: Option<usize>) -> PyResult<()> {
        let mut this = exclusive(slf)?;
        let this = &mut *this;
        here(|| match index {
            Some(index) => this.batch.restore_one(index, snapshot),
            None => this.batch.restore(snapshot),
        })?;
        this.kept.clear();
        let restored = index.map_or(0..this.batch.len(), |index| index..index + 1);
        restored.for_each(|env| this.life.restore(env, this.batch.stage_of(env)));
        Ok(())
    }

    /// 32 hexadecimal digits that name the environments' exact bits.
    fn digest(slf: &Bound<'_, Self>) -> PyResult<String> {
        Ok(reading(slf)?.batch.digest())
    }

    /// Makes the next step fail half-way, as a defect would: for tests of what comes after.
    fn fail_next_step(slf: &Bound<'_, Self>) -> PyResult<()> {
        exclusive(slf)?.batch.fail_next_step();
        Ok(())
    }
}

impl Stepped for TaskBatch {
    fn whole(&self) -> Result<(), InputError> {
        self.batch.whole()
    }
}

impl TaskBatch {
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

/// Distances of goals, then start speed, start height, and how far aside a marker may float; whether the start is
/// the own flag stand.
#[derive(FromPyObject)]
struct LevelArgument((f64, f64), f64, f64, f64, bool);

impl From<LevelArgument> for Level {
    fn from(level: LevelArgument) -> Self {
        let LevelArgument(goal_distance, start_speed, start_height, aside, from_stand) = level;
        Self { goal_distance, start_speed, start_height, aside, from_stand }
    }
}

fn grounds_of(name: &str) -> PyResult<Grounds> {
    match name {
        "beacon" => Ok(Grounds::Beacon),
        "marker" => Ok(Grounds::Marker),
        "stands" => Ok(Grounds::Stands),
        _ => Err(PyValueError::new_err(format!(
            "grounds: expected \"beacon\", \"marker\" or \"stands\", got {name:?}"
        ))),
    }
}

/// Where episodes take place on a terrain: with its own flags, or those given, on the ground where their height
/// is NaN.
fn pitch(k: usize, terrain: &Terrain, grounds: Grounds, flags: Option<[[f64; 3]; 2]>) -> PyResult<Pitch> {
    let area = terrain.area();
    if grounds != Grounds::Stands {
        return Ok(Pitch::bare(area));
    }
    let stands = match (flags, terrain.flag_stands()) {
        (Some(flags), _) => {
            let mut stands = flags;
            for flag in stands.iter_mut().filter(|flag| flag[2].is_nan()) {
                flag[2] = terrain.ground("flags", flag[0], flag[1])?.height;
            }
            stands
        }
        (None, Some(stands)) => stands,
        (None, None) => {
            return Err(PyValueError::new_err(format!(
                "terrains[{k}]: expected one with a mission, as generated ones have, or flags=((x, y), (x, y)); got \
                 one without flags"
            )));
        }
    };
    Ok(Pitch { area, stands: stands.map(DVec3::from) })
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
