//! The one number type the physics is written in.
//!
//! Every formula of the simulator is generic over [`Real`]: `f64` is the reference tier, `f32` the
//! authentic one, and a vector of `f32` lanes is several players side by side. So the physics has no
//! branches on numbers, only [`Mask`]s and [`Real::select`]; for scalars a mask is a `bool` and the
//! compiler turns it back into the branch or the conditional move it prefers.
//!
//! Bits are part of the contract: only IEEE `+ - * /` and `sqrt`, comparisons and selects, in the
//! order written; no fused multiply-add, no platform libm. A vector lane then gives the bits of the
//! scalar.

pub(crate) mod lanes;
mod ops;
mod scalar;
mod sincos;
mod vec3;

pub use ops::{Int, Mask};
pub use scalar::Scalar;
pub use vec3::V3;

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Something to be done with lanes of one width, in code that is compiled for their instruction set:
/// see [`Real::enter`]. `run` must be `#[inline(always)]`.
pub trait Work {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run(self) -> Self::Output;
}

/// A slice of the type that it already has, which generic code knows by other means.
///
/// # Panics
/// If it has another.
#[inline(always)]
pub(crate) fn same_type<F: 'static, T: 'static>(values: &[F]) -> &[T] {
    assert_eq!(core::any::TypeId::of::<F>(), core::any::TypeId::of::<T>(), "one type");
    // SAFETY: F and T are the same type, as just checked.
    unsafe { core::slice::from_raw_parts(values.as_ptr().cast(), values.len()) }
}

/// A real number, or several players' numbers side by side.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// One lane: `f32` or `f64`.
    type Scalar: Scalar;
    /// Integers as wide as `Self` has lanes: ages, square indices, map offsets.
    type Int: Int<Mask = Self::Mask>;
    /// The result of a comparison.
    type Mask: Mask;
    /// One `T` per lane, for what is rare enough to be handled player by player.
    type Each<T: Copy + Send + Sync>: Copy + Send + Sync + AsRef<[T]> + AsMut<[T]>;

    /// How many players one value holds.
    const LANES: usize;

    /// Does some work in a function that is compiled for the instruction set of these lanes.
    #[inline(always)]
    fn enter<W: Work>(work: W) -> W::Output {
        work.run()
    }
    /// The same number in every lane.
    fn splat(x: Self::Scalar) -> Self;
    /// The same `T` for every lane.
    fn every<T: Copy + Send + Sync>(x: T) -> Self::Each<T>;
    /// The numbers of all lanes at once.
    fn pack(each: &Self::Each<Self::Scalar>) -> Self;
    /// All lanes' numbers.
    fn unpack(self) -> Self::Each<Self::Scalar>;
    /// The integers of all lanes at once.
    fn pack_int(each: &Self::Each<i32>) -> Self::Int;
    /// All lanes' integers.
    fn unpack_int(i: Self::Int) -> Self::Each<i32>;
    /// The number in one lane.
    fn lane(self, lane: usize) -> Self::Scalar;
    /// Overwrites one lane.
    fn set_lane(&mut self, lane: usize, x: Self::Scalar);
    /// Copies one lane of another number, from memory to memory.
    #[inline(always)]
    fn copy_lane(&mut self, lane: usize, from: &Self, there: usize) {
        self.set_lane(lane, from.lane(there));
    }
    /// `self < other`; false where either is NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`; false where either is NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `a` where the mask is set, `b` elsewhere.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// IEEE square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Towards zero, saturating at the ends of `i32`; NaN gives 0.
    fn truncate(self) -> Self::Int;
    /// The nearest number to an integer.
    fn from_int(i: Self::Int) -> Self;
    /// The numbers of `table[index]` and of `table[index + 1]`, in this order, lane by lane: one load each.
    ///
    /// # Panics
    /// If an index is negative, or its successor not below the table's length.
    fn gather_square(table: &[[Self::Scalar; 2]], index: Self::Int) -> [Self; 4];
    /// Turns columns into rows: writes the number of lane `l` of `columns[k]`, rounded to `f32`, to
    /// `rows[l * stride + at + k]`, for the first `count` columns and the first `players` lanes.
    ///
    /// # Panics
    /// If a row does not end within `rows` or its stride, or there are more columns or players than
    /// lanes.
    fn write_rows(
        columns: &Self::Each<Self>,
        count: usize,
        rows: &mut [f32],
        stride: usize,
        at: usize,
        players: usize,
    );

    /// A constant of the specification, rounded to the lane's type.
    #[inline(always)]
    fn lit(x: f64) -> Self {
        Self::splat(Self::Scalar::from_f64(x))
    }

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::lit(0.0)
    }

    /// `if self < other { self } else { other }`: the form whose bits every lane width shares.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// `if self > other { self } else { other }`.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// The largest integer not above `self`; exact while it fits `i32`, saturating beyond.
    #[inline(always)]
    fn floor_int(self) -> Self::Int {
        let t = self.truncate();
        let over = self.lt(Self::from_int(t)).and(Self::Int::splat(i32::MIN).lt(t));
        t - Self::Int::select(over, Self::Int::splat(1), Self::Int::splat(0))
    }

    /// The smallest integer not below `self`, for `self >= 0`; saturating.
    #[inline(always)]
    fn ceil_int(self) -> Self::Int {
        let t = self.truncate();
        let short = Self::from_int(t).lt(self).and(t.lt(Self::Int::splat(i32::MAX)));
        t + Self::Int::select(short, Self::Int::splat(1), Self::Int::splat(0))
    }

    /// Sine and cosine of an angle in radians, by our own polynomials, with the same bits at any
    /// instruction set. For |angle| <= 2 pi within 2 ulp of the result or, in `f32` beside its zeros,
    /// within 1e-10.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        sincos::sin_cos(self)
    }
}
