//! Discs.

use super::burst;
use crate::arms::{Arsenal, Projectile};
use crate::movement::Obstacles;
use crate::real::{Int, Mask, Real, V3};

/// The engine's step: counted as 33 ms, made as a thirtieth of a second.
const STEP_MS: i32 = 33;
const STEPS_PER_SECOND: f64 = 30.0;

/// A disc swept exactly through the tick. It accelerates along its aim until its speed along it is the
/// terminal one, first the velocity and then the place, as players do; what it took along from its
/// shooter sideways it keeps, and a faster one is not slowed.
#[inline(always)]
pub(super) fn swept<R: Real, W: Obstacles<R>>(
    disc: &mut Projectile<R>,
    alive: R::Mask,
    map: R::Int,
    world: &W,
    arsenal: &Arsenal<R::Scalar>,
    (terminal, gain): (R::Scalar, R::Scalar),
) {
    let missing = R::splat(terminal) - disc.velocity.dot(disc.axis);
    let gained = missing.min(R::splat(gain)).max(R::zero());
    let velocity = disc.velocity + disc.axis * gained;
    disc.velocity = V3::select(alive, velocity, disc.velocity);

    let path = velocity * R::splat(arsenal.dt);
    let hit = world.line(&disc.place(map), path, alive);
    let met = alive.and(hit.hit);
    let there = disc.position + V3::select(met, path * hit.fraction, path);
    disc.position = V3::select(alive, there, disc.position);
    burst(disc, met, hit.normal);
}

/// The 1998 engine's disc: unaccelerated, in steps of its own clock, usually one a tick of 32 ms, none
/// in every 33rd, the first two ticks after the shot. It bursts where the step began that met
/// something. What is left of its acceleration: as soon as no component of the velocity is smaller
/// than the terminal velocity's, it becomes the terminal velocity.
#[inline(always)]
pub(super) fn clocked<R: Real, W: Obstacles<R>>(
    disc: &mut Projectile<R>,
    alive: R::Mask,
    map: R::Int,
    world: &W,
    arsenal: &Arsenal<R::Scalar>,
    terminal: R::Scalar,
) {
    let top = disc.axis * R::splat(terminal);
    let v = disc.velocity;
    let above = top.x.abs().le(v.x.abs()).and(top.y.abs().le(v.y.abs())).and(top.z.abs().le(v.z.abs()));
    disc.velocity = V3::select(alive.and(above), top, v);

    let path = disc.velocity * R::lit(1.0 / STEPS_PER_SECOND);
    let step = R::Int::splat(STEP_MS);
    let clock = disc.clock + R::Int::splat(arsenal.tick_ms);
    disc.clock = R::Int::select(alive, clock, disc.clock);
    let mut steps = alive.and(disc.clock.lt(step).not());
    while steps.any() {
        let hit = world.line(&disc.place(map), path, steps);
        let met = steps.and(hit.hit);
        burst(disc, met, hit.normal);
        steps = steps.and(met.not());
        disc.position = V3::select(steps, disc.position + path, disc.position);
        disc.clock = R::Int::select(steps, disc.clock - step, disc.clock);
        steps = steps.and(disc.clock.lt(step).not());
    }
}
