//! `discjump.Physics` as the core's switches.

use crate::errors::refused;
use discjump_core::rules::{Acceleration, Cutoff, DiscFlight, Knockback, Physics, named};
use pyo3::prelude::*;

/// The attributes of a `discjump.Physics`.
#[derive(FromPyObject)]
pub struct PhysicsArgument {
    ski_bug: Option<bool>,
    hysteresis: bool,
    clamp_fixup: bool,
    fixup_swept: bool,
    knockback: String,
    cutoff: String,
    accel: String,
    disc: String,
}

impl PhysicsArgument {
    /// The switches; `ValueError` for a name that is unknown.
    pub fn switches(&self) -> PyResult<Physics> {
        Ok(Physics {
            ski_bug: self.ski_bug,
            hysteresis: self.hysteresis,
            clamp_fixup: self.clamp_fixup,
            fixup_swept: self.fixup_swept,
            knockback: named("physics.knockback", &self.knockback, &Knockback::NAMES).map_err(refused)?,
            cutoff: named("physics.cutoff", &self.cutoff, &Cutoff::NAMES).map_err(refused)?,
            accel: named("physics.accel", &self.accel, &Acceleration::NAMES).map_err(refused)?,
            disc: named("physics.disc", &self.disc, &DiscFlight::NAMES).map_err(refused)?,
        })
    }
}
