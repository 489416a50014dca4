//! The constants of docs/physics.md, section 2: one table of the armors, one of what they share, each
//! with its source in that page's letters (ART the article, PORT its transcription, SNAP the tree of
//! 1998).
//!
//! Not here, since nothing models it: the masses of inventory and ammunition packs, crouching (a box of
//! 1.8 m), the factor of mines, surface materials (the article has none, and `engine` takes the default, 1).

/// Turns rows of the table into [`Armor`] and its three values.
macro_rules! armors {
    ($($(#[$doc:meta])* $field:ident: $light:literal, $medium:literal, $heavy:literal;)*) => {
        /// The constants of one armor, in metres, seconds and mass units.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Armor {
            /// The public name.
            pub name: &'static str,
            $($(#[$doc])* pub $field: f64,)*
        }

        /// Light armor.
        pub const LIGHT: Armor = Armor { name: "light", $($field: $light,)* };
        /// Medium armor.
        pub const MEDIUM: Armor = Armor { name: "medium", $($field: $medium,)* };
        /// Heavy armor.
        pub const HEAVY: Armor = Armor { name: "heavy", $($field: $heavy,)* };
    };
}

// Columns: light, medium, heavy.
armors! {
    /// Mass. SNAP, PORT.
    mass: 9.0, 13.0, 18.0;
    /// Ground force; over `mass` it is the largest ground acceleration (40, 35, 35 m/s^2). SNAP.
    ground_force: 360.0, 455.0, 630.0;
    /// Ground traction k. SNAP.
    traction: 3.0, 3.0, 4.5;
    /// Walk speed forward and, in the article's model, backward, m/s. Sideways it is 1 m/s less, and in
    /// `engine` backward as well. SNAP, ART.
    walk_speed: 11.0, 8.0, 5.0;
    /// Jump impulse J. SNAP, PORT.
    jump_impulse: 75.0, 110.0, 150.0;
    /// Jet force. SNAP.
    jet_force: 236.0, 320.0, 385.0;
    /// Largest share of the thrust that acts sideways. SNAP.
    max_sideways: 0.8, 0.8, 0.8;
    /// Speed along the pressed direction at which sideways thrust has faded out, m/s. SNAP.
    fade_speed: 22.0, 17.0, 12.0;
    /// Energy tank. SNAP.
    max_energy: 60.0, 80.0, 110.0;
    /// Energy the jets use, per second. ART; SNAP has the same per tick (0.8, 1.0, 1.1).
    jet_drain: 25.0, 31.25, 34.375;
    /// Damage that kills. SNAP.
    max_damage: 0.66, 1.0, 1.32;
    /// Damage per m/s of landing speed beyond [`LANDING_FREE_SPEED`]. SNAP.
    landing_scale: 0.005, 0.005, 0.006;
    /// Half of the width and of the depth of the box, m. The box stands on the origin; twice this is
    /// the smallest side, which knockback asks for. ART, SNAP.
    half_width: 0.5, 0.7, 0.8;
    /// Height of the box, m. Half of it is the radius of the collision sphere, whose centre is that
    /// far above the feet. ART, SNAP.
    height: 2.3, 2.4, 2.6;
    /// Factor of the damage by explosions: discs. SNAP.
    explosion_scale: 1.0, 1.0, 0.6;
    /// Factor of the damage by shrapnel: grenades. SNAP.
    shrapnel_scale: 1.2, 1.0, 0.8;
    /// Factor of the damage by mortar shells. SNAP.
    mortar_scale: 1.3, 1.0, 0.7;
}

/// Every armor, by its public name.
pub const ARMORS: [&Armor; 3] = [&LIGHT, &MEDIUM, &HEAVY];

/// Gravity along z, m/s^2: what the missions set. SNAP.
pub const GRAVITY: f64 = -20.0;
/// Energy gained per second. SNAP.
pub const RECHARGE: f64 = 8.0;
/// Energy per second that an energy pack adds. SNAP, PORT.
pub const PACK_RECHARGE: f64 = 3.0;
/// Jets that burn go out at this energy or below it. SNAP.
pub const JET_CUTOFF: f64 = 1.0;
/// Jets that are out light again from this energy on. SNAP.
pub const JET_REIGNITE: f64 = 5.0;
/// Age of a jumpable contact, in milliseconds, from which it allows no jump. ART, PORT.
pub const JUMP_GRACE_MS: i32 = 256;
/// `engine`: the same in ticks, at any tick length. SNAP.
pub const ENGINE_JUMP_GRACE: i32 = 8;
/// `engine`: age of a fresh player's contact memory, ticks. section 3.1.
pub const ENGINE_FRESH_AGE: i32 = 100;
/// Smallest n.up of a surface that can be jumped from (78.5 degrees). ART, PORT; SNAP.
pub const JUMPABLE_UP: f64 = 0.2;
/// Outward speed that every contact adds, m/s. ART, PORT.
pub const OUTWARD_PUSH: f64 = 0.001;
/// `engine`: the same. SNAP.
pub const ENGINE_OUTWARD_PUSH: f64 = 0.0001;
/// Below this speed a player crawls, m/s. ART; SNAP.
pub const CRAWL_SPEED: f64 = 0.1;
/// A crawling player below this speed stops on an upward surface, m/s; in `engine` below n.up times it.
/// ART; SNAP.
pub const STOP_SPEED: f64 = 0.75;
/// What remains of the friction memory from tick to tick while something is touched. ART; SNAP.
pub const FRICTION_MEMORY: f64 = 0.6;
/// `engine`: a memory below this is dropped. SNAP.
pub const ENGINE_LEAST_MEMORY: f64 = 0.1;
/// Landing speed that costs nothing, m/s. SNAP.
pub const LANDING_FREE_SPEED: f64 = 25.0;
/// Longest slice of a sliced move, m. ART.
pub const SLICE: f64 = 1.0;
/// Contacts after which a tick's movement ends. ART.
pub const MAX_BUMPS: i32 = 4;
/// Slices after which a move is swept in one piece instead. ours (section 12).
pub const MAX_SLICES: i32 = 65_536;
/// `engine`: longest sub-step of a tick's first attempt, m. SNAP.
pub const ENGINE_STEP: f64 = 0.3;
/// `engine`: longest sub-step after a contact, m. SNAP.
pub const ENGINE_FINE_STEP: f64 = 0.075;
/// `engine`: attempts after which a tick's movement ends. SNAP.
pub const ENGINE_ATTEMPTS: i32 = 3;
/// `engine`: largest n.up of a face that is tried to step over. SNAP (section 5.3).
pub const ENGINE_STEP_UP: f64 = 0.707;
