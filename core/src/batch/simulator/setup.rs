//! What a simulator is made from, and the checks of it.

use super::super::pool::resolve_threads;
use super::super::stage::Body;
use super::kernels::REFERENCE;
use super::{Bodies, Simulator};
use crate::armor::Armor;
use crate::arms::{Arms, Arsenal, WEAPONS, Weapon};
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::movement::Movement;
use crate::player::Player;
use crate::real::lanes::lane_width;
use crate::real::{Int, Real, Scalar, V3};
use crate::rules::{Physics, Rules, named};
use crate::scene::{Group, Scene};
use crate::solids::Solids;
use crate::terrain::{Heightfield, Maps};
use glam::{DVec3, IVec2};
use std::sync::Arc;

/// Most players of one batch.
pub const MAX_PLAYERS: usize = 1 << 24;
/// Most players of one world: each looks at all others in every move.
pub const MAX_PLAYERS_PER_WORLD: usize = 256;
/// Farthest from the map's centre, or up or down, that solids may stand for players in f32, m: beyond
/// it the rounding of a position outgrows the outward push, and carries players into faces.
pub const FARTHEST_SOLID_F32: f64 = 2048.0;
/// Distance between the first places of two players of one world, m: out of each other's way.
const APART: f64 = 4.0;

/// Everything that a simulator is made from.
#[derive(Clone, Copy, Debug)]
pub struct SimulatorSetup<'a> {
    /// The terrain.
    pub terrain: &'a Heightfield,
    /// What stands on it; only scenes that model solids look at it.
    pub solids: Option<&'a Arc<Solids>>,
    /// How many players.
    pub players: usize,
    /// How many of them share a world: players 0 to n - 1 the first one, and so on.
    pub players_per_world: usize,
    /// "ski", "sandbox", "disc_jump" or "mission".
    pub scene: &'a str,
    /// "light", "medium" or "heavy".
    pub armor: &'a str,
    /// Whether the players wear an energy pack.
    pub energy_pack: bool,
    /// "disc", "grenade" or "mortar".
    pub weapon: &'a str,
    /// Shots of a fresh player; the weapon's own number where absent.
    pub ammo: Option<i32>,
    /// "reference", "authentic", "swept", "fast", "engine", or "anyway".
    pub fidelity: &'a str,
    /// "float32" or "float64"; the tier's own where absent: float64 in "reference", which has no other, float32
    /// elsewhere. "reference" is "authentic" in float64.
    pub precision: Option<&'a str>,
    /// Switches of the movement model.
    pub physics: Physics,
    /// Tick length, ms.
    pub tick_ms: u32,
    /// Threads; one per core where absent.
    pub threads: Option<usize>,
    /// Most players stepped side by side: 1, 8, 16, or 32 (two registers of 16). Where absent the environment
    /// variable `DISCJUMP_LANES` says, else processor and number of players: as many as gain time. No bit
    /// of any result depends on it. Only "authentic", "swept" and "fast" in float32 have lanes, and only where
    /// every player is alone in his world; only "authentic" in the ski scene has 32, the others take 16 then.
    /// [`Bodies::lanes`] says what is in use.
    pub lanes: Option<usize>,
}

/// The armor of a public name.
///
/// # Errors
/// If there is none.
pub(in super::super) fn find_armor(name: &str) -> Result<&'static Armor, InputError> {
    named("armor", name, &crate::armor::ARMORS.map(|armor| (armor.name, armor)))
}

/// The weapon of a public name.
///
/// # Errors
/// If there is none.
pub(super) fn find_weapon(name: &str) -> Result<&'static Weapon, InputError> {
    named("weapon", name, &WEAPONS.map(|weapon| (weapon.name, weapon)))
}

/// Checks a tick length.
///
/// # Errors
/// If it is not 1 to 1000 ms.
pub(in super::super) fn check_tick(tick_ms: u32) -> Result<(), InputError> {
    if !(1..=1000).contains(&tick_ms) {
        refuse!("tick_ms: expected 1 to 1000, got {tick_ms}");
    }
    Ok(())
}

impl SimulatorSetup<'_> {
    fn check(&self) -> Result<(), InputError> {
        if !(1..=MAX_PLAYERS).contains(&self.players) {
            refuse!("num_players: expected 1 to {MAX_PLAYERS}, got {}", self.players);
        }
        let several = self.players_per_world;
        if !(1..=MAX_PLAYERS_PER_WORLD).contains(&several) || !self.players.is_multiple_of(several) {
            refuse!(
                "players_per_world: expected 1 to {MAX_PLAYERS_PER_WORLD}, a divisor of num_players ({}), got {several}",
                self.players
            );
        }
        if let Some(ammo) = self.ammo
            && !(0..=1_000_000).contains(&ammo)
        {
            refuse!("ammo: expected 0 to 1000000, got {ammo}");
        }
        lane_width(self.lanes, self.players)?;
        check_tick(self.tick_ms)
    }

    pub(super) fn kernel<S: Scene, M: Movement, R: Real>(&self) -> Result<Box<dyn Bodies>, InputError> {
        self.check()?;
        let armor = find_armor(self.armor)?;
        let weapon = find_weapon(self.weapon)?;
        let _floats = DefaultFloats::enter();
        let threads = resolve_threads(self.threads)?;
        let maps = Maps::new(core::slice::from_ref(self.terrain))?;
        let rules = Rules::<R::Scalar>::new(M::MODEL, armor, self.energy_pack, self.tick_ms, self.physics);
        let mut arsenal = Arsenal::<R::Scalar>::new(weapon, self.tick_ms, &self.physics);
        arsenal.ammo = self.ammo.unwrap_or(arsenal.ammo);
        let solids: Vec<_> = self.solids.filter(|_| S::SOLIDS).cloned().into_iter().collect();
        check_near::<R>(&solids, &maps)?;
        let mut layout = format!(
            "scene {}, fidelity {}, armor {}, energy_pack {}, {:?}, tick_ms {}, terrain {}, players_per_world {}",
            S::NAME,
            self.fidelity,
            armor.name,
            self.energy_pack,
            self.physics,
            self.tick_ms,
            self.terrain.digest(),
            self.players_per_world,
        );
        if S::Arms::<R>::MODELED {
            layout += &format!(", weapon {}, ammo {}", weapon.name, arsenal.ammo);
        }
        for solids in &solids {
            layout += &format!(", solids {:032x}", solids.digest());
        }
        // A tier's own precision is not told: the layouts of snapshots that never had a choice stay theirs.
        if R::Scalar::DOUBLE && self.fidelity != REFERENCE {
            layout += ", precision float64";
        }
        let fresh = (0..self.players).map(|i| {
            let player = fresh::<S, R::Scalar>(&maps, &rules, i % self.players_per_world);
            Body { player, arms: Group::new(Arms::new(&arsenal)) }
        });
        let idle = Body::<S, R> {
            player: Player::new(&rules, V3::zero(), R::Int::splat(0)),
            arms: Group::new(Arms::new(&arsenal)),
        };
        let mut blocks = vec![idle; self.players.div_ceil(R::LANES)];
        fresh.enumerate().for_each(|(i, body)| blocks[i / R::LANES].set_lane(i % R::LANES, &body));
        Ok(Box::new(Simulator::<S, M, R> {
            maps,
            solids,
            rules,
            arsenal,
            blocks,
            count: self.players,
            per_world: self.players_per_world,
            threads,
            broken: false,
            fail: false,
            layout,
            movement: core::marker::PhantomData,
        }))
    }
}

/// Checks that no solid is too far away for the arithmetic.
///
/// # Errors
/// If one is.
pub(in super::super) fn check_near<R: Real>(solids: &[Arc<Solids>], maps: &Maps) -> Result<(), InputError> {
    let from = maps.centre().extend(0.0);
    let far = solids.iter().map(|solids| solids.farthest(from)).fold(0.0, f64::max);
    if far > FARTHEST_SOLID_F32 && !R::Scalar::DOUBLE {
        refuse!(
            "terrain.solids: in float32 expected within {FARTHEST_SOLID_F32} m of the map's centre and of height 0 \
             along each axis, got {far:.1} m; fidelity \"reference\" and precision \"float64\" take them"
        );
    }
    Ok(())
}

/// Player `k` of a world at his first place.
fn fresh<S: Scene, T: Scalar>(maps: &Maps, rules: &Rules<T>, k: usize) -> Player<S, T> {
    let t = T::from_f64;
    let local = DVec3::new(APART * k as f64, 0.0, 0.0);
    let world = maps.to_world(local, IVec2::ZERO);
    // Beyond the rim of a small map the place is a local one of another tile.
    let (local, tile) = maps.to_local(world).unwrap_or((local, IVec2::ZERO));
    let (x, y) = (t(local.x), t(local.y));
    let ground = maps.surface::<T>().ground::<T>(0, x, y);
    let mut p = Player::new(rules, V3::new(x, y, ground.height), 0);
    (p.tile_x, p.tile_y) = (tile.x, tile.y);
    p
}
