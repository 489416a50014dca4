//! What an agent sees: one row of float32 per player, and the documented layout of that row.

mod landing;
mod observation;
mod rows;

pub use observation::{CLIP, LayoutField, Observation, Seen};
pub use rows::Columns;

use crate::real::Real;
use crate::terrain::{Ground, Surface};

/// The ground as an agent sees it: where there is none, level at the map's lowest height
/// (docs/physics.md, section 12).
#[inline(always)]
fn seen_ground<R: Real>(surface: &Surface<'_, R::Scalar>, map: R::Int, x: R, y: R, lowest: R) -> Ground<R> {
    let ground = surface.ground::<R>(map, x, y);
    Ground {
        height: R::select(ground.exists, ground.height, lowest),
        slope_x: R::select(ground.exists, ground.slope_x, R::zero()),
        slope_y: R::select(ground.exists, ground.slope_y, R::zero()),
        twist: ground.twist,
        exists: ground.exists,
    }
}
