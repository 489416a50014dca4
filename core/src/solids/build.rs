//! All solids of one map, checked and built for queries.

use super::check;
use super::near::Near;
use super::shapes;
use super::solid::{MAX_TRIANGLES, Shape, Solid};
use super::triangle::Triangle;
use crate::error::{InputError, refuse};
use crate::real::{Real, V3};
use crate::terrain::Grid;
use glam::{DVec2, DVec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use xxhash_rust::xxh3::Xxh3;

/// The solids of one map: triangles under a bounding volume hierarchy, and a grid that tells who is far from
/// all of them. Nothing in it changes after it was built.
#[derive(Clone, Debug)]
pub struct Solids {
    names: Vec<String>,
    triangles: Vec<Triangle>,
    bvh: Bvh,
    near: Near,
    digest: u128,
}

impl Default for Solids {
    fn default() -> Self {
        Self::built(Vec::new(), Vec::new())
    }
}

impl Solids {
    /// Checks and builds the solids that stand on a map.
    ///
    /// # Errors
    /// Names the solid, and the face where there is one, of: sides, points or vertices that are not finite or
    /// end up beyond [`super::MAX_COORDINATE`]; a placement that is not finite, turned by no unit quaternion or
    /// scaled by no positive number; boxes and hulls without volume; faces with a vertex that there is not, or
    /// thinner than a micrometre; holes; faces wound against their neighbours; meshes inside out; a solid
    /// wholly outside the map's rectangle; more than [`MAX_TRIANGLES`] triangles in all.
    pub fn new(solids: &[Solid], map: &Grid) -> Result<Self, InputError> {
        let mut triangles = Vec::new();
        for (number, solid) in solids.iter().enumerate() {
            let what = format!("solids[{number}] \"{}\"", solid.name);
            append(&mut triangles, solid, number, map, &what)?;
        }
        Ok(Self::built(solids.iter().map(|s| s.name.clone()).collect(), triangles))
    }

    fn built(names: Vec<String>, triangles: Vec<Triangle>) -> Self {
        let bounds: Vec<Aabb> = triangles.iter().map(|t| Aabb::new(t.low(), t.high())).collect();
        let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &bounds);
        let near = Near::new(&triangles);
        let mut digest = Xxh3::new();
        digest.update(&(names.len() as u64).to_le_bytes());
        for t in &triangles {
            digest.update(&t.solid.to_le_bytes());
            for x in t.corners.iter().flat_map(DVec3::to_array) {
                digest.update(&(x + 0.0).to_le_bytes());
            }
        }
        Self { names, triangles, bvh, near, digest: digest.digest128() }
    }

    /// How many solids there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// What a solid is called.
    #[must_use]
    pub fn name(&self, solid: u32) -> &str {
        &self.names[solid as usize]
    }

    /// How many triangles they have in all.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles for pictures: number of the solid, and corners counter-clockwise from outside, m.
    pub fn faces(&self) -> impl Iterator<Item = (u32, [DVec3; 3])> {
        self.triangles.iter().map(|t| (t.solid, t.corners))
    }

    /// The farthest that anything stands from a point along an axis, m; 0 where nothing stands.
    #[must_use]
    pub fn farthest(&self, from: DVec3) -> f64 {
        let corners = self.triangles.iter().flat_map(|t| t.corners);
        corners.fold(0.0, |far: f64, corner| far.max((corner - from).abs().max_element()))
    }

    /// XXH3-128 of the triangles and whose they are, in their order.
    #[must_use]
    pub fn digest(&self) -> u128 {
        self.digest
    }

    /// Bytes of triangles, hierarchy and grid.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.triangles.len() * size_of::<Triangle>() + self.bvh.heap_memory_size() + self.near.bytes()
    }

    /// Whether the box that touches everything up to `reach` metres from a point, along each axis, meets the
    /// bounds of any face: never false where it does, true in some places where it does not. Costs a few
    /// compares and one load while `reach` is at most 16 m, more beyond.
    #[must_use]
    #[inline]
    pub fn near(&self, x: f64, y: f64, z: f64, reach: f64) -> bool {
        (reach > Near::MARGIN || self.near.close(x, y, z, reach)) && self.near_bounds(x, y, z, reach)
    }

    /// Who of some lanes must be asked [`Solids::near`] one by one, of players at a place in m from `centre`
    /// and within some kilometres of it: all for whom it is true, and few others.
    #[inline(always)]
    pub(crate) fn may_be_near<R: Real>(&self, centre: DVec2, place: V3<R>, reach: R) -> R::Mask {
        self.near.may_be_close(centre, place, reach)
    }

    /// Who of some lanes stays, with all that lies between two corners and a reach beyond them, m from
    /// `centre` and within some kilometres of it, outside the rectangle that all solids stand in.
    #[inline(always)]
    pub(crate) fn beyond<R: Real>(&self, centre: DVec2, (low, high): (V3<R>, V3<R>), reach: R) -> R::Mask {
        self.near.beyond(centre, (low, high), reach)
    }

    #[cold]
    fn near_bounds(&self, x: f64, y: f64, z: f64, reach: f64) -> bool {
        let point = DVec3::new(x, y, z);
        let around = Aabb::new(point - reach, point + reach);
        self.bvh.intersect_aabb(&around).next().is_some()
    }

    pub(super) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    pub(super) fn bvh(&self) -> &Bvh {
        &self.bvh
    }
}

impl Triangle {
    pub(super) fn low(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        a.min(b).min(c)
    }

    pub(super) fn high(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        a.max(b).max(c)
    }
}

/// Checks one solid and appends its triangles.
fn append(
    triangles: &mut Vec<Triangle>,
    solid: &Solid,
    number: usize,
    map: &Grid,
    what: &str,
) -> Result<(), InputError> {
    let placement = &solid.placement;
    if !placement.position.is_finite() {
        refuse!("{what}: position: expected three finite numbers, got {:?}", placement.position);
    }
    let rotation = placement.rotation;
    let unit = (rotation.length_squared() - 1.0).abs() <= 1e-6;
    if !unit {
        refuse!("{what}: rotation: expected a unit quaternion, got {rotation:?}");
    }
    if !(placement.scale.is_finite() && placement.scale > 0.0) {
        refuse!("{what}: scale: expected a finite number above 0, got {}", placement.scale);
    }
    let (vertices, faces) = shapes::triangles(&solid.shape, what)?;
    let total = triangles.len() + faces.len();
    if total > MAX_TRIANGLES {
        refuse!("{what}: expected at most {MAX_TRIANGLES} triangles in all solids, got {total} so far");
    }
    let placement = super::Placement { rotation: rotation.normalize(), ..*placement };
    let placed: Vec<DVec3> = vertices.iter().map(|&v| placement.place(v)).collect();
    check::vertices(&vertices, &placed, what)?;
    check::faces(&placed, &faces, what)?;
    // A hull may have slivers where points all but lie on an edge; a mesh must not.
    let hull = matches!(solid.shape, Shape::Hull { .. });
    let smooth = check::closed(&placed, &faces, what)?;
    check::on_map(&placed, map, what)?;
    for (k, face) in faces.iter().enumerate() {
        let corners = face.map(|v| placed[v as usize]);
        match check::normal(corners) {
            Some(normal) => {
                triangles.push(Triangle { corners, normal, solid: number as u32, smooth: smooth[k] });
            }
            None if hull => (),
            None => return Err(check::flat(corners, k, what)),
        }
    }
    Ok(())
}
