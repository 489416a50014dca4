//! Public states, out and in.

use super::super::codec::{read_body, write_body, write_place};
use super::Bodies;
use super::Simulator;
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::movement::Movement;
use crate::player::{MOST_BUMP_LIMITS, OLDEST_MS, Player};
use crate::real::{Real, Scalar, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use glam::DVec3;

/// Fastest player that `set_state` accepts, m/s.
pub const MAX_SPEED: f64 = 1e6;

/// Most ticks of a cooldown and shots of a launcher that `set_state` accepts.
const MAX_COUNT: i32 = 1_000_000;

impl<S: Scene, M: Movement, R: Real> Simulator<S, M, R> {
    pub(super) fn write_states(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.count * self.state_bytes());
        for i in 0..self.count {
            let body = self.body(i);
            write_place(&self.maps, &body.player, &mut out);
            write_body(&body, false, &mut out);
        }
        out
    }

    pub(super) fn read_states(&mut self, indices: &[usize], states: &[u8]) -> Result<(), InputError> {
        let _floats = DefaultFloats::enter();
        let stride = self.state_bytes();
        if states.len() != indices.len() * stride {
            refuse!("state: expected {} states of {stride} bytes, got {} bytes", indices.len(), states.len());
        }
        if let Some(i) = indices.iter().find(|&&i| i >= self.count) {
            refuse!("indices: expected 0 to {}, got {i}", self.count - 1);
        }
        let mut decoded = Vec::with_capacity(indices.len());
        for (row, bytes) in states.chunks_exact(stride).enumerate() {
            let mut body = self.body(indices[row]);
            let p = &mut body.player;
            let number = |k: usize| f64::from_le_bytes(bytes[8 * k..8 * k + 8].try_into().expect("8 bytes"));
            let world = DVec3::new(number(0), number(1), number(2));
            let (place, tile) =
                self.maps.to_local(world).map_err(|e| InputError(format!("state[{row}].{e}")))?;
            let t = <R::Scalar as Scalar>::from_f64;
            p.position = V3::new(t(place.x), t(place.y), t(place.z));
            (p.tile_x, p.tile_y) = (tile.x, tile.y);
            read_body(&mut body, false, &bytes[24..]);
            check_player(&mut body.player, &self.rules, row)?;
            if let Some(arms) = body.arms.as_ref() {
                for (name, value) in [("cooldown", arms.cooldown), ("ammo", arms.ammo)] {
                    if !(0..=MAX_COUNT).contains(&value) {
                        refuse!("state[{row}].{name}: expected 0 to {MAX_COUNT}, got {value}");
                    }
                }
            }
            decoded.push(body);
        }
        for (&i, body) in indices.iter().zip(&decoded) {
            self.blocks[i / R::LANES].set_lane(i % R::LANES, body);
        }
        Ok(())
    }
}

/// Refuses a state that the physics could not go on from.
fn check_player<S: Scene, T: Scalar>(
    p: &mut Player<S, T>,
    rules: &Rules<T>,
    row: usize,
) -> Result<(), InputError> {
    let v = [p.velocity.x, p.velocity.y, p.velocity.z];
    if v.iter().any(|x| !x.finite() || x.to_f64().abs() > MAX_SPEED) {
        refuse!("state[{row}].velocity: expected finite numbers within +-{MAX_SPEED} m/s, got {v:?}");
    }
    for (name, angle) in [("yaw", p.yaw), ("pitch", p.pitch)] {
        if !angle.finite() || angle.to_f64().abs() > 1e6 {
            refuse!("state[{row}].{name}: expected a finite angle within +-1e6 rad, got {angle:?}");
        }
    }
    p.yaw = crate::tick::wrap_angle(p.yaw);
    let range = |name: &str, x: T, low: f64, high: f64| {
        if x.finite() && (low..=high).contains(&x.to_f64()) {
            return Ok(());
        }
        Err(InputError(format!("state[{row}].{name}: expected {low} to {high}, got {x:?}")))
    };
    range("friction", p.friction, 0.0, 1.0)?;
    range("energy", p.energy.get(T::zero()), 0.0, rules.max_energy.to_f64())?;
    range("damage", p.damage.get(T::zero()), 0.0, 1e9)?;
    let contact = p.contact();
    if !(0..=OLDEST_MS).contains(&contact.age) {
        refuse!("state[{row}].jump_age: expected 0 to {OLDEST_MS} ms, got {}", contact.age);
    }
    let limits = p.bump_limits.get(0);
    if !(0..=MOST_BUMP_LIMITS).contains(&limits) {
        refuse!("state[{row}].bump_limits: expected 0 to {MOST_BUMP_LIMITS}, got {limits}");
    }
    let length = contact.normal.length();
    if !length.finite() || (length.to_f64() - 1.0).abs() > 1e-3 {
        refuse!("state[{row}].jump_normal: expected length 1, got {:?}", contact.normal);
    }
    Ok(())
}
