//! The tier for training: one look at the ground a tick, at the place where the move ends.
//!
//! Most ticks of a skier are flight, and the sweep of their slices is what `authentic` spends its time
//! on. Here a tick asks for the height under the end of its straight move. Above the ground: that was
//! the tick. Below it: one exact sweep finds the contact, the whole metres before it are made at the old
//! velocity and the rest of the tick at the new one, as in `authentic`, but without testing that rest;
//! should it end below the ground it is lifted onto it.
//!
//! The hop, its period and the ski acceleration law are thus those of `authentic` on any plane. What is
//! dropped:
//!
//! - contacts of a move that ends above the ground again: crests and ridges are clipped, by at most the
//!   length of a tick's move (1 m at 31 m/s);
//! - the second and later contacts of a tick: in a crease the player meets one face per tick. So the
//!   bump limit is never reached, `ski_bug` does nothing, and `bump_limits` stays 0;
//! - the terrain between two ticks that are farther apart than a hill is wide: nobody falls through the
//!   ground, since the end of every tick is held above it, but at hundreds of metres a second one may
//!   pass through a hill.
//!
//! docs/tiers.md has the errors and the cost, measured.

use super::contact::{Tally, slices};
use super::{Movement, Obstacles};
use crate::player::Player;
use crate::real::{Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;
use crate::terrain::Hit;

/// One contact a tick, looked for where the move ends.
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
        let all = R::Mask::splat(true);
        let mut tally = Tally::new();

        let at = p.place();
        let path = p.velocity * dt;
        let end = p.position + path;
        let mut ground = world.surface().ground::<R>(p.map, end.x, end.y);
        let below = ground.exists.and(end.z.lt(ground.height));
        let mut hit = Hit::none();
        if below.any() {
            hit = world.surface().sweep::<R>(at.map, at.position, path, below);
        }
        if W::BODIES {
            // Bodies may be thinner than a move is long, so they are swept in every tick.
            hit = Hit::first(hit, world.sweep_bodies(&at, path, all));
        }
        p.position = V3::select(hit.hit, at.position, end);

        if hit.hit.any() {
            let stops = tally.meet(p, world, (&at, path, at.position), (&hit, hit.hit), rules);
            let goes_on = hit.hit.and(stops.not());
            // The slices of a metre before the one that hits, as a share of the tick.
            let count = R::from_int(slices(path.length())).max(one);
            let whole = (R::from_int((hit.fraction * count).ceil_int()) - one).max(zero) / count;
            let start = p.position + path * whole;
            let mut goal = start + p.velocity * (dt * (one - whole));
            if W::BODIES {
                let mut from = at;
                from.position = start;
                let again = world.sweep_bodies(&from, goal - start, goes_on);
                goal = V3::select(again.hit, start, goal);
            }
            p.position = V3::select(goes_on, goal, p.position);
            ground = world.surface().ground::<R>(p.map, p.position.x, p.position.y);
        }
        // Where nothing was met the ground is the one at the end: a move that leaves a face from below.
        let sunk = ground.exists.and(p.position.z.lt(ground.height));
        p.position.z = R::select(sunk, ground.height, p.position.z);
        tally.settle(p);
    }
}
