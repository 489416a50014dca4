//! What an explosion does to a player: a push and damage (docs/physics.md, section 6).

use crate::player::{Place, Player};
use crate::real::{Mask, Real, Scalar, V3};
use crate::rules::{Cutoff, Knockback, Rules};
use crate::scene::{Group, Scene};
use crate::terrain::Surface;

/// The factor of [`Knockback::LinearBoosted`]: the original is lost, and this one meets the peak of a
/// disc in the game's own form, 2 m from a light's box centre.
pub const BOOST: f64 = 26.0 / 11.0;
/// How far below the surface a blast may lie and still be felt, m: in `f32` about half of all contact
/// points lie a hair below.
pub const COVERED_DEPTH: f64 = 0.05;

/// Which of an armor's factors a damage takes (section 2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Harm {
    /// Explosions: discs.
    Explosion,
    /// Shrapnel: grenades.
    Shrapnel,
    /// Mortar shells.
    Mortar,
}

/// What explodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explosive<T> {
    /// Largest damage, before the armor's factor.
    pub damage: T,
    /// Radius, m.
    pub radius: T,
    /// Impulse at a power of 1, mass units times m/s.
    pub kick: T,
    /// Which of the armor's factors its damage takes.
    pub harm: Harm,
}

impl Explosive<f64> {
    /// The same, rounded to a tier's arithmetic.
    #[must_use]
    pub fn rounded<T: Scalar>(&self) -> Explosive<T> {
        let t = T::from_f64;
        Explosive { damage: t(self.damage), radius: t(self.radius), kick: t(self.kick), harm: self.harm }
    }
}

/// The distance d that counts, max(d0 - m, 1), and whether the blast reaches so far at all.
#[inline(always)]
fn reach<R: Real>(d0: R, min_box: R, radius: R, cutoff: Cutoff) -> (R, R::Mask) {
    let d = (d0 - min_box).max(R::lit(1.0));
    let near = match cutoff {
        Cutoff::Engine => R::Mask::splat(true),
        Cutoff::Radius => d0.le(radius),
    };
    (d, d.lt(radius).and(near))
}

/// The push of a blast, without dimension: times the explosive's kick, over the mass, it is a change of
/// speed. `d0` is the distance from the blast to the box centre, `min_box` the smallest side of the
/// box, all in m. 0 beyond the reach; never negative.
#[inline(always)]
pub fn power<R: Real>(d0: R, min_box: R, radius: R, knockback: Knockback, cutoff: Cutoff) -> R {
    let one = R::lit(1.0);
    let linear = (one - d0 / radius).max(R::zero());
    match knockback {
        Knockback::Tribes => {
            let (d, reached) = reach(d0, min_box, radius, cutoff);
            R::select(reached, (one - d / radius) * (d0 / d), R::zero())
        }
        Knockback::Basic => linear,
        Knockback::LinearBoosted => linear * R::lit(BOOST),
    }
}

/// The share of its largest damage that a blast does at a distance; arguments as for [`power`]. It has
/// its own falloff, the same for every form of the push: flat to a box side beyond a metre, 0 beyond
/// the reach.
#[inline(always)]
pub fn damage_share<R: Real>(d0: R, min_box: R, radius: R, cutoff: Cutoff) -> R {
    let (d, reached) = reach(d0, min_box, radius, cutoff);
    R::select(reached, R::lit(1.0) - d / radius, R::zero())
}

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
