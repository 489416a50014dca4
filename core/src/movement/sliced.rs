//! The article's movement in slices of at most a metre, restarted at each contact
//! (docs/physics.md, section 5.2): the `authentic` and the `reference` tier.

use super::contact::{Tally, slices, untouched};
use super::{Movement, Obstacles};
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;
use crate::terrain::Surface;

/// Slices of at most a metre, each swept; a contact charges no time and slices the rest anew.
#[derive(Clone, Copy, Debug)]
pub struct Sliced;

impl Movement for Sliced {
    const MODEL: Model = Model::Article;

    #[inline(always)]
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(
        p: &mut Player<S, R>,
        _before: V3<R>,
        world: &W,
        rules: &Rules<R::Scalar>,
    ) {
        let mut tally = Tally::new();
        let mut left = R::splat(rules.dt);
        let mut moving = R::Mask::splat(true);

        // One turn of the loop is one slice. `fresh` players slice what is left of the tick anew.
        let mut fresh = moving;
        let mut begin = p.position;
        let mut slice = R::zero();
        let mut slices_left = R::Int::splat(0);
        loop {
            if fresh.any() {
                let count = slices(p.velocity.length() * left);
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
                let stops = tally.meet(p, world, (&at, step, begin), (&hit, struck), rules);
                moving = moving.and(stops.not());
                moving = moving.and(tally.limit(p, moving, rules).not());
            }
        }
        tally.settle(p);
    }

    const PASSES_FROM: usize = 8;

    /// One slice over one square.
    #[inline(always)]
    fn pass<S: Scene, R: Real>(
        p: &mut Player<S, R>,
        surface: &Surface<'_, R::Scalar>,
        rules: &Rules<R::Scalar>,
    ) -> R::Mask {
        let left = R::splat(rules.dt);
        let single = slices(p.velocity.length() * left).eq(R::Int::splat(1));
        let step = p.velocity * left;
        let passed = single.and(surface.passes::<R>(p.map, p.position, step));
        untouched(p, passed, p.position + step);
        passed
    }
}
