//! What stands in a mover's way: the terrain and, in some scenes, bodies (solids, other players).

use crate::player::{Place, Player};
use crate::real::{Real, V3};
use crate::scene::Scene;
use crate::terrain::{Hit, Surface};

/// The world as one player's move sees it.
pub trait Obstacles<R: Real> {
    /// Whether there is anything beside the terrain; a constant, so that a move over bare terrain
    /// holds no trace of bodies.
    const BODIES: bool;

    /// The terrain.
    fn surface(&self) -> &Surface<'_, R::Scalar>;

    /// First contact of the player's body with other bodies, moved along `path` (m); [`Hit::body`] is
    /// set where there is one. Lanes outside `active` report none.
    fn sweep_bodies(&self, at: &Place<R>, path: V3<R>, active: R::Mask) -> Hit<R>;

    /// First body on a line from `at` along `path`, for projectiles: two-sided, of no radius.
    fn line_bodies(&self, at: &Place<R>, path: V3<R>, active: R::Mask) -> Hit<R>;

    /// How far a player who met `hit` along `path` must be lifted to go on over the ledge (section
    /// 5.1); 0 where there is no such ledge. `active` are those whose contact was steep enough.
    fn step_up(&self, at: &Place<R>, path: V3<R>, hit: &Hit<R>, active: R::Mask) -> R;

    /// Hears of every contact before it acts: of those in `hit`, at local `point` (m), with a surface of that
    /// normal. Only who asks for a tick's contacts listens.
    #[inline(always)]
    fn note<S: Scene>(&self, _p: &Player<S, R>, _hit: R::Mask, _point: V3<R>, _normal: V3<R>) {}

    /// First contact of a player, moved along `path`, with terrain or bodies.
    #[inline(always)]
    fn sweep(&self, at: &Place<R>, path: V3<R>, active: R::Mask) -> Hit<R> {
        let ground = self.surface().sweep::<R>(at.map, at.position, path, active);
        if !Self::BODIES {
            return ground;
        }
        Hit::first(ground, self.sweep_bodies(at, path, active))
    }

    /// First contact of a projectile, moved along `path`, with terrain or bodies.
    #[inline(always)]
    fn line(&self, at: &Place<R>, path: V3<R>, active: R::Mask) -> Hit<R> {
        let ground = self.surface().line::<R>(at.map, at.position, path, active);
        if !Self::BODIES {
            return ground;
        }
        Hit::first(ground, self.line_bodies(at, path, active))
    }
}

/// Bare terrain.
impl<R: Real> Obstacles<R> for Surface<'_, R::Scalar> {
    const BODIES: bool = false;

    #[inline(always)]
    fn surface(&self) -> &Surface<'_, R::Scalar> {
        self
    }

    #[inline(always)]
    fn sweep_bodies(&self, _at: &Place<R>, _path: V3<R>, _active: R::Mask) -> Hit<R> {
        Hit::none()
    }

    #[inline(always)]
    fn line_bodies(&self, _at: &Place<R>, _path: V3<R>, _active: R::Mask) -> Hit<R> {
        Hit::none()
    }

    #[inline(always)]
    fn step_up(&self, _at: &Place<R>, _path: V3<R>, _hit: &Hit<R>, _active: R::Mask) -> R {
        R::zero()
    }
}
