//! The authentic tier against the reference: what single precision costs on rolling terrain. Section 12
//! of docs/physics.md says less than 3.3 mm after 20 s.
#![allow(missing_docs)]

mod common;

use common::*;
use discjump_core::batch::RawInput;

/// The largest distance between the two tiers over 20 s of the same keys.
fn apart(yaw: f64, speed: f64, keys: impl Fn(u32) -> RawInput) -> f64 {
    let map = rolling();
    let mut worlds = [world(&map, "authentic"), world(&map, "reference")];
    for w in &mut worlds {
        let start = w.position();
        // Exact in both tiers, so that nothing but the arithmetic differs.
        let place = [start[0], start[1], (start[2] + 1.0).ceil()];
        let velocity = [-speed * yaw.sin(), speed * yaw.cos(), 0.0].map(|v| f64::from(v as f32));
        w.set(&[("yaw", &[f64::from(yaw as f32)]), ("position", &place), ("velocity", &velocity)]);
    }
    let mut worst = 0.0f64;
    for tick in 0..625 {
        worlds.iter_mut().for_each(|w| w.step(keys(tick)));
        let (a, b) = (worlds[0].position(), worlds[1].position());
        worst = worst.max((0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt());
    }
    worst
}

#[test]
fn single_precision_costs_millimetres_in_20_s() {
    for (name, speed, keys) in [
        ("ski", 0.0, (|_| SKI) as fn(u32) -> RawInput),
        ("ski, fast", 30.0, |_| SKI),
        ("ski and turn", 10.0, |_| RawInput { turn: 0.1, ..SKI }),
        ("ski and jet", 10.0, |t| RawInput { jet: u8::from(t % 100 < 40), ..SKI }),
    ] {
        let mut all: Vec<f64> = (0..24).map(|k| apart(f64::from(k) * 0.26, speed, keys)).collect();
        all.sort_by(f64::total_cmp);
        println!("{name}: median {:.2e}, worst {:.2e} m", all[12], all[23]);
        assert!(all[23] < 3.3e-3, "{name}: {} m", all[23]);
    }
}
