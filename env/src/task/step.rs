//! One decision, as each front end wants it back.

use super::TaskBatch;
use super::actions::{of_batch, of_one, readable};
use super::info::{Infos, Value};
use crate::arrays::{Buffers, Column};
use crate::calls::{away, here};
use discjump_core::batch::{Autoreset, Rewards, Status, StatusOutput, StepOutput};
use discjump_core::task::{ActionKind, Actions};
use numpy::ndarray::{Ix1, Ix2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Steps of up to this many ticks in all keep the interpreter's lock: it costs more to let go of it, and to
/// wait until another thread gives it back, than these take (some 10 us).
const KEEPS_LOCK: usize = 64;

/// What numpy is given by steps and resets.
pub(super) struct Outputs {
    pub(super) observations: Buffers<f32, Ix2>,
    /// The observation of a batch of one.
    row: Column<f32>,
    rewards: Column<f64>,
    rounded: Column<f32>,
    terminated: Column<bool>,
    truncated: Column<bool>,
    dones: Column<bool>,
    /// Truncations of a step that does not return them.
    scratch: Vec<bool>,
    pub(super) infos: Infos,
}

impl Outputs {
    /// For `n` environments with `row` numbers in an observation.
    pub(super) fn new(
        py: Python<'_>,
        n: usize,
        row: usize,
        ends: &[(&'static str, Value)],
    ) -> PyResult<Self> {
        Ok(Self {
            observations: Buffers::new(Ix2(n, row)),
            row: Buffers::new(Ix1(row)),
            rewards: Buffers::new(Ix1(n)),
            rounded: Buffers::new(Ix1(n)),
            terminated: Buffers::new(Ix1(n)),
            truncated: Buffers::new(Ix1(n)),
            dones: Buffers::new(Ix1(n)),
            scratch: Vec::new(),
            infos: Infos::new(py, n, ends)?,
        })
    }
}

/// Observations, rewards, terminations, truncations, info.
pub(super) type Step<'py> = (
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyDict>,
);

/// Observations, rewards, ends, and whether there is an end.
pub(super) type FlatStep<'py> =
    (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<bool>>, bool);

/// Observation, reward, terminated, truncated, info.
pub(super) type SingleStep<'py> = (Bound<'py, PyArray1<f32>>, f64, bool, bool, Bound<'py, PyDict>);

impl TaskBatch {
    fn action_shape(&self) -> [usize; 2] {
        [self.batch.len(), self.batch.action_bins().len()]
    }

    pub(super) fn step_columns<'py>(
        &mut self,
        py: Python<'py>,
        actions: &Bound<'py, PyAny>,
    ) -> PyResult<Step<'py>> {
        let (shape, kind) = (self.action_shape(), self.batch.action_kind());
        let mut observations = self.outputs.observations.take(py);
        let mut rewards = self.outputs.rewards.take(py);
        let mut terminated = self.outputs.terminated.take(py);
        let mut truncated = self.outputs.truncated.take(py);
        let mut now = self.outputs.infos.take(py);
        let output = StepOutput {
            observations: observations.contents(),
            rewards: Rewards::F64(rewards.contents()),
            terminated: terminated.contents(),
            truncated: truncated.contents(),
            status: Some(now.output()),
        };
        with_actions(actions, shape, kind, |actions| self.play(py, actions, output))?;
        self.remember(observations.contents());
        let info = self.outputs.infos.everyone(py, now)?;
        if !self.batch.finished().is_empty() {
            self.add_ends(&info)?;
        }
        Ok((
            observations.hand_over(),
            rewards.hand_over(),
            terminated.hand_over(),
            truncated.hand_over(),
            info,
        ))
    }

    pub(super) fn step_flat<'py>(
        &mut self,
        py: Python<'py>,
        actions: &Bound<'py, PyAny>,
    ) -> PyResult<FlatStep<'py>> {
        let (n, shape, kind) = (self.batch.len(), self.action_shape(), self.batch.action_kind());
        let mut observations = self.outputs.observations.take(py);
        let mut rewards = self.outputs.rounded.take(py);
        let mut dones = self.outputs.dones.take(py);
        let mut truncated = core::mem::take(&mut self.outputs.scratch);
        truncated.resize(n, false);
        let output = StepOutput {
            observations: observations.contents(),
            rewards: Rewards::F32(rewards.contents()),
            terminated: dones.contents(),
            truncated: &mut truncated,
            status: None,
        };
        let played = with_actions(actions, shape, kind, |actions| self.play(py, actions, output));
        dones.contents().iter_mut().zip(&truncated).for_each(|(done, &truncated)| *done |= truncated);
        self.outputs.scratch = truncated;
        played?;
        self.remember(observations.contents());
        let ended = !self.batch.finished().is_empty();
        Ok((observations.hand_over(), rewards.hand_over(), dones.hand_over(), ended))
    }

    pub(super) fn step_single<'py>(
        &mut self,
        py: Python<'py>,
        action: &Bound<'py, PyAny>,
    ) -> PyResult<SingleStep<'py>> {
        let mut observation = self.outputs.row.take(py);
        let [mut reward, mut distance, mut speed, mut time] = [[0.0]; 4];
        let [mut terminated, mut truncated, mut outside] = [[false]; 3];
        let output = StepOutput {
            observations: observation.contents(),
            rewards: Rewards::F64(&mut reward),
            terminated: &mut terminated,
            truncated: &mut truncated,
            status: Some(StatusOutput {
                distance: &mut distance,
                speed: &mut speed,
                time: &mut time,
                outside: &mut outside,
            }),
        };
        let [_, size] = self.action_shape();
        match of_one(action, size) {
            Some(action) => self.play(py, action, output)?,
            None => {
                let kind = self.batch.action_kind();
                let row = action.get_item(py.None())?;
                with_actions(&row, [1, size], kind, |action| self.play(py, action, output))?;
            }
        }
        let info = match self.batch.finished() {
            [] => {
                let [outside] = outside;
                let ([distance], [speed], [time]) = (distance, speed, time);
                self.outputs.infos.row(py, &Status { distance, speed, time, outside, terrain: 0 })?
            }
            [(_, outcome), ..] => self.outputs.infos.last_row(py, outcome)?,
        };
        Ok((observation.hand_over(), reward[0], terminated[0], truncated[0], info))
    }

    fn play(&mut self, py: Python<'_>, actions: Actions<'_>, output: StepOutput<'_>) -> PyResult<()> {
        let batch = &mut self.batch;
        if batch.len() * self.frame_skip <= KEEPS_LOCK {
            here(|| batch.step(actions, output))?;
        } else {
            away(py, |go_on| batch.step_while(actions, output, go_on))?;
        }
        self.life.stepped(batch.finished());
        Ok(())
    }

    /// Adds what the ends of episodes say, as gymnasium's vector environments do.
    fn add_ends(&mut self, info: &Bound<'_, PyDict>) -> PyResult<()> {
        let (py, ended) = (info.py(), self.batch.finished());
        if self.autoreset != Autoreset::SameStep {
            return self.outputs.infos.add_ends(info, ended);
        }
        let mut final_observations: Vec<Py<PyAny>> = (0..self.batch.len()).map(|_| py.None()).collect();
        let rows = self.final_rows(py)?;
        for (k, (env, _)) in ended.iter().enumerate() {
            final_observations[*env] = rows.get_item(k)?.unbind();
        }
        let mut mask = vec![false; self.batch.len()];
        ended.iter().for_each(|&(env, _)| mask[env] = true);
        info.set_item("final_obs", PyArray1::from_vec(py, final_observations))?;
        info.set_item("_final_obs", PyArray1::from_slice(py, &mask))?;
        info.set_item("final_info", self.outputs.infos.ends(py, ended)?)?;
        info.set_item("_final_info", PyArray1::from_vec(py, mask))
    }
}

/// Calls with the actions in `value`, copied first where they cannot be read in place.
fn with_actions(
    value: &Bound<'_, PyAny>,
    shape: [usize; 2],
    kind: ActionKind,
    call: impl FnOnce(Actions<'_>) -> PyResult<()>,
) -> PyResult<()> {
    if let Some(actions) = of_batch(value, shape) {
        return call(actions);
    }
    let copied = readable(value, shape, kind)?;
    call(of_batch(&copied, shape).expect("made readable"))
}
