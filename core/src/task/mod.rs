//! Tasks: what an episode is. One player at a time, or as many as a number has lanes.
//!
//! * `rules`: what is uniform over a batch: limits, weights of the reward, levels of difficulty
//! * `kind`: the kinds of goal
//! * `courses`: where an episode starts and where its goal is
//! * `run`: what is tested every tick
//! * `flag`: the flag of those who carry one
//! * `action`: the keys that actions stand for

mod action;
mod courses;
mod flag;
mod kind;
mod rules;
mod run;

pub use action::{ACTION_BINS, ACTION_SIZE, ARMED_BINS, ARMED_SIZE, ActionKind, Actions, action_bins};
pub use courses::{Course, CourseRequest, Grounds, Pitch, draw_course};
pub use flag::{Flag, MOST_TAKEN, OUTSIDE_MS};
pub use kind::{Beacon, Kind, Marker, Stands};
pub use rules::{Level, Reward, STREAK, TaskRules};
pub use run::{Outcome, Run, Verdict};
pub(crate) use run::{apex, seconds};
