//! A player's box along its path against all solids of a map.

use super::build::Solids;
use super::triangle::{AT_ONCE, Contact, Motion, Triangle};
use glam::DVec3;
use parry3d_f64::partitioning::{BvhNode, TraversalAction};

pub use super::triangle::SKIN;

/// The first contact along a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidHit {
    /// Where, as a fraction of the path, in [0, 1).
    pub fraction: f64,
    /// Unit normal, out of the solid and against the path.
    pub normal: DVec3,
    /// Number of the solid that was met.
    pub solid: u32,
}

/// A hit, and the face it is on.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceHit {
    pub hit: SolidHit,
    pub face: DVec3,
}

/// The first fraction of a path that no contact has.
const BEYOND: f64 = 1.0 + f64::EPSILON;

impl Motion {
    pub(super) fn of(feet: DVec3, path: DVec3, half_width: f64, height: f64) -> Self {
        let half = DVec3::new(half_width, half_width, 0.5 * height);
        Self { centre: feet + DVec3::new(0.0, 0.0, half.z), half, path }
    }

    fn is_finite(&self) -> bool {
        self.centre.is_finite() && self.half.is_finite() && self.path.is_finite()
    }

    /// When the box begins to meet a node's bounds; `f64::MAX` if it does not by `limit`.
    fn enters(&self, node: &BvhNode, limit: f64) -> f64 {
        let reach = self.half + AT_ONCE;
        let (low, high) = (node.mins() - reach - self.centre, node.maxs() + reach - self.centre);
        let (mut from, mut to) = (0.0f64, limit);
        for axis in 0..3 {
            let (low, high, path) = (low[axis], high[axis], self.path[axis]);
            if path == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return f64::MAX;
                }
            } else {
                let (near, far) = (low / path, high / path);
                from = from.max(near.min(far));
                to = to.min(near.max(far));
            }
        }
        if from <= to { from } else { f64::MAX }
    }
}

impl Solids {
    /// Sweeps an upright box, `2 half_width` square and `height` tall with its underside's middle at `feet`,
    /// along `path`, all in metres and world coordinates, and finds the first face that it meets from outside.
    ///
    /// A path that leaves a face, runs along it or only just reaches it does not meet it. A box that overlaps
    /// faces at the start meets them at fraction 0, with the normal of the shortest way out, unless it moves
    /// that way (docs/solids.md, "Inside a solid"). A path of zero length, or one that is not finite, meets nothing.
    ///
    /// The normal is that of the axis which parts box and face last; where several do at once the face's own,
    /// then the box's sides, then the most opposed to the path: never the order of solids or triangles.
    #[must_use]
    pub fn sweep_box(&self, feet: DVec3, path: DVec3, half_width: f64, height: f64) -> Option<SolidHit> {
        self.sweep(&Motion::of(feet, path, half_width, height)).map(|found| found.hit)
    }

    pub(super) fn sweep(&self, motion: &Motion) -> Option<FaceHit> {
        self.first(motion, Motion::meets)
    }

    /// The first contact of a motion, where `meets` tells that with one triangle.
    pub(super) fn first(
        &self,
        motion: &Motion,
        meets: impl Fn(&Motion, &Triangle) -> Option<Contact>,
    ) -> Option<FaceHit> {
        if !motion.is_finite() {
            return None;
        }
        let triangles = self.triangles();
        let at = |leaf: u32, _| meets(motion, &triangles[leaf as usize]).map(|contact| contact.fraction);
        let (_, fraction) = self.bvh().find_best(BEYOND, |node, limit| motion.enters(node, limit), at)?;
        // Once more, for all that is met at once.
        let limit = fraction + AT_ONCE / motion.path.length();
        let mut best: Option<(Contact, u32)> = None;
        self.bvh().traverse(|node| {
            if motion.enters(node, limit) > limit {
                return TraversalAction::Prune;
            }
            if let Some(leaf) = node.leaf_data() {
                let contact = meets(motion, &triangles[leaf as usize]).filter(|c| c.fraction <= limit);
                if let Some(contact) = contact
                    && best.as_ref().is_none_or(|best| self.precedes(motion, &(contact, leaf), best))
                {
                    best = Some((contact, leaf));
                }
            }
            TraversalAction::Continue
        });
        let (contact, leaf) = best?;
        let triangle = &triangles[leaf as usize];
        let hit = SolidHit { fraction, normal: contact.normal, solid: triangle.solid };
        Some(FaceHit { hit, face: triangle.normal })
    }

    /// Which of two contacts at once counts.
    fn precedes(&self, motion: &Motion, a: &(Contact, u32), b: &(Contact, u32)) -> bool {
        let key = |(contact, leaf): &(Contact, u32)| {
            let triangle = &self.triangles()[*leaf as usize];
            (contact.normal, triangle.normal, triangle.solid)
        };
        let (a_key, b_key) = (key(a), key(b));
        let order = (a.0.kind.cmp(&b.0.kind))
            .then_with(|| motion.path.dot(a_key.0).total_cmp(&motion.path.dot(b_key.0)))
            .then_with(|| lexicographic(a_key.0, b_key.0))
            .then_with(|| lexicographic(a_key.1, b_key.1))
            .then_with(|| a_key.2.cmp(&b_key.2));
        order.is_lt()
    }
}

fn lexicographic(a: DVec3, b: DVec3) -> core::cmp::Ordering {
    a.x.total_cmp(&b.x).then_with(|| a.y.total_cmp(&b.y)).then_with(|| a.z.total_cmp(&b.z))
}
