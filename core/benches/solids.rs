//! Cost of solids per query: `cargo bench --bench solids`. Each figure is for 4,096 players, one after the other.

use discjump_core::solids::{Solid, Solids};
use discjump_core::terrain::{Edge, Grid};
use divan::counter::ItemsCount;
use glam::DVec3;

const PLAYERS: usize = 4096;
const COUNTS: [usize; 3] = [0, 10, 1000];

fn main() {
    divan::main();
}

/// A fixed sequence without pattern, in [-1, 1).
fn wide(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Boxes of 4 to 16 m scattered over 1 km.
fn scattered(count: usize) -> Solids {
    let grid = Grid { rows: 257, cols: 257, square_size: 8.0, origin: [-1024.0, -1024.0], edge: Edge::Tile };
    let mut seed = 1;
    let mut block = |_| {
        let mut side = || 10.0 + 6.0 * wide(&mut seed);
        let size = DVec3::new(side(), side(), side());
        let centre = DVec3::new(500.0 * wide(&mut seed), 500.0 * wide(&mut seed), 5.0);
        Solid::cuboid("block", size, centre, 3.0 * wide(&mut seed))
    };
    Solids::new(&(0..count).map(&mut block).collect::<Vec<_>>(), &grid).expect("blocks")
}

/// Players about the map, or at the faces of solids, and where they go within a tick at 30 m/s.
fn players(solids: &Solids, close: bool) -> Vec<(DVec3, DVec3)> {
    let faces: Vec<DVec3> = solids.faces().map(|(_, [a, b, c])| (a + b + c) / 3.0).collect();
    let mut seed = 2;
    (0..PLAYERS)
        .map(|k| {
            let mut random = || DVec3::new(wide(&mut seed), wide(&mut seed), wide(&mut seed));
            let feet = if close && !faces.is_empty() {
                faces[k * 7919 % faces.len()] + 1.5 * random()
            } else {
                random() * DVec3::new(1000.0, 1000.0, 10.0) + DVec3::new(0.0, 0.0, 60.0)
            };
            (feet, random().normalize() * 0.96)
        })
        .collect()
}

fn near(bencher: divan::Bencher, count: usize, close: bool) {
    let solids = scattered(count);
    let players = players(&solids, close);
    bencher.counter(ItemsCount::new(PLAYERS)).bench_local(|| {
        players.iter().filter(|(p, _)| divan::black_box(&solids).near(p.x, p.y, p.z, 3.6)).count()
    });
}

#[divan::bench(args = COUNTS)]
fn near_of_far_players(bencher: divan::Bencher, count: usize) {
    near(bencher, count, false);
}

#[divan::bench(args = COUNTS)]
fn near_of_close_players(bencher: divan::Bencher, count: usize) {
    near(bencher, count, true);
}

/// Only the paths that meet something, or only those that do not.
fn sweep(bencher: divan::Bencher, count: usize, hits: bool) {
    let solids = scattered(count);
    let meets = |(feet, path): &(DVec3, DVec3)| solids.sweep_box(*feet, *path, 0.5, 2.3).is_some();
    let players: Vec<_> = players(&solids, true).into_iter().filter(|p| meets(p) == hits).collect();
    bencher
        .counter(ItemsCount::new(players.len()))
        .bench_local(|| players.iter().filter(|p| meets(p)).count());
}

#[divan::bench(args = [10, 1000])]
fn sweep_that_hits(bencher: divan::Bencher, count: usize) {
    sweep(bencher, count, true);
}

#[divan::bench(args = [10, 1000])]
fn sweep_that_misses_from_close(bencher: divan::Bencher, count: usize) {
    sweep(bencher, count, false);
}

#[divan::bench(args = [10, 1000])]
fn ray_of_100_m(bencher: divan::Bencher, count: usize) {
    let solids = scattered(count);
    let players = players(&solids, true);
    bencher.counter(ItemsCount::new(PLAYERS)).bench_local(|| {
        players.iter().filter(|(feet, path)| solids.ray(*feet, *path * 104.0).is_some()).count()
    });
}
