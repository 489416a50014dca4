//! Tasks with goals in the air and with flags, and levels of difficulty: against closed forms, and against what a
//! witness in f64 makes of the players' positions.
#![allow(missing_docs)]

#[path = "../common/mod.rs"]
mod common;

mod flags;
mod levels;
mod markers;
