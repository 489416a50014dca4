//! The movement of Tribes 1 (skiing, jetting, disc jumping) as a batched simulator.

pub mod random;
pub mod terrain;
