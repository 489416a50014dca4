//! Explosions and projectiles of a simulator, as its users see them.

use super::super::neighbourhood::Stand;
use super::Simulator;
use super::setup::find_weapon;
#[cfg(feature = "blast")]
use crate::blast::seen_from;
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::movement::Movement;
use crate::player::Place;
use crate::real::{Real, Scalar, V3};
use crate::scene::{Group, Scene};
use glam::{DVec3, IVec2};

/// A projectile, or where one burst.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Who fired it.
    pub player: usize,
    /// World position, m.
    pub position: [f64; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// While it flies the direction it was aimed in; once it has burst the normal of what it met.
    pub axis: [f64; 3],
    /// Ticks since the shot, the tick of the shot included.
    pub age: i32,
}

fn floats<T: Scalar>(v: V3<T>) -> [f64; 3] {
    [v.x.to_f64(), v.y.to_f64(), v.z.to_f64()]
}

impl<S: Scene, M: Movement, R: Real> Simulator<S, M, R> {
    /// The projectiles in a phase.
    pub(super) fn shots(&self, phase: i32) -> Vec<Shot> {
        let mut found = Vec::new();
        for player in 0..self.count {
            let body = self.body(player);
            let Some(arms) = body.arms.as_ref() else { return found };
            for shot in arms.slots.iter().filter(|shot| shot.phase == phase) {
                let local = DVec3::from(floats(shot.position));
                found.push(Shot {
                    player,
                    position: self.maps.to_world(local, IVec2::new(shot.tile_x, shot.tile_y)).to_array(),
                    velocity: floats(shot.velocity),
                    axis: floats(shot.axis),
                    age: shot.age,
                });
            }
        }
        found
    }

    pub(super) fn explode_all(&mut self, points: &[[f64; 3]], weapon: &str) -> Result<(), InputError> {
        self.refuse_broken()?;
        if !S::BLAST {
            refuse!("explode: the scene {:?} models no explosions", S::NAME);
        }
        #[cfg(feature = "blast")]
        self.explode_checked(points, weapon)?;
        Ok(())
    }

    #[cfg(feature = "blast")]
    fn explode_checked(&mut self, points: &[[f64; 3]], weapon: &str) -> Result<(), InputError> {
        let explosive = find_weapon(weapon)?.explosive.rounded::<R::Scalar>();
        if points.len() != self.count {
            refuse!("points: expected {} rows, got {}", self.count, points.len());
        }
        let mut placed = Vec::with_capacity(points.len());
        for (row, point) in points.iter().enumerate() {
            let point = DVec3::from(*point);
            let place = if point.is_nan() {
                None
            } else {
                Some(self.maps.to_local(point).map_err(|e| InputError(format!("points[{row}]: {e}")))?)
            };
            placed.push(place);
        }
        let _floats = DefaultFloats::enter();
        let t = R::Scalar::from_f64;
        let mut struck = Vec::new();
        for world in (0..self.count).step_by(self.per_world) {
            let mut bodies: Vec<_> = (world..world + self.per_world).map(|i| self.body(i)).collect();
            let stands: Vec<_> = bodies.iter().map(|b| Stand::of(&b.player.place())).collect();
            let stage = self.stage();
            for (local, tile) in placed[world..world + self.per_world].iter().flatten() {
                let position = V3::new(t(local.x), t(local.y), t(local.z));
                for (me, body) in bodies.iter_mut().enumerate() {
                    let map = body.player.map;
                    let place = Place { position, tile_x: tile.x, tile_y: tile.y, map };
                    let at = seen_from(&body.player, &place, &stage.surface);
                    let hood = stage.around(body.player.map, &stands, me);
                    stage.explode(&mut body.player, at, at, &explosive, &hood);
                }
            }
            struck.extend(bodies);
        }
        for (i, body) in struck.iter().enumerate() {
            self.blocks[i / R::LANES].set_lane(i % R::LANES, body);
        }
        Ok(())
    }
}
