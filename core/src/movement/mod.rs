//! How a tick's velocity becomes a change of place: the movement tiers.

mod contact;
mod obstacles;
mod sliced;

pub use obstacles::Obstacles;
pub use sliced::Sliced;

use crate::player::Player;
use crate::real::Real;
use crate::rules::Rules;
use crate::scene::Scene;

/// A form of the movement model.
pub trait Movement: Copy + Send + Sync + 'static {
    /// Moves the player through one tick at his velocity: position, velocity, contacts, landing
    /// damage, friction memory.
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(p: &mut Player<S, R>, world: &W, rules: &Rules<R::Scalar>);
}
