//! A shooting range: one player with a launcher, on one terrain, tick by tick in the order of the
//! specification: view, trigger, move, projectiles, blasts.

use super::lab::Lab;
use discjump_core::armor::Armor;
use discjump_core::arms::{Arms, Arsenal, Projectile, Weapon};
use discjump_core::blast::{coverage_on_terrain, seen_from, strike};
use discjump_core::flight::{fire, fly};
use discjump_core::input::Input;
use discjump_core::movement::Sliced;
use discjump_core::player::Player;
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::{Model, Physics, Rules};
use discjump_core::scene::DiscJump;
use discjump_core::terrain::Heightfield;
use discjump_core::tick::{act, look};

pub struct Range<T: Scalar> {
    pub lab: Lab<T>,
    pub arsenal: Arsenal<T>,
    pub p: Player<DiscJump, T>,
    pub arms: Arms<T>,
}

pub fn v3<T: Scalar>(a: [f64; 3]) -> V3<T> {
    V3::new(T::from_f64(a[0]), T::from_f64(a[1]), T::from_f64(a[2]))
}

impl<T: Scalar> Range<T> {
    pub fn new(terrain: &Heightfield, weapon: &Weapon, physics: Physics, tick_ms: u32) -> Self {
        let mut lab = Lab::<T>::with(terrain, physics);
        lab.rules = Rules::new(Model::Article, &discjump_core::armor::LIGHT, false, tick_ms, physics);
        let arsenal = Arsenal::new(weapon, tick_ms, &physics);
        let p = lab.player([0.0, 0.0, lab.ground(0.0, 0.0)], [0.0; 3]);
        Self { lab, arsenal, p, arms: Arms::new(&arsenal) }
    }

    pub fn wear(&mut self, armor: &Armor) {
        self.lab.rules = Rules::new(Model::Article, armor, false, 32, self.lab.rules.physics);
    }

    pub fn place(&mut self, position: [f64; 3], velocity: [f64; 3]) {
        (self.p.position, self.p.velocity) = (v3(position), v3(velocity));
    }

    /// Looks in a direction given by its angles, without a tick.
    pub fn aim(&mut self, yaw: f64, pitch: f64) {
        (self.p.yaw, self.p.pitch) = (T::from_f64(yaw), T::from_f64(pitch));
    }

    /// Pulls the trigger once, without a tick, and returns what left the muzzle.
    pub fn shoot(&mut self) -> Projectile<T> {
        fire(&mut self.arms, &self.p, true, &self.arsenal);
        self.arms.slots[0]
    }

    /// All projectiles one tick on, and nothing else.
    pub fn fly(&mut self) {
        let surface = self.lab.maps.surface::<T>();
        fly(&mut self.arms, self.p.map, &surface, &self.arsenal);
    }

    /// Flies the projectile in the first slot until it is gone or has burst; every place it was at.
    pub fn flight(&mut self) -> Vec<Projectile<T>> {
        let mut seen = Vec::new();
        loop {
            self.fly();
            if self.arms.slots[0].phase == 0 {
                return seen;
            }
            seen.push(self.arms.slots[0]);
            if self.arms.slots[0].burst() {
                return seen;
            }
        }
    }

    pub fn blast(&mut self, at: [f64; 3]) {
        let surface = self.lab.maps.surface::<T>();
        let at = v3(at);
        let coverage = coverage_on_terrain(&surface, self.p.map, at);
        strike(&mut self.p, at, true, coverage, &self.arsenal.explosive, &self.lab.rules);
    }

    /// A whole tick; the projectiles that burst in it.
    pub fn tick(&mut self, input: &Input<T>) -> Vec<Projectile<T>> {
        let surface = self.lab.maps.surface::<T>();
        let rules = &self.lab.rules;
        look(&mut self.p, input, rules);
        fire(&mut self.arms, &self.p, input.fire, &self.arsenal);
        act::<_, Sliced, T, _>(&mut self.p, input, &surface, rules);
        let p = &mut self.p;
        (p.position.x, p.position.y, p.tile_x, p.tile_y) =
            surface.wrap::<T>(p.position.x, p.position.y, p.tile_x, p.tile_y);
        fly(&mut self.arms, p.map, &surface, &self.arsenal);
        let bursts: Vec<_> = self.arms.slots.into_iter().filter(|slot| slot.burst()).collect();
        for blast in &bursts {
            let at = seen_from(p, &blast.place(p.map), &surface);
            let coverage = coverage_on_terrain(&surface, p.map, blast.position);
            strike(p, at, true, coverage, &self.arsenal.explosive, rules);
        }
        bursts
    }
}

pub fn trigger<T: Scalar>(pitch: f64) -> Input<T> {
    Input { fire: true, pitch: T::from_f64(pitch), ..Input::idle() }
}
