//! A pool of equal-sized heightfields, and the change between world and local coordinates.

use super::heightfield::{Edge, Grid, Heightfield};
use super::kind::SurfaceKind;
use super::surface::Surface;
use crate::error::InputError;
use crate::real::{Scalar, same_type};
use glam::{DVec2, DVec3, IVec2};
use xxhash_rust::xxh3::Xxh3;

/// Farthest tile from the first one that a position may lie in.
pub const MAX_TILE: f64 = 1e9;

/// Farthest up or down that a position may be set, m. An f32 height is known to 8 mm there; much
/// farther up a tick of falling would be lost to rounding, and the player hang in the air.
pub const MAX_ALTITUDE: f64 = 1e5;

/// Equal-sized heightfields in one array. A player knows his map by its offset in it.
///
/// A vertex is stored with its neighbour to the north (with itself in the last row), so that the four
/// corners of a square lie side by side: one load, and mostly one cache line, where rows would take two.
///
/// Local coordinates count from the vertex nearest the map's centre, so that square indices are
/// exact integers and positions within a tile are small.
#[derive(Clone, Debug)]
pub struct Maps {
    grid: Grid,
    kind: SurfaceKind,
    pairs64: Vec<[f64; 2]>,
    pairs32: Vec<[f32; 2]>,
    ranges: Vec<(f64, f64)>,
    highest: f64,
    digest: u128,
}

impl Maps {
    /// Pools heightfields.
    ///
    /// # Errors
    /// If there is none, if their grids or surfaces differ, or if there are more vertices than an `i32` counts.
    pub fn new(terrains: &[Heightfield]) -> Result<Self, InputError> {
        let Some(first) = terrains.first() else {
            return Err(InputError("terrains: expected at least one, got none".into()));
        };
        let (grid, kind) = (first.grid(), first.surface());
        if let Some(k) = terrains.iter().position(|t| t.grid() != grid) {
            return Err(InputError(format!(
                "terrains: expected the same shape, square size, origin and edge everywhere, but number {k} \
                 has {} x {} and differs from number 0 with {} x {}",
                terrains[k].rows(),
                terrains[k].cols(),
                grid.rows,
                grid.cols
            )));
        }
        if let Some(k) = terrains.iter().position(|t| t.surface() != kind) {
            return Err(InputError(format!(
                "terrains: expected the same surface everywhere, but number {k} has {:?} and number 0 {:?}",
                terrains[k].surface().name(),
                kind.name()
            )));
        }
        let total = terrains.len() * grid.vertices();
        if i32::try_from(total).is_err() {
            return Err(InputError(format!("terrains: expected at most 2^31 vertices in all, got {total}")));
        }
        let mut pairs64 = Vec::with_capacity(total);
        for heights in terrains.iter().map(Heightfield::heights) {
            let last_row = &heights[heights.len() - grid.cols..];
            let north = heights[grid.cols..].iter().chain(last_row);
            pairs64.extend(heights.iter().zip(north).map(|(&south, &north)| [south, north]));
        }
        let pairs32 = pairs64.iter().map(|pair| pair.map(|h| h as f32)).collect();
        let ranges: Vec<(f64, f64)> = terrains
            .iter()
            .map(|t| t.heights().iter().fold((f64::MAX, f64::MIN), |(l, h), &z| (l.min(z), h.max(z))))
            .collect();
        let highest = ranges.iter().fold(f64::MIN, |m, r| m.max(r.1));
        let mut digest = Xxh3::new();
        digest.update(format!("{grid:?}").as_bytes());
        for row in terrains.iter().flat_map(|t| t.heights().chunks(grid.cols)) {
            digest.update(&row.iter().flat_map(|h| h.to_le_bytes()).collect::<Vec<u8>>());
        }
        // Triangles are not named: their digests are older than any other surface.
        if kind != SurfaceKind::Triangles {
            digest.update(kind.name().as_bytes());
        }
        Ok(Self { grid: *grid, kind, pairs64, pairs32, ranges, highest, digest: digest.digest128() })
    }

    /// How many maps there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.ranges.len()
    }

    /// The shape, squares, place and edge that all maps share.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What lies between the vertices of every map.
    #[must_use]
    pub fn kind(&self) -> SurfaceKind {
        self.kind
    }

    /// Offset of a map's first vertex: what [`crate::player::Player::map`] holds.
    #[must_use]
    pub fn offset(&self, map: usize) -> i32 {
        i32::try_from(map * self.grid.vertices()).expect("checked when the pool was made")
    }

    /// The map that an offset belongs to.
    #[must_use]
    pub fn index(&self, offset: i32) -> usize {
        offset as usize / self.grid.vertices()
    }

    /// Lowest and highest vertex of a map, m.
    #[must_use]
    pub fn range(&self, map: usize) -> (f64, f64) {
        self.ranges[map]
    }

    /// Bytes of the pool.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.pairs64) + size_of_val(&*self.pairs32)
    }

    /// XXH3-128 of grid, heights and surface.
    #[must_use]
    pub fn digest(&self) -> u128 {
        self.digest
    }

    /// The kernel's view in the arithmetic `T`.
    #[must_use]
    pub fn surface<T: Scalar>(&self) -> Surface<'_, T> {
        let pairs = if T::DOUBLE { same_type(&self.pairs64) } else { same_type(&self.pairs32) };
        Surface::new(pairs, &self.grid, self.kind, self.highest)
    }

    /// World coordinates of the vertex that local coordinates count from, m.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        let [column, row] = self.grid.centre_vertex();
        DVec2::from(self.grid.origin) + DVec2::new(column as f64, row as f64) * self.grid.square_size
    }

    /// A world position as a local one and its tile. Exact for whole tiles.
    ///
    /// # Errors
    /// If the position is not finite, more than 1e9 m or 1e9 tiles away, or more than
    /// [`MAX_ALTITUDE`] up or down.
    pub fn to_local(&self, world: DVec3) -> Result<(DVec3, IVec2), InputError> {
        let fail = || {
            Err(InputError(format!(
                "position: expected finite numbers within 1e9 m and 1e9 tiles of the map and {MAX_ALTITUDE} m of \
                 height 0, got ({}, {}, {})",
                world.x, world.y, world.z
            )))
        };
        if !world.is_finite() || world.abs().max_element() > 1e9 || world.z.abs() > MAX_ALTITUDE {
            return fail();
        }
        let flat = world.truncate() - self.centre();
        if self.grid.edge != Edge::Tile {
            return Ok((flat.extend(world.z), IVec2::ZERO));
        }
        let period = self.size();
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
        let flat = self.centre() + tile.as_dvec2() * self.size() + local.truncate();
        flat.extend(local.z)
    }

    /// Local coordinates of the map's first vertex, m.
    #[must_use]
    pub fn lowest_local(&self) -> DVec2 {
        DVec2::from(self.grid.origin) - self.centre()
    }

    /// Sides of the map along x and y, m: the period of a tiling one.
    #[must_use]
    pub fn size(&self) -> DVec2 {
        DVec2::from(self.grid.size())
    }
}
