//! The players of one world as bodies to each other: spheres that block, boxes that discs meet.

use glam::DVec3;

/// Fraction of a path at which a sphere meets another one of the same size, and the unit normal
/// against the mover (docs/physics.md, section 5.3).
///
/// `apart` is the way from the other's centre to the mover's; they touch at a distance of `reach`,
/// twice the radius. Whoever moves away, or along, is free; whoever is inside already and moves
/// deeper is stopped at once.
pub(super) fn meet_sphere(apart: DVec3, path: DVec3, reach: f64) -> Option<(f64, DVec3)> {
    let approach = path.dot(apart);
    if approach >= 0.0 {
        return None;
    }
    let gap = apart.length_squared() - reach * reach;
    if gap <= 0.0 {
        return Some((0.0, apart.normalize_or(DVec3::Z)));
    }
    // Smaller root of |apart + t path|^2 = reach^2, in the form that does not cancel.
    let discriminant = approach * approach - path.length_squared() * gap;
    if discriminant < 0.0 {
        return None;
    }
    let fraction = gap / (discriminant.sqrt() - approach);
    (fraction < 1.0).then(|| (fraction, ((apart + path * fraction) / reach).normalize_or(DVec3::Z)))
}

/// Fraction of a segment at which it enters a box standing on `feet`, and the unit normal of the face.
/// A start inside meets it at once, against the path.
pub(super) fn meet_box(
    from: DVec3,
    path: DVec3,
    feet: DVec3,
    half: f64,
    height: f64,
) -> Option<(f64, DVec3)> {
    let low = feet - DVec3::new(half, half, 0.0);
    let high = feet + DVec3::new(half, half, height);
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut normal = DVec3::ZERO;
    for axis in 0..3 {
        if path[axis] == 0.0 {
            if !(low[axis]..=high[axis]).contains(&from[axis]) {
                return None;
            }
            continue;
        }
        let (near, far) = if path[axis] > 0.0 { (low, high) } else { (high, low) };
        let at = (near[axis] - from[axis]) / path[axis];
        if at > enter {
            enter = at;
            normal = DVec3::ZERO;
            normal[axis] = -path[axis].signum();
        }
        leave = leave.min((far[axis] - from[axis]) / path[axis]);
    }
    if enter >= 0.0 {
        return (enter <= leave && enter <= 1.0).then_some((enter, normal));
    }
    let inside = leave >= 0.0 && path != DVec3::ZERO;
    inside.then(|| (0.0, (-path).normalize_or(DVec3::Z)))
}
