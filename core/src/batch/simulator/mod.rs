//! A batch of players and nothing else: state in, ticks, state out.

mod kernels;
mod setup;
mod shots;
mod state;

pub use setup::{FARTHEST_SOLID_F32, MAX_PLAYERS, MAX_PLAYERS_PER_WORLD, SimulatorSetup};
pub(super) use setup::{check_near, check_tick, find_armor};
pub use shots::Shot;
pub use state::MAX_SPEED;

use super::alone::{MOST_BLOCKS, PLAYERS, together};
use super::codec::{body_fields, read_body, write_body};
use super::legal::{check_played, check_shots};
use super::neighbourhood::{Contact, Neighbourhood, Stand};
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
use crate::scene::{Group, Scene};
use crate::solids::Solids;
use crate::terrain::Maps;
use core::marker::PhantomData;
use core::ops::Range;
use std::cell::RefCell;
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
    fn step(&mut self, inputs: &[RawInput], ticks: u32) -> Result<(), InputError> {
        self.step_while(inputs, ticks, &mut || true)
    }
    /// The same, as long as `go_on`, asked on the caller's thread every few hundred players, says so.
    ///
    /// # Errors
    /// As [`Bodies::step`]; and if it was stopped half-way: then only a snapshot leads back.
    fn step_while(
        &mut self,
        inputs: &[RawInput],
        ticks: u32,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), InputError>;
    /// The contacts that a player would have in the next tick with these keys, in their order, the other
    /// players standing where they stand now.
    ///
    /// # Errors
    /// If there is no such player, or a key is out of range.
    fn contacts(&self, player: usize, input: &RawInput) -> Result<Vec<Contact>, InputError>;
    /// Whether no step ended half-way, so that there is something to read.
    ///
    /// # Errors
    /// If one did.
    fn whole(&self) -> Result<(), InputError>;
    /// Makes the next step panic half-way, as a defect would: for tests of what comes after.
    fn fail_next_step(&mut self);
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
    /// Goes back to a snapshot of this batch or of another one of the same arguments.
    ///
    /// # Errors
    /// If it is damaged, or of another layout or count; then nothing was changed.
    fn restore(&mut self, snapshot: &[u8]) -> Result<(), InputError>;
    /// Everything of one player, as bytes that [`Bodies::restore_one`] takes.
    ///
    /// # Errors
    /// If there is no such player.
    fn snapshot_one(&self, player: usize) -> Result<Vec<u8>, InputError>;
    /// Puts one player to where it, or another one of a batch of the same arguments, was.
    ///
    /// # Errors
    /// As [`Bodies::restore`], and if there is no such player; then nothing was changed.
    fn restore_one(&mut self, player: usize, snapshot: &[u8]) -> Result<(), InputError>;
    /// XXH3-128 of all players, as 32 hexadecimal digits.
    fn digest(&self) -> String;
}

/// A batch of players in one scene and tier.
#[derive(Debug)]
pub struct Simulator<S: Scene, M: Movement, R: Real> {
    maps: Maps,
    solids: Vec<Arc<Solids>>,
    rules: Rules<R::Scalar>,
    arsenal: Arsenal<R::Scalar>,
    blocks: Vec<Body<S, R>>,
    count: usize,
    per_world: usize,
    threads: usize,
    /// Whether a step panicked or was stopped half-way: better no bits than wrong ones.
    broken: bool,
    fail: bool,
    layout: String,
    movement: PhantomData<M>,
}

impl<S: Scene, M: Movement, R: Real> Simulator<S, M, R> {
    fn body(&self, index: usize) -> Body<S, R::Scalar> {
        self.blocks[index / R::LANES].lane(index % R::LANES)
    }

    fn bytes(&self, players: Range<usize>) -> Vec<u8> {
        let mut out = Vec::new();
        players.for_each(|i| write_body(&self.body(i), true, &mut out));
        out
    }

    fn stage(&self) -> Stage<'_, R::Scalar> {
        Stage::new(&self.maps, &self.solids, &self.rules, &self.arsenal)
    }

    fn refuse_broken(&self) -> Result<(), InputError> {
        if self.broken {
            refuse!(
                "an earlier step of this simulator ended half-way: restore a snapshot, or make a new one"
            );
        }
        Ok(())
    }

    fn check_index(&self, player: usize) -> Result<(), InputError> {
        if player >= self.count {
            refuse!("player: expected 0 to {}, got {player}", self.count - 1);
        }
        Ok(())
    }

    fn one_of(&self, player: usize) -> Result<Range<usize>, InputError> {
        self.check_index(player)?;
        Ok(player..player + 1)
    }

    fn sealed(&self, players: Range<usize>) -> Vec<u8> {
        snapshot::seal(&self.layout, players.len(), &self.bytes(players))
    }

    fn open(&mut self, players: Range<usize>, bytes: &[u8]) -> Result<(), InputError> {
        let stride = packed_bytes(&body_fields::<S, R::Scalar>(true));
        let body = snapshot::open(&self.layout, players.len(), stride, bytes)?;
        // A checksum tells damage, not what a stranger wrote: nobody is put back before all were looked at.
        let mut read = Vec::with_capacity(players.len());
        for (i, bytes) in players.clone().zip(body.chunks_exact(stride)) {
            let mut body = self.body(i);
            read_body(&mut body, true, bytes);
            let named = |e: InputError| e.of(format_args!("snapshot: player {i}"));
            check_played(&body.player, &self.maps, &self.rules).map_err(named)?;
            if let Some(arms) = body.arms.as_ref() {
                check_shots(arms, &self.maps).map_err(named)?;
            }
            read.push(body);
        }
        for (i, body) in players.zip(&read) {
            self.blocks[i / R::LANES].set_lane(i % R::LANES, body);
        }
        Ok(())
    }

    /// Players that a thread takes at a time: whole worlds, and whole blocks.
    fn piece(&self) -> usize {
        let whole = self.per_world * R::LANES;
        whole * PLAYERS.div_ceil(whole)
    }
}

/// Keys as inputs, side by side.
struct Pack<'a, R: Real> {
    inputs: &'a mut [Input<R>; MOST_BLOCKS],
    raw: &'a [RawInput],
}

impl<R: Real> Work for Pack<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (input, raw) in self.inputs.iter_mut().zip(self.raw.chunks(R::LANES)) {
            *input = RawInput::pack::<R>(raw);
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
        let together = together::<R>();
        let mut inputs = [Input::idle(); MOST_BLOCKS];
        for (blocks, raw) in blocks.chunks_mut(together).zip(raw.chunks(together * R::LANES)) {
            R::enter(Pack { inputs: &mut inputs, raw });
            stage.play_alone::<S, M, R>(blocks, &inputs, ticks);
        }
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

    fn step_while(
        &mut self,
        inputs: &[RawInput],
        ticks: u32,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), InputError> {
        self.refuse_broken()?;
        if inputs.len() != self.count {
            refuse!("inputs: expected {} rows, got {}", self.count, inputs.len());
        }
        RawInput::check_all(inputs)?;
        let crew = Crew::new(self.threads, self.count)?;
        let (per_world, piece) = (self.per_world, self.piece());
        let stage = Stage::new(&self.maps, &self.solids, &self.rules, &self.arsenal);
        self.broken = true;
        let fail = core::mem::take(&mut self.fail);
        let pieces = self.blocks.chunks_mut(piece / R::LANES).zip(inputs.chunks(piece));
        let work = |(blocks, raw): (&mut [Body<S, R>], &[RawInput])| {
            // A copy on each thread's own stack: the caller writes beside his all the time, and whoever
            // reads a line that another writes waits for it.
            let own = stage;
            play::<S, M, R>(&own, per_world, blocks, raw, ticks);
            assert!(!fail, "this step was made to fail");
        };
        self.broken = !crew.share(pieces, work, go_on);
        self.refuse_broken()
    }

    fn contacts(&self, player: usize, input: &RawInput) -> Result<Vec<Contact>, InputError> {
        self.refuse_broken()?;
        self.check_index(player)?;
        input.check(player)?;
        let _floats = DefaultFloats::enter();
        let (stage, log) = (self.stage(), RefCell::default());
        let (input, me) = (input.to_input(), player % self.per_world);
        let world = player - me..player - me + self.per_world;
        let stands: Vec<Stand> = world.map(|k| Stand::of(&self.body(k).player.place())).collect();
        let mut body = self.body(player);
        stage.aim(&mut body, &input);
        let world = Neighbourhood { log: Some(&log), ..stage.around(body.player.map, &stands, me) };
        stage.move_among::<S, M>(&mut body.player, &input, &world);
        Ok(log.into_inner())
    }

    fn whole(&self) -> Result<(), InputError> {
        self.refuse_broken()
    }

    fn fail_next_step(&mut self) {
        self.fail = true;
    }

    fn snapshot(&self) -> Vec<u8> {
        self.sealed(0..self.count)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), InputError> {
        self.open(0..self.count, bytes)?;
        self.broken = false;
        Ok(())
    }

    fn snapshot_one(&self, player: usize) -> Result<Vec<u8>, InputError> {
        Ok(self.sealed(self.one_of(player)?))
    }

    fn restore_one(&mut self, player: usize, bytes: &[u8]) -> Result<(), InputError> {
        self.refuse_broken()?;
        self.open(self.one_of(player)?, bytes)
    }

    fn digest(&self) -> String {
        format!("{:032x}", xxhash_rust::xxh3::xxh3_128(&self.bytes(0..self.count)))
    }
}
