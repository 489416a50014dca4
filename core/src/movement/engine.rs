//! The 1998 engine's own loop (docs/physics.md, section 5.3): a sphere about the player's middle, stepped
//! by decimetres against the plane under its centre: the `engine` tier.

use super::contact::{bounce, step_over};
use super::{Movement, Obstacles};
use crate::armor;
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;
use crate::terrain::Hit;

/// Sub-steps of at most 0.3 m, of 0.075 m after a contact; three attempts.
///
/// Its quirks are kept: an overlap counts as a touch also when it does not block (moving away), and eats
/// time; a centre below the plane meets nothing, so whoever is that deep falls out of the world; the
/// sphere cuts into a neighbouring face until the centre crosses the edge. Bodies are met by the armor's
/// box, each sub-step swept.
#[derive(Clone, Copy, Debug)]
pub struct Engine;

impl Movement for Engine {
    const MODEL: Model = Model::Engine;

    #[inline(always)]
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(
        p: &mut Player<S, R>,
        before: V3<R>,
        world: &W,
        rules: &Rules<R::Scalar>,
    ) {
        let zero = R::zero();
        let one = R::Int::splat(1);
        let dt = R::splat(rules.dt);
        let radius = R::splat(rules.height) * R::lit(0.5);

        let memory = R::lit(armor::FRICTION_MEMORY) * p.friction;
        let memory = R::select(memory.lt(R::lit(armor::ENGINE_LEAST_MEMORY)), zero, memory);
        let mut grip = zero;
        let mut touched = R::Mask::splat(false);

        let mut elapsed = zero;
        let mut attempts = R::Int::splat(0);
        let mut moving = R::Mask::splat(true);
        // One turn of the loop is one sub-step. `fresh` players cut the path to their target anew.
        let mut fresh = moving;
        let mut path = (before + p.velocity) * (dt * R::lit(0.5));
        let mut longest = R::lit(armor::ENGINE_STEP);
        let mut step = V3::zero();
        let mut count = one;
        let mut done = R::Int::splat(0);
        loop {
            if fresh.any() {
                let wanted = (path.length() / longest).ceil_int().clamp(0, armor::MAX_SLICES);
                let moves = R::Int::splat(0).lt(wanted);
                moving = moving.and(fresh.not().or(moves));
                count = R::Int::select(fresh, R::Int::select(moves, wanted, one), count);
                step = V3::select(fresh, path * (R::lit(1.0) / R::from_int(count)), step);
                done = R::Int::select(fresh, R::Int::splat(0), done);
            }
            if !moving.any() {
                break;
            }

            let at = p.place();
            let next = p.position + step;
            let ground = world.surface().ground::<R>(p.map, next.x, next.y);
            let mut normal = ground.normal();
            let distance = (next.z + radius - ground.height) * normal.z;
            let overlaps = moving.and(ground.exists).and(distance.abs().lt(radius));
            let blocks = zero.le(distance).and(p.velocity.dot(normal).lt(zero));
            let mut met = overlaps;
            let mut struck = overlaps.and(blocks);
            let mut body = Hit::none();
            if W::BODIES {
                body = world.sweep_bodies(&at, step, moving);
                normal = V3::select(body.hit, body.normal, normal);
                met = met.or(body.hit);
                struck = struck.or(body.hit);
            }
            touched = touched.or(met);
            let share = R::from_int(done) / R::from_int(count);
            elapsed = R::select(met, elapsed + share * (dt - elapsed), elapsed);

            let passed = moving.and(struck.not());
            p.position = V3::select(passed, next, p.position);
            done = R::Int::select(passed, done + one, done);
            moving = moving.and(passed.and(done.lt(count).not()).not());

            fresh = struck;
            if struck.any() {
                if world.surface().is_curved() {
                    let ahead = ground.normal_ahead(p.velocity * (dt - elapsed));
                    normal = V3::select(body.hit, normal, ahead);
                }
                let blocked = if W::BODIES {
                    let steep = body.hit.and(normal.z.le(R::lit(armor::ENGINE_STEP_UP)));
                    // A path of mean speeds may lead into a body that the new speed leaves: the path ends
                    // there, but nothing is left to turn.
                    let into = p.velocity.dot(normal).lt(zero);
                    step_over(p, world, (&at, step), &body, struck, steep).and(into)
                } else {
                    struck
                };
                world.note(p, blocked, p.position, normal);
                bounce(p, blocked, normal, Model::Engine, rules);
                let upward = blocked.and(zero.lt(normal.z));
                grip = R::select(upward, grip + normal.z, grip);
                let slow = p.velocity.length().lt(R::lit(armor::STOP_SPEED) * normal.z);
                let stops = upward.and(p.crawled).and(slow);
                p.velocity = V3::select(stops, V3::zero(), p.velocity);
                moving = moving.and(stops.not());

                attempts = R::Int::select(struck, attempts + one, attempts);
                let exhausted = R::Int::splat(armor::ENGINE_ATTEMPTS - 1).lt(attempts).and(moving);
                p.count_bump_limit(exhausted);
                if rules.physics.ski_bug.unwrap_or(true) {
                    p.velocity = V3::select(exhausted, V3::zero(), p.velocity);
                }
                moving = moving.and(exhausted.not());
                path = V3::select(struck, p.velocity * (dt - elapsed), path);
                longest = R::select(struck, R::lit(armor::ENGINE_FINE_STEP), longest);
            }
        }
        p.friction = grip.max(memory).min(R::lit(1.0));
        p.touched = touched;
    }
}
