//! Observations on their way from columns, in which lanes hold players, to rows in memory.

use super::CLIP;
use crate::real::Real;

/// Rows of some players, filled column by column.
pub(super) struct Rows<'a, R: Real> {
    numbers: &'a mut [f32],
    players: usize,
    stride: usize,
    /// Column of the first pending one.
    at: usize,
    /// So many columns are pending.
    count: usize,
    pending: R::Each<R>,
    /// The columns written last.
    written: R::Each<R>,
}

impl<'a, R: Real> Rows<'a, R> {
    /// The rows of the first `players` lanes, `stride` numbers each.
    #[inline(always)]
    pub(super) fn new(numbers: &'a mut [f32], stride: usize, players: usize) -> Self {
        let none = R::every(R::zero());
        Self { numbers, players, stride, at: 0, count: 0, pending: none, written: none }
    }

    /// The next column, scaled and clipped; a NaN stays one.
    #[inline(always)]
    pub(super) fn push(&mut self, x: R, scale: R) {
        let clip = R::lit(f64::from(CLIP));
        let scaled = x * scale;
        let high = R::select(clip.lt(scaled), clip, scaled);
        self.pending.as_mut()[self.count] = R::select(high.lt(-clip), -clip, high);
        self.count += 1;
        if self.count == R::LANES {
            R::write_rows(&self.pending, self.count, self.numbers, self.stride, self.at, self.players);
            self.written = self.pending;
            self.at += R::LANES;
            self.count = 0;
        }
    }

    /// Writes what is pending.
    ///
    /// # Panics
    /// If the rows are longer than what was pushed.
    #[inline(always)]
    pub(super) fn finish(mut self) {
        let end = self.at + self.count;
        assert_eq!(end, self.stride, "numbers pushed, and the length of a row");
        if self.count == 0 {
            return;
        }
        if self.at == 0 {
            R::write_rows(&self.pending, self.count, self.numbers, self.stride, 0, self.players);
            return;
        }
        // Some of the columns before them once more: a whole register is stored much faster than a part.
        for k in (0..self.count).rev() {
            self.pending.as_mut()[R::LANES - self.count + k] = self.pending.as_ref()[k];
        }
        for k in 0..R::LANES - self.count {
            self.pending.as_mut()[k] = self.written.as_ref()[self.count + k];
        }
        let first = end - R::LANES;
        R::write_rows(&self.pending, R::LANES, self.numbers, self.stride, first, self.players);
    }
}
