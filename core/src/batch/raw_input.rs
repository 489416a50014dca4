//! Keys as they come from outside: checked, then turned into the kernel's input.

use crate::error::{InputError, refuse};
use crate::input::{Input, MAX_TURN_RATE};
use crate::real::{Real, Scalar};

/// One player's keys as they cross the border: the layout of `discjump.INPUT`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RawInput {
    /// -1, 0 or 1.
    pub forward: i8,
    /// -1, 0 or 1.
    pub strafe: i8,
    /// 0 or 1.
    pub jump: u8,
    /// 0 or 1.
    pub jet: u8,
    /// 0 or 1.
    pub fire: u8,
    /// Turn rate, rad/s, positive to the left.
    pub turn: f64,
    /// Pitch, radians, up positive.
    pub pitch: f64,
}

impl RawInput {
    /// Checks the ranges of one player's keys.
    ///
    /// # Errors
    /// Names the field, the range and the value.
    pub fn check(&self, player: usize) -> Result<(), InputError> {
        for (name, value) in [("forward", self.forward), ("strafe", self.strafe)] {
            if !(-1..=1).contains(&value) {
                refuse!("inputs[{player}].{name}: expected -1, 0 or 1, got {value}");
            }
        }
        for (name, value) in [("jump", self.jump), ("jet", self.jet), ("fire", self.fire)] {
            if value > 1 {
                refuse!("inputs[{player}].{name}: expected a bool, got the byte {value}");
            }
        }
        if self.turn.is_nan() || self.turn.abs() > MAX_TURN_RATE {
            refuse!("inputs[{player}].turn: expected within +-{MAX_TURN_RATE} rad/s, got {}", self.turn);
        }
        if !self.pitch.is_finite() {
            refuse!("inputs[{player}].pitch: expected a finite angle in radians, got {}", self.pitch);
        }
        Ok(())
    }

    /// Whether [`RawInput::check`] accepts the keys, without a branch: a batch asks it of everybody.
    #[inline(always)]
    fn valid(&self) -> bool {
        let key = |k: i8| k.wrapping_add(1).cast_unsigned() <= 2;
        let flags = self.jump | self.jet | self.fire;
        key(self.forward)
            & key(self.strafe)
            & (flags <= 1)
            & (self.turn.abs() <= MAX_TURN_RATE)
            & (self.pitch.abs() < f64::INFINITY)
    }

    /// Checks the ranges of everybody's keys.
    ///
    /// # Errors
    /// Names the first player whose keys are out of range, the field, the range and the value.
    pub(super) fn check_all(players: &[Self]) -> Result<(), InputError> {
        if players.iter().fold(true, |all, keys| all & keys.valid()) {
            return Ok(());
        }
        players.iter().enumerate().try_for_each(|(i, keys)| keys.check(i))
    }

    /// The keys of up to as many players as `R` has lanes, side by side; the other lanes are idle.
    #[inline(always)]
    pub(super) fn pack<R: Real>(players: &[Self]) -> Input<R> {
        let mut columns = [R::every(R::Scalar::default()); 7];
        for (lane, player) in players.iter().enumerate() {
            let keys = player.to_input::<R::Scalar>();
            let flag = |pressed: bool| R::Scalar::from_int(i32::from(pressed));
            columns[0].as_mut()[lane] = keys.forward;
            columns[1].as_mut()[lane] = keys.strafe;
            columns[2].as_mut()[lane] = keys.turn;
            columns[3].as_mut()[lane] = keys.pitch;
            columns[4].as_mut()[lane] = flag(keys.jump);
            columns[5].as_mut()[lane] = flag(keys.jet);
            columns[6].as_mut()[lane] = flag(keys.fire);
        }
        let zero = R::zero();
        Input {
            forward: R::pack(&columns[0]),
            strafe: R::pack(&columns[1]),
            turn: R::pack(&columns[2]),
            pitch: R::pack(&columns[3]),
            jump: zero.lt(R::pack(&columns[4])),
            jet: zero.lt(R::pack(&columns[5])),
            fire: zero.lt(R::pack(&columns[6])),
        }
    }

    #[inline(always)]
    pub(super) fn to_input<T: Scalar>(self) -> Input<T> {
        Input {
            forward: T::from_f64(f64::from(self.forward)),
            strafe: T::from_f64(f64::from(self.strafe)),
            jump: self.jump != 0,
            jet: self.jet != 0,
            fire: self.fire != 0,
            turn: T::from_f64(self.turn),
            pitch: T::from_f64(self.pitch),
        }
    }
}
