//! The most literal reading of the article's "then moves the player anyway" (docs/physics.md, section
//! 5.2): after a bounce the slice is made with the new velocity, and not tested again.

use super::contact::{Tally, slices};
use super::{Movement, Obstacles};
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;

/// Slices that are made whatever they meet.
///
/// For measurement only: it tunnels. In a crease of 45 degrees and more the untested slice goes through
/// the other face, and whoever is below the ground falls. It cannot be what the game did.
#[derive(Clone, Copy, Debug)]
pub struct Anyway;

impl Movement for Anyway {
    const MODEL: Model = Model::Article;

    #[inline(always)]
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(
        p: &mut Player<S, R>,
        _before: V3<R>,
        world: &W,
        rules: &Rules<R::Scalar>,
    ) {
        let mut tally = Tally::new();
        let begin = p.position;
        let mut slices_left = slices(p.velocity.length() * R::splat(rules.dt));
        let mut moving = R::Int::splat(0).lt(slices_left);
        let count = R::Int::select(moving, slices_left, R::Int::splat(1));
        let slice = R::splat(rules.dt) / R::from_int(count);
        while moving.any() {
            let step = p.velocity * slice;
            let at = p.place();
            let hit = world.sweep(&at, step, moving);
            let struck = moving.and(hit.hit);
            if struck.any() {
                let stops = tally.meet(p, world, (&at, step, begin), (&hit, struck), rules);
                moving = moving.and(stops.not());
            }
            p.position = V3::select(moving, p.position + p.velocity * slice, p.position);
            slices_left = slices_left - R::Int::splat(1);
            moving = moving.and(tally.limit(p, struck.and(moving), rules).not());
            moving = moving.and(R::Int::splat(0).lt(slices_left));
        }
        tally.settle(p);
    }
}
