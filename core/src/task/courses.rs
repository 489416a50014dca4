//! Where an episode starts and where its goal is: counted draws, or what the user asked for.

use super::rules::Level;
use crate::error::{InputError, refuse};
use crate::random::{Purpose, index, uniform};
use crate::terrain::mission::Area;
use glam::{DVec2, DVec3};

/// Where episodes take place on one map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pitch {
    /// The area that they are drawn in.
    pub area: Area,
    /// Where the two flags stand, world positions, m; at the origin where there are none.
    pub stands: [DVec3; 2],
}

impl Pitch {
    /// An area without flags.
    #[must_use]
    pub fn bare(area: Area) -> Self {
        Self { area, stands: [DVec3::ZERO; 2] }
    }
}

/// What kind of course is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grounds {
    /// A beacon on the ground.
    Beacon,
    /// A marker over the start.
    Marker,
    /// The flags of a mission.
    Stands,
}

/// What a user may fix of an episode; the rest is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CourseRequest {
    /// World position of the start, m.
    pub start: Option<DVec2>,
    /// Height of the start; on the ground where absent.
    pub height: Option<f64>,
    /// World position of the goal, m.
    pub goal: Option<DVec2>,
    /// Height of a marker; drawn where absent.
    pub goal_height: Option<f64>,
    /// Which map of the pool.
    pub map: Option<usize>,
}

/// One episode's task.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Which map of the pool.
    pub map: usize,
    /// World position of the start, m.
    pub start: DVec2,
    /// Height of the start; `above` the ground where absent.
    pub height: Option<f64>,
    /// Height of the start over the ground, m.
    pub above: f64,
    /// World position of the goal, m.
    pub goal: DVec2,
    /// Height of the goal; `rise` over the ground at the start where absent.
    pub goal_height: Option<f64>,
    /// See there, m.
    pub rise: f64,
    /// Whose flag it is: the number of his own.
    pub team: usize,
    /// View yaw at the start, radians.
    pub yaw: f64,
    /// Velocity at the start, m/s.
    pub velocity: DVec2,
}

/// Draws tried before the fallback across the area's diagonal.
const TRIES: u32 = 64;

/// Draws an episode: its map; start and goal inside the map's area; any yaw; at rest in half of the episodes, else
/// with a horizontal velocity up to the level's `start_speed`.
///
/// A beacon stands at a distance uniform in the level's; where no draw of 64 fits the area, the course runs
/// along its diagonal. A marker floats over a start that in half of the episodes is on the ground, else up to
/// `start_height` above it: at a height over the ground there uniform in the level's distances, up to `aside` off. In
/// a mission either team's, the start is at rest up to `aside` from the own flag stand, or a place within the
/// area at a distance uniform in the level's from the enemy flag.
///
/// # Errors
/// If the request names a map that is not there.
pub fn draw_course(
    seed: u64,
    episode: u64,
    grounds: Grounds,
    pitches: &[Pitch],
    level: &Level,
    request: &CourseRequest,
) -> Result<Course, InputError> {
    let map = match request.map {
        Some(map) if map < pitches.len() => map,
        Some(map) => refuse!("terrain: expected an index from 0 to {}, got {map}", pitches.len() - 1),
        None => index(seed, episode, Purpose::Terrain, 0, pitches.len()),
    };
    let Pitch { area, stands } = pitches[map];
    let draw = |purpose, counter, low, high| uniform(seed, episode, purpose, counter, low, high);
    let pi = core::f64::consts::PI;
    // As many in every part of the disc as its area is large.
    let aside =
        |purpose| direction(draw(purpose, 0, -pi, pi)) * (level.aside * draw(purpose, 1, 0.0, 1.0).sqrt());
    let yaw = draw(Purpose::Velocity, 0, -pi, pi);
    let heading = draw(Purpose::Velocity, 1, -pi, pi);
    let speed = draw(Purpose::Velocity, 2, -level.start_speed, level.start_speed).max(0.0);
    let mut velocity = direction(heading) * speed;
    let (mut above, mut rise, mut team) = (0.0, 0.0, 0);
    let (mut height, mut goal_height) = (request.height, request.goal_height);
    let (start, goal);
    match grounds {
        Grounds::Beacon => {
            (start, goal) = draw_ends(seed, episode, &area, level.goal_distance, request);
        }
        Grounds::Marker => {
            above = draw(Purpose::Height, 0, -level.start_height, level.start_height).max(0.0);
            rise = draw(Purpose::Height, 1, level.goal_distance.0, level.goal_distance.1);
            let (low, high) = (DVec2::from(area.min), DVec2::from(area.max));
            let place =
                DVec2::new(draw(Purpose::Start, 0, low.x, high.x), draw(Purpose::Start, 1, low.y, high.y));
            start = request.start.or(request.goal).unwrap_or(place);
            goal = request.goal.unwrap_or(start + aside(Purpose::Goal));
        }
        Grounds::Stands => {
            team = index(seed, episode, Purpose::Team, 0, 2);
            let (own, enemy) = (stands[team], stands[1 - team]);
            goal = enemy.truncate();
            goal_height = Some(enemy.z);
            if let Some(place) = request.start {
                start = place;
            } else if level.from_stand {
                start = own.truncate() + aside(Purpose::Start);
                height = Some(own.z);
                velocity = DVec2::ZERO;
            } else {
                let towards = CourseRequest { goal: Some(goal), ..CourseRequest::default() };
                start = draw_ends(seed, episode, &area, level.goal_distance, &towards).0;
            }
        }
    }
    Ok(Course { map, start, height, above, goal, goal_height, rise, team, yaw, velocity })
}

/// A horizontal unit vector; libm's, so that it has the same bits everywhere.
fn direction(angle: f64) -> DVec2 {
    DVec2::new(libm::cos(angle), libm::sin(angle))
}

fn draw_ends(
    seed: u64,
    episode: u64,
    area: &Area,
    distance: (f64, f64),
    request: &CourseRequest,
) -> (DVec2, DVec2) {
    let pi = core::f64::consts::PI;
    let draw = |purpose, counter, low, high| uniform(seed, episode, purpose, counter, low, high);
    if let (Some(start), Some(goal)) = (request.start, request.goal) {
        return (start, goal);
    }
    let (low, high) = (DVec2::from(area.min), DVec2::from(area.max));
    let mut metres = distance.0;
    for k in 0..TRIES {
        let place = DVec2::new(
            draw(Purpose::Start, 2 * k, low.x, high.x),
            draw(Purpose::Start, 2 * k + 1, low.y, high.y),
        );
        let bearing = draw(Purpose::Goal, 2 * k, -pi, pi);
        metres = draw(Purpose::Goal, 2 * k + 1, distance.0, distance.1);
        let leg = direction(bearing) * metres;
        let (start, goal) = match (request.start, request.goal) {
            (Some(start), _) => (start, start + leg),
            (None, Some(goal)) => (goal - leg, goal),
            (None, None) => (place, place + leg),
        };
        if area.contains(start.into()) && area.contains(goal.into()) {
            return (start, goal);
        }
    }
    // From the fixed end, or from a corner, towards what is farthest within the area.
    let corner = |from: DVec2| {
        let middle = (low + high) * 0.5;
        DVec2::new(
            if from.x < middle.x { high.x } else { low.x },
            if from.y < middle.y { high.y } else { low.y },
        )
    };
    let along = |from: DVec2| from + (corner(from) - from).normalize_or(DVec2::X) * metres;
    match (request.start, request.goal) {
        (Some(start), _) => (start, along(start)),
        (None, Some(goal)) => (along(goal), goal),
        (None, None) => (low, along(low)),
    }
}
