//! The kernel's view of a pool of maps: height and slope at a point.

use super::facets::Square;
use super::heightfield::{Edge, Grid};
use super::kind::SurfaceKind;
use super::patch::Patch;
use crate::real::{Int, Mask, Real, Scalar, V3};

/// A pool of maps in the arithmetic `T`.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a, T> {
    /// Every vertex with its northern neighbour.
    pairs: &'a [[T; 2]],
    pub(super) square: T,
    inverse: T,
    rows: i32,
    cols: i32,
    centre: [i32; 2],
    period: [T; 2],
    low: [T; 2],
    edge: Edge,
    pub(super) kind: SurfaceKind,
    pub(super) highest: T,
}

/// The corners of one square.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners<R: Real> {
    pub(super) sw: R,
    pub(super) se: R,
    pub(super) nw: R,
    pub(super) ne: R,
    /// Odd where the cut into triangles runs the other way.
    pub(super) parity: R::Int,
    /// Whether there is ground.
    pub(super) ground: R::Mask,
}

/// Height and slope of the ground below or above a point.
#[derive(Clone, Copy, Debug)]
pub struct Ground<R: Real> {
    /// Height, m.
    pub height: R,
    /// dz/dx of the triangle, or of the patch at the point.
    pub slope_x: R,
    /// dz/dy of the same.
    pub slope_y: R,
    /// How fast each slope changes along the other axis within the square, 1/m: 0 on triangles.
    pub twist: R,
    /// False beyond the rim on [`Edge::Void`].
    pub exists: R::Mask,
}

impl<R: Real> Ground<R> {
    /// The unit normal of the triangle, or of the patch at the point.
    #[inline(always)]
    pub fn normal(&self) -> V3<R> {
        unit_normal(self.slope_x, self.slope_y)
    }

    /// The unit normal for whoever goes on a straight way of so many metres from the point: where the patch
    /// bends up towards him it is that of its end, else that of the point. See `patch` for why.
    #[inline(always)]
    pub fn normal_ahead(&self, way: V3<R>) -> V3<R> {
        let zero = R::zero();
        let rises = zero.lt(self.twist * way.x * way.y);
        let twist = R::select(rises, self.twist, zero);
        unit_normal(self.slope_x + twist * way.y, self.slope_y + twist * way.x)
    }
}

/// Unit normal of a plane with the given slopes.
#[inline(always)]
pub(super) fn unit_normal<R: Real>(gx: R, gy: R) -> V3<R> {
    let one = R::lit(1.0);
    let up = one / (gx * gx + gy * gy + one).sqrt();
    V3::new(-gx * up, -gy * up, up)
}

impl<'a, T: Scalar> Surface<'a, T> {
    pub(super) fn new(pairs: &'a [[T; 2]], grid: &Grid, kind: SurfaceKind, highest: f64) -> Self {
        let (rows, cols) = (grid.rows as i32, grid.cols as i32);
        let centre = grid.centre_vertex().map(|i| i as i32);
        let t = T::from_f64;
        let size = grid.square_size;
        Self {
            pairs,
            square: t(size),
            inverse: t(1.0 / size),
            rows,
            cols,
            centre,
            period: grid.size().map(t),
            low: [t(-f64::from(centre[0]) * size), t(-f64::from(centre[1]) * size)],
            edge: grid.edge,
            kind,
            highest: t(highest),
        }
    }

    /// Square indices of a local point, counted from the centre vertex. Beyond [`FARTHEST`] squares,
    /// where nothing tiles, every place counts as that one: the ground is the same all the way.
    #[inline(always)]
    pub(super) fn square_of<R: Real<Scalar = T>>(&self, x: R, y: R) -> (R::Int, R::Int) {
        let inverse = R::splat(self.inverse);
        let (i, j) = ((x * inverse).floor_int(), (y * inverse).floor_int());
        (i.clamp(-FARTHEST, FARTHEST), j.clamp(-FARTHEST, FARTHEST))
    }

    /// Whether a straight path may bend relative to the ground under it within one square.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        self.kind == SurfaceKind::Bilinear
    }

    /// The corners of a square of a map.
    #[inline(always)]
    pub(super) fn corners<R: Real<Scalar = T>>(&self, map: R::Int, i: R::Int, j: R::Int) -> Corners<R> {
        let i = i.clamp(-FARTHEST, FARTHEST) + R::Int::splat(self.centre[0]);
        let j = j.clamp(-FARTHEST, FARTHEST) + R::Int::splat(self.centre[1]);
        let (last_i, last_j) = (self.cols - 2, self.rows - 2);
        let mut ground = R::Mask::splat(true);
        // The south-western vertex, and the square whose parity counts.
        let (column, row, parity);
        match self.edge {
            Edge::Tile => {
                (column, row) = (i.wrap(self.cols - 1), j.wrap(self.rows - 1));
                parity = column + row;
            }
            Edge::Clamp => {
                (column, row) = (i.clamp(0, last_i), j.clamp(0, self.rows - 1));
                parity = i + j;
            }
            Edge::Void => {
                let zero = R::Int::splat(0);
                let outside = i.lt(zero).or(R::Int::splat(last_i).lt(i));
                let outside = outside.or(j.lt(zero)).or(R::Int::splat(last_j).lt(j));
                ground = outside.not();
                (column, row) = (i.clamp(0, last_i), j.clamp(0, last_j));
                parity = i + j;
            }
        }
        let index = map + row * R::Int::splat(self.cols) + column;
        let [mut sw, mut nw, mut se, mut ne] = R::gather_square(self.pairs, index);
        if self.edge == Edge::Clamp {
            // Beyond the rim both corners are the nearer one of the last pair; beyond the northern one
            // they are so already.
            let zero = R::Int::splat(0);
            let (beyond_west, beyond_east) = (i.lt(zero), R::Int::splat(last_i).lt(i));
            (sw, se) = (R::select(beyond_east, se, sw), R::select(beyond_west, sw, se));
            (nw, ne) = (R::select(beyond_east, ne, nw), R::select(beyond_west, nw, ne));
            let beyond_south = j.lt(zero);
            (nw, ne) = (R::select(beyond_south, sw, nw), R::select(beyond_south, se, ne));
        }
        Corners { sw, se, nw, ne, parity, ground }
    }

    /// The inverse of the square size.
    #[inline(always)]
    pub(super) fn inverse<R: Real<Scalar = T>>(&self) -> R {
        R::splat(self.inverse)
    }

    /// Height and slope at a local point (docs/physics.md, section 8). Ties on a cut belong to the
    /// upper triangle, those between two squares to the one farther east or north.
    #[inline(always)]
    pub fn ground<R: Real<Scalar = T>>(&self, map: R::Int, x: R, y: R) -> Ground<R> {
        let (i, j) = self.square_of(x, y);
        let size = R::splat(self.square);
        let a = x - R::from_int(i) * size;
        let b = y - R::from_int(j) * size;
        let corners = self.corners::<R>(map, i, j);
        match self.kind {
            SurfaceKind::Triangles => Square::new(&corners).ground(a, b, size, self.inverse()),
            SurfaceKind::Bilinear => Patch::new(&corners, self.inverse()).ground(a, b),
        }
    }

    /// Brings a local position back into its tile, in [low, low + period), and counts the tiles.
    #[inline(always)]
    pub fn wrap<R: Real<Scalar = T>>(
        &self,
        x: R,
        y: R,
        tile_x: R::Int,
        tile_y: R::Int,
    ) -> (R, R, R::Int, R::Int) {
        if self.edge != Edge::Tile {
            return (x, y, tile_x, tile_y);
        }
        let (x, tile_x) = self.wrap_axis(0, x, tile_x);
        let (y, tile_y) = self.wrap_axis(1, y, tile_y);
        (x, y, tile_x, tile_y)
    }

    #[inline(always)]
    fn wrap_axis<R: Real<Scalar = T>>(&self, axis: usize, x: R, tile: R::Int) -> (R, R::Int) {
        let (low, period) = (R::splat(self.low[axis]), R::splat(self.period[axis]));
        let outside = x.lt(low).or((low + period).le(x));
        if !outside.any() {
            return (x, tile);
        }
        let turns = ((x - low) / period).floor_int();
        let wrapped = x - R::from_int(turns) * period;
        let turned = (tile + turns).clamp(-MAX_TILES, MAX_TILES);
        // Rounding may leave it a hair outside; the square lookup wraps again, so that is harmless.
        (R::select(outside, wrapped, x), R::Int::select(outside, turned, tile))
    }

    /// Metres from a local point in one tile to a point in another, along x and y.
    #[inline(always)]
    pub fn tiles_apart<R: Real<Scalar = T>>(&self, dx: R::Int, dy: R::Int) -> (R, R) {
        (R::from_int(dx) * R::splat(self.period[0]), R::from_int(dy) * R::splat(self.period[1]))
    }
}

/// Squares from the centre beyond which there is no telling them apart: a sweep of any length from
/// there, and the sum of a square's two indices, still count within an `i32`.
const FARTHEST: i32 = 1 << 29;
/// Tile counters stop here, two thousand million metres and more from the first tile: the difference of
/// any two still counts within an `i32`.
const MAX_TILES: i32 = (1 << 30) - 1;
