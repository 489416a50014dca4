//! The environments of a block, and one decision of them while it is in the nearest cache: keys, ticks,
//! rewards, ends, the next episodes, observations, status.

use super::super::alone::{MOST_BLOCKS, together};
use super::decision::Decision;
use super::episode::{Begun, Episodes};
use super::step::Piece;
use super::*;
use crate::observe::Columns;
use crate::real::Work;
use crate::terrain::{Maps, Surface};

/// The environments of some lanes, side by side.
#[derive(Clone, Copy)]
pub(super) struct Block<S: Scene, R: Real> {
    pub(super) player: Player<S, R>,
    pub(super) run: Run<R>,
    /// The lowest height of each one's map: what is seen where there is no ground, m.
    pub(super) lowest: R,
    pub(super) episodes: Episodes<R>,
}

impl<S: Scene, R: Real> AsRef<Player<S, R>> for Block<S, R> {
    #[inline(always)]
    fn as_ref(&self) -> &Player<S, R> {
        &self.player
    }
}

impl<S: Scene, R: Real> AsMut<Player<S, R>> for Block<S, R> {
    #[inline(always)]
    fn as_mut(&mut self) -> &mut Player<S, R> {
        &mut self.player
    }
}

impl<S: Scene, R: Real> Block<S, R> {
    /// Nobody yet.
    pub(super) fn idle(rules: &Rules<R::Scalar>) -> Self {
        Self {
            player: Player::new(rules, V3::zero(), R::Int::splat(0)),
            run: Run::idle(),
            lowest: R::zero(),
            episodes: Episodes::none(),
        }
    }

    /// Puts an episode into a lane.
    pub(super) fn put(&mut self, lane: usize, begun: &Begun<S, R::Scalar>, maps: &Maps) {
        self.player.set_lane(lane, &begun.player);
        self.run.set_lane(lane, &begun.run);
        self.episodes.set_lane(lane, &begun.episode);
        self.lowest.set_lane(lane, Scalar::from_f64(maps.range(begun.episode.map as usize).0));
    }
}

/// A decision of a piece of the batch, compiled for the instruction set of its lanes.
pub(super) struct Step<'a, S: Scene, M: Movement, R: Real> {
    pub(super) batch: &'a Batch<S, M, R>,
    pub(super) surface: Surface<'a, R::Scalar>,
    pub(super) piece: Piece<'a, S, R>,
    pub(super) actions: Actions<'a>,
}

impl<S: Scene, M: Movement, R: Real> Work for Step<'_, S, M, R> {
    type Output = ();

    /// Phase by phase for some blocks at a time: within a phase there are few branches that could be
    /// guessed wrong, so that the chains of instructions of several blocks overlap.
    #[inline(always)]
    fn run(self) {
        let Self { batch, surface, mut piece, actions } = self;
        let (row, count) = (batch.row, batch.setup.count);
        let mut columns = Columns::default();
        let turn_rate = <R::Scalar as Scalar>::from_f64(batch.setup.task.turn_rate);
        for group in 0..piece.blocks.len().div_ceil(together::<R>()) {
            let start = group * together::<R>();
            let end = piece.blocks.len().min(start + together::<R>());
            let blocks = &mut piece.blocks[start..end];
            // Where a block's rows begin within the piece, and how many it has: lanes beyond the last
            // environment are padding.
            let at = |k: usize| (start + k) * R::LANES;
            let players = |k: usize| R::LANES.min(count - piece.first - at(k));

            let mut inputs = [Input::<R>::idle(); MOST_BLOCKS];
            for (k, input) in inputs.iter_mut().enumerate().take(blocks.len()) {
                *input = actions.input::<R>(piece.first + at(k), players(k), turn_rate);
            }
            piece.report.charge(0);
            let mut decisions = [Decision::<R>::none(); MOST_BLOCKS];
            batch.decide(blocks, &inputs, &surface, &mut decisions);
            piece.report.charge(1);
            for (k, block) in blocks.iter_mut().enumerate() {
                let rewards = batch.settle(block, &decisions[k], &surface);
                piece.output.rewards.write(at(k), &rewards.as_ref()[..players(k)]);
                if batch.setup.autoreset == Autoreset::NextStep && decisions[k].played.not().any() {
                    batch.go_on_where_over(block, &decisions[k], players(k));
                }
            }
            piece.report.charge(2);
            for (k, block) in blocks.iter().enumerate() {
                let rows = &mut piece.output.observations[at(k) * row..(at(k) + players(k)) * row];
                batch.observe_block(block, &surface, rows, players(k), &mut columns);
            }
            piece.report.charge(3);
            for (k, block) in blocks.iter().enumerate() {
                piece.output.write_flags(at(k), &block.episodes.phase.as_ref()[..players(k)]);
            }
            piece.report.charge(4);
            for (k, block) in blocks.iter_mut().enumerate() {
                if decisions[k].over().any() {
                    let rows = &mut piece.output.observations[at(k) * row..(at(k) + players(k)) * row];
                    batch.report_ends(block, piece.first + at(k), &decisions[k], rows, piece.report);
                }
            }
            piece.report.charge(2);
            if let Some(status) = &mut piece.output.status {
                for (k, block) in blocks.iter().enumerate() {
                    batch.write_status(block, &surface, (at(k), players(k)), status);
                }
            }
            piece.report.charge(4);
        }
    }
}

/// The observations of some blocks, compiled for the instruction set of their lanes.
pub(super) struct Observe<'a, S: Scene, M: Movement, R: Real> {
    pub(super) batch: &'a Batch<S, M, R>,
    pub(super) surface: Surface<'a, R::Scalar>,
    pub(super) blocks: &'a [Block<S, R>],
    pub(super) rows: &'a mut [f32],
}

impl<S: Scene, M: Movement, R: Real> Work for Observe<'_, S, M, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let row = self.batch.row;
        let mut columns = Columns::default();
        for (block, rows) in self.blocks.iter().zip(self.rows.chunks_mut(row * R::LANES)) {
            self.batch.observe_block(block, &self.surface, rows, rows.len() / row, &mut columns);
        }
    }
}
