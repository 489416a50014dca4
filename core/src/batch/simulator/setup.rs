//! What a simulator is made from, and the checks of it.

use super::super::pool::resolve_threads;
use super::super::stage::Body;
use super::{Bodies, Simulator};
use crate::armor::Armor;
use crate::arms::{Arms, Arsenal, WEAPONS, Weapon};
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::movement::{Anyway, Engine, Fast, Movement, Sliced, Swept};
use crate::player::Player;
#[cfg(target_arch = "x86_64")]
use crate::real::lanes::{F32x8, F32x16, Two};
use crate::real::lanes::{Width, lane_width};
use crate::real::{Int, Real, Scalar, V3};
use crate::rules::{Physics, Rules, named};
use crate::scene::{DiscJump, Group, Mission, Sandbox, Scene, Ski, scenes};
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
    /// Switches of the movement model.
    pub physics: Physics,
    /// Tick length, ms.
    pub tick_ms: u32,
    /// Threads; one per core where absent.
    pub threads: Option<usize>,
    /// Most players stepped side by side: 1, 8, 16, or 32 (two registers of 16). Where absent the environment
    /// variable `DISCJUMP_LANES` says, else processor and number of players: as many as gain time. No bit
    /// of any result depends on it. Only "authentic", "swept" and "fast" have lanes, and only where every
    /// player is alone in his world; only "authentic" in the ski scene has 32, the others take 16 then.
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
    /// Builds the simulator: every player fresh, at the map's centre, on the ground; where several
    /// share a world, in a row eastwards, 4 m apart.
    ///
    /// # Errors
    /// Names the argument that is out of range or unknown, with what was expected.
    pub fn build(&self) -> Result<Box<dyn Bodies>, InputError> {
        match self.scene {
            #[cfg(target_arch = "x86_64")]
            "ski" if self.fidelity == "authentic" && self.width()? == Width::ThirtyTwo => {
                self.kernel::<Ski, Sliced, Two<F32x16>>()
            }
            "ski" => self.tier::<Ski>(),
            "sandbox" => self.tier::<Sandbox>(),
            "disc_jump" => self.tier::<DiscJump>(),
            "mission" => self.tier::<Mission>(),
            other => {
                let names: Vec<_> = scenes().iter().map(|scene| format!("{:?}", scene.name)).collect();
                refuse!("scene: expected one of {}, got {other:?}", names.join(", "))
            }
        }
    }

    fn tier<S: Scene>(&self) -> Result<Box<dyn Bodies>, InputError> {
        match self.fidelity {
            "reference" => self.kernel::<S, Sliced, f64>(),
            "authentic" => self.side_by_side::<S, Sliced>(),
            "swept" => self.side_by_side::<S, Swept>(),
            "fast" => self.side_by_side::<S, Fast>(),
            "engine" => self.kernel::<S, Engine, f32>(),
            "anyway" => self.kernel::<S, Anyway, f32>(),
            other => refuse!(
                "fidelity: expected \"reference\", \"authentic\", \"swept\", \"fast\", \"engine\" or \"anyway\", \
                 got {other:?}"
            ),
        }
    }

    /// How many players a tier that has lanes steps side by side.
    fn width(&self) -> Result<Width, InputError> {
        if self.players_per_world > 1 {
            return Ok(Width::One);
        }
        lane_width(self.lanes, self.players)
    }

    /// The kernel of a tier that has lanes.
    fn side_by_side<S: Scene, M: Movement>(&self) -> Result<Box<dyn Bodies>, InputError> {
        match self.width()? {
            Width::One => self.kernel::<S, M, f32>(),
            #[cfg(target_arch = "x86_64")]
            Width::Eight => self.kernel::<S, M, F32x8>(),
            #[cfg(target_arch = "x86_64")]
            Width::Sixteen | Width::ThirtyTwo => self.kernel::<S, M, F32x16>(),
        }
    }

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

    fn kernel<S: Scene, M: Movement, R: Real>(&self) -> Result<Box<dyn Bodies>, InputError> {
        self.check()?;
        let armor = find_armor(self.armor)?;
        let weapon = find_weapon(self.weapon)?;
        let _floats = DefaultFloats::enter();
        let threads = resolve_threads(self.threads)?;
        let maps = Maps::new(core::slice::from_ref(self.terrain))?;
        let rules = Rules::<R::Scalar>::new(M::MODEL, armor, self.energy_pack, self.tick_ms, self.physics);
        let mut arsenal = Arsenal::<R::Scalar>::new(weapon, self.tick_ms, &self.physics);
        arsenal.ammo = self.ammo.unwrap_or(arsenal.ammo);
        let solids = if S::SOLIDS { self.solids.cloned() } else { None };
        if let Some(solids) = &solids
            && !R::Scalar::DOUBLE
        {
            let far = solids.farthest(maps.centre().extend(0.0));
            if far > FARTHEST_SOLID_F32 {
                refuse!(
                    "terrain.solids: in a float32 tier expected within {FARTHEST_SOLID_F32} m of the map's centre and of \
                     height 0 along each axis, got {far:.1} m; fidelity \"reference\" takes them"
                );
            }
        }
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
        if let Some(solids) = &solids {
            layout += &format!(", solids {:032x}", solids.digest());
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
            layout,
            movement: core::marker::PhantomData,
        }))
    }
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
