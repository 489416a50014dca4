//! The triangles of a terrain, laid out by the rules of docs/physics.md, section 8, for parry3d.

use discjump_core::real::Scalar;
use discjump_core::terrain::{Edge, Heightfield};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::TriMesh;

pub type Triangle = [Vector; 3];

/// Squares laid out beyond every rim of a map that does not end there.
pub const MARGIN: i32 = 14;

pub struct Mesh {
    /// Two per square, counter-clockwise from above, square by square, row by row.
    triangles: Vec<Triangle>,
    pub shape: TriMesh,
    first: [i32; 2],
    squares: [i32; 2],
    pub size: f64,
}

/// Height of a vertex, by its column and row, which may lie outside the map.
fn height<T: Scalar>(field: &Heightfield, i: i32, j: i32) -> f64 {
    let (cols, rows) = (field.cols() as i32, field.rows() as i32);
    let (i, j) = match field.edge() {
        Edge::Tile => (i.rem_euclid(cols - 1), j.rem_euclid(rows - 1)),
        Edge::Clamp | Edge::Void => (i.clamp(0, cols - 1), j.clamp(0, rows - 1)),
    };
    T::from_f64(field.heights()[(j * cols + i) as usize]).to_f64()
}

/// Whether a square is cut from its low corner to its high one.
fn cut_upwards(field: &Heightfield, i: i32, j: i32) -> bool {
    let (i, j) = match field.edge() {
        Edge::Tile => (i.rem_euclid(field.cols() as i32 - 1), j.rem_euclid(field.rows() as i32 - 1)),
        Edge::Clamp | Edge::Void => (i, j),
    };
    (i + j) % 2 == 0
}

impl Mesh {
    /// In local coordinates: metres from the vertex nearest the map's centre, and in the arithmetic
    /// of `T`: the heights and the square size are rounded to it.
    pub fn new<T: Scalar>(field: &Heightfield) -> Self {
        let margin = if field.edge() == Edge::Void { 0 } else { MARGIN };
        let size = T::from_f64(field.square_size()).to_f64();
        let whole = [field.cols() as i32 - 1, field.rows() as i32 - 1];
        let first = [-margin, -margin];
        let squares = whole.map(|n| n + 2 * margin);
        let vertex = |i: i32, j: i32| {
            let x = f64::from(i - whole[0] / 2) * size;
            let y = f64::from(j - whole[1] / 2) * size;
            Vector::new(x, y, height::<T>(field, i, j))
        };
        let mut triangles = Vec::new();
        for j in first[1]..first[1] + squares[1] {
            for i in first[0]..first[0] + squares[0] {
                let [sw, se] = [vertex(i, j), vertex(i + 1, j)];
                let [nw, ne] = [vertex(i, j + 1), vertex(i + 1, j + 1)];
                if cut_upwards(field, i, j) {
                    triangles.extend([[sw, se, ne], [sw, ne, nw]]);
                } else {
                    triangles.extend([[sw, se, nw], [se, ne, nw]]);
                }
            }
        }
        let vertices = triangles.iter().flatten().copied().collect();
        let indices = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let shape = TriMesh::new(vertices, indices).unwrap();
        let first = [first[0] - whole[0] / 2, first[1] - whole[1] / 2];
        Self { triangles, shape, first, squares, size }
    }

    /// The triangles of every square that the path may touch, and of one more on all sides.
    pub fn near(&self, start: Vector, path: Vector) -> impl Iterator<Item = &Triangle> {
        let end = start + path;
        let span = |axis: usize| {
            let (low, high) = (start[axis].min(end[axis]), start[axis].max(end[axis]));
            let at = |x: f64| (x / self.size).floor() as i32 - self.first[axis];
            (at(low) - 1).max(0)..(at(high) + 2).min(self.squares[axis])
        };
        let (columns, rows) = (span(0), span(1));
        rows.flat_map(move |j| columns.clone().map(move |i| j * self.squares[0] + i))
            .flat_map(|k| &self.triangles[2 * k as usize..2 * k as usize + 2])
    }
}

/// The unit normal of a triangle, upwards.
pub fn normal(t: &Triangle) -> Vector {
    (t[1] - t[0]).cross(t[2] - t[0]).normalize()
}
