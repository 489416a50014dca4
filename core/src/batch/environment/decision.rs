//! The ticks of one decision, and what they are worth.

use super::block::Block;
use super::episode::Phase;
use super::*;
use crate::terrain::Surface;

/// How a decision went: who played it at all, for how many ticks, and how it ended.
pub(super) struct Decision<R: Real> {
    pub(super) played: R::Mask,
    ticks: R::Int,
    pub(super) arrived: R::Mask,
    pub(super) died: R::Mask,
    pub(super) timed_out: R::Mask,
}

impl<R: Real> Decision<R> {
    /// Whose episode it ended.
    #[inline(always)]
    pub(super) fn over(&self) -> R::Mask {
        self.arrived.or(self.died).or(self.timed_out)
    }
}

impl<S: Scene, M: Movement, R: Real> Batch<S, M, R> {
    /// Plays the ticks. A player whose episode ends freezes for the rest of them.
    #[inline(always)]
    pub(super) fn decide(
        &self,
        block: &mut Block<S, R>,
        input: &Input<R>,
        surface: &Surface<'_, R::Scalar>,
    ) -> Decision<R> {
        let none = R::Mask::splat(false);
        let played = block.episodes.are(Phase::Running);
        let mut active = played;
        let mut decision =
            Decision::<R> { played, ticks: R::Int::splat(0), arrived: none, died: none, timed_out: none };
        for _ in 0..self.setup.task.frame_skip {
            if !active.any() {
                break;
            }
            let before = block.player;
            let mut after = crate::tick::tick::<S, M, R, _>(&before, input, surface, &self.rules);
            let mut run = block.run;
            let verdict = run.judge(&before, &after, &self.setup.task, self.rules.max_damage, surface);
            (after.position.x, after.position.y, after.tile_x, after.tile_y) =
                surface.wrap::<R>(after.position.x, after.position.y, after.tile_x, after.tile_y);
            block.player = Player::select(active, &after, &before);
            block.run = Run::select(active, &run, &block.run);
            let more = decision.ticks + R::Int::splat(1);
            decision.ticks = R::Int::select(active, more, decision.ticks);
            decision.arrived = decision.arrived.or(active.and(verdict.arrived));
            decision.died = decision.died.or(active.and(verdict.died));
            decision.timed_out = decision.timed_out.or(active.and(verdict.timed_out));
            active = active.and(decision.over().not());
        }
        decision
    }

    /// Rewards of those who played, 0 for the others; their books and phases.
    #[inline(always)]
    pub(super) fn settle(
        &self,
        block: &mut Block<S, R>,
        decision: &Decision<R>,
        surface: &Surface<'_, R::Scalar>,
    ) -> R::Each<f64> {
        let weights = &self.setup.task.reward;
        let tick_ms = f64::from(self.rules.tick_ms);
        let (zero, one) = (R::Int::splat(0), R::Int::splat(1));
        // As arrays, so that the compiler can work on several lanes' f64 at a time.
        let distances = block.run.distance(&block.player, surface).unpack();
        let ticks = R::unpack_int(decision.ticks);
        let arrived = R::unpack_int(R::Int::select(decision.arrived, one, zero));
        let played = R::unpack_int(R::Int::select(decision.played, one, zero));
        let mut rewards = R::every(0.0);
        let books = &mut block.episodes;
        for lane in 0..R::LANES {
            let distance = distances.as_ref()[lane].to_f64();
            let before = books.distance.as_ref()[lane];
            let seconds = f64::from(ticks.as_ref()[lane]) * tick_ms / 1000.0;
            let bonus = if arrived.as_ref()[lane] != 0 { weights.arrival } else { 0.0 };
            let reward = weights.progress * (before - distance) + weights.time * seconds + bonus;
            let playing = played.as_ref()[lane] != 0;
            rewards.as_mut()[lane] = if playing { reward } else { 0.0 };
            books.distance.as_mut()[lane] = if playing { distance } else { before };
            let total = books.total_reward.as_ref()[lane];
            books.total_reward.as_mut()[lane] = if playing { total + reward } else { total };
            books.length.as_mut()[lane] += i64::from(playing);
        }
        if decision.over().any() {
            for lane in 0..R::LANES {
                if decision.timed_out.lane(lane) {
                    books.phase.as_mut()[lane] = Phase::Truncated;
                } else if decision.arrived.lane(lane) || decision.died.lane(lane) {
                    books.phase.as_mut()[lane] = Phase::Terminated;
                }
            }
        }
        rewards
    }
}
