//! Wavefront OBJ. Polygons become fans of triangles, points and lines are left out, materials are not looked for.

use crate::error::InputError;
use crate::solids::Shape;
use glam::DVec3;

pub(super) fn mesh(bytes: &[u8], what: &str) -> Result<Shape, InputError> {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    let (models, _) = tobj::load_obj_buf(&mut &bytes[..], &options, |_| Ok(Default::default()))
        .map_err(|e| InputError(format!("{what}: expected an OBJ file, got: {e}")))?;
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for model in models {
        let first = vertices.len() as u32;
        vertices.extend(model.mesh.positions.chunks_exact(3).map(DVec3::from_slice));
        faces.extend(model.mesh.indices.chunks_exact(3).map(|f| [first + f[0], first + f[1], first + f[2]]));
    }
    Ok(Shape::Mesh { vertices, faces })
}
