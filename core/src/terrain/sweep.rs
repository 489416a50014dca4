//! The exact sweep of a point against the surface (docs/physics.md, section 5).

use super::facets::Facets;
use super::patch::Curve;
use super::surface::{Corners, Surface, unit_normal};
use crate::real::{Int, Mask, Real, Scalar, V3, Work};

/// The first contact along a path.
#[derive(Clone, Copy, Debug)]
pub struct Hit<R: Real> {
    /// Whether there is one.
    pub hit: R::Mask,
    /// Where, as a fraction of the path, in [0, 1].
    pub fraction: R,
    /// Unit normal of what is met: the ground's or the body's.
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

/// What the squares under a path have in common.
pub(super) struct Course<R: Real> {
    pub(super) path: V3<R>,
    /// Height of the start.
    pub(super) z: R,
    /// The first square.
    i: R::Int,
    j: R::Int,
    /// The start relative to its corner.
    x: R,
    y: R,
    east: R::Mask,
    west: R::Mask,
    north: R::Mask,
    south: R::Mask,
}

/// The part of a path over one square, in fractions of the path.
pub(super) struct Span<R: Real> {
    pub(super) from: R,
    /// Where it leaves, or ends.
    pub(super) to: R,
    /// Where it would leave by each side, and by the nearer one.
    to_x: R,
    to_y: R,
    next: R,
}

/// Where a path meets the ground over a square.
pub(super) struct Contact<R: Real> {
    /// As a fraction of the path.
    pub(super) fraction: R,
    /// Slopes of the ground there.
    pub(super) slope_x: R,
    pub(super) slope_y: R,
    /// Whether the path leads into the ground of these slopes. Where it does not, but for rounding, there is
    /// no contact.
    pub(super) inward: R::Mask,
}

/// What fills a square between its corners, seen from a path over it.
pub(super) trait Filling<R: Real> {
    /// Under the part of the path in `span`; `x` and `y` are those of the path's start, relative to the
    /// square's corner.
    fn over<const TWO_SIDED: bool>(
        surface: &Surface<'_, R::Scalar>,
        corners: &Corners<R>,
        course: &Course<R>,
        start: (R, R),
        span: &Span<R>,
    ) -> Self;

    /// Whether it is met.
    fn met(&self) -> R::Mask;

    /// Where it is first met, where it is.
    fn contact<const TWO_SIDED: bool>(&self, course: &Course<R>) -> Contact<R>;
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
        self.surface.march::<R, Facets<R>, TWO_SIDED>(self.map, self.start, self.path, self.active)
    }
}

/// The same over bilinear patches.
struct CurvedMarch<'a, R: Real, const TWO_SIDED: bool>(March<'a, R, TWO_SIDED>);

impl<R: Real, const TWO_SIDED: bool> Work for CurvedMarch<'_, R, TWO_SIDED> {
    type Output = Hit<R>;

    #[inline(always)]
    fn run(self) -> Hit<R> {
        let March { surface, map, start, path, active } = self.0;
        surface.march::<R, Curve<R>, TWO_SIDED>(map, start, path, active)
    }
}

/// One look at the first patch under a path.
struct CurvedLook<'a, R: Real> {
    surface: &'a Surface<'a, R::Scalar>,
    map: R::Int,
    start: V3<R>,
    path: V3<R>,
}

impl<R: Real> Work for CurvedLook<'_, R> {
    type Output = R::Mask;

    #[inline(always)]
    fn run(self) -> R::Mask {
        self.surface.clears_first::<R, Curve<R>>(self.map, self.start, self.path)
    }
}

/// The kernels are laid out for triangles, and hold no more of other surfaces than a call.
#[cold]
#[inline(never)]
fn out_of_line<R: Real, W: Work>(work: W) -> W::Output {
    R::enter(work)
}

/// The same; field by field, so that what triangles give need not pass through memory as this does.
#[inline(always)]
fn enter_curved<R: Real, const TWO_SIDED: bool>(march: CurvedMarch<'_, R, TWO_SIDED>) -> Hit<R> {
    let Hit { hit, fraction, normal, body } = out_of_line::<R, _>(march);
    Hit { hit, fraction, normal, body }
}

impl<T: Scalar> Surface<'_, T> {
    /// Sweeps a point from a local position along a displacement, both in metres, and finds the
    /// first triangle that it meets from above, or that it is already below where it enters the
    /// triangle's column while moving into it. A path that only just reaches a plane does not meet it.
    /// Over bilinear patches: the first place where it is on or below the surface and moves into it.
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
        if self.is_curved() {
            return enter_curved(CurvedMarch::<R, false>(March { surface: self, map, start, path, active }));
        }
        R::enter(March::<R, false> { surface: self, map, start, path, active })
    }

    /// Follows a line from a local position along a displacement, both in metres, to the first
    /// triangle or patch that it crosses from either side (section 8: a projectile's line). A start exactly
    /// on it counts as below. The normal is the upper side's, whichever side is met.
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
        if self.is_curved() {
            return enter_curved(CurvedMarch::<R, true>(March { surface: self, map, start, path, active }));
        }
        R::enter(March::<R, true> { surface: self, map, start, path, active })
    }

    /// Those whose whole path, as [`Surface::sweep`] takes it, lies over its first square and meets
    /// nothing there. No branch: several players' looks overlap.
    #[inline(always)]
    pub fn passes<R: Real<Scalar = T>>(&self, map: R::Int, start: V3<R>, path: V3<R>) -> R::Mask {
        if self.is_curved() {
            return out_of_line::<R, _>(CurvedLook { surface: self, map, start, path });
        }
        self.clears_first::<R, Facets<R>>(map, start, path)
    }

    #[inline(always)]
    fn clears_first<R: Real<Scalar = T>, F: Filling<R>>(
        &self,
        map: R::Int,
        start: V3<R>,
        path: V3<R>,
    ) -> R::Mask {
        let course = self.course(start, path);
        let place = (course.x, course.y);
        let span = self.span(&course, place, R::zero());
        let corners = self.corners::<R>(map, course.i, course.j);
        let filling = F::over::<false>(self, &corners, &course, place, &span);
        let stays = span.next.lt(R::lit(1.0)).not();
        self.below_highest(start, path).not().or(stays.and(filling.met().not()))
    }

    /// Whose path is not above every vertex all the way: there nothing is to be met.
    #[inline(always)]
    fn below_highest<R: Real<Scalar = T>>(&self, start: V3<R>, path: V3<R>) -> R::Mask {
        start.z.min(start.z + path.z).le(R::splat(self.highest))
    }

    /// What the squares under a path have in common.
    #[inline(always)]
    fn course<R: Real<Scalar = T>>(&self, start: V3<R>, path: V3<R>) -> Course<R> {
        let zero = R::zero();
        let size = R::splat(self.square);
        let (i, j) = self.square_of(start.x, start.y);
        // Rounding can leave the start a hair outside, and beyond the farthest square it is far outside:
        // the walk over squares must not make up for it.
        let x = (start.x - R::from_int(i) * size).max(zero).min(size);
        let y = (start.y - R::from_int(j) * size).max(zero).min(size);
        let (east, west) = (zero.lt(path.x), path.x.lt(zero));
        let (north, south) = (zero.lt(path.y), path.y.lt(zero));
        Course { path, z: start.z, i, j, x, y, east, west, north, south }
    }

    /// The part of the path over one square, entered at `from`; `x` and `y` are those of the path's start,
    /// relative to the square's corner.
    #[inline(always)]
    fn span<R: Real<Scalar = T>>(&self, course: &Course<R>, (x, y): (R, R), from: R) -> Span<R> {
        let Course { path, east, west, north, south, .. } = *course;
        let size = R::splat(self.square);
        let never = R::lit(2.0);
        let to_x = R::select(east, size - x, -x) / path.x;
        let to_y = R::select(north, size - y, -y) / path.y;
        let to_x = R::select(east.or(west), to_x, never);
        let to_y = R::select(north.or(south), to_y, never);
        let next = to_x.min(to_y);
        let to = next.min(R::lit(1.0)).max(from);
        Span { from, to, to_x, to_y, next }
    }

    /// Walks the squares under a path in order and stops at the first contact.
    #[inline(always)]
    fn march<R: Real<Scalar = T>, F: Filling<R>, const TWO_SIDED: bool>(
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

        let mut active = active.and(self.below_highest(start, path));
        let size = R::splat(self.square);
        let course = self.course(start, path);
        let (step_i, step_j) = (
            R::Int::select(course.west, R::Int::splat(-1), R::Int::splat(1)),
            R::Int::select(course.south, R::Int::splat(-1), R::Int::splat(1)),
        );
        let (mut i, mut j) = (course.i, course.j);
        let (mut x, mut y) = (course.x, course.y);
        let mut from = zero;
        while active.any() {
            let span = self.span(&course, (x, y), from);
            let corners = self.corners::<R>(map, i, j);
            let filling = F::over::<TWO_SIDED>(self, &corners, &course, (x, y), &span);
            let mut hit = active.and(filling.met());
            // Most squares are passed over, and need no division to say where they are met.
            if hit.any() {
                let contact = filling.contact::<TWO_SIDED>(&course);
                hit = hit.and(contact.inward);
                fraction = R::select(hit, contact.fraction, fraction);
                slope_x = R::select(hit, contact.slope_x, slope_x);
                slope_y = R::select(hit, contact.slope_y, slope_y);
                found = found.or(hit);
            }
            active = active.and(hit.not()).and(span.next.lt(one));

            let cross_x = span.to_x.le(span.to_y);
            let cross_y = span.to_y.le(span.to_x);
            i = R::Int::select(cross_x, i + step_i, i);
            j = R::Int::select(cross_y, j + step_j, j);
            // From the first square anew: a sum of steps would drift, and at last stand still.
            x = course.x - R::from_int(i - course.i) * size;
            y = course.y - R::from_int(j - course.j) * size;
            from = span.to;
        }
        let mut normal = V3::new(-zero, -zero, one);
        if found.any() {
            normal = unit_normal(slope_x, slope_y);
        }
        Hit { hit: found, fraction, normal, body: R::Mask::splat(false) }
    }
}
