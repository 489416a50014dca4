//! What a mesh must be before a player may walk into it.

use super::shapes::THINNEST;
use super::solid::MAX_COORDINATE;
use crate::error::{InputError, refuse};
use crate::terrain::Grid;
use glam::DVec3;
use std::collections::HashMap;

/// Refuses vertices that are not finite, before and after they were placed, or too far away.
pub(super) fn vertices(given: &[DVec3], placed: &[DVec3], what: &str) -> Result<(), InputError> {
    if let Some(k) = given.iter().position(|v| !v.is_finite()) {
        refuse!("{what}: vertices: expected finite numbers, got {:?} at vertex {k}", given[k]);
    }
    let far = |v: &DVec3| !v.is_finite() || v.abs().max_element() > MAX_COORDINATE;
    if let Some(k) = placed.iter().position(far) {
        refuse!(
            "{what}: vertices: expected within +-{MAX_COORDINATE} m in the world, got {:?} at vertex {k}",
            placed[k]
        );
    }
    Ok(())
}

/// Refuses faces without their vertices, and no faces at all.
pub(super) fn faces(vertices: &[DVec3], faces: &[[u32; 3]], what: &str) -> Result<(), InputError> {
    if faces.is_empty() {
        refuse!("{what}: faces: expected at least one, got none");
    }
    let count = vertices.len();
    if let Some(k) = faces.iter().position(|f| f.iter().any(|&v| v as usize >= count)) {
        refuse!("{what}: faces: expected vertex numbers below {count}, got {:?} at face {k}", faces[k]);
    }
    Ok(())
}

/// The outward unit normal of a triangle; `None` if it is thinner than a micrometre.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let across = (b - a).cross(c - a);
    let twice_area = across.length();
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    (twice_area >= THINNEST * longest && twice_area > 0.0).then(|| across / twice_area)
}

/// The error for such a triangle.
pub(super) fn flat(corners: [DVec3; 3], face: usize, what: &str) -> InputError {
    InputError(format!(
        "{what}: faces: expected triangles at least {THINNEST} m thin, got one of no area at face {face}: {corners:?}"
    ))
}

/// Refuses a solid that lies wholly outside the map's rectangle.
pub(super) fn on_map(vertices: &[DVec3], map: &Grid, what: &str) -> Result<(), InputError> {
    let (from, size) = (map.origin, map.size());
    let bounds = |axis: usize| {
        vertices.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v[axis]), h.max(v[axis])))
    };
    for (axis, name) in ["x", "y"].iter().enumerate() {
        let (low, high) = bounds(axis);
        let (first, last) = (from[axis], from[axis] + size[axis]);
        if high < first || low > last {
            refuse!("{what}: expected on the map, {name} from {first} to {last} m, got {low} to {high} m");
        }
    }
    Ok(())
}

/// One side of a face: its vertices in ascending order, its face, and whether it runs that way.
type Side = (u32, u32, u32, bool);

/// Refuses holes, faces wound against their neighbours, and shells that are inside out.
pub(super) fn closed(vertices: &[DVec3], faces: &[[u32; 3]], what: &str) -> Result<(), InputError> {
    let welded = weld(vertices);
    let mut sides: Vec<Side> = Vec::with_capacity(3 * faces.len());
    for (k, face) in faces.iter().enumerate() {
        let corners = face.map(|v| welded[v as usize]);
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            if a == b {
                return Err(flat(face.map(|v| vertices[v as usize]), k, what));
            }
            sides.push((a.min(b), a.max(b), k as u32, a < b));
        }
    }
    sides.sort_unstable();
    let mut shells = Shells::new(faces.len());
    for edge in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let forward = edge.iter().filter(|side| side.3).count();
        let (a, b, face) = (vertices[edge[0].0 as usize], vertices[edge[0].1 as usize], edge[0].2);
        if edge.len() % 2 == 1 {
            refuse!(
                "{what}: faces: expected a closed mesh, got a hole at face {face}: its side from {a:?} to {b:?} has \
                 {} faces instead of 2",
                edge.len()
            );
        }
        if 2 * forward != edge.len() {
            refuse!(
                "{what}: faces: expected all counter-clockwise from outside, got face {face} wound against face {} \
                 along their side from {a:?} to {b:?}",
                edge[1].2
            );
        }
        edge.iter().for_each(|side| shells.join(face, side.2));
    }
    volumes(vertices, faces, &mut shells, what)
}

/// For each vertex the first one at the same place.
fn weld(vertices: &[DVec3]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(vertices.len());
    // + 0.0: -0 is the same place as 0.
    let bits = |v: &DVec3| v.to_array().map(|x| (x + 0.0).to_bits());
    vertices.iter().zip(0..).map(|(v, k)| *first.entry(bits(v)).or_insert(k)).collect()
}

/// A shell: faces that hang together by their sides.
#[derive(Clone, Copy)]
struct Shell {
    volume: f64,
    area: f64,
    low: DVec3,
    high: DVec3,
}

/// Refuses shells that enclose nothing, and those inside out unless they are a cavity in another.
fn volumes(
    vertices: &[DVec3],
    faces: &[[u32; 3]],
    shells: &mut Shells,
    what: &str,
) -> Result<(), InputError> {
    let empty = Shell { volume: 0.0, area: 0.0, low: DVec3::MAX, high: DVec3::MIN };
    let mut found: HashMap<u32, Shell> = HashMap::new();
    let origin = vertices[faces[0][0] as usize];
    for (face, k) in faces.iter().zip(0..) {
        let [a, b, c] = face.map(|v| vertices[v as usize]);
        let shell = found.entry(shells.root(k)).or_insert(empty);
        let (u, v, w) = (a - origin, b - origin, c - origin);
        shell.volume += u.dot(v.cross(w)) / 6.0;
        shell.area += (v - u).cross(w - u).length() / 2.0;
        shell.low = shell.low.min(a).min(b).min(c);
        shell.high = shell.high.max(a).max(b).max(c);
    }
    // By their first faces, which are their roots.
    let mut found: Vec<(u32, Shell)> = found.into_iter().collect();
    found.sort_unstable_by_key(|shell| shell.0);
    let holds = |outer: &Shell, inner: &Shell| {
        outer.volume > 0.0 && outer.low.cmple(inner.low).all() && outer.high.cmpge(inner.high).all()
    };
    for (face, shell) in &found {
        let rounding = 1e-12 * shell.area * (shell.high - shell.low).length();
        if shell.volume.abs() <= rounding {
            refuse!("{what}: faces: expected a volume, got none within the shell of face {face}");
        }
        if shell.volume < 0.0 && !found.iter().any(|(_, outer)| holds(outer, shell)) {
            refuse!(
                "{what}: faces: expected all counter-clockwise from outside, got the shell of face {face} inside out: \
                 it encloses {} m^3",
                shell.volume
            );
        }
    }
    Ok(())
}

/// Which faces hang together: each points to an earlier one, a shell's first to itself.
struct Shells(Vec<u32>);

impl Shells {
    fn new(faces: usize) -> Self {
        Self((0..faces as u32).collect())
    }

    fn root(&mut self, mut face: u32) -> u32 {
        while self.0[face as usize] != face {
            let above = self.0[face as usize];
            self.0[face as usize] = self.0[above as usize];
            face = above;
        }
        face
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
