//! The mission's bases and bridge, on many generated maps.

use discjump_core::solids::{Solids, mission};
use discjump_core::terrain::raindance::{Options, generate};
use discjump_core::terrain::{Edge, Heightfield, Maps};
use glam::DVec3;

const SEEDS: u64 = 25;

#[test]
fn bases_and_bridge_stand_well() {
    let (mut deepest_end, mut highest_floor) = (0.0f64, 0.0f64);
    for seed in 0..SEEDS {
        let generated = generate(seed, Options::default()).unwrap();
        let field =
            Heightfield::new(generated.heights.clone(), 257, 257, 8.0, [-1024.0, -1024.0], Edge::Tile)
                .unwrap();
        let maps = Maps::new(core::slice::from_ref(&field)).unwrap();
        let surface = maps.surface::<f64>();
        let ground = |x: f64, y: f64| surface.ground::<f64>(0, x, y).height;
        let found = mission::solids(&generated.mission, ground);
        let solids = Solids::new(&found.solids, field.grid()).unwrap();
        for (k, flag) in found.flags.iter().enumerate() {
            let flag = DVec3::from(*flag);
            let was = generated.mission.flags[k];
            assert_eq!([flag.x, flag.y], [was[0], was[1]]);
            highest_floor = highest_floor.max(flag.z - 0.4 - was[2]);
            // The flag stands on its stand, and the heavy has room there and jumps to 1.75 m.
            let down = solids.sweep_box(flag + DVec3::Z, DVec3::new(0.0, 0.0, -2.0), 0.8, 2.6).unwrap();
            assert!((down.fraction - 0.5).abs() < 1e-9 && down.normal.z == 1.0, "{down:?}");
            assert_eq!(solids.sweep_box(flag + 1e-3, DVec3::new(0.0, 0.0, 1.75), 0.8, 2.6), None);
            walks_in(&solids, ground, flag, DVec3::from(found.flags[1 - k]));
            // On the roof one stands.
            let roof =
                solids.sweep_box(flag.with_z(flag.z + 40.0), DVec3::new(0.0, 0.0, -50.0), 0.5, 2.3).unwrap();
            assert!((flag.z + 40.0 - 50.0 * roof.fraction - (flag.z - 0.4 + 7.0)).abs() < 1e-6, "{roof:?}");
        }
        let bridge = &generated.mission.bridge;
        for end in bridge.ends {
            deepest_end = deepest_end.max((end[2] - bridge.deck_top).abs());
        }
        // From end to end, and down to the deck everywhere.
        let [a, b] = bridge.ends.map(|end| DVec3::new(end[0], end[1], bridge.deck_top));
        let above = DVec3::new(0.0, 0.0, 0.01);
        let (a, b) = (a.lerp(b, 0.02) + above, a.lerp(b, 0.98) + above);
        assert_eq!(solids.sweep_box(a, b - a, 0.8, 2.6), None, "seed {seed}: something on the deck");
        for k in 0..=20 {
            let at = a.lerp(b, f64::from(k) / 20.0);
            let deck = solids.ray(at, DVec3::new(0.0, 0.0, -0.1)).expect("a deck");
            assert!((deck.fraction - 0.1).abs() < 1e-6);
        }
        // Piers end in the ground: whoever runs along the gorge's floor can only meet their sides.
        for solid in found.solids.iter().filter(|s| s.name.contains("pier")) {
            let foot = solid.placement.position;
            assert!(ground(foot.x, foot.y) < bridge.deck_top, "{}", solid.name);
        }
        if seed == 0 {
            println!(
                "{} solids, {} triangles, {} bytes",
                solids.count(),
                solids.triangle_count(),
                solids.bytes()
            );
        }
    }
    println!(
        "deck to ground at its ends up to {deepest_end:.2} m, floors up to {highest_floor:.2} m above the flag's ground"
    );
}

/// From 30 m before the open side to the flag: the ground and the ramp lead to the floor, a step to the stand.
fn walks_in(solids: &Solids, ground: impl Fn(f64, f64) -> f64, flag: DVec3, other: DVec3) {
    let forward = (other - flag).with_z(0.0).normalize();
    let floor = flag.z - 0.4;
    let mut steepest = 0.0f64;
    let mut last: Option<f64> = None;
    for k in 0..56 {
        let at = flag + forward * (30.0 - 0.5 * f64::from(k));
        let from = at.with_z(floor + 4.0);
        let built = solids
            .ray(from, DVec3::new(0.0, 0.0, -40.0))
            .map_or(f64::MIN, |hit| from.z - 40.0 * hit.fraction);
        let height = built.max(ground(at.x, at.y));
        if let Some(last) = last {
            steepest = steepest.max((height - last) / 0.5);
        }
        last = Some(height);
    }
    assert!((last.unwrap() - floor).abs() < 1e-6, "the way in ends at {last:?}, the floor is at {floor}");
    assert!(steepest < 1.2, "a step of {steepest} on the way in");
    // Then on to the stand, by the step of every armor.
    for (half, height) in [(0.5, 2.3), (0.7, 2.4), (0.8, 2.6)] {
        let feet = flag.with_z(floor + 1e-4) + forward * 5.0;
        let path = -forward * 4.0;
        let hit = solids.sweep_box(feet, path, half, height).expect("the stand");
        let lift = solids.step_up(feet, path, half, height, 0.3 * height, &hit).expect("a step");
        assert!((lift - 0.4).abs() < 0.01, "{lift}");
    }
}
