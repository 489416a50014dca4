//! What a player asks for in one tick.

use crate::real::{Mask, Real};

/// Keys and view of one tick.
#[derive(Clone, Copy, Debug)]
pub struct Input<R: Real> {
    /// Forward (1), back (-1) or neither (0).
    pub forward: R,
    /// Right (1), left (-1) or neither (0).
    pub strafe: R,
    /// Jump key. Held, it requests a jump in every tick, as a skiing script does.
    pub jump: R::Mask,
    /// Jet key.
    pub jet: R::Mask,
    /// Trigger.
    pub fire: R::Mask,
    /// Turn rate, rad/s, positive to the left.
    pub turn: R,
    /// View pitch, radians, up positive, absolute.
    pub pitch: R,
}

impl<R: Real> Input<R> {
    /// No key pressed, looking straight ahead.
    #[must_use]
    pub fn idle() -> Self {
        let off = R::Mask::splat(false);
        Self {
            forward: R::zero(),
            strafe: R::zero(),
            jump: off,
            jet: off,
            fire: off,
            turn: R::zero(),
            pitch: R::zero(),
        }
    }

    /// The input of one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Input<R::Scalar> {
        Input {
            forward: self.forward.lane(lane),
            strafe: self.strafe.lane(lane),
            jump: self.jump.lane(lane),
            jet: self.jet.lane(lane),
            fire: self.fire.lane(lane),
            turn: self.turn.lane(lane),
            pitch: self.pitch.lane(lane),
        }
    }

    /// Overwrites one lane.
    pub fn set_lane(&mut self, lane: usize, input: &Input<R::Scalar>) {
        self.forward.set_lane(lane, input.forward);
        self.strafe.set_lane(lane, input.strafe);
        self.jump.set_lane(lane, input.jump);
        self.jet.set_lane(lane, input.jet);
        self.fire.set_lane(lane, input.fire);
        self.turn.set_lane(lane, input.turn);
        self.pitch.set_lane(lane, input.pitch);
    }
}

/// Fastest turn that a batch accepts, rad/s: far above any use, low enough that the yaw of a tick
/// keeps its digits.
pub const MAX_TURN_RATE: f64 = 1000.0;
