//! Many players: threads, snapshots, digests, and the two batches users step.

mod codec;
mod environment;
mod pool;
mod raw_input;
mod simulator;
mod snapshot;

pub use environment::{Autoreset, Environments, ResetRequest, SkiEnvironments, Status, StepOutput};
pub use pool::{INLINE_BELOW, MAX_THREADS};
pub use raw_input::RawInput;
pub use simulator::{Bodies, MAX_PLAYERS, MAX_SPEED, SimulatorSetup};
