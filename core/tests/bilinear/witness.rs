//! The surface and the rule of contacts (docs/physics.md, sections 5 and 8) once more, in f64, with nothing
//! shared with what is tested: weights instead of slopes, all grid lines under a path instead of a walk, and
//! ternary search and bisection instead of roots.

use discjump_core::real::Scalar;
use discjump_core::terrain::{Edge, Heightfield};

pub type Vector = [f64; 3];

pub struct Witness {
    heights: Vec<f64>,
    cols: i64,
    rows: i64,
    edge: Edge,
    pub size: f64,
    /// Column and row of local (0, 0).
    centre: [i64; 2],
}

/// A stretch of a path within one square along which the gap only falls, or only rises.
struct Slide {
    from: f64,
    to: f64,
    /// Gap at both ends.
    gaps: [f64; 2],
}

/// A first contact: fraction of the path.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    pub at: f64,
}

impl Witness {
    /// The numbers as the arithmetic `T` has them.
    pub fn new<T: Scalar>(field: &Heightfield) -> Self {
        let (cols, rows) = (field.cols() as i64, field.rows() as i64);
        Self {
            heights: field.heights().iter().map(|&h| T::from_f64(h).to_f64()).collect(),
            cols,
            rows,
            edge: field.edge(),
            size: T::from_f64(field.square_size()).to_f64(),
            centre: [(cols - 1) / 2, (rows - 1) / 2],
        }
    }

    /// Squares to ask about, from the local origin.
    pub fn span(&self, axis: usize) -> (f64, f64) {
        let n = [self.cols, self.rows][axis] - 1;
        let beyond = if self.edge == Edge::Void { 0 } else { 3 };
        ((-self.centre[axis] - beyond) as f64, (n - self.centre[axis] + beyond) as f64)
    }

    fn vertex(&self, i: i64, j: i64) -> f64 {
        let (i, j) = match self.edge {
            Edge::Tile => (i.rem_euclid(self.cols - 1), j.rem_euclid(self.rows - 1)),
            Edge::Clamp | Edge::Void => (i.clamp(0, self.cols - 1), j.clamp(0, self.rows - 1)),
        };
        self.heights[(j * self.cols + i) as usize]
    }

    /// South-western, south-eastern, north-western and north-eastern corner of a square; None where there is
    /// no ground.
    fn corners(&self, i: i64, j: i64) -> Option<[f64; 4]> {
        let outside = i < 0 || j < 0 || i >= self.cols - 1 || j >= self.rows - 1;
        if outside && self.edge == Edge::Void {
            return None;
        }
        Some([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(a, b)| self.vertex(i + a, j + b)))
    }

    /// The square of a local place, and the place within it, 0 to 1.
    fn locate(&self, x: f64, y: f64) -> ([i64; 2], [f64; 2]) {
        let squares = [(x / self.size).floor(), (y / self.size).floor()];
        let within = [x / self.size - squares[0], y / self.size - squares[1]];
        ([0, 1].map(|k| squares[k] as i64 + self.centre[k]), within)
    }

    pub fn height(&self, x: f64, y: f64) -> Option<f64> {
        let ([i, j], [u, v]) = self.locate(x, y);
        Some(weighed(self.corners(i, j)?, u, v))
    }

    /// dz/dx and dz/dy.
    pub fn slopes(&self, x: f64, y: f64) -> [f64; 2] {
        let ([i, j], within) = self.locate(x, y);
        tilt(self.corners(i, j).expect("ground"), within, self.size)
    }

    /// Where a path crosses lines of the grid, its start and its end, in order.
    fn cuts(&self, start: Vector, path: Vector) -> Vec<f64> {
        let mut cuts = vec![0.0, 1.0];
        for axis in 0..2 {
            let (a, b) = (start[axis] / self.size, (start[axis] + path[axis]) / self.size);
            let (low, high) = (a.min(b).floor() as i64, a.max(b).ceil() as i64);
            let lines = (low..=high).map(|k| (k as f64 * self.size - start[axis]) / path[axis]);
            cuts.extend(lines.filter(|t| (0.0..=1.0).contains(t)));
        }
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    /// Where a path that has come so far leaves its square, or ends.
    pub fn leaves(&self, start: Vector, path: Vector, from: f64) -> f64 {
        self.cuts(start, path).into_iter().find(|&t| t > from).unwrap_or(1.0)
    }

    /// Stretches of more than `sliver` of the path.
    fn slides(&self, start: Vector, path: Vector, sliver: f64) -> Vec<Slide> {
        let cuts = self.cuts(start, path);
        let mut slides = Vec::new();
        for pair in cuts.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            if to - from <= sliver {
                continue;
            }
            let at = |t: f64| [0, 1, 2].map(|k| start[k] + path[k] * t);
            let middle = at(0.5 * (from + to));
            let ([i, j], _) = self.locate(middle[0], middle[1]);
            let Some(corners) = self.corners(i, j) else { continue };
            let low = [(i - self.centre[0]) as f64 * self.size, (j - self.centre[1]) as f64 * self.size];
            let gap = |t: f64| {
                let p = at(t);
                p[2] - weighed(corners, (p[0] - low[0]) / self.size, (p[1] - low[1]) / self.size)
            };
            // A quadratic has one extremum: searched for as a lowest and as a highest point.
            let lowest = ternary(&gap, from, to);
            let highest = ternary(&|t| -gap(t), from, to);
            let mut ends = vec![from, lowest.min(highest), lowest.max(highest), to];
            ends.dedup();
            for ends in ends.windows(2) {
                slides.push(Slide { from: ends[0], to: ends[1], gaps: [gap(ends[0]), gap(ends[1])] });
            }
        }
        slides
    }

    fn crossing(&self, start: Vector, path: Vector, slide: &Slide) -> f64 {
        let (mut low, mut high) = (slide.from, slide.to);
        let above = slide.gaps[0] > 0.0;
        for _ in 0..64 {
            let middle = 0.5 * (low + high);
            let p = [0, 1, 2].map(|k| start[k] + path[k] * middle);
            let Some(ground) = self.height(p[0], p[1]) else { break };
            if (p[2] - ground > 0.0) == above { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// First place where the path is on or below the surface and moves into it.
    pub fn sweep(&self, start: Vector, path: Vector, sliver: f64) -> Option<Met> {
        for slide in self.slides(start, path, sliver) {
            let [before, after] = slide.gaps;
            if after < before && before <= 0.0 {
                return Some(Met { at: slide.from });
            }
            if after < before && after < 0.0 {
                let at = self.crossing(start, path, &slide);
                return Some(Met { at });
            }
        }
        None
    }

    /// First place where the path goes from above to below or back; the surface itself counts as below.
    pub fn line(&self, start: Vector, path: Vector, sliver: f64) -> Option<Met> {
        for slide in self.slides(start, path, sliver) {
            let [before, after] = slide.gaps;
            if (before > 0.0 && after < 0.0) || (before <= 0.0 && after > 0.0) {
                let at = self.crossing(start, path, &slide);
                return Some(Met { at });
            }
        }
        None
    }
}

fn weighed([sw, se, nw, ne]: [f64; 4], u: f64, v: f64) -> f64 {
    sw * (1.0 - u) * (1.0 - v) + se * u * (1.0 - v) + nw * (1.0 - u) * v + ne * u * v
}

fn tilt([sw, se, nw, ne]: [f64; 4], [u, v]: [f64; 2], size: f64) -> [f64; 2] {
    let x = ((se - sw) * (1.0 - v) + (ne - nw) * v) / size;
    let y = ((nw - sw) * (1.0 - u) + (ne - se) * u) / size;
    [x, y]
}

fn ternary(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let (from, to) = (low, high);
    for _ in 0..60 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if f(a) < f(b) { high = b } else { low = a }
    }
    // The search stops a hair short of an end, where rounding may be lower than the end itself.
    let (middle, hair) = (0.5 * (low + high), 1e-9 * (to - from));
    let inside = middle - from > hair && to - middle > hair;
    let places = if inside { vec![from, to, middle] } else { vec![from, to] };
    places.into_iter().min_by(|a, b| f(*a).total_cmp(&f(*b))).unwrap()
}
