//! Terrain: a heightfield of squares, and what can be asked of it.
//!
//! * [`Heightfield`]: one terrain as its user gave it, checked, f64.
//! * [`SurfaceKind`]: what lies between its vertices: triangles cut in a checkerboard, or bilinear patches.
//! * [`Maps`]: a pool of equal-sized heightfields in one array, in the arithmetic of each tier.
//! * [`Surface`]: the kernel's view of a pool: height, normal and sweep.
//!
//! ```text
//! sweep           a walk over the squares under a path
//!   facets, patch one square of it: two triangles, or the bilinear interpolation of its corners
//!     surface     the squares, and the ground at a point
//! ```

mod facets;
mod heightfield;
mod kind;
mod maps;
pub mod mission;
mod patch;
pub mod raindance;
pub mod statistics;
mod surface;
mod sweep;

pub use heightfield::{Edge, Grid, Heightfield};
pub use kind::SurfaceKind;
pub use maps::Maps;
pub use surface::{Ground, Surface};
pub use sweep::Hit;
