//! Refusals of the core as Python exceptions.

use discjump_core::error::InputError;
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

/// A `ValueError` with the core's words.
pub fn refused(error: InputError) -> PyErr {
    PyValueError::new_err(error.0)
}
