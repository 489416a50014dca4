//! Randomness of one attempt at one terrain: every number has a counter of its own.

use crate::random::{self, Purpose};

/// First counter of the modes of the height spectrum, one per mode.
pub(super) const MODES: u32 = 0;
/// First counter of the modes of the field that varies the texture.
pub(super) const TEXTURE: u32 = 1 << 16;
/// First counter of everything about the mission.
pub(super) const MISSION: u32 = 1 << 17;

/// The draws of one attempt.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draws {
    pub seed: u64,
    pub attempt: u32,
}

impl Draws {
    pub fn bits(self, counter: u32) -> u64 {
        random::bits(self.seed, u64::from(self.attempt), Purpose::Generator, counter)
    }

    /// Uniform in [low, high).
    pub fn uniform(self, counter: u32, low: f64, high: f64) -> f64 {
        random::uniform(self.seed, u64::from(self.attempt), Purpose::Generator, counter, low, high)
    }
}
