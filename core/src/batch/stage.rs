//! One tick of a world, phase by phase (docs/physics.md, section 12, "order of a tick"): view and
//! trigger, moves, flights, explosions.

use super::neighbourhood::{Neighbourhood, Stand};
use crate::arms::{Arms, Arsenal, Projectile};
use crate::blast::Explosive;
#[cfg(feature = "blast")]
use crate::blast::{body_points, coverage_on_terrain, meets, seen_from, strike};
#[cfg(feature = "discs")]
use crate::flight::{fire, fly};
use crate::input::Input;
use crate::movement::{Movement, Obstacles};
use crate::player::{Place, Player};
use crate::real::{Int, Mask, Real, Scalar, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::solids::Solids;
use crate::terrain::{Maps, Surface};
use crate::tick::{go, look, push};
use glam::DVec2;
use std::sync::Arc;

/// A player and what he has fired.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body<S: Scene, R: Real> {
    pub(super) player: Player<S, R>,
    pub(super) arms: S::Arms<R>,
}

impl<S: Scene, R: Real> AsRef<Player<S, R>> for Body<S, R> {
    #[inline(always)]
    fn as_ref(&self) -> &Player<S, R> {
        &self.player
    }
}

impl<S: Scene, R: Real> AsMut<Player<S, R>> for Body<S, R> {
    #[inline(always)]
    fn as_mut(&mut self) -> &mut Player<S, R> {
        &mut self.player
    }
}

impl<S: Scene, R: Real> Body<S, R> {
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> Body<S, R::Scalar> {
        let mut arms = S::Arms::<R::Scalar>::new(Arms::empty());
        if let (Some(one), Some(all)) = (arms.as_mut(), self.arms.as_ref()) {
            *one = all.lane(lane);
        }
        Body { player: self.player.lane(lane), arms }
    }

    #[inline(always)]
    pub(super) fn set_lane(&mut self, lane: usize, body: &Body<S, R::Scalar>) {
        self.player.set_lane(lane, &body.player);
        if let (Some(all), Some(one)) = (self.arms.as_mut(), body.arms.as_ref()) {
            all.set_lane(lane, one);
        }
    }
}

/// How far along the contact normal the rays start that a blast sees by, m.
const LIFTED: f64 = 0.05;
/// An engine disc may have a step of its clock left over from the tick before, s, and flies a thirtieth
/// of a second where 33 ms are counted: slack of the broad phase.
const DISC_CLOCK: (f64, f64) = (0.033, 1.0 / (30.0 * 0.033));
/// A step up, and rounding, m: slack of the broad phase.
const STEP_UP: f64 = 1.0;

/// What all worlds of a batch have in common.
#[derive(Clone, Copy)]
pub(super) struct Stage<'a, T: Scalar> {
    pub(super) surface: Surface<'a, T>,
    pub(super) maps: &'a Maps,
    /// What stands on each map; one for all of them, or none where the scene models none or none stand.
    solids: &'a [Arc<Solids>],
    pub(super) rules: &'a Rules<T>,
    pub(super) arsenal: &'a Arsenal<T>,
    range: Range,
}

/// What the broad phase asks of every player in every tick, worked out once.
#[derive(Clone, Copy)]
struct Range {
    /// World coordinates of local (0, 0) in tile (0, 0), m.
    centre: DVec2,
    /// Sides of a tile, m.
    period: DVec2,
    /// Speed that a tick may add, m/s.
    gain: f64,
    /// Length of a tick, s.
    tick: f64,
    /// Size of a body, a step up and rounding, m.
    size: f64,
}

impl<'a, T: Scalar> Stage<'a, T> {
    pub(super) fn new(
        maps: &'a Maps,
        solids: &'a [Arc<Solids>],
        rules: &'a Rules<T>,
        arsenal: &'a Arsenal<T>,
    ) -> Self {
        let gain = rules.jump.to_f64() + rules.jet.to_f64() + rules.grip.to_f64() - rules.fall.to_f64();
        let range = Range {
            centre: maps.centre(),
            period: maps.size(),
            gain,
            tick: rules.dt.to_f64(),
            size: rules.height.to_f64() + STEP_UP,
        };
        Self { surface: maps.surface::<T>(), maps, solids, rules, arsenal, range }
    }

    /// What stands on the map that an offset belongs to.
    #[inline(always)]
    fn solids_of(&self, map: i32) -> Option<&'a Solids> {
        let at = if self.solids.len() > 1 { self.maps.index(map) } else { 0 };
        self.solids.get(at).map(AsRef::as_ref)
    }

    /// Everything after the trigger, for one player near a solid. Rare, and long: one copy of it serves
    /// every lane width.
    #[inline(never)]
    pub(super) fn play_near<S: Scene, M: Movement>(&self, body: &mut Body<S, T>, input: &Input<T>) {
        let world = self.around(body.player.map, &[], 0);
        self.move_among::<S, M>(&mut body.player, input, &world);
        self.land(body, &world);
    }

    /// The move of one player among bodies, wherever it ends. One copy of it serves worlds of one and of
    /// many, and those who ask for its contacts.
    #[inline(never)]
    pub(super) fn move_among<S: Scene, M: Movement>(
        &self,
        p: &mut Player<S, T>,
        input: &Input<T>,
        world: &Neighbourhood<'_, T>,
    ) {
        let velocity = push::<S, M, T>(p, input, self.rules);
        go::<S, M, T, _>(p, velocity, world, self.rules);
    }

    /// A tick of several players in one world. They move one after the other, each past the others as
    /// they stand at that moment; so nobody passes through anybody at any speed.
    pub(super) fn tick_world<S: Scene, M: Movement>(
        &self,
        bodies: &mut [Body<S, T>],
        inputs: &[Input<T>],
        stands: &mut Vec<Stand>,
    ) {
        bodies.iter_mut().zip(inputs).for_each(|(body, input)| self.aim(body, input));
        stands.clear();
        stands.extend(bodies.iter().map(|body| Stand::of(&body.player.place())));
        for me in 0..bodies.len() {
            let world = self.reachable(&bodies[me], stands, me);
            self.move_among::<S, M>(&mut bodies[me].player, &inputs[me], &world);
            self.wrap(&mut bodies[me].player);
            stands[me] = Stand::of(&bodies[me].player.place());
        }
        #[cfg(feature = "discs")]
        for (me, body) in bodies.iter_mut().enumerate() {
            let (map, world) = (body.player.map, self.reachable(body, stands, me));
            if let Some(arms) = body.arms.as_mut() {
                fly(arms, map, &world, self.arsenal);
            }
        }
        if !S::BLAST {
            return;
        }
        #[cfg(feature = "blast")]
        for shooter in 0..bodies.len() {
            let Some(slots) = bodies[shooter].arms.as_ref().map(|arms| arms.slots) else { return };
            for shot in slots.iter().filter(|shot| shot.burst()) {
                for (me, body) in bodies.iter_mut().enumerate() {
                    let world = self.around(body.player.map, stands, me);
                    self.suffer(&mut body.player, shot, &world);
                }
            }
        }
    }

    /// The world around one of its players, with all that stands.
    pub(super) fn around<'b>(&'b self, map: i32, stands: &'b [Stand], me: usize) -> Neighbourhood<'b, T> {
        Neighbourhood { stage: self, solids: self.solids_of(map), stands, me, log: None }
    }

    /// The same, without solids that neither he nor his projectiles can reach within the tick.
    fn reachable<'b, S: Scene>(
        &'b self,
        body: &Body<S, T>,
        stands: &'b [Stand],
        me: usize,
    ) -> Neighbourhood<'b, T> {
        let solids = if self.near_solids(body) { self.solids_of(body.player.map) } else { None };
        Neighbourhood { stage: self, solids, stands, me, log: None }
    }

    /// View and trigger.
    #[inline(always)]
    pub(super) fn aim<S: Scene, R: Real<Scalar = T>>(&self, body: &mut Body<S, R>, input: &Input<R>) {
        look(&mut body.player, input, self.rules);
        #[cfg(feature = "discs")]
        if let Some(arms) = body.arms.as_mut() {
            fire(arms, &body.player, input.fire, self.arsenal);
        }
    }

    /// The position back in its tile.
    #[inline(always)]
    fn wrap<S: Scene, R: Real<Scalar = T>>(&self, p: &mut Player<S, R>) {
        (p.position.x, p.position.y, p.tile_x, p.tile_y) =
            self.surface.wrap::<R>(p.position.x, p.position.y, p.tile_x, p.tile_y);
    }

    /// Everything after the move, for players alone in their worlds.
    #[inline(always)]
    pub(super) fn land<S: Scene, R: Real<Scalar = T>, W: Obstacles<R>>(
        &self,
        body: &mut Body<S, R>,
        world: &W,
    ) {
        self.wrap(&mut body.player);
        let Some(arms) = body.arms.as_mut() else { return };
        #[cfg(feature = "discs")]
        fly(arms, body.player.map, world, self.arsenal);
        #[cfg(feature = "blast")]
        if S::BLAST {
            for shot in &arms.slots {
                let burst = shot.burst();
                if burst.any() {
                    self.suffer_alone(&mut body.player, shot, burst);
                }
            }
        }
    }

    /// The shooter's own bursts, where he is alone.
    #[cfg(feature = "blast")]
    #[inline(always)]
    fn suffer_alone<S: Scene, R: Real<Scalar = T>>(
        &self,
        p: &mut Player<S, R>,
        shot: &Projectile<R>,
        burst: R::Mask,
    ) {
        let at = seen_from(p, &shot.place(p.map), &self.surface);
        if S::SOLIDS && !self.solids.is_empty() {
            // Most bursts are too far away to be felt, whatever they see.
            let (_, felt) = meets(p, at, burst, &self.arsenal.explosive, self.rules);
            for lane in (0..R::LANES).filter(|&lane| felt.lane(lane)) {
                let mut one = p.lane(lane);
                let world = self.around(one.map, &[], 0);
                self.suffer(&mut one, &shot.lane(lane), &world);
                p.set_lane(lane, &one);
            }
            return;
        }
        let coverage = coverage_on_terrain(&self.surface, p.map, at);
        strike(p, at, burst, coverage, &self.arsenal.explosive, self.rules);
    }

    /// What a burst does to one player of the world.
    #[cfg(feature = "blast")]
    fn suffer<S: Scene>(&self, p: &mut Player<S, T>, shot: &Projectile<T>, world: &Neighbourhood<'_, T>) {
        let at = seen_from(p, &shot.place(p.map), &self.surface);
        let eye = at + shot.axis * T::from_f64(LIFTED);
        self.explode(p, at, eye, &self.arsenal.explosive, world);
    }

    /// What an explosion at `at`, seen from `eye`, does to one player; both in his local frame, m.
    #[cfg(feature = "blast")]
    pub(super) fn explode<S: Scene>(
        &self,
        p: &mut Player<S, T>,
        at: V3<T>,
        eye: V3<T>,
        explosive: &Explosive<T>,
        world: &Neighbourhood<'_, T>,
    ) {
        let coverage = if !self.solids.is_empty() {
            let from = Place { position: eye, ..p.place() };
            let blocked = |point: V3<T>| world.line(&from, point - eye, true).hit;
            let free = body_points(p, self.rules).into_iter().filter(|&point| !blocked(point)).count();
            T::from_f64(0.25 * free as f64)
        } else {
            coverage_on_terrain(&self.surface, p.map, at)
        };
        strike(p, at, true, coverage, explosive, self.rules);
    }

    /// Whose tick, or whose projectiles', may meet a solid.
    #[inline(always)]
    pub(super) fn near_solids<S: Scene, R: Real<Scalar = T>>(&self, body: &Body<S, R>) -> R::Mask {
        let mut near = R::Mask::splat(false);
        if !S::SOLIDS {
            return near;
        }
        if self.solids.is_empty() {
            return near;
        }
        let p = &body.player;
        if R::LANES > 1
            && let [solids] = self.solids
            && self.all_beyond(solids, body)
        {
            return near;
        }
        self.mark_near((R::Mask::splat(true), self.range.tick), &p.place(), p.velocity, &mut near);
        for shot in body.arms.as_ref().iter().flat_map(|arms| &arms.slots) {
            let flying = shot.flying();
            if flying.any() {
                self.mark_near((flying, self.disc_time()), &shot.place(p.map), shot.velocity, &mut near);
            }
        }
        near
    }

    /// Whether nobody of a block, nor a projectile of his, comes as far as the rectangle that all solids
    /// stand in: one answer for the whole block, since mostly it is yes.
    #[inline(always)]
    fn all_beyond<S: Scene, R: Real<Scalar = T>>(&self, solids: &Solids, body: &Body<S, R>) -> bool {
        let p = &body.player;
        let mut away = home(&p.place());
        let (mut low, mut high) = (p.position, p.position);
        let mut reach = self.reach(p.velocity, self.range.tick);
        for shot in body.arms.as_ref().iter().flat_map(|arms| &arms.slots) {
            let flying = shot.flying();
            if flying.any() {
                let at = shot.place(p.map);
                away = away.and(flying.not().or(home(&at)));
                let place = V3::select(flying, at.position, p.position);
                (low.x, low.y) = (low.x.min(place.x), low.y.min(place.y));
                (high.x, high.y) = (high.x.max(place.x), high.y.max(place.y));
                let far = self.reach(shot.velocity, self.disc_time());
                reach = R::select(flying, reach.max(far), reach);
            }
        }
        !away.and(solids.beyond(self.range.centre, (low, high), reach)).not().any()
    }

    /// How far along each axis something at a velocity comes within so many seconds, m.
    #[inline(always)]
    fn reach<R: Real<Scalar = T>>(&self, velocity: V3<R>, time: f64) -> R {
        // The sum of the components is no less than the speed.
        let speed = velocity.x.abs() + velocity.y.abs() + velocity.z.abs();
        (speed + R::lit(self.range.gain)) * R::lit(time) + R::lit(self.range.size)
    }

    /// Seconds that a disc may fly in a tick.
    fn disc_time(&self) -> f64 {
        (self.range.tick + DISC_CLOCK.0) * DISC_CLOCK.1
    }

    /// Adds those of `chosen` to `near` who may meet a solid within so many seconds.
    #[inline(always)]
    fn mark_near<R: Real<Scalar = T>>(
        &self,
        (chosen, time): (R::Mask, f64),
        at: &Place<R>,
        velocity: V3<R>,
        near: &mut R::Mask,
    ) {
        let mut candidates = chosen;
        // Lanes on several maps are asked one by one.
        if R::LANES > 1
            && let [solids] = self.solids
        {
            let maybe = solids.may_be_near::<R>(self.range.centre, at.position, self.reach(velocity, time));
            candidates = chosen.and(home(at).not().or(maybe));
        }
        let mut bits = candidates.bits();
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let (at, velocity) = (at.lane(lane), velocity.lane(lane));
            if self.solids_of(at.map).is_some_and(|solids| self.reaches(solids, time, &at, velocity)) {
                near.set_lane(lane, true);
            }
        }
    }

    /// Whether something at a place and velocity may meet a solid within so many seconds.
    #[inline(always)]
    fn reaches(&self, solids: &Solids, time: f64, at: &Place<T>, velocity: V3<T>) -> bool {
        let range = &self.range;
        // The sum of the components is no less than the speed.
        let speed = (velocity.x.abs() + velocity.y.abs() + velocity.z.abs()).to_f64();
        let reach = (speed + range.gain) * time + range.size;
        let x = at.position.x.to_f64() + range.centre.x + f64::from(at.tile_x) * range.period.x;
        let y = at.position.y.to_f64() + range.centre.y + f64::from(at.tile_y) * range.period.y;
        solids.near(x, y, at.position.z.to_f64(), reach)
    }
}

/// Whose local coordinates are those of the first tile, where solids stand.
#[inline(always)]
fn home<R: Real>(at: &Place<R>) -> R::Mask {
    let zero = R::Int::splat(0);
    at.tile_x.eq(zero).and(at.tile_y.eq(zero))
}
