//! Players side by side: `f32` lanes as a [`Real`], with the bits of the scalar in every lane.
//!
//! ```text
//! avx2     8 lanes, masks as integer lanes
//! avx512   16 lanes, masks as 16 bits
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
mod width;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::F32x8;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::F32x16;
pub(crate) use width::{Width, lane_width};

#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;

/// What a bounds check of a gather ends in: out of line, so that the lookup stays short.
#[cold]
#[inline(never)]
fn out_of_range(len: usize) -> ! {
    panic!("an index of a gather is negative, or not below the table's length of {len}")
}

/// `table[index]` and `table[index + 1]` of 8 lanes by plain loads of 8 bytes, half as many as two
/// gather instructions make; on AMD, whose gathers are microcode, that was the longest wait of a march.
///
/// # Safety
/// The processor has AVX2, and for every index both places lie in the table.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn load_pairs(table: &[f32], index: &[i32; 8]) -> (__m256, __m256) {
    // SAFETY: the caller's promise. The loads need no alignment.
    unsafe {
        let at = |lane: usize| table.as_ptr().add(index[lane] as usize).cast::<f64>();
        let x = _mm256_set_m128d(
            _mm_loadh_pd(_mm_load_sd(at(4)), at(5)),
            _mm_loadh_pd(_mm_load_sd(at(0)), at(1)),
        );
        let y = _mm256_set_m128d(
            _mm_loadh_pd(_mm_load_sd(at(6)), at(7)),
            _mm_loadh_pd(_mm_load_sd(at(2)), at(3)),
        );
        let (x, y) = (_mm256_castpd_ps(x), _mm256_castpd_ps(y));
        (_mm256_shuffle_ps::<0b10_00_10_00>(x, y), _mm256_shuffle_ps::<0b11_01_11_01>(x, y))
    }
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
use operators;

/// One lane of a register, read and written through an array on the stack. The register itself stays
/// one: an index into it would force it into memory.
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
            // SAFETY: as above.
            let mut lanes = unsafe { core::mem::transmute::<$register, [$scalar; $count]>(self.0) };
            lanes[lane] = x;
            // SAFETY: as above.
            self.0 = unsafe { core::mem::transmute::<[$scalar; $count], $register>(lanes) };
        }
    };
}
use lane_access;

/// An integer modulo `n > 0`, lane by lane: only maps whose sides are no powers of two need it.
macro_rules! wrap_lanes {
    ($value:expr, $count:expr, $register:ty, $n:expr) => {{
        // SAFETY: a register is as large as the array of its lanes, and both are plain bits.
        let mut lanes = unsafe { core::mem::transmute::<$register, [i32; $count]>($value) };
        for lane in &mut lanes {
            *lane = lane.rem_euclid($n);
        }
        // SAFETY: as above.
        unsafe { core::mem::transmute::<[i32; $count], $register>(lanes) }
    }};
}
use wrap_lanes;
