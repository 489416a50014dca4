//! The environments of a block, and one decision of them while it is in the nearest cache: keys, ticks,
//! rewards, ends, the next episodes, observations, status.

use super::episode::{Begun, Episodes, Phase};
use super::step::Piece;
use super::*;
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

    #[inline(always)]
    fn run(self) {
        let Self { batch, surface, mut piece, actions } = self;
        let row = batch.row;
        let turn_rate = <R::Scalar as Scalar>::from_f64(batch.setup.task.turn_rate);
        for (k, block) in piece.blocks.iter_mut().enumerate() {
            let at = k * R::LANES;
            let first = piece.first + at;
            // Lanes beyond the last environment are padding.
            let players = R::LANES.min(batch.setup.count - first);
            let input = actions.input::<R>(first, players, turn_rate);
            piece.report.charge(0);
            let decision = batch.decide(block, &input, &surface);
            piece.report.charge(1);
            let rewards = batch.settle(block, &decision, &surface);
            if batch.setup.autoreset == Autoreset::NextStep && decision.played.not().any() {
                batch.go_on_where_over(block, &decision, players);
            }
            piece.report.charge(2);
            let rows = &mut piece.output.observations[at * row..(at + players) * row];
            batch.observe_block(block, &surface, rows, players);
            piece.report.charge(3);
            piece.output.rewards.write(at, &rewards.as_ref()[..players]);
            for (lane, &phase) in block.episodes.phase.as_ref()[..players].iter().enumerate() {
                piece.output.terminated[at + lane] = phase == Phase::Terminated;
                piece.output.truncated[at + lane] = phase == Phase::Truncated;
            }
            piece.report.charge(4);
            if decision.over().any() {
                batch.report_ends(block, first, &decision, rows, piece.report);
            }
            piece.report.charge(2);
            if let Some(status) = &mut piece.output.status {
                batch.write_status(block, &surface, (at, players), status);
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
        for (block, rows) in self.blocks.iter().zip(self.rows.chunks_mut(row * R::LANES)) {
            self.batch.observe_block(block, &self.surface, rows, rows.len() / row);
        }
    }
}
