//! One solid as its user gave it.

use glam::{DQuat, DVec3};

/// Most triangles that all solids of one map may have.
pub const MAX_TRIANGLES: usize = 4_000_000;
/// Most points of one convex hull.
pub const MAX_HULL_POINTS: usize = 65_536;
/// Farthest that a vertex may lie from the world's origin along an axis, m.
pub const MAX_COORDINATE: f64 = 1e6;

/// The shape of a solid, in its own coordinates, metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box about its own origin, by its full sides.
    Box {
        /// Sides along x, y and z.
        size: DVec3,
    },
    /// The convex hull of points.
    Hull {
        /// At least four that do not lie in a plane.
        points: Vec<DVec3>,
    },
    /// A closed mesh: its triangles counter-clockwise as seen from outside.
    Mesh {
        /// Vertices. Those at the same place count as one.
        vertices: Vec<DVec3>,
        /// Vertex numbers of each triangle.
        faces: Vec<[u32; 3]>,
    },
}

/// Where a shape stands: scaled, then turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// World coordinates of the shape's origin, m.
    pub position: DVec3,
    /// A unit quaternion.
    pub rotation: DQuat,
    /// Same along all axes, above 0.
    pub scale: f64,
}

impl Default for Placement {
    fn default() -> Self {
        Self { position: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: 1.0 }
    }
}

impl Placement {
    /// At a position, turned about the vertical by `yaw` radians, counter-clockwise seen from above.
    #[must_use]
    pub fn at(position: DVec3, yaw: f64) -> Self {
        let rotation = DQuat::from_xyzw(0.0, 0.0, libm::sin(0.5 * yaw), libm::cos(0.5 * yaw));
        Self { position, rotation, scale: 1.0 }
    }

    /// A point of the shape, in the world.
    #[must_use]
    pub fn place(&self, point: DVec3) -> DVec3 {
        self.rotation * (point * self.scale) + self.position
    }
}

/// One solid: a shape, and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// What errors call it.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// Where it stands.
    pub placement: Placement,
}

impl Solid {
    /// A box by its full sides, turned about the vertical by `yaw` radians, its middle at `centre`.
    #[must_use]
    pub fn cuboid(name: &str, size: DVec3, centre: DVec3, yaw: f64) -> Self {
        Self::new(name, Shape::Box { size }, Placement::at(centre, yaw))
    }

    /// The convex hull of points.
    #[must_use]
    pub fn hull(name: &str, points: Vec<DVec3>, placement: Placement) -> Self {
        Self::new(name, Shape::Hull { points }, placement)
    }

    /// A closed mesh.
    #[must_use]
    pub fn mesh(name: &str, vertices: Vec<DVec3>, faces: Vec<[u32; 3]>, placement: Placement) -> Self {
        Self::new(name, Shape::Mesh { vertices, faces }, placement)
    }

    /// Any shape.
    #[must_use]
    pub fn new(name: &str, shape: Shape, placement: Placement) -> Self {
        Self { name: name.into(), shape, placement }
    }
}
