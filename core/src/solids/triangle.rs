//! A box moving along a straight path against one triangle: swept separating axes.

use core::cmp::Ordering;
use glam::DVec3;

/// How far box and triangle must come to overlap sideways, along the face, before a contact counts, m.
/// Less is a graze: a player who slides over the seam of two solids that lie flush, and whom `f32` has put
/// 30 micrometres into the one he stands on, does not catch on the side of the next. Towards the face
/// itself contact is exact.
pub const SKIN: f64 = 1e-4;

/// Contacts within this of each other, along a normal or in metres of path, count as at once, m. Rounding of
/// coordinates of 1,000 km is a hundredth of it.
pub(super) const AT_ONCE: f64 = 1e-7;

/// Overlaps at the start up to this deep are contacts like any other, m: what rounding leaves of a touch. Of deeper ones
/// only one counts at a time ([`Motion::buried`]), else two that press from opposite sides would hold the box for ever.
const TOUCH: f64 = 1e-3;

/// How deep a touch may become by motions that are each let go, m: well below a touch, since of what is overlapped
/// deeper all but one face would let him through.
const CREEP: f64 = 5e-4;

/// Squared sine of the angle below which a triangle's edge and a box's edge count as parallel. Their cross
/// product then says nothing that the other axes do not say to within 3 micrometres on a box's edge.
const PARALLEL: f64 = 1e-12;

/// One face of a solid, counter-clockwise as seen from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub corners: [DVec3; 3],
    /// Outwards, length 1.
    pub normal: DVec3,
    /// Number of its solid.
    pub solid: u32,
    /// Where the surface is not sharp.
    pub smooth: Smooth,
}

/// Which sides and corners of a triangle no box can meet but flat: where the surface goes on in the same plane or
/// rises. There the only normal is the face's own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Smooth {
    /// Side k is that from corner k to the next.
    pub sides: [bool; 3],
    pub corners: [bool; 3],
}

/// An upright box in motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// Its centre at the start.
    pub centre: DVec3,
    /// Half of its sides.
    pub half: DVec3,
    /// Its displacement.
    pub path: DVec3,
}

/// Which kind of axis parts box and triangle last. Where several do at once, the first kind counts:
/// a box that slides over two faces in one plane meets the faces, never the edge between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Face,
    Box,
    Edge,
    /// The edge between two faces in one plane, where neither of them counted.
    Seam,
}

const KINDS: [Kind; 3] = [Kind::Face, Kind::Box, Kind::Edge];

/// A contact with one triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub fraction: f64,
    pub kind: Kind,
    /// From the triangle towards the box, length 1, against the path.
    pub normal: DVec3,
    /// Whether the box overlaps the triangle at the start.
    pub overlaps: bool,
}

impl Motion {
    /// The box's first contact with a triangle: `None` for a path that leaves it, runs along it or only just
    /// reaches it, and for a triangle that the box overlaps by more than a touch at the start.
    pub fn meets(&self, triangle: &Triangle) -> Option<Contact> {
        if self.path.dot(triangle.normal) >= 0.0 {
            return None;
        }
        self.axes(triangle)?.contact()
    }

    /// Whether the box overlaps a triangle where it is.
    pub fn overlaps(&self, triangle: &Triangle) -> bool {
        self.still().axes(triangle).is_some()
    }

    /// How deep the box is under the face of a triangle that it overlaps where it is by more than a touch.
    pub fn buried(&self, triangle: &Triangle) -> Option<f64> {
        self.still().axes(triangle).filter(|axes| axes.shallowest.depth > TOUCH)?;
        let normal = triangle.normal;
        Some((triangle.corners[0] - self.centre).dot(normal) + self.half.dot(normal.abs()))
    }

    fn still(&self) -> Self {
        Self { path: DVec3::ZERO, ..*self }
    }

    /// All axes; `None` as soon as one parts box and triangle all along the path.
    #[inline(always)]
    fn axes(&self, triangle: &Triangle) -> Option<Axes> {
        let mut axes = Axes::new(self, triangle);
        for (axis, unit) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            axes.overlap(Kind::Box, unit, self.half[axis])?;
        }
        axes.overlap(Kind::Face, triangle.normal, self.half.dot(triangle.normal.abs()))?;
        for k in 0..3 {
            let edge = triangle.corners[(k + 1) % 3] - triangle.corners[k];
            let parallel = PARALLEL * edge.length_squared();
            for across in [
                DVec3::new(0.0, edge.z, -edge.y),
                DVec3::new(-edge.z, 0.0, edge.x),
                DVec3::new(edge.y, -edge.x, 0.0),
            ] {
                let square = across.length_squared();
                if square > parallel {
                    let axis = across / square.sqrt();
                    axes.overlap(Kind::Edge, axis, self.half.dot(axis.abs()))?;
                }
            }
        }
        Some(axes)
    }
}

/// When an axis of some kind begins to overlap, as a fraction of the path.
#[derive(Clone, Copy)]
struct Entry {
    at: f64,
    /// Metres along the axis per whole path.
    speed: f64,
    normal: DVec3,
}

/// How far box and triangle overlap at the start along an axis, and the shorter way out.
#[derive(Clone, Copy)]
struct Overlap {
    depth: f64,
    kind: Kind,
    out: DVec3,
}

/// What the axes say, one after the other.
struct Axes {
    path: DVec3,
    normal: DVec3,
    smooth: Smooth,
    /// Corners from the box's centre.
    corners: [DVec3; 3],
    /// The part of the path in which all axes overlap by their skins.
    from: f64,
    to: f64,
    /// The last entry of each kind.
    entries: [Entry; 3],
    shallowest: Overlap,
}

impl Axes {
    fn new(motion: &Motion, triangle: &Triangle) -> Self {
        Self {
            path: motion.path,
            normal: triangle.normal,
            smooth: triangle.smooth,
            corners: triangle.corners.map(|c| c - motion.centre),
            from: f64::NEG_INFINITY,
            to: f64::INFINITY,
            entries: [Entry { at: f64::NEG_INFINITY, speed: 0.0, normal: DVec3::ZERO }; 3],
            shallowest: Overlap { depth: f64::INFINITY, kind: Kind::Edge, out: DVec3::ZERO },
        }
    }

    /// Takes in an axis of length 1, along which the box reaches `radius` from its centre. `None` where it
    /// parts box and triangle all along the path.
    #[inline(always)]
    fn overlap(&mut self, kind: Kind, axis: DVec3, radius: f64) -> Option<()> {
        // The box overlaps while its centre, 0 at the start, is between low and high.
        let [a, b, c] = self.corners.map(|corner| corner.dot(axis));
        let (low, high) = (a.min(b).min(c) - radius, a.max(b).max(c) + radius);
        let along = self.path.dot(axis);
        let speed = along.abs();
        let (near, far) = if along > 0.0 { (low, high) } else { (-high, -low) };
        // Along the face in full, towards it not at all.
        let skin = if kind == Kind::Face {
            0.0
        } else {
            let cosine = axis.dot(self.normal);
            SKIN * (1.0 - cosine * cosine).max(0.0).sqrt()
        };
        if near + skin >= speed || far - skin <= 0.0 {
            return None;
        }
        if speed > 0.0 {
            self.from = self.from.max((near + skin) / speed);
            self.to = self.to.min((far - skin) / speed);
            let at = near / speed;
            let last = &mut self.entries[kind as usize];
            if at > last.at || (at == last.at && speed > last.speed) {
                *last = Entry { at, speed, normal: if along > 0.0 { -axis } else { axis } };
            }
        }
        let (depth, out) = if -low < high { (-low, -axis) } else { (high, axis) };
        let margin = match kind.cmp(&self.shallowest.kind) {
            Ordering::Less => -AT_ONCE,
            Ordering::Equal => 0.0,
            Ordering::Greater => AT_ONCE,
        };
        if depth + margin < self.shallowest.depth {
            self.shallowest = Overlap { depth, kind, out };
        }
        (self.from <= self.to).then_some(())
    }

    /// The contact, when every axis overlaps at some time.
    fn contact(&self) -> Option<Contact> {
        if self.overlaps() {
            let Overlap { kind, out, depth } = self.shallowest;
            // Deeper by less than a skin is let go as long as it does not add up: in a gap just as wide as the box its two
            // sides would stop it in turn for ever.
            let deeper = -self.path.dot(out);
            let met = depth <= TOUCH && deeper > 0.0 && (deeper > SKIN || depth + deeper > CREEP);
            return met.then(|| self.met(0.0, kind, out));
        }
        let last = self.entries.iter().fold(f64::NEG_INFINITY, |m, e| m.max(e.at));
        let at_once = |kind: &&Kind| {
            let entry = &self.entries[**kind as usize];
            entry.speed > 0.0 && (last - entry.at) * entry.speed <= AT_ONCE
        };
        let kind = *KINDS.iter().find(at_once)?;
        Some(self.met(last, kind, self.entries[kind as usize].normal))
    }

    /// A contact along a normal, or along the face's own if that is the only one where the triangle is met.
    fn met(&self, fraction: f64, kind: Kind, normal: DVec3) -> Contact {
        let reach = self.corners.map(|corner| corner.dot(normal));
        let most = reach[0].max(reach[1]).max(reach[2]) - AT_ONCE;
        let smooth = match reach.map(|at| at >= most) {
            [true, false, false] => self.smooth.corners[0],
            [false, true, false] => self.smooth.corners[1],
            [false, false, true] => self.smooth.corners[2],
            [true, true, false] => self.smooth.sides[0],
            [false, true, true] => self.smooth.sides[1],
            [true, false, true] => self.smooth.sides[2],
            _ => false,
        };
        let face = &self.entries[Kind::Face as usize];
        let (kind, normal) = if smooth && (fraction - face.at) * face.speed <= TOUCH {
            (Kind::Seam, self.normal)
        } else {
            (kind, normal)
        };
        Contact { fraction, kind, normal, overlaps: fraction == 0.0 && self.overlaps() }
    }

    /// Whether every axis that closes overlapped before the start.
    fn overlaps(&self) -> bool {
        self.entries.iter().all(|entry| entry.at < 0.0)
    }
}
