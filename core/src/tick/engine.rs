//! The order of a tick in the 1998 engine's model (docs/physics.md, section 3.2).

use crate::armor;
use crate::forces;
use crate::input::Input;
use crate::player::{OLDEST_MS, Player};
use crate::real::{Int, Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};

/// Everything before the move. Returns the velocity after the jump and before the tick's forces.
#[inline(always)]
pub(super) fn push<S: Scene, R: Real>(
    p: &mut Player<S, R>,
    input: &Input<R>,
    rules: &Rules<R::Scalar>,
) -> V3<R> {
    let wish = forces::engine_wish(input.forward, input.strafe, p.yaw, rules);
    let mut contact = p.contact();
    let grace = R::Int::splat(armor::ENGINE_JUMP_GRACE);
    #[cfg(feature = "jump")]
    if S::JUMP {
        let jumps = input.jump.and(contact.age.lt(grace));
        let jumped = p.velocity + forces::jump(contact.normal, &wish, rules);
        p.velocity = V3::select(jumps, jumped, p.velocity);
        contact.age = R::Int::select(jumps, grace, contact.age);
        p.contact.set(contact);
    }

    // The pack is a device of its own, served before the jets ask for energy; a full tank takes nothing.
    let full = R::splat(rules.max_energy);
    let energy = (p.energy.get(full) + R::splat(rules.pack_recharge)).min(full);
    let mut gain = V3::new(R::zero(), R::zero(), R::splat(rules.fall));
    let mut burn = R::Mask::splat(false);
    #[cfg(feature = "jet")]
    if S::Jet::<R>::MODELED {
        burn = input.jet;
        #[cfg(feature = "energy")]
        if S::Energy::<R>::MODELED {
            burn = forces::jets_burn(input.jet, p.jetting.get(R::Mask::splat(false)), energy, rules);
        }
        // The tick of a jump still counts as recent: sideways thrust comes one tick later.
        let recent = grace.lt(contact.age).not();
        let thrust = forces::jet(p.velocity, &wish, recent, rules);
        gain = V3::select(burn, gain + thrust, gain);
    }
    p.jetting.set(burn);
    #[cfg(feature = "energy")]
    if S::Energy::<R>::MODELED {
        let drain = R::select(burn, R::splat(rules.drain), R::zero());
        let left = energy - drain + (R::splat(rules.recharge) - R::splat(rules.pack_recharge));
        p.energy.set(left.max(R::zero()).min(full));
    }

    let before = p.velocity;
    p.velocity = p.velocity + gain;
    let (walk, reached) = forces::friction(p.velocity, &wish, p.friction, rules);
    p.velocity = V3::select(p.touched, p.velocity + walk, p.velocity);
    let still = before.length().lt(R::lit(armor::CRAWL_SPEED));
    p.crawled = p.touched.pick(reached, still);
    before
}

/// What follows the move: the last contact is a tick older.
#[inline(always)]
pub(super) fn age<S: Scene, R: Real>(p: &mut Player<S, R>) {
    let mut contact = p.contact();
    contact.age = (contact.age + R::Int::splat(1)).clamp(0, OLDEST_MS);
    p.contact.set(contact);
}
