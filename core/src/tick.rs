//! One tick of one player: a pure function of player, input and world (docs/physics.md, 3.1 and 12).

use crate::armor;
use crate::forces;
use crate::input::Input;
use crate::movement::{Movement, Obstacles};
use crate::player::{OLDEST_MS, Player};
use crate::real::{Int, Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};

/// Largest view pitch, radians (88 degrees).
pub const MAX_PITCH: f64 = 1.535_889_741_755_009_3;

/// An angle in radians brought into [-pi, pi).
#[inline(always)]
pub fn wrap_angle<R: Real>(angle: R) -> R {
    let pi = R::lit(core::f64::consts::PI);
    let turn = R::lit(2.0 * core::f64::consts::PI);
    let turns = ((angle + pi) / turn).floor_int();
    let wrapped = angle - R::from_int(turns) * turn;
    let wrapped = R::select(pi.le(wrapped), wrapped - turn, wrapped);
    // The interval's ends are those of the tier: in f32 -pi itself is rounded outwards, by 9e-8.
    wrapped.max(-pi)
}

/// The player one tick later. The position is not yet wrapped back into its tile, so that the
/// segment from the old position to the new one can be tested; see
/// [`Surface::wrap`](crate::terrain::Surface::wrap).
#[inline(always)]
pub fn tick<S: Scene, M: Movement, R: Real, W: Obstacles<R>>(
    before: &Player<S, R>,
    input: &Input<R>,
    world: &W,
    rules: &Rules<R::Scalar>,
) -> Player<S, R> {
    let mut p = *before;
    look(&mut p, input, rules);
    act::<S, M, R, W>(&mut p, input, world, rules);
    p
}

/// Turns the view, which comes before the trigger and the move.
#[inline(always)]
pub fn look<S: Scene, R: Real>(p: &mut Player<S, R>, input: &Input<R>, rules: &Rules<R::Scalar>) {
    p.yaw = wrap_angle(p.yaw + input.turn * R::splat(rules.dt));
    let top = R::lit(MAX_PITCH);
    p.pitch = input.pitch.min(top).max(-top);
}

/// Everything of a tick that comes after the view and the trigger: forces and the move.
#[inline(always)]
pub fn act<S: Scene, M: Movement, R: Real, W: Obstacles<R>>(
    p: &mut Player<S, R>,
    input: &Input<R>,
    world: &W,
    rules: &Rules<R::Scalar>,
) {
    let wish = forces::wish(input.forward, input.strafe, p.yaw, rules);
    let mut contact = p.contact();
    let energy = p.energy.get(R::splat(rules.max_energy));
    let burn = if S::Jet::<R>::MODELED {
        forces::jets_burn(input.jet, p.jetting.get(R::Mask::splat(false)), energy, rules)
    } else {
        R::Mask::splat(false)
    };

    if S::JUMP {
        let grace = R::Int::splat(armor::JUMP_GRACE_MS);
        let jumps = input.jump.and(contact.age.lt(grace));
        let jumped = p.velocity + forces::jump(contact.normal, &wish, rules);
        p.velocity = V3::select(jumps, jumped, p.velocity);
        contact.age = R::Int::select(jumps, grace, contact.age);
    }

    p.crawled = p.velocity.length().lt(R::lit(armor::CRAWL_SPEED));

    let mut gain = V3::new(R::zero(), R::zero(), R::splat(rules.fall));
    if S::Jet::<R>::MODELED {
        let thrust = forces::jet(p.velocity, &wish, &contact, rules);
        gain = V3::select(burn, gain + thrust, gain);
    }
    if S::Energy::<R>::MODELED {
        let drain = R::select(burn, R::splat(rules.drain), R::zero());
        let left = energy + R::splat(rules.recharge) - drain;
        p.energy.set(left.max(R::zero()).min(R::splat(rules.max_energy)));
    }
    p.jetting.set(burn);
    p.velocity = p.velocity + gain;

    let (walk, reached) = forces::friction(p.velocity, &wish, p.friction, rules);
    p.velocity = V3::select(p.touched, p.velocity + walk, p.velocity);
    p.crawled = p.crawled.or(p.touched.and(reached));

    contact.age = (contact.age + R::Int::splat(rules.tick_ms)).clamp(0, OLDEST_MS);
    p.contact.set(contact);

    M::advance(p, world, rules);
}
