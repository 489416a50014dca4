//! Terrain: a heightfield of squares cut in a checkerboard, and what can be asked of it.

pub mod mission;
pub mod raindance;
pub mod statistics;
