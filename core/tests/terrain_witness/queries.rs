//! Random places and paths, many of them where rounding decides: on edges, cuts, vertices and seams,
//! and one ulp to either side.

/// Squares that a path may lead beyond the places it starts at.
const REACH: i32 = 5;

use discjump_core::random::{Purpose, bits, unit};
use discjump_core::real::{Scalar, V3};
use discjump_core::terrain::{Edge, Heightfield, Surface};
use parry3d_f64::math::Vector;

/// A terrain seen by the generators of queries.
pub struct Queries<'a, T> {
    pub surface: Surface<'a, T>,
    size: f64,
    low: [i32; 2],
    high: [i32; 2],
    edge: Edge,
    /// Typical height differences, m.
    relief: f64,
    seed: u64,
    drawn: u32,
}

impl<'a, T: Scalar> Queries<'a, T> {
    pub fn new(field: &Heightfield, surface: Surface<'a, T>, seed: u64) -> Self {
        let whole = [field.cols() as i32 - 1, field.rows() as i32 - 1];
        // Beyond the rim of a clamped map there is more ground to be asked about.
        let beyond = if field.edge() == Edge::Clamp { 4 } else { 0 };
        let low = whole.map(|n| -(n / 2) - beyond);
        let high = [0, 1].map(|k| low[k] + whole[k] + 2 * beyond);
        let (edge, size) = (field.edge(), T::from_f64(field.square_size()).to_f64());
        Self { surface, size, low, high, edge, relief: size, seed, drawn: 0 }
    }

    pub fn unit(&mut self) -> f64 {
        self.drawn += 1;
        unit(self.seed, 0, Purpose::Goal, self.drawn)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.drawn += 1;
        bits(self.seed, 1, Purpose::Goal, self.drawn) % n
    }

    /// A number of squares between two, whole or not.
    fn squares(&mut self, low: i32, high: i32, whole: bool) -> f64 {
        let x = f64::from(low) + self.unit() * f64::from(high - low);
        if whole { x.round() } else { x }
    }

    /// A number, or one of its two neighbours.
    fn nudged(&mut self, x: f64) -> T {
        let x = T::from_f64(x);
        let which = self.below(3);
        let f32 = |x: f32| [x, x.next_up(), x.next_down()][which as usize];
        let f64 = |x: f64| [x, x.next_up(), x.next_down()][which as usize];
        if T::DOUBLE { T::from_f64(f64(x.to_f64())) } else { T::from_f64(f64::from(f32(x.to_f64() as f32))) }
    }

    /// A place of the map, in a range of squares.
    fn place_in(&mut self, low: [i32; 2], high: [i32; 2]) -> (T, T) {
        let size = self.size;
        let (x, y) = match self.below(8) {
            0..3 => (self.squares(low[0], high[0], false), self.squares(low[1], high[1], false)),
            3 => (self.squares(low[0], high[0], true), self.squares(low[1], high[1], false)),
            4 => (self.squares(low[0], high[0], false), self.squares(low[1], high[1], true)),
            5 => (self.squares(low[0], high[0], true), self.squares(low[1], high[1], true)),
            6 => {
                // On a cut, or on the other diagonal of the square.
                let (i, j) = (self.squares(low[0], high[0], true), self.squares(low[1], high[1], true));
                let along = self.unit();
                (i + along, j + if self.below(2) == 0 { along } else { 1.0 - along })
            }
            _ => {
                // On the rim, which is the seam between two tiles, where it is in range.
                let rim = if self.below(2) == 0 { self.low } else { self.high };
                let rim = [0, 1].map(|k| f64::from(rim[k].clamp(low[k], high[k])));
                let (x, y) = (self.squares(low[0], high[0], false), self.squares(low[1], high[1], false));
                if self.below(2) == 0 { (rim[0], y) } else { (x, rim[1]) }
            }
        };
        (self.nudged(x * size), self.nudged(y * size))
    }

    pub fn place(&mut self) -> (T, T) {
        self.place_in(self.low, self.high)
    }

    /// A place with ground, and its height.
    fn grounded(&mut self, low: [i32; 2], high: [i32; 2]) -> V3<T> {
        loop {
            let (x, y) = self.place_in(low, high);
            let ground = self.surface.ground::<T>(0, x, y);
            if ground.exists {
                return V3::new(x, y, ground.height);
            }
        }
    }

    /// A path that starts at the given height over the ground, and stays within the mesh: towards a
    /// place of the surface nearby, or past it, or straight down.
    pub fn path(&mut self, clearance: f64) -> (V3<T>, V3<T>) {
        let t = T::from_f64;
        let mut start = self.grounded(self.low, self.high);
        start.z = start.z + t(clearance);
        let span = [start.x, start.y].map(|x| (x.to_f64() / self.size).floor() as i32);
        let reach = if self.edge == Edge::Void { 30 } else { REACH };
        let low = [0, 1].map(|k| (span[k] - reach).max(self.low[k] - REACH));
        let high = [0, 1].map(|k| (span[k] + reach).min(self.high[k] + REACH));
        let end = match self.below(10) {
            0 => V3::new(start.x, start.y, start.z - t(clearance.abs() * 4.0 * self.unit())),
            1 => {
                // Along an axis or a diagonal.
                let far = self.size * 4.0 * self.unit();
                let [x, y] = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, -1.0]][self.below(4) as usize];
                let far = if self.below(2) == 0 { far } else { -far };
                let z = start.z + t((self.unit() - 0.7) * self.relief * 2.0);
                V3::new(start.x + t(x * far), start.y + t(y * far), z)
            }
            _ => {
                let mut end = if self.edge == Edge::Void {
                    self.grounded(self.low, self.high)
                } else {
                    self.grounded(low, high)
                };
                let off = [0.0, 0.0, -1.0, 1.0][self.below(4) as usize];
                end.z = end.z + t(off * self.unit() * self.relief);
                end
            }
        };
        let further = [1.0, 0.7, 1.4][self.below(3) as usize];
        (start, (end - start) * t(further))
    }
}

pub fn vector<T: Scalar>(v: V3<T>) -> Vector {
    Vector::new(v.x.to_f64(), v.y.to_f64(), v.z.to_f64())
}
