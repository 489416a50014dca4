//! What is uniform over a batch: armor, tick length and switches, rounded once to the tier's type.

use crate::armor::{self, Armor};
use crate::real::Scalar;

/// Switches of the movement model (docs/physics.md, section 12).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physics {
    /// Whether the fourth contact of a tick stops the player dead.
    pub ski_bug: bool,
    /// Whether jets go out at an energy of 1 and light again at 5. Without it they burn at any energy
    /// above 0, which gives free thrust on an empty tank.
    pub hysteresis: bool,
}

impl Default for Physics {
    fn default() -> Self {
        Self { ski_bug: false, hysteresis: true }
    }
}

/// Constants per tick, in the arithmetic of the tier.
#[derive(Clone, Copy, Debug)]
pub struct Rules<T> {
    /// Tick length, s.
    pub dt: T,
    /// Tick length, ms.
    pub tick_ms: i32,
    /// Speed gained by gravity in a tick, m/s (negative).
    pub fall: T,
    /// Forward and backward walk speed, m/s.
    pub walk_forward: T,
    /// Sideways walk speed, m/s.
    pub walk_side: T,
    /// Speed of a jump, J/m, m/s.
    pub jump: T,
    /// Speed gained by the jets in a tick, m/s.
    pub jet: T,
    /// Largest sideways share of the jets.
    pub max_sideways: T,
    /// Speed at which the sideways share has faded out, m/s.
    pub fade_speed: T,
    /// Largest change of speed by ground friction in a tick, m/s.
    pub grip: T,
    /// Ground traction.
    pub traction: T,
    /// Energy tank.
    pub max_energy: T,
    /// Energy gained per tick.
    pub recharge: T,
    /// Energy the jets use per tick.
    pub drain: T,
    /// Damage that kills.
    pub max_damage: T,
    /// Damage per m/s of landing speed.
    pub landing_scale: T,
    /// Switches.
    pub physics: Physics,
}

impl<T: Scalar> Rules<T> {
    /// The rules of an armor at a tick length.
    #[must_use]
    pub fn new(armor: &Armor, energy_pack: bool, tick_ms: u32, physics: Physics) -> Self {
        let dt = f64::from(tick_ms) / 1000.0;
        let recharge = armor::RECHARGE + if energy_pack { armor::PACK_RECHARGE } else { 0.0 };
        let t = T::from_f64;
        Self {
            dt: t(dt),
            tick_ms: tick_ms.cast_signed(),
            fall: t(armor::GRAVITY * dt),
            walk_forward: t(armor.walk_speed),
            walk_side: t(armor.walk_speed - 1.0),
            jump: t(armor.jump_impulse / armor.mass),
            jet: t(armor.jet_force / armor.mass * dt),
            max_sideways: t(armor.max_sideways),
            fade_speed: t(armor.fade_speed),
            grip: t(armor.ground_force / armor.mass * dt),
            traction: t(armor.traction),
            max_energy: t(armor.max_energy),
            recharge: t(recharge * dt),
            drain: t(armor.jet_drain * dt),
            max_damage: t(armor.max_damage),
            landing_scale: t(armor.landing_scale),
            physics,
        }
    }
}
