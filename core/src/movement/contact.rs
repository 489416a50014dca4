//! What a contact does to a player, in every movement tier (docs/physics.md, section 5).

use crate::armor;
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};

/// Applies a contact with a surface of the given normal where `hit` is set: landing damage, memory
/// of the jumpable surface, and the velocity turned out of the surface. Nothing tangential.
#[inline(always)]
pub fn bounce<S: Scene, R: Real>(
    p: &mut Player<S, R>,
    hit: R::Mask,
    normal: V3<R>,
    rules: &Rules<R::Scalar>,
) {
    let impact = -p.velocity.dot(normal);
    if S::Damage::<R>::MODELED {
        let excess = (impact - R::lit(armor::LANDING_FREE_SPEED)).max(R::zero());
        let damage = p.damage.get(R::zero());
        let hurt = damage + excess * R::splat(rules.landing_scale);
        p.damage.set(R::select(hit, hurt, damage));
    }
    if S::Contact::<R>::MODELED {
        let mut contact = p.contact();
        let jumpable = R::lit(armor::JUMPABLE_UP).le(normal.z);
        let older = R::Int::splat(rules.tick_ms).lt(contact.age);
        let steeper = normal.z.lt(contact.normal.z);
        let remember = hit.and(jumpable).and(older.or(steeper));
        contact.normal = V3::select(remember, normal, contact.normal);
        contact.age = R::Int::select(remember, R::Int::splat(0), contact.age);
        p.contact.set(contact);
    }
    let out = p.velocity + normal * (impact + R::lit(armor::OUTWARD_PUSH));
    p.velocity = V3::select(hit, out, p.velocity);
}
