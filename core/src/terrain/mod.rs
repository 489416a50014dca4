//! Terrain: a heightfield of squares cut in a checkerboard, and what can be asked of it.
//!
//! * [`Heightfield`]: one terrain as its user gave it, checked, f64.
//! * [`Maps`]: a pool of equal-sized heightfields in one array, in the arithmetic of each tier.
//! * [`Surface`]: the kernel's view of a pool: height, normal and sweep.

mod heightfield;
mod maps;
pub mod mission;
pub mod raindance;
pub mod statistics;
mod surface;
mod sweep;

pub use heightfield::{Edge, Grid, Heightfield};
pub use maps::Maps;
pub use surface::{Ground, Surface};
pub use sweep::Hit;
