//! The terrains the witness is asked about.

use discjump_core::random::{Purpose, uniform};
use discjump_core::terrain::{Edge, Heightfield, raindance};
use std::sync::LazyLock;

/// A terrain, and what share of the queries it gets.
pub struct World {
    pub name: &'static str,
    pub field: Heightfield,
    pub share: usize,
}

/// Heights drawn uniformly from 0 to `relief`; repeated at the rim where the map tiles.
fn rough(seed: u64, cols: usize, rows: usize, size: f64, relief: f64, edge: Edge) -> Heightfield {
    let draw = |i: usize, j: usize| {
        let (i, j) = if edge == Edge::Tile { (i % (cols - 1), j % (rows - 1)) } else { (i, j) };
        uniform(seed, 0, Purpose::Start, (j * cols + i) as u32, 0.0, relief)
    };
    let heights = (0..rows * cols).map(|k| draw(k % cols, k / cols)).collect();
    Heightfield::new(heights, rows, cols, size, [0.0, 0.0], edge).unwrap()
}

fn rolling() -> Heightfield {
    let n = 65;
    let wave = |i: usize, k: f64| (core::f64::consts::TAU * k * (i % (n - 1)) as f64 / (n - 1) as f64).sin();
    let height = |i: usize, j: usize| {
        30.0 + 10.0 * wave(i, 2.0) * wave(j, 2.0) + 4.0 * wave(i + 3, 5.0) + 3.0 * wave(j, 7.0)
    };
    let heights = (0..n * n).map(|k| height(k % n, k / n)).collect();
    Heightfield::new(heights, n, n, 8.0, [-256.0, -256.0], Edge::Tile).unwrap()
}

fn raindance() -> Heightfield {
    let made = raindance::generate(7, raindance::Options::default()).unwrap();
    Heightfield::new(made.heights, 257, 257, 8.0, [-1024.0, -1024.0], Edge::Tile).unwrap()
}

/// Slopes up to 70 degrees: neighbours differ by at most `8 tan 70 / sqrt 2` metres.
const STEEP: f64 = 15.5;

/// All of them, made once: the generator takes its time.
pub static WORLDS: LazyLock<Vec<World>> = LazyLock::new(worlds);

fn worlds() -> Vec<World> {
    let world = |name, share, field| World { name, field, share };
    vec![
        world("rolling", 6, rolling()),
        world("rough to 70 degrees", 6, rough(1, 65, 65, 8.0, STEEP, Edge::Tile)),
        world("raindance", 6, raindance()),
        world("odd sides, tile", 2, rough(2, 14, 18, 8.0, STEEP, Edge::Tile)),
        world("odd and even side, tile", 1, rough(3, 10, 9, 8.0, STEEP, Edge::Tile)),
        world("2 x 2, tile", 1, rough(4, 2, 2, 8.0, STEEP, Edge::Tile)),
        world("3 x 3, tile", 1, rough(5, 3, 3, 8.0, STEEP, Edge::Tile)),
        world("odd sides, clamp", 2, rough(6, 17, 24, 8.0, STEEP, Edge::Clamp)),
        world("2 x 2, clamp", 1, rough(7, 2, 2, 8.0, STEEP, Edge::Clamp)),
        world("odd sides, void", 2, rough(8, 24, 17, 8.0, STEEP, Edge::Void)),
        world("2 x 2, void", 1, rough(9, 2, 2, 8.0, STEEP, Edge::Void)),
        world("squares of 0.01 m, tile", 1, rough(10, 17, 17, 0.01, 0.019, Edge::Tile)),
        world("squares of 0.01 m, clamp", 1, rough(11, 18, 17, 0.01, 0.019, Edge::Clamp)),
        world("squares of 3 m, tile", 1, rough(12, 17, 20, 3.0, 5.8, Edge::Tile)),
        world("squares of 3 m, void", 1, rough(13, 17, 17, 3.0, 5.8, Edge::Void)),
        world("squares of 1000 m, tile", 1, rough(14, 17, 17, 1000.0, 1900.0, Edge::Tile)),
        world("squares of 1000 m, clamp", 1, rough(15, 16, 17, 1000.0, 1900.0, Edge::Clamp)),
    ]
}
