//! What a contact does to a player (docs/physics.md, sections 4.4 and 5).

use super::Obstacles;
use crate::armor;
use crate::player::{Place, Player};
use crate::real::{Int, Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::{Group, Scene};
use crate::terrain::Hit;

/// Applies a contact with a surface of the given normal where `hit` is set: landing damage, memory
/// of the jumpable surface, and the velocity turned out of the surface. Nothing tangential.
///
/// `model` is a constant of the caller, so one side of each choice is all that is compiled.
#[inline(always)]
pub fn bounce<S: Scene, R: Real>(
    p: &mut Player<S, R>,
    hit: R::Mask,
    normal: V3<R>,
    model: Model,
    rules: &Rules<R::Scalar>,
) {
    let impact = -p.velocity.dot(normal);
    #[cfg(feature = "landing_damage")]
    if S::Damage::<R>::MODELED {
        let excess = (impact - R::lit(armor::LANDING_FREE_SPEED)).max(R::zero());
        let damage = p.damage.get(R::zero());
        let hurt = damage + excess * R::splat(rules.landing_scale);
        p.damage.set(R::select(hit, hurt, damage));
    }
    if S::Contact::<R>::MODELED {
        let mut contact = p.contact();
        let least = R::lit(armor::JUMPABLE_UP);
        let (jumpable, preferred, tick) = match model {
            Model::Article => (least.le(normal.z), normal.z.lt(contact.normal.z), rules.tick_ms),
            Model::Engine => (least.lt(normal.z), contact.normal.z.lt(normal.z), 1),
        };
        let older = R::Int::splat(tick).lt(contact.age);
        let remember = hit.and(jumpable).and(older.or(preferred));
        contact.normal = V3::select(remember, normal, contact.normal);
        contact.age = R::Int::select(remember, R::Int::splat(0), contact.age);
        p.contact.set(contact);
    }
    let push = match model {
        Model::Article => armor::OUTWARD_PUSH,
        Model::Engine => armor::ENGINE_OUTWARD_PUSH,
    };
    let out = p.velocity + normal * (impact + R::lit(push));
    p.velocity = V3::select(hit, out, p.velocity);
}

/// The move of those in `passed`, who met nothing and end at `end`.
#[inline(always)]
pub fn untouched<S: Scene, R: Real>(p: &mut Player<S, R>, passed: R::Mask, end: V3<R>) {
    p.position = V3::select(passed, end, p.position);
    p.friction = R::select(passed, R::zero(), p.friction);
    p.touched = p.touched.and(passed.not());
}

/// Lifts those who met a ledge of a body that can be stepped onto; returns those who did not, and are
/// blocked. `steep` is the largest n.up that is tried.
#[inline(always)]
pub fn step_over<S: Scene, R: Real, W: Obstacles<R>>(
    p: &mut Player<S, R>,
    world: &W,
    (at, path): (&Place<R>, V3<R>),
    hit: &Hit<R>,
    struck: R::Mask,
    steep: R::Mask,
) -> R::Mask {
    if !W::BODIES {
        return struck;
    }
    let lift = world.step_up(at, path, hit, struck.and(steep));
    p.position.z = p.position.z + lift;
    struck.and(R::zero().lt(lift).not())
}

/// What the contacts of one tick add up to in the article's tiers.
#[derive(Clone, Copy, Debug)]
pub struct Tally<R: Real> {
    bumps: R::Int,
    grip: R,
    touched: R::Mask,
}

impl<R: Real> Tally<R> {
    /// Before the first contact.
    #[inline(always)]
    pub fn new() -> Self {
        Self { bumps: R::Int::splat(0), grip: R::zero(), touched: R::Mask::splat(false) }
    }

    /// A contact of those in `struck`, who moved from `at` along `path`: a step up, or a bounce after
    /// which the stop rule may put them back to `begin`. Returns those whose tick it ends.
    #[inline(always)]
    pub fn meet<S: Scene, W: Obstacles<R>>(
        &mut self,
        p: &mut Player<S, R>,
        world: &W,
        (at, path, begin): (&Place<R>, V3<R>, V3<R>),
        (hit, struck): (&Hit<R>, R::Mask),
        rules: &Rules<R::Scalar>,
    ) -> R::Mask {
        self.touched = self.touched.or(struck);
        let steep = hit.normal.z.lt(R::lit(armor::JUMPABLE_UP));
        let blocked = step_over(p, world, (at, path), hit, struck, steep);
        world.note(p, blocked, at.position + path * hit.fraction, hit.normal);
        bounce(p, blocked, hit.normal, Model::Article, rules);
        let upward = blocked.and(R::zero().lt(hit.normal.z));
        self.grip = R::select(upward, hit.normal.z, self.grip);
        let slow = p.velocity.length().lt(R::lit(armor::STOP_SPEED));
        let stops = upward.and(p.crawled).and(slow);
        p.velocity = V3::select(stops, V3::zero(), p.velocity);
        p.position = V3::select(stops, begin, p.position);
        self.bumps = R::Int::select(struck, self.bumps + R::Int::splat(1), self.bumps);
        stops
    }

    /// Those among `moving` who have used up the bumps of the tick; with the ski bug it stops them dead.
    #[inline(always)]
    pub fn limit<S: Scene>(
        &self,
        p: &mut Player<S, R>,
        moving: R::Mask,
        rules: &Rules<R::Scalar>,
    ) -> R::Mask {
        let exhausted = R::Int::splat(armor::MAX_BUMPS - 1).lt(self.bumps).and(moving);
        p.count_bump_limit(exhausted);
        if rules.physics.ski_bug.unwrap_or(false) {
            p.velocity = V3::select(exhausted, V3::zero(), p.velocity);
        }
        exhausted
    }

    /// Friction memory at the end of the move.
    #[inline(always)]
    pub fn settle<S: Scene>(&self, p: &mut Player<S, R>) {
        let memory = self.grip.max(R::lit(armor::FRICTION_MEMORY) * p.friction).min(R::lit(1.0));
        p.friction = R::select(self.touched, memory, R::zero());
        p.touched = self.touched;
    }
}

/// How many slices a move of so many metres takes; 0 where nothing moves, and one, swept exactly, where
/// there would be too many.
#[inline(always)]
pub fn slices<R: Real>(metres: R) -> R::Int {
    let wanted = (metres / R::lit(armor::SLICE)).ceil_int();
    let many = R::Int::splat(armor::MAX_SLICES).lt(wanted);
    R::Int::select(many, R::Int::splat(1), wanted)
}
