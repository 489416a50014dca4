//! The rule of docs/physics.md, section 5, written out over all triangles near a path, in f64, with
//! nothing shared with the sweep under test: no walk over squares, no mirroring, no early end.

use crate::mesh::{Triangle, normal};
use parry3d_f64::math::Vector;

/// A first contact: fraction of the path, and the triangle's unit normal.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    pub fraction: f64,
    pub normal: Vector,
}

/// What part of the path, in fractions of it, lies in the column over a triangle.
fn column(triangle: &Triangle, start: Vector, path: Vector) -> (f64, f64) {
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for k in 0..3 {
        let a = triangle[k];
        let edge = triangle[(k + 1) % 3] - a;
        // Positive to the left of the edge, which is inside.
        let side = edge.x * (start.y - a.y) - edge.y * (start.x - a.x);
        let turn = edge.x * path.y - edge.y * path.x;
        if turn > 0.0 {
            enter = enter.max(-side / turn);
        } else if turn < 0.0 {
            leave = leave.min(-side / turn);
        } else if side < 0.0 {
            return (1.0, 0.0);
        }
    }
    (enter, leave)
}

/// The first contact of a path that is lifted by `lift` along each triangle's normal. Columns that
/// take up no more than a fraction `sliver` of the path are left out.
pub fn first_contact<'a>(
    triangles: impl Iterator<Item = &'a Triangle>,
    start: Vector,
    path: Vector,
    lift: f64,
    sliver: f64,
) -> Option<Contact> {
    let mut first: Option<Contact> = None;
    for triangle in triangles {
        let (enter, leave) = column(triangle, start, path);
        let normal = normal(triangle);
        let approach = path.dot(normal);
        if leave - enter <= sliver || approach >= 0.0 {
            continue;
        }
        let gap = (start - triangle[0]).dot(normal) + lift;
        let (s0, s1) = (gap + approach * enter, gap + approach * leave);
        let fraction = if s0 <= 0.0 {
            enter
        } else if s1 < 0.0 {
            enter + (leave - enter) * (s0 / (s0 - s1))
        } else {
            continue;
        };
        if first.is_none_or(|f| fraction < f.fraction) {
            first = Some(Contact { fraction, normal });
        }
    }
    first
}

/// How far a point lies inside a triangle's column, m; negative outside.
fn depth(t: &Triangle, x: f64, y: f64) -> f64 {
    let side = |k: usize| {
        let (a, edge) = (t[k], t[(k + 1) % 3] - t[k]);
        (edge.x * (y - a.y) - edge.y * (x - a.x)) / edge.x.hypot(edge.y)
    };
    side(0).min(side(1)).min(side(2))
}

/// The normals of the triangles whose column comes within `reach` metres of a point.
pub fn normals_at<'a>(
    triangles: impl Iterator<Item = &'a Triangle>,
    x: f64,
    y: f64,
    reach: f64,
) -> Vec<Vector> {
    triangles.filter(|t| depth(t, x, y) >= -reach).map(normal).collect()
}

/// Height of the triangle that a point lies in, or nearest to.
pub fn height_at<'a>(triangles: impl Iterator<Item = &'a Triangle>, x: f64, y: f64) -> Option<f64> {
    let t = triangles.max_by(|a, b| depth(a, x, y).total_cmp(&depth(b, x, y)))?;
    let n = normal(t);
    Some(t[0].z - (n.x * (x - t[0].x) + n.y * (y - t[0].y)) / n.z)
}
