//! Every tier against the reference on rolling terrain. Section 12 of docs/physics.md says that single
//! precision costs less than 3.3 mm in 20 s; what the other tiers cost is docs/tiers.md.
#![allow(missing_docs)]

mod common;

use common::*;
use discjump_core::batch::RawInput;

type Keys = fn(u32) -> RawInput;

const SCRIPTS: [(&str, f64, Keys); 5] = [
    ("ski", 0.0, |_| SKI),
    ("ski, fast", 30.0, |_| SKI),
    ("ski and turn", 10.0, |_| RawInput { turn: 0.1, ..SKI }),
    ("ski and jet", 10.0, |t| RawInput { jet: u8::from(t % 100 < 40), ..SKI }),
    ("walk", 0.0, |_| FORWARD),
];

/// How far a tier and the reference are apart after each tick of 20 s of the same keys: in place and in speed.
fn apart(tier: &str, yaw: f64, speed: f64, keys: Keys) -> Vec<(f64, f64)> {
    let map = rolling();
    let mut worlds = [world(&map, tier), world(&map, "reference")];
    for w in &mut worlds {
        let start = w.position();
        // Exact in both tiers, so that nothing but the arithmetic differs.
        let place = [start[0], start[1], (start[2] + 1.0).ceil()];
        let velocity = [-speed * yaw.sin(), speed * yaw.cos(), 0.0].map(|v| f64::from(v as f32));
        w.set(&[("yaw", &[f64::from(yaw as f32)]), ("position", &place), ("velocity", &velocity)]);
    }
    (0..625)
        .map(|tick| {
            worlds.iter_mut().for_each(|w| w.step(keys(tick)));
            let (a, b) = (worlds[0].position(), worlds[1].position());
            let place = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
            (place, (worlds[0].speed() - worlds[1].speed()).abs())
        })
        .collect()
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = values.collect();
    all.sort_by(f64::total_cmp);
    all
}

#[test]
fn measure() {
    for tier in ["fast"] {
        for (name, speed, keys) in SCRIPTS {
            let runs: Vec<_> = (0..24).map(|k| apart(tier, f64::from(k) * 0.26, speed, keys)).collect();
            let at = |tick: usize| {
                let place = sorted(runs.iter().map(|r| r[tick - 1].0));
                let v = sorted(runs.iter().map(|r| r[tick - 1].1));
                format!("{:.4} {:.3} {:.3} v {:.3} {:.3}", place[6], place[12], place[21], v[12], v[21])
            };
            println!("{tier:8} {name:14} 1 s {}; 5 s {}; 20 s {}", at(31), at(156), at(625));
        }
    }
}
