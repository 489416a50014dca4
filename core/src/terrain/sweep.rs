//! The exact sweep of a point against the triangulated surface (docs/physics.md, section 5).

use super::surface::{Plane, Surface, unit_normal};
use crate::real::{Int, Mask, Real, Scalar, V3, Work};

/// The first contact along a path.
#[derive(Clone, Copy, Debug)]
pub struct Hit<R: Real> {
    /// Whether there is one.
    pub hit: R::Mask,
    /// Where, as a fraction of the path, in [0, 1].
    pub fraction: R,
    /// Unit normal of what is met: the triangle's or the body's.
    pub normal: V3<R>,
    /// Whether it is a body rather than terrain.
    pub body: R::Mask,
}

impl<R: Real> Hit<R> {
    /// No contact.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let none = R::Mask::splat(false);
        Self { hit: none, fraction: R::lit(1.0), normal: V3::up(), body: none }
    }

    /// The earlier of two contacts; the first where both come at once.
    #[inline(always)]
    #[must_use]
    pub fn first(a: Self, b: Self) -> Self {
        let later = b.hit.and(a.hit.not().or(b.fraction.lt(a.fraction)));
        Self {
            hit: a.hit.or(b.hit),
            fraction: R::select(later, b.fraction, a.fraction),
            normal: V3::select(later, b.normal, a.normal),
            body: later.pick(b.body, a.body),
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

/// A walk over the squares under a path, compiled once for each lane width: it is most of a tick, and
/// every scene and tier makes it.
struct March<'a, R: Real, const TWO_SIDED: bool> {
    surface: &'a Surface<'a, R::Scalar>,
    map: R::Int,
    start: V3<R>,
    path: V3<R>,
    active: R::Mask,
}

impl<R: Real, const TWO_SIDED: bool> Work for March<'_, R, TWO_SIDED> {
    type Output = Hit<R>;

    #[inline(always)]
    fn run(self) -> Hit<R> {
        self.surface.march::<R, TWO_SIDED>(self.map, self.start, self.path, self.active)
    }
}

impl<T: Scalar> Surface<'_, T> {
    /// Sweeps a point from a local position along a displacement, both in metres, and finds the
    /// first triangle that it meets from above, or that it is already below where it enters the
    /// triangle's column while moving into it. A path that only just reaches a plane does not meet it.
    ///
    /// Lanes outside `active` report no contact.
    #[inline(always)]
    pub fn sweep<R: Real<Scalar = T>>(
        &self,
        map: R::Int,
        start: V3<R>,
        path: V3<R>,
        active: R::Mask,
    ) -> Hit<R> {
        R::enter(March::<R, false> { surface: self, map, start, path, active })
    }

    /// Follows a line from a local position along a displacement, both in metres, to the first
    /// triangle that it crosses from either side (section 8: a projectile's line). A start exactly on
    /// a triangle counts as below it. The normal is the upper side's, whichever side is met.
    ///
    /// Lanes outside `active` report no contact.
    #[inline(always)]
    pub fn line<R: Real<Scalar = T>>(
        &self,
        map: R::Int,
        start: V3<R>,
        path: V3<R>,
        active: R::Mask,
    ) -> Hit<R> {
        R::enter(March::<R, true> { surface: self, map, start, path, active })
    }

    /// Walks the squares under a path in order and stops at the first contact.
    #[inline(always)]
    fn march<R: Real<Scalar = T>, const TWO_SIDED: bool>(
        &self,
        map: R::Int,
        start: V3<R>,
        path: V3<R>,
        active: R::Mask,
    ) -> Hit<R> {
        let zero = R::zero();
        let one = R::lit(1.0);
        let mut found = R::Mask::splat(false);
        let mut fraction = one;
        let (mut slope_x, mut slope_y) = (zero, zero);

        // Above every vertex on the whole path: nothing to meet.
        let lowest = start.z.min(start.z + path.z);
        let mut active = active.and(lowest.le(R::splat(self.highest)));

        let size = R::splat(self.square);
        let inverse = self.inverse::<R>();
        let (mut i, mut j) = self.square_of(start.x, start.y);
        // The start relative to the current square's corner. Rounding can leave it a hair outside, and
        // beyond the farthest square it is far outside: the walk over squares must not make up for it.
        let (first_i, first_j) = (i, j);
        let first_x = (start.x - R::from_int(i) * size).max(zero).min(size);
        let first_y = (start.y - R::from_int(j) * size).max(zero).min(size);
        let (mut x, mut y) = (first_x, first_y);
        let (east, west) = (zero.lt(path.x), path.x.lt(zero));
        let (north, south) = (zero.lt(path.y), path.y.lt(zero));
        let (step_i, step_j) = (
            R::Int::select(west, R::Int::splat(-1), R::Int::splat(1)),
            R::Int::select(south, R::Int::splat(-1), R::Int::splat(1)),
        );
        let never = R::lit(2.0);
        let mut from = zero;
        while active.any() {
            let to_x = R::select(east, size - x, -x) / path.x;
            let to_y = R::select(north, size - y, -y) / path.y;
            let to_x = R::select(east.or(west), to_x, never);
            let to_y = R::select(north.or(south), to_y, never);
            let next = to_x.min(to_y);
            let to = next.min(one).max(from);

            let square = self.square::<R>(map, i, j);
            let mirror = square.mirrored;
            let local = Path {
                x: R::select(mirror, size - x, x),
                y,
                z: start.z,
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
            let lower = square.plane(first_lower, inverse);
            let upper = square.plane(first_lower.not(), inverse);
            let first = Piece::new::<TWO_SIDED>(&local, lower, from, cut);
            let second = Piece::new::<TWO_SIDED>(&local, upper, cut, to);
            let hit = active.and(square.ground).and(first.met.or(second.met));
            // Most squares are passed over, and need no division to say where they are met.
            if hit.any() {
                let piece = Piece::select(first.met, &first, &second);
                fraction = R::select(hit, piece.fraction::<TWO_SIDED>(), fraction);
                slope_x = R::select(hit, square.world_slope(&piece.plane), slope_x);
                slope_y = R::select(hit, piece.plane.gy, slope_y);
                found = found.or(hit);
            }
            active = active.and(hit.not()).and(next.lt(one));

            let cross_x = to_x.le(to_y);
            let cross_y = to_y.le(to_x);
            i = R::Int::select(cross_x, i + step_i, i);
            j = R::Int::select(cross_y, j + step_j, j);
            // From the first square anew: a sum of steps would drift, and at last stand still.
            x = first_x - R::from_int(i - first_i) * size;
            y = first_y - R::from_int(j - first_j) * size;
            from = to;
        }
        let mut normal = V3::new(-zero, -zero, one);
        if found.any() {
            normal = unit_normal(slope_x, slope_y);
        }
        Hit { hit: found, fraction, normal, body: R::Mask::splat(false) }
    }
}
