//! What an explosion does to a player: a push and damage (docs/physics.md, section 6).

#[cfg(feature = "blast")]
mod strike;

#[cfg(feature = "blast")]
pub use strike::{COVERED_DEPTH, body_points, coverage_on_terrain, meets, seen_from, strike};

use crate::real::{Mask, Real, Scalar};
use crate::rules::{Cutoff, Knockback};

/// The factor of [`Knockback::LinearBoosted`]: the original is lost, and this one meets the peak of a
/// disc in the game's own form, 2 m from a light's box centre.
pub const BOOST: f64 = 26.0 / 11.0;
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
