//! parry3d's shape casts as an independent witness of the swept box: 100,000 random paths against boxes, hulls
//! and closed meshes, slow and fast, at them and past them.
//!
//! Times of impact must agree within 1e-4 m of path and normals within 1e-3; the worst are printed. Where they do not, the geometry
//! decides: a separating-axis test of the box at rest, against every triangle. Ours must be right; how often parry was
//! not, or how often two answers are right (a box that comes down on a corner has many normals), is counted.

#[path = "../common/mod.rs"]
mod common;
mod judge;
mod worlds;

use common::random::Random;
use discjump_core::solids::{SKIN, SolidHit};
use glam::DVec3;
use judge::{Upright, deepest, parts};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::{ShapeCastHit, ShapeCastOptions, cast_shapes};
use parry3d_f64::shape::Cuboid;
use worlds::{NAMES, World, world};

const SWEEPS: usize = 100_000;
const WORLDS: usize = 250;
/// Light, medium and heavy: half width and height, m.
const ARMORS: [(f64, f64); 3] = [(0.5, 2.3), (0.7, 2.4), (0.8, 2.6)];

#[derive(Default, Debug)]
#[allow(dead_code, reason = "printed")]
struct Count {
    asked: usize,
    hits: usize,
    /// Times or normals that differ, after which the geometry was asked.
    misses: usize,
    times: usize,
    normals: usize,
    worst_time: f64,
    worst_normal: f64,
}

struct Sweep {
    feet: DVec3,
    path: DVec3,
    armor: (f64, f64),
}

impl Sweep {
    /// A path that ends, or passes, near a point of the solid.
    fn random(world: &World, random: &mut Random) -> Self {
        let armor = ARMORS[random.index(3)];
        let corners = world.faces[random.index(world.faces.len())];
        let (a, b) = (random.within(0.0, 1.0), random.within(0.0, 1.0));
        let on = match random.index(3) {
            0 => corners[0],
            1 => corners[0].lerp(corners[1], a),
            _ => {
                corners[0] + (corners[1] - corners[0]) * (a * b) + (corners[2] - corners[0]) * (a * (1.0 - b))
            }
        };
        let half = DVec3::new(armor.0, armor.0, 0.5 * armor.1);
        // Somewhere in the box meets that point, or one of its sides just does, or just does not.
        let mut inside = half * DVec3::new(random.wide(), random.wide(), random.wide());
        for axis in 0..3 {
            if random.index(4) == 0 {
                inside[axis] = half[axis].copysign(random.wide()) * (1.0 + 1e-2 * random.wide());
            }
        }
        let length = 10f64.powf(random.within(-1.5, 2.5));
        let mut direction = DVec3::new(random.wide(), random.wide(), random.wide());
        if random.index(4) == 0 {
            direction[random.index(3)] = 0.0;
        }
        let path = direction.normalize_or(DVec3::X) * length;
        let feet = on + inside - DVec3::new(0.0, 0.0, half.z) - path * random.within(0.0, 1.2);
        Self { feet, path, armor }
    }

    fn upright(&self) -> Upright {
        let half = DVec3::new(self.armor.0, self.armor.0, 0.5 * self.armor.1);
        Upright { centre: self.feet + DVec3::new(0.0, 0.0, half.z), half }
    }

    fn parry(&self, world: &World) -> Option<ShapeCastHit> {
        let upright = self.upright();
        let (place, shape) = (Pose::from_translation(upright.centre), Cuboid::new(upright.half));
        let options = ShapeCastOptions::with_max_time_of_impact(1.0);
        let (pose, solid) = &world.parry;
        cast_shapes(&place, self.path, &shape, pose, Vector::ZERO, &**solid, options).unwrap()
    }

    /// Whether the geometry allows an answer: nothing overlapped by more than a skin before it, and something met there.
    fn judged(&self, world: &World, ours: Option<SolidHit>) -> bool {
        let upright = self.upright();
        let until = ours.map_or(1.0, |hit| hit.fraction);
        let free = (0..=1000).all(|k| {
            deepest(world, &upright.moved(self.path * (until * f64::from(k) / 1000.0))) <= SKIN + 1e-6
        });
        free && ours.is_none_or(|hit| deepest(world, &upright.moved(self.path * hit.fraction)) >= -1e-6)
    }
}

fn compare(world: &World, sweep: &Sweep, count: &mut Count) {
    let ours = world.solids.sweep_box(sweep.feet, sweep.path, sweep.armor.0, sweep.armor.1);
    let other = sweep.parry(world);
    let what =
        || format!("{}: {:?} {:?}: ours {ours:?}, parry {other:?}", world.name, sweep.feet, sweep.path);
    count.asked += 1;
    let (hit, cast) = match (ours, other) {
        (None, None) => return,
        (Some(hit), Some(cast)) => (hit, cast),
        _ => {
            count.misses += 1;
            assert!(sweep.judged(world, ours), "{}", what());
            return;
        }
    };
    count.hits += 1;
    assert!((hit.normal.length() - 1.0).abs() < 1e-12 && hit.normal.dot(sweep.path) < 0.0, "{}", what());
    assert!((0.0..1.0).contains(&hit.fraction), "{}", what());
    let apart = (hit.fraction - cast.time_of_impact).abs() * sweep.path.length();
    if apart > 1e-4 {
        count.times += 1;
        assert!(sweep.judged(world, ours), "{}", what());
    } else {
        count.worst_time = count.worst_time.max(apart);
    }
    // The box's own normal points the other way.
    let turned = (hit.normal + cast.normal1).length();
    if turned > 1e-3 {
        count.normals += 1;
        let at = sweep.upright().moved(sweep.path * hit.fraction);
        assert!(parts(world, &at, hit.normal, SKIN), "{}", what());
        assert!(sweep.judged(world, ours), "{}", what());
    } else {
        count.worst_normal = count.worst_normal.max(turned);
    }
}

#[test]
fn sweeps_agree_with_parry() {
    let mut random = Random::new(1);
    for (kind, name) in NAMES.into_iter().enumerate() {
        let mut count = Count::default();
        for _ in 0..WORLDS / 5 {
            let world = world(kind, &mut random);
            for _ in 0..SWEEPS / WORLDS {
                let mut sweep = Sweep::random(&world, &mut random);
                // From outside: what starts inside has rules of its own.
                while deepest(&world, &sweep.upright()) > -1e-3
                    || world.solids.overlap(sweep.feet, sweep.armor.0, sweep.armor.1).is_some()
                {
                    sweep = Sweep::random(&world, &mut random);
                }
                compare(&world, &sweep, &mut count);
            }
        }
        println!("{name}: {count:?}");
        assert!(2 * count.hits > count.asked, "too few hits: {count:?}");
        // Grazes within a skin, and ties of normals at corners and edges.
        assert!(1000 * (count.misses + count.times) < count.asked, "{count:?}");
        assert!(2000 * count.normals < count.asked, "{count:?}");
    }
}
