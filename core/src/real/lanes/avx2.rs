//! 8 lanes: AVX2.

use super::{check_rows, lane_access, load_square, operators, out_of_range, transpose, wrap_slowly};
use crate::real::{Int, Mask, Real, Work};
use core::arch::x86_64::*;
use core::ops::Neg;

/// 8 numbers.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct F32x8(__m256);

/// 8 integers.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct I32x8(__m256i);

/// All bits set, or none, in each of 8 lanes.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Mask8(__m256i);

#[inline(never)]
#[target_feature(enable = "avx2")]
fn with_avx2<W: Work>(work: W) -> W::Output {
    work.run()
}

// SAFETY of every intrinsic below: whoever holds a lane, or makes the first one, checked that the
// processor has AVX2.
impl Mask for Mask8 {
    #[inline(always)]
    fn splat(x: bool) -> Self {
        Self(unsafe { _mm256_set1_epi32(if x { -1 } else { 0 }) })
    }
    #[inline(always)]
    fn any(self) -> bool {
        unsafe { _mm256_movemask_ps(_mm256_castsi256_ps(self.0)) != 0 }
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(unsafe { _mm256_and_si256(self.0, other.0) })
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(unsafe { _mm256_or_si256(self.0, other.0) })
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(unsafe { _mm256_xor_si256(self.0, _mm256_set1_epi32(-1)) })
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> bool {
        I32x8(self.0).lane(lane) != 0
    }
    #[inline(always)]
    fn set_lane(&mut self, lane: usize, x: bool) {
        // SAFETY: a mask is a register of integers.
        let lanes = unsafe { &mut *core::ptr::from_mut(self).cast::<I32x8>() };
        lanes.set_lane(lane, -i32::from(x));
    }
    #[inline(always)]
    fn copy_lane(&mut self, lane: usize, from: &Self, there: usize) {
        // SAFETY: a mask is as large as the array of its lanes, and both are plain bits.
        let (to, from) = unsafe {
            let to = core::ptr::from_mut(self).cast::<[i32; 8]>();
            (&mut *to, &*core::ptr::from_ref(from).cast::<[i32; 8]>())
        };
        to[lane] = from[there];
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        unsafe { _mm256_movemask_ps(_mm256_castsi256_ps(self.0)).cast_unsigned() }
    }
}

operators!(I32x8: Add::add = _mm256_add_epi32, Sub::sub = _mm256_sub_epi32, Mul::mul = _mm256_mullo_epi32);

impl Int for I32x8 {
    type Mask = Mask8;
    #[inline(always)]
    fn splat(x: i32) -> Self {
        Self(unsafe { _mm256_set1_epi32(x) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_cmpgt_epi32(other.0, self.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_cmpeq_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Mask8, a: Self, b: Self) -> Self {
        Self(unsafe { _mm256_blendv_epi8(b.0, a.0, mask.0) })
    }
    #[inline(always)]
    fn wrap(self, n: i32) -> Self {
        if n & (n - 1) == 0 {
            return Self(unsafe { _mm256_and_si256(self.0, _mm256_set1_epi32(n - 1)) });
        }
        // A register is as large as the array of its lanes, and both are plain bits.
        let mut lanes = unsafe { core::mem::transmute::<__m256i, [i32; 8]>(self.0) };
        wrap_slowly(&mut lanes, n);
        Self(unsafe { core::mem::transmute::<[i32; 8], __m256i>(lanes) })
    }
    #[inline(always)]
    fn is_odd(self) -> Mask8 {
        Mask8(unsafe { _mm256_srai_epi32::<31>(_mm256_slli_epi32::<31>(self.0)) })
    }
    lane_access!(i32, 8, __m256i);
}

operators!(F32x8: Add::add = _mm256_add_ps, Sub::sub = _mm256_sub_ps, Mul::mul = _mm256_mul_ps, Div::div = _mm256_div_ps);

impl Neg for F32x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(unsafe { _mm256_xor_ps(self.0, _mm256_set1_ps(-0.0)) })
    }
}

impl Real for F32x8 {
    type Scalar = f32;
    type Int = I32x8;
    type Mask = Mask8;
    type Each<T: Copy + Send + Sync> = [T; 8];
    const LANES: usize = 8;

    #[inline(always)]
    fn enter<W: Work>(work: W) -> W::Output {
        unsafe { with_avx2(work) }
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(unsafe { _mm256_set1_ps(x) })
    }
    #[inline(always)]
    fn every<T: Copy + Send + Sync>(x: T) -> [T; 8] {
        [x; 8]
    }
    #[inline(always)]
    fn pack(each: &[f32; 8]) -> Self {
        Self(unsafe { _mm256_loadu_ps(each.as_ptr()) })
    }
    #[inline(always)]
    fn unpack(self) -> [f32; 8] {
        unsafe { core::mem::transmute(self.0) }
    }
    #[inline(always)]
    fn pack_int(each: &[i32; 8]) -> I32x8 {
        I32x8(unsafe { _mm256_loadu_si256(each.as_ptr().cast()) })
    }
    #[inline(always)]
    fn unpack_int(i: I32x8) -> [i32; 8] {
        unsafe { core::mem::transmute(i.0) }
    }
    lane_access!(f32, 8, __m256);
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) })
    }
    #[inline(always)]
    fn select(mask: Mask8, a: Self, b: Self) -> Self {
        Self(unsafe { _mm256_blendv_ps(b.0, a.0, _mm256_castsi256_ps(mask.0)) })
    }
    // The instructions' own rule, with the second operand where neither is less, is the trait's.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm256_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn truncate(self) -> I32x8 {
        I32x8(unsafe {
            // What does not fit gives i32::MIN: right at the lower end, wrong at the upper one and for NaN.
            let plain = _mm256_cvttps_epi32(self.0);
            let above = _mm256_cmp_ps::<_CMP_GE_OQ>(self.0, _mm256_set1_ps(2_147_483_648.0));
            let capped = _mm256_blendv_epi8(plain, _mm256_set1_epi32(i32::MAX), _mm256_castps_si256(above));
            let number = _mm256_cmp_ps::<_CMP_ORD_Q>(self.0, self.0);
            _mm256_and_si256(capped, _mm256_castps_si256(number))
        })
    }
    // Rounding first saves the way back from the integer.
    #[inline(always)]
    fn floor_int(self) -> I32x8 {
        Self(unsafe { _mm256_round_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0) }).truncate()
    }
    #[inline(always)]
    fn ceil_int(self) -> I32x8 {
        Self(unsafe { _mm256_round_ps::<{ _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC }>(self.0) }).truncate()
    }
    #[inline(always)]
    fn from_int(i: I32x8) -> Self {
        Self(unsafe { _mm256_cvtepi32_ps(i.0) })
    }
    #[inline(always)]
    fn write_rows(
        columns: &[Self; 8],
        count: usize,
        rows: &mut [f32],
        stride: usize,
        at: usize,
        players: usize,
    ) {
        check_rows(8, count, rows.len(), stride, at, players);
        // SAFETY: as above, and the rows were checked.
        unsafe {
            let columns = core::mem::transmute::<&[Self; 8], &[__m256; 8]>(columns);
            transpose::write_8(columns, count, rows.as_mut_ptr().add(at), stride, players);
        }
    }
    #[inline(always)]
    fn gather_square(table: &[[f32; 2]], index: I32x8) -> [Self; 4] {
        let last = u32::try_from(table.len().saturating_sub(1)).unwrap_or(u32::MAX).cast_signed();
        unsafe {
            // Unsigned, so that a negative index is a large one.
            let larger = _mm256_max_epu32(index.0, _mm256_set1_epi32(last));
            if Mask8(_mm256_cmpeq_epi32(larger, index.0)).any() {
                out_of_range(table.len());
            }
            // Two indices to a word: half as many moves out of the register.
            let [i0, i2, i4, i6] = core::mem::transmute::<__m256i, [u64; 4]>(index.0);
            let a = _mm256_set_m128(load_square(table, i4), load_square(table, i0));
            let b = _mm256_set_m128(load_square(table, i4 >> 32), load_square(table, i0 >> 32));
            let c = _mm256_set_m128(load_square(table, i6), load_square(table, i2));
            let d = _mm256_set_m128(load_square(table, i6 >> 32), load_square(table, i2 >> 32));
            let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
            let (ef, gh) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
            let (ab, cd) = (_mm256_castps_pd(ab), _mm256_castps_pd(cd));
            let (ef, gh) = (_mm256_castps_pd(ef), _mm256_castps_pd(gh));
            [
                Self(_mm256_castpd_ps(_mm256_unpacklo_pd(ab, cd))),
                Self(_mm256_castpd_ps(_mm256_unpackhi_pd(ab, cd))),
                Self(_mm256_castpd_ps(_mm256_unpacklo_pd(ef, gh))),
                Self(_mm256_castpd_ps(_mm256_unpackhi_pd(ef, gh))),
            ]
        }
    }
}
