//! Heights and normals.

use crate::common::lab::floats;
use crate::witness::Witness;
use crate::worlds::{Paths, World, worlds};
use discjump_core::real::{Scalar, V3};
use discjump_core::terrain::{Edge, Maps};

fn maps(world: &World) -> Maps {
    Maps::new(core::slice::from_ref(&world.field)).unwrap()
}

fn heights_and_normals<T: Scalar>() {
    for (k, world) in worlds().iter().enumerate() {
        let (maps, witness) = (maps(world), Witness::new::<T>(&world.field));
        let surface = maps.surface::<T>();
        let mut paths = Paths::new(world, &witness, 50 + k as u64);
        // Of coordinates some squares away, times the slope.
        let eps = if T::DOUBLE { 1e-14 } else { 4e-6 } * world.relief;
        for _ in 0..5_000 {
            let (x, y) = paths.place::<T>();
            let ground = surface.ground::<T>(0, x, y);
            let (x, y) = (x.to_f64(), y.to_f64());
            let what = || format!("{} at ({x:?}, {y:?})", world.name);
            let Some(height) = witness.height(x, y) else {
                assert!(!ground.exists, "{}", what());
                continue;
            };
            assert!(ground.exists, "{}", what());
            assert!((ground.height.to_f64() - height).abs() <= 20.0 * eps, "{}: {height}", what());
            let n = floats(ground.normal());
            let tolerance = if T::DOUBLE { 1e-11 } else { 3e-5 };
            // A place whose product with the inverse of a side rounds to a whole number is on that side.
            let size = world.field.square_size();
            let hair = if size == 8.0 { 1e-44 } else { 1e-18 + 3e-16 * x.abs().max(y.abs()) };
            let hair = if T::DOUBLE || size == 8.0 { hair } else { hair * 1e9 };
            let known = (0..9).any(|k| {
                let (x, y) = (x + f64::from(k % 3 - 1) * hair, y + f64::from(k / 3 - 1) * hair);
                let Some(_) = witness.height(x, y) else { return true };
                let [sx, sy] = witness.slopes(x, y);
                let length = (1.0 + sx * sx + sy * sy).sqrt();
                let expected = [-sx / length, -sy / length, 1.0 / length];
                (0..3).all(|k| (n[k] - expected[k]).abs() < tolerance)
            });
            assert!(known, "{}: {n:?}", what());
        }
    }
}

#[test]
fn heights_and_normals_are_those_of_the_definition() {
    heights_and_normals::<f64>();
    heights_and_normals::<f32>();
}

/// At a vertex its very height; on a side between two squares what the side's two vertices say, and within
/// rounding the same just before it.
fn vertices_and_sides<T: Scalar>() {
    for world in worlds() {
        let maps = maps(&world);
        let surface = maps.surface::<T>();
        let size = T::from_f64(world.field.square_size()).to_f64();
        let grid = *world.field.grid();
        let [ci, cj] = grid.centre_vertex();
        let heights = world.field.heights();
        let vertex = |i: usize, j: usize| T::from_f64(heights[j * grid.cols + i]);
        let place = |i: usize, j: usize| {
            [T::from_f64((i as f64 - ci as f64) * size), T::from_f64((j as f64 - cj as f64) * size)]
        };
        for (i, j) in (0..grid.cols - 1).flat_map(|i| (0..grid.rows - 1).map(move |j| (i, j))) {
            let [x, y] = place(i, j);
            let off = (surface.ground::<T>(0, x, y).height - vertex(i, j)).to_f64().abs();
            // Other sides are no power of two: their vertices lie on no number.
            let rounding = if T::DOUBLE { 1e-12 } else { 1e-4 };
            let least = if size == 8.0 { 0.0 } else { rounding * world.relief };
            assert!(off <= least, "{} ({i}, {j})", world.name);
            for part in [0.125, 0.5, 0.8125] {
                let along = T::from_f64(part * size);
                let south = vertex(i, j) + (vertex(i + 1, j) - vertex(i, j)) * T::from_f64(part);
                let got = surface.ground::<T>(0, x + along, y).height;
                let tolerance = if T::DOUBLE { 1e-12 } else { 1e-4 } * world.relief;
                assert!((got - south).to_f64().abs() <= tolerance, "{} ({i}, {j})", world.name);
                // A hair south of the side, where there is ground.
                let below = y.to_f64();
                let below = if T::DOUBLE { below.next_down() } else { f64::from((below as f32).next_down()) };
                let before = surface.ground::<T>(0, x + along, T::from_f64(below));
                if before.exists {
                    assert!((before.height - got).to_f64().abs() <= tolerance, "{} ({i}, {j})", world.name);
                }
            }
        }
    }
}

#[test]
fn vertices_are_exact_and_sides_belong_to_both_squares() {
    vertices_and_sides::<f64>();
    vertices_and_sides::<f32>();
}

/// A whole number of periods away there are the same bits: a position keeps its place in the tile.
#[test]
fn tiles_repeat_and_rims_meet() {
    for world in worlds().iter().filter(|world| world.field.edge() == Edge::Tile) {
        let maps = maps(world);
        let surface = maps.surface::<f64>();
        let period = maps.size();
        for k in 0..200 {
            let (x, y) = (f64::from(k) * 0.37 * world.field.square_size(), f64::from(k) * 0.21);
            let here = surface.ground::<f64>(0, x, y).height;
            let there = surface.ground::<f64>(0, x + 4.0 * period.x, y - 2.0 * period.y).height;
            assert!((here - there).abs() <= 1e-11 * world.relief, "{}", world.name);
        }
    }
}

/// On a plane the two surfaces are one, bit by bit where nothing is mirrored.
#[test]
fn a_plane_is_a_plane() {
    let plane = crate::common::slope(20.0);
    let both = [plane.clone(), plane.with_surface(discjump_core::terrain::SurfaceKind::Bilinear)];
    let [cut, smooth] = both.map(|field| Maps::new(&[field]).unwrap());
    for k in 0..2_000 {
        let (x, y) = (f64::from(k) * 0.93 - 900.0, f64::from(k % 31) - 15.0);
        let a = cut.surface::<f64>().ground::<f64>(0, x, y);
        let b = smooth.surface::<f64>().ground::<f64>(0, x, y);
        assert!((a.height - b.height).abs() < 1e-12);
        let (n, m): (V3<f64>, V3<f64>) = (a.normal(), b.normal());
        assert!((n - m).length() < 1e-14);
    }
}
