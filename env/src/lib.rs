//! Python bindings of `discjump-core`.

use pyo3::prelude::*;

#[pymodule]
mod _native {}
