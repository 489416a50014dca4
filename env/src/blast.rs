//! The core's explosion formulas, for arrays.

use crate::arrays::array1;
use crate::errors::refused;
use discjump_core::blast::{damage_share, power};
use discjump_core::rules::{Cutoff, Knockback, named};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

type Curves<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// Power of the push and share of the largest damage at distances (n,), m, from the box centre.
#[pyfunction]
pub fn blast_falloff<'py>(
    py: Python<'py>,
    distance: PyReadonlyArray1<'py, f64>,
    formula: &str,
    radius: f64,
    min_box: f64,
    cutoff: &str,
) -> PyResult<Curves<'py>> {
    let formula = named("formula", formula, &Knockback::NAMES).map_err(refused)?;
    let cutoff = named("cutoff", cutoff, &Cutoff::NAMES).map_err(refused)?;
    let distance = distance.as_slice()?;
    let push = distance.iter().map(|&d0| power(d0, min_box, radius, formula, cutoff)).collect();
    let hurt = distance.iter().map(|&d0| damage_share(d0, min_box, radius, cutoff)).collect();
    Ok((array1(py, push), array1(py, hurt)))
}
