//! The movement of Tribes 1 (skiing, jetting, disc jumping) as a batched simulator.
//!
//! Nothing here knows of Python, and nothing but loading touches a file. Dependencies point
//! down only; a lower room that used an upper one could no longer be tested, or vectorised, alone:
//!
//! ```text
//! batch                     many players, threads, episodes, snapshots
//!   task, observe           what an episode is, and what an agent sees
//!     tick                  one player, one tick: a pure function
//!       movement, forces    how he moves, and what pushes him
//!       flight, blast       how he fires, how projectiles fly, what their explosions do
//!         terrain, solids   heights, normals, sweeps; generated maps and their statistics; bases, bridges, towers
//!           player, scene   his state, and which parts of it a scene models
//!           arms            his launcher and its projectiles: constants and state
//!             armor, rules  constants
//!             real          the number type: f64, f32, and lanes of f32
//! random                    counted draws, used by terrain, task and batch
//! float_environment         rounding as the language has it, whatever the caller's thread was set to
//! ```
//!
//! Cargo features, all on by default: one for each public scene, and one for each thing that a scene can
//! model ([`scene::FEATURES`] but `flags`, which no scene has yet). Without one of the latter its code is not
//! compiled, and a [`scene::Scene`] that models it does not compile either.

// What serves only a feature that is left out is idle then.
#![cfg_attr(
    not(all(feature = "ski", feature = "sandbox", feature = "disc_jump", feature = "mission")),
    allow(dead_code, unused_imports, unused_macros, unused_mut, unused_variables, clippy::needless_return)
)]

pub mod armor;
pub mod arms;
pub mod batch;
pub mod blast;
pub mod error;
#[cfg(feature = "discs")]
pub mod flight;
mod float_environment;
pub mod forces;
pub mod input;
pub mod movement;
pub mod observe;
pub mod player;
pub mod random;
pub mod real;
pub mod rules;
pub mod scene;
#[cfg(feature = "solids")]
pub mod solids;
#[cfg(not(feature = "solids"))]
#[path = "no_solids.rs"]
pub mod solids;
pub mod task;
pub mod terrain;
pub mod tick;
