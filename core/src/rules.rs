//! What is uniform over a batch: armor, tick length and switches, rounded once to the tier's type.

use crate::armor::{self, Armor};
use crate::error::{InputError, refuse};
use crate::real::Scalar;

/// The two movement models (docs/physics.md, section 12): a tier has one of them, so whoever asks
/// asks a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The article's: semi-implicit Euler, point at the feet, ages in milliseconds.
    Article,
    /// The 1998 engine's: trapezoid, sphere, ages in ticks.
    Engine,
}

/// Switches of the movement model (docs/physics.md, section 12).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physics {
    /// Whether the last contact that a tick allows stops the player dead. By default it does in the
    /// `engine` tier and not in the others.
    pub ski_bug: Option<bool>,
    /// Whether jets go out at an energy of 1 and light again at 5. Without it they burn at any energy
    /// above 0, which gives free thrust on an empty tank.
    pub hysteresis: bool,
    /// `swept` tier: whether the literal corner of a contact at once, which pushes the player out of
    /// the surface, is switched off.
    pub clamp_fixup: bool,
    /// `swept` tier: whether the move that redoes the last slice is swept as well.
    pub fixup_swept: bool,
    /// How the push of an explosion falls off.
    pub knockback: Knockback,
    /// Where explosions end.
    pub cutoff: Cutoff,
    /// How discs accelerate.
    pub accel: Acceleration,
    /// How discs fly and where they burst.
    pub disc: DiscFlight,
}

/// How the push of an explosion falls off with distance (docs/physics.md, section 6).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knockback {
    /// The game's: weakest at the box centre, strongest a box side beyond a metre.
    Tribes,
    /// The article's first form, 1 - d/R.
    Basic,
    /// The basic form times 26/11, which meets the game's peak at 2 m.
    LinearBoosted,
}

/// How far an explosion reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cutoff {
    /// The radius and the smallest side of the armor's box, as the engine has it.
    Engine,
    /// The radius alone, as the article has it.
    Radius,
}

/// How a disc accelerates to its terminal speed (section 7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acceleration {
    /// At the nominal 5 m/s^2.
    Nominal,
    /// Not at all.
    None,
    /// At 2.5 m/s^2: the nominal force over the disc's mass.
    Mass,
}

/// How a disc flies (section 7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscFlight {
    /// Swept exactly in every tick, bursting where it meets something.
    Surface,
    /// The 1998 engine's clock of 33 ms, unaccelerated, bursting at the place before the contact.
    Engine,
}

impl Default for Physics {
    fn default() -> Self {
        Self {
            ski_bug: None,
            hysteresis: true,
            clamp_fixup: false,
            fixup_swept: false,
            knockback: Knockback::Tribes,
            cutoff: Cutoff::Engine,
            accel: Acceleration::Nominal,
            disc: DiscFlight::Surface,
        }
    }
}

impl Knockback {
    /// Each by its public name.
    pub const NAMES: [(&str, Self); 3] =
        [("tribes", Self::Tribes), ("basic", Self::Basic), ("linear_boosted", Self::LinearBoosted)];
}

impl Cutoff {
    /// Each by its public name.
    pub const NAMES: [(&str, Self); 2] = [("engine", Self::Engine), ("radius", Self::Radius)];
}

impl Acceleration {
    /// Each by its public name.
    pub const NAMES: [(&str, Self); 3] =
        [("nominal", Self::Nominal), ("none", Self::None), ("mass", Self::Mass)];
}

impl DiscFlight {
    /// Each by its public name.
    pub const NAMES: [(&str, Self); 2] = [("surface", Self::Surface), ("engine", Self::Engine)];
}

/// The value of a public name.
///
/// # Errors
/// If there is none; the message names the argument and the names there are.
pub fn named<T: Copy>(argument: &str, name: &str, names: &[(&str, T)]) -> Result<T, InputError> {
    if let Some((_, value)) = names.iter().find(|(known, _)| *known == name) {
        return Ok(*value);
    }
    let known: Vec<_> = names.iter().map(|(known, _)| format!("{known:?}")).collect();
    refuse!("{argument}: expected one of {}, got {name:?}", known.join(", "))
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
    /// Forward walk speed, m/s; in the article's model also the backward one.
    pub walk_forward: T,
    /// Sideways walk speed, m/s; in the engine's model also the backward one.
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
    /// Energy gained per tick, an energy pack's share included.
    pub recharge: T,
    /// The energy pack's share of it; 0 without one.
    pub pack_recharge: T,
    /// Age of a fresh player's contact memory: expired.
    pub fresh_age: i32,
    /// Energy the jets use per tick.
    pub drain: T,
    /// Damage that kills.
    pub max_damage: T,
    /// Damage per m/s of landing speed.
    pub landing_scale: T,
    /// Half of the width and depth of the armor's box, m.
    pub half_width: T,
    /// Height of the armor's box, m.
    pub height: T,
    /// Mass.
    pub mass: T,
    /// What the armor makes of an explosion's damage.
    pub explosion_scale: T,
    /// What it makes of a grenade's.
    pub shrapnel_scale: T,
    /// What it makes of a mortar shell's.
    pub mortar_scale: T,
    /// Switches.
    pub physics: Physics,
}

impl<T: Scalar> Rules<T> {
    /// The rules of a model for an armor at a tick length.
    #[must_use]
    pub fn new(model: Model, armor: &Armor, energy_pack: bool, tick_ms: u32, physics: Physics) -> Self {
        let dt = f64::from(tick_ms) / 1000.0;
        let pack_recharge = if energy_pack { armor::PACK_RECHARGE } else { 0.0 };
        let recharge = armor::RECHARGE + pack_recharge;
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
            pack_recharge: t(pack_recharge * dt),
            fresh_age: match model {
                Model::Article => armor::JUMP_GRACE_MS,
                Model::Engine => armor::ENGINE_FRESH_AGE,
            },
            drain: t(armor.jet_drain * dt),
            max_damage: t(armor.max_damage),
            landing_scale: t(armor.landing_scale),
            half_width: t(armor.half_width),
            height: t(armor.height),
            mass: t(armor.mass),
            explosion_scale: t(armor.explosion_scale),
            shrapnel_scale: t(armor.shrapnel_scale),
            mortar_scale: t(armor.mortar_scale),
            physics,
        }
    }
}
