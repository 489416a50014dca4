//! The trigger.

use crate::arms::{Arms, Arsenal, FLYING, MUZZLE, Projectile};
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::scene::Scene;

/// Lets a tick of the launcher's cycle pass and fires where the trigger is held, the cycle is over and
/// a shot is left. Position, velocity and view are those before the move, the view already turned.
#[inline(always)]
pub fn fire<S: Scene, R: Real>(
    arms: &mut Arms<R>,
    p: &Player<S, R>,
    trigger: R::Mask,
    arsenal: &Arsenal<R::Scalar>,
) {
    let (zero, one) = (R::Int::splat(0), R::Int::splat(1));
    arms.cooldown = R::Int::select(zero.lt(arms.cooldown), arms.cooldown - one, zero);
    let mut wanted = trigger.and(arms.cooldown.lt(one)).and(zero.lt(arms.ammo));
    if !wanted.any() {
        return;
    }

    let (sin, cos) = p.yaw.sin_cos();
    let (sin_pitch, cos_pitch) = p.pitch.sin_cos();
    let aim = V3::new(-sin * cos_pitch, cos * cos_pitch, sin_pitch);
    let [right, forward, up] = MUZZLE.map(R::lit);
    let muzzle = V3::new(right * cos - forward * sin, right * sin + forward * cos, up);
    let shot = Projectile {
        position: p.position + muzzle,
        tile_x: p.tile_x,
        tile_y: p.tile_y,
        velocity: aim * R::splat(arsenal.speed) + p.velocity * R::splat(arsenal.inherit),
        age: zero,
        phase: R::Int::splat(FLYING),
        clock: R::Int::splat(-arsenal.tick_ms),
        axis: aim,
    };
    let mut fired = R::Mask::splat(false);
    for slot in &mut arms.slots {
        let put = wanted.and(slot.flying().not());
        *slot = Projectile::select(put, &shot, slot);
        fired = fired.or(put);
        wanted = wanted.and(put.not());
    }
    arms.cooldown = R::Int::select(fired, R::Int::splat(arsenal.cycle), arms.cooldown);
    arms.ammo = R::Int::select(fired, arms.ammo - one, arms.ammo);
}
