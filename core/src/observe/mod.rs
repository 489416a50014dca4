//! What an agent sees: one row of float32 per player, and the documented layout of that row.

mod landing;
mod ski;

pub use ski::{CLIP, LayoutField, SkiObservation};
