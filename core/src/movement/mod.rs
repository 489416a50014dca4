//! How a tick's velocity becomes a change of place: the movement tiers (docs/tiers.md compares them).
//!
//! ```text
//! sliced    `reference`, `authentic`: slices of a metre, restarted at each contact
//! swept     `swept`: one sweep and a fix-up of the last slice
//! fast      `fast`: one look at the ground, at the end of the move
//! anyway    `anyway`: the literal reading of the article, which tunnels; to be measured
//! engine    `engine`: the 1998 engine's sub-steps of a sphere
//! contact   what a contact does to a player, in all of them
//! obstacles what stands in the way: terrain, and in some scenes bodies
//! ```

mod anyway;
mod contact;
mod engine;
mod fast;
mod obstacles;
mod sliced;
mod swept;

pub use anyway::Anyway;
pub use engine::Engine;
pub use fast::Fast;
pub use obstacles::Obstacles;
pub use sliced::Sliced;
pub use swept::Swept;

use crate::player::Player;
use crate::real::{Mask, Real, V3};
use crate::rules::{Model, Rules};
use crate::scene::Scene;
use crate::terrain::Surface;

/// A form of the movement model.
pub trait Movement: Copy + Send + Sync + 'static {
    /// The model whose order of a tick it belongs to.
    const MODEL: Model;

    /// Moves the player through one tick at his velocity: position, velocity, contacts, landing
    /// damage, friction memory. `before` is his velocity after the jump and before the tick's forces,
    /// which only the engine's trapezoid asks for.
    fn advance<S: Scene, R: Real, W: Obstacles<R>>(
        p: &mut Player<S, R>,
        before: V3<R>,
        world: &W,
        rules: &Rules<R::Scalar>,
    );

    /// The fewest lanes with which [`Movement::pass`] gains time (measured); more than there are where it
    /// moves nobody. A player alone is done sooner with one look than with two.
    const PASSES_FROM: usize = usize::MAX;

    /// Over bare terrain, moves those at once who are easily seen to meet nothing, and returns them. The
    /// bits are those of `advance`, which must still move the others. Most ticks of most players are such,
    /// and without a branch on numbers those of several players overlap in the processor.
    #[inline(always)]
    fn pass<S: Scene, R: Real>(
        _p: &mut Player<S, R>,
        _surface: &Surface<'_, R::Scalar>,
        _rules: &Rules<R::Scalar>,
    ) -> R::Mask {
        R::Mask::splat(false)
    }
}
