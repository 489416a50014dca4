//! OBJ and glTF files, written here and read back, and broken ones.

use crate::common::solids::{block, built, map};
use discjump_core::solids::{Placement, Shape, Solid, Solids, load};
use glam::DVec3;
use std::path::PathBuf;

/// A directory of this test's own.
fn directory(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("solids_{name}"));
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// A wedge: unlike itself after any turn or mirroring.
fn wedge() -> Vec<[DVec3; 3]> {
    let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0], [4.0, 0.0, 0.5]];
    let points = points.map(DVec3::from).to_vec();
    built(&[Solid::hull("wedge", points, Placement::default())]).faces().map(|(_, corners)| corners).collect()
}

/// The triangles of a shape once built, in an order of their own.
fn faces(shape: Shape) -> Vec<[[f64; 3]; 3]> {
    let solids = Solids::new(&[Solid::new("file", shape, Placement::default())], &map()).unwrap();
    sorted(solids.faces().map(|(_, corners)| corners))
}

fn sorted(faces: impl Iterator<Item = [DVec3; 3]>) -> Vec<[[f64; 3]; 3]> {
    let mut faces: Vec<_> = faces
        .map(|corners| {
            let mut corners = corners.map(|c| (c + 0.0).to_array());
            let first = (0..3).min_by(|&a, &b| corners[a].partial_cmp(&corners[b]).unwrap()).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect();
    faces.sort_by(|a, b| a.partial_cmp(b).unwrap());
    faces
}

#[test]
fn obj() {
    let path = directory("obj").join("Cube.OBJ");
    // Two objects and a material that hang together only as one file, with quads, and texture and normal numbers.
    let text = "mtllib nowhere.mtl\no one\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\n\
                v -1 1 1\nvt 0 0\nvn 0 0 1\nusemtl red\nf 4 3 2 1\nf 5/1/1 6/1/1 7/1/1 8/1/1\no two\nusemtl blue\n\
                f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf -8 -4 -1 -5\nl 1 2\n";
    std::fs::write(&path, text).unwrap();
    let solids = built(&[Solid::new("file", load::mesh(&path).unwrap(), Placement::default())]);
    assert_eq!(solids.triangle_count(), 12);
    let hit = solids.sweep_box(DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.0, 0.0, -4.0), 0.5, 2.3).unwrap();
    assert!((hit.fraction - 0.5).abs() < 1e-12 && hit.normal == DVec3::Z, "{hit:?}");
    assert_eq!(solids.overlap(DVec3::ZERO, 0.5, 2.3), Some(0));
    assert_eq!(solids.overlap(DVec3::new(0.0, 0.0, -1.0), 0.1, 0.2), Some(0));
}

/// A glTF of triangles given z up, indexed, under two nodes that together turn, scale, mirror and move nothing away.
fn gltf(uri: &str, bytes: usize, vertices: usize, component: u32) -> String {
    let size = if component == 5123 { 2 } else { 4 };
    let points = vertices * 12;
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"children":[1],"scale":[-2,2,2],"translation":[1,2,3]}},
                 {{"mesh":0,"scale":[-0.5,0.5,0.5],"translation":[0.5,-1,-1.5]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "buffers":[{{{uri}"byteLength":{bytes}}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{points}}},
                       {{"buffer":0,"byteOffset":{points},"byteLength":{}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3","min":[0,0,0],"max":[9,9,9]}},
                     {{"bufferView":1,"componentType":{component},"count":{vertices},"type":"SCALAR"}}]}}"#,
        vertices * size
    )
}

/// Positions y up, then vertex numbers.
fn buffer(faces: &[[DVec3; 3]], component: u32) -> Vec<u8> {
    let corners = faces.iter().flatten();
    let mut bytes: Vec<u8> =
        corners.flat_map(|c| [c.x, c.z, -c.y]).flat_map(|x| (x as f32).to_le_bytes()).collect();
    for k in 0..3 * faces.len() as u32 {
        if component == 5123 { bytes.extend((k as u16).to_le_bytes()) } else { bytes.extend(k.to_le_bytes()) }
    }
    bytes
}

fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let json = format!("{json:width$}", width = json.len().next_multiple_of(4));
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2u32.to_le_bytes());
    bytes.extend((28 + json.len() as u32 + bin.len() as u32).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json.as_bytes());
    bytes.extend((bin.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(bin);
    bytes
}

#[test]
fn gltf_in_all_its_forms() {
    let directory = directory("gltf");
    let wedge = wedge();
    let expected = sorted(wedge.iter().copied());
    for component in [5123, 5125] {
        let bytes = buffer(&wedge, component);
        let vertices = 3 * wedge.len();
        let text = |uri: &str| gltf(uri, bytes.len(), vertices, component);
        // A file beside it, its name escaped; the file itself; base64.
        std::fs::write(directory.join("the bytes.bin"), &bytes).unwrap();
        std::fs::write(directory.join("beside.gltf"), text(r#""uri":"the%20bytes.bin","#)).unwrap();
        std::fs::write(directory.join("whole.glb"), glb(&text(""), &bytes)).unwrap();
        use base64::Engine;
        let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
        let uri = format!(r#""uri":"data:application/octet-stream;base64,{data}","#);
        std::fs::write(directory.join("inline.gltf"), text(&uri)).unwrap();
        for name in ["beside.gltf", "whole.glb", "inline.gltf"] {
            assert_eq!(faces(load::mesh(&directory.join(name)).unwrap()), expected, "{name}");
        }
    }
}

#[test]
fn broken_files() {
    let directory = directory("broken");
    let write = |name: &str, bytes: &[u8]| {
        let path = directory.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let fails = |name: &str, bytes: &[u8], part: &str| {
        let error = load::mesh(&write(name, bytes)).unwrap_err().0;
        assert!(error.contains(name) && error.contains(part), "expected {part:?} in {error:?}");
    };
    assert!(load::mesh(&directory.join("missing.obj")).unwrap_err().0.contains("missing.obj"));
    fails("mesh.stl", b"solid", "stl");
    fails("empty.obj", b"", "triangles");
    fails("words.obj", b"v 1 2 three\n", "OBJ");
    fails("outside.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "OBJ");
    fails("words.gltf", b"hello", "glTF");
    let wedge = wedge();
    let bytes = buffer(&wedge, 5123);
    let text = |uri: &str| gltf(uri, bytes.len(), 3 * wedge.len(), 5123);
    fails("no_file.gltf", text(r#""uri":"gone.bin","#).as_bytes(), "gone.bin");
    fails("no_bytes.gltf", text("").as_bytes(), "buffer 0");
    fails("far.gltf", text(r#""uri":"https://example.org/a.bin","#).as_bytes(), "beside");
    fails("odd.gltf", text(r#""uri":"data:text/plain,hello","#).as_bytes(), "base64");
    let whole = text("");
    let circle = whole.replace(r#"{"mesh":0,"#, r#"{"mesh":0,"children":[0],"#);
    fails("circle.glb", &glb(&circle, &bytes), "more than once");
    let strip = whole.replace(r#""indices":1"#, r#""indices":1,"mode":5"#);
    fails("strip.glb", &glb(&strip, &bytes), "TriangleStrip");
    fails("short.glb", &glb(&whole, &bytes[..40]), "elements");
    let none = whole.replace(r#""type":"SCALAR""#, r#""type":"VEC2""#);
    fails("vec2.glb", &glb(&none, &bytes), "Scalar");
    let mut far = bytes.clone();
    let last = far.len() - 2;
    far[last..].copy_from_slice(&60_000u16.to_le_bytes());
    fails("number.glb", &glb(&whole, &far), "60000");
    // Cut off anywhere, or with any byte changed, a file is read or refused: never a panic.
    let all = glb(&whole, &bytes);
    for cut in 0..all.len() {
        assert!(load::mesh(&write("cut.glb", &all[..cut])).is_err() || cut > all.len() - 4, "{cut}");
    }
    for at in 0..all.len() {
        let mut changed = all.clone();
        changed[at] ^= 0x15;
        let _ = load::mesh(&write("changed.glb", &changed));
    }
    // NaN in a file is no error of the file, but no solid either.
    let mut nan = bytes.clone();
    nan[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let shape = load::mesh(&write("nan.glb", &glb(&whole, &nan))).unwrap();
    let solids = [block([0.0; 3], [1.0; 3]), Solid::new("file", shape, Placement::default())];
    let error = Solids::new(&solids, &map()).unwrap_err().0;
    assert!(error.contains("solids[1] \"file\"") && error.contains("vertex 0"), "{error}");
}
