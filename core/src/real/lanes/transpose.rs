//! Columns of lanes as rows in memory: how observations leave the registers.

use core::arch::x86_64::*;

/// Writes the first `count` of 8 columns to the first `players` of 8 rows.
///
/// # Safety
/// The processor has AVX2; for every row below `players` the numbers `row * stride` to
/// `row * stride + count` after `to` may be written.
#[inline(always)]
pub(super) unsafe fn write_8(
    columns: &[__m256; 8],
    count: usize,
    to: *mut f32,
    stride: usize,
    players: usize,
) {
    // SAFETY: the caller's promise.
    unsafe {
        let c = columns;
        // Pairs, then fours, then the halves of the registers.
        let (a0, a1) = (_mm256_unpacklo_ps(c[0], c[1]), _mm256_unpackhi_ps(c[0], c[1]));
        let (b0, b1) = (_mm256_unpacklo_ps(c[2], c[3]), _mm256_unpackhi_ps(c[2], c[3]));
        let (d0, d1) = (_mm256_unpacklo_ps(c[4], c[5]), _mm256_unpackhi_ps(c[4], c[5]));
        let (e0, e1) = (_mm256_unpacklo_ps(c[6], c[7]), _mm256_unpackhi_ps(c[6], c[7]));
        let low = [
            _mm256_shuffle_ps::<0x44>(a0, b0),
            _mm256_shuffle_ps::<0xee>(a0, b0),
            _mm256_shuffle_ps::<0x44>(a1, b1),
            _mm256_shuffle_ps::<0xee>(a1, b1),
        ];
        let high = [
            _mm256_shuffle_ps::<0x44>(d0, e0),
            _mm256_shuffle_ps::<0xee>(d0, e0),
            _mm256_shuffle_ps::<0x44>(d1, e1),
            _mm256_shuffle_ps::<0xee>(d1, e1),
        ];
        let mut rows = [_mm256_setzero_ps(); 8];
        for k in 0..4 {
            rows[k] = _mm256_permute2f128_ps::<0x20>(low[k], high[k]);
            rows[4 + k] = _mm256_permute2f128_ps::<0x31>(low[k], high[k]);
        }
        if count == 8 {
            for (row, &numbers) in rows.iter().enumerate().take(players) {
                _mm256_storeu_ps(to.add(row * stride), numbers);
            }
            return;
        }
        let indices = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        let mask = _mm256_cmpgt_epi32(_mm256_set1_epi32(count as i32), indices);
        for (row, &numbers) in rows.iter().enumerate().take(players) {
            _mm256_maskstore_ps(to.add(row * stride), mask, numbers);
        }
    }
}

/// Writes the first `count` of 16 columns to the first `players` of 16 rows.
///
/// # Safety
/// The processor has AVX-512; for every row below `players` the numbers `row * stride` to
/// `row * stride + count` after `to` may be written.
#[inline(always)]
pub(super) unsafe fn write_16(
    columns: &[__m512; 16],
    count: usize,
    to: *mut f32,
    stride: usize,
    players: usize,
) {
    // SAFETY: the caller's promise.
    unsafe {
        // Within every quarter of a register: four columns become four rows of four.
        let mut fours = [_mm512_setzero_ps(); 16];
        for k in 0..4 {
            let c = &columns[4 * k..4 * k + 4];
            let (a0, a1) = (_mm512_unpacklo_ps(c[0], c[1]), _mm512_unpackhi_ps(c[0], c[1]));
            let (b0, b1) = (_mm512_unpacklo_ps(c[2], c[3]), _mm512_unpackhi_ps(c[2], c[3]));
            fours[4 * k] = _mm512_shuffle_ps::<0x44>(a0, b0);
            fours[4 * k + 1] = _mm512_shuffle_ps::<0xee>(a0, b0);
            fours[4 * k + 2] = _mm512_shuffle_ps::<0x44>(a1, b1);
            fours[4 * k + 3] = _mm512_shuffle_ps::<0xee>(a1, b1);
        }
        // Row 4 q + k has its fours in quarter q of the registers k, 4 + k, 8 + k and 12 + k.
        let mut rows = [_mm512_setzero_ps(); 16];
        for k in 0..4 {
            let even_low = _mm512_shuffle_f32x4::<0x88>(fours[k], fours[4 + k]);
            let even_high = _mm512_shuffle_f32x4::<0x88>(fours[8 + k], fours[12 + k]);
            let odd_low = _mm512_shuffle_f32x4::<0xdd>(fours[k], fours[4 + k]);
            let odd_high = _mm512_shuffle_f32x4::<0xdd>(fours[8 + k], fours[12 + k]);
            rows[k] = _mm512_shuffle_f32x4::<0x88>(even_low, even_high);
            rows[4 + k] = _mm512_shuffle_f32x4::<0x88>(odd_low, odd_high);
            rows[8 + k] = _mm512_shuffle_f32x4::<0xdd>(even_low, even_high);
            rows[12 + k] = _mm512_shuffle_f32x4::<0xdd>(odd_low, odd_high);
        }
        let mask = if count == 16 { u16::MAX } else { (1 << count) - 1 };
        for (row, &numbers) in rows.iter().enumerate().take(players) {
            _mm512_mask_storeu_ps(to.add(row * stride), mask, numbers);
        }
    }
}
