//! A batch of ski episodes: reset, step, observe, reward, autoreset, block by block.

use super::codec::{place, read_player, write_player, write_state};
use super::pool::{INLINE_BELOW, pool, resolve_threads};
use super::simulator::find_armor;
use super::snapshot;
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::input::Input;
use crate::movement::Movement;
use crate::observe::LayoutField;
use crate::player::{Field, Player, fields, packed_bytes};
use crate::real::{Int, Mask, Real, Scalar, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::task::{ActionKind, Actions, CourseRequest, Outcome, Run, draw_course};
use glam::{DVec3, IVec2};
use rayon::prelude::*;

mod api;
mod episode;
mod setup;
mod step;

pub use api::{Autoreset, Environments, ResetRequest, Rewards, Status, StatusOutput, StepOutput};
use episode::{Begun, Episode, Phase};
pub use setup::SkiEnvironments;

/// Players stepped together by one task of the pool.
const CHUNK: usize = 32;

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
    /// Whether a step panicked half-way: better no bits than wrong ones.
    broken: bool,
    layout: String,
    movement: core::marker::PhantomData<M>,
}

impl<S: Scene, M: Movement, R: Real> Batch<S, M, R> {
    fn boxed(setup: SkiEnvironments) -> Result<Box<dyn Environments>, InputError> {
        let threads = resolve_threads(setup.threads)?;
        crate::real::lanes::lane_width(setup.lanes, setup.count)?;
        let armor = find_armor(&setup.armor)?;
        let rules = Rules::new(M::MODEL, armor, setup.energy_pack, setup.tick_ms, setup.physics);
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
            broken: false,
            layout,
            setup,
            movement: core::marker::PhantomData,
        }))
    }

    /// Whether to step on the caller's thread: waking the pool costs more for few players.
    fn inline(&self) -> bool {
        self.threads == 1 || self.setup.count < INLINE_BELOW
    }

    fn each(&self) -> impl Iterator<Item = (Player<S, R::Scalar>, Run<R::Scalar>, &Episode)> {
        let lanes = self
            .blocks
            .iter()
            .flat_map(|b| (0..R::LANES).map(|l| (b.player.lane(l), b.run.lane(l), &b.episodes.as_ref()[l])));
        lanes.take(self.setup.count)
    }

    fn report(&self, p: &Player<S, R::Scalar>, run: &Run<R::Scalar>, episode: &Episode) -> Status {
        let surface = self.setup.maps.surface::<R::Scalar>();
        let map = episode.map as usize;
        Status {
            distance: run.distance(p, &surface).to_f64(),
            speed: p.velocity.length().to_f64(),
            time: run.seconds(self.rules.tick_ms),
            outside: !self.setup.areas[map].contains(place(&self.setup.maps, p).truncate().into()),
            terrain: map,
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        for (player, run, episode) in self.each() {
            write_player(&player, true, &mut out);
            episode::write(&run, episode, &mut out);
        }
        out
    }

    fn body_stride(&self) -> usize {
        packed_bytes(&fields::<S, R::Scalar>(true)) + episode::BYTES
    }
}

impl<S: Scene, M: Movement, R: Real> Environments for Batch<S, M, R> {
    fn len(&self) -> usize {
        self.setup.count
    }

    fn lanes(&self) -> usize {
        R::LANES
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
        for (i, next) in &begun {
            self.blocks[i / R::LANES].put(i % R::LANES, next);
        }
        self.finished.clear();
        self.final_observations.clear();
        if request.others_observed {
            for (i, next) in &begun {
                let row = &mut observations[i * self.row..(i + 1) * self.row];
                self.observe(&next.player, &next.run, &next.episode, row);
            }
        } else {
            self.observe_all(observations);
        }
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
        self.each().map(|(p, run, episode)| self.report(&p, &run, episode)).collect()
    }

    fn status_of(&self, index: usize) -> Status {
        assert!(index < self.setup.count, "no environment {index}");
        let (block, lane) = (&self.blocks[index / R::LANES], index % R::LANES);
        self.report(&block.player.lane(lane), &block.run.lane(lane), &block.episodes.as_ref()[lane])
    }

    fn goals(&self) -> Vec<[f64; 3]> {
        self.each()
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
        self.each().for_each(|(p, _, _)| write_state(&self.setup.maps, &p, &mut out));
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
        self.broken = false;
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
