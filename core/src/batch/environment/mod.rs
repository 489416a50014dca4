//! A batch of episodes of a task: reset, step, observe, reward, autoreset, block by block.

use super::alone::PLAYERS;
use super::codec::{body_fields, place, read_body, write_body, write_place};
use super::legal::{check_place, check_played, check_shots};
use super::pool::{Crew, resolve_threads};
use super::simulator::{check_near, find_armor};
use super::snapshot;
use super::stage::{Body, Stage};
use crate::arms::{Arms, Arsenal, DISC};
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::input::Input;
use crate::movement::Movement;
use crate::observe::LayoutField;
use crate::player::{Field, Player, packed_bytes};
use crate::real::{Int, Mask, Real, Scalar, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::task::{
    ActionKind, Actions, CourseRequest, Kind, MOST_TAKEN, Outcome, Pitch, Run, STREAK, action_bins,
    draw_course,
};
use core::ops::Range;
use glam::{DVec2, DVec3, IVec2};

mod api;
mod block;
mod decision;
mod ends;
mod episode;
mod parts;
mod setup;
mod step;

pub use api::{Autoreset, Environments, LifeStage, ResetRequest, Rewards, Status, StatusOutput, StepOutput};
use block::Block;
use episode::{Begun, Episode, Next, Phase};
use parts::{PARTS, Watch};
pub use setup::EnvironmentsSetup;
use step::Report;

struct Batch<S: Scene, K: Kind, M: Movement, R: Real> {
    setup: EnvironmentsSetup,
    rules: Rules<R::Scalar>,
    arsenal: Arsenal<R::Scalar>,
    /// The players, beside what is kept of their episodes: what plays bodies without a task plays them too.
    bodies: Vec<Body<S, R>>,
    blocks: Vec<Block<K, R>>,
    finished: Vec<(usize, Outcome)>,
    final_observations: Vec<f32>,
    /// What the pieces of a step report, one each; kept, so that a step need not ask for memory.
    reports: Vec<Report>,
    /// Whether every environment was reset at least once.
    ready: bool,
    row: usize,
    threads: usize,
    /// Whether a step panicked or was stopped half-way: better no bits than wrong ones.
    broken: bool,
    fail: bool,
    layout: String,
    /// What plays those who have projectiles or are among solids.
    play: Play<S, R>,
    movement: core::marker::PhantomData<M>,
}

/// Ticks of bodies: [`Stage::play_alone`] of a tier.
type Play<S, R> = fn(&Stage<'_, <R as Real>::Scalar>, &mut [Body<S, R>], &[Input<R>], u32);

impl<S: Scene, K: Kind, M: Movement, R: Real> Batch<S, K, M, R> {
    /// The batch of a tier, `P`. Only where players are alone on bare ground `M` is it too: there everything that a
    /// step does is compiled into one, and for the others it is compiled once for all tiers.
    fn boxed<P: Movement>(setup: EnvironmentsSetup) -> Result<Box<dyn Environments>, InputError> {
        let threads = resolve_threads(setup.threads)?;
        let armor = find_armor(&setup.armor)?;
        let rules = Rules::new(P::MODEL, armor, setup.energy_pack, setup.tick_ms, setup.physics);
        check_near::<R>(&setup.solids, &setup.maps)?;
        let mut arsenal = Arsenal::new(&DISC, setup.tick_ms, &setup.physics);
        arsenal.ammo = setup.ammo;
        let row = setup.observation.size::<S, K>();
        let places = |pitch: &Pitch| {
            let [a, b] = pitch.stands;
            let area = [pitch.area.min, pitch.area.max].concat();
            area.into_iter().chain(a.to_array()).chain(b.to_array()).collect::<Vec<f64>>()
        };
        let corners: Vec<u8> = setup.pitches.iter().flat_map(places).flat_map(f64::to_le_bytes).collect();
        let standing: Vec<u8> = setup.solids.iter().flat_map(|s| s.digest().to_le_bytes()).collect();
        let layout = format!(
            "scene {}, {:?}, ammo {}, fidelity {}, armor {}, energy_pack {}, {:?}, tick_ms {}, {:?}, {:?}, \
             {} terrains: {:032x}, their areas: {:016x}, what stands on them: {:016x}",
            S::NAME,
            setup.grounds,
            setup.ammo,
            setup.fidelity,
            setup.armor,
            setup.energy_pack,
            setup.physics,
            setup.tick_ms,
            setup.task,
            setup.actions,
            setup.maps.count(),
            setup.maps.digest(),
            xxhash_rust::xxh3::xxh3_64(&corners),
            xxhash_rust::xxh3::xxh3_64(&standing),
        );
        let player = Player::new(&rules, V3::zero(), R::Int::splat(0));
        let idle = Body { player, arms: Group::new(Arms::new(&arsenal)) };
        let blocks = setup.count.div_ceil(R::LANES);
        Ok(Box::new(Self {
            rules,
            arsenal,
            bodies: vec![idle; blocks],
            blocks: vec![Block::idle(); blocks],
            finished: Vec::new(),
            final_observations: Vec::new(),
            reports: Vec::new(),
            ready: false,
            row,
            threads,
            broken: false,
            fail: false,
            layout,
            setup,
            play: |stage, bodies, inputs, ticks| stage.play_alone::<S, P, R>(bodies, inputs, ticks),
            movement: core::marker::PhantomData,
        }))
    }

    /// Players that a thread takes at a time: whole blocks.
    const PIECE: usize = R::LANES * PLAYERS.div_ceil(R::LANES);

    fn crew(&self) -> Result<Crew, InputError> {
        Crew::new(self.threads, self.setup.count)
    }

    fn each(&self) -> impl Iterator<Item = Begun<S, K, R::Scalar>> {
        (0..self.setup.count).map(|env| self.one(env))
    }

    fn one(&self, env: usize) -> Begun<S, K, R::Scalar> {
        let (at, lane) = (env / R::LANES, env % R::LANES);
        self.blocks[at].one(&self.bodies[at], lane)
    }

    fn stage(&self) -> Stage<'_, R::Scalar> {
        Stage::new(&self.setup.maps, &self.setup.solids, &self.rules, &self.arsenal)
    }

    fn stride(&self) -> usize {
        packed_bytes(&body_fields::<S, R::Scalar>(true)) + episode::bytes::<K>(self.levels())
    }

    fn levels(&self) -> usize {
        self.setup.task.levels.len()
    }

    /// Whether an episode that is over reached its goal.
    fn succeeded(&self, begun: &Begun<S, K, R::Scalar>) -> bool {
        let zero = R::Scalar::default();
        begun.episode.phase == Phase::Terminated && begun.body.player.damage.get(zero) < self.rules.max_damage
    }

    fn following(&self, old: &Begun<S, K, R::Scalar>) -> Next {
        Next::after(&old.episode, self.succeeded(old), self.levels())
    }

    fn begin(&self, next: Next, course: &CourseRequest) -> Result<Begun<S, K, R::Scalar>, InputError> {
        episode::begin(&self.setup, (&self.rules, &self.arsenal), next, course)
    }

    fn one_of(&self, env: usize) -> Result<Range<usize>, InputError> {
        if env >= self.setup.count {
            refuse!("index: expected 0 to {}, got {env}", self.setup.count - 1);
        }
        Ok(env..env + 1)
    }

    fn sealed(&self, envs: Range<usize>) -> Vec<u8> {
        snapshot::seal(&self.layout, envs.len(), &self.bytes(envs))
    }

    fn open(&mut self, envs: Range<usize>, bytes: &[u8]) -> Result<(), InputError> {
        let (stride, levels) = (self.stride(), self.levels());
        let body = snapshot::open(&self.layout, envs.len(), stride, bytes)?;
        // A checksum tells damage, not what a stranger wrote: nobody is put back before all were looked at.
        let mut read = Vec::with_capacity(envs.len());
        for (i, bytes) in envs.clone().zip(body.chunks_exact(stride)) {
            let mut body = self.bodies[i / R::LANES].lane(i % R::LANES);
            let (head, tail) = bytes.split_at(stride - episode::bytes::<K>(levels));
            read_body(&mut body, true, head);
            let (run, episode) = episode::read(tail, levels);
            let begun = Begun { body, run, episode };
            self.check_begun(&begun).map_err(|e| e.of(format_args!("snapshot: environment {i}")))?;
            read.push(begun);
        }
        for (i, begun) in envs.zip(&read) {
            self.put(i, begun);
        }
        Ok(())
    }

    /// Refuses an episode of a snapshot that cannot have been played.
    fn check_begun(&self, begun: &Begun<S, K, R::Scalar>) -> Result<(), InputError> {
        let Begun { body, run, episode } = begun;
        let (maps, player) = (&self.setup.maps, &body.player);
        check_played(player, maps, &self.rules)?;
        if let Some(arms) = body.arms.as_ref() {
            check_shots(arms, maps)?;
        }
        check_place(maps, run.goal, run.goal_tile, 0.0).map_err(|e| e.of("goal"))?;
        let map = episode.map as usize;
        if map >= maps.count() || maps.offset(map) != player.map {
            refuse!("terrain: expected 0 to {}, the player's, got {map}", maps.count() - 1);
        }
        let limit = self.setup.task.time_limit;
        if !(0..=limit).contains(&run.ticks) || episode.length < 0 {
            refuse!("time: expected 0 to {limit} ticks, got {} in {}", run.ticks, episode.length);
        }
        let told = [run.path.to_f64(), run.top_speed.to_f64(), episode.left, episode.start_distance];
        if let Some(wrong) =
            told.iter().chain([&episode.total_reward, &episode.rise]).find(|x| !x.is_finite())
        {
            refuse!("figures: expected finite distances, speeds and reward, got {wrong}");
        }
        if episode.level as usize >= self.levels() || episode.streak.abs() > STREAK {
            refuse!("level: expected 0 to {}, got {}", self.levels() - 1, episode.level);
        }
        let Some(flag) = run.flag.as_ref() else { return Ok(()) };
        if !(0..=MOST_TAKEN).contains(&flag.taken) || !(0..=MOST_TAKEN).contains(&flag.outside) {
            refuse!("flag: expected counts from 0 to {MOST_TAKEN}, got {} and {}", flag.taken, flag.outside);
        }
        for place in [flag.enemy, flag.home] {
            check_place(maps, place, [0, 0], 0.0).map_err(|e| e.of("flag"))?;
        }
        if let Some(wrong) = flag.area.iter().find(|x| !x.finite()) {
            refuse!("flag: expected a finite area, got {wrong:?}");
        }
        Ok(())
    }

    fn episode(&self, index: usize) -> Episode {
        self.blocks[index / R::LANES].episodes.lane(index % R::LANES)
    }

    fn put(&mut self, index: usize, begun: &Begun<S, K, R::Scalar>) {
        let (at, lane) = (index / R::LANES, index % R::LANES);
        self.blocks[at].put(&mut self.bodies[at], lane, begun, &self.setup.maps);
    }

    fn bytes(&self, envs: Range<usize>) -> Vec<u8> {
        let mut out = Vec::new();
        for Begun { body, run, episode } in envs.map(|env| self.one(env)) {
            write_body(&body, true, &mut out);
            episode::write(&run, &episode, self.levels(), &mut out);
        }
        out
    }

    /// After a reset or a restore.
    fn note_phases(&mut self) {
        let phases = self.blocks.iter().flat_map(|block| block.episodes.phase.as_ref());
        self.ready = self.ready || phases.take(self.setup.count).all(|&phase| phase != Phase::Unseeded);
        self.finished.clear();
        self.final_observations.clear();
    }
}

impl<S: Scene, K: Kind, M: Movement, R: Real> Environments for Batch<S, K, M, R> {
    fn len(&self) -> usize {
        self.setup.count
    }

    fn lanes(&self) -> usize {
        R::LANES
    }

    fn ready(&self) -> bool {
        self.ready
    }

    fn time_parts(&mut self, on: bool) {
        self.reports = (0..self.setup.count.div_ceil(Self::PIECE)).map(|_| Report::new(on)).collect();
    }

    fn parts(&self) -> Vec<(&'static str, f64)> {
        let mut watches = self.reports.iter().filter_map(|report| report.watch.as_ref()).peekable();
        if watches.peek().is_none() {
            return Vec::new();
        }
        let mut spent = [0.0; PARTS.len()];
        for watch in watches {
            spent.iter_mut().zip(watch.spent()).for_each(|(sum, one)| *sum += one.as_secs_f64());
        }
        PARTS.into_iter().zip(spent).collect()
    }

    fn observation_size(&self) -> usize {
        self.row
    }

    fn layout(&self) -> Vec<LayoutField> {
        let (energy, damage) = (self.rules.max_energy.to_f64(), self.rules.max_damage.to_f64());
        self.setup.observation.layout::<S, K>(energy, damage)
    }

    fn action_bins(&self) -> &'static [i64] {
        action_bins(S::Arms::<R>::MODELED)
    }

    fn action_kind(&self) -> ActionKind {
        self.setup.actions
    }

    fn reset_while(
        &mut self,
        request: &ResetRequest,
        observations: &mut [f32],
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), InputError> {
        self.check_reset(request, observations.len())?;
        let crew = self.crew()?;
        let _floats = DefaultFloats::enter();
        let mut begun = Vec::new();
        for i in asked(&request.mask, self.setup.count) {
            let old = self.one(i);
            let next = match (request.seeds.get(i), old.episode.phase) {
                (Some(&seed), _) => Next::first(seed),
                (None, Phase::Unseeded) => {
                    refuse!(
                        "seeds: expected one per environment at the first reset of environment {i}, got none"
                    )
                }
                (None, _) => self.following(&old),
            };
            let course = request.courses.get(i).copied().unwrap_or_default();
            let next = self.begin(next, &course).map_err(|e| InputError(format!("environment {i}: {e}")))?;
            begun.push((i, next));
            if begun.len().is_multiple_of(PLAYERS) && !go_on() {
                refuse!("the reset was stopped before anything changed");
            }
        }
        let chosen: Vec<usize> = begun.iter().map(|&(i, _)| i).collect();
        for (i, next) in begun {
            self.put(i, &next);
        }
        self.note_phases();
        if request.others_observed {
            for i in chosen {
                let row = &mut observations[i * self.row..(i + 1) * self.row];
                self.observe_lane(i / R::LANES, i % R::LANES, row);
            }
        } else {
            let seen = self.observe_all(crew, observations, go_on);
            if !seen {
                refuse!("the reset was stopped: its episodes have begun, and were not observed");
            }
        }
        Ok(())
    }

    fn step_while(
        &mut self,
        actions: Actions<'_>,
        output: StepOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), InputError> {
        self.check_step(&actions, &output)?;
        self.step_all(actions, output, go_on)
    }

    fn whole(&self) -> Result<(), InputError> {
        self.check_whole()
    }

    fn fail_next_step(&mut self) {
        self.fail = true;
    }

    fn finished(&self) -> &[(usize, Outcome)] {
        &self.finished
    }

    fn final_observations(&self) -> &[f32] {
        &self.final_observations
    }

    fn status(&self) -> Vec<Status> {
        self.each().map(|begun| self.describe(&begun)).collect()
    }

    fn status_of(&self, index: usize) -> Status {
        assert!(index < self.setup.count, "no environment {index}");
        self.describe(&self.one(index))
    }

    fn episodes(&self) -> Vec<(u64, u64)> {
        (0..self.setup.count).map(|i| self.episode(i)).map(|e| (e.seed, e.episode)).collect()
    }

    fn goals(&self) -> Vec<[f64; 3]> {
        self.each()
            .map(|Begun { run, .. }| {
                let goal = DVec3::new(run.goal.x.to_f64(), run.goal.y.to_f64(), run.goal.z.to_f64());
                let tile = IVec2::from(run.goal_tile);
                self.setup.maps.to_world(goal, tile).to_array()
            })
            .collect()
    }

    fn state_fields(&self) -> Vec<Field> {
        body_fields::<S, R::Scalar>(false)
    }

    fn state(&self) -> Vec<u8> {
        let mut out = Vec::new();
        for Begun { body, .. } in self.each() {
            write_place(&self.setup.maps, &body.player, &mut out);
            write_body(&body, false, &mut out);
        }
        out
    }

    fn bytes_per_environment(&self) -> usize {
        (size_of::<Body<S, R>>() + size_of::<Block<K, R>>()) / R::LANES
    }

    fn stage_of(&self, env: usize) -> LifeStage {
        assert!(env < self.setup.count, "no environment {env}");
        match self.episode(env).phase {
            Phase::Unseeded => LifeStage::Fresh,
            Phase::Running => LifeStage::Running,
            Phase::Terminated | Phase::Truncated => LifeStage::Over,
        }
    }

    fn snapshot(&self) -> Vec<u8> {
        self.sealed(0..self.setup.count)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), InputError> {
        self.open(0..self.setup.count, bytes)?;
        self.ready = false;
        self.note_phases();
        self.broken = false;
        Ok(())
    }

    fn snapshot_one(&self, env: usize) -> Result<Vec<u8>, InputError> {
        Ok(self.sealed(self.one_of(env)?))
    }

    fn restore_one(&mut self, env: usize, bytes: &[u8]) -> Result<(), InputError> {
        self.check_whole()?;
        self.open(self.one_of(env)?, bytes)?;
        // Among many the others are not looked at again, unless it is their last hope of being ready.
        if self.episode(env).phase == Phase::Unseeded {
            self.ready = false;
        }
        if !self.ready {
            self.note_phases();
        }
        self.finished.clear();
        self.final_observations.clear();
        Ok(())
    }

    fn digest(&self) -> String {
        format!("{:032x}", xxhash_rust::xxh3::xxh3_128(&self.bytes(0..self.setup.count)))
    }
}

/// The environments that a mask names; all of `count` where it is empty.
fn asked(mask: &[bool], count: usize) -> impl Iterator<Item = usize> {
    /// Few are named among many: stretches without one are passed over as a whole.
    const STRETCH: usize = 64;
    let all = if mask.is_empty() { 0..count } else { 0..0 };
    let named = mask
        .chunks(STRETCH)
        .enumerate()
        .filter(|(_, stretch)| stretch.iter().fold(false, |any, &one| any | one))
        .flat_map(|(k, stretch)| (0..stretch.len()).filter(|&i| stretch[i]).map(move |i| k * STRETCH + i));
    all.chain(named)
}
