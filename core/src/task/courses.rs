//! Where an episode starts and where its beacon stands: counted draws, or what the user asked for.

use crate::error::{InputError, refuse};
use crate::random::{Purpose, index, uniform};
use crate::terrain::mission::Area;
use glam::DVec2;

/// What a user may fix of an episode; the rest is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CourseRequest {
    /// World position of the start, m.
    pub start: Option<DVec2>,
    /// Height of the start; on the ground where absent.
    pub height: Option<f64>,
    /// World position of the beacon, m.
    pub goal: Option<DVec2>,
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
    /// Height of the start; on the ground where absent.
    pub height: Option<f64>,
    /// World position of the beacon, m.
    pub goal: DVec2,
    /// View yaw at the start, radians.
    pub yaw: f64,
    /// Velocity at the start, m/s.
    pub velocity: DVec2,
}

/// Draws tried before the fallback across the area's diagonal.
const TRIES: u32 = 64;

/// Draws an episode: its map; start and beacon inside the map's area, the beacon at a distance
/// uniform in `distance`; any yaw; at rest in half of the episodes, else with a horizontal velocity up
/// to `start_speed`. Where no draw of 64 fits the area, the course runs along its diagonal.
///
/// # Errors
/// If the request names a map that is not there.
pub fn draw_course(
    seed: u64,
    episode: u64,
    areas: &[Area],
    distance: (f64, f64),
    start_speed: f64,
    request: &CourseRequest,
) -> Result<Course, InputError> {
    let map = match request.map {
        Some(map) if map < areas.len() => map,
        Some(map) => refuse!("terrain: expected an index from 0 to {}, got {map}", areas.len() - 1),
        None => index(seed, episode, Purpose::Terrain, 0, areas.len()),
    };
    let area = areas[map];
    let (start, goal) = draw_ends(seed, episode, &area, distance, request);
    let draw = |purpose, counter, low, high| uniform(seed, episode, purpose, counter, low, high);
    let pi = core::f64::consts::PI;
    let yaw = draw(Purpose::Velocity, 0, -pi, pi);
    let heading = draw(Purpose::Velocity, 1, -pi, pi);
    let speed = draw(Purpose::Velocity, 2, -start_speed, start_speed).max(0.0);
    let velocity = direction(heading) * speed;
    Ok(Course { map, start, height: request.height, goal, yaw, velocity })
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
