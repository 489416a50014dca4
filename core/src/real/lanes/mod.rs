//! Players side by side: `f32` lanes as a [`Real`], with the bits of the scalar in every lane.
//!
//! ```text
//! avx2     8 lanes, masks as integer lanes
//! avx512   16 lanes, masks as 16 bits
//! two      two registers of 16 side by side
//! ```
//!
//! Every operation is one instruction of the set, or a few; IEEE `+ - * /` and `sqrt` alone round, as
//! they do for scalars, and nothing is contracted. The methods carry no target feature of their own:
//! they are flattened into a function that does, which [`Real::enter`] calls. Two things follow. Code
//! that is generic over [`Real`] must be `#[inline(always)]` and free of closures around lane
//! operations, or each instruction becomes a call (slow, never wrong). And a value of these types may
//! only be made where the processor has the set: they are the crate's own, and [`lane_width`], which
//! chooses among them, is the one door.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
#[cfg(target_arch = "x86_64")]
mod transpose;
#[cfg(target_arch = "x86_64")]
mod two;
mod width;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::F32x8;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::F32x16;
#[cfg(target_arch = "x86_64")]
pub(crate) use two::Two;
pub(crate) use width::{Width, lane_width};

#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;

/// What a bounds check of a gather ends in: out of line, so that the lookup stays short.
#[cfg(target_arch = "x86_64")]
#[cold]
#[inline(never)]
fn out_of_range(len: usize) -> ! {
    panic!("an index of a gather is negative, or not below the table's length of {len}")
}

/// Four places of a table of pairs, and the two numbers before and after each one's middle, as one load
/// of 16 bytes. Plain loads: gather instructions are microcode on AMD, and were the longest wait of a
/// march.
///
/// # Safety
/// For the index both places lie in the table.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn load_square(table: &[[f32; 2]], index: u64) -> __m128 {
    // SAFETY: the caller's promise. The load needs no alignment.
    unsafe { _mm_loadu_ps(table.as_ptr().add((index & 0xffff_ffff) as usize).cast()) }
}

/// What [`Real::write_rows`](crate::real::Real::write_rows) promises to panic about.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn check_rows(lanes: usize, count: usize, len: usize, stride: usize, at: usize, players: usize) {
    let inside = players == 0 || (players - 1).saturating_mul(stride).saturating_add(stride) <= len;
    let fits = count <= lanes && players <= lanes && at.saturating_add(count) <= stride && inside;
    assert!(fits, "{count} columns at {at} of {players} rows of {stride} do not fit {len} numbers");
}

/// The arithmetic operators of a lane type, each one intrinsic.
#[cfg(target_arch = "x86_64")]
macro_rules! operators {
    ($t:ident: $($trait:ident :: $method:ident = $intrinsic:ident),+) => {
        $(impl core::ops::$trait for $t {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                // SAFETY: a value exists, so the processor has the set.
                Self(unsafe { $intrinsic(self.0, o.0) })
            }
        })+
    };
}
#[cfg(target_arch = "x86_64")]
use operators;

/// One lane of a register: read through an array on the stack, so that the register itself stays one; written
/// in memory, where whatever is changed lane by lane lies anyway. To load it whole, change a lane and store
/// it again would have every such change wait for the one before.
#[cfg(target_arch = "x86_64")]
macro_rules! lane_access {
    ($scalar:ty, $count:expr, $register:ty) => {
        #[inline(always)]
        fn lane(self, lane: usize) -> $scalar {
            // SAFETY: a register is as large as the array of its lanes, and both are plain bits.
            let lanes = unsafe { core::mem::transmute::<$register, [$scalar; $count]>(self.0) };
            lanes[lane]
        }
        #[inline(always)]
        fn set_lane(&mut self, lane: usize, x: $scalar) {
            // SAFETY: as above, and this type is its register.
            let lanes = unsafe { &mut *core::ptr::from_mut(self).cast::<[$scalar; $count]>() };
            lanes[lane] = x;
        }
        #[inline(always)]
        fn copy_lane(&mut self, lane: usize, from: &Self, there: usize) {
            // SAFETY: as above.
            let (to, from) = unsafe {
                let to = core::ptr::from_mut(self).cast::<[$scalar; $count]>();
                (&mut *to, &*core::ptr::from_ref(from).cast::<[$scalar; $count]>())
            };
            to[lane] = from[there];
        }
    };
}
#[cfg(target_arch = "x86_64")]
use lane_access;

/// Integers modulo `n > 0`, for maps whose sides are no powers of two. Out of line: within a march its
/// divisions would take the registers of the others.
#[cfg(target_arch = "x86_64")]
#[cold]
#[inline(never)]
fn wrap_slowly(lanes: &mut [i32], n: i32) {
    for lane in lanes {
        *lane = lane.rem_euclid(n);
    }
}
