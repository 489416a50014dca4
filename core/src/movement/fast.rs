//! placeholder while measuring
use super::contact::Tally;
use super::{Movement, Obstacles};
use crate::player::Player;
use crate::real::{Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;
use crate::terrain::Hit;

/// x
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
        let mut tally = Tally::new();
        let at = p.place();
        let path = p.velocity * dt;
        let end = p.position + path;

        let mut ground = world.surface().ground::<R>(p.map, end.x, end.y);
        let end_gap = end.z - ground.height;
        let approach = path.z - (ground.slope_x * path.x + ground.slope_y * path.y);
        let start_gap = end_gap - approach;
        let hit = ground.exists.and(end_gap.lt(zero)).and(approach.lt(zero));
        let fraction = (start_gap / (start_gap - end_gap)).max(zero);
        let mut first = Hit { hit, fraction, normal: ground.normal(), body: R::Mask::splat(false) };
        if W::BODIES {
            first = Hit::first(first, world.sweep_bodies(&at, path, R::Mask::splat(true)));
        }
        p.position = V3::select(first.hit, p.position, end);
        if first.hit.any() {
            let stops = tally.meet(p, world, (&at, path, at.position), (&first, first.hit), rules);
            let count = R::from_int(super::contact::slices(path.length()));
            let whole = (R::from_int((first.fraction * count).ceil_int()) - one).max(zero) / count.max(one);
            let turned = p.position + path * whole;
            let mut goal = turned + p.velocity * (dt * (one - whole));
            if W::BODIES {
                let mut from = at;
                from.position = turned;
                let again = world.sweep_bodies(&from, goal - turned, first.hit.and(stops.not()));
                goal = V3::select(again.hit, turned, goal);
            }
            p.position = V3::select(first.hit.and(stops.not()), goal, p.position);
            ground = world.surface().ground::<R>(p.map, p.position.x, p.position.y);
        }
        let sunk = ground.exists.and(p.position.z.lt(ground.height));
        p.position.z = R::select(sunk, ground.height, p.position.z);
        tally.settle(p);
    }
}
