//! Where the player would come down if he let himself fall: the ballistic landing.

use super::seen_ground;
use crate::player::Player;
use crate::real::{Scalar, V3};
use crate::scene::Scene;
use crate::terrain::Surface;

/// Seconds looked ahead.
pub(super) const HORIZON: f64 = 3.0;
/// Looks at the ground along the way.
const LOOKS: i32 = 20;

/// A ballistic landing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing<T> {
    /// Seconds until it; [`HORIZON`] if later.
    pub(super) time: T,
    /// Slopes of the ground there.
    pub(super) slope: [T; 2],
    /// Speed into the ground, m/s; 0 if later.
    pub(super) impact: T,
    /// Height of the ground there over the feet now, m.
    pub(super) rise: T,
}

/// Looks along the parabola of the present velocity, every 0.15 s, and interpolates where the
/// height over the ground changes its sign. Hills narrower than the stride between two looks can be
/// missed: it is a feature for an agent, not a contact test.
pub(super) fn landing<S: Scene, T: Scalar>(
    p: &Player<S, T>,
    gravity: T,
    surface: &Surface<'_, T>,
    lowest: T,
) -> Landing<T> {
    let half = T::from_f64(0.5);
    let step = T::from_f64(HORIZON / f64::from(LOOKS));
    let at = |t: T| -> V3<T> {
        p.position + p.velocity * t + V3::new(T::zero(), T::zero(), gravity * t * t * half)
    };
    let ground = |place: V3<T>| seen_ground(surface, p.map, place.x, place.y, lowest);
    let mut gap = (p.position.z - ground(p.position).height).max(T::zero());
    let mut before = T::zero();
    for look in 1..=LOOKS {
        let time = T::from_int(look) * step;
        let place = at(time);
        let below = ground(place);
        let next = place.z - below.height;
        if next < T::zero() {
            let time = before + (time - before) * (gap / (gap - next));
            let place = at(time);
            let there = ground(place);
            let velocity = p.velocity + V3::new(T::zero(), T::zero(), gravity * time);
            return Landing {
                time,
                slope: [there.slope_x, there.slope_y],
                impact: (-velocity.dot(there.normal())).max(T::zero()),
                rise: there.height - p.position.z,
            };
        }
        (gap, before) = (next, time);
    }
    let there = ground(at(before));
    Landing {
        time: T::from_f64(HORIZON),
        slope: [there.slope_x, there.slope_y],
        impact: T::zero(),
        rise: there.height - p.position.z,
    }
}
