//! Terrains and paths.

use crate::common::random::Random;
use crate::witness::Witness;
use discjump_core::real::{Scalar, V3};
use discjump_core::terrain::{Edge, Heightfield, SurfaceKind};

pub struct World {
    pub name: &'static str,
    pub field: Heightfield,
    /// Height differences between neighbours, m.
    pub relief: f64,
}

/// Heights drawn uniformly from 0 to `relief`; repeated at the rim where the map tiles.
fn rough(seed: u64, cols: usize, rows: usize, size: f64, relief: f64, edge: Edge) -> Heightfield {
    let mut random = Random::new(seed);
    let drawn: Vec<f64> = (0..rows * cols).map(|_| random.within(0.0, relief)).collect();
    let heights = (0..rows * cols)
        .map(|k| {
            let (i, j) = (k % cols, k / cols);
            let (i, j) = if edge == Edge::Tile { (i % (cols - 1), j % (rows - 1)) } else { (i, j) };
            drawn[j * cols + i]
        })
        .collect();
    let field = Heightfield::new(heights, rows, cols, size, [0.0, 0.0], edge).unwrap();
    field.with_surface(SurfaceKind::Bilinear)
}

pub fn worlds() -> Vec<World> {
    let world = |name, relief, field| World { name, relief, field };
    let field = rough;
    vec![
        world("gentle, tile", 2.0, field(1, 17, 17, 8.0, 2.0, Edge::Tile)),
        world("rough, tile", 15.0, field(2, 17, 17, 8.0, 15.0, Edge::Tile)),
        world("odd sides, tile", 15.0, field(3, 14, 18, 8.0, 15.0, Edge::Tile)),
        world("odd sides, clamp", 15.0, field(4, 17, 24, 8.0, 15.0, Edge::Clamp)),
        world("2 x 2, clamp", 15.0, field(5, 2, 2, 8.0, 15.0, Edge::Clamp)),
        world("odd sides, void", 15.0, field(6, 24, 17, 8.0, 15.0, Edge::Void)),
        world("spikes to 89 degrees", 500.0, field(7, 17, 17, 8.0, 500.0, Edge::Tile)),
        world("squares of 0.01 m", 0.02, field(8, 17, 17, 0.01, 0.02, Edge::Clamp)),
        world("squares of 1000 m", 1900.0, field(9, 17, 16, 1000.0, 1900.0, Edge::Tile)),
    ]
}

/// Random places and paths, many of them where rounding decides.
pub struct Paths<'a> {
    pub world: &'a World,
    witness: &'a Witness,
    random: Random,
}

impl<'a> Paths<'a> {
    pub fn new(world: &'a World, witness: &'a Witness, seed: u64) -> Self {
        Self { world, witness, random: Random::new(seed) }
    }

    /// A number of squares, whole in some cases.
    fn squares(&mut self, low: f64, high: f64) -> f64 {
        let x = self.random.within(low, high);
        if self.random.index(4) == 0 { x.round() } else { x }
    }

    /// A local place: anywhere, on a side, on a vertex or one ulp beside it.
    pub fn place<T: Scalar>(&mut self) -> (T, T) {
        let size = self.witness.size;
        let [x, y] = [0, 1].map(|axis| {
            let (low, high) = self.witness.span(axis);
            let x = T::from_f64(self.squares(low, high) * size);
            let which = self.random.index(3);
            if T::DOUBLE {
                let x = x.to_f64();
                T::from_f64([x, x.next_up(), x.next_down()][which])
            } else {
                let x = x.to_f64() as f32;
                T::from_f64(f64::from([x, x.next_up(), x.next_down()][which]))
            }
        });
        (x, y)
    }

    /// A start, above the ground, on it or below it, and a path, in the arithmetic of `T`.
    pub fn path<T: Scalar>(&mut self) -> (V3<T>, V3<T>) {
        let t = T::from_f64;
        let (size, relief) = (self.witness.size, self.world.relief);
        let (x, y) = loop {
            let (x, y) = self.place::<T>();
            if self.witness.height(x.to_f64(), y.to_f64()).is_some() {
                break (x, y);
            }
        };
        let ground = self.witness.height(x.to_f64(), y.to_f64()).unwrap();
        let reach = size * [0.02, 0.15, 1.0, 5.0, 25.0][self.random.index(5)];
        let (mut dx, mut dy) = (reach * self.random.wide(), reach * self.random.wide());
        match self.random.index(8) {
            0 => dx = 0.0,
            1 => dy = 0.0,
            2 => (dx, dy) = (0.0, 0.0),
            _ => {}
        }
        let end = self.witness.height(x.to_f64() + dx, y.to_f64() + dy).unwrap_or(ground);
        let some = relief * self.random.within(0.0, 1.0).powi(3);
        let (lift, fall) = match self.random.index(6) {
            // From above to below, or to just above.
            0 => (some, -relief * self.random.wide()),
            1 => (some, relief * 1e-3 * self.random.wide()),
            // Along the ground.
            2 => (0.0, 0.0),
            3 => (relief * 1e-3 * self.random.wide(), relief * 1e-3 * self.random.wide()),
            // From below.
            4 => (-some, relief * self.random.wide()),
            _ => (some, -some),
        };
        let along = self.random.index(3) == 0;
        let z = t(ground + lift);
        let mut path = V3::new(t(dx), t(dy), t(end + fall - z.to_f64()));
        if along {
            // Along the tangent of the start, so that it bends away or dips and comes back.
            let [sx, sy] = self.witness.slopes(x.to_f64(), y.to_f64());
            path.z = t(sx * dx + sy * dy + fall);
        }
        (V3::new(x, y, z), path)
    }
}
