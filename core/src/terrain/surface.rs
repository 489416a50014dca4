//! The kernel's view of a pool of maps: height and slope at a point.

use super::heightfield::{Edge, Grid};
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
    pub(super) highest: T,
}

/// One square, mirrored in x where its cut runs the other way, so that one formula serves both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square<R: Real> {
    corner: [R; 4],
    /// Whether x is mirrored.
    pub(super) mirrored: R::Mask,
    /// Whether there is ground.
    pub(super) ground: R::Mask,
}

/// The plane of a triangle: height at the square's (mirrored) corner and slopes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane<R> {
    pub(super) z: R,
    /// Slope in mirrored x.
    pub(super) gx: R,
    pub(super) gy: R,
}

/// Height and slope of the ground below or above a point.
#[derive(Clone, Copy, Debug)]
pub struct Ground<R: Real> {
    /// Height, m.
    pub height: R,
    /// dz/dx of the triangle.
    pub slope_x: R,
    /// dz/dy of the triangle.
    pub slope_y: R,
    /// False beyond the rim on [`Edge::Void`].
    pub exists: R::Mask,
}

impl<R: Real> Ground<R> {
    /// The triangle's unit normal.
    #[inline(always)]
    pub fn normal(&self) -> V3<R> {
        unit_normal(self.slope_x, self.slope_y)
    }
}

/// Unit normal of a plane with the given slopes.
#[inline(always)]
pub(super) fn unit_normal<R: Real>(gx: R, gy: R) -> V3<R> {
    let one = R::lit(1.0);
    let up = one / (gx * gx + gy * gy + one).sqrt();
    V3::new(-gx * up, -gy * up, up)
}

impl<R: Real> Square<R> {
    /// The plane of the lower triangle (beside the x axis, mirrored) or of the upper one.
    #[inline(always)]
    pub(super) fn plane(&self, lower: R::Mask, inverse: R) -> Plane<R> {
        let [sw, se, nw, ne] = self.corner;
        let gx = R::select(lower, se - sw, ne - nw) * inverse;
        let gy = R::select(lower, ne - se, nw - sw) * inverse;
        Plane { z: sw, gx, gy }
    }

    /// The slope in x as it is in the world.
    #[inline(always)]
    pub(super) fn world_slope(&self, plane: &Plane<R>) -> R {
        R::select(self.mirrored, -plane.gx, plane.gx)
    }
}

impl<'a, T: Scalar> Surface<'a, T> {
    pub(super) fn new(pairs: &'a [[T; 2]], grid: &Grid, highest: f64) -> Self {
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

    /// The corners of a square of a map.
    #[inline(always)]
    pub(super) fn square<R: Real<Scalar = T>>(&self, map: R::Int, i: R::Int, j: R::Int) -> Square<R> {
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
        let mirrored = parity.is_odd();
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
        let corner = [
            R::select(mirrored, se, sw),
            R::select(mirrored, sw, se),
            R::select(mirrored, ne, nw),
            R::select(mirrored, nw, ne),
        ];
        Square { corner, mirrored, ground }
    }

    /// The inverse of the square size.
    #[inline(always)]
    pub(super) fn inverse<R: Real<Scalar = T>>(&self) -> R {
        R::splat(self.inverse)
    }

    /// Height and slope at a local point (docs/physics.md, section 8). Ties on a cut belong to the
    /// upper triangle.
    #[inline(always)]
    pub fn ground<R: Real<Scalar = T>>(&self, map: R::Int, x: R, y: R) -> Ground<R> {
        let (i, j) = self.square_of(x, y);
        let size = R::splat(self.square);
        let a = x - R::from_int(i) * size;
        let b = y - R::from_int(j) * size;
        let square = self.square::<R>(map, i, j);
        let a = R::select(square.mirrored, size - a, a);
        let plane = square.plane(b.lt(a), self.inverse());
        Ground {
            height: plane.z + plane.gx * a + plane.gy * b,
            slope_x: square.world_slope(&plane),
            slope_y: plane.gy,
            exists: square.ground,
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
