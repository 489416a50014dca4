//! Solids: bases, bridges, towers and walls as they stand in a world (docs/solids.md).
//!
//! * [`Solid`]: one box, convex hull or closed mesh of triangles, and where it stands.
//! * [`load`]: meshes from OBJ and glTF files, the only part of this room that touches a file.
//! * [`Solids`]: all solids of one map, checked and built. It answers [`Solids::near`] (the broad phase),
//!   [`Solids::sweep_box`] (a player's box along its path), [`Solids::step_up`] and [`Solids::ray`].
//! * [`mission`]: the bases, towers and bridge of a generated mission.
//!
//! Geometry is f64 in world coordinates for every tier. A solid stands once, however often the terrain repeats.

mod build;
mod check;
pub mod load;
pub mod mission;
mod near;
mod ray;
mod shapes;
mod solid;
mod step;
mod sweep;
mod triangle;

pub use build::Solids;
pub use solid::{MAX_COORDINATE, MAX_HULL_POINTS, MAX_TRIANGLES, Placement, Shape, Solid};
pub use step::STEP_GROUND;
pub use sweep::{SKIN, SolidHit};
