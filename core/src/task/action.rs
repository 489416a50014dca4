//! Actions, and the keys they stand for.

use crate::error::{InputError, refuse};
use crate::input::Input;
use crate::real::{Int, Real, Scalar};
use crate::tick::MAX_PITCH;

/// Numbers per action where nothing can be fired: forward, strafe, jump, jet, turn.
pub const ACTION_SIZE: usize = 5;
/// Choices of each number of such a discrete action.
pub const ACTION_BINS: [i64; ACTION_SIZE] = [3, 3, 2, 2, 7];
/// Numbers per action of who has a launcher: the same, then fire and pitch.
pub const ARMED_SIZE: usize = 7;
/// Choices of each number of such a discrete action.
pub const ARMED_BINS: [i64; ARMED_SIZE] = [3, 3, 2, 2, 7, 2, 5];

/// Choices of each number of a discrete action, with a launcher or without.
#[must_use]
pub fn action_bins(armed: bool) -> &'static [i64] {
    if armed { &ARMED_BINS } else { &ACTION_BINS }
}

/// How actions are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionKind {
    /// Indices into [`action_bins`]: forward and strafe 0, 1, 2 for -1, 0, +1; turn 0 (right) to 6 (left); pitch
    /// 0 (straight down, as far as the view goes) to 4 (ahead).
    MultiDiscrete,
    /// Numbers in [-1, 1]: keys are pressed beyond +-1/3 (forward, strafe) or above 0 (jump, jet, fire); turn and
    /// pitch are proportional.
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
    pub fn check(&self, kind: ActionKind, armed: bool, players: usize) -> Result<(), InputError> {
        if armed {
            self.check_rows::<ARMED_SIZE>(kind, players, &ARMED_BINS)
        } else {
            self.check_rows::<ACTION_SIZE>(kind, players, &ACTION_BINS)
        }
    }

    fn check_rows<const N: usize>(
        &self,
        kind: ActionKind,
        players: usize,
        bins: &[i64; N],
    ) -> Result<(), InputError> {
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
        if len != players * N {
            refuse!("actions: expected {players} rows of {N}, got {len} numbers");
        }
        let bad = match self {
            Self::Int8(a) => find_bad(a, bins),
            Self::Int32(a) => find_bad(a, bins),
            Self::Int64(a) => find_bad(a, bins),
            Self::Float(a) => a
                .iter()
                .position(|x| !(-1.0..=1.0).contains(x))
                .map(|at| (at, format!("expected -1 to 1, got {}", a[at]))),
        };
        if let Some((at, what)) = bad {
            refuse!("actions[{}, {}]: {what}", at / N, at % N);
        }
        Ok(())
    }

    /// The keys of `players` players from the `first` on, side by side; further lanes press none. Rows have `N`
    /// numbers, [`ACTION_SIZE`] or [`ARMED_SIZE`]; `turn_rate` is the fastest turn, rad/s.
    #[inline(always)]
    #[must_use]
    pub fn input<R: Real, const N: usize>(
        &self,
        first: usize,
        players: usize,
        turn_rate: R::Scalar,
    ) -> Input<R> {
        let rows = first * N..(first + players) * N;
        match self {
            Self::Int8(a) => discrete::<R, _, N>(&a[rows], turn_rate),
            Self::Int32(a) => discrete::<R, _, N>(&a[rows], turn_rate),
            Self::Int64(a) => discrete::<R, _, N>(&a[rows], turn_rate),
            Self::Float(a) => continuous::<R, N>(&a[rows], turn_rate),
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

fn find_bad<I: Choice + Default, const N: usize>(actions: &[I], bins: &[i64; N]) -> Option<(usize, String)> {
    for (k, stretch) in actions.chunks(STRETCH * N).enumerate() {
        // Only signs are gathered, with no branch, so that the compiler looks at many at a time.
        let mut beyond = [I::default(); N];
        for row in stretch.chunks_exact(N) {
            for (column, &choice) in row.iter().enumerate() {
                beyond[column] = beyond[column].join(choice.beyond(bins[column]));
            }
        }
        if beyond.iter().all(|&sign| sign.into() >= 0) {
            continue;
        }
        for (at, &choice) in stretch.iter().enumerate() {
            let (choice, bins) = (choice.into(), bins[at % N]);
            if !(0..bins).contains(&choice) {
                let at = k * STRETCH * N + at;
                return Some((at, format!("expected 0 to {}, got {choice}", bins - 1)));
            }
        }
    }
    None
}

/// Index of the pitch straight ahead.
const AHEAD: i32 = ARMED_BINS[6] as i32 - 1;

#[inline(always)]
fn discrete<R: Real, I: Copy + Into<i64>, const N: usize>(actions: &[I], turn_rate: R::Scalar) -> Input<R> {
    // No key, for lanes without a player.
    let idle = [1, 1, 0, 0, 3, 0, AHEAD];
    let mut columns: [R::Each<i32>; N] = core::array::from_fn(|column| R::every(idle[column]));
    // Plain loops: adapters of iterators and arrays stay calls here, for each number.
    for lane in 0..actions.len() / N {
        for column in 0..N {
            // Checked: it is a small number.
            columns[column].as_mut()[lane] = actions[lane * N + column].into() as i32;
        }
    }
    let one = R::Int::splat(1);
    let pressed = |column: usize| R::Int::splat(0).lt(R::pack_int(&columns[column]));
    let mut input = Input {
        forward: R::from_int(R::pack_int(&columns[0]) - one),
        strafe: R::from_int(R::pack_int(&columns[1]) - one),
        jump: pressed(2),
        jet: pressed(3),
        turn: R::from_int(R::pack_int(&columns[4]) - R::Int::splat(3)) / R::lit(3.0) * R::splat(turn_rate),
        ..Input::idle()
    };
    if N == ARMED_SIZE {
        input.fire = pressed(5);
        let down = R::from_int(R::pack_int(&columns[6]) - R::Int::splat(AHEAD));
        input.pitch = down * R::lit(MAX_PITCH / f64::from(AHEAD));
    }
    input
}

#[inline(always)]
fn continuous<R: Real, const N: usize>(actions: &[f32], turn_rate: R::Scalar) -> Input<R> {
    let mut columns = [R::every(R::Scalar::default()); N];
    for lane in 0..actions.len() / N {
        for column in 0..N {
            let number = f64::from(actions[lane * N + column]);
            columns[column].as_mut()[lane] = R::Scalar::from_f64(number);
        }
    }
    let number = |column: usize| R::pack(&columns[column]);
    let zero = R::zero();
    let mut input = Input {
        forward: key(number(0)),
        strafe: key(number(1)),
        jump: zero.lt(number(2)),
        jet: zero.lt(number(3)),
        turn: number(4) * R::splat(turn_rate),
        ..Input::idle()
    };
    if N == ARMED_SIZE {
        input.fire = zero.lt(number(5));
        input.pitch = number(6) * R::lit(MAX_PITCH);
    }
    input
}

/// 1 beyond a third, -1 beyond minus a third. The threshold is that of `f32`, in which actions come.
#[inline(always)]
fn key<R: Real>(x: R) -> R {
    let third = R::lit(f64::from(1.0_f32 / 3.0));
    let (zero, one) = (R::zero(), R::lit(1.0));
    R::select(third.lt(x), one, R::select(x.lt(-third), -one, zero))
}
