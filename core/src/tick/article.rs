//! The order of a tick in the article's model (docs/physics.md, section 3.1).

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
    let wish = forces::wish(input.forward, input.strafe, p.yaw, rules);
    let mut contact = p.contact();
    let energy = p.energy.get(R::splat(rules.max_energy));
    let mut burn = R::Mask::splat(false);
    #[cfg(feature = "jet")]
    if S::Jet::<R>::MODELED {
        burn = input.jet;
        #[cfg(feature = "energy")]
        if S::Energy::<R>::MODELED {
            burn = forces::jets_burn(input.jet, p.jetting.get(R::Mask::splat(false)), energy, rules);
        }
    }

    #[cfg(feature = "jump")]
    if S::JUMP {
        let grace = R::Int::splat(armor::JUMP_GRACE_MS);
        let jumps = input.jump.and(contact.age.lt(grace));
        let jumped = p.velocity + forces::jump(contact.normal, &wish, rules);
        p.velocity = V3::select(jumps, jumped, p.velocity);
        contact.age = R::Int::select(jumps, grace, contact.age);
    }

    p.crawled = p.velocity.length().lt(R::lit(armor::CRAWL_SPEED));

    let mut gain = V3::new(R::zero(), R::zero(), R::splat(rules.fall));
    #[cfg(feature = "jet")]
    if S::Jet::<R>::MODELED {
        // The age is the one after this tick's jump: a jump turns the jets sideways at once.
        let recent = contact.age.lt(R::Int::splat(armor::JUMP_GRACE_MS));
        let thrust = forces::jet(p.velocity, &wish, recent, rules);
        gain = V3::select(burn, gain + thrust, gain);
    }
    #[cfg(feature = "energy")]
    if S::Energy::<R>::MODELED {
        let drain = R::select(burn, R::splat(rules.drain), R::zero());
        let left = energy + R::splat(rules.recharge) - drain;
        p.energy.set(left.max(R::zero()).min(R::splat(rules.max_energy)));
    }
    p.jetting.set(burn);
    let before = p.velocity;
    p.velocity = p.velocity + gain;

    let (walk, reached) = forces::friction(p.velocity, &wish, p.friction, rules);
    p.velocity = V3::select(p.touched, p.velocity + walk, p.velocity);
    p.crawled = p.crawled.or(p.touched.and(reached));

    contact.age = (contact.age + R::Int::splat(rules.tick_ms)).clamp(0, OLDEST_MS);
    p.contact.set(contact);
    before
}
