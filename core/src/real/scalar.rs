//! `f32` and `f64` as [`Real`]s of one lane.

use super::Real;

/// One lane of a [`Real`], convertible to and from `f64`.
pub trait Scalar: Real<Scalar = Self, Int = i32, Mask = bool> + PartialOrd + Default {
    /// Whether this is `f64`.
    const DOUBLE: bool;
    /// Rounds to nearest.
    fn from_f64(x: f64) -> Self;
    /// Exact.
    fn to_f64(self) -> f64;
    /// Whether it is neither infinite nor NaN.
    fn finite(self) -> bool;
}

macro_rules! scalar {
    ($t:ty, $double:expr) => {
        impl Scalar for $t {
            const DOUBLE: bool = $double;
            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn finite(self) -> bool {
                self.is_finite()
            }
        }

        impl Real for $t {
            type Scalar = $t;
            type Int = i32;
            type Mask = bool;
            type Each<T: Copy + Send + Sync> = [T; 1];
            const LANES: usize = 1;

            #[inline(always)]
            fn splat(x: $t) -> Self {
                x
            }
            #[inline(always)]
            fn every<T: Copy + Send + Sync>(x: T) -> [T; 1] {
                [x; 1]
            }
            #[inline(always)]
            fn pack(each: &[$t; 1]) -> Self {
                each[0]
            }
            #[inline(always)]
            fn unpack(self) -> [$t; 1] {
                [self]
            }
            #[inline(always)]
            fn pack_int(each: &[i32; 1]) -> i32 {
                each[0]
            }
            #[inline(always)]
            fn unpack_int(i: i32) -> [i32; 1] {
                [i]
            }
            #[inline(always)]
            fn lane(self, _lane: usize) -> $t {
                self
            }
            #[inline(always)]
            fn set_lane(&mut self, _lane: usize, x: $t) {
                *self = x;
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$t>::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline(always)]
            fn truncate(self) -> i32 {
                self as i32
            }
            #[inline(always)]
            fn from_int(i: i32) -> Self {
                i as $t
            }
            #[inline(always)]
            fn gather_square(table: &[[$t; 2]], index: i32) -> [Self; 4] {
                let [[a, b], [c, d]] = table[index as usize..][..2] else { unreachable!() };
                [a, b, c, d]
            }
            #[inline(always)]
            fn write_rows(
                columns: &[$t; 1],
                count: usize,
                rows: &mut [f32],
                stride: usize,
                at: usize,
                players: usize,
            ) {
                assert!(count <= 1 && players <= 1 && at + count <= stride, "a column beyond the row");
                if count == 1 && players == 1 {
                    rows[at] = columns[0] as f32;
                }
            }
        }
    };
}

scalar!(f32, false);
scalar!(f64, true);
