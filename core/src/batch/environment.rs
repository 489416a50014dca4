//! A batch of ski episodes: reset, step, observe, reward, autoreset, block by block.

use super::codec::{read_player, write_player};
use super::float_environment::DefaultFloats;
use super::pool::{INLINE_BELOW, pool, resolve_threads};
use super::simulator::{MAX_PLAYERS, check_tick, find_armor};
use super::snapshot;
use crate::error::{InputError, refuse};
use crate::input::Input;
use crate::movement::{Movement, Sliced};
use crate::observe::{LayoutField, SkiObservation};
use crate::player::{Field, Player, fields, local};
use crate::real::{Int, Mask, Real, Scalar, V3};
use crate::rules::{Physics, Rules};
use crate::scene::{Group, Scene, Ski};
use crate::task::{ActionKind, Actions, CourseRequest, Outcome, Run, SkiTask, draw_course};
use crate::terrain::Maps;
use crate::terrain::mission::Area;
use glam::{DVec2, DVec3, IVec2};
use rayon::prelude::*;
use std::sync::Arc;

mod episode;
mod step;

use episode::{Begun, Episode, Phase};

/// Players stepped together by one task of the pool.
const CHUNK: usize = 32;

/// When an environment whose episode ended begins the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// In the step after the one that ended it, whose action is ignored.
    NextStep,
    /// In the step that ended it, which returns the next episode's first observation.
    SameStep,
    /// When the user resets it; until then it stays as it ended.
    Disabled,
}

/// What a reset asks for. Every list is empty (nothing asked) or has one entry per environment.
#[derive(Clone, Debug, Default)]
pub struct ResetRequest {
    /// New seeds; without them each environment goes on to its next episode.
    pub seeds: Vec<u64>,
    /// Which environments to reset; all where empty.
    pub mask: Vec<bool>,
    /// Fixed parts of the episodes; drawn where empty.
    pub courses: Vec<CourseRequest>,
}

/// Where a step writes: one entry (or row) per environment.
#[derive(Debug)]
pub struct StepOutput<'a> {
    /// Observations, row by row.
    pub observations: &'a mut [f32],
    /// Rewards.
    pub rewards: &'a mut [f64],
    /// Whether the episode ended by arrival or death.
    pub terminated: &'a mut [bool],
    /// Whether the episode ended by the clock.
    pub truncated: &'a mut [bool],
}

/// What is reported of an environment at any time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// Horizontal distance to the beacon, m.
    pub distance: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// Seconds played.
    pub time: f64,
    /// Whether the player is outside the mission area.
    pub outside: bool,
    /// Which map of the pool.
    pub terrain: usize,
}

/// Everything that a batch of ski environments is made from.
#[derive(Debug)]
pub struct SkiEnvironments {
    /// The pool of maps; batches may share one.
    pub maps: Arc<Maps>,
    /// The area of each map that episodes are drawn in.
    pub areas: Vec<Area>,
    /// How many environments.
    pub count: usize,
    /// Tier: "authentic" or "reference".
    pub fidelity: String,
    /// Armor: "light", "medium" or "heavy".
    pub armor: String,
    /// Whether the player wears an energy pack.
    pub energy_pack: bool,
    /// Switches of the movement model.
    pub physics: Physics,
    /// Tick length, ms.
    pub tick_ms: u32,
    /// The task.
    pub task: SkiTask,
    /// Its actions.
    pub actions: ActionKind,
    /// Its observation.
    pub observation: SkiObservation,
    /// When ended episodes begin anew.
    pub autoreset: Autoreset,
    /// Threads; one per core where absent.
    pub threads: Option<usize>,
}

/// What every batch of environments can do, whatever its tier.
pub trait Environments: Send + Sync {
    /// How many environments.
    fn len(&self) -> usize;
    /// Whether there is none: never.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Numbers in an observation.
    fn observation_size(&self) -> usize;
    /// The layout of an observation.
    fn layout(&self) -> Vec<LayoutField>;
    /// The kind of action that [`Environments::step`] takes.
    fn action_kind(&self) -> ActionKind;
    /// Begins episodes, and writes the observations of all environments.
    ///
    /// # Errors
    /// If the request is malformed; then nothing was changed.
    fn reset(&mut self, request: &ResetRequest, observations: &mut [f32]) -> Result<(), InputError>;
    /// One decision of every environment.
    ///
    /// # Errors
    /// If actions or outputs are malformed, or an environment was never reset; then nothing was changed.
    fn step(&mut self, actions: Actions<'_>, output: StepOutput<'_>) -> Result<(), InputError>;
    /// Which environments' episodes ended in the last step, and how, in ascending order.
    fn finished(&self) -> &[(usize, Outcome)];
    /// Their last observations, row by row.
    fn final_observations(&self) -> &[f32];
    /// Status of every environment.
    fn status(&self) -> Vec<Status>;
    /// World position of every beacon, m.
    fn goals(&self) -> Vec<[f64; 3]>;
    /// The fields of a player's state after `position` (three f64), packed.
    fn state_fields(&self) -> Vec<Field>;
    /// All players' states, packed.
    fn state(&self) -> Vec<u8>;
    /// Bytes that one environment takes in memory, beside its observation row.
    fn bytes_per_environment(&self) -> usize;
    /// Everything, as bytes that [`Environments::restore`] takes.
    fn snapshot(&self) -> Vec<u8>;
    /// Goes back to a snapshot.
    ///
    /// # Errors
    /// If it is damaged, or of another layout or count; then nothing was changed.
    fn restore(&mut self, snapshot: &[u8]) -> Result<(), InputError>;
    /// XXH3-128 of all environments, as 32 hexadecimal digits.
    fn digest(&self) -> String;
}

/// The environments of some lanes, side by side.
#[derive(Clone, Copy, Debug)]
struct Block<S: Scene, R: Real> {
    player: Player<S, R>,
    run: Run<R>,
    episodes: R::Each<Episode>,
}

struct Batch<S: Scene, M: Movement, R: Real> {
    setup: SkiEnvironments,
    rules: Rules<R::Scalar>,
    blocks: Vec<Block<S, R>>,
    finished: Vec<(usize, Outcome)>,
    final_observations: Vec<f32>,
    row: usize,
    threads: usize,
    layout: String,
    movement: core::marker::PhantomData<M>,
}

impl SkiEnvironments {
    /// Builds the batch. Nothing is reset yet.
    ///
    /// # Errors
    /// Names the argument that is out of range or unknown, with what was expected.
    pub fn build(self) -> Result<Box<dyn Environments>, InputError> {
        self.check()?;
        match self.fidelity.as_str() {
            "authentic" => Batch::<Ski, Sliced, f32>::boxed(self),
            "reference" => Batch::<Ski, Sliced, f64>::boxed(self),
            other => refuse!("fidelity: expected \"authentic\" or \"reference\", got {other:?}"),
        }
    }

    fn check(&self) -> Result<(), InputError> {
        if !(1..=MAX_PLAYERS).contains(&self.count) {
            refuse!("num_envs: expected 1 to {MAX_PLAYERS}, got {}", self.count);
        }
        find_armor(&self.armor)?;
        check_tick(self.tick_ms)?;
        let task = &self.task;
        let (near, far) = task.goal_distance;
        if !(1..=1000).contains(&task.frame_skip) {
            refuse!("frame_skip: expected 1 to 1000 ticks, got {}", task.frame_skip);
        }
        if task.time_limit < 1 {
            refuse!("time_limit: expected at least one tick, got {}", task.time_limit);
        }
        if !(task.arrival_radius > 0.0 && task.arrival_radius <= 1000.0) {
            refuse!("arrival_radius: expected above 0 and up to 1000 m, got {}", task.arrival_radius);
        }
        if !(near > task.arrival_radius && near <= far && far <= 1e6) {
            refuse!(
                "goal_distance: expected (near, far) with arrival_radius < near <= far <= 1e6 m, got ({near}, {far})"
            );
        }
        if !(0.0..=1000.0).contains(&task.start_speed) {
            refuse!("start_speed: expected 0 to 1000 m/s, got {}", task.start_speed);
        }
        if !(task.turn_rate > 0.0 && task.turn_rate <= crate::input::MAX_TURN_RATE) {
            refuse!("turn_rate: expected above 0 and up to 1000 rad/s, got {}", task.turn_rate);
        }
        let reward = [task.reward.progress, task.reward.time, task.reward.arrival];
        if let Some(bad) = reward.iter().find(|w| w.is_nan() || w.abs() > 1e6) {
            refuse!("reward: expected finite weights within +-1e6, got {bad}");
        }
        if self.areas.len() != self.maps.count() {
            refuse!("areas: expected {}, one per terrain, got {}", self.maps.count(), self.areas.len());
        }
        let diagonal = |a: &Area| (DVec2::from(a.max) - DVec2::from(a.min)).length();
        if let Some(area) = self.areas.iter().find(|a| diagonal(a) < near) {
            refuse!(
                "goal_distance: expected at most {:.1} m, the diagonal of the smallest terrain's area, got {near}",
                diagonal(area)
            );
        }
        Ok(())
    }
}

impl<S: Scene, M: Movement, R: Real> Batch<S, M, R> {
    fn boxed(setup: SkiEnvironments) -> Result<Box<dyn Environments>, InputError> {
        let threads = resolve_threads(setup.threads)?;
        let armor = find_armor(&setup.armor)?;
        let rules = Rules::<R::Scalar>::new(armor, setup.energy_pack, setup.tick_ms, setup.physics);
        let row = setup.observation.size::<S>();
        let idle = Block {
            player: Player::new(&rules, V3::zero(), R::Int::splat(0)),
            run: Run::idle(),
            episodes: R::each(|_| Episode::default()),
        };
        let corners: Vec<u8> =
            setup.areas.iter().flat_map(|a| [a.min, a.max].concat()).flat_map(f64::to_le_bytes).collect();
        let layout = format!(
            "scene {}, fidelity {}, armor {}, energy_pack {}, {:?}, tick_ms {}, {:?}, {:?}, {:?}, {} terrains: {:032x}, \
             their areas: {:016x}",
            S::NAME,
            setup.fidelity,
            setup.armor,
            setup.energy_pack,
            setup.physics,
            setup.tick_ms,
            setup.task,
            setup.actions,
            setup.autoreset,
            setup.maps.count(),
            setup.maps.digest(),
            xxhash_rust::xxh3::xxh3_64(&corners),
        );
        let blocks = vec![idle; setup.count.div_ceil(R::LANES)];
        Ok(Box::new(Self {
            rules,
            blocks,
            finished: Vec::new(),
            final_observations: Vec::new(),
            row,
            threads,
            layout,
            setup,
            movement: core::marker::PhantomData,
        }))
    }

    /// Runs `work` over pieces of the batch: on the pool, or here where waking it costs more.
    fn inline(&self) -> bool {
        self.threads == 1 || self.setup.count < INLINE_BELOW
    }

    fn lanes(&self) -> impl Iterator<Item = (Player<S, R::Scalar>, Run<R::Scalar>, &Episode)> {
        let lanes = self
            .blocks
            .iter()
            .flat_map(|b| (0..R::LANES).map(|l| (b.player.lane(l), b.run.lane(l), &b.episodes.as_ref()[l])));
        lanes.take(self.setup.count)
    }

    fn place(&self, p: &Player<S, R::Scalar>) -> DVec3 {
        self.setup.maps.to_world(local(p), IVec2::new(p.tile_x, p.tile_y))
    }

    fn status_of(&self, p: &Player<S, R::Scalar>, run: &Run<R::Scalar>, episode: &Episode) -> Status {
        let surface = self.setup.maps.surface::<R::Scalar>();
        let map = episode.map as usize;
        Status {
            distance: run.distance(p, &surface).to_f64(),
            speed: p.velocity.length().to_f64(),
            time: run.seconds(self.rules.tick_ms),
            outside: !self.setup.areas[map].contains(self.place(p).truncate().into()),
            terrain: map,
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        for (player, run, episode) in self.lanes() {
            write_player(&player, true, &mut out);
            episode::write(&run, episode, &mut out);
        }
        out
    }

    fn body_stride(&self) -> usize {
        let player = fields::<S, R::Scalar>(true).iter().map(|f| f.kind.bytes() * f.count).sum::<usize>();
        player + episode::BYTES
    }
}

impl<S: Scene, M: Movement, R: Real> Environments for Batch<S, M, R> {
    fn len(&self) -> usize {
        self.setup.count
    }

    fn observation_size(&self) -> usize {
        self.row
    }

    fn layout(&self) -> Vec<LayoutField> {
        let (energy, damage) = (self.rules.max_energy.to_f64(), self.rules.max_damage.to_f64());
        self.setup.observation.layout::<S>(energy, damage)
    }

    fn action_kind(&self) -> ActionKind {
        self.setup.actions
    }

    fn reset(&mut self, request: &ResetRequest, observations: &mut [f32]) -> Result<(), InputError> {
        self.check_reset(request, observations.len())?;
        let _floats = DefaultFloats::enter();
        let chosen = |i: usize| request.mask.is_empty() || request.mask[i];
        let mut begun: Vec<(usize, Begun<S, R::Scalar>)> = Vec::new();
        for i in (0..self.setup.count).filter(|&i| chosen(i)) {
            let old = self.blocks[i / R::LANES].episodes.as_ref()[i % R::LANES];
            let (seed, number) = match (request.seeds.get(i), old.phase) {
                (Some(&seed), _) => (seed, 0),
                (None, Phase::Unseeded) => {
                    refuse!(
                        "seeds: expected one per environment at the first reset of environment {i}, got none"
                    )
                }
                (None, _) => (old.seed, old.episode + 1),
            };
            let course = request.courses.get(i).copied().unwrap_or_default();
            let next = episode::begin(&self.setup, &self.rules, seed, number, &course)
                .map_err(|e| InputError(format!("environment {i}: {e}")))?;
            begun.push((i, next));
        }
        for (i, next) in begun {
            self.blocks[i / R::LANES].put(i % R::LANES, &next);
        }
        self.finished.clear();
        self.final_observations.clear();
        self.observe_all(observations);
        Ok(())
    }

    fn step(&mut self, actions: Actions<'_>, output: StepOutput<'_>) -> Result<(), InputError> {
        self.check_step(&actions, &output)?;
        self.step_all(actions, output)
    }

    fn finished(&self) -> &[(usize, Outcome)] {
        &self.finished
    }

    fn final_observations(&self) -> &[f32] {
        &self.final_observations
    }

    fn status(&self) -> Vec<Status> {
        self.lanes().map(|(p, run, episode)| self.status_of(&p, &run, episode)).collect()
    }

    fn goals(&self) -> Vec<[f64; 3]> {
        self.lanes()
            .map(|(_, run, _)| {
                let goal = DVec3::new(run.goal.x.to_f64(), run.goal.y.to_f64(), run.goal.z.to_f64());
                let tile = IVec2::from(run.goal_tile);
                self.setup.maps.to_world(goal, tile).to_array()
            })
            .collect()
    }

    fn state_fields(&self) -> Vec<Field> {
        fields::<S, R::Scalar>(false)
    }

    fn state(&self) -> Vec<u8> {
        let mut out = Vec::new();
        for (p, _, _) in self.lanes() {
            self.place(&p).to_array().iter().for_each(|x| out.extend(x.to_le_bytes()));
            write_player(&p, false, &mut out);
        }
        out
    }

    fn bytes_per_environment(&self) -> usize {
        size_of::<Block<S, R>>() / R::LANES
    }

    fn snapshot(&self) -> Vec<u8> {
        snapshot::seal(&self.layout, self.setup.count, &self.bytes())
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), InputError> {
        let body = snapshot::open(&self.layout, self.setup.count, bytes)?;
        let stride = self.body_stride();
        if body.len() != stride * self.setup.count {
            refuse!("snapshot: expected {} bytes, got {}", stride * self.setup.count, body.len());
        }
        for (i, bytes) in body.chunks_exact(stride).enumerate() {
            let block = &mut self.blocks[i / R::LANES];
            let mut player = block.player.lane(i % R::LANES);
            let (head, tail) = bytes.split_at(stride - episode::BYTES);
            read_player(&mut player, true, head);
            let (run, episode) = episode::read(tail);
            block.put(i % R::LANES, &Begun { player, run, episode });
        }
        self.finished.clear();
        self.final_observations.clear();
        Ok(())
    }

    fn digest(&self) -> String {
        format!("{:032x}", xxhash_rust::xxh3::xxh3_128(&self.bytes()))
    }
}

impl<S: Scene, R: Real> Block<S, R> {
    fn put(&mut self, lane: usize, begun: &Begun<S, R::Scalar>) {
        self.player.set_lane(lane, &begun.player);
        self.run.set_lane(lane, &begun.run);
        self.episodes.as_mut()[lane] = begun.episode;
    }
}
