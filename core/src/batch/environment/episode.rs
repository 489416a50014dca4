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
    /// What was left to be done at the last decision, m: see [`Run::left`].
    pub(super) left: f64,
    pub(super) start_distance: f64,
    pub(super) total_reward: f64,
    pub(super) length: i64,
    /// Height of the goal over the start, m.
    pub(super) rise: f64,
    /// Which of the task's levels it was drawn from.
    pub(super) level: u32,
    /// Successes in a row, or failures, below 0, of this environment on its level.
    pub(super) streak: i32,
}

/// Level and streak of an environment's next episode, of so many levels, after one that succeeded or failed.
pub(super) fn promoted(level: u32, streak: i32, success: bool, levels: usize) -> (u32, i32) {
    let streak = if success { streak.max(0) + 1 } else { streak.min(0) - 1 };
    let last = levels as u32 - 1;
    if streak >= STREAK && level < last {
        return (level + 1, 0);
    }
    if streak <= -STREAK && level > 0 {
        return (level - 1, 0);
    }
    (level, Ord::clamp(streak, -STREAK, STREAK))
}

/// The episodes of some lanes, field by field: a step reads and writes those of all lanes at once.
#[derive(Clone, Copy)]
pub(super) struct Episodes<R: Real> {
    seed: R::Each<u64>,
    episode: R::Each<u64>,
    pub(super) map: R::Each<u32>,
    pub(super) phase: R::Each<Phase>,
    pub(super) left: R::Each<f64>,
    start_distance: R::Each<f64>,
    pub(super) total_reward: R::Each<f64>,
    pub(super) length: R::Each<i64>,
    rise: R::Each<f64>,
    level: R::Each<u32>,
    streak: R::Each<i32>,
}

impl<R: Real> Episodes<R> {
    /// None has begun.
    pub(super) fn none() -> Self {
        Self {
            seed: R::every(0),
            episode: R::every(0),
            map: R::every(0),
            phase: R::every(Phase::default()),
            left: R::every(0.0),
            start_distance: R::every(0.0),
            total_reward: R::every(0.0),
            length: R::every(0),
            rise: R::every(0.0),
            level: R::every(0),
            streak: R::every(0),
        }
    }

    pub(super) fn lane(&self, lane: usize) -> Episode {
        Episode {
            seed: self.seed.as_ref()[lane],
            episode: self.episode.as_ref()[lane],
            map: self.map.as_ref()[lane],
            phase: self.phase.as_ref()[lane],
            left: self.left.as_ref()[lane],
            start_distance: self.start_distance.as_ref()[lane],
            total_reward: self.total_reward.as_ref()[lane],
            length: self.length.as_ref()[lane],
            rise: self.rise.as_ref()[lane],
            level: self.level.as_ref()[lane],
            streak: self.streak.as_ref()[lane],
        }
    }

    pub(super) fn set_lane(&mut self, lane: usize, e: &Episode) {
        self.seed.as_mut()[lane] = e.seed;
        self.episode.as_mut()[lane] = e.episode;
        self.map.as_mut()[lane] = e.map;
        self.phase.as_mut()[lane] = e.phase;
        self.left.as_mut()[lane] = e.left;
        self.start_distance.as_mut()[lane] = e.start_distance;
        self.total_reward.as_mut()[lane] = e.total_reward;
        self.length.as_mut()[lane] = e.length;
        self.rise.as_mut()[lane] = e.rise;
        self.level.as_mut()[lane] = e.level;
        self.streak.as_mut()[lane] = e.streak;
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
pub(super) struct Begun<S: Scene, K: Kind, T: Scalar> {
    pub(super) body: Body<S, T>,
    pub(super) run: Run<K, T>,
    pub(super) episode: Episode,
}

/// Which episode: seed and number, and the environment's level and streak.
#[derive(Clone, Copy, Debug)]
pub(super) struct Next {
    pub(super) seed: u64,
    pub(super) number: u64,
    pub(super) level: u32,
    pub(super) streak: i32,
}

impl Next {
    /// The first one of a seed.
    pub(super) fn first(seed: u64) -> Self {
        Self { seed, number: 0, level: 0, streak: 0 }
    }

    /// The one after another, which counts as a failure if it is not over.
    pub(super) fn after(old: &Episode, success: bool, levels: usize) -> Self {
        let (level, streak) = promoted(old.level, old.streak, success, levels);
        Self { seed: old.seed, number: old.episode + 1, level, streak }
    }
}

/// Draws an environment's episode and sets it up.
pub(super) fn begin<S: Scene, K: Kind, T: Scalar>(
    setup: &EnvironmentsSetup,
    (rules, arsenal): (&Rules<T>, &Arsenal<T>),
    next: Next,
    request: &CourseRequest,
) -> Result<Begun<S, K, T>, InputError> {
    let maps = &setup.maps;
    let named = |name: &str, e: InputError| InputError(format!("{name}: {e}"));
    // Before anything is drawn from them, so that the one at fault is named.
    for (name, place) in [("start", request.start), ("goal", request.goal)] {
        if let Some(place) = place {
            maps.to_local(place.extend(0.0)).map_err(|e| named(name, e))?;
        }
    }
    let Next { seed, number, level, streak } = next;
    let drawn_from = &setup.task.levels[level as usize];
    let course = draw_course(seed, number, setup.grounds, &setup.pitches, drawn_from, request)?;
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
    let z = match course.height {
        Some(_) => t(start.z),
        None => {
            let below = top(setup, course.map, course.start, ground.height.to_f64()).map_or(ground.height, t);
            if course.above == 0.0 { below } else { below + t(course.above) }
        }
    };
    let mut player = Player::<S, T>::new(rules, V3::new(t(start.x), t(start.y), z), map);
    (player.tile_x, player.tile_y) = (tile.x, tile.y);
    player.yaw = crate::tick::wrap_angle(t(course.yaw));
    player.velocity = V3::new(t(course.velocity.x), t(course.velocity.y), T::zero());

    let goal = course.goal.extend(course.goal_height.unwrap_or(0.0));
    let (goal, goal_tile) = maps.to_local(goal).map_err(|e| named("goal", e))?;
    let mut run = Run::<K, T>::idle();
    let height = if !K::ALOFT {
        let there = surface.ground::<T>(map, t(goal.x), t(goal.y));
        if there.exists { there.height } else { t(maps.range(course.map).0) }
    } else if course.goal_height.is_some() {
        t(goal.z)
    } else {
        let below = if ground.exists { ground.height } else { t(maps.range(course.map).0) };
        below + t(course.rise)
    };
    run.goal = V3::new(t(goal.x), t(goal.y), height);
    run.goal_tile = goal_tile.to_array();
    if let Some(flag) = run.flag.as_mut() {
        let Pitch { area, stands } = setup.pitches[course.map];
        let (home, _) = maps.to_local(stands[course.team]).map_err(|e| named("flags", e))?;
        flag.enemy = run.goal;
        flag.home = V3::new(t(home.x), t(home.y), t(home.z));
        let centre = maps.centre();
        let side = |x: f64, middle: f64| t(x - middle);
        flag.area = [
            side(area.min[0], centre.x),
            side(area.min[1], centre.y),
            side(area.max[0], centre.x),
            side(area.max[1], centre.y),
        ];
    }

    let episode = Episode {
        seed,
        episode: number,
        map: course.map as u32,
        phase: Phase::Running,
        left: run.left(&player, &setup.task, &surface).to_f64(),
        start_distance: run.distance(&player, &surface).to_f64(),
        total_reward: 0.0,
        length: 0,
        rise: if K::ALOFT { run.goal.z.to_f64() - player.position.z.to_f64() } else { 0.0 },
        level,
        streak,
    };
    Ok(Begun { body: Body { player, arms: Group::new(Arms::new(arsenal)) }, run, episode })
}

/// Height of the topmost face that stands over the ground at a place of a map, m: nobody starts inside a solid.
fn top(setup: &EnvironmentsSetup, map: usize, place: DVec2, ground: f64) -> Option<f64> {
    let solids = setup.solids.get(map)?;
    let high = MAX_SKY.max(ground);
    let hit = solids.ray(place.extend(high), DVec3::new(0.0, 0.0, ground - high))?;
    Some(high + (ground - high) * hit.fraction)
}

/// Higher than anything that stands on a map, m.
const MAX_SKY: f64 = 4096.0;

/// Bytes of a run and an episode of every task.
const COMMON: usize = 5 * 8 + 3 * 4 + 8 + 8 + 4 + 1 + 3 * 8 + 8;
/// What those with a goal aloft have besides.
const ALOFT: usize = 8;
/// What those with a flag have besides.
const FLAG: usize = 1 + 2 * 4 + 10 * 8;
/// What those with levels have besides.
const LEVELS: usize = 2 * 4;

/// Bytes of a run and an episode.
pub(super) fn bytes<K: Kind>(levels: usize) -> usize {
    let mut bytes = COMMON;
    if K::ALOFT {
        bytes += ALOFT;
    }
    if K::Flag::<f32>::MODELED {
        bytes += FLAG;
    }
    if levels > 1 {
        bytes += LEVELS;
    }
    bytes
}

/// Appends a run and an episode, little-endian. Reals go as f64: exact for both tiers.
pub(super) fn write<K: Kind, T: Scalar>(run: &Run<K, T>, e: &Episode, levels: usize, out: &mut Vec<u8>) {
    let real = |x: T, out: &mut Vec<u8>| out.extend(x.to_f64().to_le_bytes());
    for x in [run.goal.x, run.goal.y, run.goal.z, run.path, run.top_speed] {
        real(x, out);
    }
    for i in [run.goal_tile[0], run.goal_tile[1], run.ticks] {
        out.extend(i.to_le_bytes());
    }
    out.extend(e.seed.to_le_bytes());
    out.extend(e.episode.to_le_bytes());
    out.extend(e.map.to_le_bytes());
    out.push(e.phase as u8);
    for x in [e.left, e.start_distance, e.total_reward] {
        out.extend(x.to_le_bytes());
    }
    out.extend(e.length.to_le_bytes());
    if K::ALOFT {
        out.extend(e.rise.to_le_bytes());
    }
    if let Some(flag) = run.flag.as_ref() {
        out.push(u8::from(flag.carried));
        out.extend(flag.outside.to_le_bytes());
        out.extend(flag.taken.to_le_bytes());
        for x in [flag.enemy, flag.home].into_iter().flat_map(|v| [v.x, v.y, v.z]).chain(flag.area) {
            real(x, out);
        }
    }
    if levels > 1 {
        out.extend(e.level.to_le_bytes());
        out.extend(e.streak.to_le_bytes());
    }
}

/// Reads what [`write`] wrote.
///
/// # Panics
/// If there are fewer than [`bytes`]: callers check.
pub(super) fn read<K: Kind, T: Scalar>(mut bytes: &[u8], levels: usize) -> (Run<K, T>, Episode) {
    let b = &mut bytes;
    let goal = V3::new(real(b), real(b), real(b));
    let (path, top_speed) = (real(b), real(b));
    let (goal_tile, ticks) = ([int(b), int(b)], int(b));
    let mut run = Run::<K, T> { goal, goal_tile, ticks, path, top_speed, ..Run::idle() };
    let mut e = Episode {
        seed: u64::from_le_bytes(take(b)),
        episode: u64::from_le_bytes(take(b)),
        map: u32::from_le_bytes(take(b)),
        phase: match take::<1>(b)[0] {
            0 => Phase::Unseeded,
            1 => Phase::Running,
            2 => Phase::Terminated,
            _ => Phase::Truncated,
        },
        left: number(b),
        start_distance: number(b),
        total_reward: number(b),
        length: i64::from_le_bytes(take(b)),
        ..Episode::default()
    };
    if K::ALOFT {
        e.rise = number(b);
    }
    if let Some(flag) = run.flag.as_mut() {
        flag.carried = take::<1>(b)[0] != 0;
        (flag.outside, flag.taken) = (int(b), int(b));
        flag.enemy = V3::new(real(b), real(b), real(b));
        flag.home = V3::new(real(b), real(b), real(b));
        flag.area = [real(b), real(b), real(b), real(b)];
    }
    if levels > 1 {
        e.level = u32::from_le_bytes(take(b));
        e.streak = int(b);
    }
    (run, e)
}

fn take<const N: usize>(bytes: &mut &[u8]) -> [u8; N] {
    let (head, rest) = bytes.split_first_chunk::<N>().expect("the caller checked the length");
    *bytes = rest;
    *head
}

fn number(bytes: &mut &[u8]) -> f64 {
    f64::from_le_bytes(take(bytes))
}

fn real<T: Scalar>(bytes: &mut &[u8]) -> T {
    T::from_f64(number(bytes))
}

fn int(bytes: &mut &[u8]) -> i32 {
    i32::from_le_bytes(take(bytes))
}
