//! Bad input is refused by name, with what was expected and what came, and nothing is changed.

#[path = "../common/mod.rs"]
mod common;
mod environments;
mod simulators;
mod terrains;

use discjump_core::error::InputError;

const NAN: f64 = f64::NAN;
const INF: f64 = f64::INFINITY;

/// The message must begin with the argument and hold what came.
#[track_caller]
fn refused<T>(result: Result<T, InputError>, argument: &str, got: &str) {
    let Err(error) = result else { panic!("{argument}: {got} was accepted") };
    let message = error.to_string();
    assert!(message.starts_with(argument), "{message:?} does not begin with {argument:?}");
    assert!(message.contains("expected"), "{message:?} does not say what was expected");
    assert!(message.contains(got), "{message:?} does not say {got:?}");
}
