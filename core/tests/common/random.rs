//! Random numbers for tests: counted draws from a seed.

use discjump_core::random::{Purpose, uniform};

pub struct Random {
    seed: u64,
    count: u32,
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Self { seed, count: 0 }
    }

    /// Uniform in [low, high).
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        self.count += 1;
        uniform(self.seed, 0, Purpose::Start, self.count, low, high)
    }

    /// Uniform in [-1, 1).
    pub fn wide(&mut self) -> f64 {
        self.within(-1.0, 1.0)
    }

    /// Uniform among 0 .. below.
    pub fn index(&mut self, below: usize) -> usize {
        (self.within(0.0, below as f64) as usize).min(below - 1)
    }
}
