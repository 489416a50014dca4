//! The ticks of one decision, and what they are worth.

use super::super::alone::{MOST_BLOCKS, catch_up, passes};
use super::block::Block;
use super::episode::Phase;
use super::*;
use crate::task::seconds;
use crate::terrain::Surface;
use crate::tick::{go, look, push};

/// How a decision went: who played it at all, for how many ticks, and how it ended.
#[derive(Clone, Copy)]
pub(super) struct Decision<R: Real> {
    pub(super) played: R::Mask,
    ticks: R::Int,
    pub(super) arrived: R::Mask,
    pub(super) died: R::Mask,
    pub(super) timed_out: R::Mask,
}

impl<R: Real> Decision<R> {
    /// Nobody played.
    #[inline(always)]
    pub(super) fn none() -> Self {
        let none = R::Mask::splat(false);
        Self { played: none, ticks: R::Int::splat(0), arrived: none, died: none, timed_out: none }
    }

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
        blocks: &mut [Block<S, R>],
        inputs: &[Input<R>; MOST_BLOCKS],
        surface: &Surface<'_, R::Scalar>,
        decisions: &mut [Decision<R>; MOST_BLOCKS],
    ) {
        let mut active = [R::Mask::splat(false); MOST_BLOCKS];
        for (k, block) in blocks.iter().enumerate() {
            active[k] = block.episodes.are(Phase::Running);
            decisions[k].played = active[k];
        }
        let mut from = [blocks[0].player.place(); MOST_BLOCKS];
        let mut velocity = [V3::zero(); MOST_BLOCKS];
        let mut passed = [R::Mask::splat(false); MOST_BLOCKS];
        let passes = passes::<M, R>();
        for _ in 0..self.setup.task.frame_skip {
            // Where some are frozen, what they all were.
            let mut frozen = [const { None }; MOST_BLOCKS];
            for (k, block) in blocks.iter_mut().enumerate() {
                if active[k].not().any() {
                    frozen[k] = Some((block.player, block.run));
                }
                let player = &mut block.player;
                from[k] = player.place();
                look(player, &inputs[k], &self.rules);
                velocity[k] = push::<S, M, R>(player, &inputs[k], &self.rules);
                if passes {
                    passed[k] = M::pass(player, surface, &self.rules).or(active[k].not());
                }
            }
            if passes {
                catch_up::<S, M, R>(blocks, &passed, surface, &self.rules);
            }
            for (k, block) in blocks.iter_mut().enumerate() {
                let Block { player, run, .. } = block;
                let (decision, active) = (&mut decisions[k], &mut active[k]);
                if !passes {
                    go::<S, M, R, _>(player, velocity[k], surface, &self.rules);
                }
                let verdict = run.judge(&from[k], player, &self.setup.task, self.rules.max_damage, surface);
                (player.position.x, player.position.y, player.tile_x, player.tile_y) =
                    surface.wrap::<R>(player.position.x, player.position.y, player.tile_x, player.tile_y);
                if let Some((before, running)) = &frozen[k] {
                    *player = Player::select(*active, player, before);
                    *run = Run::select(*active, run, running);
                }
                let more = decision.ticks + R::Int::splat(1);
                decision.ticks = R::Int::select(*active, more, decision.ticks);
                decision.arrived = decision.arrived.or(active.and(verdict.arrived));
                decision.died = decision.died.or(active.and(verdict.died));
                decision.timed_out = decision.timed_out.or(active.and(verdict.timed_out));
                *active = active.and(decision.over().not());
            }
        }
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
            let seconds = seconds(ticks.as_ref()[lane], self.rules.tick_ms);
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
