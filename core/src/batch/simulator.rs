//! A batch of players and nothing else: state in, ticks, state out.

use super::codec::{read_player, write_player, write_state};
use super::pool::{INLINE_BELOW, pool, resolve_threads};
use super::raw_input::RawInput;
use super::snapshot;
use crate::armor::Armor;
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::input::Input;
use crate::movement::{Anyway, Engine, Fast, Movement, Sliced, Swept};
use crate::player::{Field, OLDEST_MS, Player, fields, packed_bytes};
use crate::real::{Int, Real, Scalar, V3};
use crate::rules::{Physics, Rules};
use crate::scene::{Group, Sandbox, Scene, Ski};
use crate::terrain::{Heightfield, Maps};
use glam::DVec3;
use rayon::prelude::*;

/// Most players of one batch.
pub const MAX_PLAYERS: usize = 1 << 24;
/// Fastest player that `set_state` accepts, m/s.
pub const MAX_SPEED: f64 = 1e6;
/// Players stepped together by one task of the pool.
const CHUNK: usize = 64;

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
    /// What the scene models.
    fn models(&self) -> Vec<&'static str>;
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
    rules: Rules<R::Scalar>,
    blocks: Vec<Player<S, R>>,
    count: usize,
    threads: usize,
    /// Whether a step panicked half-way: better no bits than wrong ones.
    broken: bool,
    layout: String,
    movement: core::marker::PhantomData<M>,
}

impl<S: Scene, M: Movement, R: Real> Simulator<S, M, R> {
    fn player(&self, index: usize) -> Player<S, R::Scalar> {
        self.blocks[index / R::LANES].lane(index % R::LANES)
    }

    fn bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        (0..self.count).for_each(|i| write_player(&self.player(i), true, &mut out));
        out
    }
}

/// Everything that a simulator is made from.
#[derive(Clone, Copy, Debug)]
pub struct SimulatorSetup<'a> {
    /// The terrain.
    pub terrain: &'a Heightfield,
    /// How many players.
    pub players: usize,
    /// "ski" or "sandbox".
    pub scene: &'a str,
    /// "light", "medium" or "heavy".
    pub armor: &'a str,
    /// Whether the players wear an energy pack.
    pub energy_pack: bool,
    /// "reference", "authentic", "swept", "fast", "engine", or "anyway".
    pub fidelity: &'a str,
    /// Switches of the movement model.
    pub physics: Physics,
    /// Tick length, ms.
    pub tick_ms: u32,
    /// Threads; one per core where absent.
    pub threads: Option<usize>,
}

/// The armor of a public name.
///
/// # Errors
/// If there is none.
pub(super) fn find_armor(name: &str) -> Result<&'static Armor, InputError> {
    crate::armor::ARMORS.into_iter().find(|a| a.name == name).ok_or_else(|| {
        InputError(format!("armor: expected \"light\", \"medium\" or \"heavy\", got {name:?}"))
    })
}

/// Checks a tick length.
///
/// # Errors
/// If it is not 1 to 1000 ms.
pub(super) fn check_tick(tick_ms: u32) -> Result<(), InputError> {
    if !(1..=1000).contains(&tick_ms) {
        refuse!("tick_ms: expected 1 to 1000, got {tick_ms}");
    }
    Ok(())
}

impl SimulatorSetup<'_> {
    /// Builds the simulator: every player fresh, at the map's centre, on the ground.
    ///
    /// # Errors
    /// Names the argument that is out of range or unknown, with what was expected.
    pub fn build(&self) -> Result<Box<dyn Bodies>, InputError> {
        match self.scene {
            "ski" => self.tier::<Ski>(),
            "sandbox" => self.tier::<Sandbox>(),
            other => refuse!("scene: expected \"ski\" or \"sandbox\", got {other:?}"),
        }
    }

    fn tier<S: Scene>(&self) -> Result<Box<dyn Bodies>, InputError> {
        match self.fidelity {
            "reference" => self.kernel::<S, Sliced, f64>(),
            "authentic" => self.kernel::<S, Sliced, f32>(),
            "swept" => self.kernel::<S, Swept, f32>(),
            "fast" => self.kernel::<S, Fast, f32>(),
            "engine" => self.kernel::<S, Engine, f32>(),
            "anyway" => self.kernel::<S, Anyway, f32>(),
            other => refuse!(
                "fidelity: expected \"reference\", \"authentic\", \"swept\", \"fast\", \"engine\" or \"anyway\", \
                 got {other:?}"
            ),
        }
    }

    fn kernel<S: Scene, M: Movement, R: Real>(&self) -> Result<Box<dyn Bodies>, InputError> {
        if !(1..=MAX_PLAYERS).contains(&self.players) {
            refuse!("num_players: expected 1 to {MAX_PLAYERS}, got {}", self.players);
        }
        let armor = find_armor(self.armor)?;
        check_tick(self.tick_ms)?;
        let _floats = DefaultFloats::enter();
        let threads = resolve_threads(self.threads)?;
        let maps = Maps::new(core::slice::from_ref(self.terrain))?;
        let rules = Rules::new(M::MODEL, armor, self.energy_pack, self.tick_ms, self.physics);
        let zero = R::zero();
        let ground = maps.surface::<R::Scalar>().ground::<R>(R::Int::splat(0), zero, zero).height;
        let fresh = Player::new(&rules, V3::new(zero, zero, ground), R::Int::splat(0));
        let layout = format!(
            "scene {}, fidelity {}, armor {}, energy_pack {}, {:?}, tick_ms {}, terrain {}",
            S::NAME,
            self.fidelity,
            armor.name,
            self.energy_pack,
            self.physics,
            self.tick_ms,
            self.terrain.digest()
        );
        Ok(Box::new(Simulator::<S, M, R> {
            maps,
            rules,
            blocks: vec![fresh; self.players.div_ceil(R::LANES)],
            count: self.players,
            threads,
            broken: false,
            layout,
            movement: core::marker::PhantomData,
        }))
    }
}

impl<S: Scene, M: Movement, R: Real> Bodies for Simulator<S, M, R> {
    fn len(&self) -> usize {
        self.count
    }

    fn state_fields(&self) -> Vec<Field> {
        fields::<S, R::Scalar>(false)
    }

    fn player_bytes(&self) -> usize {
        size_of::<Player<S, R>>() / R::LANES
    }

    fn models(&self) -> Vec<&'static str> {
        S::models()
    }

    fn state(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.count * self.state_bytes());
        for i in 0..self.count {
            write_state(&self.maps, &self.player(i), &mut out);
        }
        out
    }

    fn set_state(&mut self, indices: &[usize], states: &[u8]) -> Result<(), InputError> {
        let _floats = DefaultFloats::enter();
        let stride = self.state_bytes();
        if states.len() != indices.len() * stride {
            refuse!("state: expected {} states of {stride} bytes, got {} bytes", indices.len(), states.len());
        }
        if let Some(i) = indices.iter().find(|&&i| i >= self.count) {
            refuse!("indices: expected 0 to {}, got {i}", self.count - 1);
        }
        let mut decoded = Vec::with_capacity(indices.len());
        for (row, bytes) in states.chunks_exact(stride).enumerate() {
            let mut p = self.player(indices[row]);
            let number = |k: usize| f64::from_le_bytes(bytes[8 * k..8 * k + 8].try_into().expect("8 bytes"));
            let world = DVec3::new(number(0), number(1), number(2));
            let (place, tile) =
                self.maps.to_local(world).map_err(|e| InputError(format!("state[{row}].{e}")))?;
            let t = <R::Scalar as Scalar>::from_f64;
            p.position = V3::new(t(place.x), t(place.y), t(place.z));
            (p.tile_x, p.tile_y) = (tile.x, tile.y);
            read_player(&mut p, false, &bytes[24..]);
            check_player(&mut p, &self.rules, row)?;
            decoded.push(p);
        }
        for (&i, p) in indices.iter().zip(&decoded) {
            self.blocks[i / R::LANES].set_lane(i % R::LANES, p);
        }
        Ok(())
    }

    fn step(&mut self, inputs: &[RawInput], ticks: u32) -> Result<(), InputError> {
        if self.broken {
            refuse!("an earlier step of this simulator failed: restore a snapshot, or make a new one");
        }
        if inputs.len() != self.count {
            refuse!("inputs: expected {} rows, got {}", self.count, inputs.len());
        }
        inputs.iter().enumerate().try_for_each(|(i, input)| input.check(i))?;
        let surface = self.maps.surface::<R::Scalar>();
        let rules = &self.rules;
        let play = |(blocks, inputs): (&mut [Player<S, R>], &[RawInput])| {
            let _floats = DefaultFloats::enter();
            for (block, raw) in blocks.iter_mut().zip(inputs.chunks(R::LANES)) {
                let mut input = Input::<R>::idle();
                raw.iter().enumerate().for_each(|(lane, r)| input.set_lane(lane, &r.to_input()));
                for _ in 0..ticks {
                    let mut p = crate::tick::tick::<S, M, R, _>(block, &input, &surface, rules);
                    (p.position.x, p.position.y, p.tile_x, p.tile_y) =
                        surface.wrap::<R>(p.position.x, p.position.y, p.tile_x, p.tile_y);
                    *block = p;
                }
            }
        };
        let per_task = CHUNK.div_ceil(R::LANES);
        let pool =
            if self.threads == 1 || self.count < INLINE_BELOW { None } else { Some(pool(self.threads)?) };
        self.broken = true;
        match pool {
            None => play((&mut self.blocks, inputs)),
            Some(pool) => {
                let chunks = self.blocks.par_chunks_mut(per_task).zip(inputs.par_chunks(per_task * R::LANES));
                pool.install(|| chunks.for_each(play));
            }
        }
        self.broken = false;
        Ok(())
    }

    fn snapshot(&self) -> Vec<u8> {
        snapshot::seal(&self.layout, self.count, &self.bytes())
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), InputError> {
        let body = snapshot::open(&self.layout, self.count, bytes)?;
        let stride = packed_bytes(&fields::<S, R::Scalar>(true));
        if body.len() != stride * self.count {
            refuse!("snapshot: expected {} bytes of players, got {}", stride * self.count, body.len());
        }
        for (i, bytes) in body.chunks_exact(stride).enumerate() {
            let mut p = self.player(i);
            read_player(&mut p, true, bytes);
            self.blocks[i / R::LANES].set_lane(i % R::LANES, &p);
        }
        self.broken = false;
        Ok(())
    }

    fn digest(&self) -> String {
        format!("{:032x}", xxhash_rust::xxh3::xxh3_128(&self.bytes()))
    }
}

/// Refuses a state that the physics could not go on from.
fn check_player<S: Scene, T: Scalar>(
    p: &mut Player<S, T>,
    rules: &Rules<T>,
    row: usize,
) -> Result<(), InputError> {
    let v = [p.velocity.x, p.velocity.y, p.velocity.z];
    if v.iter().any(|x| !x.finite() || x.to_f64().abs() > MAX_SPEED) {
        refuse!("state[{row}].velocity: expected finite numbers within +-{MAX_SPEED} m/s, got {v:?}");
    }
    for (name, angle) in [("yaw", p.yaw), ("pitch", p.pitch)] {
        if !angle.finite() || angle.to_f64().abs() > 1e6 {
            refuse!("state[{row}].{name}: expected a finite angle within +-1e6 rad, got {angle:?}");
        }
    }
    p.yaw = crate::tick::wrap_angle(p.yaw);
    let range = |name: &str, x: T, low: f64, high: f64| {
        if x.finite() && (low..=high).contains(&x.to_f64()) {
            return Ok(());
        }
        Err(InputError(format!("state[{row}].{name}: expected {low} to {high}, got {x:?}")))
    };
    range("friction", p.friction, 0.0, 1.0)?;
    range("energy", p.energy.get(T::zero()), 0.0, rules.max_energy.to_f64())?;
    range("damage", p.damage.get(T::zero()), 0.0, 1e9)?;
    let contact = p.contact();
    if !(0..=OLDEST_MS).contains(&contact.age) {
        refuse!("state[{row}].jump_age: expected 0 to {OLDEST_MS} ms, got {}", contact.age);
    }
    let length = contact.normal.length();
    if !length.finite() || (length.to_f64() - 1.0).abs() > 1e-3 {
        refuse!("state[{row}].jump_normal: expected length 1, got {:?}", contact.normal);
    }
    Ok(())
}
