//! What a batch of environments is made from, and the checks of it.

use super::super::simulator::{MAX_PLAYERS, check_tick, find_armor};
use super::{Autoreset, Batch, Environments};
use crate::error::{InputError, refuse};
use crate::movement::{Engine, Fast, Movement, Sliced, Swept};
use crate::observe::Observation;
#[cfg(target_arch = "x86_64")]
use crate::real::lanes::{F32x8, F32x16};
use crate::real::lanes::{Width, lane_width};
use crate::rules::Physics;
#[cfg(feature = "disc_jump")]
use crate::scene::DiscJump;
#[cfg(feature = "mission")]
use crate::scene::Mission;
use crate::scene::{Scene, Ski};
use crate::solids::Solids;
#[cfg(feature = "disc_jump")]
use crate::task::Marker;
#[cfg(feature = "mission")]
use crate::task::Stands;
use crate::task::{ActionKind, Beacon, Grounds, Kind, Level, Pitch, Reward, TaskRules};
use crate::terrain::mission::Area;
use crate::terrain::{Edge, Maps};
use glam::{DVec2, DVec3, IVec2};
use std::sync::Arc;

/// Everything that a batch of environments is made from.
#[derive(Debug)]
pub struct EnvironmentsSetup {
    /// The pool of maps; batches may share one.
    pub maps: Arc<Maps>,
    /// What kind of goal there is: which scene is played.
    pub grounds: Grounds,
    /// Where episodes take place on each map.
    pub pitches: Vec<Pitch>,
    /// What stands on each map, or nothing at all; only missions look at it.
    pub solids: Vec<Arc<Solids>>,
    /// Discs of a fresh player, where he has a launcher.
    pub ammo: i32,
    /// How many environments.
    pub count: usize,
    /// Tier: "reference", "authentic", "swept", "fast" or "engine".
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
    pub task: TaskRules,
    /// Its actions.
    pub actions: ActionKind,
    /// Its observation.
    pub observation: Observation,
    /// When ended episodes begin anew.
    pub autoreset: Autoreset,
    /// Threads; one per core where absent.
    pub threads: Option<usize>,
    /// Most environments stepped side by side: 1, 8, or 16, which 32 means too. Where absent the environment
    /// variable `DISCJUMP_LANES` says, else the processor: as many as it can. No bit of any result depends
    /// on it. "reference" and "engine" have no lanes. [`Environments::lanes`] says what is in use.
    pub lanes: Option<usize>,
}

impl EnvironmentsSetup {
    /// Builds the batch. Nothing is reset yet.
    ///
    /// # Errors
    /// Names the argument that is out of range or unknown, with what was expected.
    pub fn build(self) -> Result<Box<dyn Environments>, InputError> {
        self.check()?;
        match self.grounds {
            Grounds::Beacon => self.fused(),
            #[cfg(feature = "disc_jump")]
            Grounds::Marker => self.tier::<DiscJump, Marker>(),
            #[cfg(feature = "mission")]
            Grounds::Stands => self.tier::<Mission, Stands>(),
            #[cfg(not(all(feature = "disc_jump", feature = "mission")))]
            other => refuse!("grounds: expected those of a scene of this build, got {other:?}"),
        }
    }

    fn tier<S: Scene, K: Kind>(self) -> Result<Box<dyn Environments>, InputError> {
        match self.fidelity.as_str() {
            "reference" => Batch::<S, K, Sliced, f64>::boxed::<Sliced>(self),
            "authentic" => self.side_by_side::<S, K, Sliced, Sliced>(),
            "swept" => self.side_by_side::<S, K, Sliced, Swept>(),
            "fast" => self.side_by_side::<S, K, Sliced, Fast>(),
            "engine" => Batch::<S, K, Sliced, f32>::boxed::<Engine>(self),
            other => unknown(other),
        }
    }

    /// Skiers: a kernel for each tier.
    fn fused(self) -> Result<Box<dyn Environments>, InputError> {
        match self.fidelity.as_str() {
            "reference" => Batch::<Ski, Beacon, Sliced, f64>::boxed::<Sliced>(self),
            "authentic" => self.side_by_side::<Ski, Beacon, Sliced, Sliced>(),
            "swept" => self.side_by_side::<Ski, Beacon, Swept, Swept>(),
            "fast" => self.side_by_side::<Ski, Beacon, Fast, Fast>(),
            "engine" => Batch::<Ski, Beacon, Engine, f32>::boxed::<Engine>(self),
            other => unknown(other),
        }
    }

    /// The kernel of a tier that has lanes.
    fn side_by_side<S: Scene, K: Kind, M: Movement, P: Movement>(
        self,
    ) -> Result<Box<dyn Environments>, InputError> {
        match lane_width(self.lanes, self.count)? {
            Width::One => Batch::<S, K, M, f32>::boxed::<P>(self),
            #[cfg(target_arch = "x86_64")]
            Width::Eight => Batch::<S, K, M, F32x8>::boxed::<P>(self),
            #[cfg(target_arch = "x86_64")]
            // Two registers are slower here: observations are bound by work, not by waiting.
            Width::Sixteen | Width::ThirtyTwo => Batch::<S, K, M, F32x16>::boxed::<P>(self),
        }
    }

    fn check(&self) -> Result<(), InputError> {
        if !(1..=MAX_PLAYERS).contains(&self.count) {
            refuse!("num_envs: expected 1 to {MAX_PLAYERS}, got {}", self.count);
        }
        find_armor(&self.armor)?;
        lane_width(self.lanes, self.count)?;
        check_tick(self.tick_ms)?;
        let task = &self.task;
        if !(1..=1000).contains(&task.frame_skip) {
            refuse!("frame_skip: expected 1 to 1000 ticks, got {}", task.frame_skip);
        }
        if task.time_limit < 1 {
            refuse!("time_limit: expected at least one tick, got {}", task.time_limit);
        }
        if !(task.arrival_radius > 0.0 && task.arrival_radius <= 1000.0) {
            refuse!("arrival_radius: expected above 0 and up to 1000 m, got {}", task.arrival_radius);
        }
        if !(0..=1_000_000).contains(&self.ammo) {
            refuse!("ammo: expected 0 to 1000000, got {}", self.ammo);
        }
        if !(task.turn_rate > 0.0 && task.turn_rate <= crate::input::MAX_TURN_RATE) {
            refuse!("turn_rate: expected above 0 and up to 1000 rad/s, got {}", task.turn_rate);
        }
        let Reward { progress, time, arrival, death, climb } = task.reward;
        let reward = [progress, time, arrival, death, climb];
        if let Some(bad) = reward.iter().find(|w| w.is_nan() || w.abs() > 1e6) {
            refuse!("reward: expected finite weights within +-1e6, got {bad}");
        }
        if self.pitches.len() != self.maps.count() {
            refuse!("areas: expected {}, one per terrain, got {}", self.maps.count(), self.pitches.len());
        }
        if !self.solids.is_empty() && self.solids.len() != self.maps.count() {
            refuse!("solids: expected {}, one per terrain, got {}", self.maps.count(), self.solids.len());
        }
        if task.levels.is_empty() {
            refuse!("levels: expected at least one, got none");
        }
        task.levels.iter().try_for_each(|level| self.check_level(level))
    }

    fn check_level(&self, level: &Level) -> Result<(), InputError> {
        let (near, far) = level.goal_distance;
        let radius = self.task.arrival_radius;
        if !(near > radius && near <= far && far <= 1e6) {
            refuse!(
                "goal_distance: expected (near, far) with arrival_radius < near <= far <= 1e6 m, got ({near}, {far})"
            );
        }
        if !(0.0..=1000.0).contains(&level.start_speed) {
            refuse!("start_speed: expected 0 to 1000 m/s, got {}", level.start_speed);
        }
        if !(0.0..=1000.0).contains(&level.start_height) {
            refuse!("start_height: expected 0 to 1000 m, got {}", level.start_height);
        }
        if !(0.0..=1e6).contains(&level.aside) {
            refuse!("aside: expected 0 to 1e6 m, got {}", level.aside);
        }
        let diagonal = |area: &Area| (DVec2::from(area.max) - DVec2::from(area.min)).length();
        for (k, Pitch { area, stands }) in self.pitches.iter().enumerate() {
            self.check_area(k, area, level)?;
            if self.grounds != Grounds::Marker && diagonal(area) < near {
                refuse!(
                    "goal_distance: expected at most {:.1} m, the diagonal of the smallest terrain's area, got {near}",
                    diagonal(area)
                );
            }
            if self.grounds == Grounds::Stands {
                self.check_stands(k, stands, area)?;
            }
        }
        Ok(())
    }

    /// An episode drawn in a checked area can always begin: a batch begins them in the middle of a step.
    fn check_area(&self, k: usize, area: &Area, level: &Level) -> Result<(), InputError> {
        let (min, max) = (DVec2::from(area.min), DVec2::from(area.max));
        let far = DVec2::splat(level.goal_distance.1.max(level.aside));
        let within = [min - far, max + far].iter().all(|c| self.maps.to_local(c.extend(0.0)).is_ok());
        if !(min.cmple(max).all() && within) {
            refuse!(
                "areas[{k}]: expected min <= max, and beacons within 1e9 m and 1e9 tiles of the map, got {area:?}"
            );
        }
        let low = DVec2::from(self.maps.grid().origin);
        let high = low + self.maps.size();
        if self.maps.grid().edge == Edge::Void && !(low.cmple(min).all() && max.cmple(high).all()) {
            refuse!("areas[{k}]: on edge \"void\" expected within {low} to {high}, got {area:?}");
        }
        Ok(())
    }

    /// Flags stand in the area and on the first tile, apart.
    fn check_stands(&self, k: usize, stands: &[DVec3; 2], area: &Area) -> Result<(), InputError> {
        for stand in stands {
            let home = self.maps.to_local(*stand).is_ok_and(|(_, tile)| tile == IVec2::ZERO);
            if !(home && area.contains(stand.truncate().into())) {
                refuse!("flags: expected places within the area and on the map, got {stand} on terrain {k}");
            }
        }
        let (apart, radius) = ((stands[0] - stands[1]).length(), self.task.arrival_radius);
        if apart <= 2.0 * radius {
            refuse!("flags: expected more than {} m between them, got {apart} on terrain {k}", 2.0 * radius);
        }
        Ok(())
    }
}

fn unknown(fidelity: &str) -> Result<Box<dyn Environments>, InputError> {
    refuse!(
        "fidelity: expected \"reference\", \"authentic\", \"swept\", \"fast\" or \"engine\", got {fidelity:?}"
    )
}
