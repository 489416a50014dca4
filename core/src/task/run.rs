//! A run to the beacon: what is tested every tick, and what it is worth.

use crate::player::{Place, Player};
use crate::real::{Int, Mask, Real, Scalar, V3};
use crate::scene::{Group, Scene};
use crate::terrain::Surface;

/// Weights of the reward's terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reward {
    /// Per metre that the beacon came nearer: the difference of a potential, so it cannot be farmed.
    pub progress: f64,
    /// Per second.
    pub time: f64,
    /// Once, on arrival.
    pub arrival: f64,
}

impl Default for Reward {
    fn default() -> Self {
        Self { progress: 0.02, time: -0.156_25, arrival: 5.0 }
    }
}

/// What is uniform over a batch of ski episodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkiTask {
    /// Ticks per decision.
    pub frame_skip: u32,
    /// Ticks after which an episode is truncated.
    pub time_limit: i32,
    /// Horizontal distance of the path to the beacon that counts as arrival, m.
    pub arrival_radius: f64,
    /// Drawn distances of the beacon, m.
    pub goal_distance: (f64, f64),
    /// Largest drawn speed at the start, m/s.
    pub start_speed: f64,
    /// Fastest turn, rad/s.
    pub turn_rate: f64,
    /// Weights.
    pub reward: Reward,
}

/// A run under way: beacon, clock, and what is reported at its end.
#[derive(Clone, Copy, Debug)]
pub struct Run<R: Real> {
    /// Local position of the beacon on its tile, m; z is the ground's height there.
    pub goal: V3<R>,
    /// Tile of the beacon.
    pub goal_tile: [R::Int; 2],
    /// Ticks played.
    pub ticks: R::Int,
    /// Horizontal length of the path, m.
    pub path: R,
    /// Highest speed, m/s.
    pub top_speed: R,
}

/// How a tick left an episode.
#[derive(Clone, Copy, Debug)]
pub struct Verdict<M> {
    /// The path came within the radius, alive.
    pub arrived: M,
    /// Damage reached the armor's limit.
    pub died: M,
    /// The time is up, and neither of the above.
    pub timed_out: M,
}

/// What an episode came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Reached the beacon.
    pub success: bool,
    /// Killed by a landing.
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
    /// Horizontal distance left to the beacon, m.
    pub distance: f64,
    /// Horizontal distance of the beacon at the start, m.
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
}

impl<R: Real> Run<R> {
    /// No run: the beacon at the origin.
    #[must_use]
    pub fn idle() -> Self {
        let zero = R::Int::splat(0);
        Self { goal: V3::zero(), goal_tile: [zero; 2], ticks: zero, path: R::zero(), top_speed: R::zero() }
    }

    /// Horizontal way from a place on a tile to the beacon, m.
    #[inline(always)]
    pub fn to_goal(&self, place: V3<R>, tile: [R::Int; 2], surface: &Surface<'_, R::Scalar>) -> (R, R) {
        let tiles = [self.goal_tile[0] - tile[0], self.goal_tile[1] - tile[1]];
        let (x, y) = surface.tiles_apart::<R>(tiles[0], tiles[1]);
        (self.goal.x - place.x + x, self.goal.y - place.y + y)
    }

    /// Horizontal distance of a player to the beacon, m.
    #[inline(always)]
    pub fn distance<S: Scene>(&self, p: &Player<S, R>, surface: &Surface<'_, R::Scalar>) -> R {
        let (x, y) = self.to_goal(p.position, [p.tile_x, p.tile_y], surface);
        (x * x + y * y).sqrt()
    }

    /// Judges the tick from `before` to `after` (whose position is not yet wrapped) and keeps the
    /// books. Arrival counts when the segment between them passes within the radius.
    #[inline(always)]
    pub fn judge<S: Scene>(
        &mut self,
        before: &Place<R>,
        after: &Player<S, R>,
        task: &SkiTask,
        max_damage: R::Scalar,
        surface: &Surface<'_, R::Scalar>,
    ) -> Verdict<R::Mask> {
        let (zero, one) = (R::zero(), R::lit(1.0));
        let (gx, gy) = self.to_goal(before.position, [before.tile_x, before.tile_y], surface);
        let dx = after.position.x - before.position.x;
        let dy = after.position.y - before.position.y;
        let square = dx * dx + dy * dy;
        let moved = zero.lt(square);
        let along = (gx * dx + gy * dy) / R::select(moved, square, one);
        let nearest = along.max(zero).min(one);
        let (mx, my) = (gx - dx * nearest, gy - dy * nearest);
        let radius = R::lit(task.arrival_radius);
        let within = (mx * mx + my * my).le(radius * radius);

        self.ticks = self.ticks + R::Int::splat(1);
        self.path = self.path + square.sqrt();
        self.top_speed = self.top_speed.max(after.velocity.length());

        let died = if S::Damage::<R>::MODELED {
            R::splat(max_damage).le(after.damage.get(zero))
        } else {
            R::Mask::splat(false)
        };
        let arrived = within.and(died.not());
        let late = R::Int::splat(task.time_limit - 1).lt(self.ticks);
        Verdict { arrived, died, timed_out: late.and(arrived.or(died).not()) }
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
        }
    }

    /// The run in one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Run<R::Scalar> {
        Run {
            goal: self.goal.lane(lane),
            goal_tile: self.goal_tile.map(|t| t.lane(lane)),
            ticks: self.ticks.lane(lane),
            path: self.path.lane(lane),
            top_speed: self.top_speed.lane(lane),
        }
    }

    /// Overwrites one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, run: &Run<R::Scalar>) {
        self.goal.set_lane(lane, run.goal);
        for (mine, theirs) in self.goal_tile.iter_mut().zip(run.goal_tile) {
            mine.set_lane(lane, theirs);
        }
        self.ticks.set_lane(lane, run.ticks);
        self.path.set_lane(lane, run.path);
        self.top_speed.set_lane(lane, run.top_speed);
    }
}

impl<T: Scalar> Run<T> {
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
