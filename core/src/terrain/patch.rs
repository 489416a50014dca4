//! A square filled by the bilinear interpolation of its corners (docs/physics.md, section 8).
//!
//! Along a straight path its height is a quadratic, and so is the gap of the path over it: at most one dip
//! or one bump, whose crossings are roots in closed form.
//!
//! A player who is turned along the tangent where he meets ground that rises ahead meets it again at once,
//! and again: on hollow ground his bumps would run out every tick, and he would stand still. So the normal
//! that turns him is taken as far ahead on the patch, and no farther, as it takes for the turned path to
//! lead over all that is left of it: for one that begins on the ground this is the plane along the chord.
//! Where the tangent at the contact leads over it already, as after a fall of some height, it is that.

use super::surface::{Corners, Ground, Surface};
use super::sweep::{Contact, Course, Filling, Span};
use crate::real::{Mask, Real};

/// One square: z + gx a + gy b + twist a b, a metres east and b metres north of its corner.
///
/// On the western side (a = 0) and the southern one nothing but that side's two vertices counts, and at the
/// corner the vertex itself. A point of a side belongs to the square farther east or north, so heights there
/// are the same from wherever one comes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch<R: Real> {
    z: R,
    gx: R,
    gy: R,
    twist: R,
    /// Whether there is ground.
    exists: R::Mask,
}

impl<R: Real> Patch<R> {
    #[inline(always)]
    pub(super) fn new(corners: &Corners<R>, inverse: R) -> Self {
        let Corners { sw, se, nw, ne, ground, .. } = *corners;
        let (south, north) = (se - sw, ne - nw);
        let twist = (north - south) * inverse * inverse;
        Self { z: sw, gx: south * inverse, gy: (nw - sw) * inverse, twist, exists: ground }
    }

    #[inline(always)]
    fn height(&self, a: R, b: R) -> R {
        self.z + self.gx * a + (self.gy + self.twist * a) * b
    }

    /// dz/dx and dz/dy.
    #[inline(always)]
    fn slopes(&self, a: R, b: R) -> (R, R) {
        (self.gx + self.twist * b, self.gy + self.twist * a)
    }

    /// The ground so many metres east and north of the square's corner.
    #[inline(always)]
    pub(super) fn ground(&self, a: R, b: R) -> Ground<R> {
        let (slope_x, slope_y) = self.slopes(a, b);
        Ground { height: self.height(a, b), slope_x, slope_y, twist: self.twist, exists: self.exists }
    }
}

/// The patch under a path. The gap between them is gap + slope s + bend s^2, negative below the surface, with
/// s from 0 where the path enters the square to 1 where it leaves it or ends: from there, not from the start
/// of the path, so that nothing cancels where the start is a thousand squares away.
pub(super) struct Curve<R: Real> {
    patch: Patch<R>,
    /// The entry, from the square's corner, and the way to the exit.
    x: R,
    y: R,
    dx: R,
    dy: R,
    from: R,
    to: R,
    /// The quadratic; for a two-sided path from below turned upside down.
    gap: R,
    slope: R,
    bend: R,
    under: R::Mask,
    met: R::Mask,
}

impl<R: Real> Filling<R> for Curve<R> {
    #[inline(always)]
    fn over<const TWO_SIDED: bool>(
        surface: &Surface<'_, R::Scalar>,
        corners: &Corners<R>,
        course: &Course<R>,
        (x, y): (R, R),
        span: &Span<R>,
    ) -> Self {
        let Span { from, to, .. } = *span;
        let zero = R::zero();
        let size = R::splat(surface.square);
        let patch = Patch::new(corners, surface.inverse());
        let path = course.path;
        let x = (x + path.x * from).max(zero).min(size);
        let y = (y + path.y * from).max(zero).min(size);
        let share = to - from;
        let (dx, dy) = (path.x * share, path.y * share);
        let (slope_x, slope_y) = patch.slopes(x, y);
        let gap = course.z + path.z * from - patch.height(x, y);
        let slope = path.z * share - (slope_x * dx + slope_y * dy);
        let bend = -(patch.twist * dx * dy);

        let under = gap.le(zero);
        let turned = if TWO_SIDED { under } else { R::Mask::splat(false) };
        let gap = R::select(turned, -gap, gap);
        let slope = R::select(turned, -slope, slope);
        let bend = R::select(turned, -bend, bend);
        let twice = bend + bend;
        let below = (gap + slope + bend).lt(zero);
        let falls = slope.lt(zero);
        // Down and up again before the exit.
        let dips = falls.and((-slope).lt(twice)).and((R::lit(4.0) * bend * gap).lt(slope * slope));
        let met = if TWO_SIDED {
            below.or(dips)
        } else {
            // From below: where it moves into the surface, at once or later.
            let into = falls.or(below.and((slope + twice).lt(zero)));
            under.and(into).or(under.not().and(below.or(dips)))
        };
        let met = met.and(patch.exists);
        Self { patch, x, y, dx, dy, from, to, gap, slope, bend, under, met }
    }

    #[inline(always)]
    fn met(&self) -> R::Mask {
        self.met
    }

    #[inline(always)]
    fn contact<const TWO_SIDED: bool>(&self, course: &Course<R>) -> Contact<R> {
        let (zero, one, half) = (R::zero(), R::lit(1.0), R::lit(0.5));
        let Self { gap, slope, bend, .. } = *self;
        let falls = slope.lt(zero);
        // The first root where it falls at the entry, else the second; below the surface all the way, the
        // crest. Neither form subtracts numbers of one sign, so a plane's root is that of a line.
        let root = (slope * slope - R::lit(4.0) * bend * gap).max(zero).sqrt();
        let sum = slope.abs() + root;
        let at = R::select(falls, gap + gap, sum) / R::select(falls, sum, -(bend + bend));
        let mut at = at.max(zero).min(one);
        let mut turn = at;
        if !TWO_SIDED {
            at = R::select(self.under.and(falls), zero, at);
            let chord = (one + gap / bend) * half;
            turn = R::select(bend.lt(zero), at.max(chord), at).min(one);
        }
        let (x, y) = (self.x + self.dx * turn, self.y + self.dy * turn);
        let (slope_x, slope_y) = self.patch.slopes(x, y);
        let path = course.path;
        let inward = if TWO_SIDED {
            R::Mask::splat(true)
        } else {
            (path.z - (slope_x * path.x + slope_y * path.y)).lt(zero)
        };
        let fraction = (self.from + (self.to - self.from) * at).min(self.to);
        Contact { fraction, slope_x, slope_y, inward }
    }
}
