//! What players from outside must be, so that the physics can go on from them. A refusal begins with the field;
//! whose it is the caller says, and only then: most are fine, and a tree search restores millions.

use crate::arms::{Arms, BURST, FLYING, FREE, Projectile};
use crate::error::{InputError, refuse};
use crate::player::{MOST_BUMP_LIMITS, OLDEST_MS, Player};
use crate::real::{Scalar, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::terrain::{Edge, Maps};

/// Most ticks of a cooldown or of a flight, and shots of a launcher.
const MAX_COUNT: i32 = 1_000_000;
/// Farthest local coordinate where a map does not tile, m.
const FARTHEST: f64 = 2e9;
/// Farthest tile: beyond those that a position can be put on by as many as a game can add.
const FARTHEST_TILE: i32 = 1_500_000_000;
/// Farthest that the clock of an engine disc may be off, ms: a tick and its own.
const MAX_CLOCK: u32 = 2_000;
/// Fastest projectile, m/s.
const FASTEST_SHOT: f64 = 1e5;

/// How fast players may be, m/s.
#[derive(Clone, Copy)]
pub(super) struct Fastest {
    /// Along each horizontal axis.
    pub(super) across: f64,
    /// Up or down.
    pub(super) down: f64,
}

/// What the game can bring about: who falls beside a map does so for ever.
pub(super) const PLAYED: Fastest = Fastest { across: 1e7, down: 1e9 };

/// Refuses a player whose numbers the physics could not go on from.
pub(super) fn check_player<S: Scene, T: Scalar>(
    p: &Player<S, T>,
    rules: &Rules<T>,
    fastest: Fastest,
) -> Result<(), InputError> {
    let v = [p.velocity.x, p.velocity.y, p.velocity.z];
    let limits = [fastest.across, fastest.across, fastest.down];
    if v.iter().zip(limits).any(|(x, most)| !x.finite() || x.to_f64().abs() > most) {
        refuse!("velocity: expected finite numbers within +-{} m/s, got {v:?}", fastest.across);
    }
    for (name, angle) in [("yaw", p.yaw), ("pitch", p.pitch)] {
        if !angle.finite() || angle.to_f64().abs() > 1e6 {
            refuse!("{name}: expected a finite angle within +-1e6 rad, got {angle:?}");
        }
    }
    let range = |name: &str, x: T, low: f64, high: f64| {
        if x.finite() && (low..=high).contains(&x.to_f64()) {
            return Ok(());
        }
        Err(InputError(format!("{name}: expected {low} to {high}, got {x:?}")))
    };
    range("friction", p.friction, 0.0, 1.0)?;
    range("energy", p.energy.get(T::zero()), 0.0, rules.max_energy.to_f64())?;
    range("damage", p.damage.get(T::zero()), 0.0, 1e9)?;
    let contact = p.contact();
    if !(0..=OLDEST_MS).contains(&contact.age) {
        refuse!("jump_age: expected 0 to {OLDEST_MS} ms, got {}", contact.age);
    }
    let limits = p.bump_limits.get(0);
    if !(0..=MOST_BUMP_LIMITS).contains(&limits) {
        refuse!("bump_limits: expected 0 to {MOST_BUMP_LIMITS}, got {limits}");
    }
    if !is_unit(contact.normal) {
        refuse!("jump_normal: expected length 1, got {:?}", contact.normal);
    }
    Ok(())
}

/// Refuses a launcher that could not go on either.
pub(super) fn check_launcher<T: Scalar>(arms: &Arms<T>) -> Result<(), InputError> {
    for (name, value) in [("cooldown", arms.cooldown), ("ammo", arms.ammo)] {
        if !(0..=MAX_COUNT).contains(&value) {
            refuse!("{name}: expected 0 to {MAX_COUNT}, got {value}");
        }
    }
    Ok(())
}

/// Refuses a player of a snapshot who cannot have been played: also his place and his map, which a state
/// does not name.
pub(super) fn check_played<S: Scene, T: Scalar>(
    p: &Player<S, T>,
    maps: &Maps,
    rules: &Rules<T>,
) -> Result<(), InputError> {
    check_player(p, rules, PLAYED)?;
    check_place(maps, p.position, [p.tile_x, p.tile_y], 0.0)?;
    let (map, count) = (p.map, maps.count());
    if map < 0 || maps.index(map) >= count || maps.offset(maps.index(map)) != map {
        refuse!("map: expected where one of {count} maps starts, got {map}");
    }
    Ok(())
}

/// Refuses a place that is none, or that no map reaches, unless by up to `beyond` metres: a projectile bursts
/// wherever its last tick took it.
pub(super) fn check_place<T: Scalar>(
    maps: &Maps,
    local: V3<T>,
    tile: [i32; 2],
    beyond: f64,
) -> Result<(), InputError> {
    let size = maps.size();
    // A position is put back into its tile after each tick; a hair beyond the rim is its rounding.
    let most =
        |side: f64| if maps.grid().edge == Edge::Tile { 0.5 * side * 1.001 + beyond } else { FARTHEST };
    let within = |x: T, most: f64| x.finite() && x.to_f64().abs() <= most;
    if !(within(local.x, most(size.x)) && within(local.y, most(size.y)) && local.z.finite()) {
        refuse!("position: expected finite coordinates on its tile, got {local:?}");
    }
    if tile.iter().any(|t| t.unsigned_abs() > FARTHEST_TILE.unsigned_abs()) {
        refuse!("tile: expected within +-{FARTHEST_TILE}, got {tile:?}");
    }
    Ok(())
}

/// Refuses projectiles of a snapshot that cannot fly on.
pub(super) fn check_shots<T: Scalar>(arms: &Arms<T>, maps: &Maps) -> Result<(), InputError> {
    check_launcher(arms)?;
    for (k, shot) in arms.slots.iter().enumerate() {
        check_shot(shot, maps).map_err(|e| e.of(format_args!("projectile {k}")))?;
    }
    Ok(())
}

fn check_shot<T: Scalar>(shot: &Projectile<T>, maps: &Maps) -> Result<(), InputError> {
    if ![FREE, FLYING, BURST].contains(&shot.phase) {
        refuse!("phase: expected {FREE}, {FLYING} or {BURST}, got {}", shot.phase);
    }
    check_place(maps, shot.position, [shot.tile_x, shot.tile_y], FASTEST_SHOT)?;
    let v = shot.velocity;
    if [v.x, v.y, v.z].iter().any(|x| !x.finite() || x.to_f64().abs() > FASTEST_SHOT) {
        refuse!("velocity: expected finite numbers within +-{FASTEST_SHOT} m/s, got {v:?}");
    }
    if shot.phase != FREE && !is_unit(shot.axis) {
        refuse!("axis: expected length 1, got {:?}", shot.axis);
    }
    if !(0..=MAX_COUNT).contains(&shot.age) || shot.clock.unsigned_abs() > MAX_CLOCK {
        refuse!("age: expected 0 to {MAX_COUNT} ticks, got {}, or a clock of {} ms", shot.age, shot.clock);
    }
    Ok(())
}

fn is_unit<T: Scalar>(v: V3<T>) -> bool {
    let length = v.length();
    length.finite() && (length.to_f64() - 1.0).abs() <= 1e-3
}
