//! Python bindings of `discjump-core`: thin, typed in `_native.pyi`, re-exported by the package.
//!
//! * `terrain`: `Terrain`
//! * `solids`: what stands on one
//! * `simulator`: `Simulator`, bodies without a task
//! * `task`: `TaskBatch`, the episodes behind every gymnasium and SB3 environment
//! * `measure`: both stepped against the clock, without Python in the loop
//! * `blast`: the explosion formulas for arrays
//! * `physics`: the switches of a `Physics`
//! * `pools`: maps that batches share
//! * `build`: what this library was built for
//! * `arrays`: numpy arrays in and out; which buffers may be used again
//! * `calls`: who may call, Ctrl-C, panics
//! * `errors`: refusals as Python exceptions

mod arrays;
mod blast;
mod build;
mod calls;
mod errors;
mod measure;
mod physics;
mod pools;
mod simulator;
mod solids;
mod task;
mod terrain;

use pyo3::prelude::*;

/// Private: what the package `discjump` is made from.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::blast::blast_falloff;
    #[pymodule_export]
    use crate::build::build;
    #[pymodule_export]
    use crate::measure::{time_environments, time_players, time_resets};
    #[pymodule_export]
    use crate::simulator::{Simulator, scenes};
    #[pymodule_export]
    use crate::solids::load_mesh;
    #[pymodule_export]
    use crate::task::TaskBatch;
    #[pymodule_export]
    use crate::terrain::Terrain;
}
