//! Which environments may be stepped: what a front end asks before every step.

use discjump_core::batch::{Autoreset, LifeStage};
use discjump_core::task::Outcome;

/// Bit of [`Life::flags`]: the environment was reset at least once.
const SEEDED: u8 = 1;
/// Bit of [`Life::flags`]: the last step ended its episode.
const OVER: u8 = 2;

/// The environments' lives, as far as they decide whether a step may be taken.
pub(super) struct Life {
    seeded: Vec<bool>,
    unseeded: usize,
    /// Those whose episode the last step ended, and that were not reset since, ascending.
    over: Vec<usize>,
    waits: bool,
}

impl Life {
    /// `n` environments that were never reset.
    pub(super) fn new(n: usize, autoreset: Autoreset) -> Self {
        let waits = autoreset == Autoreset::Disabled;
        Self { seeded: vec![false; n], unseeded: n, over: Vec::new(), waits }
    }

    /// Whether some environment was never reset.
    pub(super) fn fresh(&self) -> bool {
        self.unseeded > 0
    }

    /// Whether a reset must come before the next step.
    pub(super) fn halted(&self) -> bool {
        self.fresh() || (self.waits && !self.over.is_empty())
    }

    /// A step was taken.
    pub(super) fn stepped(&mut self, finished: &[(usize, Outcome)]) {
        self.over.clear();
        self.over.extend(finished.iter().map(|&(env, _)| env));
    }

    /// The environments in `mask` were reset; all where there is none.
    pub(super) fn reset(&mut self, mask: Option<&[bool]>) {
        let Some(mask) = mask else {
            self.seeded.fill(true);
            self.unseeded = 0;
            return self.over.clear();
        };
        self.over.retain(|&env| !mask[env]);
        if self.unseeded > 0 {
            self.seeded.iter_mut().zip(mask).for_each(|(seeded, &reset)| *seeded |= reset);
            self.count();
        }
    }

    /// A byte of [`SEEDED`] and [`OVER`] per environment.
    pub(super) fn flags(&self) -> Vec<u8> {
        let mut flags: Vec<u8> = self.seeded.iter().map(|&seeded| u8::from(seeded) * SEEDED).collect();
        self.over.iter().for_each(|&env| flags[env] |= OVER);
        flags
    }

    /// An environment is where a snapshot had it.
    pub(super) fn restore(&mut self, env: usize, stage: LifeStage) {
        let seeded = stage != LifeStage::Fresh;
        self.unseeded = self.unseeded + usize::from(self.seeded[env]) - usize::from(seeded);
        self.seeded[env] = seeded;
        match (self.over.binary_search(&env), stage) {
            (Err(at), LifeStage::Over) => self.over.insert(at, env),
            (Ok(at), LifeStage::Fresh | LifeStage::Running) => _ = self.over.remove(at),
            _ => {}
        }
    }

    fn count(&mut self) {
        self.unseeded = self.seeded.iter().filter(|&&seeded| !seeded).count();
    }
}
