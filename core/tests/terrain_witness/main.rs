//! parry3d's `TriMesh` of the same triangles as an independent witness of heights, normals and
//! sweeps, in both tiers: 100,000 random queries of each kind.
//!
//! The mesh has the terrain's numbers as the tier under test sees them (rounded to `f32` in
//! `authentic`), and answers in f64, so that its own rounding never explains a difference.
//!
//! parry's rays slip through the seam between two triangles, most of all those aimed at seams as here.
//! Where it and our sweep disagree, a brute force over the triangles near the path decides; ours must
//! be right within rounding, and the slips are counted and must be few.

mod brute;
mod mesh;
mod queries;
mod worlds;

use brute::{Contact, first_contact, height_at, normals_at};
use discjump_core::real::Scalar;
use discjump_core::terrain::{Edge, Hit, Maps};
use mesh::{Mesh, normal};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::{Ray, RayCast, ShapeCastOptions, cast_shapes};
use parry3d_f64::shape::Ball;
use queries::{Queries, vector};
use worlds::{WORLDS, World};

/// Queries of each kind, over all worlds.
const QUERIES: usize = 100_000;

/// Metres by which two answers may differ on squares of 8 m: some hundred ulp of coordinates of 1 km
/// in f64; two ulp in f32. In proportion on squares of another size.
fn rounding<T: Scalar>(world: &World) -> f64 {
    let size = world.field.square_size() / 8.0;
    size * if T::DOUBLE { 1e-10 } else { 1e-4 }
}

/// Asks `query` its share of the queries on every world.
fn everywhere<T: Scalar>(mut query: impl FnMut(&World, &Mesh, &mut Queries<'_, T>)) {
    let shares: usize = WORLDS.iter().map(|w| w.share).sum();
    for (k, world) in WORLDS.iter().enumerate() {
        let maps = Maps::new(core::slice::from_ref(&world.field)).unwrap();
        let mesh = Mesh::new::<T>(&world.field);
        let mut queries = Queries::new(&world.field, maps.surface::<T>(), k as u64);
        (0..(QUERIES * world.share).div_ceil(shares)).for_each(|_| query(world, &mesh, &mut queries));
    }
}

fn heights_and_normals<T: Scalar>() {
    let (mut asked, mut slips, mut worst) = (0, 0, 0.0f64);
    everywhere::<T>(|world, mesh, queries| {
        let (x, y) = queries.place();
        let ground = queries.surface.ground::<T>(0, x, y);
        let (x, y) = (x.to_f64(), y.to_f64());
        let scale = world.field.square_size() / 8.0;
        let high = 100.0 * scale;
        let start = Vector::new(x, y, high);
        let drop = Vector::new(0.0, 0.0, -2.0 * high);
        let hit = mesh.shape.cast_local_ray_and_get_normal(&Ray::new(start, drop), 1.0, false);
        asked += 1;
        let what = || format!("{} at ({x:?}, {y:?})", world.name);
        if !ground.exists {
            // The rim itself belongs to the mesh, and on its high sides not to the map.
            let inside = normals_at(mesh.near(start, drop), x, y, -1e-9 * scale);
            assert!(world.field.edge() == Edge::Void && inside.is_empty(), "{}", what());
            return;
        }
        let eps = rounding::<T>(world);
        // Every triangle at the place, to rounding: on an edge either of its two will do here; which
        // of them it has to be is checked against the rule of ties below.
        let near = normals_at(mesh.near(start, drop), x, y, eps);
        let ours = vector(ground.normal());
        let same = |n: &Vector| (*n - ours).length() < if T::DOUBLE { 1e-11 } else { 1e-5 };
        assert!(near.iter().any(same), "{}: normal {ours:?}, expected one of {near:?}", what());
        let height = ground.height.to_f64();
        let expected = match hit {
            Some(hit) => {
                let n = hit.normal * hit.normal.z.signum();
                assert!(same(&n) || near.len() > 1, "{}: normal {ours:?}, parry {n:?}", what());
                high - 2.0 * high * hit.time_of_impact
            }
            None => {
                slips += 1;
                let within = normals_at(mesh.near(start, drop), x, y, -eps);
                assert!(within.is_empty(), "{}: parry found no ground within a triangle", what());
                // Either triangle of an edge will do: they meet there.
                height_at(mesh.near(start, drop), x, y).expect("the ground exists")
            }
        };
        worst = worst.max((height - expected).abs() / scale);
        assert!((height - expected).abs() <= eps, "{}: height {height}, parry {expected}", what());
    });
    println!("heights, double {}: {asked} asked, {slips} slips, worst {worst:.1e} m", T::DOUBLE);
    // More than half of the places lie on an edge, to an ulp: parry misses some of them, and no other.
    assert!(asked >= QUERIES && slips * 100 <= asked, "{slips} slips of {asked}");
}

#[test]
fn heights_and_normals_agree_in_f64() {
    heights_and_normals::<f64>();
}

#[test]
fn heights_and_normals_agree_in_f32() {
    heights_and_normals::<f32>();
}

/// Ties on a cut belong to the upper triangle, and on the line between two squares to the higher
/// square (docs/physics.md, section 8). Exact, so the mesh's own order of triangles is the witness.
#[test]
fn ties_belong_to_the_upper_triangle() {
    for world in WORLDS.iter().filter(|w| w.field.square_size() == 8.0) {
        let maps = Maps::new(core::slice::from_ref(&world.field)).unwrap();
        let surface = maps.surface::<f64>();
        let mesh = Mesh::new::<f64>(&world.field);
        let (cols, rows) = (world.field.cols() as i32 - 1, world.field.rows() as i32 - 1);
        for (j, i) in (0..rows).flat_map(|j| (0..cols).map(move |i| (j, i))) {
            let corner = [f64::from(i - cols / 2) * 8.0, f64::from(j - rows / 2) * 8.0];
            let upwards = (i + j) % 2 == 0;
            for quarter in 0..4 {
                let along = 2.0 * f64::from(quarter);
                let (a, b) = if upwards { (along, along) } else { (along, 8.0 - along) };
                // The upper end of the other cut belongs to the next square.
                if b < 8.0 {
                    let at = Vector::new(corner[0] + a, corner[1] + b, 0.0);
                    let square: Vec<_> = mesh
                        .near(at, Vector::ZERO)
                        .filter(|t| {
                            let middle = (t[0] + t[1] + t[2]) / 3.0;
                            let (u, v) = (middle.x - corner[0], middle.y - corner[1]);
                            (0.0..8.0).contains(&u) && (0.0..8.0).contains(&v)
                        })
                        .collect();
                    let expected = normal(square[1]);
                    let got = vector(surface.ground::<f64>(0, at.x, at.y).normal());
                    assert!((got - expected).length() < 1e-12, "{} at {at:?}", world.name);
                }
            }
        }
    }
}

/// Whether two answers are the same hit, or the same miss. Differences count across the surface: a
/// path that grazes it meets it at a fraction that no rounding can tell.
fn same_hit(ours: Option<Contact>, other: Option<Contact>, path: Vector, eps: f64) -> bool {
    match (ours, other) {
        (None, None) => true,
        (Some(a), Some(b)) => (a.fraction - b.fraction).abs() * path.dot(b.normal).abs() <= 4.0 * eps,
        _ => false,
    }
}

fn contact<T: Scalar>(hit: Hit<T>) -> Option<Contact> {
    hit.hit.then(|| Contact { fraction: hit.fraction.to_f64(), normal: vector(hit.normal) })
}

/// What the brute force says, of the path and of the same path a rounding higher, lower and aside,
/// with and without the triangles of which it touches no more than a rounding.
fn answers(mesh: &Mesh, start: Vector, path: Vector, eps: f64) -> Vec<Option<Contact>> {
    let mut answers = Vec::new();
    for (east, north) in (0..9).map(|k| (f64::from(k % 3 - 1), f64::from(k / 3 - 1))) {
        let from = start + Vector::new(east, north, 0.0) * eps;
        let triangles: Vec<_> = mesh.near(from, path).collect();
        for lift in [0.0, eps, -eps] {
            for sliver in [0.0, eps / path.x.hypot(path.y)] {
                answers.push(first_contact(triangles.iter().copied(), from, path, lift, sliver));
            }
        }
    }
    answers
}

/// The normal must be that of a triangle at the point of contact.
fn check_normal<T: Scalar>(mesh: &Mesh, start: Vector, path: Vector, hit: Contact, eps: f64) {
    let at = start + path * hit.fraction;
    let near = normals_at(mesh.near(at, Vector::ZERO), at.x, at.y, 10.0 * eps);
    let tolerance = if T::DOUBLE { 1e-11 } else { 1e-5 };
    let known = near.iter().any(|n| (*n - hit.normal).length() < tolerance);
    assert!(known && path.dot(hit.normal) < tolerance, "{start:?} {path:?}: normal {:?}", hit.normal);
}

fn rays<T: Scalar>() {
    let (mut asked, mut hits, mut slips, mut grazes, mut worst) = (0, 0, 0, 0, 0.0f64);
    everywhere::<T>(|world, mesh, queries| {
        let eps = rounding::<T>(world);
        let clearance = world.field.square_size() * (0.001 + queries.unit().powi(3) * 2.0);
        let (start, path) = queries.path(clearance);
        let ours = contact(queries.surface.sweep::<T>(0, start, path, true));
        let (start, path) = (vector(start), vector(path));
        let ray = mesh.shape.cast_local_ray_and_get_normal(&Ray::new(start, path), 1.0, false);
        let ray = ray.map(|r| Contact { fraction: r.time_of_impact, normal: r.normal });
        asked += 1;
        if let Some(hit) = ours {
            hits += 1;
            check_normal::<T>(mesh, start, path, hit, eps);
        }
        if same_hit(ours, ray, path, eps) {
            if let (Some(a), Some(b)) = (ours, ray) {
                let across = (a.fraction - b.fraction).abs() * path.dot(b.normal).abs();
                worst = worst.max(across / world.field.square_size() * 8.0);
            }
            return;
        }
        let right = answers(mesh, start, path, eps);
        let by_parry = right.iter().any(|r| same_hit(ray, *r, path, eps));
        *(if by_parry { &mut grazes } else { &mut slips }) += 1;
        let by_us = right.iter().any(|r| same_hit(ours, *r, path, eps));
        assert!(
            by_us,
            "{}: {start:?} {path:?}: ours {ours:?}, parry {ray:?}, right {:?}",
            world.name, right[0]
        );
    });
    println!(
        "rays, double {}: {asked} cast, {hits} hits, {slips} slips, {grazes} grazes, worst {worst:.1e} m",
        T::DOUBLE
    );
    assert!(asked >= QUERIES && hits * 4 > asked && hits * 20 < 19 * asked, "{hits} hits of {asked}");
    // A third of the paths end on the surface: whether they touch it is a matter of rounding.
    assert!(slips * 1000 <= asked && grazes * 30 <= asked, "{slips} slips, {grazes} grazes");
}

#[test]
fn rays_from_above_agree_in_f64() {
    rays::<f64>();
}

#[test]
fn rays_from_above_agree_in_f32() {
    rays::<f32>();
}

/// A path that starts below the surface: the rule of section 5, by brute force alone, since parry's
/// triangles have two sides.
fn from_below<T: Scalar>() {
    let (mut asked, mut hits, mut entries, mut differences) = (0, 0, 0, 0);
    everywhere::<T>(|world, mesh, queries| {
        let eps = rounding::<T>(world);
        let depth = world.field.square_size() * (0.001 + queries.unit().powi(3));
        let (start, path) = queries.path(-depth);
        let ours = contact(queries.surface.sweep::<T>(0, start, path, true));
        let (start, path) = (vector(start), vector(path));
        asked += 1;
        if let Some(hit) = ours {
            hits += 1;
            entries += usize::from(hit.fraction == 0.0);
            check_normal::<T>(mesh, start, path, hit, eps);
        }
        let plain = first_contact(mesh.near(start, path), start, path, 0.0, 0.0);
        if same_hit(ours, plain, path, eps) {
            return;
        }
        differences += 1;
        let right = answers(mesh, start, path, eps);
        let agree = right.iter().any(|r| same_hit(ours, *r, path, eps));
        assert!(agree, "{}: {start:?} {path:?}: ours {ours:?}, right {:?}", world.name, right[0]);
    });
    println!(
        "from below, double {}: {asked} cast, {hits} hits, {entries} at the start, {differences} by rounding",
        T::DOUBLE
    );
    assert!(asked >= QUERIES && entries > 0 && entries < hits && hits < asked);
    assert!(differences * 30 <= asked, "{differences} of {asked} decided by rounding");
}

#[test]
fn paths_from_below_hit_where_they_enter_in_f64() {
    from_below::<f64>();
}

#[test]
fn paths_from_below_hit_where_they_enter_in_f32() {
    from_below::<f32>();
}

/// A small ball instead of a point. It always touches before the point does. Where both meet the same
/// face, the point has one radius to go along the face's normal; and where the ball touches anything,
/// the ground is within its radius of the centre, so the height over it is at most the radius over
/// the cosine of the steepest slope.
#[test]
fn small_balls_agree() {
    let (mut asked, mut hits, mut faces, mut worst) = (0, 0, 0, 0.0f64);
    everywhere::<f64>(|world, mesh, queries| {
        let size = world.field.square_size();
        let radius = size * 1e-4;
        // The cast ends when it is this near: parry's own tolerance.
        let eps = 1e-6 * size;
        let clearance = size * (0.01 + queries.unit().powi(3));
        let (start, path) = queries.path(clearance);
        let ours = contact(queries.surface.sweep::<f64>(0, start, path, true));
        let (start, path) = (vector(start), vector(path));
        let options = ShapeCastOptions::with_max_time_of_impact(1.0);
        let (place, still) = (Pose::from_translation(start), Pose::IDENTITY);
        let ball = Ball::new(radius);
        let cast = cast_shapes(&place, path, &ball, &still, Vector::ZERO, &mesh.shape, options).unwrap();
        asked += 1;
        let what = || format!("{}: {start:?} {path:?}: ours {ours:?}, ball {cast:?}", world.name);
        let Some(cast) = cast else {
            assert!(ours.is_none(), "{}", what());
            return;
        };
        let at = start + path * cast.time_of_impact;
        let ground = queries.surface.ground::<f64>(0, at.x, at.y);
        let steepest = 70.5f64.to_radians();
        let over_the_rim = world.field.edge() == Edge::Void && !ground.exists;
        assert!(over_the_rim || at.z - ground.height <= radius / steepest.cos() + eps, "{}", what());
        let Some(ours) = ours else { return };
        hits += 1;
        assert!(cast.time_of_impact <= ours.fraction, "{}", what());
        if (cast.normal2 - ours.normal).length() < 1e-6 {
            faces += 1;
            let across = (ours.fraction - cast.time_of_impact) * -path.dot(ours.normal);
            worst = worst.max((across - radius).abs() / size * 8.0);
            assert!((across - radius).abs() <= eps, "{}: {across}", what());
        }
    });
    println!("balls: {asked} cast, {hits} hits, {faces} on the same face, worst {worst:.1e} m");
    assert!(asked >= QUERIES && hits * 3 > asked && faces * 10 > 8 * hits);
}
