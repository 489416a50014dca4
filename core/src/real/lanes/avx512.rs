//! 16 lanes: AVX-512.

use super::{check_rows, lane_access, load_square, operators, out_of_range, transpose, wrap_slowly};
use crate::real::{Int, Mask, Real, Work};
use core::arch::x86_64::*;
use core::ops::Neg;

/// Four places of a table, each with its successor, in one register.
///
/// # Safety
/// The processor has AVX-512, and all these places lie in the table.
#[inline(always)]
unsafe fn join(index: [u64; 4], table: &[[f32; 2]]) -> __m512 {
    // SAFETY: the caller's promise.
    unsafe {
        let low = _mm256_set_m128(load_square(table, index[1]), load_square(table, index[0]));
        let high = _mm256_set_m128(load_square(table, index[3]), load_square(table, index[2]));
        _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high)
    }
}

/// 16 numbers.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct F32x16(__m512);

/// 16 integers.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct I32x16(__m512i);

/// A bit for each of 16 lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mask16(u16);

#[inline(never)]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn with_avx512<W: Work>(work: W) -> W::Output {
    work.run()
}

impl Mask for Mask16 {
    #[inline(always)]
    fn splat(x: bool) -> Self {
        Self(if x { u16::MAX } else { 0 })
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> bool {
        self.0 >> lane & 1 == 1
    }
    #[inline(always)]
    fn set_lane(&mut self, lane: usize, x: bool) {
        self.0 = self.0 & !(1 << lane) | u16::from(x) << lane;
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self.0)
    }
}

operators!(I32x16: Add::add = _mm512_add_epi32, Sub::sub = _mm512_sub_epi32, Mul::mul = _mm512_mullo_epi32);

// SAFETY of every intrinsic below: whoever holds a lane, or makes the first one, checked that the
// processor has AVX-512.
impl Int for I32x16 {
    type Mask = Mask16;
    #[inline(always)]
    fn splat(x: i32) -> Self {
        Self(unsafe { _mm512_set1_epi32(x) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmplt_epi32_mask(self.0, other.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmpeq_epi32_mask(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Mask16, a: Self, b: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_epi32(mask.0, b.0, a.0) })
    }
    #[inline(always)]
    fn wrap(self, n: i32) -> Self {
        if n & (n - 1) == 0 {
            return Self(unsafe { _mm512_and_si512(self.0, _mm512_set1_epi32(n - 1)) });
        }
        // A register is as large as the array of its lanes, and both are plain bits.
        let mut lanes = unsafe { core::mem::transmute::<__m512i, [i32; 16]>(self.0) };
        wrap_slowly(&mut lanes, n);
        Self(unsafe { core::mem::transmute::<[i32; 16], __m512i>(lanes) })
    }
    #[inline(always)]
    fn is_odd(self) -> Mask16 {
        Mask16(unsafe { _mm512_test_epi32_mask(self.0, _mm512_set1_epi32(1)) })
    }
    lane_access!(i32, 16, __m512i);
}

operators!(F32x16: Add::add = _mm512_add_ps, Sub::sub = _mm512_sub_ps, Mul::mul = _mm512_mul_ps, Div::div = _mm512_div_ps);

impl Neg for F32x16 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(unsafe {
            let sign = _mm512_set1_epi32(i32::MIN);
            _mm512_castsi512_ps(_mm512_xor_si512(_mm512_castps_si512(self.0), sign))
        })
    }
}

impl Real for F32x16 {
    type Scalar = f32;
    type Int = I32x16;
    type Mask = Mask16;
    type Each<T: Copy + Send + Sync> = [T; 16];
    const LANES: usize = 16;

    #[inline(always)]
    fn enter<W: Work>(work: W) -> W::Output {
        unsafe { with_avx512(work) }
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(unsafe { _mm512_set1_ps(x) })
    }
    #[inline(always)]
    fn every<T: Copy + Send + Sync>(x: T) -> [T; 16] {
        [x; 16]
    }
    #[inline(always)]
    fn pack(each: &[f32; 16]) -> Self {
        Self(unsafe { _mm512_loadu_ps(each.as_ptr()) })
    }
    #[inline(always)]
    fn unpack(self) -> [f32; 16] {
        unsafe { core::mem::transmute(self.0) }
    }
    #[inline(always)]
    fn pack_int(each: &[i32; 16]) -> I32x16 {
        I32x16(unsafe { _mm512_loadu_si512(each.as_ptr().cast()) })
    }
    #[inline(always)]
    fn unpack_int(i: I32x16) -> [i32; 16] {
        unsafe { core::mem::transmute(i.0) }
    }
    lane_access!(f32, 16, __m512);
    #[inline(always)]
    fn lt(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Mask16, a: Self, b: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_ps(mask.0, b.0, a.0) })
    }
    // The instructions' own rule, with the second operand where neither is less, is the trait's.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm512_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm512_abs_ps(self.0) })
    }
    #[inline(always)]
    fn truncate(self) -> I32x16 {
        I32x16(unsafe {
            // What does not fit gives i32::MIN: right at the lower end, wrong at the upper one and for NaN.
            let plain = _mm512_cvttps_epi32(self.0);
            let above = _mm512_cmp_ps_mask::<_CMP_GE_OQ>(self.0, _mm512_set1_ps(2_147_483_648.0));
            let capped = _mm512_mask_blend_epi32(above, plain, _mm512_set1_epi32(i32::MAX));
            let number = _mm512_cmp_ps_mask::<_CMP_ORD_Q>(self.0, self.0);
            _mm512_maskz_mov_epi32(number, capped)
        })
    }
    // Rounding first saves the way back from the integer.
    #[inline(always)]
    fn floor_int(self) -> I32x16 {
        Self(unsafe { _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0) })
            .truncate()
    }
    #[inline(always)]
    fn ceil_int(self) -> I32x16 {
        Self(unsafe { _mm512_roundscale_ps::<{ _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC }>(self.0) })
            .truncate()
    }
    #[inline(always)]
    fn from_int(i: I32x16) -> Self {
        Self(unsafe { _mm512_cvtepi32_ps(i.0) })
    }
    #[inline(always)]
    fn write_rows(
        columns: &[Self; 16],
        count: usize,
        rows: &mut [f32],
        stride: usize,
        at: usize,
        players: usize,
    ) {
        check_rows(16, count, rows.len(), stride, at, players);
        // SAFETY: as above, and the rows were checked.
        unsafe {
            let columns = core::mem::transmute::<&[Self; 16], &[__m512; 16]>(columns);
            transpose::write_16(columns, count, rows.as_mut_ptr().add(at), stride, players);
        }
    }
    #[inline(always)]
    fn gather_square(table: &[[f32; 2]], index: I32x16) -> [Self; 4] {
        let last = u32::try_from(table.len().saturating_sub(1)).unwrap_or(u32::MAX).cast_signed();
        unsafe {
            // Unsigned, so that a negative index is a large one.
            if _mm512_cmpge_epu32_mask(index.0, _mm512_set1_epi32(last)) != 0 {
                out_of_range(table.len());
            }
            // Two indices to a word: half as many moves out of the register.
            let [i0, i2, i4, i6, i8, ia, ic, ie] = core::mem::transmute::<__m512i, [u64; 8]>(index.0);
            let a = join([i0, i4, i8, ic], table);
            let b = join([i0 >> 32, i4 >> 32, i8 >> 32, ic >> 32], table);
            let c = join([i2, i6, ia, ie], table);
            let d = join([i2 >> 32, i6 >> 32, ia >> 32, ie >> 32], table);
            let (ab, cd) = (_mm512_unpacklo_ps(a, b), _mm512_unpacklo_ps(c, d));
            let (ef, gh) = (_mm512_unpackhi_ps(a, b), _mm512_unpackhi_ps(c, d));
            let (ab, cd) = (_mm512_castps_pd(ab), _mm512_castps_pd(cd));
            let (ef, gh) = (_mm512_castps_pd(ef), _mm512_castps_pd(gh));
            [
                Self(_mm512_castpd_ps(_mm512_unpacklo_pd(ab, cd))),
                Self(_mm512_castpd_ps(_mm512_unpackhi_pd(ab, cd))),
                Self(_mm512_castpd_ps(_mm512_unpacklo_pd(ef, gh))),
                Self(_mm512_castpd_ps(_mm512_unpackhi_pd(ef, gh))),
            ]
        }
    }
}
