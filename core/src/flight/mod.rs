//! How projectiles leave the launcher and how they fly (docs/physics.md, section 7 and the appendix).
//!
//! A tick's order is: the view turns, [`fire`], the players move, [`fly`], then the bursts act on the
//! players (section 12). A burst stays in its slot, to be read, until the next tick's [`fly`].

mod disc;
mod fire;
mod shell;

pub use fire::fire;

use crate::arms::{Arms, Arsenal, BURST, FREE, Flight, Projectile};
use crate::movement::Obstacles;
use crate::real::{Int, Mask, Real, V3, Work};

/// Moves all projectiles of a launcher through one tick, the one just fired included. `map` is the
/// shooter's; `world` is the world as his projectiles see it, without himself: nothing that a player
/// fires ever meets him (the sources spare him by rule for a disc, for 250 ms for a shell).
#[inline(always)]
pub fn fly<R: Real, W: Obstacles<R>>(
    arms: &mut Arms<R>,
    map: R::Int,
    world: &W,
    arsenal: &Arsenal<R::Scalar>,
) {
    R::enter(Fly { arms, map, world, arsenal });
}

/// See [`fly`]: compiled once for each lane width, not once for each scene and tier.
struct Fly<'a, R: Real, W: Obstacles<R>> {
    arms: &'a mut Arms<R>,
    map: R::Int,
    world: &'a W,
    arsenal: &'a Arsenal<R::Scalar>,
}

impl<R: Real, W: Obstacles<R>> Work for Fly<'_, R, W> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        fly_all(self.arms, self.map, self.world, self.arsenal);
    }
}

#[inline(always)]
fn fly_all<R: Real, W: Obstacles<R>>(
    arms: &mut Arms<R>,
    map: R::Int,
    world: &W,
    arsenal: &Arsenal<R::Scalar>,
) {
    for slot in &mut arms.slots {
        let taken = slot.phase.eq(R::Int::splat(FREE)).not();
        if !taken.any() {
            continue;
        }
        slot.age = R::Int::select(slot.flying(), slot.age + R::Int::splat(1), slot.age);
        let alive = slot.flying().and(slot.age.lt(R::Int::splat(arsenal.life)));
        *slot = Projectile::select(alive, slot, &Projectile::none());
        if !alive.any() {
            continue;
        }
        match arsenal.flight {
            Flight::Disc { terminal, gain } => {
                disc::swept(slot, alive, map, world, arsenal, (terminal, gain))
            }
            Flight::EngineDisc { terminal } => disc::clocked(slot, alive, map, world, arsenal, terminal),
            Flight::Shell { fall, elasticity, arms } => {
                shell::bouncing(slot, alive, map, world, arsenal, &shell::Shell { fall, elasticity, arms });
            }
        }
        let (x, y) = (slot.position.x, slot.position.y);
        (slot.position.x, slot.position.y, slot.tile_x, slot.tile_y) =
            world.surface().wrap::<R>(x, y, slot.tile_x, slot.tile_y);
    }
}

/// Marks a burst where the projectile is, at a contact of the given normal.
#[inline(always)]
fn burst<R: Real>(projectile: &mut Projectile<R>, met: R::Mask, normal: V3<R>) {
    projectile.phase = R::Int::select(met, R::Int::splat(BURST), projectile.phase);
    projectile.axis = V3::select(met, normal, projectile.axis);
}
