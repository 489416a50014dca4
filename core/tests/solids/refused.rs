//! Every bad solid is refused by name, and a million good triangles are not.

use crate::common::random::Random;
use crate::common::solids::{block, built, map};
use discjump_core::solids::{MAX_TRIANGLES, Placement, Shape, Solid, Solids};
use glam::{DQuat, DVec3};
use std::time::Instant;

const NAN: f64 = f64::NAN;

#[track_caller]
fn refused(solid: Solid, parts: &[&str]) {
    let error = Solids::new(&[block([0.0; 3], [1.0; 3]), solid], &map()).map(|_| ()).unwrap_err().0;
    for part in [&"solids[1] \"bad\""].into_iter().chain(parts) {
        assert!(error.contains(*part), "expected {part:?} in {error:?}");
    }
}

/// A cube of 2 m as a mesh, changed.
fn cube(change: impl FnOnce(&mut Vec<DVec3>, &mut Vec<[u32; 3]>)) -> Solid {
    let solids = built(&[block([-1.0; 3], [1.0; 3])]);
    let mut vertices: Vec<DVec3> = solids.faces().flat_map(|(_, corners)| corners).collect();
    let mut faces = (0..12).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    change(&mut vertices, &mut faces);
    Solid::mesh("bad", vertices, faces, Placement::default())
}

fn placed(placement: Placement) -> Solid {
    Solid::new("bad", Shape::Box { size: DVec3::ONE }, placement)
}

fn hull(points: &[[f64; 3]]) -> Solid {
    Solid::hull("bad", points.iter().map(|&p| p.into()).collect(), Placement::default())
}

#[test]
fn meshes() {
    assert!(Solids::new(&[cube(|_, _| ())], &map()).is_ok());
    refused(cube(|v, _| v[7].y = NAN), &["vertices", "NaN", "vertex 7"]);
    refused(cube(|v, _| v[35].z = f64::INFINITY), &["vertices", "inf", "vertex 35"]);
    refused(cube(|v, _| v[4].x = 2e6), &["vertices", "2000000", "vertex 4"]);
    refused(cube(|_, f| f[3][1] = 36), &["faces", "below 36", "36", "face 3"]);
    refused(cube(|_, f| f.clear()), &["faces", "none"]);
    refused(cube(|_, f| f[5][2] = f[5][1]), &["faces", "face 5"]);
    refused(cube(|_, f| f.truncate(11)), &["hole", "face"]);
    refused(cube(|_, f| f.push(f[2])), &["face 2", "3 faces"]);
    refused(cube(|_, f| f[8].swap(0, 1)), &["wound against", "face 8"]);
    refused(cube(|_, f| f.iter_mut().for_each(|f| f.swap(0, 1))), &["inside out", "face 0", "m^3"]);
    // Flat: both sides of one triangle.
    let both = Solid::mesh(
        "bad",
        vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        vec![[0, 1, 2], [2, 1, 0]],
        Placement::default(),
    );
    refused(both, &["volume", "face 0"]);
    // Squeezed until its faces have no area.
    refused(cube(|v, _| v.iter_mut().for_each(|v| v.z *= 1e-8)), &["no area", "face"]);
    // A second shell inside out beside the first; within it it would be a cavity.
    let beside = |shift: f64, size: f64| {
        cube(|v, f| {
            let second: Vec<DVec3> = v.iter().map(|&v| v * size + shift).collect();
            f.extend((12..24).map(|k| [3 * k, 3 * k + 2, 3 * k + 1]));
            v.extend(second);
        })
    };
    refused(beside(5.0, 0.5), &["inside out", "face 12"]);
    assert!(Solids::new(&[beside(0.0, 0.5)], &map()).is_ok());
}

#[test]
fn boxes_hulls_and_placements() {
    for size in [[0.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, NAN], [1.0, 1e-7, 1.0]] {
        refused(Solid::cuboid("bad", size.into(), DVec3::ZERO, 0.0), &["size"]);
    }
    refused(hull(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), &["points", "3"]);
    let tripod = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    refused(hull(&[tripod[0], tripod[1], tripod[2], [NAN, 0.0, 0.0]]), &["NaN", "point 3"]);
    refused(hull(&[[1.0, 2.0, 3.0]; 9]), &["volume", "within"]);
    let line: Vec<_> = (0..9).map(|k| [f64::from(k), 2.0 * f64::from(k), 1.0]).collect();
    refused(hull(&line), &["volume", "line"]);
    let plane: Vec<_> = (0..9).map(|k| [f64::from(k % 3), f64::from(k / 3), 1.0]).collect();
    refused(hull(&plane), &["volume", "plane"]);
    let at = Placement::default();
    refused(placed(Placement { position: DVec3::new(0.0, NAN, 0.0), ..at }), &["position", "NaN"]);
    refused(placed(Placement { position: DVec3::new(0.0, 0.0, 2e6), ..at }), &["1000000", "vertex 0"]);
    refused(placed(Placement { rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0), ..at }), &["rotation", "2"]);
    refused(placed(Placement { rotation: DQuat::from_xyzw(0.0, 0.0, NAN, 1.0), ..at }), &["rotation", "NaN"]);
    refused(placed(Placement { scale: 0.0, ..at }), &["scale", "0"]);
    refused(placed(Placement { scale: NAN, ..at }), &["scale", "NaN"]);
    refused(
        placed(Placement { position: DVec3::new(1025.0, 0.0, 0.0), ..at }),
        &["on the map", "x", "1024.5"],
    );
    refused(
        placed(Placement { position: DVec3::new(0.0, -2000.0, 0.0), ..at }),
        &["on the map", "y", "-2000"],
    );
    assert!(
        Solids::new(&[placed(Placement { position: DVec3::new(1024.2, 0.0, 0.0), ..at })], &map()).is_ok()
    );
}

/// Points on a lattice: most lie on edges and sides of their hull. Whatever spans a volume has a hull, and one that
/// holds them all.
#[test]
fn hulls_of_lattices() {
    let mut random = Random::new(50);
    let mut flat = 0;
    for _ in 0..3000 {
        let mut on = || random.index(4) as f64 - 1.5;
        let count = 4 + on().abs() as usize * 12;
        let points: Vec<DVec3> = (0..count).map(|_| DVec3::new(on(), on(), on())).collect();
        let solid = Solid::hull("hull", points.clone(), Placement::default());
        let solids = match Solids::new(&[solid], &map()) {
            Ok(solids) => solids,
            Err(error) => {
                flat += 1;
                assert!(error.0.contains("span a volume"), "{error}: {points:?}");
                continue;
            }
        };
        for (_, [a, b, c]) in solids.faces() {
            let normal = (b - a).cross(c - a);
            assert!(points.iter().all(|p| (*p - a).dot(normal) < 1e-9), "{points:?}");
        }
    }
    assert!((1..1500).contains(&flat), "{flat}");
}

/// A closed wavy slab with `2 side^2` triangles above and as many below.
fn slab(side: u32) -> Solid {
    let count = side + 1;
    let at = |i: u32, j: u32, lower: u32| lower * count * count + j * count + i;
    let mut vertices = Vec::with_capacity(2 * (count * count) as usize);
    for lower in 0..2 {
        for (j, i) in (0..count).flat_map(|j| (0..count).map(move |i| (j, i))) {
            let (x, y) = (f64::from(i) * 0.5, f64::from(j) * 0.5);
            vertices.push(DVec3::new(x - 200.0, y - 200.0, 3.0 * (x / 9.0).sin() - 2.0 * f64::from(lower)));
        }
    }
    let mut faces = Vec::new();
    let mut quad = |a, b, c, d| faces.extend([[a, b, c], [a, c, d]]);
    for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
        quad(at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0));
        quad(at(i, j, 1), at(i, j + 1, 1), at(i + 1, j + 1, 1), at(i + 1, j, 1));
    }
    for i in 0..side {
        quad(at(i + 1, 0, 0), at(i, 0, 0), at(i, 0, 1), at(i + 1, 0, 1));
        quad(at(i, side, 0), at(i + 1, side, 0), at(i + 1, side, 1), at(i, side, 1));
        quad(at(0, i, 0), at(0, i + 1, 0), at(0, i + 1, 1), at(0, i, 1));
        quad(at(side, i + 1, 0), at(side, i, 0), at(side, i, 1), at(side, i + 1, 1));
    }
    Solid::mesh("slab", vertices, faces, Placement::default())
}

#[test]
fn a_million_triangles_load() {
    let solid = slab(500);
    let start = Instant::now();
    let solids = Solids::new(core::slice::from_ref(&solid), &map()).unwrap();
    println!("{} triangles in {:?}, {} bytes", solids.triangle_count(), start.elapsed(), solids.bytes());
    assert!(solids.triangle_count() > 1_000_000);
    let hit = solids.sweep_box(DVec3::new(3.0, 4.0, 100.0), DVec3::new(0.0, 0.0, -4000.0), 0.5, 2.3).unwrap();
    assert!((0.02..0.03).contains(&hit.fraction), "{hit:?}");
    // And what is wrong among a million is found.
    let Shape::Mesh { vertices, mut faces } = solid.shape else { unreachable!() };
    faces[777_777].swap(0, 1);
    let error =
        Solids::new(&[Solid::mesh("slab", vertices, faces, Placement::default())], &map()).unwrap_err();
    assert!(error.0.contains("777777"), "{error}");
}

#[test]
fn too_many_triangles() {
    let faces = vec![[0, 1, 2]; MAX_TRIANGLES + 1];
    let solid = Solid::mesh("bad", vec![DVec3::ZERO; 3], faces, Placement::default());
    refused(solid, &["4000000", "4000013"]);
}
