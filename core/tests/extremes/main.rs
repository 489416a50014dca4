//! The numerical extremes of docs/physics.md, section 11, one by one: what must happen, in every tier.
//!
//! `eNN` in a test's name is the number of the item. A form of the movement runs in f32 and in f64 (`reference`
//! and `authentic` are one form); where the tests of another file prove an item, or a part of it, in all tiers
//! already, it is listed and not repeated.
//!
//! ```text
//!  1 nothing to move              moves, speeds
//!  2 a hair over whole slices     moves
//!  3 starts on and under ground   moves; swept: a_contact_at_once_pushes_out, a_player_below_the_ground_is_pushed_out_again
//!  4 parallel, leaving            moves, walls; contacts: a_path_that_only_just_reaches_the_ground_does_not_meet_it
//!  5 huge speeds                  speeds; standing: a_plate_of_a_millimetre_stops_everyone_at_any_speed,
//!                                 worlds: nobody_passes_through_anybody_at_any_speed
//!  6 ages are integers            ticks; closed_forms: a_contact_allows_a_jump_in_the_next_8_ticks_or_7
//!  7 valleys and pits             pits; creases: all of it
//!  8 walls and overhangs          walls; thresholds: walls_cannot_be_jumped_from
//!  9 two contacts in a row        keys; thresholds: the_steeper_of_two_contacts_is_remembered,
//!                                 engine: the_flatter_of_two_contacts_is_remembered
//! 10 edges of the jump window     keys; closed_forms: a_jump_turns_the_jets_sideways_at_once_or_a_tick_later
//! 11 energy                       keys; closed_forms: holding_jets_on_an_empty_tank_burns_8_ticks_of_25,
//!                                 thresholds: a_released_key_puts_the_jets_out
//! 12 sideways thrust              keys; closed_forms: sideways_thrust_fades_with_the_speed_along_the_pressed_direction
//! 13 friction's cap               keys; contacts: friction_remembers_contacts_and_forgets_in_the_air
//! 14 the stop rule                walls; contacts: a_crawler_stops_where_his_slices_began
//! 15 landings                     walls; creases: every_bump_costs
//! 16 explosions                   shots, in every tier; blasts (beside this directory): all of it
//! 17 lines of the grid            places; terrain_witness: all of it
//! 18 tick lengths                 ticks; flight_properties: slots_suffice_at_every_tick_length
//! 19 discs                        shots; discs, flight_properties: all of them
//! 20 numbers that are none        inputs; bad_input: all of it
//! 21 outside the map              places; far_places: all of it, in every tier
//! ```
#![allow(missing_docs)]

#[path = "../common/mod.rs"]
mod common;

/// Runs a check, generic over form and arithmetic, in the forms named and in f32 and f64.
macro_rules! in_forms {
    ($check:ident, $($form:ident),+) => {
        $($check::<discjump_core::movement::$form, f32>(); $check::<discjump_core::movement::$form, f64>();)+
    };
}

/// The same in every form there is.
macro_rules! in_every_form {
    ($check:ident) => {
        in_forms!($check, Sliced, Swept, Fast, Anyway, Engine)
    };
}

mod inputs;
mod keys;
mod moves;
mod pits;
mod places;
mod shots;
mod speeds;
mod ticks;
mod walls;

use common::lab::Lab;
use discjump_core::armor::LIGHT;
use discjump_core::movement::Movement;
use discjump_core::real::Scalar;
use discjump_core::rules::{Model, Physics, Rules};
use discjump_core::terrain::Heightfield;

/// What a failure calls the form and its arithmetic.
fn form<M: Movement, T: Scalar>() -> String {
    format!("{} in {}", core::any::type_name::<M>(), core::any::type_name::<T>())
}

/// The physics of a form on a terrain, at a tick length.
fn lab<M: Movement, T: Scalar>(terrain: &Heightfield, tick_ms: u32) -> Lab<T> {
    let mut lab = Lab::of(M::MODEL, terrain, Physics::default());
    lab.rules = Rules::new(M::MODEL, &LIGHT, false, tick_ms, Physics::default());
    lab
}

/// A number of the article's model, or of the engine's.
fn by_model<M: Movement>(article: f64, engine: f64) -> f64 {
    if M::MODEL == Model::Engine { engine } else { article }
}

/// A number in f64, or in f32.
fn digits<T: Scalar>(double: f64, single: f64) -> f64 {
    if T::DOUBLE { double } else { single }
}

/// The next number up, or down, of the arithmetic.
fn next<T: Scalar>(x: f64, up: bool) -> f64 {
    match (T::DOUBLE, up) {
        (true, true) => x.next_up(),
        (true, false) => x.next_down(),
        (false, true) => f64::from((x as f32).next_up()),
        (false, false) => f64::from((x as f32).next_down()),
    }
}
