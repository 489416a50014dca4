//! Straight lines against all solids of a map: discs, line of sight, and what a box stands in.

use super::build::Solids;
use super::sweep::SolidHit;
use super::triangle::{Contact, Kind, Motion, Triangle};
use glam::DVec3;

/// Where a line meets a triangle, from either side. An edge belongs to both of its triangles: the products below
/// are the same numbers with the other sign for the other one, so that no line slips through a seam.
fn meets(line: &Motion, triangle: &Triangle) -> Option<Contact> {
    let [a, b, c] = triangle.corners.map(|corner| corner - line.centre);
    let (u, v, w) = (line.path.dot(c.cross(b)), line.path.dot(a.cross(c)), line.path.dot(b.cross(a)));
    let (least, most) = (u.min(v).min(w), u.max(v).max(w));
    let across = line.path.dot(triangle.normal);
    if (least < 0.0 && most > 0.0) || across == 0.0 {
        return None;
    }
    let fraction = a.dot(triangle.normal) / across;
    let normal = if across < 0.0 { triangle.normal } else { -triangle.normal };
    (0.0..=1.0).contains(&fraction).then_some(Contact { fraction, kind: Kind::Face, normal })
}

impl Solids {
    /// The first face on the straight line from a point along `path`, both in metres and world coordinates, from
    /// whichever side, its two ends included. The normal is turned against the path.
    #[must_use]
    pub fn ray(&self, from: DVec3, path: DVec3) -> Option<SolidHit> {
        self.first(&Motion { centre: from, half: DVec3::ZERO, path }, meets).map(|found| found.hit)
    }

    /// A solid that an upright box (as in [`Solids::sweep_box`]) overlaps, or within which it lies: one of a
    /// start that should be refused.
    #[must_use]
    pub fn overlap(&self, feet: DVec3, half_width: f64, height: f64) -> Option<u32> {
        let still = Motion::of(feet, DVec3::ZERO, half_width, height);
        let around =
            parry3d_f64::bounding_volume::Aabb::new(still.centre - still.half, still.centre + still.half);
        let cut = self.bvh().intersect_aabb(&around).map(|leaf| &self.triangles()[leaf as usize]);
        if let Some(solid) = cut.filter(|t| still.overlaps(t)).map(|t| t.solid).min() {
            return Some(solid);
        }
        // The next face above is seen from within. Farther up than twice the limit of coordinates nothing stands.
        let up = DVec3::new(0.0, 0.0, 4.0 * super::MAX_COORDINATE);
        let above = self.first(&Motion { centre: still.centre, half: DVec3::ZERO, path: up }, meets)?;
        (above.face.z > 0.0).then_some(above.hit.solid)
    }
}
