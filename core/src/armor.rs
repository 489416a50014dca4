//! The armors: one table of constants (docs/physics.md, section 2).

/// The constants of one armor, in metres, seconds and mass units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Armor {
    /// The public name.
    pub name: &'static str,
    /// Mass.
    pub mass: f64,
    /// Ground force; over `mass` it is the largest ground acceleration.
    pub ground_force: f64,
    /// Ground traction k.
    pub traction: f64,
    /// Walk speed forward and, in the article's model, backward, m/s. Sideways it is 1 m/s less.
    pub walk_speed: f64,
    /// Jump impulse J.
    pub jump_impulse: f64,
    /// Jet force.
    pub jet_force: f64,
    /// Largest share of the thrust that acts sideways.
    pub max_sideways: f64,
    /// Speed along the pressed direction at which sideways thrust has faded out, m/s.
    pub fade_speed: f64,
    /// Energy tank.
    pub max_energy: f64,
    /// Energy the jets use, per second.
    pub jet_drain: f64,
    /// Damage that kills.
    pub max_damage: f64,
    /// Damage per m/s of landing speed beyond [`LANDING_FREE_SPEED`].
    pub landing_scale: f64,
    /// Half of the width and of the depth of the box, m. The box stands on the origin.
    pub half_width: f64,
    /// Height of the box, m. Half of it is the radius of the collision sphere, whose centre is that
    /// far above the feet.
    pub height: f64,
    /// Factor of the damage by explosions.
    pub explosion_scale: f64,
    /// Factor of the damage by shrapnel: grenades.
    pub shrapnel_scale: f64,
    /// Factor of the damage by mortar shells.
    pub mortar_scale: f64,
}

/// Light armor.
pub const LIGHT: Armor = Armor {
    name: "light",
    mass: 9.0,
    ground_force: 360.0,
    traction: 3.0,
    walk_speed: 11.0,
    jump_impulse: 75.0,
    jet_force: 236.0,
    max_sideways: 0.8,
    fade_speed: 22.0,
    max_energy: 60.0,
    jet_drain: 25.0,
    max_damage: 0.66,
    landing_scale: 0.005,
    half_width: 0.5,
    height: 2.3,
    explosion_scale: 1.0,
    shrapnel_scale: 1.2,
    mortar_scale: 1.3,
};

/// Medium armor.
pub const MEDIUM: Armor = Armor {
    name: "medium",
    mass: 13.0,
    ground_force: 455.0,
    traction: 3.0,
    walk_speed: 8.0,
    jump_impulse: 110.0,
    jet_force: 320.0,
    max_sideways: 0.8,
    fade_speed: 17.0,
    max_energy: 80.0,
    jet_drain: 31.25,
    max_damage: 1.0,
    landing_scale: 0.005,
    half_width: 0.7,
    height: 2.4,
    explosion_scale: 1.0,
    shrapnel_scale: 1.0,
    mortar_scale: 1.0,
};

/// Heavy armor.
pub const HEAVY: Armor = Armor {
    name: "heavy",
    mass: 18.0,
    ground_force: 630.0,
    traction: 4.5,
    walk_speed: 5.0,
    jump_impulse: 150.0,
    jet_force: 385.0,
    max_sideways: 0.8,
    fade_speed: 12.0,
    max_energy: 110.0,
    jet_drain: 34.375,
    max_damage: 1.32,
    landing_scale: 0.006,
    half_width: 0.8,
    height: 2.6,
    explosion_scale: 0.6,
    shrapnel_scale: 0.8,
    mortar_scale: 0.7,
};

/// Every armor, by its public name.
pub const ARMORS: [&Armor; 3] = [&LIGHT, &MEDIUM, &HEAVY];

/// Gravity along z, m/s^2: what the missions set.
pub const GRAVITY: f64 = -20.0;
/// Energy gained per second.
pub const RECHARGE: f64 = 8.0;
/// Energy per second that an energy pack adds.
pub const PACK_RECHARGE: f64 = 3.0;
/// Jets that burn go out at this energy or below it.
pub const JET_CUTOFF: f64 = 1.0;
/// Jets that are out light again from this energy on.
pub const JET_REIGNITE: f64 = 5.0;
/// Age of a jumpable contact, in milliseconds, from which it allows no jump.
pub const JUMP_GRACE_MS: i32 = 256;
/// `engine`: the same in ticks, at any tick length.
pub const ENGINE_JUMP_GRACE: i32 = 8;
/// `engine`: age of a fresh player's contact memory, ticks.
pub const ENGINE_FRESH_AGE: i32 = 100;
/// Smallest n.up of a surface that can be jumped from (78.5 degrees).
pub const JUMPABLE_UP: f64 = 0.2;
/// Outward speed that every contact adds, m/s.
pub const OUTWARD_PUSH: f64 = 0.001;
/// `engine`: the same.
pub const ENGINE_OUTWARD_PUSH: f64 = 0.0001;
/// Below this speed a player crawls, m/s.
pub const CRAWL_SPEED: f64 = 0.1;
/// A crawling player below this speed stops on an upward surface, m/s; in `engine` below n.up times it.
pub const STOP_SPEED: f64 = 0.75;
/// What remains of the friction memory from tick to tick while something is touched.
pub const FRICTION_MEMORY: f64 = 0.6;
/// `engine`: a memory below this is dropped.
pub const ENGINE_LEAST_MEMORY: f64 = 0.1;
/// Landing speed that costs nothing, m/s.
pub const LANDING_FREE_SPEED: f64 = 25.0;
/// Longest slice of a sliced move, m.
pub const SLICE: f64 = 1.0;
/// Contacts after which a tick's movement ends.
pub const MAX_BUMPS: i32 = 4;
/// Slices after which a move is swept in one piece instead.
pub const MAX_SLICES: i32 = 65_536;
/// `engine`: longest sub-step of a tick's first attempt, m.
pub const ENGINE_STEP: f64 = 0.3;
/// `engine`: longest sub-step after a contact, m.
pub const ENGINE_FINE_STEP: f64 = 0.075;
/// `engine`: attempts after which a tick's movement ends.
pub const ENGINE_ATTEMPTS: i32 = 3;
/// `engine`: largest n.up of a face that is tried to step over.
pub const ENGINE_STEP_UP: f64 = 0.707;
