//! Sweeps and lines against the witness.

use crate::common::draws::rough;
use crate::common::lab::floats;
use crate::common::random::Random;
use crate::common::{rolling, slope};
use crate::witness::{Met, Vector, Witness};
use crate::worlds::{Paths, World, worlds};
use discjump_core::real::{Scalar, V3};
use discjump_core::terrain::{Heightfield, Hit, Maps, Surface, SurfaceKind};

/// Paths on every world.
const PATHS: usize = 2_500;

/// Places a rounding aside.
fn aside(eps: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..9).map(move |k| [f64::from(k % 3 - 1) * eps, f64::from(k / 3 - 1) * eps])
}

/// What is right for the path, or for one that begins or ends a rounding aside, higher or lower, with stretches
/// no longer than a rounding counted or not.
fn answers(
    ask: impl Fn(Vector, Vector, f64) -> Option<Met>,
    start: Vector,
    path: Vector,
    eps: f64,
) -> Vec<Option<Met>> {
    let mut answers = Vec::new();
    for [east, north] in aside(eps) {
        for [lift, tilt] in aside(eps) {
            let from = [start[0] + east, start[1] + north, start[2] + lift];
            let path = [path[0], path[1], path[2] + 2.0 * tilt];
            for sliver in [0.0, eps / path[0].hypot(path[1])] {
                answers.push(ask(from, path, sliver));
            }
        }
    }
    answers
}

/// Whether two answers are one: at one place, or between them the path comes no nearer to the surface: a crest
/// of the gap, where it begins to sink in, is flat.
fn same<T: Scalar>(
    witness: &Witness,
    hit: &Hit<T>,
    met: Option<Met>,
    start: Vector,
    path: Vector,
    eps: f64,
) -> bool {
    let Some(met) = met else { return !hit.hit };
    if !hit.hit {
        return false;
    }
    let ours = hit.fraction.to_f64();
    let (low, high) = (ours.min(met.at), ours.max(met.at));
    let length = path.iter().map(|x| x * x).sum::<f64>().sqrt();
    let gap = |t: f64| {
        let p = [0, 1, 2].map(|k| start[k] + path[k] * t);
        witness.height(p[0], p[1]).map_or(0.0, |ground| p[2] - ground)
    };
    (high - low) * length <= 8.0 * eps
        || (0..=8).all(|k| {
            let between = gap(low + (high - low) * f64::from(k) / 8.0);
            (between - gap(low)).abs() <= 8.0 * eps
        })
}

/// The normal is that of the ground somewhere between the contact and where the path leaves that square, and
/// the path leads into it.
fn check_normal<T: Scalar>(witness: &Witness, (start, path): (Vector, Vector), hit: &Hit<T>, eps: f64) {
    let n = floats(hit.normal);
    let (sx, sy) = (-n[0] / n[2], -n[1] / n[2]);
    let what = || format!("{start:?} {path:?} {hit:?}");
    assert!((n.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-5, "{}", what());
    let dull = if T::DOUBLE { 1e-9 } else { 2e-3 } * (sx.abs() + sy.abs() + 1.0);
    let length = path[0].hypot(path[1]) + path[2].abs();
    let into = path[2] - sx * path[0] - sy * path[1];
    assert!(into < dull * length, "into {into}: {}", what());
    let ours = hit.fraction.to_f64();
    let out = witness.leaves(start, path, ours + 10.0 * eps / length);
    let known = aside(eps).any(|[east, north]| {
        let slopes = |t: f64| {
            let (x, y) = (start[0] + path[0] * t + east, start[1] + path[1] * t + north);
            witness.height(x, y).map(|_| witness.slopes(x, y))
        };
        // A hair within the square, whichever side the ends lie on; and the very place, for one that it only
        // just touches.
        let ahead = |k: i32| slopes(ours + (out - ours) * (f64::from(k) / 64.0).clamp(1e-6, 1.0 - 1e-6));
        let (Some(first), Some(last)) = (ahead(0), ahead(64)) else { return true };
        let spread = (first[0] - last[0]).abs() + (first[1] - last[1]).abs();
        let nearest =
            (0..=64).filter_map(ahead).chain(slopes(ours)).map(|s| (s[0] - sx).abs() + (s[1] - sy).abs());
        nearest.fold(f64::MAX, f64::min) <= spread / 32.0 + 10.0 * dull
    });
    assert!(known, "{}", what());
}

fn everywhere<T: Scalar>(
    eps: f64,
    mut each: impl FnMut(&World, &Witness, &Surface<'_, T>, (V3<T>, V3<T>), f64),
) {
    for (k, world) in worlds().iter().enumerate() {
        let maps = Maps::new(core::slice::from_ref(&world.field)).unwrap();
        let witness = Witness::new::<T>(&world.field);
        let surface = maps.surface::<T>();
        let mut paths = Paths::new(world, &witness, 100 + k as u64);
        for _ in 0..PATHS {
            let path = paths.path::<T>();
            let eps = eps * (world.relief + witness.size);
            each(world, &witness, &surface, path, eps);
        }
    }
}

fn sweeps<T: Scalar>(eps: f64) {
    let (mut asked, mut hits, mut starts, mut close, mut tangents) = (0, 0, 0, 0, 0);
    everywhere::<T>(eps, |world, witness, surface, (start, path), eps| {
        let hit = surface.sweep::<T>(0, start, path, true);
        let passes = surface.passes::<T>(0, start, path);
        let (start, path) = (floats(start), floats(path));
        asked += 1;
        let fraction = hit.fraction.to_f64();
        assert!((0.0..=1.0).contains(&fraction), "{}: {fraction}", world.name);
        assert!(!(passes && hit.hit), "{}: {start:?} {path:?} passes and hits", world.name);
        let plain = witness.sweep(start, path, 0.0);
        if hit.hit {
            hits += 1;
            starts += usize::from(fraction == 0.0);
            check_normal(witness, (start, path), &hit, eps);
        }
        if same(witness, &hit, plain, start, path, eps) {
            return;
        }
        close += 1;
        let right = answers(|s, p, sliver| witness.sweep(s, p, sliver), start, path, eps);
        let mut agree = right.iter().any(|met| same(witness, &hit, *met, start, path, eps));
        if !agree && hit.hit && plain.is_none_or(|met| met.at > fraction) {
            // From below along the tangent: whether it sinks in for a hair before it rises, no search can tell.
            let [sx, sy] = witness.slopes(start[0] + path[0] * fraction, start[1] + path[1] * fraction);
            agree = (path[2] - sx * path[0] - sy * path[1]).abs() <= 10.0 * eps;
            tangents += usize::from(agree);
        }
        assert!(agree, "{}: {start:?} {path:?}: {hit:?}, right {plain:?}", world.name);
    });
    println!(
        "sweeps, double {}: {asked}, {hits} hits, {starts} at the start, {close} by rounding",
        T::DOUBLE
    );
    assert!(asked >= 20_000 && hits * 3 > asked && hits * 10 < 9 * asked && starts * 20 > asked);
    assert!(close * 10 < asked && tangents * 1000 < asked, "{close} and {tangents} of {asked} by rounding");
}

#[test]
fn sweeps_find_the_first_contact_in_f64() {
    sweeps::<f64>(1e-12);
}

#[test]
fn sweeps_find_the_first_contact_in_f32() {
    sweeps::<f32>(1e-5);
}

fn lines<T: Scalar>(eps: f64) {
    let (mut hits, mut close, mut asked) = (0, 0, 0);
    everywhere::<T>(eps, |world, witness, surface, (start, path), eps| {
        let hit = surface.line::<T>(0, start, path, true);
        let (start, path) = (floats(start), floats(path));
        (asked, hits) = (asked + 1, hits + usize::from(hit.hit));
        assert!((0.0..=1.0).contains(&hit.fraction.to_f64()) && hit.normal.z > T::zero());
        let plain = witness.line(start, path, 0.0);
        if same(witness, &hit, plain, start, path, eps) {
            return;
        }
        close += 1;
        let right = answers(|s, p, sliver| witness.line(s, p, sliver), start, path, eps);
        let agree = right.iter().any(|met| same(witness, &hit, *met, start, path, eps));
        assert!(agree, "{}: {start:?} {path:?}: {hit:?}, right {plain:?}", world.name);
    });
    println!("lines, double {}: {hits} hits of {asked}, {close} by rounding", T::DOUBLE);
    assert!(hits * 3 > asked && close * 6 < asked);
}

#[test]
fn lines_find_the_first_crossing_from_either_side() {
    lines::<f64>(1e-12);
    lines::<f32>(1e-5);
}

/// Over a plane there is nothing to choose between the surfaces.
#[test]
fn a_plane_is_met_where_its_triangles_are() {
    let plane = slope(25.0);
    let both = [plane.clone(), plane.with_surface(SurfaceKind::Bilinear)];
    let [cut, smooth] = both.map(|field| Maps::new(&[field]).unwrap());
    let mut random = Random::new(3);
    let mut hits = 0;
    for _ in 0..20_000 {
        let (x, y) = (random.within(-900.0, 900.0), random.within(-15.0, 15.0));
        let z = -25.0f64.to_radians().tan() * x + random.within(-0.5, 3.0).max(-0.1);
        let start = V3::new(x, y, z);
        let reach = [1.0, 20.0, 300.0][random.index(3)];
        let path = V3::new(random.wide() * reach, random.wide() * reach * 0.1, random.wide() * reach);
        let a = cut.surface::<f64>().sweep::<f64>(0, start, path, true);
        let b = smooth.surface::<f64>().sweep::<f64>(0, start, path, true);
        let sunk = z < -25.0f64.to_radians().tan() * x;
        // From below rounding says at which edge a path that is parallel to the plane moves into it.
        if a.hit != b.hit {
            assert!(sunk, "{start:?} {path:?} {a:?} {b:?}");
            continue;
        }
        hits += usize::from(a.hit);
        assert!((a.fraction - b.fraction).abs() < 1e-9, "{start:?} {path:?} {a:?} {b:?}");
        assert!((a.normal - b.normal).length() < 1e-12);
    }
    assert!(hits > 5_000, "{hits}");
}

/// A turned path leads over the rest of the square in one turn or two: players on hollow ground get on.
#[test]
fn a_turn_along_the_normal_leads_out_of_a_hollow() {
    let fields: [Heightfield; 2] = [rolling(), rough(3)];
    let mut random = Random::new(11);
    let mut most = [0usize; 8];
    for field in fields.map(|field| field.with_surface(SurfaceKind::Bilinear)) {
        let maps = Maps::new(&[field]).unwrap();
        let surface = maps.surface::<f64>();
        for _ in 0..20_000 {
            // Within one square, from the ground along the tangent and a little into it.
            let corner = [8.0 * random.index(6) as f64, 8.0 * random.index(6) as f64];
            let (x, y) = (corner[0] + random.within(0.1, 7.9), corner[1] + random.within(0.1, 7.9));
            let end = [corner[0] + random.within(0.1, 7.9), corner[1] + random.within(0.1, 7.9)];
            let ground = surface.ground::<f64>(0, x, y);
            let far = random.within(0.02, 1.0);
            let (dx, dy) = ((end[0] - x) * far, (end[1] - y) * far);
            let into = 0.02 * random.within(0.0, 1.0) * dx.hypot(dy);
            let start = V3::new(x, y, ground.height);
            let mut path = V3::new(dx, dy, ground.slope_x * dx + ground.slope_y * dy - into);
            let mut turns = 0;
            loop {
                let hit = surface.sweep::<f64>(0, start, path, true);
                if !hit.hit {
                    break;
                }
                turns += 1;
                assert!(path.dot(hit.normal) < 0.0);
                path = path + hit.normal * (1e-5 - path.dot(hit.normal));
                assert!(turns < 8, "{start:?} {path:?}");
            }
            most[turns] += 1;
        }
    }
    println!("turns: {most:?}");
    let all: usize = most.iter().sum();
    assert!(most[4..].iter().sum::<usize>() * 1000 < all, "{most:?}");
}

/// Nothing is met where there is nothing to be met with, and no number is lost.
#[test]
fn paths_of_no_length_and_of_lost_numbers() {
    for world in worlds() {
        let maps = Maps::new(core::slice::from_ref(&world.field)).unwrap();
        fn check<T: Scalar>(surface: &Surface<'_, T>) {
            let t = T::from_f64;
            let ground = surface.ground::<T>(0, t(0.001), t(0.001));
            for lift in [-1.0, 0.0, 1.0] {
                let start = V3::new(t(0.001), t(0.001), ground.height + t(lift));
                for size in [0.0, 1e-45, 1e-38, 1e-30, 1e-20, 1e-10, f64::NAN] {
                    for (x, y, z) in (0..27).map(|k| (k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)) {
                        let path =
                            V3::new(t(f64::from(x) * size), t(f64::from(y) * size), t(f64::from(z) * size));
                        for hit in [
                            surface.sweep::<T>(0, start, path, true),
                            surface.line::<T>(0, start, path, true),
                        ] {
                            let f = hit.fraction.to_f64();
                            assert!((0.0..=1.0).contains(&f), "{path:?} {hit:?}");
                            let n = floats(hit.normal);
                            assert!(n.iter().all(|x| x.is_finite()), "{path:?} {hit:?}");
                            assert!(!(hit.hit && size == 0.0 && lift > 0.0), "{path:?} {hit:?}");
                        }
                    }
                }
            }
        }
        check(&maps.surface::<f32>());
        check(&maps.surface::<f64>());
    }
}
