//! Actions of the ski task, and the keys they stand for.

use crate::error::{InputError, refuse};
use crate::input::Input;
use crate::real::Scalar;

/// Numbers per action: forward, strafe, jump, jet, turn.
pub const ACTION_SIZE: usize = 5;
/// Choices of each number of a discrete action.
pub const ACTION_BINS: [i64; ACTION_SIZE] = [3, 3, 2, 2, 7];

/// How actions are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionKind {
    /// Indices into [`ACTION_BINS`]: forward and strafe 0, 1, 2 for -1, 0, +1; turn 0 (right) to 6 (left).
    MultiDiscrete,
    /// Five numbers in [-1, 1]: keys are pressed beyond +-1/3 (forward, strafe) or above 0 (jump, jet);
    /// turn is proportional.
    Box,
}

/// A batch of actions, row by row.
#[derive(Clone, Copy, Debug)]
pub enum Actions<'a> {
    /// For [`ActionKind::MultiDiscrete`].
    Int8(&'a [i8]),
    /// For [`ActionKind::MultiDiscrete`].
    Int32(&'a [i32]),
    /// For [`ActionKind::MultiDiscrete`].
    Int64(&'a [i64]),
    /// For [`ActionKind::Box`].
    Float(&'a [f32]),
}

impl Actions<'_> {
    /// Checks length, kind and range of every action, before anything is stepped.
    ///
    /// # Errors
    /// Names the row and column, the range and the value.
    pub fn check(&self, kind: ActionKind, players: usize) -> Result<(), InputError> {
        let (len, is_float) = match self {
            Self::Int8(a) => (a.len(), false),
            Self::Int32(a) => (a.len(), false),
            Self::Int64(a) => (a.len(), false),
            Self::Float(a) => (a.len(), true),
        };
        match (kind, is_float) {
            (ActionKind::MultiDiscrete, true) => {
                refuse!("actions: expected integers (MultiDiscrete), got floats")
            }
            (ActionKind::Box, false) => refuse!("actions: expected float32 (Box), got integers"),
            _ => {}
        }
        if len != players * ACTION_SIZE {
            refuse!("actions: expected {players} rows of {ACTION_SIZE}, got {len} numbers");
        }
        let bad = match self {
            Self::Int8(a) => find_bad(a),
            Self::Int32(a) => find_bad(a),
            Self::Int64(a) => find_bad(a),
            Self::Float(a) => a
                .iter()
                .position(|x| !(-1.0..=1.0).contains(x))
                .map(|at| (at, format!("expected -1 to 1, got {}", a[at]))),
        };
        if let Some((at, what)) = bad {
            refuse!("actions[{}, {}]: {what}", at / ACTION_SIZE, at % ACTION_SIZE);
        }
        Ok(())
    }

    /// The keys of one player. `turn_rate` is the fastest turn, rad/s.
    #[must_use]
    pub fn input<T: Scalar>(&self, player: usize, turn_rate: T) -> Input<T> {
        let row = player * ACTION_SIZE;
        match self {
            Self::Int8(a) => discrete(&a[row..row + ACTION_SIZE], turn_rate),
            Self::Int32(a) => discrete(&a[row..row + ACTION_SIZE], turn_rate),
            Self::Int64(a) => discrete(&a[row..row + ACTION_SIZE], turn_rate),
            Self::Float(a) => continuous(&a[row..row + ACTION_SIZE], turn_rate),
        }
    }
}

fn find_bad<I: Copy + Into<i64>>(actions: &[I]) -> Option<(usize, String)> {
    for (row, action) in actions.chunks_exact(ACTION_SIZE).enumerate() {
        for (column, (&a, bins)) in action.iter().zip(ACTION_BINS).enumerate() {
            let a: i64 = a.into();
            if !(0..bins).contains(&a) {
                let what = format!("expected 0 to {}, got {a}", bins - 1);
                return Some((row * ACTION_SIZE + column, what));
            }
        }
    }
    None
}

fn discrete<T: Scalar, I: Copy + Into<i64>>(a: &[I], turn_rate: T) -> Input<T> {
    let number = |k: usize| -> i64 { a[k].into() };
    let key = |k: usize| T::from_int((number(k) - 1) as i32);
    Input {
        forward: key(0),
        strafe: key(1),
        jump: number(2) != 0,
        jet: number(3) != 0,
        turn: T::from_int((number(4) - 3) as i32) / T::from_f64(3.0) * turn_rate,
        ..Input::idle()
    }
}

fn continuous<T: Scalar>(a: &[f32], turn_rate: T) -> Input<T> {
    let third = 1.0 / 3.0;
    let key = |x: f32| T::from_int(i32::from(x > third) - i32::from(x < -third));
    Input {
        forward: key(a[0]),
        strafe: key(a[1]),
        jump: a[2] > 0.0,
        jet: a[3] > 0.0,
        turn: T::from_f64(f64::from(a[4])) * turn_rate,
        ..Input::idle()
    }
}
