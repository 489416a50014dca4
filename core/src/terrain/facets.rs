//! A square cut into two triangles (docs/physics.md, section 8): the game's surface.

use super::surface::{Corners, Ground, Surface};
use super::sweep::{Contact, Course, Filling, Span};
use crate::real::{Int, Mask, Real};

/// One square, mirrored in x where its cut runs the other way, so that one formula serves both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square<R: Real> {
    corner: [R; 4],
    /// Whether x is mirrored.
    mirrored: R::Mask,
    /// Whether there is ground.
    ground: R::Mask,
}

/// The plane of a triangle: height at the square's (mirrored) corner and slopes.
#[derive(Clone, Copy, Debug)]
struct Plane<R> {
    z: R,
    /// Slope in mirrored x.
    gx: R,
    gy: R,
}

impl<R: Real> Square<R> {
    #[inline(always)]
    pub(super) fn new(corners: &Corners<R>) -> Self {
        let Corners { sw, se, nw, ne, parity, ground } = *corners;
        let mirrored = parity.is_odd();
        let corner = [
            R::select(mirrored, se, sw),
            R::select(mirrored, sw, se),
            R::select(mirrored, ne, nw),
            R::select(mirrored, nw, ne),
        ];
        Self { corner, mirrored, ground }
    }

    /// The plane of the lower triangle (beside the x axis, mirrored) or of the upper one.
    #[inline(always)]
    fn plane(&self, lower: R::Mask, inverse: R) -> Plane<R> {
        let [sw, se, nw, ne] = self.corner;
        let gx = R::select(lower, se - sw, ne - nw) * inverse;
        let gy = R::select(lower, ne - se, nw - sw) * inverse;
        Plane { z: sw, gx, gy }
    }

    /// The slope in x as it is in the world.
    #[inline(always)]
    fn world_slope(&self, plane: &Plane<R>) -> R {
        R::select(self.mirrored, -plane.gx, plane.gx)
    }

    /// The ground so many metres east and north of the square's corner.
    #[inline(always)]
    pub(super) fn ground(&self, a: R, b: R, size: R, inverse: R) -> Ground<R> {
        let a = R::select(self.mirrored, size - a, a);
        let plane = self.plane(b.lt(a), inverse);
        Ground {
            height: plane.z + plane.gx * a + plane.gy * b,
            slope_x: self.world_slope(&plane),
            slope_y: plane.gy,
            twist: R::zero(),
            exists: self.ground,
        }
    }
}

/// The path relative to one square.
struct Path<R> {
    /// Start, in the square's mirrored coordinates.
    x: R,
    y: R,
    z: R,
    /// Displacement, mirrored.
    dx: R,
    dy: R,
    dz: R,
}

/// The part of a path that lies over one triangle.
struct Piece<R: Real> {
    from: R,
    to: R,
    /// The triangle's plane.
    plane: Plane<R>,
    /// Gap to the plane at both ends, negative below it: distances times the same factor 1 / n.up, which
    /// their ratio does not see.
    enter: R,
    leave: R,
    /// Whether the plane is met: one-sided, and at the entry for what is already below.
    met: R::Mask,
}

impl<R: Real> Piece<R> {
    #[inline(always)]
    fn new<const TWO_SIDED: bool>(path: &Path<R>, plane: Plane<R>, from: R, to: R) -> Self {
        let approach = path.dz - (plane.gx * path.dx + plane.gy * path.dy);
        let gap = path.z - (plane.z + plane.gx * path.x + plane.gy * path.y);
        let enter = gap + approach * from;
        let leave = gap + approach * to;
        let zero = R::zero();
        let under = enter.le(zero);
        let crosses = leave.lt(zero);
        let meets = if TWO_SIDED {
            // From above down, or from below (the plane itself counts as below) up.
            under.not().and(crosses).or(under.and(zero.lt(leave)))
        } else {
            approach.lt(zero).and(under.or(crosses))
        };
        Self { from, to, plane, enter, leave, met: meets.and(from.lt(to)) }
    }

    /// Where the plane is met, as a fraction of the path.
    #[inline(always)]
    fn fraction<const TWO_SIDED: bool>(&self) -> R {
        let at = self.from + (self.to - self.from) * (self.enter / (self.enter - self.leave));
        if TWO_SIDED { at } else { R::select(self.enter.le(R::zero()), self.from, at) }
    }

    /// `a` where the mask is set, `b` elsewhere.
    #[inline(always)]
    fn select(mask: R::Mask, a: &Self, b: &Self) -> Self {
        Self {
            from: R::select(mask, a.from, b.from),
            to: R::select(mask, a.to, b.to),
            plane: Plane {
                z: b.plane.z,
                gx: R::select(mask, a.plane.gx, b.plane.gx),
                gy: R::select(mask, a.plane.gy, b.plane.gy),
            },
            enter: R::select(mask, a.enter, b.enter),
            leave: R::select(mask, a.leave, b.leave),
            met: a.met.or(b.met),
        }
    }
}

/// The two triangles of a square under a path.
pub(super) struct Facets<R: Real> {
    square: Square<R>,
    /// In the order of the path.
    first: Piece<R>,
    second: Piece<R>,
}

impl<R: Real> Filling<R> for Facets<R> {
    #[inline(always)]
    fn over<const TWO_SIDED: bool>(
        surface: &Surface<'_, R::Scalar>,
        corners: &Corners<R>,
        course: &Course<R>,
        (x, y): (R, R),
        span: &Span<R>,
    ) -> Self {
        let (path, z) = (course.path, course.z);
        let Span { from, to, .. } = *span;
        let zero = R::zero();
        let size = R::splat(surface.square);
        let square = Square::new(corners);
        let mirror = square.mirrored;
        let local = Path {
            x: R::select(mirror, size - x, x),
            y,
            z,
            dx: R::select(mirror, -path.x, path.x),
            dy: path.y,
            dz: path.z,
        };
        // Across the cut: beside the x axis while x - y > 0.
        let side = local.x - local.y;
        let turn = local.dx - local.dy;
        let along = turn.le(zero).and(zero.le(turn));
        let cut = (-side / turn).max(from).min(to);
        let cut = R::select(along, to, cut);
        let first_lower = R::select(along, -side, turn).lt(zero);
        let lower = square.plane(first_lower, surface.inverse());
        let upper = square.plane(first_lower.not(), surface.inverse());
        let first = Piece::new::<TWO_SIDED>(&local, lower, from, cut);
        let second = Piece::new::<TWO_SIDED>(&local, upper, cut, to);
        Self { square, first, second }
    }

    #[inline(always)]
    fn met(&self) -> R::Mask {
        self.square.ground.and(self.first.met.or(self.second.met))
    }

    #[inline(always)]
    fn contact<const TWO_SIDED: bool>(&self, _course: &Course<R>) -> Contact<R> {
        let piece = Piece::select(self.first.met, &self.first, &self.second);
        Contact {
            fraction: piece.fraction::<TWO_SIDED>(),
            slope_x: self.square.world_slope(&piece.plane),
            slope_y: piece.plane.gy,
            inward: R::Mask::splat(true),
        }
    }
}
