//! Steps against the clock, without Python in the loop: what `discjump bench` compares the ways in with.

use crate::errors::refused;
use crate::simulator::{INPUT_BYTES, Simulator, read_input};
use crate::task::TaskBatch;
use discjump_core::batch::{Environments, RawInput, ResetRequest, Rewards, StepOutput};
use discjump_core::task::Actions;
use numpy::{PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::time::Instant;

/// Buffers of a step. Filled with something, so that their pages are there before the clock starts.
struct Outputs {
    observations: Vec<f32>,
    rewards: Vec<f64>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
}

impl Outputs {
    fn new(batch: &dyn Environments) -> Self {
        let n = batch.len();
        Self {
            observations: vec![1.0; n * batch.observation_size()],
            rewards: vec![1.0; n],
            terminated: vec![true; n],
            truncated: vec![true; n],
        }
    }

    fn lend(&mut self) -> StepOutput<'_> {
        StepOutput {
            observations: &mut self.observations,
            rewards: Rewards::F64(&mut self.rewards),
            terminated: &mut self.terminated,
            truncated: &mut self.truncated,
            status: None,
        }
    }
}

/// Seconds of `calls` steps with the actions (k, num_envs, size) in turn, and with `parts` of each part of them,
/// summed over threads. What the batch keeps for Python does not follow: it is for nothing else afterwards.
#[pyfunction]
#[pyo3(signature = (batch, actions, calls, *, parts=false))]
pub fn time_environments(
    py: Python<'_>,
    mut batch: PyRefMut<'_, TaskBatch>,
    actions: PyReadonlyArray3<'_, i8>,
    calls: usize,
    parts: bool,
) -> PyResult<(f64, Vec<(&'static str, f64)>)> {
    let batch = &mut *batch.batch;
    let (n, size) = (batch.len(), batch.action_bins().len());
    if actions.shape()[0] == 0 || actions.shape()[1..] != [n, size] {
        return Err(PyValueError::new_err(format!(
            "actions: expected shape (k, {n}, {size}) with k >= 1, got {:?}",
            actions.shape()
        )));
    }
    let actions = actions.as_slice()?;
    let mut outputs = Outputs::new(batch);
    batch.time_parts(parts);
    let seconds = py.detach(|| {
        let start = Instant::now();
        for actions in actions.chunks_exact(n * size).cycle().take(calls) {
            batch.step(Actions::Int8(actions), outputs.lend())?;
        }
        Ok(start.elapsed().as_secs_f64())
    });
    let parts = if parts { batch.parts() } else { Vec::new() };
    batch.time_parts(false);
    Ok((seconds.map_err(refused)?, parts))
}

/// Seconds of `calls` resets of one environment each, the environments in turn. The rows of the others are
/// not observed again, as where a caller still has them.
#[pyfunction]
pub fn time_resets(py: Python<'_>, mut batch: PyRefMut<'_, TaskBatch>, calls: usize) -> PyResult<f64> {
    let batch = &mut *batch.batch;
    let n = batch.len();
    let mut observations = Outputs::new(batch).observations;
    let mut request = ResetRequest { mask: vec![false; n], others_observed: true, ..ResetRequest::default() };
    let seconds = py.detach(|| {
        let start = Instant::now();
        for call in 0..calls {
            request.mask[call % n] = true;
            batch.reset(&request, &mut observations)?;
            request.mask[call % n] = false;
        }
        Ok(start.elapsed().as_secs_f64())
    });
    seconds.map_err(refused)
}

/// Seconds of `calls` steps of `ticks` ticks with the inputs in turn, given as k times the bytes of
/// `discjump.INPUT` of all players.
#[pyfunction]
pub fn time_players(
    py: Python<'_>,
    mut simulator: PyRefMut<'_, Simulator>,
    inputs: &[u8],
    ticks: u32,
    calls: usize,
) -> PyResult<f64> {
    let bodies = &mut *simulator.bodies;
    let n = bodies.len();
    if inputs.is_empty() || !inputs.len().is_multiple_of(n * INPUT_BYTES) {
        return Err(PyValueError::new_err(format!(
            "inputs: expected k times {} bytes with k >= 1, got {}",
            n * INPUT_BYTES,
            inputs.len()
        )));
    }
    let inputs: Vec<RawInput> = inputs.chunks_exact(INPUT_BYTES).map(read_input).collect();
    let seconds = py.detach(|| {
        let start = Instant::now();
        for inputs in inputs.chunks_exact(n).cycle().take(calls) {
            bodies.step(inputs, ticks)?;
        }
        Ok(start.elapsed().as_secs_f64())
    });
    seconds.map_err(refused)
}
