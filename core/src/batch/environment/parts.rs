//! Where the time of a step goes.

use std::time::{Duration, Instant};

/// The parts of a step, in their order.
pub(super) const PARTS: [&str; 5] = ["input", "physics", "task", "observation", "output"];

/// A watch that charges the time since it was last looked at to a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    last: Instant,
    spent: [Duration; PARTS.len()],
}

impl Watch {
    pub(super) fn start() -> Self {
        Self { last: Instant::now(), spent: [Duration::ZERO; PARTS.len()] }
    }

    pub(super) fn restart(&mut self) {
        self.last = Instant::now();
    }

    pub(super) fn charge(&mut self, part: usize) {
        let now = Instant::now();
        self.spent[part] += now - self.last;
        self.last = now;
    }

    pub(super) fn spent(&self) -> [Duration; PARTS.len()] {
        self.spent
    }
}
