//! What is uniform over a batch of episodes.

/// Weights of the reward's terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reward {
    /// Per metre that is left less: the difference of a potential, so it cannot be farmed.
    pub progress: f64,
    /// Per second.
    pub time: f64,
    /// Once, on arrival.
    pub arrival: f64,
    /// Once, on death.
    pub death: f64,
    /// What a metre of height that a flight will lack counts in what is left, in metres; for goals aloft.
    pub climb: f64,
}

impl Default for Reward {
    fn default() -> Self {
        Self { progress: 0.02, time: -0.156_25, arrival: 5.0, death: 0.0, climb: 0.0 }
    }
}

/// A distribution that episodes are drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Distances of the goal, m: of a beacon or an enemy flag on the map, of a marker the height over the
    /// ground at the start.
    pub goal_distance: (f64, f64),
    /// Largest speed at the start, m/s.
    pub start_speed: f64,
    /// Largest height of the start over the ground, m.
    pub start_height: f64,
    /// Largest distance on the map of a marker from the start, or of a start from the own flag stand, m.
    pub aside: f64,
    /// Whether the start is the player's own flag stand.
    pub from_stand: bool,
}

impl Level {
    /// Beacons at so many metres, from the ground.
    #[must_use]
    pub fn beacons(goal_distance: (f64, f64), start_speed: f64) -> Self {
        Self { goal_distance, start_speed, start_height: 0.0, aside: 0.0, from_stand: false }
    }
}

/// What is uniform over a batch of episodes.
#[derive(Clone, Debug, PartialEq)]
pub struct TaskRules {
    /// Ticks per decision.
    pub frame_skip: u32,
    /// Ticks after which an episode is truncated.
    pub time_limit: i32,
    /// Distance of the path to the goal that counts as arrival, m: horizontal, to a goal aloft in space.
    pub arrival_radius: f64,
    /// Fastest turn, rad/s.
    pub turn_rate: f64,
    /// Weights.
    pub reward: Reward,
    /// Whether the enemy flag must be brought home.
    pub capture: bool,
    /// Where the episodes of an environment are drawn from, easy to hard: each begins at the first, goes up by one
    /// after [`STREAK`] successes in a row, and down after as many failures.
    pub levels: Vec<Level>,
}

/// Episodes of one outcome in a row after which an environment changes its level.
pub const STREAK: i32 = 3;
