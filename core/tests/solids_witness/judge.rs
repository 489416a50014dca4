//! The geometry itself, where two answers differ: separating axes of a box that stands still against every triangle.

use crate::worlds::World;
use glam::DVec3;

/// The player's box.
#[derive(Clone, Copy, Debug)]
pub struct Upright {
    pub centre: DVec3,
    pub half: DVec3,
}

impl Upright {
    pub fn moved(self, path: DVec3) -> Self {
        Self { centre: self.centre + path, ..self }
    }

    /// How far the box reaches under a plane through `point`; negative: above it.
    pub fn under(&self, point: DVec3, normal: DVec3) -> f64 {
        (point - self.centre).dot(normal) + self.half.dot(normal.abs())
    }
}

/// How deep the box overlaps a triangle; negative: they are apart, at least that far along some axis.
pub fn depth(upright: &Upright, corners: &[DVec3; 3]) -> f64 {
    let [a, b, c] = *corners;
    let edges = [b - a, c - b, a - c];
    let sides = [DVec3::X, DVec3::Y, DVec3::Z];
    let crosses = edges.into_iter().flat_map(|e| sides.map(|s| e.cross(s)));
    let axes = sides.into_iter().chain([edges[0].cross(edges[1])]).chain(crosses);
    axes.filter(|axis| axis.length() > 1e-9)
        .map(|axis| {
            let axis = axis.normalize();
            let p = corners.map(|corner| (corner - upright.centre).dot(axis));
            let (low, high) = (p[0].min(p[1]).min(p[2]), p[0].max(p[1]).max(p[2]));
            let radius = upright.half.dot(axis.abs());
            (radius - low).min(high + radius)
        })
        .fold(f64::INFINITY, f64::min)
}

/// The deepest overlap with any triangle.
pub fn deepest(world: &World, upright: &Upright) -> f64 {
    world.faces.iter().map(|corners| depth(upright, corners)).fold(f64::NEG_INFINITY, f64::max)
}

/// Whether a normal parts the box from a triangle that it touches.
pub fn parts(world: &World, upright: &Upright, normal: DVec3, eps: f64) -> bool {
    let apart = |corners: &[DVec3; 3]| corners.iter().all(|&c| upright.under(c, normal) <= eps);
    world.faces.iter().any(|corners| depth(upright, corners) >= -eps && apart(corners))
}
