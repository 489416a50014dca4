//! Whom an explosion meets, pushes and hurts.

use super::{Explosive, Harm, damage_share, power};
use crate::player::{Place, Player};
use crate::real::{Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::terrain::Surface;

/// How far below the surface a blast may lie and still be felt, m: in `f32` about half of all contact
/// points lie a hair below.
pub const COVERED_DEPTH: f64 = 0.05;

/// The way from a blast to the middle of a player's box, m, and whose box meets the cube about it; arguments
/// as for [`strike`], which leaves all others as they are.
#[inline(always)]
pub fn meets<S: Scene, R: Real>(
    p: &Player<S, R>,
    at: V3<R>,
    struck: R::Mask,
    explosive: &Explosive<R::Scalar>,
    rules: &Rules<R::Scalar>,
) -> (V3<R>, R::Mask) {
    let (width, height) = (R::splat(rules.half_width), R::splat(rules.height) * R::lit(0.5));
    let radius = R::splat(explosive.radius);
    let away = p.position + V3::up() * height - at;
    let beside = away.x.abs().le(width + radius).and(away.y.abs().le(width + radius));
    (away, struck.and(beside).and(away.z.abs().le(height + radius)))
}

/// Pushes and hurts a player where `struck` is set. `at` is the blast in the player's local frame, m
/// (the caller resolves tiles); a NaN there strikes nobody. `coverage` is the share of the body that
/// the blast sees; see [`coverage_on_terrain`] and [`body_points`].
///
/// As in the engine it is felt only by a player whose box meets the cube of half side R about the
/// blast, which sideways ends before R + m does. A blast at the very box centre has no direction: it
/// hurts and does not push.
#[inline(always)]
pub fn strike<S: Scene, R: Real>(
    p: &mut Player<S, R>,
    at: V3<R>,
    struck: R::Mask,
    coverage: R,
    explosive: &Explosive<R::Scalar>,
    rules: &Rules<R::Scalar>,
) {
    let (away, meets) = meets(p, at, struck, explosive, rules);
    let (width, height) = (R::splat(rules.half_width), R::splat(rules.height) * R::lit(0.5));
    let radius = R::splat(explosive.radius);

    let d0 = away.length();
    let min_box = (width + width).min(height + height);
    let physics = &rules.physics;
    let power = power(d0, min_box, radius, physics.knockback, physics.cutoff);
    let pushed = meets.and(R::zero().lt(d0));
    let speed = R::splat(explosive.kick) / R::splat(rules.mass) * power * coverage;
    let safe = R::select(pushed, d0, R::lit(1.0));
    p.velocity = V3::select(pushed, p.velocity + away * (speed / safe), p.velocity);

    #[cfg(feature = "landing_damage")]
    if S::Damage::<R>::MODELED {
        let share = damage_share(d0, min_box, radius, physics.cutoff);
        let factor = match explosive.harm {
            Harm::Explosion => rules.explosion_scale,
            Harm::Shrapnel => rules.shrapnel_scale,
            Harm::Mortar => rules.mortar_scale,
        };
        let scale = R::splat(explosive.damage) * R::splat(factor);
        let damage = p.damage.get(R::zero());
        p.damage.set(R::select(meets, damage + scale * share * coverage, damage));
    }
}

/// A place in the local frame of a player who may be in another tile: the `at` of [`strike`], m.
#[inline(always)]
pub fn seen_from<S: Scene, R: Real>(
    p: &Player<S, R>,
    place: &Place<R>,
    surface: &Surface<'_, R::Scalar>,
) -> V3<R> {
    let (x, y) = surface.tiles_apart::<R>(place.tile_x - p.tile_x, place.tile_y - p.tile_y);
    place.position + V3::new(x, y, R::zero())
}

/// Coverage of a blast over bare terrain: all of a player's body, unless the blast lies deeper than
/// [`COVERED_DEPTH`] below the ground, straight down. `at` is local to the map.
#[inline(always)]
pub fn coverage_on_terrain<R: Real>(surface: &Surface<'_, R::Scalar>, map: R::Int, at: V3<R>) -> R {
    let ground = surface.ground::<R>(map, at.x, at.y);
    let buried = ground.exists.and((at.z + R::lit(COVERED_DEPTH)).lt(ground.height));
    R::select(buried, R::zero(), R::lit(1.0))
}

/// The four points of a body that a blast must see, in the player's local frame: on the axis at a
/// quarter and three quarters of the height, and the left and the right shoulder at five eighths, half
/// of the half width to the side. Sideways is to the sides of the player's view (the sources do not
/// say: the box itself never turns).
#[inline(always)]
pub fn body_points<S: Scene, R: Real>(p: &Player<S, R>, rules: &Rules<R::Scalar>) -> [V3<R>; 4] {
    let (sin, cos) = p.yaw.sin_cos();
    let height = R::splat(rules.height);
    let out = R::splat(rules.half_width) * R::lit(0.5);
    let right = V3::new(cos, sin, R::zero()) * out;
    let up = |share: f64| p.position + V3::up() * (height * R::lit(share));
    let shoulders = up(0.625);
    [up(0.25), up(0.75), shoulders - right, shoulders + right]
}
