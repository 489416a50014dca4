//! The tier for training: one look at the ground a tick, at the place where the move ends.
//!
//! Most ticks of a skier are flight, and sweeping their slices is what `authentic` spends its time on.
//! Here a tick asks for the plane under the end of its straight move. Where both ends of the move lie
//! above that plane nothing is met, whichever one edge between triangles it crosses: that was the tick.
//! Else one exact sweep of the whole move finds the contact; the whole metres before it are made at the
//! old velocity and the rest of the tick at the new one, as in `authentic`, but that rest is not swept.
//! Should it end below the ground, the face there is a second contact, and the player is put on it.
//!
//! The hop, its period and the ski acceleration law are thus those of `authentic` on any plane. What is
//! dropped:
//!
//! - the way of the rest of the tick after a contact, and where exactly its second contact is;
//! - third and later contacts of a tick. So the bump limit is never reached: `ski_bug` does nothing, and
//!   `bump_limits` stays 0;
//! - contacts of a move that crosses several edges and has both ends above the last triangle's plane.
//!   Squares are 8 m, so at ordinary speeds (1 m a tick at 31 m/s) that is the tip of a peak; at
//!   hundreds of metres a second it may be a hill. Nobody falls through the ground at any speed: the end of
//!   every tick is held above it.
//!
//! docs/tiers.md has the errors and the cost, measured.

use super::contact::{Tally, slices, untouched};
use super::{Movement, Obstacles};
use crate::player::Player;
use crate::real::{Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;
use crate::terrain::{Ground, Hit, Surface};

/// One look at the ground a tick, where the move ends.
#[derive(Clone, Copy, Debug)]
pub struct Fast;

impl Movement for Fast {
    const MODEL: Model = Model::Article;

    #[inline(always)]
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(
        p: &mut Player<S, R>,
        _before: V3<R>,
        world: &W,
        rules: &Rules<R::Scalar>,
    ) {
        let zero = R::zero();
        let one = R::lit(1.0);
        let dt = R::splat(rules.dt);
        let none = R::Mask::splat(false);
        let mut tally = Tally::new();

        let at = p.place();
        let path = p.velocity * dt;
        let end = p.position + path;
        let mut ground = world.surface().ground::<R>(at.map, end.x, end.y);
        let near = may_meet(world.surface(), &ground, end, path);
        let mut hit = Hit::none();
        if near.any() {
            hit = world.surface().sweep::<R>(at.map, at.position, path, near);
        }
        if W::BODIES {
            // Bodies may be thinner than a move is long, so they are swept in every tick.
            hit = Hit::first(hit, world.sweep_bodies(&at, path, none.not()));
        }
        p.position = V3::select(hit.hit, at.position, end);

        if hit.hit.any() {
            let stops = tally.meet(p, world, (&at, path, at.position), (&hit, hit.hit), rules);
            let goes_on = hit.hit.and(stops.not());
            // The slices of a metre before the one that hits, as a share of the tick.
            let count = R::from_int(slices(path.length())).max(one);
            let whole = (R::from_int((hit.fraction * count).ceil_int()) - one).max(zero) / count;
            let start = p.position + path * whole;
            let rest = p.velocity * (dt * (one - whole));
            let mut goal = start + rest;
            if W::BODIES {
                let mut from = at;
                from.position = start;
                let met = world.sweep_bodies(&from, rest, goes_on);
                let second = goes_on.and(met.hit);
                if second.any() {
                    let there = start + rest * met.fraction;
                    p.position = V3::select(second, there, p.position);
                    tally.meet(p, world, (&from, rest, there), (&met, second), rules);
                    goal = V3::select(second, p.position, goal);
                }
            }
            p.position = V3::select(goes_on, goal, p.position);

            ground = world.surface().ground::<R>(at.map, p.position.x, p.position.y);
            let normal = ground.normal();
            let under = ground.exists.and(p.position.z.lt(ground.height));
            let again = goes_on.and(under).and(p.velocity.dot(normal).lt(zero));
            if again.any() {
                let second = Hit { hit: again, fraction: one, normal, body: none };
                let here = p.place();
                tally.meet(p, world, (&here, rest, here.position), (&second, again), rules);
            }
        }
        // Where nothing was met the ground is the one at the end: a move that leaves a face from below.
        let sunk = ground.exists.and(p.position.z.lt(ground.height));
        p.position.z = R::select(sunk, ground.height, p.position.z);
        tally.settle(p);
    }

    const PASSES_FROM: usize = 16;

    /// The look at the ground.
    #[inline(always)]
    fn pass<S: Scene, R: Real>(
        p: &mut Player<S, R>,
        surface: &Surface<'_, R::Scalar>,
        rules: &Rules<R::Scalar>,
    ) -> R::Mask {
        let path = p.velocity * R::splat(rules.dt);
        let end = p.position + path;
        let ground = surface.ground::<R>(p.map, end.x, end.y);
        let sunk = ground.exists.and(end.z.lt(ground.height));
        let passed = may_meet(surface, &ground, end, path).or(sunk).not();
        untouched(p, passed, end);
        passed
    }
}

/// Whose move along `path` has an end below the plane of the ground under its end, or below that patch.
#[inline(always)]
fn may_meet<R: Real>(
    surface: &Surface<'_, R::Scalar>,
    ground: &Ground<R>,
    end: V3<R>,
    path: V3<R>,
) -> R::Mask {
    // Height of the end over the plane, and how much of it the move has gained.
    let gap = end.z - ground.height;
    let mut climb = path.z - (ground.slope_x * path.x + ground.slope_y * path.y);
    if surface.is_curved() {
        // A patch that falls away from its plane is farther below the path than that; one that rises above
        // it does so most at the start.
        climb = climb + (ground.twist * path.x * path.y).max(R::zero());
    }
    ground.exists.and(gap.min(gap - climb).lt(R::zero()))
}
