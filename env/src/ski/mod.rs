//! `SkiBatch`: many ski environments stepped together.

use crate::arrays::{Buffers, Flags, array1, structured};
use crate::errors::refused;
use crate::physics::PhysicsArgument;
use crate::pools::pool;
use crate::simulator::state_fields;
use crate::terrain::Terrain;
use discjump_core::batch::{Autoreset, Environments, ResetRequest, Rewards, SkiEnvironments, StepOutput};
use discjump_core::observe::{CLIP, SkiObservation};
use discjump_core::task::{ACTION_BINS, ACTION_SIZE, ActionKind, Actions, Reward, SkiTask};
use numpy::ndarray::{Ix1, Ix2};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

mod report;
mod request;

use report::{outcomes, status};
use request::courses;

/// Private: a batch of ski environments.
#[pyclass(module = "discjump._native")]
pub struct SkiBatch {
    pub(crate) batch: Box<dyn Environments>,
    max_terrain: usize,
    observations: Buffers<f32, Ix2>,
    rewards: Buffers<f64, Ix1>,
    terminated: Flags,
    truncated: Flags,
}

type Step<'py> = (
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
);

#[pymethods]
impl SkiBatch {
    #[new]
    #[pyo3(signature = (terrains, num_envs, *, fidelity, armor, energy_pack, physics, tick_ms, frame_skip, actions,
        turn_rate, time_limit, arrival_radius, goal_distance, start_speed, reward, fan_bearings, fan_ranges, landing,
        autoreset, threads))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments that the package fills from its options"
    )]
    fn new(
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
    ) -> PyResult<Self> {
        let ticks = time_limit * 1000.0 / f64::from(tick_ms.max(1));
        if !(1.0..=1e9).contains(&ticks) {
            return Err(PyValueError::new_err(format!(
                "time_limit: expected 1 to 1e9 ticks of {tick_ms} ms, got {time_limit} s"
            )));
        }
        let (progress, time, arrival) = reward;
        let fields: Vec<_> = terrains.iter().map(|t| &t.heightfield).collect();
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
            autoreset: autoreset_mode(autoreset)?,
            threads,
            lanes: None,
        };
        let batch = setup.build().map_err(refused)?;
        let row = batch.observation_size();
        Ok(Self {
            max_terrain: fields.len(),
            observations: Buffers::new(Ix2(num_envs, row)),
            rewards: Buffers::new(Ix1(num_envs)),
            terminated: Buffers::new(Ix1(num_envs)),
            truncated: Buffers::new(Ix1(num_envs)),
            batch,
        })
    }

    /// How many environments.
    #[getter]
    fn num_envs(&self) -> usize {
        self.batch.len()
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
        seeds: Option<Vec<u64>>,
        mask: Option<Vec<bool>>,
        start: Option<Bound<'py, PyAny>>,
        goal: Option<Bound<'py, PyAny>>,
        terrain: Option<Vec<i64>>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let n = self.batch.len();
        let courses = courses(py, n, self.max_terrain, start, goal, terrain)?;
        if seeds.as_ref().is_some_and(|s| s.len() != n) || mask.as_ref().is_some_and(|m| m.len() != n) {
            return Err(PyValueError::new_err(format!("seeds, mask: expected {n}, one per environment")));
        }
        let request =
            ResetRequest { seeds: seeds.unwrap_or_default(), mask: mask.unwrap_or_default(), courses };
        let array = self.observations.take(py);
        {
            let mut out = array.readwrite();
            let slice = out.as_slice_mut()?;
            let batch = &mut self.batch;
            py.detach(|| batch.reset(&request, slice)).map_err(refused)?;
        }
        Ok(array)
    }

    /// One decision of every environment: (observations, rewards, terminated, truncated).
    fn step<'py>(&mut self, py: Python<'py>, actions: &Bound<'py, PyAny>) -> PyResult<Step<'py>> {
        if let Ok(a) = actions.extract::<PyReadonlyArray2<'_, i64>>() {
            return self.step_with(py, &a, |s| Actions::Int64(s));
        }
        if let Ok(a) = actions.extract::<PyReadonlyArray2<'_, i32>>() {
            return self.step_with(py, &a, |s| Actions::Int32(s));
        }
        if let Ok(a) = actions.extract::<PyReadonlyArray2<'_, i8>>() {
            return self.step_with(py, &a, |s| Actions::Int8(s));
        }
        if let Ok(a) = actions.extract::<PyReadonlyArray2<'_, f32>>() {
            return self.step_with(py, &a, |s| Actions::Float(s));
        }
        let wanted = match self.batch.action_kind() {
            ActionKind::MultiDiscrete => "int8, int32 or int64",
            ActionKind::Box => "float32",
        };
        let got = py.import("numpy")?.call_method1("asarray", (actions,))?;
        let (dtype, shape) = (got.getattr("dtype")?, got.getattr("shape")?);
        let message = format!(
            "actions: expected an array of {wanted}, shape ({}, {ACTION_SIZE}), got {dtype} {shape}",
            self.batch.len(),
        );
        if wanted.contains(&dtype.to_string()) && shape.len()? != 2 {
            return Err(PyValueError::new_err(message));
        }
        Err(PyTypeError::new_err(message))
    }

    /// Indices of the environments whose episode ended in the last step, ascending, int64.
    fn finished<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        array1(py, self.batch.finished().iter().map(|&(i, _)| i as i64).collect())
    }

    /// Their last observations, float32 (len(finished), observation_size).
    fn final_observations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let rows = self.batch.finished().len();
        array1(py, self.batch.final_observations().to_vec()).reshape([rows, self.batch.observation_size()])
    }

    /// How they ended: structured, shape (len(finished),).
    fn outcomes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        outcomes(py, self.batch.finished())
    }

    /// distance (m), speed (m/s), time (s), outside (the mission area), terrain: structured, (num_envs,).
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        status(py, &self.batch.status())
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

    /// Goes back to a snapshot of a batch with the same arguments.
    fn restore(&mut self, snapshot: &[u8]) -> PyResult<()> {
        self.batch.restore(snapshot).map_err(refused)
    }

    /// 32 hexadecimal digits that name the environments' exact bits.
    fn digest(&self) -> String {
        self.batch.digest()
    }
}

impl SkiBatch {
    fn step_with<'py, T: numpy::Element + Clone>(
        &mut self,
        py: Python<'py>,
        actions: &PyReadonlyArray2<'py, T>,
        kind: impl FnOnce(&[T]) -> Actions<'_>,
    ) -> PyResult<Step<'py>> {
        let n = self.batch.len();
        if actions.shape() != [n, ACTION_SIZE] {
            return Err(PyValueError::new_err(format!(
                "actions: expected shape ({n}, {ACTION_SIZE}), got {:?}",
                actions.shape()
            )));
        }
        // Fortran order has a slice too, but its rows are scrambled.
        let copied: Vec<T>;
        let slice = if actions.is_c_contiguous() {
            actions.as_slice()?
        } else {
            copied = actions.as_array().iter().cloned().collect();
            &copied
        };
        let actions = kind(slice);
        let out = (
            self.observations.take(py),
            self.rewards.take(py),
            self.terminated.take(py),
            self.truncated.take(py),
        );
        {
            let (mut a, mut b) = (out.0.readwrite(), out.1.readwrite());
            let (mut c, mut d) = (out.2.readwrite(), out.3.readwrite());
            let output = StepOutput {
                observations: a.as_slice_mut()?,
                rewards: Rewards::F64(b.as_slice_mut()?),
                terminated: c.as_slice_mut()?,
                truncated: d.as_slice_mut()?,
                status: None,
            };
            let batch = &mut self.batch;
            py.detach(|| batch.step(actions, output)).map_err(refused)?;
        }
        Ok(out)
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
