//! Public states, out and in.

use super::super::codec::{read_body, write_body, write_place};
use super::super::legal::{Fastest, check_launcher, check_player};
use super::Bodies;
use super::Simulator;
use crate::error::{InputError, refuse};
use crate::float_environment::DefaultFloats;
use crate::movement::Movement;
use crate::real::{Real, Scalar, V3};
use crate::scene::{Group, Scene};
use glam::DVec3;

/// Fastest player that `set_state` accepts, m/s.
pub const MAX_SPEED: f64 = 1e6;

/// Of everybody: faster ones are made by falling only.
const ACCEPTED: Fastest = Fastest { across: MAX_SPEED, down: MAX_SPEED };

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
            let (place, tile) = self.maps.to_local(world).map_err(|e| e.of(format_args!("state[{row}]")))?;
            let t = <R::Scalar as Scalar>::from_f64;
            p.position = V3::new(t(place.x), t(place.y), t(place.z));
            (p.tile_x, p.tile_y) = (tile.x, tile.y);
            read_body(&mut body, false, &bytes[24..]);
            let named = |e: InputError| e.of(format_args!("state[{row}]"));
            check_player(&body.player, &self.rules, ACCEPTED).map_err(named)?;
            body.player.yaw = crate::tick::wrap_angle(body.player.yaw);
            if let Some(arms) = body.arms.as_ref() {
                check_launcher(arms).map_err(named)?;
            }
            decoded.push(body);
        }
        for (&i, body) in indices.iter().zip(&decoded) {
            self.blocks[i / R::LANES].set_lane(i % R::LANES, body);
        }
        Ok(())
    }
}
