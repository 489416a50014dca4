//! Jump, jets and ground friction (docs/physics.md, section 4).

use crate::armor;
use crate::real::{Mask, Real, V3};
use crate::rules::Rules;

/// What the keys ask for: a walk velocity and its direction, both horizontal.
#[derive(Clone, Copy, Debug)]
pub struct Wish<R: Real> {
    /// Wished velocity, m/s.
    pub velocity: V3<R>,
    /// Its direction, length 1, or zero.
    pub direction: V3<R>,
    /// Whether any direction is wished.
    pub any: R::Mask,
}

/// Forward is (-sin, cos), right is (cos, sin).
#[inline(always)]
fn turned<R: Real>(forward: R, right: R, (sin, cos): (R, R)) -> V3<R> {
    V3::new(right * cos - forward * sin, forward * cos + right * sin, R::zero())
}

/// The wish of forward and strafe keys at a yaw in the article's model (section 3.1, step 1): its
/// direction leans towards the faster key.
#[inline(always)]
pub fn wish<R: Real>(forward: R, strafe: R, yaw: R, rules: &Rules<R::Scalar>) -> Wish<R> {
    let top = R::splat(rules.walk_forward);
    let wished = turned(forward * top, strafe * R::splat(rules.walk_side), yaw.sin_cos());
    let V3 { x, y, .. } = wished;
    let length = (x * x + y * y).sqrt();
    let any = R::zero().lt(length);
    let safe = R::select(any, length, R::lit(1.0));
    let direction = V3::new(x / safe, y / safe, R::zero());
    let long = top.lt(length);
    let velocity = V3::select(long, direction * top, wished);
    Wish { velocity, direction, any }
}

/// The wish in the engine's model (section 3.2, step 2): slower backwards, its direction weighs the
/// keys alike.
#[inline(always)]
pub fn engine_wish<R: Real>(forward: R, strafe: R, yaw: R, rules: &Rules<R::Scalar>) -> Wish<R> {
    let zero = R::zero();
    let side = R::splat(rules.walk_side);
    let f = forward * R::select(forward.lt(zero), side, R::splat(rules.walk_forward));
    let s = strafe * side;
    let frame = yaw.sin_cos();
    let wished = turned(f, s, frame);
    let (length, top) = ((f * f + s * s).sqrt(), f.abs().max(s.abs()));
    let any = zero.lt(length);
    let safe = R::select(any, length, R::lit(1.0));
    // One key alone is its own top speed: not even rounding may touch it.
    let k = R::select(top.lt(length), top / safe, R::lit(1.0));
    let pressed = (forward * forward + strafe * strafe).sqrt();
    let direction = turned(forward, strafe, frame) * (R::lit(1.0) / R::select(any, pressed, R::lit(1.0)));
    Wish { velocity: wished * k, direction, any }
}

/// Change of velocity by a jump off a surface (section 4.1): no tangential loss with the key pressed
/// straight downhill, and nothing gained uphill.
#[inline(always)]
pub fn jump<R: Real>(normal: V3<R>, wish: &Wish<R>, rules: &Rules<R::Scalar>) -> V3<R> {
    let j = R::splat(rules.jump);
    let along = normal.dot(wish.direction).max(R::zero());
    wish.direction * (j * along) + V3::up() * (j * normal.z)
}

/// Whether the jets burn in this tick (section 4.2): out at 1, lit again at 5, decided before the
/// tick's recharge and drain.
#[inline(always)]
pub fn jets_burn<R: Real>(key: R::Mask, burning: R::Mask, energy: R, rules: &Rules<R::Scalar>) -> R::Mask {
    let allowed = if rules.physics.hysteresis {
        let stay = R::lit(armor::JET_CUTOFF).lt(energy);
        let light = R::lit(armor::JET_REIGNITE).le(energy);
        burning.pick(stay, light)
    } else {
        R::zero().lt(energy)
    };
    key.and(allowed)
}

/// Change of velocity by burning jets in one tick (section 4.2). Straight up while the last jumpable
/// contact is `recent`.
#[inline(always)]
pub fn jet<R: Real>(velocity: V3<R>, wish: &Wish<R>, recent: R::Mask, rules: &Rules<R::Scalar>) -> V3<R> {
    let thrust = R::splat(rules.jet);
    let along = velocity.dot(wish.direction);
    let fade = R::splat(rules.fade_speed);
    let one = R::lit(1.0);
    let share = R::select(along.lt(R::zero()), one, one - along / fade);
    let share = R::select(fade.lt(along), R::zero(), share);
    let share = share.min(R::splat(rules.max_sideways));
    let upwards = wish.any.not().or(recent);
    let share = R::select(upwards, R::zero(), share);
    wish.direction * (share * thrust) + V3::up() * ((one - share) * thrust)
}

/// Ground friction, which is also walking (section 4.3): the change of velocity towards the wish,
/// and whether the wish was within reach.
#[inline(always)]
pub fn friction<R: Real>(
    velocity: V3<R>,
    wish: &Wish<R>,
    memory: R,
    rules: &Rules<R::Scalar>,
) -> (V3<R>, R::Mask) {
    let x = wish.velocity.x - velocity.x;
    let y = wish.velocity.y - velocity.y;
    let wanted = (x * x + y * y).sqrt();
    let grip = (R::splat(rules.traction) * memory).min(R::lit(1.0));
    let cap = R::splat(rules.grip) * grip;
    let short = cap.lt(wanted);
    let k = R::select(short, cap / wanted, R::lit(1.0));
    (V3::new(x * k, y * k, R::zero()), short.not())
}
