//! Where the player would come down: if he let himself fall, and if his jets burnt.

use super::seen_ground;
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::terrain::{Ground, Surface};

/// Seconds looked ahead.
pub(super) const HORIZON: f64 = 3.0;
/// Looks at the ground along the way.
const LOOKS: i32 = 20;

/// Length of a short burst of the jets, s.
const BURST: f64 = 0.5;

/// A landing.
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
    /// Horizontal velocity there, m/s.
    pub(super) velocity: [R; 2],
}

/// Jets that burn from now on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jets<R> {
    /// What they add, m/s^2.
    pub(super) thrust: V3<R>,
    /// For how long, s.
    pub(super) seconds: R,
}

impl<R: Real> Jets<R> {
    /// A short burst up, one that uses all the energy, and short ones to the left and to the right of the way
    /// that the player moves: with the largest sideways share, what is left of the thrust going up. A guess,
    /// for who chooses where to land: speed and contact, which change the shares (docs/physics.md, section
    /// 4.2), and the keys of the present are left out.
    #[inline(always)]
    pub(super) fn ways<S: Scene>(p: &Player<S, R>, rules: &Rules<R::Scalar>, speed: R) -> [Self; 4] {
        let dt = R::splat(rules.dt);
        let lift = R::splat(rules.jet) / dt;
        let rate = (R::splat(rules.drain) - R::splat(rules.recharge)) / dt;
        let all = p.energy.get(R::zero()) / rate;
        let short = R::lit(BURST).min(all);
        let side = R::splat(rules.max_sideways) * lift;
        let v = p.velocity;
        let left = V3::new(R::zero() - v.y, v.x, R::zero()) * (side / speed.max(R::lit(1.0)));
        let (up, rest) = (V3::up() * lift, V3::up() * (lift - side));
        [(up, short), (up, all), (rest + left, short), (rest - left, short)]
            .map(|(thrust, seconds)| Self { thrust, seconds })
    }

    /// Seconds of a time that they burn in.
    #[inline(always)]
    fn burnt(&self, time: R) -> R {
        R::select(time.lt(self.seconds), time, self.seconds)
    }
}

/// Where a player is so many seconds later.
#[inline(always)]
fn place<S: Scene, R: Real>(p: &Player<S, R>, gravity: R, jets: Option<&Jets<R>>, time: R) -> V3<R> {
    let half = R::lit(0.5);
    let fall = gravity * time * time * half;
    let falls = p.position + p.velocity * time + V3::new(R::zero(), R::zero(), fall);
    let Some(jets) = jets else { return falls };
    let burnt = jets.burnt(time);
    falls + jets.thrust * (burnt * (time - burnt * half))
}

/// Looks along the parabola of the present velocity, every 0.15 s, and interpolates where the
/// height over the ground changes its sign. Hills narrower than the stride between two looks can be
/// missed: it is a feature for an agent, not a contact test.
#[inline(always)]
pub(super) fn landing<S: Scene, R: Real>(
    p: &Player<S, R>,
    below: &Ground<R>,
    gravity: R,
    jets: Option<&Jets<R>>,
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
        let there = place(p, gravity, jets, time);
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
    let there = place(p, gravity, jets, time);
    let ground = seen_ground::<R>(surface, p.map, there.x, there.y, lowest);
    let velocity = jets.map_or(p.velocity, |jets| p.velocity + jets.thrust * jets.burnt(time));
    let into = velocity + V3::new(zero, zero, gravity * time);
    let impact = (-into.dot(ground.normal())).max(zero);
    Landing {
        time: R::select(falling, R::lit(HORIZON), time),
        slope: [ground.slope_x, ground.slope_y],
        impact: R::select(falling, zero, impact),
        rise: ground.height - p.position.z,
        velocity: [velocity.x, velocity.y],
    }
}
