//! A map for solids to stand on, and solids for tests.

use discjump_core::solids::{Solid, Solids};
use discjump_core::terrain::{Edge, Grid};
use glam::DVec3;

/// 2 km square about the origin.
pub fn map() -> Grid {
    Grid { rows: 257, cols: 257, square_size: 8.0, origin: [-1024.0, -1024.0], edge: Edge::Tile }
}

pub fn built(solids: &[Solid]) -> Solids {
    Solids::new(solids, &map()).unwrap()
}

/// An upright box by its corners.
pub fn block(low: [f64; 3], high: [f64; 3]) -> Solid {
    let (low, high) = (DVec3::from(low), DVec3::from(high));
    Solid::cuboid("block", high - low, 0.5 * (low + high), 0.0)
}
