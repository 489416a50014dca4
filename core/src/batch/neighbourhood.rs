//! What stands in one player's way beside the terrain: solids, and the other players of his world.
//!
//! Scalar, and the slow way: whoever is far from every body never comes here.

use super::crowd::{meet_box, meet_sphere};
use super::stage::Stage;
use crate::movement::Obstacles;
use crate::player::{Place, Player};
use crate::real::{Scalar, V3};
use crate::scene::Scene;
use crate::solids::{SolidHit, Solids};
use crate::terrain::{Hit, Surface};
use glam::{DVec3, IVec2};
use std::cell::RefCell;

/// A contact of a player, before it acted on him.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// World position of the player's feet there, m.
    pub position: [f64; 3],
    /// His velocity, m/s.
    pub velocity: [f64; 3],
    /// The surface's unit normal.
    pub normal: [f64; 3],
}

/// Feet of a player: local position and tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    local: DVec3,
    tile: IVec2,
}

impl Stand {
    pub(super) fn of<T: Scalar>(at: &Place<T>) -> Self {
        Self { local: vector(at.position), tile: IVec2::new(at.tile_x, at.tile_y) }
    }
}

pub(super) fn vector<T: Scalar>(v: V3<T>) -> DVec3 {
    DVec3::new(v.x.to_f64(), v.y.to_f64(), v.z.to_f64())
}

/// The world around one player of it.
#[derive(Clone, Copy)]
pub(super) struct Neighbourhood<'a, T: Scalar> {
    pub(super) stage: &'a Stage<'a, T>,
    /// The solids within his reach; none where he is far from all of them.
    pub(super) solids: Option<&'a Solids>,
    /// Where all players of the world stand at this moment.
    pub(super) stands: &'a [Stand],
    /// Whose way it is: his own body is not in it.
    pub(super) me: usize,
    /// Where his contacts are written down, for those who ask.
    pub(super) log: Option<&'a RefCell<Vec<Contact>>>,
}

fn hit<T: Scalar>(fraction: f64, normal: DVec3) -> Hit<T> {
    let t = T::from_f64;
    Hit {
        hit: true,
        fraction: t(fraction),
        normal: V3::new(t(normal.x), t(normal.y), t(normal.z)),
        body: true,
    }
}

impl<T: Scalar> Neighbourhood<'_, T> {
    /// The others, as the way from `at` to their feet. Tiles are subtracted before metres are: so two
    /// players a thousand million metres away meet with the bits of two at the centre.
    fn others(&self, at: &Place<T>) -> impl Iterator<Item = DVec3> {
        let here = Stand::of(at);
        let period = self.stage.maps.size();
        let me = self.me;
        self.stands.iter().enumerate().filter(move |(k, _)| *k != me).map(move |(_, stand)| {
            let tiles = (stand.tile - here.tile).as_dvec2() * period;
            tiles.extend(0.0) + (stand.local - here.local)
        })
    }

    fn world(&self, at: &Place<T>) -> DVec3 {
        self.stage.maps.to_world(vector(at.position), IVec2::new(at.tile_x, at.tile_y))
    }

    fn half_width(&self) -> f64 {
        self.stage.rules.half_width.to_f64()
    }

    fn height(&self) -> f64 {
        self.stage.rules.height.to_f64()
    }
}

impl<T: Scalar> Obstacles<T> for Neighbourhood<'_, T> {
    const BODIES: bool = true;

    fn surface(&self) -> &Surface<'_, T> {
        &self.stage.surface
    }

    fn note<S: Scene>(&self, p: &Player<S, T>, hit: bool, point: V3<T>, normal: V3<T>) {
        if let (Some(log), true) = (self.log, hit) {
            let place = Place { position: point, ..p.place() };
            log.borrow_mut().push(Contact {
                position: self.world(&place).to_array(),
                velocity: vector(p.velocity).to_array(),
                normal: vector(normal).to_array(),
            });
        }
    }

    fn sweep_bodies(&self, at: &Place<T>, path: V3<T>, active: bool) -> Hit<T> {
        if !active {
            return Hit::none();
        }
        let path = vector(path);
        let mut first = Hit::none();
        if let Some(solids) = self.solids {
            let found = solids.sweep_box(self.world(at), path, self.half_width(), self.height());
            if let Some(SolidHit { fraction, normal, .. }) = found {
                first = hit(fraction, normal);
            }
        }
        // Both centres are as far above their feet: the way between feet is the way between centres.
        for other in self.others(at) {
            if let Some((fraction, normal)) = meet_sphere(-other, path, self.height()) {
                first = Hit::first(first, hit(fraction, normal));
            }
        }
        first
    }

    fn line_bodies(&self, at: &Place<T>, path: V3<T>, active: bool) -> Hit<T> {
        if !active {
            return Hit::none();
        }
        let path = vector(path);
        let mut first = Hit::none();
        if let Some(solids) = self.solids
            && let Some(SolidHit { fraction, normal, .. }) = solids.ray(self.world(at), path)
        {
            first = hit(fraction, normal);
        }
        for other in self.others(at) {
            let met = meet_box(DVec3::ZERO, path, other, self.half_width(), self.height());
            if let Some((fraction, normal)) = met {
                first = Hit::first(first, hit(fraction, normal));
            }
        }
        first
    }

    fn step_up(&self, at: &Place<T>, path: V3<T>, met: &Hit<T>, active: bool) -> T {
        // Only over solids: players are no stairs.
        let (true, true, Some(solids)) = (active, met.body, self.solids) else {
            return T::zero();
        };
        let (feet, path) = (self.world(at), vector(path));
        let Some(found) = solids.sweep_box(feet, path, self.half_width(), self.height()) else {
            return T::zero();
        };
        // What was met may be a player who stands before the solid.
        if T::from_f64(found.fraction) != met.fraction {
            return T::zero();
        }
        let most = 0.6 * 0.5 * self.height();
        let lift = solids.step_up(feet, path, self.half_width(), self.height(), most, &found);
        T::from_f64(lift.unwrap_or(0.0))
    }
}
