//! The player: one flat struct that is the whole truth about him.

mod fields;

pub use fields::{Describe, Field, FieldKind, FieldVisitor, fields, packed_bytes, visit, visit_vector};

use crate::armor::JUMP_GRACE_MS;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};

/// Memory of the last surface that could be jumped from.
#[derive(Clone, Copy, Debug)]
pub struct Contact<R: Real> {
    /// Its normal.
    pub normal: V3<R>,
    /// Milliseconds since it was touched, saturating at [`OLDEST_MS`]; [`JUMP_GRACE_MS`] or more: expired.
    /// In the `engine` tier it counts ticks (saturating at the same number), and is expired from
    /// [`ENGINE_JUMP_GRACE`](crate::armor::ENGINE_JUMP_GRACE) on.
    pub age: R::Int,
}

/// Ages stop here: two weeks, and far from the end of `i32`.
pub const OLDEST_MS: i32 = 1 << 30;

/// The count of exhausted bump limits stops here.
pub const MOST_BUMP_LIMITS: i32 = 1 << 30;

/// Where somebody is: a local position, its tile and its map.
#[derive(Clone, Copy, Debug)]
pub struct Place<R: Real> {
    /// Local position, m.
    pub position: V3<R>,
    /// Tiles east of the first one.
    pub tile_x: R::Int,
    /// Tiles north of the first one.
    pub tile_y: R::Int,
    /// Where the map starts in the pool of heights.
    pub map: R::Int,
}

impl<R: Real> Place<R> {
    /// The place in one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Place<R::Scalar> {
        Place {
            position: self.position.lane(lane),
            tile_x: self.tile_x.lane(lane),
            tile_y: self.tile_y.lane(lane),
            map: self.map.lane(lane),
        }
    }
}

/// State of one player, or of as many as `R` has lanes (docs/physics.md, section 3.1).
///
/// The origin is the centre of the feet. Positions are local: metres from the map's centre vertex,
/// kept within one period of a tiling map, with the tile counted beside it. So a player 1e9 m away
/// is simulated as exactly as one at the centre.
#[derive(Clone, Copy, Debug)]
pub struct Player<S: Scene, R: Real> {
    /// Local position, m.
    pub position: V3<R>,
    /// Tiles east of the first one.
    pub tile_x: R::Int,
    /// Tiles north of the first one.
    pub tile_y: R::Int,
    /// Where the player's map starts in the pool of heights.
    pub map: R::Int,
    /// Velocity, m/s.
    pub velocity: V3<R>,
    /// View yaw, radians counter-clockwise from north, in [-pi, pi).
    pub yaw: R,
    /// View pitch, radians, up positive.
    pub pitch: R,
    /// Friction memory f, 0 to 1.
    pub friction: R,
    /// Whether anything was touched in the last tick.
    pub touched: R::Mask,
    /// Whether the player crawled or had the speed he wished for.
    pub crawled: R::Mask,
    /// The last jumpable contact.
    pub contact: S::Contact<R>,
    /// Whether the jets burn.
    pub jetting: S::Jet<R>,
    /// Jet energy.
    pub energy: S::Energy<R>,
    /// Damage taken.
    pub damage: S::Damage<R>,
    /// Ticks that ended at the bump limit since the state was set.
    pub bump_limits: S::BumpLimits<R>,
}

impl<S: Scene, R: Real> Player<S, R> {
    /// A fresh player at rest: full tank, no damage, no memory of any contact.
    #[must_use]
    pub fn new(rules: &Rules<R::Scalar>, position: V3<R>, map: R::Int) -> Self {
        let off = R::Mask::splat(false);
        let zero = R::Int::splat(0);
        Self {
            position,
            tile_x: zero,
            tile_y: zero,
            map,
            velocity: V3::zero(),
            yaw: R::zero(),
            pitch: R::zero(),
            friction: R::zero(),
            touched: off,
            crawled: off,
            contact: Group::new(Contact { normal: V3::up(), age: R::Int::splat(rules.fresh_age) }),
            jetting: Group::new(off),
            energy: Group::new(R::splat(rules.max_energy)),
            damage: Group::new(R::zero()),
            bump_limits: Group::new(zero),
        }
    }

    /// `a` where the mask is set, `b` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: R::Mask, a: &Self, b: &Self) -> Self {
        let (zero, none, off) = (R::zero(), R::Int::splat(0), R::Mask::splat(false));
        let (x, y) = (a.contact(), b.contact());
        Self {
            position: V3::select(mask, a.position, b.position),
            tile_x: R::Int::select(mask, a.tile_x, b.tile_x),
            tile_y: R::Int::select(mask, a.tile_y, b.tile_y),
            map: R::Int::select(mask, a.map, b.map),
            velocity: V3::select(mask, a.velocity, b.velocity),
            yaw: R::select(mask, a.yaw, b.yaw),
            pitch: R::select(mask, a.pitch, b.pitch),
            friction: R::select(mask, a.friction, b.friction),
            touched: mask.pick(a.touched, b.touched),
            crawled: mask.pick(a.crawled, b.crawled),
            contact: Group::new(Contact {
                normal: V3::select(mask, x.normal, y.normal),
                age: R::Int::select(mask, x.age, y.age),
            }),
            jetting: Group::new(mask.pick(a.jetting.get(off), b.jetting.get(off))),
            energy: Group::new(R::select(mask, a.energy.get(zero), b.energy.get(zero))),
            damage: Group::new(R::select(mask, a.damage.get(zero), b.damage.get(zero))),
            bump_limits: Group::new(R::Int::select(mask, a.bump_limits.get(none), b.bump_limits.get(none))),
        }
    }

    /// The player in one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Player<S, R::Scalar> {
        let none = Contact { normal: V3::up(), age: R::Int::splat(0) };
        let contact = self.contact.get(none);
        Player {
            position: self.position.lane(lane),
            tile_x: self.tile_x.lane(lane),
            tile_y: self.tile_y.lane(lane),
            map: self.map.lane(lane),
            velocity: self.velocity.lane(lane),
            yaw: self.yaw.lane(lane),
            pitch: self.pitch.lane(lane),
            friction: self.friction.lane(lane),
            touched: self.touched.lane(lane),
            crawled: self.crawled.lane(lane),
            contact: Group::new(Contact { normal: contact.normal.lane(lane), age: contact.age.lane(lane) }),
            jetting: Group::new(self.jetting.get(R::Mask::splat(false)).lane(lane)),
            energy: Group::new(self.energy.get(R::zero()).lane(lane)),
            damage: Group::new(self.damage.get(R::zero()).lane(lane)),
            bump_limits: Group::new(self.bump_limits.get(R::Int::splat(0)).lane(lane)),
        }
    }

    /// Overwrites one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, p: &Player<S, R::Scalar>) {
        self.position.set_lane(lane, p.position);
        self.tile_x.set_lane(lane, p.tile_x);
        self.tile_y.set_lane(lane, p.tile_y);
        self.map.set_lane(lane, p.map);
        self.velocity.set_lane(lane, p.velocity);
        self.yaw.set_lane(lane, p.yaw);
        self.pitch.set_lane(lane, p.pitch);
        self.friction.set_lane(lane, p.friction);
        self.touched.set_lane(lane, p.touched);
        self.crawled.set_lane(lane, p.crawled);
        let none = Contact { normal: V3::up(), age: 0 };
        let theirs = p.contact.get(none);
        let mut contact = self.contact.get(Contact { normal: V3::up(), age: R::Int::splat(0) });
        contact.normal.set_lane(lane, theirs.normal);
        contact.age.set_lane(lane, theirs.age);
        self.contact.set(contact);
        let mut jetting = self.jetting.get(R::Mask::splat(false));
        jetting.set_lane(lane, p.jetting.get(false));
        self.jetting.set(jetting);
        let mut energy = self.energy.get(R::zero());
        energy.set_lane(lane, p.energy.get(R::Scalar::default()));
        self.energy.set(energy);
        let mut damage = self.damage.get(R::zero());
        damage.set_lane(lane, p.damage.get(R::Scalar::default()));
        self.damage.set(damage);
        let mut limits = self.bump_limits.get(R::Int::splat(0));
        limits.set_lane(lane, p.bump_limits.get(0));
        self.bump_limits.set(limits);
    }

    /// Copies what a move over bare terrain reads or writes from one lane of others. A field that such a
    /// move comes to use must be listed here.
    #[inline(always)]
    pub fn copy_move(&mut self, lane: usize, from: &Self, there: usize) {
        self.position.copy_lane(lane, &from.position, there);
        self.map.copy_lane(lane, &from.map, there);
        self.velocity.copy_lane(lane, &from.velocity, there);
        self.friction.copy_lane(lane, &from.friction, there);
        self.touched.copy_lane(lane, &from.touched, there);
        self.crawled.copy_lane(lane, &from.crawled, there);
        if let (Some(to), Some(from)) = (self.contact.as_mut(), from.contact.as_ref()) {
            to.normal.copy_lane(lane, &from.normal, there);
            to.age.copy_lane(lane, &from.age, there);
        }
        if let (Some(to), Some(from)) = (self.damage.as_mut(), from.damage.as_ref()) {
            to.copy_lane(lane, from, there);
        }
        if let (Some(to), Some(from)) = (self.bump_limits.as_mut(), from.bump_limits.as_ref()) {
            to.copy_lane(lane, from, there);
        }
    }

    /// Where the player is.
    #[inline(always)]
    #[must_use]
    pub fn place(&self) -> Place<R> {
        Place { position: self.position, tile_x: self.tile_x, tile_y: self.tile_y, map: self.map }
    }

    /// Counts a tick that the bump limit ended.
    #[inline(always)]
    pub fn count_bump_limit(&mut self, exhausted: R::Mask) {
        #[cfg(feature = "bump_limits")]
        if S::BumpLimits::<R>::MODELED {
            let count = self.bump_limits.get(R::Int::splat(0));
            let more = (count + R::Int::splat(1)).clamp(0, MOST_BUMP_LIMITS);
            self.bump_limits.set(R::Int::select(exhausted, more, count));
        }
    }

    /// The normal and age of the last jumpable contact; expired, in either model, where the scene has no
    /// such memory.
    #[inline(always)]
    #[must_use]
    pub fn contact(&self) -> Contact<R> {
        self.contact.get(Contact { normal: V3::up(), age: R::Int::splat(JUMP_GRACE_MS) })
    }
}
