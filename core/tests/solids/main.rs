//! Solids: what is refused, files, sliding and resting, starts inside, stepping up, rays, the broad phase, the mission.

#[path = "../common/mod.rs"]
mod common;
mod files;
mod inside;
mod mission;
mod near;
mod rays;
mod refused;
mod sliding;
mod steps;
