//! Where the player would come down if he let himself fall: the ballistic landing.

use super::seen_ground;
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::scene::Scene;
use crate::terrain::{Ground, Surface};

/// Seconds looked ahead.
pub(super) const HORIZON: f64 = 3.0;
/// Looks at the ground along the way.
const LOOKS: i32 = 20;

/// A ballistic landing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing<R> {
    /// Seconds until it; [`HORIZON`] if later.
    pub(super) time: R,
    /// Slopes of the ground there.
    pub(super) slope: [R; 2],
    /// Speed into the ground, m/s; 0 if later.
    pub(super) impact: R,
    /// Height of the ground there over the feet now, m.
    pub(super) rise: R,
}

/// Where a player is so many seconds later.
#[inline(always)]
fn place<S: Scene, R: Real>(p: &Player<S, R>, gravity: R, time: R) -> V3<R> {
    let fall = gravity * time * time * R::lit(0.5);
    p.position + p.velocity * time + V3::new(R::zero(), R::zero(), fall)
}

/// Looks along the parabola of the present velocity, every 0.15 s, and interpolates where the
/// height over the ground changes its sign. Hills narrower than the stride between two looks can be
/// missed: it is a feature for an agent, not a contact test.
#[inline(always)]
pub(super) fn landing<S: Scene, R: Real>(
    p: &Player<S, R>,
    below: &Ground<R>,
    gravity: R,
    surface: &Surface<'_, R::Scalar>,
    lowest: R,
) -> Landing<R> {
    let zero = R::zero();
    let step = R::lit(HORIZON / f64::from(LOOKS));
    let mut gap = (p.position.z - below.height).max(zero);
    let mut before = zero;
    // What the last look before the landing and the first one below the ground saw.
    let (mut above, mut under, mut from, mut to) = (zero, R::lit(-1.0), zero, zero);
    let mut falling = R::Mask::splat(true);
    for look in 1..=LOOKS {
        let time = R::from_int(R::Int::splat(look)) * step;
        let there = place(p, gravity, time);
        let next = there.z - seen_ground::<R>(surface, p.map, there.x, there.y, lowest).height;
        let lands = falling.and(next.lt(zero));
        above = R::select(lands, gap, above);
        under = R::select(lands, next, under);
        from = R::select(lands, before, from);
        to = R::select(lands, time, to);
        falling = falling.and(lands.not());
        if !falling.any() {
            break;
        }
        (gap, before) = (next, time);
    }
    let landed = from + (to - from) * (above / (above - under));
    let time = R::select(falling, before, landed);
    let there = place(p, gravity, time);
    let ground = seen_ground::<R>(surface, p.map, there.x, there.y, lowest);
    let velocity = p.velocity + V3::new(zero, zero, gravity * time);
    let impact = (-velocity.dot(ground.normal())).max(zero);
    Landing {
        time: R::select(falling, R::lit(HORIZON), time),
        slope: [ground.slope_x, ground.slope_y],
        impact: R::select(falling, zero, impact),
        rise: ground.height - p.position.z,
    }
}
