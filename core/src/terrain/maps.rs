//! A pool of equal-sized heightfields, and the change between world and local coordinates.

use super::heightfield::{Edge, Heightfield};
use super::surface::Surface;
use crate::error::InputError;
use crate::real::Scalar;
use glam::{DVec2, DVec3, IVec2};

/// Farthest tile from the first one that a position may lie in.
pub const MAX_TILE: f64 = 1e9;

/// Equal-sized heightfields in one array. A player knows his map by its offset in it.
///
/// Local coordinates count from the vertex nearest the map's centre, so that square indices are
/// exact integers and positions within a tile are small.
#[derive(Clone, Debug)]
pub struct Maps {
    grid: Heightfield,
    heights64: Vec<f64>,
    heights32: Vec<f32>,
    ranges: Vec<(f64, f64)>,
}

impl Maps {
    /// Pools heightfields.
    ///
    /// # Errors
    /// If there is none, if their grids differ, or if there are more vertices than an `i32` counts.
    pub fn new(terrains: &[Heightfield]) -> Result<Self, InputError> {
        let Some(grid) = terrains.first() else {
            return Err(InputError("terrains: expected at least one, got none".into()));
        };
        if let Some(k) = terrains.iter().position(|t| !t.same_grid(grid)) {
            return Err(InputError(format!(
                "terrains: expected the same shape, square size, origin and edge everywhere, but number {k} \
                 has {} x {} and differs from number 0 with {} x {}",
                terrains[k].rows(),
                terrains[k].cols(),
                grid.rows(),
                grid.cols()
            )));
        }
        let total = terrains.len() * grid.heights().len();
        if i32::try_from(total).is_err() {
            return Err(InputError(format!("terrains: expected at most 2^31 vertices in all, got {total}")));
        }
        let heights64: Vec<f64> = terrains.iter().flat_map(|t| t.heights().iter().copied()).collect();
        let heights32 = heights64.iter().map(|&h| h as f32).collect();
        let ranges = terrains
            .iter()
            .map(|t| t.heights().iter().fold((f64::MAX, f64::MIN), |(l, h), &z| (l.min(z), h.max(z))))
            .collect();
        Ok(Self { grid: grid.clone(), heights64, heights32, ranges })
    }

    /// How many maps there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.ranges.len()
    }

    /// The shape, squares, place and edge that all maps share.
    #[must_use]
    pub fn grid(&self) -> &Heightfield {
        &self.grid
    }

    /// Offset of a map's first vertex: what [`crate::player::Player::map`] holds.
    #[must_use]
    pub fn offset(&self, map: usize) -> i32 {
        i32::try_from(map * self.grid.heights().len()).expect("checked when the pool was made")
    }

    /// The map that an offset belongs to.
    #[must_use]
    pub fn index(&self, offset: i32) -> usize {
        offset as usize / self.grid.heights().len()
    }

    /// Lowest and highest vertex of a map, m.
    #[must_use]
    pub fn range(&self, map: usize) -> (f64, f64) {
        self.ranges[map]
    }

    /// Bytes of the pool.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.heights64.len() * 8 + self.heights32.len() * 4
    }

    /// XXH3-128 of every map's digest.
    #[must_use]
    pub fn digest(&self) -> u128 {
        let mut bytes: Vec<u8> = self.grid.digest().into_bytes();
        self.heights64.iter().for_each(|h| bytes.extend(h.to_le_bytes()));
        xxhash_rust::xxh3::xxh3_128(&bytes)
    }

    /// The kernel's view in the arithmetic `T`.
    #[must_use]
    pub fn surface<T: Scalar>(&self) -> Surface<'_, T> {
        let highest = self.ranges.iter().fold(f64::MIN, |m, r| m.max(r.1));
        let heights =
            if T::DOUBLE { cast::<f64, T>(&self.heights64) } else { cast::<f32, T>(&self.heights32) };
        Surface::new(heights, &self.grid, highest)
    }

    fn period(&self) -> DVec2 {
        DVec2::new((self.grid.cols() - 1) as f64, (self.grid.rows() - 1) as f64) * self.grid.square_size()
    }

    /// World coordinates of the vertex that local coordinates count from, m.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        let vertex = DVec2::new(((self.grid.cols() - 1) / 2) as f64, ((self.grid.rows() - 1) / 2) as f64);
        DVec2::from(self.grid.origin()) + vertex * self.grid.square_size()
    }

    /// A world position as a local one and its tile. Exact for whole tiles.
    ///
    /// # Errors
    /// If the position is not finite or more than 1e9 tiles (or, without tiling, 1e9 m) away.
    pub fn to_local(&self, world: DVec3) -> Result<(DVec3, IVec2), InputError> {
        let fail = || {
            Err(InputError(format!(
                "position: expected finite numbers within 1e9 m and 1e9 tiles of the map, got ({}, {}, {})",
                world.x, world.y, world.z
            )))
        };
        if !world.is_finite() || world.abs().max_element() > 1e9 {
            return fail();
        }
        let flat = world.truncate() - self.centre();
        if self.grid.edge() != Edge::Tile {
            return Ok((flat.extend(world.z), IVec2::ZERO));
        }
        let period = self.period();
        let low = self.lowest_local();
        let tile = ((flat - low) / period).floor();
        if tile.abs().max_element() > MAX_TILE {
            return fail();
        }
        Ok(((flat - tile * period).extend(world.z), tile.as_ivec2()))
    }

    /// The world position of a local one in a tile.
    #[must_use]
    pub fn to_world(&self, local: DVec3, tile: IVec2) -> DVec3 {
        let flat = self.centre() + tile.as_dvec2() * self.period() + local.truncate();
        flat.extend(local.z)
    }

    /// Local coordinates of the map's first vertex, m.
    #[must_use]
    pub fn lowest_local(&self) -> DVec2 {
        DVec2::from(self.grid.origin()) - self.centre()
    }

    /// The side lengths of the map, m.
    #[must_use]
    pub fn size(&self) -> DVec2 {
        self.period()
    }
}

/// A slice of the type it already has, which the caller knows by `Scalar::DOUBLE`.
fn cast<F: 'static, T: Scalar>(values: &[F]) -> &[T] {
    assert_eq!(core::any::TypeId::of::<F>(), core::any::TypeId::of::<T>());
    // SAFETY: F and T are the same type, as just checked.
    unsafe { core::slice::from_raw_parts(values.as_ptr().cast(), values.len()) }
}
