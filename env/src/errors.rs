//! Refusals of the core as Python exceptions.

use discjump_core::error::InputError;
use pyo3::PyErr;
use pyo3::exceptions::{PyRuntimeError, PyValueError};

/// A `ValueError` with the core's words.
pub fn refused(error: InputError) -> PyErr {
    PyValueError::new_err(error.0)
}

/// A `RuntimeError` with the core's words: of an object that cannot be used any more.
pub fn unusable(error: InputError) -> PyErr {
    PyRuntimeError::new_err(error.0)
}
