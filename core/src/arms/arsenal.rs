//! A launcher at a tick length, rounded once to the tier's arithmetic.

use super::weapons::{Motion, Weapon};
use crate::armor;
use crate::blast::Explosive;
use crate::real::Scalar;
use crate::rules::{Acceleration, DiscFlight, Physics};

/// A projectile's motion per tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Flight<T> {
    /// A disc that is swept through every tick and bursts where it meets something.
    Disc {
        /// Speed along the aim that the acceleration leads to, m/s.
        terminal: T,
        /// Speed gained per tick on the way there, m/s.
        gain: T,
    },
    /// The 1998 engine's disc: steps of its own clock, and a burst where the last one began.
    EngineDisc {
        /// Terminal speed, m/s.
        terminal: T,
    },
    /// A shell under gravity.
    Shell {
        /// Speed gained by gravity in a tick, m/s (negative).
        fall: T,
        /// Speed after a bounce over speed before it, along the normal.
        elasticity: T,
        /// Ticks after which it bursts at a contact instead of bouncing.
        arms: i32,
    },
}

/// What is uniform over a batch about the launcher of its players.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arsenal<T> {
    /// What its projectiles do when they burst.
    pub explosive: Explosive<T>,
    /// Muzzle speed, m/s.
    pub speed: T,
    /// Share of the shooter's velocity that a projectile takes along.
    pub inherit: T,
    /// Ticks from one shot to the next with the trigger held.
    pub cycle: i32,
    /// A projectile is gone in its tick of this number, the tick of the shot being the first.
    pub life: i32,
    /// Shots of a fresh player.
    pub ammo: i32,
    /// How projectiles fly.
    pub flight: Flight<T>,
    /// Tick length, s.
    pub dt: T,
    /// Tick length, ms.
    pub tick_ms: i32,
}

impl<T: Scalar> Arsenal<T> {
    /// A launcher at a tick length. States and ages are milliseconds, rounded up to ticks.
    #[must_use]
    pub fn new(weapon: &Weapon, tick_ms: u32, physics: &Physics) -> Self {
        let ticks = |ms: u32| ms.div_ceil(tick_ms).cast_signed();
        let dt = f64::from(tick_ms) / 1000.0;
        let t = T::from_f64;
        let flight = match weapon.motion {
            Motion::Disc { terminal, .. } if physics.disc == DiscFlight::Engine => {
                Flight::EngineDisc { terminal: t(terminal) }
            }
            Motion::Disc { terminal, acceleration, mass } => {
                let acceleration = match physics.accel {
                    Acceleration::Nominal => acceleration,
                    Acceleration::Mass => acceleration / mass,
                    Acceleration::None => 0.0,
                };
                Flight::Disc { terminal: t(terminal), gain: t(acceleration * dt) }
            }
            Motion::Shell { elasticity, arms_ms } => Flight::Shell {
                fall: t(armor::GRAVITY * dt),
                elasticity: t(elasticity),
                arms: ticks(arms_ms),
            },
        };
        Self {
            explosive: weapon.explosive.rounded(),
            speed: t(weapon.speed),
            inherit: t(weapon.inherit),
            cycle: weapon.states_ms.iter().map(|&ms| ticks(ms)).sum(),
            life: ticks(weapon.life_ms),
            ammo: weapon.ammo,
            flight,
            dt: t(dt),
            tick_ms: tick_ms.cast_signed(),
        }
    }
}
