//! Actions of the ski task, and the keys they stand for.

use crate::error::{InputError, refuse};
use crate::input::Input;
use crate::real::{Int, Real, Scalar};

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

    /// The keys of `players` players from the `first` on, side by side; further lanes press none.
    /// `turn_rate` is the fastest turn, rad/s.
    #[inline(always)]
    #[must_use]
    pub fn input<R: Real>(&self, first: usize, players: usize, turn_rate: R::Scalar) -> Input<R> {
        let rows = first * ACTION_SIZE..(first + players) * ACTION_SIZE;
        match self {
            Self::Int8(a) => discrete(&a[rows], turn_rate),
            Self::Int32(a) => discrete(&a[rows], turn_rate),
            Self::Int64(a) => discrete(&a[rows], turn_rate),
            Self::Float(a) => continuous(&a[rows], turn_rate),
        }
    }
}

/// An index of a discrete action, as wide as it comes.
trait Choice: Copy + Into<i64> {
    /// Whether it lies outside `0..bins`, in the sign of a number.
    fn beyond(self, bins: i64) -> Self;
    /// Both signs in one.
    fn join(self, other: Self) -> Self;
}

macro_rules! choice {
    ($($t:ty),+) => {
        $(impl Choice for $t {
            #[inline(always)]
            fn beyond(self, bins: i64) -> Self {
                self | (bins as $t - 1).wrapping_sub(self)
            }
            #[inline(always)]
            fn join(self, other: Self) -> Self {
                self | other
            }
        })+
    };
}
choice!(i8, i32, i64);

/// Rows that are looked at before it is asked whether all were good.
const STRETCH: usize = 64;

fn find_bad<I: Choice + Default>(actions: &[I]) -> Option<(usize, String)> {
    for (k, stretch) in actions.chunks(STRETCH * ACTION_SIZE).enumerate() {
        // Only signs are gathered, with no branch, so that the compiler looks at many at a time.
        let mut beyond = [I::default(); ACTION_SIZE];
        for row in stretch.chunks_exact(ACTION_SIZE) {
            for (column, &choice) in row.iter().enumerate() {
                beyond[column] = beyond[column].join(choice.beyond(ACTION_BINS[column]));
            }
        }
        if beyond.iter().all(|&sign| sign.into() >= 0) {
            continue;
        }
        for (at, &choice) in stretch.iter().enumerate() {
            let (choice, bins) = (choice.into(), ACTION_BINS[at % ACTION_SIZE]);
            if !(0..bins).contains(&choice) {
                let at = k * STRETCH * ACTION_SIZE + at;
                return Some((at, format!("expected 0 to {}, got {choice}", bins - 1)));
            }
        }
    }
    None
}

#[inline(always)]
fn discrete<R: Real, I: Copy + Into<i64>>(actions: &[I], turn_rate: R::Scalar) -> Input<R> {
    // No key, for lanes without a player.
    let mut columns = [R::every(1_i32), R::every(1), R::every(0), R::every(0), R::every(3)];
    // Plain loops: adapters of iterators and arrays stay calls here, for each number.
    for lane in 0..actions.len() / ACTION_SIZE {
        for column in 0..ACTION_SIZE {
            // Checked: it is a small number.
            columns[column].as_mut()[lane] = actions[lane * ACTION_SIZE + column].into() as i32;
        }
    }
    let [forward, strafe, jump, jet, turn] = &columns;
    let one = R::Int::splat(1);
    Input {
        forward: R::from_int(R::pack_int(forward) - one),
        strafe: R::from_int(R::pack_int(strafe) - one),
        jump: R::Int::splat(0).lt(R::pack_int(jump)),
        jet: R::Int::splat(0).lt(R::pack_int(jet)),
        turn: R::from_int(R::pack_int(turn) - R::Int::splat(3)) / R::lit(3.0) * R::splat(turn_rate),
        ..Input::idle()
    }
}

#[inline(always)]
fn continuous<R: Real>(actions: &[f32], turn_rate: R::Scalar) -> Input<R> {
    let mut columns = [R::every(R::Scalar::default()); ACTION_SIZE];
    for lane in 0..actions.len() / ACTION_SIZE {
        for column in 0..ACTION_SIZE {
            let number = f64::from(actions[lane * ACTION_SIZE + column]);
            columns[column].as_mut()[lane] = R::Scalar::from_f64(number);
        }
    }
    let [forward, strafe, jump, jet, turn] = &columns;
    let zero = R::zero();
    Input {
        forward: key(R::pack(forward)),
        strafe: key(R::pack(strafe)),
        jump: zero.lt(R::pack(jump)),
        jet: zero.lt(R::pack(jet)),
        turn: R::pack(turn) * R::splat(turn_rate),
        ..Input::idle()
    }
}

/// 1 beyond a third, -1 beyond minus a third. The threshold is that of `f32`, in which actions come.
#[inline(always)]
fn key<R: Real>(x: R) -> R {
    let third = R::lit(f64::from(1.0_f32 / 3.0));
    let (zero, one) = (R::zero(), R::lit(1.0));
    R::select(third.lt(x), one, R::select(x.lt(-third), -one, zero))
}
