//! What the physics tests share: worlds of planes, and a simulator that is read by field name.
#![allow(dead_code, missing_docs)]

pub mod crew;
pub mod crowd;
pub mod draws;
pub mod envs;
pub mod lab;
pub mod random;
pub mod range;
pub mod solids;

use discjump_core::batch::{Bodies, RawInput, SimulatorSetup};
use discjump_core::player::FieldKind;
use discjump_core::rules::Physics;
use discjump_core::terrain::{Edge, Heightfield};

/// A plane that falls towards +x by `degrees`: 4 km long, 32 m wide, its centre at height 0.
pub fn slope(degrees: f64) -> Heightfield {
    let (rows, cols) = (5, 513);
    let gradient = -degrees.to_radians().tan();
    let heights = (0..rows * cols).map(|k| gradient * 8.0 * ((k % cols) as f64 - 256.0)).collect();
    Heightfield::new(heights, rows, cols, 8.0, [-2048.0, -16.0], Edge::Clamp).unwrap()
}

/// Flat ground at height 0, 8 km square.
pub fn flat() -> Heightfield {
    Heightfield::new(vec![0.0; 9], 3, 3, 4096.0, [-4096.0, -4096.0], Edge::Clamp).unwrap()
}

/// A valley along y with faces of so many degrees, lowest at x = 0.
pub fn valley(degrees: f64) -> Heightfield {
    let n = 33;
    let steep = degrees.to_radians().tan();
    let heights = (0..n * n).map(|k| steep * 8.0 * ((k % n) as f64 - 16.0).abs()).collect();
    Heightfield::new(heights, n, n, 8.0, [-128.0, -128.0], Edge::Clamp).unwrap()
}

/// Rolling terrain that tiles: hills of 10 m every 256 m and smaller ones between.
pub fn rolling() -> Heightfield {
    let n = 65;
    let wave = |i: usize, k: f64| (core::f64::consts::TAU * k * (i % (n - 1)) as f64 / (n - 1) as f64).sin();
    let heights = (0..n * n)
        .map(|k| {
            let (i, j) = (k % n, k / n);
            30.0 + 10.0 * wave(i, 2.0) * wave(j, 2.0) + 4.0 * wave(i + 3, 5.0) + 3.0 * wave(j, 7.0)
        })
        .collect();
    Heightfield::new(heights, n, n, 8.0, [0.0, 0.0], Edge::Tile).unwrap()
}

/// The tiers of the article's model.
pub const ARTICLE: [&str; 5] = ["authentic", "reference", "swept", "fast", "anyway"];
/// Every tier.
pub const TIERS: [&str; 6] = ["authentic", "reference", "swept", "fast", "anyway", "engine"];

/// A number of the article's model, or of the engine's.
pub fn by_model(tier: &str, article: f64, engine: f64) -> f64 {
    if tier == "engine" { engine } else { article }
}

#[track_caller]
pub fn near(what: &str, got: f64, expected: f64, tolerance: f64) {
    assert!((got - expected).abs() <= tolerance, "{what}: expected {expected} +- {tolerance}, got {got}");
}

pub struct World {
    pub sim: Box<dyn Bodies>,
}

pub fn world(terrain: &Heightfield, fidelity: &str) -> World {
    World { sim: setup(terrain, fidelity).build().unwrap() }
}

pub fn setup<'a>(terrain: &'a Heightfield, fidelity: &'a str) -> SimulatorSetup<'a> {
    SimulatorSetup {
        terrain,
        solids: None,
        players: 1,
        players_per_world: 1,
        scene: "sandbox",
        armor: "light",
        energy_pack: false,
        weapon: "disc",
        ammo: None,
        fidelity,
        precision: None,
        physics: Physics::default(),
        tick_ms: 32,
        threads: Some(1),
        lanes: None,
    }
}

/// Byte offset of a field of a state, and its type and count.
fn field(sim: &dyn Bodies, name: &str) -> (usize, FieldKind, usize) {
    if name == "position" {
        return (0, FieldKind::Real { double: true }, 3);
    }
    let mut at = 24;
    for f in sim.state_fields() {
        if f.name == name {
            return (at, f.kind, f.count);
        }
        at += f.kind.bytes() * f.count;
    }
    panic!("no field {name}");
}

/// A field of a packed state.
pub fn read_field(sim: &dyn Bodies, state: &[u8], name: &str) -> Vec<f64> {
    let (at, kind, count) = field(sim, name);
    (0..count)
        .map(|k| {
            let b = &state[at + k * kind.bytes()..];
            match kind {
                FieldKind::Real { double: true } => f64::from_le_bytes(b[..8].try_into().unwrap()),
                FieldKind::Real { double: false } => {
                    f64::from(f32::from_le_bytes(b[..4].try_into().unwrap()))
                }
                FieldKind::Int => f64::from(i32::from_le_bytes(b[..4].try_into().unwrap())),
                FieldKind::Flag => f64::from(b[0]),
            }
        })
        .collect()
}

/// Overwrites fields of a packed state.
pub fn write_fields(sim: &dyn Bodies, state: &mut [u8], fields: &[(&str, &[f64])]) {
    for &(name, values) in fields {
        let (at, kind, count) = field(sim, name);
        assert_eq!(values.len(), count, "{name}");
        for (k, &v) in values.iter().enumerate() {
            let at = at + k * kind.bytes();
            match kind {
                FieldKind::Real { double: true } => state[at..at + 8].copy_from_slice(&v.to_le_bytes()),
                FieldKind::Real { double: false } => {
                    state[at..at + 4].copy_from_slice(&(v as f32).to_le_bytes());
                }
                FieldKind::Int => state[at..at + 4].copy_from_slice(&(v as i32).to_le_bytes()),
                FieldKind::Flag => state[at] = v as u8,
            }
        }
    }
}

impl World {
    /// A field of player 0.
    pub fn get(&self, name: &str) -> Vec<f64> {
        read_field(&*self.sim, &self.sim.state(), name)
    }

    /// Overwrites fields of player 0.
    pub fn set(&mut self, fields: &[(&str, &[f64])]) {
        let stride = self.sim.state_bytes();
        let mut state = self.sim.state()[..stride].to_vec();
        write_fields(&*self.sim, &mut state, fields);
        self.sim.set_state(&[0], &state).unwrap();
    }

    pub fn step(&mut self, input: RawInput) {
        self.sim.step(&[input], 1).unwrap();
    }

    pub fn position(&self) -> [f64; 3] {
        self.get("position").try_into().unwrap()
    }

    pub fn velocity(&self) -> [f64; 3] {
        self.get("velocity").try_into().unwrap()
    }

    pub fn speed(&self) -> f64 {
        self.velocity().iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    /// Looks along +x: downhill on [`slope`].
    pub fn face_east(&mut self) {
        self.set(&[("yaw", &[-core::f64::consts::FRAC_PI_2])]);
    }
}

pub const JUMP: RawInput =
    RawInput { forward: 0, strafe: 0, jump: 1, jet: 0, fire: 0, turn: 0.0, pitch: 0.0 };
pub const JET: RawInput = RawInput { jump: 0, jet: 1, ..JUMP };
pub const IDLE: RawInput = RawInput { jump: 0, ..JUMP };
pub const FORWARD: RawInput = RawInput { forward: 1, ..IDLE };
pub const SKI: RawInput = RawInput { forward: 1, ..JUMP };

/// The widths of lanes beside 1 that this processor must have, by its own word.
#[cfg(target_arch = "x86_64")]
pub fn widths() -> impl Iterator<Item = usize> {
    let eight = is_x86_feature_detected!("avx2");
    let sixteen = is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512bw");
    [(8, eight), (16, sixteen), (32, sixteen)].into_iter().filter(|width| width.1).map(|width| width.0)
}

/// None but on x86-64.
#[cfg(not(target_arch = "x86_64"))]
pub fn widths() -> impl Iterator<Item = usize> {
    core::iter::empty()
}
