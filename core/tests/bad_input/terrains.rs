//! Heightfields and pools of them.

use crate::{INF, NAN, refused};
use discjump_core::terrain::{Edge, Heightfield, Maps, SurfaceKind};

#[test]
fn heightfields() {
    let ok = vec![1.0; 6];
    let new = |heights: &[f64], rows, cols, size, origin, edge| {
        Heightfield::new(heights.to_vec(), rows, cols, size, origin, edge)
    };
    let make = |heights: &[f64]| new(heights, 2, 3, 8.0, [0.0; 2], Edge::Clamp);
    assert!(make(&ok).is_ok());
    refused(new(&ok, 1, 6, 8.0, [0.0; 2], Edge::Clamp), "heights", "1 x 6");
    refused(new(&ok, 6, 1, 8.0, [0.0; 2], Edge::Clamp), "heights", "6 x 1");
    refused(new(&[], 0, 0, 8.0, [0.0; 2], Edge::Clamp), "heights", "0 x 0");
    refused(new(&ok, 2, 2, 8.0, [0.0; 2], Edge::Clamp), "heights", "6");
    refused(new(&ok, usize::MAX, 2, 8.0, [0.0; 2], Edge::Clamp), "heights", "x 2");
    refused(new(&ok, 1 << 20, 1 << 20, 8.0, [0.0; 2], Edge::Clamp), "heights", "1048576");
    for (bad, got) in [(NAN, "NaN"), (INF, "inf"), (-INF, "-inf"), (10_000.001, "10000.001"), (-1e300, "-1")]
    {
        let mut heights = ok.clone();
        heights[4] = bad;
        refused(make(&heights), "heights", got);
        refused(make(&heights), "heights", "row 1, column 1");
    }
    for edge in [10_000.0, -10_000.0] {
        assert!(make(&[edge; 6]).is_ok());
    }
    for (bad, got) in
        [(0.0, "0"), (-8.0, "-8"), (NAN, "NaN"), (INF, "inf"), (0.009, "0.009"), (10_001.0, "10001")]
    {
        refused(new(&ok, 2, 3, bad, [0.0; 2], Edge::Clamp), "square_size", got);
    }
    for bad in [[NAN, 0.0], [0.0, INF], [1.1e9, 0.0]] {
        refused(new(&ok, 2, 3, 8.0, bad, Edge::Clamp), "origin", &format!("{bad:?}"));
    }
    // A map that tiles repeats its first row and column.
    refused(new(&[1.0, 1.0, 1.0, 1.0, 2.0, 1.0], 2, 3, 8.0, [0.0; 2], Edge::Tile), "heights", "column 1");
    refused(new(&[1.0, 2.0, 3.0, 1.0, 2.0, 3.0], 2, 3, 8.0, [0.0; 2], Edge::Tile), "heights", "row 0");
    refused("wrap".parse::<Edge>(), "edge", "\"wrap\"");
    refused("cubic".parse::<SurfaceKind>(), "surface", "\"cubic\"");
}

#[test]
fn pools_of_maps() {
    let map =
        |rows, size| Heightfield::new(vec![0.0; rows * 3], rows, 3, size, [0.0; 2], Edge::Clamp).unwrap();
    refused(Maps::new(&[]), "terrains", "none");
    refused(Maps::new(&[map(3, 8.0), map(4, 8.0)]), "terrains", "4 x 3");
    refused(Maps::new(&[map(3, 8.0), map(3, 8.0), map(3, 4.0)]), "terrains", "number 2");
    let smooth = map(3, 8.0).with_surface(SurfaceKind::Bilinear);
    refused(Maps::new(&[map(3, 8.0), smooth]), "terrains", "number 1 has \"bilinear\"");
}
