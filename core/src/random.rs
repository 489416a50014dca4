//! Randomness that is counted, not streamed.
//!
//! Every draw is a function of (seed, episode, purpose, counter). Nothing is consumed, so no draw
//! depends on how many were made before it, on a batch index, or on a thread.

use xxhash_rust::xxh3::xxh3_64;

/// What a draw is for. Two purposes never share a value, whatever their counters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// Which map of the pool an episode plays on.
    Terrain = 1,
    /// Where an episode starts.
    Start = 2,
    /// Where the beacon stands.
    Goal = 3,
    /// Which way the player looks at the start, and his velocity.
    Velocity = 4,
    /// The generator of Raindance-like terrain.
    Generator = 5,
    /// How high an episode starts, and how high its marker floats.
    Height = 6,
    /// Whose flag is one's own.
    Team = 7,
}

/// 64 uniform bits for one (seed, episode, purpose, counter): XXH3-64 of the four numbers,
/// little-endian, in this order.
#[must_use]
pub fn bits(seed: u64, episode: u64, purpose: Purpose, counter: u32) -> u64 {
    let mut key = [0u8; 24];
    key[0..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&episode.to_le_bytes());
    key[16..20].copy_from_slice(&(purpose as u32).to_le_bytes());
    key[20..24].copy_from_slice(&counter.to_le_bytes());
    xxh3_64(&key)
}

/// A uniform number in [0, 1) with 53 random bits.
#[must_use]
pub fn unit(seed: u64, episode: u64, purpose: Purpose, counter: u32) -> f64 {
    (bits(seed, episode, purpose, counter) >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

/// A uniform number in [low, high).
#[must_use]
pub fn uniform(seed: u64, episode: u64, purpose: Purpose, counter: u32, low: f64, high: f64) -> f64 {
    low + (high - low) * unit(seed, episode, purpose, counter)
}

/// A uniform index below `n`. The bias is below n / 2^64.
///
/// # Panics
/// If `n` is zero.
#[must_use]
pub fn index(seed: u64, episode: u64, purpose: Purpose, counter: u32, n: usize) -> usize {
    assert!(n > 0, "index below zero was asked for");
    let wide = u128::from(bits(seed, episode, purpose, counter)) * n as u128;
    (wide >> 64) as usize
}
