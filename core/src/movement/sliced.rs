//! The article's movement in slices of at most a metre, restarted at each contact
//! (docs/physics.md, section 5.2): the `authentic` and the `reference` tier.

use super::contact::bounce;
use super::{Movement, Obstacles};
use crate::armor;
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::Scene;

/// Slices of at most a metre, each swept; a contact charges no time and slices the rest anew.
#[derive(Clone, Copy, Debug)]
pub struct Sliced;

impl Movement for Sliced {
    #[inline(always)]
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(
        p: &mut Player<S, R>,
        world: &W,
        rules: &Rules<R::Scalar>,
    ) {
        let zero = R::zero();
        let none = R::Mask::splat(false);
        let mut left = R::splat(rules.dt);
        let mut bumps = R::Int::splat(0);
        let mut grip = zero;
        let mut touched = none;
        let mut moving = R::Mask::splat(true);

        // One turn of the loop is one slice. `fresh` players slice what is left of the tick anew.
        let mut fresh = moving;
        let mut begin = p.position;
        let mut slice = zero;
        let mut slices_left = R::Int::splat(0);
        loop {
            if fresh.any() {
                let metres = p.velocity.length() * left;
                let wanted = (metres / R::lit(armor::SLICE)).ceil_int();
                let many = R::Int::splat(armor::MAX_SLICES).lt(wanted);
                let count = R::Int::select(many, R::Int::splat(1), wanted);
                let moves = R::Int::splat(0).lt(count);
                moving = moving.and(fresh.not().or(moves));
                let safe = R::Int::select(moves, count, R::Int::splat(1));
                slice = R::select(fresh, left / R::from_int(safe), slice);
                slices_left = R::Int::select(fresh, count, slices_left);
                begin = V3::select(fresh, p.position, begin);
            }
            if !moving.any() {
                break;
            }

            let step = p.velocity * slice;
            let at = p.place();
            let hit = world.sweep(&at, step, moving);
            let struck = moving.and(hit.hit);
            let passed = moving.and(hit.hit.not());

            p.position = V3::select(passed, p.position + step, p.position);
            left = R::select(passed, left - slice, left);
            slices_left = R::Int::select(passed, slices_left - R::Int::splat(1), slices_left);
            let finished = passed.and(slices_left.lt(R::Int::splat(1)));
            moving = moving.and(finished.not());

            fresh = struck;
            if struck.any() {
                touched = touched.or(struck);
                let mut blocked = struck;
                if W::BODIES {
                    let steep = struck.and(hit.normal.z.lt(R::lit(armor::JUMPABLE_UP)));
                    let lift = world.step_up(&at, step, &hit, steep);
                    p.position.z = p.position.z + lift;
                    blocked = struck.and(zero.lt(lift).not());
                }
                bounce(p, blocked, hit.normal, rules);
                let upward = blocked.and(zero.lt(hit.normal.z));
                grip = R::select(upward, hit.normal.z, grip);
                let slow = p.velocity.length().lt(R::lit(armor::STOP_SPEED));
                let stops = upward.and(p.crawled).and(slow);
                p.velocity = V3::select(stops, V3::zero(), p.velocity);
                p.position = V3::select(stops, begin, p.position);
                moving = moving.and(stops.not());
                bumps = R::Int::select(struck, bumps + R::Int::splat(1), bumps);
                let exhausted = R::Int::splat(armor::MAX_BUMPS - 1).lt(bumps).and(moving);
                p.count_bump_limit(exhausted);
                if rules.physics.ski_bug.unwrap_or(false) {
                    p.velocity = V3::select(exhausted, V3::zero(), p.velocity);
                }
                moving = moving.and(exhausted.not());
            }
        }

        let memory = grip.max(R::lit(armor::FRICTION_MEMORY) * p.friction).min(R::lit(1.0));
        p.friction = R::select(touched, memory, zero);
        p.touched = touched;
    }
}
