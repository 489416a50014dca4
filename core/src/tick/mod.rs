//! One tick of one player: a pure function of player, input and world (docs/physics.md, 3 and 12).

mod article;
mod engine;

use crate::input::Input;
use crate::movement::{Movement, Obstacles};
use crate::player::Player;
use crate::real::{Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;

/// Largest view pitch, radians (88 degrees).
pub const MAX_PITCH: f64 = 1.535_889_741_755_009_3;

/// An angle, radians, that is less than pi also after rounding of a sum.
const WELL_INSIDE: f64 = 3.125;

/// An angle in radians brought into [-pi, pi).
#[inline(always)]
pub fn wrap_angle<R: Real>(angle: R) -> R {
    // Whoever is inside stays as he is, to the bit, and mostly everybody is: nothing waits for a division.
    let inside = angle.abs().le(R::lit(WELL_INSIDE));
    if !inside.not().any() {
        return angle;
    }
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

/// Everything of a tick that comes after the view and the trigger: forces and the move, in the order of
/// the tier's model.
#[inline(always)]
pub fn act<S: Scene, M: Movement, R: Real, W: Obstacles<R>>(
    p: &mut Player<S, R>,
    input: &Input<R>,
    world: &W,
    rules: &Rules<R::Scalar>,
) {
    let before = push::<S, M, R>(p, input, rules);
    go::<S, M, R, W>(p, before, world, rules);
}

/// The first half of [`act`]: jump, jets and friction. Returns the velocity after the jump and before the
/// tick's forces. It has no branches on numbers, so that a processor does the next players' beside it.
#[inline(always)]
pub fn push<S: Scene, M: Movement, R: Real>(
    p: &mut Player<S, R>,
    input: &Input<R>,
    rules: &Rules<R::Scalar>,
) -> V3<R> {
    const { S::BUILT }
    match M::MODEL {
        Model::Article => article::push(p, input, rules),
        Model::Engine => engine::push(p, input, rules),
    }
}

/// The second half of [`act`]: the move.
#[inline(always)]
pub fn go<S: Scene, M: Movement, R: Real, W: Obstacles<R>>(
    p: &mut Player<S, R>,
    before: V3<R>,
    world: &W,
    rules: &Rules<R::Scalar>,
) {
    M::advance(p, before, world, rules);
    if M::MODEL == Model::Engine {
        engine::age(p);
    }
}
