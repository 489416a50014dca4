//! The article's shortcut (docs/physics.md, section 5.1): one sweep of the whole move, and at a contact
//! the last slice, as it would have been cut, redone with the new velocity: the `swept` tier.

use super::contact::{Tally, slices, untouched};
use super::{Movement, Obstacles};
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;
use crate::terrain::Surface;

/// One sweep per bump, with a fix-up of the last slice.
///
/// A contact at once (the player starts on or under the surface) has no last slice. Read literally the
/// fix-up then pushes him out along the normal by a whole slice of what the surface took from his
/// velocity; `clamp_fixup` makes it nothing. The fix-up is not swept, so in steep creases it ends below
/// the other face, until that push brings the player up again. With `fixup_swept` a fix-up that would
/// meet something is not made; so it is always where bodies are, which have no push that could bring
/// anybody out of them.
#[derive(Clone, Copy, Debug)]
pub struct Swept;

impl Movement for Swept {
    const MODEL: Model = Model::Article;

    #[inline(always)]
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(
        p: &mut Player<S, R>,
        _before: V3<R>,
        world: &W,
        rules: &Rules<R::Scalar>,
    ) {
        let zero = R::zero();
        let one = R::Int::splat(1);
        let mut tally = Tally::new();
        let mut left = R::splat(rules.dt);
        let mut moving = R::Mask::splat(true);
        loop {
            let count = slices(p.velocity.length() * left);
            let moves = R::Int::splat(0).lt(count);
            moving = moving.and(moves);
            if !moving.any() {
                break;
            }
            let slice = left / R::from_int(R::Int::select(moves, count, one));
            let path = p.velocity * left;
            let at = p.place();
            let hit = world.sweep(&at, path, moving);
            let struck = moving.and(hit.hit);
            p.position = V3::select(moving.and(hit.hit.not()), p.position + path, p.position);
            moving = struck;
            if !struck.any() {
                break;
            }

            let used = hit.fraction * left;
            let mut slice_hit = (used / slice).ceil_int();
            if rules.physics.clamp_fixup {
                slice_hit = R::Int::select(slice_hit.lt(one), one, slice_hit);
            }
            let full = slice * R::from_int(slice_hit - one);
            let fix = used - full;
            let old = p.velocity;
            let stops = tally.meet(p, world, (&at, path, at.position), (&hit, struck), rules);
            moving = moving.and(stops.not());

            let whole = old * full;
            let mut goal = p.position + whole + p.velocity * fix;
            if rules.physics.fixup_swept || W::BODIES {
                // What is tested is the way from the last whole slice, or from here where there is none.
                let start = V3::select(full.lt(zero), p.position, p.position + whole);
                let mut from = at;
                from.position = start;
                let again = if rules.physics.fixup_swept {
                    world.sweep(&from, goal - start, moving)
                } else {
                    world.sweep_bodies(&from, goal - start, moving)
                };
                goal = V3::select(again.hit, start, goal);
            }
            p.position = V3::select(moving, goal, p.position);
            left = R::select(struck, left - used, left);
            moving = moving.and(zero.lt(left));
            moving = moving.and(tally.limit(p, moving, rules).not());
        }
        tally.settle(p);
    }

    const PASSES_FROM: usize = 8;

    /// One sweep over one square.
    #[inline(always)]
    fn pass<S: Scene, R: Real>(
        p: &mut Player<S, R>,
        surface: &Surface<'_, R::Scalar>,
        rules: &Rules<R::Scalar>,
    ) -> R::Mask {
        let left = R::splat(rules.dt);
        let moves = R::Int::splat(0).lt(slices(p.velocity.length() * left));
        let path = p.velocity * left;
        let passed = moves.and(surface.passes::<R>(p.map, p.position, path));
        untouched(p, passed, p.position + path);
        passed
    }
}
