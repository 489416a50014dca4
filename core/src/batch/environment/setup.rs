//! What a batch of ski environments is made from, and the checks of it.

use super::super::simulator::{MAX_PLAYERS, check_tick, find_armor};
use super::{Autoreset, Batch, Environments};
use crate::error::{InputError, refuse};
use crate::movement::{Engine, Fast, Movement, Sliced, Swept};
use crate::observe::SkiObservation;
#[cfg(target_arch = "x86_64")]
use crate::real::lanes::{F32x8, F32x16};
use crate::real::lanes::{Width, lane_width};
use crate::rules::Physics;
use crate::scene::Ski;
use crate::task::{ActionKind, SkiTask};
use crate::terrain::mission::Area;
use crate::terrain::{Edge, Maps};
use glam::DVec2;
use std::sync::Arc;

/// Everything that a batch of ski environments is made from.
#[derive(Debug)]
pub struct SkiEnvironments {
    /// The pool of maps; batches may share one.
    pub maps: Arc<Maps>,
    /// The area of each map that episodes are drawn in.
    pub areas: Vec<Area>,
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
    pub task: SkiTask,
    /// Its actions.
    pub actions: ActionKind,
    /// Its observation.
    pub observation: SkiObservation,
    /// When ended episodes begin anew.
    pub autoreset: Autoreset,
    /// Threads; one per core where absent.
    pub threads: Option<usize>,
    /// Most environments stepped side by side: 1, 8, or 16, which 32 means too. Where absent the environment
    /// variable `DISCJUMP_LANES` says, else the processor: as many as it can. No bit of any result depends
    /// on it. "reference" and "engine" have no lanes. [`Environments::lanes`] says what is in use.
    pub lanes: Option<usize>,
}

impl SkiEnvironments {
    /// Builds the batch. Nothing is reset yet.
    ///
    /// # Errors
    /// Names the argument that is out of range or unknown, with what was expected.
    pub fn build(self) -> Result<Box<dyn Environments>, InputError> {
        self.check()?;
        match self.fidelity.as_str() {
            "reference" => Batch::<Ski, Sliced, f64>::boxed(self),
            "authentic" => self.side_by_side::<Sliced>(),
            "swept" => self.side_by_side::<Swept>(),
            "fast" => self.side_by_side::<Fast>(),
            "engine" => Batch::<Ski, Engine, f32>::boxed(self),
            other => refuse!(
                "fidelity: expected \"reference\", \"authentic\", \"swept\", \"fast\" or \"engine\", got {other:?}"
            ),
        }
    }

    /// The kernel of a tier that has lanes.
    fn side_by_side<M: Movement>(self) -> Result<Box<dyn Environments>, InputError> {
        match lane_width(self.lanes, self.count)? {
            Width::One => Batch::<Ski, M, f32>::boxed(self),
            #[cfg(target_arch = "x86_64")]
            Width::Eight => Batch::<Ski, M, F32x8>::boxed(self),
            #[cfg(target_arch = "x86_64")]
            // Two registers are slower here: observations are bound by work, not by waiting.
            Width::Sixteen | Width::ThirtyTwo => Batch::<Ski, M, F32x16>::boxed(self),
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
        for (k, area) in self.areas.iter().enumerate() {
            self.check_area(k, area)?;
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

    /// An episode drawn in a checked area can always begin: a batch begins them in the middle of a step.
    fn check_area(&self, k: usize, area: &Area) -> Result<(), InputError> {
        let (min, max) = (DVec2::from(area.min), DVec2::from(area.max));
        let far = DVec2::splat(self.task.goal_distance.1);
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
}
