//! Two registers side by side: the tick is bound by latency, and two chains of instructions that do not
//! wait for each other take less than twice the time of one.

use crate::real::{Int, Mask, Real, Work};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Twice the lanes of `L`: first those of one, then those of the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Two<L>(L, L);

macro_rules! pairwise {
    ($($trait:ident :: $method:ident),+) => {
        $(impl<L: $trait<Output = L>> $trait for Two<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                Self(self.0.$method(o.0), self.1.$method(o.1))
            }
        })+
    };
}
pairwise!(Add::add, Sub::sub, Mul::mul, Div::div);

impl<L: Neg<Output = L>> Neg for Two<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

/// What every kind of value does with a lane: the half that it is in does it.
macro_rules! lanes_of_halves {
    ($scalar:ty, $count:expr) => {
        #[inline(always)]
        fn lane(self, lane: usize) -> $scalar {
            if lane < $count { self.0.lane(lane) } else { self.1.lane(lane - $count) }
        }
        #[inline(always)]
        fn set_lane(&mut self, lane: usize, x: $scalar) {
            if lane < $count { self.0.set_lane(lane, x) } else { self.1.set_lane(lane - $count, x) }
        }
        #[inline(always)]
        fn copy_lane(&mut self, lane: usize, from: &Self, there: usize) {
            let (from, there) = if there < $count { (&from.0, there) } else { (&from.1, there - $count) };
            let (to, lane) = if lane < $count { (&mut self.0, lane) } else { (&mut self.1, lane - $count) };
            to.copy_lane(lane, from, there);
        }
    };
}

/// The two halves of an array of all lanes.
macro_rules! halves {
    ($each:expr, $count:expr) => {{
        let (first, second) = $each.split_first_chunk::<$count>().expect("twice as many");
        (first, second.first_chunk::<$count>().expect("as many"))
    }};
}

/// An array of all lanes from its two halves.
macro_rules! both {
    ($first:expr, $second:expr, $count:expr) => {{
        let (first, second) = ($first, $second);
        let mut all = [first[0]; 2 * $count];
        all[..$count].copy_from_slice(&first);
        all[$count..].copy_from_slice(&second);
        all
    }};
}

macro_rules! two {
    ($real:ty, $int:ty, $mask:ty, $count:expr) => {
        impl Mask for Two<$mask> {
            #[inline(always)]
            fn splat(x: bool) -> Self {
                Self(<$mask>::splat(x), <$mask>::splat(x))
            }
            #[inline(always)]
            fn any(self) -> bool {
                self.0.or(self.1).any()
            }
            #[inline(always)]
            fn and(self, o: Self) -> Self {
                Self(self.0.and(o.0), self.1.and(o.1))
            }
            #[inline(always)]
            fn or(self, o: Self) -> Self {
                Self(self.0.or(o.0), self.1.or(o.1))
            }
            #[inline(always)]
            fn not(self) -> Self {
                Self(self.0.not(), self.1.not())
            }
            lanes_of_halves!(bool, $count);
            #[inline(always)]
            fn bits(self) -> u32 {
                self.0.bits() | self.1.bits() << $count
            }
        }

        impl Int for Two<$int> {
            type Mask = Two<$mask>;
            #[inline(always)]
            fn splat(x: i32) -> Self {
                Self(<$int>::splat(x), <$int>::splat(x))
            }
            #[inline(always)]
            fn lt(self, o: Self) -> Two<$mask> {
                Two(self.0.lt(o.0), self.1.lt(o.1))
            }
            #[inline(always)]
            fn eq(self, o: Self) -> Two<$mask> {
                Two(self.0.eq(o.0), self.1.eq(o.1))
            }
            #[inline(always)]
            fn select(mask: Two<$mask>, a: Self, b: Self) -> Self {
                Self(<$int>::select(mask.0, a.0, b.0), <$int>::select(mask.1, a.1, b.1))
            }
            #[inline(always)]
            fn wrap(self, n: i32) -> Self {
                Self(self.0.wrap(n), self.1.wrap(n))
            }
            #[inline(always)]
            fn is_odd(self) -> Two<$mask> {
                Two(self.0.is_odd(), self.1.is_odd())
            }
            lanes_of_halves!(i32, $count);
        }

        impl Real for Two<$real> {
            type Scalar = f32;
            type Int = Two<$int>;
            type Mask = Two<$mask>;
            type Each<T: Copy + Send + Sync> = [T; 2 * $count];
            const LANES: usize = 2 * $count;

            #[inline(always)]
            fn enter<W: Work>(work: W) -> W::Output {
                <$real>::enter(work)
            }
            #[inline(always)]
            fn splat(x: f32) -> Self {
                Self(<$real>::splat(x), <$real>::splat(x))
            }
            #[inline(always)]
            fn every<T: Copy + Send + Sync>(x: T) -> [T; 2 * $count] {
                [x; 2 * $count]
            }
            #[inline(always)]
            fn pack(each: &[f32; 2 * $count]) -> Self {
                let (first, second) = halves!(each, $count);
                Self(<$real>::pack(first), <$real>::pack(second))
            }
            #[inline(always)]
            fn unpack(self) -> [f32; 2 * $count] {
                both!(self.0.unpack(), self.1.unpack(), $count)
            }
            #[inline(always)]
            fn pack_int(each: &[i32; 2 * $count]) -> Two<$int> {
                let (first, second) = halves!(each, $count);
                Two(<$real>::pack_int(first), <$real>::pack_int(second))
            }
            #[inline(always)]
            fn unpack_int(i: Two<$int>) -> [i32; 2 * $count] {
                both!(<$real>::unpack_int(i.0), <$real>::unpack_int(i.1), $count)
            }
            lanes_of_halves!(f32, $count);
            #[inline(always)]
            fn lt(self, o: Self) -> Two<$mask> {
                Two(self.0.lt(o.0), self.1.lt(o.1))
            }
            #[inline(always)]
            fn le(self, o: Self) -> Two<$mask> {
                Two(self.0.le(o.0), self.1.le(o.1))
            }
            #[inline(always)]
            fn select(mask: Two<$mask>, a: Self, b: Self) -> Self {
                Self(<$real>::select(mask.0, a.0, b.0), <$real>::select(mask.1, a.1, b.1))
            }
            #[inline(always)]
            fn min(self, o: Self) -> Self {
                Self(self.0.min(o.0), self.1.min(o.1))
            }
            #[inline(always)]
            fn max(self, o: Self) -> Self {
                Self(self.0.max(o.0), self.1.max(o.1))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt(), self.1.sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(self.0.abs(), self.1.abs())
            }
            #[inline(always)]
            fn truncate(self) -> Two<$int> {
                Two(self.0.truncate(), self.1.truncate())
            }
            #[inline(always)]
            fn floor_int(self) -> Two<$int> {
                Two(self.0.floor_int(), self.1.floor_int())
            }
            #[inline(always)]
            fn ceil_int(self) -> Two<$int> {
                Two(self.0.ceil_int(), self.1.ceil_int())
            }
            #[inline(always)]
            fn from_int(i: Two<$int>) -> Self {
                Self(<$real>::from_int(i.0), <$real>::from_int(i.1))
            }
            #[inline(always)]
            fn write_rows(
                columns: &[Self; 2 * $count],
                count: usize,
                rows: &mut [f32],
                stride: usize,
                at: usize,
                players: usize,
            ) {
                super::check_rows(2 * $count, count, rows.len(), stride, at, players);
                let mut begin = 0;
                while begin < count {
                    let some = (count - begin).min($count);
                    let (mut first, mut second) = ([<$real>::zero(); $count], [<$real>::zero(); $count]);
                    for k in 0..some {
                        (first[k], second[k]) = (columns[begin + k].0, columns[begin + k].1);
                    }
                    let (low, high) = (players.min($count), players.saturating_sub($count));
                    <$real>::write_rows(&first, some, rows, stride, at + begin, low);
                    if high > 0 {
                        let rows = &mut rows[$count * stride..];
                        <$real>::write_rows(&second, some, rows, stride, at + begin, high);
                    }
                    begin += some;
                }
            }
            #[inline(always)]
            fn gather_square(table: &[[f32; 2]], index: Two<$int>) -> [Self; 4] {
                let [a, b, c, d] = <$real>::gather_square(table, index.0);
                let [e, f, g, h] = <$real>::gather_square(table, index.1);
                [Self(a, e), Self(b, f), Self(c, g), Self(d, h)]
            }
        }
    };
}

two!(super::F32x16, super::avx512::I32x16, super::avx512::Mask16, 16);
