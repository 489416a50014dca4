//! Places far from the map, and squares that are small or huge: nothing panics, nothing hangs, and the
//! ground is where the edge says.
#![allow(missing_docs)]

mod common;

use common::*;
use discjump_core::terrain::{Edge, Heightfield, Maps};
use std::time::Instant;

/// 4 x 4 heights whose rims differ: low in the west, high in the east.
fn tilted(size: f64, edge: Edge) -> Heightfield {
    let heights = (0..16).map(|k| f64::from(k % 4) * size).collect();
    Heightfield::new(heights, 4, 4, size, [0.0, 0.0], edge).unwrap()
}

/// Caught: 1e9 m from a clamped map of squares of 0.01 m the index of the square overflowed, which put
/// the far west on the heights of the eastern rim; and a sweep there walked 1e11 squares to catch up with
/// its own start, which is for ever.
#[test]
fn a_clamped_map_goes_on_to_1e9_m() {
    for size in [0.01, 8.0, 1000.0] {
        for tier in TIERS {
            for (x, height) in [(-1e9, 0.0), (1e9, 3.0 * size)] {
                for y in [-1e9, 0.0, 1e9] {
                    let map = tilted(size, Edge::Clamp);
                    let mut w = world(&map, tier);
                    w.set(&[("position", &[x, y, height + 5.0]), ("velocity", &[30.0, -20.0, 0.0])]);
                    let begun = Instant::now();
                    (0..60).for_each(|_| w.step(IDLE));
                    assert!(begun.elapsed().as_secs() < 20, "{size} {tier} {x} {y}");
                    let landed = w.position()[2];
                    assert!((landed - height).abs() < 0.5, "{size} {tier} {x} {y}: {landed}");
                }
            }
        }
    }
}

#[test]
fn beyond_a_void_map_one_falls() {
    for size in [0.01, 8.0, 1000.0] {
        for tier in TIERS {
            for x in [-1e9, -size * 3.0, size * 5.0, 1e9] {
                let map = tilted(size, Edge::Void);
                let mut w = world(&map, tier);
                w.set(&[("position", &[x, 0.0, 5.0])]);
                (0..100).for_each(|_| w.step(IDLE));
                let fallen = 5.0 - 10.0 * 0.032 * 0.032 * 100.0 * by_model(tier, 101.0, 100.0);
                assert!((w.position()[2] - fallen).abs() < 1e-3, "{size} {tier} {x}: {:?}", w.position());
            }
        }
    }
}

/// The far tile is as exact as the first: the same local bits, the tile counted beside them.
#[test]
fn a_tiling_map_is_as_exact_at_1e9_m() {
    for tier in TIERS {
        let map = rolling();
        let run = |x: f64, y: f64| {
            let mut w = world(&map, tier);
            w.set(&[("position", &[x, y, 60.0]), ("velocity", &[13.0, -7.0, 0.0])]);
            (0..300).for_each(|_| w.step(SKI));
            (w.position(), w.velocity())
        };
        let (p, v) = run(100.0, 200.0);
        // 512 m tiles: the world position of the far player has fewer digits than his local one.
        let away = 512.0 * 1_900_000.0;
        let (q, u) = run(100.0 - away, 200.0 + away);
        assert_eq!(v.map(f64::to_bits), u.map(f64::to_bits));
        assert_eq!(p[2].to_bits(), q[2].to_bits());
        assert!((q[0] + away - p[0]).abs() < 1e-6 && (q[1] - away - p[1]).abs() < 1e-6);
    }
}

/// Positions come back as they went in, in every tier, wherever they are exact.
#[test]
fn positions_round_trip() {
    let odd = Heightfield::new(vec![0.0; 6 * 4], 4, 6, 3.0, [100.0, -50.0], Edge::Tile).unwrap();
    for (map, step) in [(rolling(), 0.125), (odd, 0.125)] {
        for tier in TIERS {
            for k in -2000..2000 {
                let p = [f64::from(k) * step, f64::from(k * 7 % 2000) * step, 1.5];
                let mut w = world(&map, tier);
                w.set(&[("position", &p)]);
                assert_eq!(w.position(), p, "{tier}");
            }
        }
    }
}

/// Caught: a sweep kept its place by subtracting one square after the other, which in f32 stands still
/// after 260 km of squares of 0.01 m.
#[test]
fn three_hundred_km_in_a_tick_end_in_time() {
    let map = tilted(0.01, Edge::Clamp);
    let mut s = setup(&map, "authentic");
    s.tick_ms = 1000;
    let mut w = World { sim: s.build().unwrap() };
    w.set(&[("velocity", &[3e5, 0.0, 0.0]), ("position", &[0.0, 0.0, 5.0])]);
    w.step(IDLE);
    // Fallen by 20 m/s in this tick: it comes down a quarter of the way along the one sweep.
    assert!((w.velocity()[2] - 0.001).abs() < 0.01 && w.velocity()[0] == 3e5, "{:?}", w.velocity());
}

#[test]
fn local_and_world_places_agree_at_any_origin() {
    let map = Heightfield::new(vec![0.0; 25], 5, 5, 8.0, [1e9 - 64.0, -1e9], Edge::Tile).unwrap();
    let maps = Maps::new(core::slice::from_ref(&map)).unwrap();
    for k in -40..40 {
        let place = glam::DVec3::new(1e9 - 64.0 + f64::from(k) / 4.0, -1e9 + 7.25, 3.0);
        if place.x <= 1e9 {
            let (local, tile) = maps.to_local(place).unwrap();
            assert!((-16.0..16.0).contains(&local.x) && (-16.0..16.0).contains(&local.y));
            assert_eq!(maps.to_world(local, tile), place);
        }
    }
}
