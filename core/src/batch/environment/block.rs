//! The environments of a block, and one decision of them while it is in the nearest cache: keys, ticks,
//! rewards, ends, the next episodes, observations, status.

use super::super::alone::{MOST_BLOCKS, together};
use super::decision::Decision;
use super::episode::{Begun, Episodes};
use super::step::Piece;
use super::*;
use crate::observe::Columns;
use crate::real::Work;
use crate::task::{ACTION_SIZE, ARMED_SIZE};
use crate::terrain::{Maps, Surface};

/// What is kept of the environments of some lanes beside their players.
#[derive(Clone, Copy)]
pub(super) struct Block<K: Kind, R: Real> {
    pub(super) run: Run<K, R>,
    /// The lowest height of each one's map: what is seen where there is no ground, m.
    pub(super) lowest: R,
    pub(super) episodes: Episodes<R>,
}

/// Players, and what is kept beside them.
pub(super) type Blocks<'a, S, K, R> = (&'a mut [Body<S, R>], &'a mut [Block<K, R>]);

impl<K: Kind, R: Real> Block<K, R> {
    /// Nobody yet.
    pub(super) fn idle() -> Self {
        Self { run: Run::idle(), lowest: R::zero(), episodes: Episodes::none() }
    }

    /// The environment in one lane.
    pub(super) fn one<S: Scene>(&self, body: &Body<S, R>, lane: usize) -> Begun<S, K, R::Scalar> {
        Begun { body: body.lane(lane), run: self.run.lane(lane), episode: self.episodes.lane(lane) }
    }

    /// Puts an episode into a lane.
    pub(super) fn put<S: Scene>(
        &mut self,
        body: &mut Body<S, R>,
        lane: usize,
        begun: &Begun<S, K, R::Scalar>,
        maps: &Maps,
    ) {
        body.set_lane(lane, &begun.body);
        self.run.set_lane(lane, &begun.run);
        self.episodes.set_lane(lane, &begun.episode);
        self.lowest.set_lane(lane, Scalar::from_f64(maps.range(begun.episode.map as usize).0));
    }
}

/// A decision of a piece of the batch, compiled for the instruction set of its lanes.
pub(super) struct Step<'a, S: Scene, K: Kind, M: Movement, R: Real> {
    pub(super) batch: &'a Batch<S, K, M, R>,
    pub(super) stage: Stage<'a, R::Scalar>,
    pub(super) piece: Piece<'a, S, K, R>,
    pub(super) actions: Actions<'a>,
}

impl<S: Scene, K: Kind, M: Movement, R: Real> Work for Step<'_, S, K, M, R> {
    type Output = ();

    /// Phase by phase for some blocks at a time: within a phase there are few branches that could be
    /// guessed wrong, so that the chains of instructions of several blocks overlap.
    #[inline(always)]
    fn run(self) {
        let Self { batch, stage, mut piece, actions } = self;
        let surface = stage.surface;
        let (row, count) = (batch.row, batch.setup.count);
        let mut columns = Columns::default();
        let turn_rate = <R::Scalar as Scalar>::from_f64(batch.setup.task.turn_rate);
        for group in 0..piece.blocks.len().div_ceil(together::<R>()) {
            let start = group * together::<R>();
            let end = piece.blocks.len().min(start + together::<R>());
            let (bodies, blocks) = (&mut piece.bodies[start..end], &mut piece.blocks[start..end]);
            // Where a block's rows begin within the piece, and how many it has: lanes beyond the last
            // environment are padding.
            let at = |k: usize| (start + k) * R::LANES;
            let players = |k: usize| R::LANES.min(count - piece.first - at(k));

            let mut inputs = [Input::<R>::idle(); MOST_BLOCKS];
            for (k, input) in inputs.iter_mut().enumerate().take(blocks.len()) {
                let first = piece.first + at(k);
                *input = if S::Arms::<R>::MODELED {
                    actions.input::<R, ARMED_SIZE>(first, players(k), turn_rate)
                } else {
                    actions.input::<R, ACTION_SIZE>(first, players(k), turn_rate)
                };
            }
            piece.report.charge(0);
            let mut decisions = [Decision::<R>::none(); MOST_BLOCKS];
            batch.decide(&stage, (bodies, blocks), &inputs, &mut decisions);
            piece.report.charge(1);
            for (k, (body, block)) in bodies.iter_mut().zip(blocks.iter_mut()).enumerate() {
                let rewards = batch.settle((body, block), &decisions[k], &surface);
                piece.output.rewards.write(at(k), &rewards.as_ref()[..players(k)]);
                if batch.setup.autoreset == Autoreset::NextStep && decisions[k].played.not().any() {
                    batch.go_on_where_over((body, block), &decisions[k], players(k));
                }
            }
            piece.report.charge(2);
            for (k, (body, block)) in bodies.iter().zip(blocks.iter()).enumerate() {
                let rows = &mut piece.output.observations[at(k) * row..(at(k) + players(k)) * row];
                batch.observe_block((body, block), &surface, rows, players(k), &mut columns);
            }
            piece.report.charge(3);
            for (k, block) in blocks.iter().enumerate() {
                piece.output.write_flags(at(k), &block.episodes.phase.as_ref()[..players(k)]);
            }
            piece.report.charge(4);
            for (k, (body, block)) in bodies.iter_mut().zip(blocks.iter_mut()).enumerate() {
                if decisions[k].over().any() {
                    let rows = &mut piece.output.observations[at(k) * row..(at(k) + players(k)) * row];
                    batch.report_ends((body, block), piece.first + at(k), &decisions[k], rows, piece.report);
                }
            }
            piece.report.charge(2);
            if let Some(status) = &mut piece.output.status {
                for (k, (body, block)) in bodies.iter().zip(blocks.iter()).enumerate() {
                    batch.write_status((body, block), &surface, (at(k), players(k)), status);
                }
            }
            piece.report.charge(4);
        }
    }
}

/// The observations of some blocks, compiled for the instruction set of their lanes.
pub(super) struct Observe<'a, S: Scene, K: Kind, M: Movement, R: Real> {
    pub(super) batch: &'a Batch<S, K, M, R>,
    pub(super) surface: Surface<'a, R::Scalar>,
    pub(super) bodies: &'a [Body<S, R>],
    pub(super) blocks: &'a [Block<K, R>],
    pub(super) rows: &'a mut [f32],
}

impl<S: Scene, K: Kind, M: Movement, R: Real> Work for Observe<'_, S, K, M, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let row = self.batch.row;
        let mut columns = Columns::default();
        let pairs = self.bodies.iter().zip(self.blocks);
        for (pair, rows) in pairs.zip(self.rows.chunks_mut(row * R::LANES)) {
            self.batch.observe_block(pair, &self.surface, rows, rows.len() / row, &mut columns);
        }
    }
}
