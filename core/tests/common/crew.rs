//! A simulator of several players, read and written by field name.

use super::*;

pub struct Crew {
    pub sim: Box<dyn Bodies>,
}

impl Crew {
    pub fn new(setup: &SimulatorSetup<'_>) -> Self {
        Self { sim: setup.build().unwrap() }
    }

    /// A field of one player.
    pub fn get(&self, player: usize, name: &str) -> Vec<f64> {
        let stride = self.sim.state_bytes();
        let state = self.sim.state()[player * stride..(player + 1) * stride].to_vec();
        read_field(&*self.sim, &state, name)
    }

    /// Overwrites fields of one player.
    pub fn set(&mut self, player: usize, fields: &[(&str, &[f64])]) {
        let stride = self.sim.state_bytes();
        let mut state = self.sim.state()[player * stride..(player + 1) * stride].to_vec();
        write_fields(&*self.sim, &mut state, fields);
        self.sim.set_state(&[player], &state).unwrap();
    }

    pub fn position(&self, player: usize) -> [f64; 3] {
        self.get(player, "position").try_into().unwrap()
    }

    pub fn velocity(&self, player: usize) -> [f64; 3] {
        self.get(player, "velocity").try_into().unwrap()
    }

    /// Puts a player somewhere at a velocity.
    pub fn put(&mut self, player: usize, position: [f64; 3], velocity: [f64; 3]) {
        self.set(player, &[("position", &position), ("velocity", &velocity)]);
    }

    /// The bytes of one player's state.
    pub fn bytes(&self, player: usize) -> Vec<u8> {
        let stride = self.sim.state_bytes();
        self.sim.state()[player * stride..(player + 1) * stride].to_vec()
    }
}
