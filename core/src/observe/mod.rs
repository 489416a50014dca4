//! What an agent sees: one row of float32 per player, and the documented layout of that row.

mod landing;
mod ski;

pub use ski::{CLIP, LayoutField, SkiObservation};

use crate::real::Scalar;
use crate::terrain::{Ground, Surface};

/// The ground as an agent sees it: where there is none, level at the map's lowest height
/// (docs/physics.md, section 12).
fn seen_ground<T: Scalar>(surface: &Surface<'_, T>, map: i32, x: T, y: T, lowest: T) -> Ground<T> {
    let ground = surface.ground::<T>(map, x, y);
    if ground.exists {
        return ground;
    }
    Ground { height: lowest, slope_x: T::zero(), slope_y: T::zero(), exists: false }
}
