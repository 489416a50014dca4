//! The launchers: one table of constants (docs/physics.md, section 7 and the appendix).

use crate::blast::{Explosive, Harm};

/// How a projectile moves and when it bursts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Straight on, without gravity, bursting at the first contact.
    Disc {
        /// Speed that the acceleration leads to, m/s.
        terminal: f64,
        /// Nominal acceleration, m/s^2.
        acceleration: f64,
        /// Mass, which divides the acceleration where the rules say so.
        mass: f64,
    },
    /// Under gravity, bouncing until it is armed and bursting at the first contact after that.
    Shell {
        /// Speed after a bounce over speed before it, along the contact normal.
        elasticity: f64,
        /// Age at which it is armed, ms.
        arms_ms: u32,
    },
}

/// The constants of one launcher and of what it fires.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weapon {
    /// The public name.
    pub name: &'static str,
    /// What explodes.
    pub explosive: Explosive<f64>,
    /// Muzzle speed, m/s.
    pub speed: f64,
    /// Share of the shooter's velocity that the projectile takes along.
    pub inherit: f64,
    /// States between two shots, ms; each lasts whole ticks.
    pub states_ms: [u32; 3],
    /// Age at which the projectile is gone, without a burst, ms.
    pub life_ms: u32,
    /// Shots of a fresh player.
    pub ammo: i32,
    /// How it moves.
    pub motion: Motion,
}

/// Life of grenades and mortar shells, ms. The sources give none: 8 s is longer than a mortar shell
/// fired straight up from the ground takes to come back (7.4 s).
const SHELL_LIFE_MS: u32 = 8000;
/// Shots of every launcher. The sources give the disc launcher's, for a light; the others have the same
/// here, and so has every armor.
const AMMO: i32 = 15;

/// Disc launcher: fire, reload and spin-up.
pub const DISC: Weapon = Weapon {
    name: "disc",
    explosive: Explosive { damage: 0.5, radius: 7.5, kick: 150.0, harm: Harm::Explosion },
    speed: 65.0,
    inherit: 0.5,
    states_ms: [1250, 250, 250],
    life_ms: 6500,
    ammo: AMMO,
    motion: Motion::Disc { terminal: 80.0, acceleration: 5.0, mass: 2.0 },
};

/// Grenade launcher: fire and reload. Its speed is sqrt(150 * 20). The sources do not say which damage a
/// grenade does: here it is shrapnel, which nothing else would be.
pub const GRENADE: Weapon = Weapon {
    name: "grenade",
    explosive: Explosive { damage: 0.4, radius: 15.0, kick: 150.0, harm: Harm::Shrapnel },
    speed: 54.772_255_750_516_61,
    inherit: 0.5,
    states_ms: [500, 500, 0],
    life_ms: SHELL_LIFE_MS,
    ammo: AMMO,
    motion: Motion::Shell { elasticity: 0.45, arms_ms: 1000 },
};

/// Mortar: fire and reload. Its speed is sqrt(275 * 20).
pub const MORTAR: Weapon = Weapon {
    name: "mortar",
    explosive: Explosive { damage: 1.0, radius: 20.0, kick: 250.0, harm: Harm::Mortar },
    speed: 74.161_984_870_956_63,
    inherit: 0.5,
    states_ms: [2000, 500, 0],
    life_ms: SHELL_LIFE_MS,
    ammo: AMMO,
    motion: Motion::Shell { elasticity: 0.1, arms_ms: 2000 },
};

/// Every launcher, by its public name.
pub const WEAPONS: [&Weapon; 3] = [&DISC, &GRENADE, &MORTAR];

/// The muzzle from the shooter's feet, turned by his yaw: right, forward and up, m. An assumption: the
/// true value sits in art files.
pub const MUZZLE: [f64; 3] = [0.2, 0.5, 1.5];
