//! Resets, from Python's arguments.

use super::TaskBatch;
use crate::arrays::rows;
use crate::calls::away;
use crate::errors::refused;
use discjump_core::batch::ResetRequest;
use discjump_core::error::InputError;
use discjump_core::task::CourseRequest;
use glam::DVec2;
use numpy::{Element, PyArray2, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::borrow::Cow;

impl TaskBatch {
    /// Begins episodes and returns all observations.
    pub(super) fn begin<'py>(
        &mut self,
        py: Python<'py>,
        seeds: Option<PyReadonlyArray1<'py, u64>>,
        mask: Option<PyReadonlyArray1<'py, bool>>,
        courses: Vec<CourseRequest>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let n = self.batch.len();
        let seeds = seeds.as_ref().map(|seeds| entries("seeds", seeds, n)).transpose()?;
        let mask = mask.as_ref().map(|mask| entries("mask", mask, n)).transpose()?;
        let mask = mask.as_deref();
        let request = ResetRequest {
            seeds: seeds.map(Cow::into_owned).unwrap_or_default(),
            mask: mask.unwrap_or_default().to_vec(),
            courses,
            others_observed: mask.is_some() && !self.kept.is_empty(),
        };
        let mut array = self.outputs.observations.take(py);
        let observations = array.contents();
        if request.others_observed {
            observations.copy_from_slice(&self.kept);
        }
        let batch = &mut self.batch;
        away(py, |go_on| batch.reset_while(&request, observations, go_on))?;
        self.life.reset(mask);
        if request.others_observed {
            let row = self.batch.observation_size();
            for env in (0..n).filter(|&env| request.mask[env]) {
                let numbers = env * row..(env + 1) * row;
                self.kept[numbers.clone()].copy_from_slice(&array.contents()[numbers]);
            }
        } else {
            self.remember(array.contents());
        }
        Ok(array.hand_over())
    }
}

/// The entries of an array with one per environment.
pub(super) fn entries<'a, T: Element + Copy>(
    name: &str,
    array: &'a PyReadonlyArray1<'_, T>,
    n: usize,
) -> PyResult<Cow<'a, [T]>> {
    check_rows(name, array.len(), n)?;
    Ok(match array.as_slice() {
        Ok(slice) => Cow::Borrowed(slice),
        // Every other one, or backwards.
        Err(_) => Cow::Owned(array.as_array().iter().copied().collect()),
    })
}

/// The fixed parts of `n` episodes on `terrains` maps; empty where nothing is fixed.
pub(super) fn courses(
    py: Python<'_>,
    n: usize,
    terrains: usize,
    start: Option<Bound<'_, PyAny>>,
    goal: Option<Bound<'_, PyAny>>,
    terrain: Option<PyReadonlyArray1<'_, i64>>,
) -> PyResult<Vec<CourseRequest>> {
    let mut courses = Vec::new();
    if start.is_some() || goal.is_some() || terrain.is_some() {
        courses = vec![CourseRequest::default(); n];
    }
    if let Some(start) = start {
        let (numbers, columns) = rows(py, "start", &start, &[2, 3])?;
        check_rows("start", numbers.len() / columns, n)?;
        for (course, row) in courses.iter_mut().zip(numbers.chunks_exact(columns)) {
            course.start = point("start", row)?;
            course.height = row.get(2).copied().filter(|z| course.start.is_some() && !z.is_nan());
        }
    }
    if let Some(goal) = goal {
        let (numbers, columns) = rows(py, "goal", &goal, &[2, 3])?;
        check_rows("goal", numbers.len() / columns, n)?;
        for (course, row) in courses.iter_mut().zip(numbers.chunks_exact(columns)) {
            course.goal = point("goal", row)?;
            course.goal_height = row.get(2).copied().filter(|z| course.goal.is_some() && !z.is_nan());
        }
    }
    if let Some(terrain) = terrain {
        let terrain = entries("terrain", &terrain, n)?;
        for (course, &index) in courses.iter_mut().zip(terrain.as_ref()) {
            course.map = match index {
                -1 => None,
                _ => Some(usize::try_from(index).ok().filter(|&i| i < terrains).ok_or_else(|| {
                    PyValueError::new_err(format!(
                        "terrain: expected -1 or 0 to {}, got {index}",
                        terrains - 1
                    ))
                })?),
            };
        }
    }
    Ok(courses)
}

fn check_rows(name: &str, got: usize, expected: usize) -> PyResult<()> {
    if got == expected {
        return Ok(());
    }
    Err(refused(InputError(format!("{name}: expected {expected} rows, one per environment, got {got}"))))
}

/// A point, or nothing where the row is NaN.
fn point(name: &str, row: &[f64]) -> PyResult<Option<DVec2>> {
    match (row[0].is_nan(), row[1].is_nan()) {
        (true, true) => Ok(None),
        (false, false) if row[0].is_finite() && row[1].is_finite() => Ok(Some(DVec2::new(row[0], row[1]))),
        _ => Err(PyValueError::new_err(format!(
            "{name}: expected finite coordinates in metres, or a row of NaN to draw it, got {row:?}"
        ))),
    }
}
