//! Random terrains, states and keys for the properties.

use discjump_core::random::{Purpose, uniform};
use discjump_core::terrain::{Edge, Heightfield};
use proptest::collection::vec;
use proptest::prelude::*;

/// Squares of the random maps: even, so that the checkerboard of cuts is whole.
const SIDE: usize = 16;

/// Random heights that tile, with slopes up to 75 degrees: neighbours differ by 8 tan 75 / sqrt 2.
pub fn rough(seed: u64) -> Heightfield {
    let draw = |i: usize, j: usize| {
        let at = (j % SIDE) * SIDE + i % SIDE;
        uniform(seed, 0, Purpose::Start, at as u32, 0.0, 21.1)
    };
    let n = SIDE + 1;
    let heights = (0..n * n).map(|k| draw(k % n, k / n)).collect();
    Heightfield::new(heights, n, n, 8.0, [-64.0, -64.0], Edge::Tile).unwrap()
}

/// Forward, strafe, jump, jet and turn, held for ten ticks.
pub type Keys = (i8, i8, bool, bool, i8);

pub fn keys() -> impl Strategy<Value = Vec<Keys>> {
    vec((-1..2i8, -1..2i8, any::<bool>(), any::<bool>(), -20..21i8), 30)
}

/// Place (its height over the ground), velocity and yaw.
pub type Start = ([f64; 3], [f64; 3], f64);

pub fn start() -> impl Strategy<Value = Start> {
    let place = [-64.0..64.0f64, -64.0..64.0, 0.0..20.0];
    let velocity = [-60.0..60.0f64, -60.0..60.0, -60.0..40.0];
    (place, velocity, -3.0..3.0f64)
}
