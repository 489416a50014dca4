//! How a tick's velocity becomes a change of place: the movement tiers.

mod contact;
mod sliced;

pub use sliced::Sliced;

use crate::player::Player;
use crate::real::Real;
use crate::rules::Rules;
use crate::scene::Scene;
use crate::terrain::Surface;

/// A form of the movement model.
pub trait Movement: Copy + Send + Sync + 'static {
    /// Moves the player through one tick at his velocity: position, velocity, contacts, landing
    /// damage, friction memory.
    fn advance<S: Scene, R: Real>(
        p: &mut Player<S, R>,
        surface: &Surface<'_, R::Scalar>,
        rules: &Rules<R::Scalar>,
    );
}
