//! The ticks of one decision, and what they are worth.

use super::super::alone::{MOST_BLOCKS, catch_up, passes};
use super::block::{Block, Blocks};
use super::episode::Phase;
use super::*;
use crate::task::{Verdict, seconds};
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

    /// Counts a tick of those who are active, and how it ended.
    #[inline(always)]
    fn count(&mut self, active: &mut R::Mask, verdict: &Verdict<R::Mask>) {
        self.ticks = R::Int::select(*active, self.ticks + R::Int::splat(1), self.ticks);
        self.arrived = self.arrived.or(active.and(verdict.arrived));
        self.died = self.died.or(active.and(verdict.died));
        self.timed_out = self.timed_out.or(active.and(verdict.timed_out));
        *active = active.and(self.over().not());
    }
}

/// Someone who does not play, as he was.
struct Frozen<S: Scene, K: Kind, T: Scalar> {
    k: usize,
    lane: usize,
    body: Body<S, T>,
    run: Run<K, T>,
}

impl<S: Scene, K: Kind, M: Movement, R: Real> Batch<S, K, M, R> {
    /// Plays the ticks. A player whose episode ends freezes for the rest of them.
    #[inline(always)]
    pub(super) fn decide(
        &self,
        stage: &Stage<'_, R::Scalar>,
        (bodies, blocks): Blocks<'_, S, K, R>,
        inputs: &[Input<R>; MOST_BLOCKS],
        decisions: &mut [Decision<R>; MOST_BLOCKS],
    ) {
        let mut active = [R::Mask::splat(false); MOST_BLOCKS];
        for (k, block) in blocks.iter().enumerate() {
            active[k] = block.episodes.are(Phase::Running);
            decisions[k].played = active[k];
        }
        if const { S::Arms::<R>::MODELED || S::SOLIDS } {
            self.decide_armed(stage, (bodies, blocks), inputs, (decisions, &mut active));
        } else {
            self.decide_alone(stage, (bodies, blocks), inputs, (decisions, &mut active));
        }
    }

    /// The ticks of players on bare ground without projectiles: physics and task in one.
    #[inline(always)]
    fn decide_alone(
        &self,
        stage: &Stage<'_, R::Scalar>,
        (bodies, blocks): Blocks<'_, S, K, R>,
        inputs: &[Input<R>; MOST_BLOCKS],
        (decisions, active): (&mut [Decision<R>; MOST_BLOCKS], &mut [R::Mask; MOST_BLOCKS]),
    ) {
        let surface = &stage.surface;
        let mut from = [bodies[0].player.place(); MOST_BLOCKS];
        let mut velocity = [V3::zero(); MOST_BLOCKS];
        let mut passed = [R::Mask::splat(false); MOST_BLOCKS];
        let passes = passes::<M, R>();
        for _ in 0..self.setup.task.frame_skip {
            // Where some are frozen, what they all were.
            let mut frozen = [const { None }; MOST_BLOCKS];
            for (k, (body, block)) in bodies.iter_mut().zip(blocks.iter()).enumerate() {
                if active[k].not().any() {
                    frozen[k] = Some((body.player, block.run));
                }
                let player = &mut body.player;
                from[k] = player.place();
                look(player, &inputs[k], &self.rules);
                velocity[k] = push::<S, M, R>(player, &inputs[k], &self.rules);
                if passes {
                    passed[k] = M::pass(player, surface, &self.rules).or(active[k].not());
                }
            }
            if passes {
                catch_up::<S, M, R>(bodies, &passed, surface, &self.rules);
            }
            for (k, (body, block)) in bodies.iter_mut().zip(blocks.iter_mut()).enumerate() {
                let (player, run) = (&mut body.player, &mut block.run);
                let (decision, active) = (&mut decisions[k], &mut active[k]);
                if !passes {
                    go::<S, M, R, _>(player, velocity[k], surface, &self.rules);
                }
                let verdict = run.judge(&from[k], player, &self.setup.task, &self.rules, surface);
                (player.position.x, player.position.y, player.tile_x, player.tile_y) =
                    surface.wrap::<R>(player.position.x, player.position.y, player.tile_x, player.tile_y);
                if let Some((before, running)) = &frozen[k] {
                    *player = Player::select(*active, player, before);
                    *run = Run::select(*active, run, running);
                }
                decision.count(active, &verdict);
            }
        }
    }

    /// The ticks of players with projectiles or among solids: what plays bodies without a task plays them.
    fn decide_armed(
        &self,
        stage: &Stage<'_, R::Scalar>,
        (bodies, blocks): Blocks<'_, S, K, R>,
        inputs: &[Input<R>; MOST_BLOCKS],
        (decisions, active): (&mut [Decision<R>; MOST_BLOCKS], &mut [R::Mask; MOST_BLOCKS]),
    ) {
        let mut from = [bodies[0].player.place(); MOST_BLOCKS];
        let mut frozen: Vec<Frozen<S, K, R::Scalar>> = Vec::new();
        for _ in 0..self.setup.task.frame_skip {
            frozen.clear();
            for (k, (body, block)) in bodies.iter().zip(blocks.iter()).enumerate() {
                from[k] = body.player.place();
                let mut still = active[k].not().bits();
                while still != 0 {
                    let lane = still.trailing_zeros() as usize;
                    still &= still - 1;
                    frozen.push(Frozen { k, lane, body: body.lane(lane), run: block.run.lane(lane) });
                }
            }
            if frozen.len() == bodies.len() * R::LANES {
                break;
            }
            (self.play)(stage, bodies, inputs, 1);
            for (k, (body, block)) in bodies.iter().zip(blocks.iter_mut()).enumerate() {
                let (player, task) = (&body.player, &self.setup.task);
                let verdict = block.run.judge(&from[k], player, task, &self.rules, &stage.surface);
                decisions[k].count(&mut active[k], &verdict);
            }
            for Frozen { k, lane, body, run } in &frozen {
                bodies[*k].set_lane(*lane, body);
                blocks[*k].run.set_lane(*lane, run);
            }
        }
    }

    /// Rewards of those who played, 0 for the others; their books and phases.
    #[inline(always)]
    pub(super) fn settle(
        &self,
        (body, block): (&Body<S, R>, &mut Block<K, R>),
        decision: &Decision<R>,
        surface: &Surface<'_, R::Scalar>,
    ) -> R::Each<f64> {
        let weights = &self.setup.task.reward;
        let (zero, one) = (R::Int::splat(0), R::Int::splat(1));
        // As arrays, so that the compiler can work on several lanes' f64 at a time.
        let left = block.run.left(&body.player, &self.setup.task, surface).unpack();
        let ticks = R::unpack_int(decision.ticks);
        let arrived = R::unpack_int(R::Int::select(decision.arrived, one, zero));
        let died = R::unpack_int(R::Int::select(decision.died, one, zero));
        let played = R::unpack_int(R::Int::select(decision.played, one, zero));
        let mut rewards = R::every(0.0);
        let books = &mut block.episodes;
        for lane in 0..R::LANES {
            let left = left.as_ref()[lane].to_f64();
            let before = books.left.as_ref()[lane];
            let seconds = seconds(ticks.as_ref()[lane], self.rules.tick_ms);
            let bonus = match (arrived.as_ref()[lane], died.as_ref()[lane]) {
                (0, 0) => 0.0,
                (0, _) => weights.death,
                _ => weights.arrival,
            };
            let reward = weights.progress * (before - left) + weights.time * seconds + bonus;
            let playing = played.as_ref()[lane] != 0;
            rewards.as_mut()[lane] = if playing { reward } else { 0.0 };
            books.left.as_mut()[lane] = if playing { left } else { before };
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
