//! The world as a player's move asks it, with everything it answered.

use std::cell::RefCell;

use discjump_core::movement::Obstacles;
use discjump_core::player::Place;
use discjump_core::real::{Scalar, V3};
use discjump_core::terrain::{Hit, Surface};

/// A sweep that a move asked for, and what it met.
#[derive(Clone, Copy)]
pub struct Sweep<T: Scalar> {
    /// The way that was swept, m.
    pub path: V3<T>,
    /// What was met on it.
    pub hit: Hit<T>,
}

/// Bare terrain that remembers the sweeps of a tick. The movement is compiled for it as for the terrain
/// itself, so nothing in the product knows of it.
pub struct Witness<'a, T: Scalar> {
    surface: Surface<'a, T>,
    sweeps: RefCell<Vec<Sweep<T>>>,
}

impl<'a, T: Scalar> Witness<'a, T> {
    /// Over a terrain.
    pub fn new(surface: Surface<'a, T>) -> Self {
        Self { surface, sweeps: RefCell::new(Vec::new()) }
    }

    /// What was asked since the last call.
    pub fn take(&self) -> Vec<Sweep<T>> {
        self.sweeps.take()
    }
}

impl<T: Scalar> Obstacles<T> for Witness<'_, T> {
    const BODIES: bool = false;

    fn surface(&self) -> &Surface<'_, T> {
        &self.surface
    }

    fn sweep_bodies(&self, _at: &Place<T>, _path: V3<T>, _active: bool) -> Hit<T> {
        Hit::none()
    }

    fn line_bodies(&self, _at: &Place<T>, _path: V3<T>, _active: bool) -> Hit<T> {
        Hit::none()
    }

    fn step_up(&self, _at: &Place<T>, _path: V3<T>, _hit: &Hit<T>, _active: bool) -> T {
        T::zero()
    }

    fn sweep(&self, at: &Place<T>, path: V3<T>, active: bool) -> Hit<T> {
        let hit = self.surface.sweep::<T>(at.map, at.position, path, active);
        self.sweeps.borrow_mut().push(Sweep { path, hit });
        hit
    }
}
