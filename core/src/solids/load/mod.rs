//! Meshes from files: Wavefront OBJ (`.obj`) and glTF 2.0 (`.gltf`, `.glb`).
//!
//! A file is one mesh, whatever objects, groups or materials it is divided into. OBJ is read as it stands: z up,
//! metres. glTF is y up by its standard, so its (x, y, z) becomes (x, -z, y) here.

mod gltf;
mod obj;

use super::solid::Shape;
use crate::error::{InputError, refuse};
use std::path::Path;

/// Largest file that is read, bytes.
pub const MAX_FILE: u64 = 1 << 30;

/// Reads a mesh. What makes a mesh a solid is checked when [`super::Solids`] are built, not here.
///
/// # Errors
/// Names the file, and says what is wrong with it: another ending than `.obj`, `.gltf` or `.glb`, unreadable, larger
/// than [`MAX_FILE`], or not of the format its ending promises.
pub fn mesh(path: &Path) -> Result<Shape, InputError> {
    let what = format!("{}", path.display());
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let shape = match ending.as_str() {
        "obj" => obj::mesh(&read(path, &what)?, &what)?,
        "gltf" | "glb" => gltf::mesh(&read(path, &what)?, path, &what)?,
        _ => refuse!("{what}: expected a file that ends in .obj, .gltf or .glb, got {ending:?}"),
    };
    match &shape {
        Shape::Mesh { faces, .. } if faces.is_empty() => refuse!("{what}: expected triangles, got none"),
        _ => Ok(shape),
    }
}

fn read(path: &Path, what: &str) -> Result<Vec<u8>, InputError> {
    let fail = |e: std::io::Error| InputError(format!("{what}: expected a readable file, got: {e}"));
    let size = std::fs::metadata(path).map_err(fail)?.len();
    if size > MAX_FILE {
        refuse!("{what}: expected at most {MAX_FILE} bytes, got {size}");
    }
    std::fs::read(path).map_err(fail)
}
