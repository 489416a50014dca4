//! Bilinear ground: heights and slopes from the definition, sweeps and lines from a witness that samples and
//! bisects, and what players do on it.
#![allow(missing_docs)]

#[path = "../common/mod.rs"]
mod common;
mod ground;
mod players;
mod sweeps;
mod witness;
mod worlds;
