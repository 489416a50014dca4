//! The kernel by hand: one player, one tick after the other, his local state laid open.

use discjump_core::armor::LIGHT;
use discjump_core::input::Input;
use discjump_core::movement::{Movement, Sliced};
use discjump_core::player::{Contact, Player};
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::{Model, Physics, Rules};
use discjump_core::scene::{Has, Sandbox, Scene};
use discjump_core::terrain::{Heightfield, Maps};
use discjump_core::tick::tick;

pub type Body<T> = Player<Sandbox, T>;

pub struct Lab<T> {
    pub maps: Maps,
    pub rules: Rules<T>,
}

impl<T: Scalar> Lab<T> {
    pub fn new(terrain: &Heightfield) -> Self {
        Self::with(terrain, Physics::default())
    }

    pub fn with(terrain: &Heightfield, physics: Physics) -> Self {
        Self::of(Model::Article, terrain, physics)
    }

    pub fn of(model: Model, terrain: &Heightfield, physics: Physics) -> Self {
        let maps = Maps::new(core::slice::from_ref(terrain)).unwrap();
        Self { maps, rules: Rules::new(model, &LIGHT, false, 32, physics) }
    }

    pub fn player<S: Scene>(&self, position: [f64; 3], velocity: [f64; 3]) -> Player<S, T> {
        let v = |a: [f64; 3]| V3::new(T::from_f64(a[0]), T::from_f64(a[1]), T::from_f64(a[2]));
        let mut p = Player::new(&self.rules, v(position), 0);
        p.velocity = v(velocity);
        p
    }

    pub fn tick<S: Scene>(&self, before: &Player<S, T>, input: &Input<T>) -> Player<S, T> {
        self.tick_as::<Sliced, S>(before, input)
    }

    pub fn tick_as<M: Movement, S: Scene>(&self, before: &Player<S, T>, input: &Input<T>) -> Player<S, T> {
        let surface = self.maps.surface::<T>();
        let mut p = tick::<S, M, T, _>(before, input, &surface, &self.rules);
        (p.position.x, p.position.y, p.tile_x, p.tile_y) =
            surface.wrap::<T>(p.position.x, p.position.y, p.tile_x, p.tile_y);
        p
    }

    /// Height of the ground at a local place, m.
    pub fn ground(&self, x: f64, y: f64) -> f64 {
        let ground = self.maps.surface::<T>().ground::<T>(0, T::from_f64(x), T::from_f64(y));
        ground.height.to_f64()
    }

    /// Height of the feet over the ground, m, computed in f64.
    pub fn clearance<S: Scene>(&self, p: &Player<S, T>) -> f64 {
        let ground = self.maps.surface::<T>().ground::<T>(0, p.position.x, p.position.y);
        p.position.z.to_f64() - ground.height.to_f64()
    }
}

pub fn floats<T: Scalar>(v: V3<T>) -> [f64; 3] {
    [v.x.to_f64(), v.y.to_f64(), v.z.to_f64()]
}

/// Every number of a body.
pub fn numbers<T: Scalar>(p: &Body<T>) -> Vec<f64> {
    let (Has(Contact { normal, .. }), Has(energy), Has(damage)) = (p.contact, p.energy, p.damage);
    let scalars = [p.yaw, p.pitch, p.friction, energy, damage].map(Scalar::to_f64);
    [&floats(p.position)[..], &floats(p.velocity), &floats(normal), &scalars].concat()
}

/// Keys as whole numbers, turn in tenths of rad/s.
pub fn input<T: Scalar>(forward: i8, strafe: i8, jump: bool, jet: bool, turn: i8) -> Input<T> {
    let t = |x: i8| T::from_f64(f64::from(x));
    Input {
        forward: t(forward),
        strafe: t(strafe),
        jump,
        jet,
        turn: T::from_f64(f64::from(turn) / 10.0),
        ..Input::idle()
    }
}
