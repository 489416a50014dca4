//! A step of the whole batch: checks, pieces for the threads, and what the pieces report.

use super::block::{Observe, Step};
use super::*;
use crate::observe::{Columns, Observation, Seen};
use crate::terrain::Surface;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// The episodes of a piece that ended, in order, with their last observations.
#[derive(Debug)]
pub(super) struct Report {
    pub(super) outcomes: Vec<(usize, Outcome)>,
    pub(super) observations: Vec<f32>,
    pub(super) watch: Option<Watch>,
}

impl Report {
    /// Of nothing yet; with a watch where the parts of a step are to be timed.
    pub(super) fn new(timed: bool) -> Self {
        let watch = timed.then(Watch::start);
        Self { outcomes: Vec::new(), observations: Vec::new(), watch }
    }

    /// Time between two steps is charged to nobody.
    fn restart(&mut self) {
        if let Some(watch) = self.watch.as_mut() {
            watch.restart();
        }
    }

    /// Charges the time since the last charge to a part.
    #[inline(always)]
    pub(super) fn charge(&mut self, part: usize) {
        if let Some(watch) = self.watch.as_mut() {
            watch.charge(part);
        }
    }
}

impl Rewards<'_> {
    /// Overwrites those from `at` on.
    #[inline(always)]
    pub(super) fn write(&mut self, at: usize, rewards: &[f64]) {
        match self {
            Self::F64(all) => all[at..at + rewards.len()].copy_from_slice(rewards),
            Self::F32(all) => {
                for (out, &reward) in all[at..at + rewards.len()].iter_mut().zip(rewards) {
                    *out = reward as f32;
                }
            }
        }
    }
}

impl<'a> StepOutput<'a> {
    /// Takes off the rows of the first `players`, of `row` numbers each.
    fn split_off(&mut self, players: usize, row: usize) -> Self {
        fn front<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
            slice.split_off_mut(..count).expect("the lengths were checked")
        }
        Self {
            observations: front(&mut self.observations, players * row),
            rewards: match &mut self.rewards {
                Rewards::F64(all) => Rewards::F64(front(all, players)),
                Rewards::F32(all) => Rewards::F32(front(all, players)),
            },
            terminated: front(&mut self.terminated, players),
            truncated: front(&mut self.truncated, players),
            status: self.status.as_mut().map(|all| StatusOutput {
                distance: front(&mut all.distance, players),
                speed: front(&mut all.speed, players),
                time: front(&mut all.time, players),
                outside: front(&mut all.outside, players),
            }),
        }
    }

    /// Flags of the environments from `at` on.
    #[inline(always)]
    pub(super) fn write_flags(&mut self, at: usize, phases: &[Phase]) {
        for (lane, &phase) in phases.iter().enumerate() {
            self.terminated[at + lane] = phase == Phase::Terminated;
            self.truncated[at + lane] = phase == Phase::Truncated;
        }
    }

    /// Every length but that of the observations.
    fn lengths(&self) -> impl Iterator<Item = usize> {
        let rewards = match &self.rewards {
            Rewards::F64(all) => all.len(),
            Rewards::F32(all) => all.len(),
        };
        let status =
            self.status.iter().flat_map(|s| [s.distance.len(), s.speed.len(), s.time.len(), s.outside.len()]);
        [rewards, self.terminated.len(), self.truncated.len()].into_iter().chain(status)
    }
}

/// A piece of the batch and of the outputs.
pub(super) struct Piece<'a, S: Scene, K: Kind, R: Real> {
    pub(super) bodies: &'a mut [Body<S, R>],
    pub(super) blocks: &'a mut [Block<K, R>],
    pub(super) output: StepOutput<'a>,
    pub(super) report: &'a mut Report,
    /// Index of its first environment.
    pub(super) first: usize,
}

impl<S: Scene, K: Kind, M: Movement, R: Real> Batch<S, K, M, R> {
    pub(super) fn check_reset(&self, request: &ResetRequest, numbers: usize) -> Result<(), InputError> {
        self.check_whole()?;
        let n = self.setup.count;
        let lengths = [
            ("seeds", request.seeds.len()),
            ("mask", request.mask.len()),
            ("options", request.courses.len()),
        ];
        for (name, len) in lengths {
            if len != 0 && len != n {
                refuse!("{name}: expected {n}, one per environment, got {len}");
            }
        }
        if numbers != n * self.row {
            refuse!("observations: expected {n} rows of {}, got {numbers} numbers", self.row);
        }
        Ok(())
    }

    pub(super) fn check_whole(&self) -> Result<(), InputError> {
        if self.broken {
            refuse!("an earlier step of this batch ended half-way: restore a snapshot, or make a new batch");
        }
        Ok(())
    }

    pub(super) fn check_step(
        &self,
        actions: &Actions<'_>,
        output: &StepOutput<'_>,
    ) -> Result<(), InputError> {
        self.check_whole()?;
        let n = self.setup.count;
        actions.check(self.setup.actions, S::Arms::<R>::MODELED, n)?;
        if output.observations.len() != n * self.row || output.lengths().any(|len| len != n) {
            refuse!("output: expected {n} rows of {} and {n} of the rest", self.row);
        }
        if !self.ready {
            refuse!("step: expected every environment to have been reset before its first step");
        }
        Ok(())
    }

    /// The observations of a block's first players.
    #[inline(always)]
    pub(super) fn observe_block(
        &self,
        (body, block): (&Body<S, R>, &Block<K, R>),
        surface: &Surface<'_, R::Scalar>,
        rows: &mut [f32],
        players: usize,
        columns: &mut Columns<R>,
    ) {
        if const { S::Arms::<R>::MODELED } {
            for (lane, row) in rows.chunks_exact_mut(self.row).enumerate() {
                self.observe_one(body, block, lane, row);
            }
            return;
        }
        let Block { run, lowest, .. } = block;
        let (player, arms) = (&body.player, body.arms.as_ref());
        let (rules, arsenal, lowest) = (&self.rules, &self.arsenal, *lowest);
        let seen = Seen { player, arms, run, surface, rules, arsenal, lowest };
        self.setup.observation.write(&seen, rows, players, columns);
    }

    /// The observation of one player.
    pub(super) fn observe_one(&self, body: &Body<S, R>, block: &Block<K, R>, lane: usize, row: &mut [f32]) {
        let Begun { body, run, .. } = block.one(body, lane);
        let surface = &self.setup.maps.surface();
        let (rules, arsenal, lowest) = (&self.rules, &self.arsenal, block.lowest.lane(lane));
        let (player, arms) = (&body.player, body.arms.as_ref());
        let seen = Seen { player, arms, run: &run, surface, rules, arsenal, lowest };
        observe_single(&self.setup.observation, &seen, row);
    }

    /// The same, of the player of a lane of a block.
    pub(super) fn observe_lane(&self, block: usize, lane: usize, row: &mut [f32]) {
        self.observe_one(&self.bodies[block], &self.blocks[block], lane, row);
    }

    /// Returns whether it came to the end; see [`Crew::share`].
    pub(super) fn observe_all(
        &self,
        crew: Crew,
        observations: &mut [f32],
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let (blocks, rows) = (Self::PIECE / R::LANES, Self::PIECE * self.row);
        let surface = self.setup.maps.surface();
        let pieces = self.bodies.chunks(blocks).zip(self.blocks.chunks(blocks));
        let pieces = pieces.zip(observations.chunks_mut(rows));
        let work = |((bodies, blocks), rows)| {
            let _floats = DefaultFloats::enter();
            R::enter(Observe { batch: self, surface, bodies, blocks, rows });
        };
        crew.share(pieces, work, go_on)
    }

    pub(super) fn step_all(
        &mut self,
        actions: Actions<'_>,
        mut output: StepOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), InputError> {
        let fail = core::mem::take(&mut self.fail);
        let crew = self.crew()?;
        let (count, row) = (self.setup.count, self.row);
        // They leave the batch for the step, so that the rest of it can be read from every thread.
        let mut bodies = core::mem::take(&mut self.bodies);
        let mut blocks = core::mem::take(&mut self.blocks);
        let mut reports = core::mem::take(&mut self.reports);
        reports.resize_with(count.div_ceil(Self::PIECE), || Report::new(false));
        let this = &*self;
        let stage = this.stage();
        let (players, books) =
            (bodies.chunks_mut(Self::PIECE / R::LANES), blocks.chunks_mut(Self::PIECE / R::LANES));
        let pieces = players.zip(books).zip(&mut reports).enumerate();
        let pieces = pieces.map(move |(k, ((bodies, blocks), report))| {
            let first = k * Self::PIECE;
            let output = output.split_off(Self::PIECE.min(count - first), row);
            Piece { bodies, blocks, output, report, first }
        });
        let stepped = catch_unwind(AssertUnwindSafe(|| {
            let work = |piece: Piece<'_, S, K, R>| {
                let _floats = DefaultFloats::enter();
                piece.report.restart();
                R::enter(Step { batch: this, stage, piece, actions });
                assert!(!fail, "this step was made to fail");
            };
            crew.share(pieces, work, go_on)
        }));
        self.bodies = bodies;
        self.blocks = blocks;
        self.finished.clear();
        self.final_observations.clear();
        for report in &mut reports {
            self.finished.append(&mut report.outcomes);
            self.final_observations.append(&mut report.observations);
        }
        self.reports = reports;
        self.broken = !matches!(stepped, Ok(true));
        if let Err(panic) = stepped {
            resume_unwind(panic);
        }
        self.check_whole()
    }
}

/// The row of one player. Compiled once, whatever the lanes.
#[inline(never)]
fn observe_single<S: Scene, K: Kind, T: Scalar>(
    observation: &Observation,
    seen: &Seen<'_, S, K, T>,
    row: &mut [f32],
) {
    observation.write(seen, row, 1, &mut Columns::<T>::default());
}
