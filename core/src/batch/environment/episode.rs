//! One environment's episode: how it begins, and its bytes.

use super::*;

/// Where an environment is in its life.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u8)]
pub(super) enum Phase {
    /// It never had a seed.
    #[default]
    Unseeded = 0,
    /// An episode is under way.
    Running = 1,
    /// Its episode ended by arrival or death, and the next has not begun.
    Terminated = 2,
    /// Its episode ended by the clock, and the next has not begun.
    Truncated = 3,
}

/// What is kept of an episode beside the player and the run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Episode {
    pub(super) seed: u64,
    pub(super) episode: u64,
    pub(super) map: u32,
    pub(super) phase: Phase,
    /// Horizontal distance to the beacon at the last decision, m.
    pub(super) distance: f64,
    pub(super) start_distance: f64,
    pub(super) total_reward: f64,
    pub(super) length: i64,
}

/// The episodes of some lanes, field by field: a step reads and writes those of all lanes at once.
#[derive(Clone, Copy)]
pub(super) struct Episodes<R: Real> {
    seed: R::Each<u64>,
    episode: R::Each<u64>,
    pub(super) map: R::Each<u32>,
    pub(super) phase: R::Each<Phase>,
    pub(super) distance: R::Each<f64>,
    start_distance: R::Each<f64>,
    pub(super) total_reward: R::Each<f64>,
    pub(super) length: R::Each<i64>,
}

impl<R: Real> Episodes<R> {
    /// None has begun.
    pub(super) fn none() -> Self {
        Self {
            seed: R::every(0),
            episode: R::every(0),
            map: R::every(0),
            phase: R::every(Phase::default()),
            distance: R::every(0.0),
            start_distance: R::every(0.0),
            total_reward: R::every(0.0),
            length: R::every(0),
        }
    }

    pub(super) fn lane(&self, lane: usize) -> Episode {
        Episode {
            seed: self.seed.as_ref()[lane],
            episode: self.episode.as_ref()[lane],
            map: self.map.as_ref()[lane],
            phase: self.phase.as_ref()[lane],
            distance: self.distance.as_ref()[lane],
            start_distance: self.start_distance.as_ref()[lane],
            total_reward: self.total_reward.as_ref()[lane],
            length: self.length.as_ref()[lane],
        }
    }

    pub(super) fn set_lane(&mut self, lane: usize, e: &Episode) {
        self.seed.as_mut()[lane] = e.seed;
        self.episode.as_mut()[lane] = e.episode;
        self.map.as_mut()[lane] = e.map;
        self.phase.as_mut()[lane] = e.phase;
        self.distance.as_mut()[lane] = e.distance;
        self.start_distance.as_mut()[lane] = e.start_distance;
        self.total_reward.as_mut()[lane] = e.total_reward;
        self.length.as_mut()[lane] = e.length;
    }

    /// Which lanes are in a phase.
    #[inline(always)]
    pub(super) fn are(&self, phase: Phase) -> R::Mask {
        let mut mask = R::Mask::splat(false);
        for lane in 0..R::LANES {
            mask.set_lane(lane, self.phase.as_ref()[lane] == phase);
        }
        mask
    }
}

/// An episode about to be put into its block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Begun<S: Scene, T: Scalar> {
    pub(super) player: Player<S, T>,
    pub(super) run: Run<T>,
    pub(super) episode: Episode,
}

/// Draws an environment's episode and sets it up.
pub(super) fn begin<S: Scene, T: Scalar>(
    setup: &SkiEnvironments,
    rules: &Rules<T>,
    seed: u64,
    number: u64,
    request: &CourseRequest,
) -> Result<Begun<S, T>, InputError> {
    let maps = &setup.maps;
    let named = |name: &str, e: InputError| InputError(format!("{name}: {e}"));
    // Before anything is drawn from them, so that the one at fault is named.
    for (name, place) in [("start", request.start), ("goal", request.goal)] {
        if let Some(place) = place {
            maps.to_local(place.extend(0.0)).map_err(|e| named(name, e))?;
        }
    }
    let task = &setup.task;
    let course = draw_course(seed, number, &setup.areas, task.goal_distance, task.start_speed, request)?;
    let surface = maps.surface::<T>();
    let map = maps.offset(course.map);
    let t = T::from_f64;

    let (start, tile) =
        maps.to_local(course.start.extend(course.height.unwrap_or(0.0))).map_err(|e| named("start", e))?;
    let ground = surface.ground::<T>(map, t(start.x), t(start.y));
    // A start that is drawn lies on the map, and at most rounding puts it on the rim.
    let asked = request.start.is_some() || request.goal.is_some();
    if asked && !ground.exists && course.height.is_none() {
        refuse!("start: expected a place with ground below it, got ({}, {})", course.start.x, course.start.y);
    }
    let z = if course.height.is_some() { t(start.z) } else { ground.height };
    let mut player = Player::<S, T>::new(rules, V3::new(t(start.x), t(start.y), z), map);
    (player.tile_x, player.tile_y) = (tile.x, tile.y);
    player.yaw = crate::tick::wrap_angle(t(course.yaw));
    player.velocity = V3::new(t(course.velocity.x), t(course.velocity.y), T::zero());

    let (goal, goal_tile) = maps.to_local(course.goal.extend(0.0)).map_err(|e| named("goal", e))?;
    let there = surface.ground::<T>(map, t(goal.x), t(goal.y));
    let height = if there.exists { there.height } else { t(maps.range(course.map).0) };
    let mut run = Run::<T>::idle();
    run.goal = V3::new(t(goal.x), t(goal.y), height);
    run.goal_tile = goal_tile.to_array();

    let distance = run.distance(&player, &surface).to_f64();
    let episode = Episode {
        seed,
        episode: number,
        map: course.map as u32,
        phase: Phase::Running,
        distance,
        start_distance: distance,
        total_reward: 0.0,
        length: 0,
    };
    Ok(Begun { player, run, episode })
}

/// Bytes of a run and an episode.
pub(super) const BYTES: usize = 5 * 8 + 3 * 4 + 8 + 8 + 4 + 1 + 3 * 8 + 8;

/// Appends a run and an episode, little-endian. Reals go as f64: exact for both tiers.
pub(super) fn write<T: Scalar>(run: &Run<T>, e: &Episode, out: &mut Vec<u8>) {
    for x in [run.goal.x, run.goal.y, run.goal.z, run.path, run.top_speed] {
        out.extend(x.to_f64().to_le_bytes());
    }
    for i in [run.goal_tile[0], run.goal_tile[1], run.ticks] {
        out.extend(i.to_le_bytes());
    }
    out.extend(e.seed.to_le_bytes());
    out.extend(e.episode.to_le_bytes());
    out.extend(e.map.to_le_bytes());
    out.push(e.phase as u8);
    for x in [e.distance, e.start_distance, e.total_reward] {
        out.extend(x.to_le_bytes());
    }
    out.extend(e.length.to_le_bytes());
}

/// Reads what [`write`] wrote.
///
/// # Panics
/// If there are fewer than [`BYTES`]: callers check.
pub(super) fn read<T: Scalar>(mut bytes: &[u8]) -> (Run<T>, Episode) {
    fn take<const N: usize>(bytes: &mut &[u8]) -> [u8; N] {
        let (head, rest) = bytes.split_first_chunk::<N>().expect("the caller checked the length");
        *bytes = rest;
        *head
    }
    let b = &mut bytes;
    let mut real = || T::from_f64(f64::from_le_bytes(take(b)));
    let goal = V3::new(real(), real(), real());
    let (path, top_speed) = (real(), real());
    let mut int = || i32::from_le_bytes(take(b));
    let goal_tile = [int(), int()];
    let ticks = int();
    let run = Run { goal, goal_tile, ticks, path, top_speed };
    let seed = u64::from_le_bytes(take(b));
    let episode = u64::from_le_bytes(take(b));
    let map = u32::from_le_bytes(take(b));
    let phase = match take::<1>(b)[0] {
        0 => Phase::Unseeded,
        1 => Phase::Running,
        2 => Phase::Terminated,
        _ => Phase::Truncated,
    };
    let mut number = || f64::from_le_bytes(take(b));
    let (distance, start_distance, total_reward) = (number(), number(), number());
    let length = i64::from_le_bytes(take(b));
    (run, Episode { seed, episode, map, phase, distance, start_distance, total_reward, length })
}
