//! Masks and integers that go with a [`Real`](super::Real).

use core::fmt::Debug;
use core::ops::{Add, Mul, Sub};

/// The result of a comparison: a `bool`, or one per lane.
pub trait Mask: Copy + Debug + Send + Sync + 'static {
    /// The same truth in every lane.
    fn splat(x: bool) -> Self;
    /// Whether any lane is set.
    fn any(self) -> bool;
    /// Both.
    #[must_use]
    fn and(self, other: Self) -> Self;
    /// Either.
    #[must_use]
    fn or(self, other: Self) -> Self;
    /// The opposite.
    #[must_use]
    fn not(self) -> Self;
    /// One lane.
    fn lane(self, lane: usize) -> bool;
    /// Overwrites one lane.
    fn set_lane(&mut self, lane: usize, x: bool);
    /// Copies one lane of another mask.
    #[inline(always)]
    fn copy_lane(&mut self, lane: usize, from: &Self, there: usize) {
        self.set_lane(lane, from.lane(there));
    }
    /// A bit for every lane, the first one lowest.
    fn bits(self) -> u32;
    /// `a` where `self` is set, `b` elsewhere.
    #[inline(always)]
    #[must_use]
    fn pick(self, a: Self, b: Self) -> Self {
        self.and(a).or(self.not().and(b))
    }
}

/// A 32-bit integer, or one per lane. Callers keep sums and products in range.
pub trait Int:
    Copy + Debug + Send + Sync + 'static + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// The mask of its comparisons.
    type Mask: Mask;
    /// The same integer in every lane.
    fn splat(x: i32) -> Self;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self == other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// `a` where the mask is set, `b` elsewhere.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// `self` modulo `n > 0`, in `0..n` also for negative `self`.
    #[must_use]
    fn wrap(self, n: i32) -> Self;
    /// Whether the lowest bit is set.
    fn is_odd(self) -> Self::Mask;
    /// One lane.
    fn lane(self, lane: usize) -> i32;
    /// Overwrites one lane.
    fn set_lane(&mut self, lane: usize, x: i32);
    /// Copies one lane of another integer, from memory to memory.
    #[inline(always)]
    fn copy_lane(&mut self, lane: usize, from: &Self, there: usize) {
        self.set_lane(lane, from.lane(there));
    }
    /// Between two bounds.
    #[inline(always)]
    #[must_use]
    fn clamp(self, low: i32, high: i32) -> Self {
        let (low, high) = (Self::splat(low), Self::splat(high));
        let raised = Self::select(self.lt(low), low, self);
        Self::select(high.lt(raised), high, raised)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn splat(x: bool) -> Self {
        x
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self && other
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self || other
    }
    #[inline(always)]
    fn not(self) -> Self {
        !self
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> bool {
        self
    }
    #[inline(always)]
    fn set_lane(&mut self, _lane: usize, x: bool) {
        *self = x;
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

impl Int for i32 {
    type Mask = bool;
    #[inline(always)]
    fn splat(x: i32) -> Self {
        x
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn eq(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn wrap(self, n: i32) -> Self {
        // A division costs as much as the rest of a lookup; generated maps are powers of two.
        if n & (n - 1) == 0 { self & (n - 1) } else { self.rem_euclid(n) }
    }
    #[inline(always)]
    fn is_odd(self) -> bool {
        self & 1 == 1
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> i32 {
        self
    }
    #[inline(always)]
    fn set_lane(&mut self, _lane: usize, x: i32) {
        *self = x;
    }
}
