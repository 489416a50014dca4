//! Random solids of every shape, and parry3d's shapes of the same points.

use crate::common::random::Random;
use crate::common::solids::map;
use discjump_core::solids::{Placement, Shape, Solid, Solids};
use glam::{DQuat, DVec3};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::shape::{ConvexPolyhedron, Cuboid, Shape as ParryShape, TriMesh};

pub const NAMES: [&str; 5] = ["upright box", "box", "hull", "torus", "spikes"];

pub struct World {
    pub name: &'static str,
    pub solids: Solids,
    /// Corners of every triangle.
    pub faces: Vec<[DVec3; 3]>,
    pub parry: (Pose, Box<dyn ParryShape>),
}

fn rotation(random: &mut Random) -> DQuat {
    let q = DQuat::from_xyzw(random.wide(), random.wide(), random.wide(), random.wide());
    q.normalize()
}

/// A closed surface from rings of points: row by row round the x axis, closed in both directions.
fn torus(random: &mut Random) -> Shape {
    let (around, across) = (11, 7);
    let (far, thick) = (random.within(2.0, 6.0), random.within(0.3, 1.8));
    let turn = core::f64::consts::TAU;
    let mut vertices = Vec::new();
    for i in 0..around {
        for j in 0..across {
            let (a, b) = (turn * f64::from(i) / f64::from(around), turn * f64::from(j) / f64::from(across));
            let r = far + thick * random.within(0.6, 1.0) * b.cos();
            vertices.push(DVec3::new(r * a.cos(), r * a.sin(), thick * b.sin()));
        }
    }
    let at = |i: i32, j: i32| ((i % around) * across + j % across) as u32;
    let faces = (0..around).flat_map(|i| (0..across).map(move |j| (i, j))).flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    Shape::Mesh { vertices, faces: faces.collect() }
}

/// A ball whose every vertex is pulled in or out: valleys and spikes.
fn spikes(random: &mut Random) -> Shape {
    let (rings, across) = (6, 9);
    let size = random.within(1.0, 6.0);
    let mut pull = || size * random.within(0.5, 1.0);
    let mut vertices = vec![DVec3::Z * pull(), DVec3::NEG_Z * pull()];
    for i in 1..=rings {
        for j in 0..across {
            let a = core::f64::consts::PI * f64::from(i) / f64::from(rings + 1);
            let b = core::f64::consts::TAU * f64::from(j) / f64::from(across);
            vertices.push(DVec3::new(a.sin() * b.cos(), a.sin() * b.sin(), a.cos()) * pull());
        }
    }
    let at = |i: i32, j: i32| (2 + (i - 1) * across + j % across) as u32;
    let mut faces = Vec::new();
    for j in 0..across {
        faces.push([0, at(1, j), at(1, j + 1)]);
        faces.push([1, at(rings, j + 1), at(rings, j)]);
        for i in 1..rings {
            faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            faces.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Shape::Mesh { vertices, faces }
}

pub fn world(kind: usize, random: &mut Random) -> World {
    let upright = kind == 0;
    let name = NAMES[kind];
    let shape = match kind {
        0 | 1 => {
            let mut side = || 10f64.powf(random.within(-3.0, 1.3));
            Shape::Box { size: DVec3::new(side(), side(), side()) }
        }
        2 => {
            let size = random.within(0.5, 8.0);
            let points = (0..24).map(|_| size * DVec3::new(random.wide(), random.wide(), random.wide()));
            Shape::Hull { points: points.collect() }
        }
        3 => torus(random),
        _ => spikes(random),
    };
    let placement = Placement {
        position: 100.0 * DVec3::new(random.wide(), random.wide(), random.wide()),
        rotation: if upright { DQuat::IDENTITY } else { rotation(random) },
        scale: 1.0,
    };
    let place = |points: &[DVec3]| -> Vec<Vector> { points.iter().map(|&p| placement.place(p)).collect() };
    let parry: (Pose, Box<dyn ParryShape>) = match &shape {
        Shape::Box { size } => {
            (Pose::from_parts(placement.position, placement.rotation), Box::new(Cuboid::new(*size / 2.0)))
        }
        Shape::Hull { points } => {
            (Pose::IDENTITY, Box::new(ConvexPolyhedron::from_convex_hull(&place(points)).unwrap()))
        }
        Shape::Mesh { vertices, faces } => {
            (Pose::IDENTITY, Box::new(TriMesh::new(place(vertices), faces.clone()).unwrap()))
        }
    };
    let solids = Solids::new(&[Solid::new(name, shape, placement)], &map()).unwrap();
    let faces = solids.faces().map(|(_, corners)| corners).collect();
    World { name, solids, faces, parry }
}
