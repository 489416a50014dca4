//! Observations on their way from columns, in which lanes hold players, to rows in memory.

use super::CLIP;
use crate::real::Real;

/// Room for columns: one for many rows, since to clear it takes longer than to fill it.
#[derive(Clone, Copy)]
pub struct Columns<R: Real>([R::Each<R>; 2]);

impl<R: Real> Default for Columns<R> {
    #[inline(always)]
    fn default() -> Self {
        Self([R::every(R::zero()); 2])
    }
}

/// Rows of some players, filled column by column.
pub(super) struct Rows<'a, R: Real> {
    numbers: &'a mut [f32],
    players: usize,
    stride: usize,
    /// Column of the first pending one.
    at: usize,
    /// So many columns are pending.
    count: usize,
    /// The pending columns, and those that were written last.
    columns: &'a mut [R::Each<R>; 2],
    pending: usize,
}

impl<'a, R: Real> Rows<'a, R> {
    /// The rows of the first `players` lanes, `stride` numbers each.
    #[inline(always)]
    pub(super) fn new(
        numbers: &'a mut [f32],
        stride: usize,
        players: usize,
        Columns(columns): &'a mut Columns<R>,
    ) -> Self {
        Self { numbers, players, stride, at: 0, count: 0, columns, pending: 0 }
    }

    /// The next column, scaled and clipped; a NaN stays one.
    #[inline(always)]
    pub(super) fn push(&mut self, x: R, scale: R) {
        let clip = R::lit(f64::from(CLIP));
        let scaled = x * scale;
        let high = R::select(clip.lt(scaled), clip, scaled);
        self.columns[self.pending].as_mut()[self.count] = R::select(high.lt(-clip), -clip, high);
        self.count += 1;
        if self.count == R::LANES {
            self.write(self.count, self.at);
            self.at += R::LANES;
            self.count = 0;
            self.pending = 1 - self.pending;
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
            self.write(self.count, 0);
            return;
        }
        // Some of the columns before them once more: a whole register is stored much faster than a part.
        let shift = R::LANES - self.count;
        for k in (0..self.count).rev() {
            let column = self.columns[self.pending].as_ref()[k];
            self.columns[self.pending].as_mut()[shift + k] = column;
        }
        for k in 0..shift {
            let column = self.columns[1 - self.pending].as_ref()[self.count + k];
            self.columns[self.pending].as_mut()[k] = column;
        }
        self.write(R::LANES, end - R::LANES);
    }

    #[inline(always)]
    fn write(&mut self, count: usize, at: usize) {
        let columns = &self.columns[self.pending];
        R::write_rows(columns, count, self.numbers, self.stride, at, self.players);
    }
}
