//! Shapes as vertices and triangles.

use super::solid::{MAX_HULL_POINTS, Shape};
use crate::error::{InputError, refuse};
use glam::DVec3;
use parry3d_f64::transformation::try_convex_hull;
use std::borrow::Cow;
use std::collections::HashMap;

/// Vertices and faces of a shape, in its own coordinates.
pub(super) type Buffers<'a> = (Cow<'a, [DVec3]>, Cow<'a, [[u32; 3]]>);

/// Thinnest that a box or hull may be, m: below, rounding of world coordinates would tell its normals.
pub(super) const THINNEST: f64 = 1e-6;

/// The triangles of a shape. `what` names the solid in errors.
pub(super) fn triangles<'a>(shape: &'a Shape, what: &str) -> Result<Buffers<'a>, InputError> {
    match shape {
        Shape::Box { size } => {
            if !(size.is_finite() && size.min_element() >= THINNEST) {
                refuse!("{what}: size: expected three finite sides of at least {THINNEST} m, got {size:?}");
            }
            Ok((cuboid(*size).into(), BOX_FACES.as_slice().into()))
        }
        Shape::Hull { points } => {
            let (vertices, faces) = hull(points, what)?;
            Ok((vertices.into(), faces.into()))
        }
        Shape::Mesh { vertices, faces } => Ok((vertices.into(), faces.into())),
    }
}

/// The corners of a box, x fastest.
fn cuboid(size: DVec3) -> Vec<DVec3> {
    let side = |bit: u32, size: f64| if bit == 0 { -0.5 * size } else { 0.5 * size };
    (0..8).map(|k| DVec3::new(side(k & 1, size.x), side(k & 2, size.y), side(k & 4, size.z))).collect()
}

/// Two triangles for each side of [`cuboid`].
const BOX_FACES: [[u32; 3]; 12] = [
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
];

fn hull(points: &[DVec3], what: &str) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), InputError> {
    if !(4..=MAX_HULL_POINTS).contains(&points.len()) {
        refuse!("{what}: points: expected 4 to {MAX_HULL_POINTS}, got {}", points.len());
    }
    if let Some(k) = points.iter().position(|p| !p.is_finite()) {
        refuse!("{what}: points: expected finite numbers, got {:?} at point {k}", points[k]);
    }
    let frame = Frame::of(points, what)?;
    let fail = |why: &dyn core::fmt::Display| InputError(format!("{what}: points: no convex hull: {why}"));
    let even: Vec<DVec3> = points.iter().map(|&p| frame.even(p)).collect();
    let (corners, faces) = try_convex_hull(&even).map_err(|e| fail(&e))?;
    let bits = |v: &DVec3| v.to_array().map(f64::to_bits);
    let given: HashMap<_, usize> = even.iter().map(bits).zip(0..).collect();
    let chosen: Option<Vec<usize>> = corners.iter().map(|v| given.get(&bits(v)).copied()).collect();
    let chosen = chosen.ok_or_else(|| fail(&"a corner that was not given"))?;
    let vertices: Vec<DVec3> = chosen.iter().map(|&k| points[k]).collect();
    if let Some(k) = left_outside(points, &chosen, &vertices, &faces) {
        return Err(fail(&format_args!("point {k} was left outside")));
    }
    Ok((vertices, faces))
}

/// A point that a hull does not hold: rounding decides about those that all but lie in the plane of others. For the
/// hull's own corners it is enough to ask whether it is convex along every side; all others are held against all faces.
fn left_outside(points: &[DVec3], chosen: &[usize], vertices: &[DVec3], faces: &[[u32; 3]]) -> Option<usize> {
    let slack = 1e-9 * vertices.iter().fold(0.0, |m: f64, v| m.max((*v - vertices[0]).length()));
    let slack = slack.max(THINNEST);
    let planes: Vec<(DVec3, DVec3)> = faces
        .iter()
        .map(|face| {
            let [a, b, c] = face.map(|k| vertices[k as usize]);
            (a, (b - a).cross(c - a).normalize_or_zero())
        })
        .collect();
    let above = |p: DVec3, (a, normal): &(DVec3, DVec3)| (p - a).dot(*normal) > slack;
    let sides = |face: &[u32; 3]| [0, 1, 2].map(|k| (face[k], face[(k + 1) % 3], face[(k + 2) % 3]));
    let tips: HashMap<(u32, u32), u32> =
        faces.iter().flat_map(sides).map(|(from, to, tip)| ((from, to), tip)).collect();
    for (face, plane) in faces.iter().zip(&planes) {
        for (from, to, _) in sides(face) {
            if let Some(&tip) = tips.get(&(to, from))
                && above(vertices[tip as usize], plane)
            {
                return Some(chosen[tip as usize]);
            }
        }
    }
    let mut inner = vec![true; points.len()];
    chosen.iter().for_each(|&k| inner[k] = false);
    (0..points.len()).find(|&k| inner[k] && planes.iter().any(|plane| above(points[k], plane)))
}

/// The axes along which points spread, and how far.
struct Frame {
    origin: DVec3,
    axes: [DVec3; 3],
    spread: DVec3,
}

impl Frame {
    /// A point with its spread along all axes alike: that changes nothing about which points are corners of the hull,
    /// and everything about how well a thin wall's can be told.
    fn even(&self, point: DVec3) -> DVec3 {
        DVec3::from(self.axes.map(|axis| axis.dot(point - self.origin))) / self.spread
    }

    /// Refuses points that all lie in one place, line or plane.
    fn of(points: &[DVec3], what: &str) -> Result<Self, InputError> {
        let farthest = |distance: &dyn Fn(DVec3) -> f64| {
            points
                .iter()
                .map(|&p| (distance(p), p))
                .fold((0.0, points[0]), |m, d| if d.0 > m.0 { d } else { m })
        };
        let origin = points[0];
        let (length, end) = farthest(&|p| (p - origin).length());
        if length < THINNEST {
            refuse!(
                "{what}: points: expected four that span a volume, got all within {length} m of {origin:?}"
            );
        }
        let along = (end - origin) / length;
        let (width, side) = farthest(&|p| (p - origin).cross(along).length());
        if width < THINNEST {
            refuse!("{what}: points: expected four that span a volume, got all within {width} m of a line");
        }
        let normal = along.cross(side - origin).normalize();
        let (depth, _) = farthest(&|p| (p - origin).dot(normal).abs());
        if depth < THINNEST {
            refuse!("{what}: points: expected four that span a volume, got all within {depth} m of a plane");
        }
        let axes = [along, normal.cross(along), normal];
        Ok(Self { origin, axes, spread: DVec3::new(length, width, depth) })
    }
}
