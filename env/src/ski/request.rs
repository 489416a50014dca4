//! What a reset asks for, from Python's arguments.

use crate::arrays::rows;
use crate::errors::refused;
use discjump_core::error::InputError;
use discjump_core::task::CourseRequest;
use glam::DVec2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The fixed parts of `n` episodes on `terrains` maps; empty where nothing is fixed.
pub(super) fn courses(
    py: Python<'_>,
    n: usize,
    terrains: usize,
    start: Option<Bound<'_, PyAny>>,
    goal: Option<Bound<'_, PyAny>>,
    terrain: Option<Vec<i64>>,
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
        let (numbers, columns) = rows(py, "goal", &goal, &[2])?;
        check_rows("goal", numbers.len() / columns, n)?;
        for (course, row) in courses.iter_mut().zip(numbers.chunks_exact(columns)) {
            course.goal = point("goal", row)?;
        }
    }
    if let Some(terrain) = terrain {
        check_rows("terrain", terrain.len(), n)?;
        for (course, &index) in courses.iter_mut().zip(&terrain) {
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
