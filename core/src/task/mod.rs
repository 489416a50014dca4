//! Tasks: what an episode is. One player at a time, or as many as a number has lanes.

mod action;
mod courses;
mod run;

pub use action::{ACTION_BINS, ACTION_SIZE, ActionKind, Actions};
pub use courses::{Course, CourseRequest, draw_course};
pub(crate) use run::seconds;
pub use run::{Outcome, Reward, Run, SkiTask, Verdict};
