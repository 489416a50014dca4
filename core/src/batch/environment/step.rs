//! One decision of a batch: ticks, rewards, ends, autoreset and observations in one pass over a block.

use super::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// A piece of the outputs that belongs to one piece of the batch.
struct Piece<'a, S: Scene, R: Real> {
    blocks: &'a mut [Block<S, R>],
    observations: &'a mut [f32],
    rewards: &'a mut [f64],
    terminated: &'a mut [bool],
    truncated: &'a mut [bool],
    /// Index of its first environment.
    first: usize,
}

/// The episodes of a piece that ended, in order, with their last observations.
#[derive(Default)]
struct Ended {
    outcomes: Vec<(usize, Outcome)>,
    observations: Vec<f32>,
}

/// How an environment's decision went.
#[derive(Clone, Copy, Default)]
struct Decision {
    ticks: i32,
    arrived: bool,
    died: bool,
    timed_out: bool,
}

impl<S: Scene, M: Movement, R: Real> Batch<S, M, R> {
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

    fn check_whole(&self) -> Result<(), InputError> {
        if self.broken {
            refuse!("an earlier step of this batch failed: restore a snapshot, or make a new batch");
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
        actions.check(self.setup.actions, n)?;
        let sizes = [output.rewards.len(), output.terminated.len(), output.truncated.len()];
        let columns = output
            .status
            .as_ref()
            .map_or([n; 4], |s| [s.distance.len(), s.speed.len(), s.time.len(), s.outside.len()]);
        if output.observations.len() != n * self.row || sizes != [n; 3] || columns != [n; 4] {
            refuse!("output: expected {n} rows of {} and {n} of the rest", self.row);
        }
        let mut episodes = self.blocks.iter().flat_map(|b| b.episodes.as_ref()).take(n);
        if episodes.any(|e| e.phase == Phase::Unseeded) {
            refuse!("step: expected every environment to have been reset before its first step");
        }
        Ok(())
    }

    pub(super) fn observe_all(&self, observations: &mut [f32]) {
        for ((player, run, episode), row) in self.each().zip(observations.chunks_exact_mut(self.row)) {
            self.observe(&player, &run, episode, row);
        }
    }

    pub(super) fn observe(
        &self,
        p: &Player<S, R::Scalar>,
        run: &Run<R::Scalar>,
        episode: &Episode,
        row: &mut [f32],
    ) {
        let surface = self.setup.maps.surface::<R::Scalar>();
        let lowest = <R::Scalar as Scalar>::from_f64(self.setup.maps.range(episode.map as usize).0);
        self.setup.observation.write(p, run, &surface, &self.rules, lowest, row);
    }

    pub(super) fn step_all(
        &mut self,
        actions: Actions<'_>,
        output: StepOutput<'_>,
    ) -> Result<(), InputError> {
        let StepOutput { observations, rewards, terminated, truncated, status } = output;
        let mut wide = Vec::new();
        let (narrow, rewards) = match rewards {
            Rewards::F64(rewards) => (None, rewards),
            Rewards::F32(narrow) => {
                wide.resize(narrow.len(), 0.0);
                (Some(narrow), &mut wide[..])
            }
        };
        let inline = self.inline();
        let pool = if inline { None } else { Some(pool(self.threads)?) };
        // The blocks leave the batch for the step, so that the rest of it can be read from every thread.
        let mut blocks = core::mem::take(&mut self.blocks);
        let per_task = if inline { blocks.len() } else { CHUNK.div_ceil(R::LANES) };
        let rows = per_task * R::LANES;
        let this = &*self;
        let stepped = catch_unwind(AssertUnwindSafe(|| match pool {
            None => {
                let piece = Piece {
                    blocks: &mut blocks,
                    observations,
                    rewards: &mut *rewards,
                    terminated,
                    truncated,
                    first: 0,
                };
                vec![this.step_piece(piece, actions)]
            }
            Some(pool) => pool.install(|| {
                blocks
                    .par_chunks_mut(per_task)
                    .zip(observations.par_chunks_mut(rows * this.row))
                    .zip(rewards.par_chunks_mut(rows))
                    .zip(terminated.par_chunks_mut(rows))
                    .zip(truncated.par_chunks_mut(rows))
                    .enumerate()
                    .map(|(k, ((((blocks, observations), rewards), terminated), truncated))| {
                        let first = k * rows;
                        this.step_piece(
                            Piece { blocks, observations, rewards, terminated, truncated, first },
                            actions,
                        )
                    })
                    .collect::<Vec<Ended>>()
            }),
        }));
        self.blocks = blocks;
        let ended = stepped.unwrap_or_else(|panic| {
            self.broken = true;
            resume_unwind(panic)
        });
        self.finished.clear();
        self.final_observations.clear();
        for piece in ended {
            self.finished.extend(piece.outcomes);
            self.final_observations.extend(piece.observations);
        }
        if let Some(narrow) = narrow {
            narrow.iter_mut().zip(wide).for_each(|(out, reward)| *out = reward as f32);
        }
        if let Some(out) = status {
            for (i, (player, run, episode)) in self.each().enumerate() {
                let status = self.report(&player, &run, episode);
                (out.distance[i], out.speed[i]) = (status.distance, status.speed);
                (out.time[i], out.outside[i]) = (status.time, status.outside);
            }
        }
        Ok(())
    }

    fn step_piece(&self, piece: Piece<'_, S, R>, actions: Actions<'_>) -> Ended {
        let _floats = DefaultFloats::enter();
        let mut ended = Ended::default();
        let mut observations = piece.observations.chunks_exact_mut(self.row);
        for (k, block) in piece.blocks.iter_mut().enumerate() {
            let decisions = self.decide(block, piece.first + k * R::LANES, actions);
            for lane in 0..R::LANES {
                let (at, env) = (k * R::LANES + lane, piece.first + k * R::LANES + lane);
                // Lanes beyond the last environment are padding.
                let Some(row) = observations.next() else { return ended };
                let decision = decisions.as_ref()[lane];
                (piece.rewards[at], piece.terminated[at], piece.truncated[at]) =
                    self.settle(block, lane, env, decision, row, &mut ended);
            }
        }
        ended
    }

    /// Plays the ticks of one decision. A player whose episode ends freezes for the rest of them.
    fn decide(&self, block: &mut Block<S, R>, first: usize, actions: Actions<'_>) -> R::Each<Decision> {
        let surface = self.setup.maps.surface::<R::Scalar>();
        let turn_rate = <R::Scalar as Scalar>::from_f64(self.setup.task.turn_rate);
        let mut input = Input::<R>::idle();
        let mut active = R::Mask::splat(false);
        for lane in 0..R::LANES.min(self.setup.count - first) {
            input.set_lane(lane, &actions.input(first + lane, turn_rate));
            active.set_lane(lane, block.episodes.as_ref()[lane].phase == Phase::Running);
        }
        let mut decisions = R::each(|_| Decision::default());
        for _ in 0..self.setup.task.frame_skip {
            if !active.any() {
                break;
            }
            let before = block.player;
            let mut after = crate::tick::tick::<S, M, R, _>(&before, &input, &surface, &self.rules);
            let mut run = block.run;
            let verdict = run.judge(&before, &after, &self.setup.task, self.rules.max_damage, &surface);
            (after.position.x, after.position.y, after.tile_x, after.tile_y) =
                surface.wrap::<R>(after.position.x, after.position.y, after.tile_x, after.tile_y);
            for lane in 0..R::LANES {
                if active.lane(lane) {
                    let d = &mut decisions.as_mut()[lane];
                    d.ticks += 1;
                    d.arrived = verdict.arrived.lane(lane);
                    d.died = verdict.died.lane(lane);
                    d.timed_out = verdict.timed_out.lane(lane);
                } else {
                    run.set_lane(lane, &block.run.lane(lane));
                }
            }
            block.player = Player::select(active, &after, &before);
            block.run = run;
            let over = verdict.arrived.or(verdict.died).or(verdict.timed_out);
            active = active.and(over.not());
        }
        decisions
    }

    /// Reward, flags, end of episode, autoreset and observation of one environment.
    fn settle(
        &self,
        block: &mut Block<S, R>,
        lane: usize,
        env: usize,
        decision: Decision,
        row: &mut [f32],
        ended: &mut Ended,
    ) -> (f64, bool, bool) {
        let (player, run) = (block.player.lane(lane), block.run.lane(lane));
        let mut episode = block.episodes.as_ref()[lane];
        if episode.phase != Phase::Running {
            let flags = (episode.phase == Phase::Terminated, episode.phase == Phase::Truncated);
            if self.setup.autoreset == Autoreset::NextStep {
                self.go_on(block, lane, &episode, row);
                return (0.0, false, false);
            }
            self.observe(&player, &run, &episode, row);
            return (0.0, flags.0, flags.1);
        }

        let surface = self.setup.maps.surface::<R::Scalar>();
        let distance = run.distance(&player, &surface).to_f64();
        let weights = &self.setup.task.reward;
        let seconds = f64::from(decision.ticks) * f64::from(self.rules.tick_ms) / 1000.0;
        let bonus = if decision.arrived { weights.arrival } else { 0.0 };
        let reward = weights.progress * (episode.distance - distance) + weights.time * seconds + bonus;
        episode.distance = distance;
        episode.total_reward += reward;
        episode.length += 1;

        let terminated = decision.arrived || decision.died;
        let truncated = decision.timed_out;
        if terminated {
            episode.phase = Phase::Terminated;
        } else if truncated {
            episode.phase = Phase::Truncated;
        }
        block.episodes.as_mut()[lane] = episode;
        self.observe(&player, &run, &episode, row);
        if terminated || truncated {
            ended.outcomes.push((env, self.outcome(&player, &run, &episode, decision)));
            ended.observations.extend_from_slice(row);
            if self.setup.autoreset == Autoreset::SameStep {
                self.go_on(block, lane, &episode, row);
            }
        }
        (reward, terminated, truncated)
    }

    /// Begins the environment's next episode and observes it.
    fn go_on(&self, block: &mut Block<S, R>, lane: usize, old: &Episode, row: &mut [f32]) {
        let course = CourseRequest::default();
        let next = episode::begin::<S, _>(&self.setup, &self.rules, old.seed, old.episode + 1, &course)
            .expect("a course drawn within a checked area can always begin");
        block.put(lane, &next);
        self.observe(&next.player, &next.run, &next.episode, row);
    }

    fn outcome(
        &self,
        p: &Player<S, R::Scalar>,
        run: &Run<R::Scalar>,
        e: &Episode,
        decision: Decision,
    ) -> Outcome {
        let Status { distance, speed, time, outside, .. } = self.report(p, run, e);
        let path = run.path.to_f64();
        Outcome {
            success: decision.arrived,
            death: decision.died,
            timeout: decision.timed_out,
            time,
            total_reward: e.total_reward,
            length: e.length,
            top_speed: run.top_speed.to_f64(),
            mean_speed: path / time,
            path,
            damage: p.damage.get(R::Scalar::default()).to_f64(),
            distance,
            start_distance: e.start_distance,
            speed,
            outside,
            terrain: i64::from(e.map),
            seed: e.seed,
            episode: e.episode,
        }
    }
}
