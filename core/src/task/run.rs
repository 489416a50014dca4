//! A run to the goal: what is tested every tick, and what it is worth.

use super::flag::{Flag, MOST_TAKEN, OUTSIDE_MS};
use super::kind::Kind;
use super::rules::TaskRules;
use crate::armor::GRAVITY;
use crate::player::{Place, Player};
use crate::real::{Int, Mask, Real, Scalar, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::terrain::Surface;

/// A run under way: goal, clock, and what is reported at its end.
#[derive(Clone, Copy, Debug)]
pub struct Run<K: Kind, R: Real> {
    /// Local position of the goal on its tile, m; a beacon's z is the ground's height there.
    pub goal: V3<R>,
    /// Tile of the goal.
    pub goal_tile: [R::Int; 2],
    /// Ticks played.
    pub ticks: R::Int,
    /// Horizontal length of the path, m.
    pub path: R,
    /// Highest speed, m/s.
    pub top_speed: R,
    /// The enemy flag, where there is one.
    pub flag: K::Flag<R>,
}

/// How a tick left an episode.
#[derive(Clone, Copy, Debug)]
pub struct Verdict<M> {
    /// The path came within the radius of the goal (of the last one, where there are two), alive.
    pub arrived: M,
    /// Damage reached the armor's limit.
    pub died: M,
    /// The time is up, and neither of the above.
    pub timed_out: M,
}

/// What an episode came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Reached the goal.
    pub success: bool,
    /// Killed, by a landing or an explosion.
    pub death: bool,
    /// Neither within the time limit.
    pub timeout: bool,
    /// Length, s, to the tick.
    pub time: f64,
    /// Sum of rewards.
    pub total_reward: f64,
    /// Decisions.
    pub length: i64,
    /// Highest speed, m/s.
    pub top_speed: f64,
    /// Horizontal path over time, m/s.
    pub mean_speed: f64,
    /// Horizontal path, m.
    pub path: f64,
    /// Damage taken.
    pub damage: f64,
    /// Distance left to the goal, m.
    pub distance: f64,
    /// Distance of the goal at the start, m.
    pub start_distance: f64,
    /// Speed at the end, m/s.
    pub speed: f64,
    /// Whether it ended outside the mission area.
    pub outside: bool,
    /// Which map.
    pub terrain: i64,
    /// The environment's seed.
    pub seed: u64,
    /// Which episode of that seed.
    pub episode: u64,
    /// Height of the goal over the start, m.
    pub rise: f64,
    /// Whether he had the enemy flag at the end.
    pub carried: bool,
    /// How often he took it.
    pub taken: i64,
    /// Which level of the curriculum it was drawn from.
    pub level: i64,
}

impl<K: Kind, R: Real> Run<K, R> {
    /// No run: the goal at the origin.
    #[must_use]
    pub fn idle() -> Self {
        let zero = R::Int::splat(0);
        let flag = Group::new(Flag::idle());
        Self {
            goal: V3::zero(),
            goal_tile: [zero; 2],
            ticks: zero,
            path: R::zero(),
            top_speed: R::zero(),
            flag,
        }
    }

    /// Horizontal way from a place on a tile to the goal, m.
    #[inline(always)]
    pub fn to_goal(&self, place: V3<R>, tile: [R::Int; 2], surface: &Surface<'_, R::Scalar>) -> (R, R) {
        let tiles = [self.goal_tile[0] - tile[0], self.goal_tile[1] - tile[1]];
        let (x, y) = surface.tiles_apart::<R>(tiles[0], tiles[1]);
        (self.goal.x - place.x + x, self.goal.y - place.y + y)
    }

    /// Distance of a player to the goal, m: horizontal, and to one that is aloft in space.
    #[inline(always)]
    pub fn distance<S: Scene>(&self, p: &Player<S, R>, surface: &Surface<'_, R::Scalar>) -> R {
        let (x, y) = self.to_goal(p.position, [p.tile_x, p.tile_y], surface);
        let square = x * x + y * y;
        if K::ALOFT {
            let z = self.goal.z - p.position.z;
            return (square + z * z).sqrt();
        }
        square.sqrt()
    }

    /// What is left to be done, m: what progress is rewarded for. The distance to the goal; with a flag that is
    /// to be captured also the way home, until it is taken; with a weight for climbing also the height that
    /// the player's flight will miss the goal's by, times the weight.
    #[inline(always)]
    pub fn left<S: Scene>(&self, p: &Player<S, R>, task: &TaskRules, surface: &Surface<'_, R::Scalar>) -> R {
        let mut left = self.distance(p, surface);
        if let Some(flag) = self.flag.as_ref()
            && task.capture
        {
            left = left + R::select(flag.carried, R::zero(), flag.apart());
        }
        if K::ALOFT && task.reward.climb != 0.0 {
            let gap = (self.goal.z - apex(p)).max(R::zero());
            left = left + gap * R::lit(task.reward.climb);
        }
        left
    }

    /// Judges the tick from `before` to `after` and keeps the books. Arrival counts when the segment between
    /// them passes within the radius. Where the goal is on the ground `after` is not yet wrapped.
    #[inline(always)]
    pub fn judge<S: Scene>(
        &mut self,
        before: &Place<R>,
        after: &Player<S, R>,
        task: &TaskRules,
        rules: &Rules<R::Scalar>,
        surface: &Surface<'_, R::Scalar>,
    ) -> Verdict<R::Mask> {
        let (zero, one) = (R::zero(), R::lit(1.0));
        let (gx, gy) = self.to_goal(before.position, [before.tile_x, before.tile_y], surface);
        let mut dx = after.position.x - before.position.x;
        let mut dy = after.position.y - before.position.y;
        if K::ALOFT {
            let (x, y) = self.to_goal(after.position, [after.tile_x, after.tile_y], surface);
            (dx, dy) = (gx - x, gy - y);
        }
        let flat = dx * dx + dy * dy;
        let (gz, dz) = (self.goal.z - before.position.z, after.position.z - before.position.z);
        let square = if K::ALOFT { flat + dz * dz } else { flat };
        let moved = zero.lt(square);
        let mut along = gx * dx + gy * dy;
        if K::ALOFT {
            along = along + gz * dz;
        }
        let along = along / R::select(moved, square, one);
        let nearest = along.max(zero).min(one);
        let (mx, my) = (gx - dx * nearest, gy - dy * nearest);
        let mut miss = mx * mx + my * my;
        if K::ALOFT {
            let mz = gz - dz * nearest;
            miss = miss + mz * mz;
        }
        let radius = R::lit(task.arrival_radius);
        let within = miss.le(radius * radius);

        self.ticks = self.ticks + R::Int::splat(1);
        self.path = self.path + flat.sqrt();
        self.top_speed = self.top_speed.max(after.velocity.length());

        let died = if S::Damage::<R>::MODELED {
            R::splat(rules.max_damage).le(after.damage.get(zero))
        } else {
            R::Mask::splat(false)
        };
        let arrived = self.reach(within.and(died.not()), after, task, rules, surface);
        let late = R::Int::splat(task.time_limit - 1).lt(self.ticks);
        Verdict { arrived, died, timed_out: late.and(arrived.or(died).not()) }
    }

    /// Who is at his last goal, of those who are at one; the others of these go on to the next.
    #[inline(always)]
    fn reach<S: Scene>(
        &mut self,
        there: R::Mask,
        p: &Player<S, R>,
        task: &TaskRules,
        rules: &Rules<R::Scalar>,
        surface: &Surface<'_, R::Scalar>,
    ) -> R::Mask {
        let Some(flag) = self.flag.as_mut() else { return there };
        let (zero, one) = (R::Int::splat(0), R::Int::splat(1));
        let outside = flag.is_outside(p, surface);
        let home = there.and(flag.carried);
        let takes = there.and(flag.carried.or(outside).not());
        flag.taken = R::Int::select(takes, flag.taken + one, flag.taken).clamp(0, MOST_TAKEN);
        flag.carried = flag.carried.or(takes);
        if !task.capture {
            return takes;
        }
        flag.outside = R::Int::select(flag.carried.and(outside), flag.outside + one, zero);
        let most = OUTSIDE_MS.div_ceil(rules.tick_ms.cast_unsigned()).cast_signed();
        let lost = flag.outside.lt(R::Int::splat(most)).not();
        flag.carried = flag.carried.and(lost.not());
        flag.outside = R::Int::select(lost, zero, flag.outside);
        self.goal =
            V3::select(flag.carried.and(home.not()), flag.home, V3::select(home, self.goal, flag.enemy));
        home
    }

    /// `a` where the mask is set, `b` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: R::Mask, a: &Self, b: &Self) -> Self {
        let [a_x, a_y] = a.goal_tile;
        let [b_x, b_y] = b.goal_tile;
        Self {
            goal: V3::select(mask, a.goal, b.goal),
            goal_tile: [R::Int::select(mask, a_x, b_x), R::Int::select(mask, a_y, b_y)],
            ticks: R::Int::select(mask, a.ticks, b.ticks),
            path: R::select(mask, a.path, b.path),
            top_speed: R::select(mask, a.top_speed, b.top_speed),
            flag: match (a.flag.as_ref(), b.flag.as_ref()) {
                (Some(a), Some(b)) => Group::new(Flag::select(mask, a, b)),
                _ => a.flag,
            },
        }
    }

    /// The run in one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Run<K, R::Scalar> {
        Run {
            goal: self.goal.lane(lane),
            goal_tile: self.goal_tile.map(|t| t.lane(lane)),
            ticks: self.ticks.lane(lane),
            path: self.path.lane(lane),
            top_speed: self.top_speed.lane(lane),
            flag: Group::new(self.flag.as_ref().map_or_else(Flag::idle, |flag| flag.lane(lane))),
        }
    }

    /// Overwrites one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, run: &Run<K, R::Scalar>) {
        self.goal.set_lane(lane, run.goal);
        for (mine, theirs) in self.goal_tile.iter_mut().zip(run.goal_tile) {
            mine.set_lane(lane, theirs);
        }
        self.ticks.set_lane(lane, run.ticks);
        self.path.set_lane(lane, run.path);
        self.top_speed.set_lane(lane, run.top_speed);
        if let (Some(mine), Some(theirs)) = (self.flag.as_mut(), run.flag.as_ref()) {
            mine.set_lane(lane, theirs);
        }
    }
}

/// Height that a player's flight leads to, without jets, m.
#[inline(always)]
pub(crate) fn apex<S: Scene, R: Real>(p: &Player<S, R>) -> R {
    let rising = p.velocity.z.max(R::zero());
    p.position.z + rising * rising * R::lit(-0.5 / GRAVITY)
}

impl<K: Kind, T: Scalar> Run<K, T> {
    /// Seconds played.
    #[must_use]
    pub fn seconds(&self, tick_ms: i32) -> f64 {
        seconds(self.ticks, tick_ms)
    }
}

/// So many ticks in seconds.
#[inline(always)]
pub(crate) fn seconds(ticks: i32, tick_ms: i32) -> f64 {
    f64::from(ticks) * f64::from(tick_ms) / 1000.0
}
