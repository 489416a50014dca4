//! Stepping up on low ledges (docs/physics.md, section 5).

use super::build::Solids;
use super::sweep::SolidHit;
use super::triangle::Motion;
use glam::DVec3;

/// Least n.up of a face that is stepped up on.
pub const STEP_GROUND: f64 = 0.707;
/// How far above the ledge the box is put, m.
const CLEARANCE: f64 = 1e-3;
/// How far beyond the face the box must be able to go, m.
const BEYOND: f64 = 0.02;
/// Height of the slab that feels for the ledge, m.
const SLAB: f64 = 0.01;

impl Solids {
    /// How far the box of [`Solids::sweep_box`] is lifted from where `hit` stopped it, so that it can go on along
    /// the horizontal part of its path: the smallest lift that clears the ledge in front, up to `max_lift`, m.
    ///
    /// `None` where the ledge is higher than that, has no face of at least [`STEP_GROUND`] under the box, or where
    /// the lifted box would meet something above or in front. What faces count as a step (n.up of `hit`) is the caller's.
    #[must_use]
    pub fn step_up(
        &self,
        feet: DVec3,
        path: DVec3,
        half_width: f64,
        height: f64,
        max_lift: f64,
        hit: &SolidHit,
    ) -> Option<f64> {
        let at = feet + path * hit.fraction;
        let level = path.with_z(0.0);
        let into = -level.dot(hit.normal);
        let highest = max_lift.min(height - SLAB) - CLEARANCE;
        if !(into > 0.0 && highest > 0.0) {
            return None;
        }
        // Far enough to be BEYOND the face, unless the path all but runs along it.
        let ahead = level * (BEYOND / into).min(half_width / level.length());
        let up = |lift: f64| DVec3::new(0.0, 0.0, lift);
        let slab = |from, path| self.sweep(&Motion::of(from, path, half_width, SLAB));
        if slab(at + up(highest), ahead).is_some() {
            return None;
        }
        let ledge =
            slab(at + up(highest) + ahead, up(-highest)).filter(|found| found.face.z >= STEP_GROUND)?;
        let lift = highest * (1.0 - ledge.hit.fraction) + CLEARANCE;
        let body = |from, path| self.sweep(&Motion::of(from, path, half_width, height));
        let free = body(at, up(lift)).is_none() && body(at + up(lift), ahead).is_none();
        free.then_some(lift)
    }
}
