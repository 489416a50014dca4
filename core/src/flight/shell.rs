//! Grenades and mortar shells.

use super::burst;
use crate::armor;
use crate::arms::{Arsenal, Projectile};
use crate::movement::Obstacles;
use crate::real::{Int, Mask, Real, V3};
use crate::terrain::Hit;

/// Bounces that one tick allows; what is left of the tick after them is dropped. So a shell at rest in
/// a crease takes no longer than another.
const MAX_BOUNCES: u32 = 4;
/// How far a bounce leaves a shell outside a body, m: on it, it would be no telling on which side.
const CLEARANCE: f64 = 0.01;

/// What a shell is made of, per tick.
pub(super) struct Shell<T> {
    pub(super) fall: T,
    pub(super) elasticity: T,
    pub(super) arms: i32,
}

/// The first contact of a shell. Unlike a disc it meets the terrain from above only, as players do:
/// one that lies on the ground, or was fired from within it, can rise out of it.
#[inline(always)]
fn contact<R: Real, W: Obstacles<R>>(
    shell: &Projectile<R>,
    path: V3<R>,
    map: R::Int,
    world: &W,
    active: R::Mask,
) -> Hit<R> {
    let ground = world.surface().sweep::<R>(map, shell.position, path, active);
    if !W::BODIES {
        return ground;
    }
    Hit::first(ground, world.line_bodies(&shell.place(map), path, active))
}

/// A shell, as a point: gravity first, then the place, as for players. Before it is armed it bounces,
/// losing speed along the contact normal alone; armed, it bursts at its next contact.
#[inline(always)]
pub(super) fn bouncing<R: Real, W: Obstacles<R>>(
    shell: &mut Projectile<R>,
    alive: R::Mask,
    map: R::Int,
    world: &W,
    arsenal: &Arsenal<R::Scalar>,
    kind: &Shell<R::Scalar>,
) {
    let one = R::lit(1.0);
    let fallen = shell.velocity + V3::up() * R::splat(kind.fall);
    shell.velocity = V3::select(alive, fallen, shell.velocity);
    let armed = R::Int::splat(kind.arms).lt(shell.age);
    let rebound = one + R::splat(kind.elasticity);
    let mut left = R::splat(arsenal.dt);
    let mut moving = alive;
    for _ in 0..=MAX_BOUNCES {
        let path = shell.velocity * left;
        let hit = contact(shell, path, map, world, moving);
        let met = moving.and(hit.hit);
        let there = shell.position + V3::select(met, path * hit.fraction, path);
        shell.position = V3::select(moving, there, shell.position);
        left = R::select(met, left * (one - hit.fraction), left);
        burst(shell, met.and(armed), hit.normal);

        moving = met.and(armed.not());
        if !moving.any() {
            return;
        }
        let impact = -shell.velocity.dot(hit.normal);
        let out = hit.normal * (rebound * impact + R::lit(armor::OUTWARD_PUSH));
        shell.velocity = V3::select(moving, shell.velocity + out, shell.velocity);
        let outside = shell.position + hit.normal * R::lit(CLEARANCE);
        shell.position = V3::select(moving.and(hit.body), outside, shell.position);
    }
}
