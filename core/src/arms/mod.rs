//! A player's launcher and its projectiles: constants and state. How they are fired and how they fly
//! is the room [`flight`](crate::flight)'s.

mod arsenal;
mod fields;
mod weapons;

pub use arsenal::{Arsenal, Flight};
pub use fields::{visit, visit_launcher};
pub use weapons::{DISC, GRENADE, MORTAR, MUZZLE, Motion, WEAPONS, Weapon};

use crate::player::Place;
use crate::real::{Int, Real, V3};

/// Projectiles of one player that can be under way at once: as many as any launcher can fire within
/// the life of one, at any tick length.
pub const SLOTS: usize = 8;

/// [`Projectile::phase`] of an empty slot.
pub const FREE: i32 = 0;
/// [`Projectile::phase`] of a projectile under way.
pub const FLYING: i32 = 1;
/// [`Projectile::phase`] of a projectile that burst in the last tick.
pub const BURST: i32 = 2;

/// A slot for one projectile, or one slot of as many players as `R` has lanes.
#[derive(Clone, Copy, Debug)]
pub struct Projectile<R: Real> {
    /// Local position, m. Once it has burst: of the blast.
    pub position: V3<R>,
    /// Tiles east of the first one.
    pub tile_x: R::Int,
    /// Tiles north of the first one.
    pub tile_y: R::Int,
    /// Velocity, m/s.
    pub velocity: V3<R>,
    /// Ticks since the shot, the tick of the shot included.
    pub age: R::Int,
    /// [`FREE`], [`FLYING`] or [`BURST`].
    pub phase: R::Int,
    /// The engine disc's clock, ms; 0 for others.
    pub clock: R::Int,
    /// While it flies the direction it was aimed in; once it has burst the normal of what it met.
    /// Length 1.
    pub axis: V3<R>,
}

impl<R: Real> Projectile<R> {
    /// An empty slot.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let zero = R::Int::splat(0);
        Self {
            position: V3::zero(),
            tile_x: zero,
            tile_y: zero,
            velocity: V3::zero(),
            age: zero,
            phase: R::Int::splat(FREE),
            clock: zero,
            axis: V3::zero(),
        }
    }

    /// `a` where the mask is set, `b` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: R::Mask, a: &Self, b: &Self) -> Self {
        Self {
            position: V3::select(mask, a.position, b.position),
            tile_x: R::Int::select(mask, a.tile_x, b.tile_x),
            tile_y: R::Int::select(mask, a.tile_y, b.tile_y),
            velocity: V3::select(mask, a.velocity, b.velocity),
            age: R::Int::select(mask, a.age, b.age),
            phase: R::Int::select(mask, a.phase, b.phase),
            clock: R::Int::select(mask, a.clock, b.clock),
            axis: V3::select(mask, a.axis, b.axis),
        }
    }

    /// Whether it is under way.
    #[inline(always)]
    pub fn flying(&self) -> R::Mask {
        self.phase.eq(R::Int::splat(FLYING))
    }

    /// Whether it burst in the last tick.
    #[inline(always)]
    pub fn burst(&self) -> R::Mask {
        self.phase.eq(R::Int::splat(BURST))
    }

    /// Where it is, on a map.
    #[inline(always)]
    pub fn place(&self, map: R::Int) -> Place<R> {
        Place { position: self.position, tile_x: self.tile_x, tile_y: self.tile_y, map }
    }

    /// The projectile in one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Projectile<R::Scalar> {
        Projectile {
            position: self.position.lane(lane),
            tile_x: self.tile_x.lane(lane),
            tile_y: self.tile_y.lane(lane),
            velocity: self.velocity.lane(lane),
            age: self.age.lane(lane),
            phase: self.phase.lane(lane),
            clock: self.clock.lane(lane),
            axis: self.axis.lane(lane),
        }
    }

    /// Overwrites one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, p: &Projectile<R::Scalar>) {
        self.position.set_lane(lane, p.position);
        self.tile_x.set_lane(lane, p.tile_x);
        self.tile_y.set_lane(lane, p.tile_y);
        self.velocity.set_lane(lane, p.velocity);
        self.age.set_lane(lane, p.age);
        self.phase.set_lane(lane, p.phase);
        self.clock.set_lane(lane, p.clock);
        self.axis.set_lane(lane, p.axis);
    }
}

/// A player's launcher, or those of as many players as `R` has lanes. It lies beside the players, not
/// in them.
#[derive(Clone, Copy, Debug)]
pub struct Arms<R: Real> {
    /// Ticks until it can fire again; 0 is ready.
    pub cooldown: R::Int,
    /// Shots left.
    pub ammo: R::Int,
    /// Its projectiles.
    pub slots: [Projectile<R>; SLOTS],
}

impl<R: Real> Arms<R> {
    /// A full launcher, ready to fire.
    #[must_use]
    pub fn new(arsenal: &Arsenal<R::Scalar>) -> Self {
        let (cooldown, ammo) = (R::Int::splat(0), R::Int::splat(arsenal.ammo));
        Self { cooldown, ammo, slots: [Projectile::none(); SLOTS] }
    }

    /// A launcher that has nothing to fire.
    #[inline(always)]
    #[must_use]
    pub fn empty() -> Self {
        let zero = R::Int::splat(0);
        Self { cooldown: zero, ammo: zero, slots: [Projectile::none(); SLOTS] }
    }

    /// The launcher in one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Arms<R::Scalar> {
        Arms {
            cooldown: self.cooldown.lane(lane),
            ammo: self.ammo.lane(lane),
            slots: self.slots.map(|slot| slot.lane(lane)),
        }
    }

    /// Overwrites one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, arms: &Arms<R::Scalar>) {
        self.cooldown.set_lane(lane, arms.cooldown);
        self.ammo.set_lane(lane, arms.ammo);
        for (mine, theirs) in self.slots.iter_mut().zip(&arms.slots) {
            mine.set_lane(lane, theirs);
        }
    }
}
