//! The broad phase: a grid over the ground that tells, with one load, who is far from every solid.

use super::triangle::Triangle;
use crate::real::{Int, Mask, Real, V3, same_type};
use glam::{DVec2, DVec3, Vec3Swizzles};

/// Least side of a cell, m.
const CELL: f64 = 16.0;
/// Most cells along a side of the grid.
const MOST: usize = 256;
/// Most cells along a side that one triangle is drawn into, before it goes to a coarser level.
const DRAWN: usize = 16;
/// More than lanes may lose to the rounding of f32 within some kilometres of the map's centre, m.
const ROUNDED: f64 = 0.01;
/// Added around every triangle against rounding, m.
const SLACK: f64 = 1e-3;

/// The lowest and the highest that stands in a cell or near it, m.
type Range = [f32; 2];
const NOTHING: Range = [f32::INFINITY, f32::NEG_INFINITY];

fn join(a: Range, b: Range) -> Range {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Heights of what stands within [`Near::MARGIN`] of each cell.
#[derive(Clone, Debug)]
pub(super) struct Near {
    low: DVec2,
    inverse: f64,
    cols: usize,
    rows: usize,
    cells: Vec<Range>,
    /// South-west and north-east corner of all that stands.
    bounds: (DVec2, DVec2),
}

impl Near {
    /// Largest reach that the grid answers for, m: a tick of 32 ms at 400 m/s and a heavy's box.
    pub(super) const MARGIN: f64 = 16.0;

    pub(super) fn new(triangles: &[Triangle]) -> Self {
        let low = triangles.iter().fold(DVec3::MAX, |m, t| m.min(t.low())).xy() - Self::MARGIN - SLACK;
        let high = triangles.iter().fold(DVec3::MIN, |m, t| m.max(t.high())).xy() + Self::MARGIN + SLACK;
        if triangles.is_empty() {
            let bounds = (DVec2::MAX, DVec2::MIN);
            return Self { low: DVec2::ZERO, inverse: 1.0, cols: 0, rows: 0, cells: Vec::new(), bounds };
        }
        let bounds = (low + Self::MARGIN, high - Self::MARGIN);
        let size = CELL.max((high - low).max_element() / (MOST - 1) as f64);
        let [cols, rows] = (high - low).to_array().map(|side| (side / size) as usize + 1);
        let drawing = Drawing::new(triangles, low, size, cols, rows);
        let spread = (Self::MARGIN / size).ceil() as usize;
        let mut cells = dilated(&drawing.cells(), cols, rows, spread);
        // Lanes read a cell together with the next one.
        cells.push(NOTHING);
        Self { low, inverse: 1.0 / size, cols, rows, cells, bounds }
    }

    pub(super) fn bytes(&self) -> usize {
        self.cells.len() * size_of::<Range>()
    }

    /// Who is farther from everything than a reach, with all that lies between two corners in m from
    /// `centre`. For lanes.
    #[inline(always)]
    pub(super) fn beyond<R: Real>(&self, centre: DVec2, (low, high): (V3<R>, V3<R>), reach: R) -> R::Mask {
        // A part of the reach too: f32 rounds a large one by more than the slack.
        let reach = reach * R::lit(1.0001) + R::lit(ROUNDED);
        let (from, to) = (self.bounds.0 - centre, self.bounds.1 - centre);
        let east_or_north = R::lit(to.x).lt(low.x - reach).or(R::lit(to.y).lt(low.y - reach));
        let west_or_south = (high.x + reach).lt(R::lit(from.x)).or((high.y + reach).lt(R::lit(from.y)));
        east_or_north.or(west_or_south)
    }

    /// Who may have anything within reach along each axis, of players at a place in m from `centre`: all
    /// whom [`Near::close`] would name, and few others. For lanes, in f32, whose rounding within some
    /// kilometres is far below the slack.
    #[inline(always)]
    pub(super) fn may_be_close<R: Real>(&self, centre: DVec2, place: V3<R>, reach: R) -> R::Mask {
        let reach = reach + R::lit(ROUNDED);
        let far = R::lit(Self::MARGIN).lt(reach);
        let low = self.low - centre;
        let u = (place.x - R::lit(low.x)) * R::lit(self.inverse);
        let v = (place.y - R::lit(low.y)) * R::lit(self.inverse);
        let (i, j) = (u.floor_int(), v.floor_int());
        let (zero, cols, rows) = (R::Int::splat(0), self.cols as i32, self.rows as i32);
        let outside = i.lt(zero).or(R::Int::splat(cols - 1).lt(i));
        let outside = outside.or(j.lt(zero)).or(R::Int::splat(rows - 1).lt(j));
        if !outside.not().any() {
            return far;
        }
        let cell = j.clamp(0, rows - 1) * R::Int::splat(cols) + i.clamp(0, cols - 1);
        let [lowest, highest, _, _] = R::gather_square(same_type(&self.cells), cell);
        let clear = (place.z + reach).lt(lowest).or(highest.lt(place.z - reach));
        far.or(outside.or(clear).not())
    }

    /// Whether anything stands within `reach`, at most the margin, of a point along each axis.
    #[inline]
    pub(super) fn close(&self, x: f64, y: f64, z: f64, reach: f64) -> bool {
        let (u, v) = ((x - self.low.x) * self.inverse, (y - self.low.y) * self.inverse);
        if !(u >= 0.0 && v >= 0.0 && u < self.cols as f64 && v < self.rows as f64) {
            return false;
        }
        let [lowest, highest] = self.cells[v as usize * self.cols + u as usize];
        z + reach >= f64::from(lowest) && z - reach <= f64::from(highest)
    }
}

/// Each cell with those up to `spread` away.
fn dilated(cells: &[Range], cols: usize, rows: usize, spread: usize) -> Vec<Range> {
    let along = |cells: &[Range], count: usize, step: usize| -> Vec<Range> {
        (0..cells.len())
            .map(|at| {
                let k = at / step % count;
                let (first, last) = (k - spread.min(k), (k + spread).min(count - 1));
                (first..=last).fold(NOTHING, |m, i| join(m, cells[at - k * step + i * step]))
            })
            .collect()
    };
    along(&along(cells, cols, 1), rows, cols)
}

/// Levels of ever coarser cells: a triangle is drawn where it covers few of them, so that no number of
/// large ones takes long.
struct Drawing {
    cols: usize,
    rows: usize,
    levels: Vec<Vec<Range>>,
}

impl Drawing {
    fn new(triangles: &[Triangle], low: DVec2, size: f64, cols: usize, rows: usize) -> Self {
        let levels =
            (0..=MOST.ilog2()).map(|l| vec![NOTHING; (cols.div_ceil(1 << l)) * (rows.div_ceil(1 << l))]);
        let mut drawing = Self { cols, rows, levels: levels.collect() };
        triangles.iter().for_each(|t| drawing.draw(t, low, size));
        drawing
    }

    fn draw(&mut self, triangle: &Triangle, low: DVec2, size: f64) {
        let (from, to) = (triangle.low() - SLACK, triangle.high() + SLACK);
        let range = [(from.z as f32).next_down(), (to.z as f32).next_up()];
        let corners = triangle.corners.map(|c| c.xy() - low);
        let (mut level, mut size) = (0, size);
        let cell = |x: f64, size: f64| (x.max(0.0) / size) as usize;
        let cells = |size: f64| {
            let (first, last) = (from.xy() - low, to.xy() - low);
            (cell(first.x, size)..=cell(last.x, size), cell(first.y, size)..=cell(last.y, size))
        };
        let (mut columns, mut lines) = cells(size);
        while columns.end() - columns.start() >= DRAWN || lines.end() - lines.start() >= DRAWN {
            level += 1;
            size *= 2.0;
            (columns, lines) = cells(size);
        }
        let width = self.cols.div_ceil(1 << level);
        for j in lines {
            for i in columns.clone() {
                if touches(&corners, DVec2::new(i as f64, j as f64) * size, size) {
                    let at = &mut self.levels[level][j * width + i];
                    *at = join(*at, range);
                }
            }
        }
    }

    /// The finest level, with all that was drawn above it.
    fn cells(mut self) -> Vec<Range> {
        for level in (1..self.levels.len()).rev() {
            let (wide, width) = (self.cols.div_ceil(1 << level), self.cols.div_ceil(1 << (level - 1)));
            let (finer, coarser) = self.levels.split_at_mut(level);
            for (k, cell) in finer[level - 1].iter_mut().enumerate() {
                *cell = join(*cell, coarser[0][(k / width / 2) * wide + k % width / 2]);
            }
        }
        debug_assert_eq!(self.levels[0].len(), self.cols * self.rows);
        self.levels.swap_remove(0)
    }
}

/// Whether a triangle seen from above comes within [`SLACK`] of a square, whose bounds its own meet already.
fn touches(corners: &[DVec2; 3], corner: DVec2, size: f64) -> bool {
    let middle = corner + 0.5 * size;
    (0..3).all(|k| {
        let across = (corners[(k + 1) % 3] - corners[k]).perp();
        let reach = (0.5 * size + SLACK) * (across.x.abs() + across.y.abs());
        let at = corners.map(|c| (c - middle).dot(across));
        at[0].min(at[1]).min(at[2]) <= reach && at[0].max(at[1]).max(at[2]) >= -reach
    })
}
