//! The kinds of goal, each its own type: what a task does not need is neither stored nor computed.

use super::flag::Flag;
use crate::real::Real;
use crate::scene::{Absent, Group, Has};
use core::fmt::Debug;

/// A kind of goal.
pub trait Kind: Copy + Debug + Send + Sync + 'static {
    /// Whether the goal is a place in space, that the feet must pass: else it is one on the map, at whatever
    /// height.
    const ALOFT: bool;
    /// The flag of those who carry one.
    type Flag<R: Real>: Group<Flag<R>>;
}

/// A beacon on the ground, reached at any height above it.
#[derive(Clone, Copy, Debug)]
pub struct Beacon;

impl Kind for Beacon {
    const ALOFT: bool = false;
    type Flag<R: Real> = Absent;
}

/// A marker that floats in the air.
#[derive(Clone, Copy, Debug)]
pub struct Marker;

impl Kind for Marker {
    const ALOFT: bool = true;
    type Flag<R: Real> = Absent;
}

/// Two flag stands: one to reach, and, where the flag is to be captured, one to come back to.
#[derive(Clone, Copy, Debug)]
pub struct Stands;

impl Kind for Stands {
    const ALOFT: bool = true;
    type Flag<R: Real> = Has<Flag<R>>;
}
