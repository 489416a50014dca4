//! Many players: threads, snapshots, digests, and the two batches users step.

mod alone;
mod codec;
mod crowd;
#[cfg(feature = "ski")]
mod environment;
mod legal;
mod neighbourhood;
mod pool;
mod raw_input;
mod simulator;
mod snapshot;
mod stage;

#[cfg(feature = "ski")]
pub use environment::{
    Autoreset, Environments, EnvironmentsSetup, LifeStage, ResetRequest, Rewards, Status, StatusOutput,
    StepOutput,
};
pub use neighbourhood::Contact;
pub use pool::{INLINE_BELOW, MAX_THREADS};
pub use raw_input::RawInput;
pub use simulator::{
    Bodies, FARTHEST_SOLID_F32, MAX_PLAYERS, MAX_PLAYERS_PER_WORLD, MAX_SPEED, Shot, SimulatorSetup,
};
