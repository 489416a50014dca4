//! What the batch of ski episodes promises, whatever its tier.

use crate::error::InputError;
use crate::observe::LayoutField;
use crate::player::Field;
use crate::task::{ActionKind, Actions, CourseRequest, Outcome};

/// When an environment whose episode ended begins the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// In the step after the one that ended it, whose action is ignored.
    NextStep,
    /// In the step that ended it, which returns the next episode's first observation.
    SameStep,
    /// When the user resets it; until then it stays as it ended.
    Disabled,
}

/// Where an environment is in its life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LifeStage {
    /// It was never reset.
    Fresh,
    /// An episode is under way.
    Running,
    /// Its episode is over, and the next one has not begun.
    Over,
}

/// What a reset asks for. Every list is empty (nothing asked) or has one entry per environment.
#[derive(Clone, Debug, Default)]
pub struct ResetRequest {
    /// New seeds; without them each environment goes on to its next episode.
    pub seeds: Vec<u64>,
    /// Which environments to reset; all where empty.
    pub mask: Vec<bool>,
    /// Fixed parts of the episodes; drawn where empty.
    pub courses: Vec<CourseRequest>,
    /// Whether the rows of environments outside the mask hold their observations already and stay as
    /// they are.
    pub others_observed: bool,
}

/// Where a step writes: one entry (or row) per environment.
#[derive(Debug)]
pub struct StepOutput<'a> {
    /// Observations, row by row.
    pub observations: &'a mut [f32],
    /// Rewards.
    pub rewards: Rewards<'a>,
    /// Whether the episode ended by arrival or death.
    pub terminated: &'a mut [bool],
    /// Whether the episode ended by the clock.
    pub truncated: &'a mut [bool],
    /// What every step says of every environment, where that is wanted.
    pub status: Option<StatusOutput<'a>>,
}

/// Rewards in the precision that is asked for.
#[derive(Debug)]
pub enum Rewards<'a> {
    /// As they are.
    F64(&'a mut [f64]),
    /// Rounded to nearest.
    F32(&'a mut [f32]),
}

/// Columns of [`Status`] after the step: of the next episode where one began in it.
#[derive(Debug)]
pub struct StatusOutput<'a> {
    /// See [`Status::distance`].
    pub distance: &'a mut [f64],
    /// See [`Status::speed`].
    pub speed: &'a mut [f64],
    /// See [`Status::time`].
    pub time: &'a mut [f64],
    /// See [`Status::outside`].
    pub outside: &'a mut [bool],
}

/// What is reported of an environment at any time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// Horizontal distance to the beacon, m.
    pub distance: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// Seconds played.
    pub time: f64,
    /// Whether the player is outside the mission area.
    pub outside: bool,
    /// Which map of the pool.
    pub terrain: usize,
}
/// What every batch of environments can do, whatever its tier.
pub trait Environments: Send + Sync {
    /// How many environments.
    fn len(&self) -> usize;
    /// Whether there is none: never.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// How many environments are stepped side by side, in one instruction: 1, 8 or 16. No bit depends on
    /// it.
    fn lanes(&self) -> usize;
    /// Whether every environment was reset at least once, as a step demands.
    fn ready(&self) -> bool;
    /// Begins, or ends, to measure where the time of a step goes; see [`Environments::parts`].
    fn time_parts(&mut self, on: bool);
    /// Seconds spent in each part of all steps since [`Environments::time_parts`] was switched on, summed
    /// over threads: "input" (actions to keys), "physics", "task" (reward, ends, resets), "observation"
    /// and "output" (flags, status). Empty while it is off. Looking at the clock costs some 10% itself.
    fn parts(&self) -> Vec<(&'static str, f64)>;
    /// Numbers in an observation.
    fn observation_size(&self) -> usize;
    /// The layout of an observation.
    fn layout(&self) -> Vec<LayoutField>;
    /// Choices of each number of a discrete action; as many numbers has any action.
    fn action_bins(&self) -> &'static [i64];
    /// The kind of action that [`Environments::step`] takes.
    fn action_kind(&self) -> ActionKind;
    /// Begins episodes, and writes the observations of all environments, or, where the request says that
    /// the others are observed, of those that it resets.
    ///
    /// # Errors
    /// If the request is malformed; then nothing was changed.
    fn reset(&mut self, request: &ResetRequest, observations: &mut [f32]) -> Result<(), InputError> {
        self.reset_while(request, observations, &mut || true)
    }
    /// The same, as long as `go_on`, asked on the caller's thread every few hundred environments, says so.
    ///
    /// # Errors
    /// As [`Environments::reset`]; and if it was stopped: episodes have begun then, or not.
    fn reset_while(
        &mut self,
        request: &ResetRequest,
        observations: &mut [f32],
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), InputError>;
    /// One decision of every environment.
    ///
    /// # Errors
    /// If actions or outputs are malformed, or an environment was never reset; then nothing was changed.
    fn step(&mut self, actions: Actions<'_>, output: StepOutput<'_>) -> Result<(), InputError> {
        self.step_while(actions, output, &mut || true)
    }
    /// The same, as long as `go_on`, asked on the caller's thread every few hundred environments, says so.
    ///
    /// # Errors
    /// As [`Environments::step`]; and if it was stopped half-way: then only a snapshot leads back.
    fn step_while(
        &mut self,
        actions: Actions<'_>,
        output: StepOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), InputError>;
    /// Whether no step ended half-way, so that there is something to read.
    ///
    /// # Errors
    /// If one did.
    fn whole(&self) -> Result<(), InputError>;
    /// Makes the next step panic half-way, as a defect would: for tests of what comes after.
    fn fail_next_step(&mut self);
    /// Which environments' episodes ended in the last step, and how, in ascending order.
    fn finished(&self) -> &[(usize, Outcome)];
    /// Their last observations, row by row.
    fn final_observations(&self) -> &[f32];
    /// Status of every environment.
    fn status(&self) -> Vec<Status>;
    /// Status of one environment.
    ///
    /// # Panics
    /// If there is no such environment.
    fn status_of(&self, index: usize) -> Status;
    /// Seed and number of every environment's episode, which together name it; (0, 0) before its first reset.
    fn episodes(&self) -> Vec<(u64, u64)>;
    /// World position of every beacon, m.
    fn goals(&self) -> Vec<[f64; 3]>;
    /// The fields of a player's state after `position` (three f64), packed.
    fn state_fields(&self) -> Vec<Field>;
    /// All players' states, packed.
    fn state(&self) -> Vec<u8>;
    /// Bytes that one environment takes in memory, beside its observation row.
    fn bytes_per_environment(&self) -> usize;
    /// Where an environment is in its life.
    ///
    /// # Panics
    /// If there is no such environment.
    fn stage_of(&self, env: usize) -> LifeStage;
    /// Everything, as bytes that [`Environments::restore`] takes.
    fn snapshot(&self) -> Vec<u8>;
    /// Goes back to a snapshot of this batch or of another one of the same arguments. Autoreset modes may differ.
    ///
    /// # Errors
    /// If it is damaged, or of another layout or count; then nothing was changed.
    fn restore(&mut self, snapshot: &[u8]) -> Result<(), InputError>;
    /// Everything of one environment, as bytes that [`Environments::restore_one`] takes.
    ///
    /// # Errors
    /// If there is no such environment.
    fn snapshot_one(&self, env: usize) -> Result<Vec<u8>, InputError>;
    /// Puts one environment to where it, or another one of a batch of the same arguments, was.
    ///
    /// # Errors
    /// As [`Environments::restore`], and if there is no such environment; then nothing was changed.
    fn restore_one(&mut self, env: usize, snapshot: &[u8]) -> Result<(), InputError>;
    /// XXH3-128 of all environments, as 32 hexadecimal digits.
    fn digest(&self) -> String;
}
