//! A batch of players and nothing else: state in, ticks, state out.

mod kernels;
mod setup;
mod shots;
mod state;

pub use setup::{FARTHEST_SOLID_F32, MAX_PLAYERS, MAX_PLAYERS_PER_WORLD, SimulatorSetup};
pub(super) use setup::{check_tick, find_armor};
pub use shots::Shot;
pub use state::MAX_SPEED;

use super::alone::{MOST_BLOCKS, PLAYERS, together};
use super::codec::{body_fields, read_body, write_body};
use super::neighbourhood::Stand;
use super::pool::Crew;
use super::raw_input::RawInput;
use super::snapshot;
use super::stage::{Body, Stage};
use crate::arms::Arsenal;
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::input::Input;
use crate::movement::Movement;
use crate::player::{Field, packed_bytes};
use crate::real::{Real, Scalar, Work};
use crate::rules::Rules;
use crate::scene::Scene;
use crate::solids::Solids;
use crate::terrain::Maps;
use core::marker::PhantomData;
use std::sync::Arc;

/// What every batch of bodies can do, whatever its scene and tier.
pub trait Bodies: Send + Sync {
    /// How many players.
    fn len(&self) -> usize;
    /// Whether there is none: never.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// The fields of a player's state after `position` (three f64), packed.
    fn state_fields(&self) -> Vec<Field>;
    /// Bytes of one player in [`Bodies::state`].
    fn state_bytes(&self) -> usize {
        24 + packed_bytes(&self.state_fields())
    }
    /// Bytes that one player takes in memory.
    fn player_bytes(&self) -> usize;
    /// How many players are stepped side by side: 1, 8, 16 or 32. No bit depends on it.
    fn lanes(&self) -> usize;
    /// "float32" or "float64".
    fn precision(&self) -> &'static str;
    /// The scene's name.
    fn scene(&self) -> &'static str;
    /// All players' states, packed, one after the other.
    fn state(&self) -> Vec<u8>;
    /// Overwrites the states of the players at `indices` with packed states, one each.
    ///
    /// # Errors
    /// If a value is out of range; then nothing was changed.
    fn set_state(&mut self, indices: &[usize], states: &[u8]) -> Result<(), InputError>;
    /// Plays `ticks` ticks with the same input in each.
    ///
    /// # Errors
    /// If there is not one input per player, or one is out of range; then nothing was changed.
    fn step(&mut self, inputs: &[RawInput], ticks: u32) -> Result<(), InputError>;
    /// One explosion of a weapon ("disc", "grenade", "mortar") per player, at world points, m; a point
    /// with a NaN is none. It acts on all players of the player's world at once, in the players' order,
    /// and nothing stays pending.
    ///
    /// # Errors
    /// If the scene models no explosions, the weapon is unknown, there is not one point per player, or
    /// one is out of range; then nothing was changed.
    fn explode(&mut self, points: &[[f64; 3]], weapon: &str) -> Result<(), InputError>;
    /// The projectiles that burst in the last tick, in the order of their shooters.
    fn blasts(&self) -> Vec<Shot>;
    /// The projectiles under way, in the order of their shooters.
    fn projectiles(&self) -> Vec<Shot>;
    /// Everything, as bytes that [`Bodies::restore`] takes.
    fn snapshot(&self) -> Vec<u8>;
    /// Goes back to a snapshot.
    ///
    /// # Errors
    /// If it is damaged, or of another layout or count; then nothing was changed.
    fn restore(&mut self, snapshot: &[u8]) -> Result<(), InputError>;
    /// XXH3-128 of all players, as 32 hexadecimal digits.
    fn digest(&self) -> String;
}

/// A batch of players in one scene and tier.
#[derive(Debug)]
pub struct Simulator<S: Scene, M: Movement, R: Real> {
    maps: Maps,
    solids: Option<Arc<Solids>>,
    rules: Rules<R::Scalar>,
    arsenal: Arsenal<R::Scalar>,
    blocks: Vec<Body<S, R>>,
    count: usize,
    per_world: usize,
    threads: usize,
    /// Whether a step panicked half-way: better no bits than wrong ones.
    broken: bool,
    layout: String,
    movement: PhantomData<M>,
}

impl<S: Scene, M: Movement, R: Real> Simulator<S, M, R> {
    fn body(&self, index: usize) -> Body<S, R::Scalar> {
        self.blocks[index / R::LANES].lane(index % R::LANES)
    }

    fn bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        (0..self.count).for_each(|i| write_body(&self.body(i), true, &mut out));
        out
    }

    fn stage(&self) -> Stage<'_, R::Scalar> {
        Stage::new(&self.maps, self.solids.as_deref(), &self.rules, &self.arsenal)
    }

    fn refuse_broken(&self) -> Result<(), InputError> {
        if self.broken {
            refuse!("an earlier step of this simulator failed: restore a snapshot, or make a new one");
        }
        Ok(())
    }

    /// Players that a thread takes at a time: whole worlds, and whole blocks.
    fn piece(&self) -> usize {
        let whole = self.per_world * R::LANES;
        whole * PLAYERS.div_ceil(whole)
    }
}

/// Ticks of players who are alone in their worlds.
struct PlayAlone<'a, S: Scene, M: Movement, R: Real> {
    stage: &'a Stage<'a, R::Scalar>,
    blocks: &'a mut [Body<S, R>],
    raw: &'a [RawInput],
    ticks: u32,
    movement: PhantomData<M>,
}

impl<S: Scene, M: Movement, R: Real> Work for PlayAlone<'_, S, M, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let together = together::<R>();
        let mut inputs = [Input::idle(); MOST_BLOCKS];
        for (blocks, raw) in self.blocks.chunks_mut(together).zip(self.raw.chunks(together * R::LANES)) {
            for (input, raw) in inputs.iter_mut().zip(raw.chunks(R::LANES)) {
                *input = RawInput::pack::<R>(raw);
            }
            for _ in 0..self.ticks {
                self.stage.tick_alone::<S, M, R>(blocks, &inputs);
            }
        }
    }
}

/// Plays ticks of blocks that hold whole worlds.
fn play<S: Scene, M: Movement, R: Real>(
    stage: &Stage<'_, R::Scalar>,
    per_world: usize,
    blocks: &mut [Body<S, R>],
    raw: &[RawInput],
    ticks: u32,
) {
    let _floats = DefaultFloats::enter();
    if per_world == 1 {
        R::enter(PlayAlone::<S, M, R> { stage, blocks, raw, ticks, movement: PhantomData });
        return;
    }
    let mut stands: Vec<Stand> = Vec::with_capacity(per_world);
    for (world, raw) in raw.chunks(per_world).enumerate() {
        let at = |k: usize| ((world * per_world + k) / R::LANES, (world * per_world + k) % R::LANES);
        let inputs: Vec<Input<R::Scalar>> = raw.iter().map(|r| r.to_input()).collect();
        let mut bodies: Vec<_> = (0..per_world).map(|k| blocks[at(k).0].lane(at(k).1)).collect();
        (0..ticks).for_each(|_| stage.tick_world::<S, M>(&mut bodies, &inputs, &mut stands));
        bodies.iter().enumerate().for_each(|(k, body)| blocks[at(k).0].set_lane(at(k).1, body));
    }
}

impl<S: Scene, M: Movement, R: Real> Bodies for Simulator<S, M, R> {
    fn len(&self) -> usize {
        self.count
    }

    fn state_fields(&self) -> Vec<Field> {
        body_fields::<S, R::Scalar>(false)
    }

    fn player_bytes(&self) -> usize {
        size_of::<Body<S, R>>() / R::LANES
    }

    fn lanes(&self) -> usize {
        R::LANES
    }

    fn precision(&self) -> &'static str {
        if R::Scalar::DOUBLE { "float64" } else { "float32" }
    }

    fn scene(&self) -> &'static str {
        S::NAME
    }

    fn state(&self) -> Vec<u8> {
        self.write_states()
    }

    fn set_state(&mut self, indices: &[usize], states: &[u8]) -> Result<(), InputError> {
        self.read_states(indices, states)
    }

    fn explode(&mut self, points: &[[f64; 3]], weapon: &str) -> Result<(), InputError> {
        self.explode_all(points, weapon)
    }

    fn blasts(&self) -> Vec<Shot> {
        self.shots(crate::arms::BURST)
    }

    fn projectiles(&self) -> Vec<Shot> {
        self.shots(crate::arms::FLYING)
    }

    fn step(&mut self, inputs: &[RawInput], ticks: u32) -> Result<(), InputError> {
        self.refuse_broken()?;
        if inputs.len() != self.count {
            refuse!("inputs: expected {} rows, got {}", self.count, inputs.len());
        }
        RawInput::check_all(inputs)?;
        let crew = Crew::new(self.threads, self.count)?;
        let (per_world, piece) = (self.per_world, self.piece());
        let stage = Stage::new(&self.maps, self.solids.as_deref(), &self.rules, &self.arsenal);
        self.broken = true;
        let pieces = self.blocks.chunks_mut(piece / R::LANES).zip(inputs.chunks(piece));
        crew.share(pieces, |(blocks, raw)| {
            // A copy on each thread's own stack: the caller writes beside his all the time, and whoever
            // reads a line that another writes waits for it.
            let own = stage;
            play::<S, M, R>(&own, per_world, blocks, raw, ticks);
        });
        self.broken = false;
        Ok(())
    }

    fn snapshot(&self) -> Vec<u8> {
        snapshot::seal(&self.layout, self.count, &self.bytes())
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), InputError> {
        let body = snapshot::open(&self.layout, self.count, bytes)?;
        let stride = packed_bytes(&body_fields::<S, R::Scalar>(true));
        if body.len() != stride * self.count {
            refuse!("snapshot: expected {} bytes of players, got {}", stride * self.count, body.len());
        }
        for (i, bytes) in body.chunks_exact(stride).enumerate() {
            let mut body = self.body(i);
            read_body(&mut body, true, bytes);
            self.blocks[i / R::LANES].set_lane(i % R::LANES, &body);
        }
        self.broken = false;
        Ok(())
    }

    fn digest(&self) -> String {
        format!("{:032x}", xxhash_rust::xxh3::xxh3_128(&self.bytes()))
    }
}
