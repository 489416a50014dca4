//! glTF 2.0: every triangle of the default scene, with its nodes' transforms.

use super::read;
use crate::error::{InputError, refuse};
use crate::solids::{MAX_TRIANGLES, Shape};
use base64::Engine;
use glam::{DMat4, DVec3, Mat4};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Accessor, Document, Gltf, Node, Primitive, Semantic};
use std::path::Path;

pub(super) fn mesh(bytes: &[u8], path: &Path, what: &str) -> Result<Shape, InputError> {
    let fail = |e: gltf::Error| InputError(format!("{what}: expected a glTF 2.0 file, got: {e}"));
    let Gltf { document, blob } = Gltf::from_slice(bytes).map_err(fail)?;
    let buffers = buffers(&document, blob, path, what)?;
    let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
        refuse!("{what}: expected a scene, got none");
    };
    let mut file = File { buffers, what, vertices: Vec::new(), faces: Vec::new() };
    // A tree has every node once; one that turns in circles is found out by their number.
    let mut left = document.nodes().count();
    let mut nodes: Vec<(Node, DMat4)> = scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
    while let Some((node, parent)) = nodes.pop() {
        left = match left.checked_sub(1) {
            Some(left) => left,
            None => refuse!("{what}: expected a tree of nodes, got node {} more than once", node.index()),
        };
        let world = parent * Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            file.primitive(&primitive, world)?;
        }
        nodes.extend(node.children().map(|child| (child, world)));
    }
    Ok(Shape::Mesh { vertices: file.vertices, faces: file.faces })
}

/// The bytes of each buffer: of the file itself, of a `data:` address, or of a file beside it.
fn buffers(
    document: &Document,
    mut blob: Option<Vec<u8>>,
    path: &Path,
    what: &str,
) -> Result<Vec<Vec<u8>>, InputError> {
    let one = |buffer: gltf::Buffer| {
        let number = buffer.index();
        let fail = |why: &dyn core::fmt::Display| InputError(format!("{what}: buffer {number}: {why}"));
        let Source::Uri(uri) = buffer.source() else {
            return blob.take().ok_or_else(|| fail(&"expected the bytes of a .glb file, got none"));
        };
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((_, text)) = data.split_once(";base64,") else {
                return Err(fail(&"expected base64 data"));
            };
            return base64::engine::general_purpose::STANDARD.decode(text).map_err(|e| fail(&e));
        }
        let name = percent_encoding::percent_decode_str(uri).decode_utf8().map_err(|e| fail(&e))?;
        if name.contains("://") {
            return Err(fail(&format_args!("expected a file beside this one, got {name:?}")));
        }
        let beside = path.with_file_name(name.as_ref());
        read(&beside, &format!("{what}: buffer {number}: {}", beside.display()))
    };
    document.buffers().map(one).collect()
}

struct File<'a> {
    buffers: Vec<Vec<u8>>,
    what: &'a str,
    vertices: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

impl File<'_> {
    fn primitive(&mut self, primitive: &Primitive, world: DMat4) -> Result<(), InputError> {
        let what = self.what;
        match primitive.mode() {
            Mode::Triangles => (),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return Ok(()),
            mode => refuse!("{what}: expected separate triangles, got {mode:?}"),
        }
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            refuse!("{what}: expected positions in every mesh, got one without");
        };
        let first = self.vertices.len();
        let points = self.elements(&positions, Dimensions::Vec3, &[DataType::F32])?;
        let points: Vec<DVec3> = points
            .map(|p| {
                let at = |k: usize| f64::from(f32::from_le_bytes([p[k], p[k + 1], p[k + 2], p[k + 3]]));
                let p = world.transform_point3(DVec3::new(at(0), at(4), at(8)));
                DVec3::new(p.x, -p.z, p.y)
            })
            .collect();
        let numbers: Vec<u32> = match primitive.indices() {
            None => (0..points.len() as u32).collect(),
            Some(indices) => self
                .elements(&indices, Dimensions::Scalar, &[DataType::U8, DataType::U16, DataType::U32])?
                .map(|bytes| bytes.iter().rev().fold(0, |number, &byte| number << 8 | u32::from(byte)))
                .collect(),
        };
        if let Some(number) = numbers.iter().find(|&&number| number as usize >= points.len()) {
            refuse!("{what}: expected vertex numbers below {}, got {number}", points.len());
        }
        let total = self.faces.len() + numbers.len() / 3;
        if total > MAX_TRIANGLES {
            refuse!("{what}: expected at most {MAX_TRIANGLES} triangles, got {total} so far");
        }
        // A transform that mirrors turns every triangle over, and the standard turns it back.
        let mirrored = world.determinant() < 0.0;
        self.vertices.extend(points);
        self.faces.extend(numbers.chunks_exact(3).map(|f| {
            let [a, b, c] = [f[0], f[1], f[2]].map(|number| first as u32 + number);
            if mirrored { [a, c, b] } else { [a, b, c] }
        }));
        Ok(())
    }

    /// The bytes of each element of an accessor of one of the expected kinds.
    fn elements(
        &self,
        accessor: &Accessor,
        dimensions: Dimensions,
        types: &[DataType],
    ) -> Result<impl Iterator<Item = &[u8]>, InputError> {
        let what = format!("{}: accessor {}", self.what, accessor.index());
        if accessor.dimensions() != dimensions || !types.contains(&accessor.data_type()) {
            let got = (accessor.dimensions(), accessor.data_type());
            refuse!("{what}: expected {dimensions:?} of one of {types:?}, got {got:?}");
        }
        let (Some(view), None) = (accessor.view(), accessor.sparse()) else {
            refuse!("{what}: expected a buffer view and no sparse values");
        };
        let (size, count) = (accessor.size(), accessor.count());
        let stride = view.stride().unwrap_or(size);
        let all = &self.buffers[view.buffer().index()];
        let bytes = view
            .offset()
            .checked_add(view.length())
            .and_then(|end| all.get(view.offset()..end))
            .and_then(|bytes| bytes.get(accessor.offset()..));
        let needed = count.saturating_sub(1).checked_mul(stride).and_then(|n| n.checked_add(size));
        match (bytes, needed) {
            (Some(bytes), Some(needed)) if stride >= size && needed <= bytes.len() => {
                Ok((0..count).map(move |k| &bytes[k * stride..k * stride + size]))
            }
            _ => refuse!("{what}: expected {count} elements within its buffer of {} bytes", all.len()),
        }
    }
}
