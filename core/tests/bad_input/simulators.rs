//! Simulators: what they are made from, inputs and states.

use crate::common::*;
use crate::{INF, NAN, refused};
use discjump_core::batch::{Bodies, RawInput, SimulatorSetup};
use discjump_core::error::InputError;
use discjump_core::player::FieldKind;

#[test]
fn simulators() {
    let map = rolling();
    let build = |change: fn(&mut SimulatorSetup<'_>)| {
        let mut s = setup(&map, "authentic");
        change(&mut s);
        s.build()
    };
    assert!(build(|_| ()).is_ok());
    refused(build(|s| s.players = 0), "num_players", "0");
    refused(build(|s| s.players = (1 << 24) + 1), "num_players", "16777217");
    refused(build(|s| s.threads = Some(0)), "threads", "0");
    refused(build(|s| s.threads = Some(257)), "threads", "257");
    refused(build(|s| s.scene = "race"), "scene", "\"race\"");
    refused(build(|s| s.fidelity = "exact"), "fidelity", "\"exact\"");
    refused(build(|s| s.precision = Some("double")), "precision", "\"double\"");
    refused(
        build(|s| (s.fidelity, s.precision) = ("reference", Some("float32"))),
        "precision",
        "\"authentic\" in float64",
    );
    refused(build(|s| s.armor = "Light"), "armor", "\"Light\"");
    refused(build(|s| s.tick_ms = 0), "tick_ms", "0");
    refused(build(|s| s.tick_ms = 1001), "tick_ms", "1001");
}

/// Runs `call` on a batch that has been played, and checks that it changes no bit.
#[track_caller]
fn unchanged(
    sim: &mut dyn Bodies,
    call: impl FnOnce(&mut dyn Bodies) -> Result<(), InputError>,
    argument: &str,
    got: &str,
) {
    let before = (sim.digest(), sim.state(), sim.snapshot());
    refused(call(sim), argument, got);
    assert_eq!((sim.digest(), sim.state(), sim.snapshot()), before, "{argument}: {got}");
}

fn played(tier: &str) -> Box<dyn Bodies> {
    let map = rolling();
    let mut s = setup(&map, tier);
    s.players = 3;
    let mut sim = s.build().unwrap();
    sim.step(&[SKI; 3], 30).unwrap();
    sim
}

#[test]
fn inputs_of_a_step() {
    for tier in ["authentic", "reference"] {
        let mut sim = played(tier);
        let mut bad = |change: fn(&mut RawInput), argument: &str, got: &str| {
            let mut inputs = [SKI; 3];
            change(&mut inputs[2]);
            let argument = format!("inputs[2].{argument}");
            unchanged(&mut *sim, |s| s.step(&inputs, 1), &argument, got);
        };
        bad(|i| i.forward = 2, "forward", "2");
        bad(|i| i.forward = i8::MIN, "forward", "-128");
        bad(|i| i.strafe = -2, "strafe", "-2");
        bad(|i| i.jump = 2, "jump", "2");
        bad(|i| i.jet = 255, "jet", "255");
        bad(|i| i.fire = 7, "fire", "7");
        bad(|i| i.turn = NAN, "turn", "NaN");
        bad(|i| i.turn = -INF, "turn", "-inf");
        bad(|i| i.turn = 1000.1, "turn", "1000.1");
        bad(|i| i.pitch = NAN, "pitch", "NaN");
        bad(|i| i.pitch = INF, "pitch", "inf");
        unchanged(&mut *sim, |s| s.step(&[SKI; 2], 1), "inputs", "2");
        unchanged(&mut *sim, |s| s.step(&[], 1), "inputs", "0");
    }
}

/// A state of player 0 with one number of a field replaced.
fn state_with(sim: &dyn Bodies, name: &str, at: usize, value: f64) -> Vec<u8> {
    let mut state = sim.state()[..sim.state_bytes()].to_vec();
    if name == "position" {
        state[8 * at..8 * at + 8].copy_from_slice(&value.to_le_bytes());
        return state;
    }
    let mut offset = 24;
    for f in sim.state_fields() {
        if f.name == name {
            let offset = offset + at * f.kind.bytes();
            match (f.kind, f.kind.bytes()) {
                (FieldKind::Int, _) => {
                    state[offset..offset + 4].copy_from_slice(&(value as i32).to_le_bytes());
                }
                (_, 8) => state[offset..offset + 8].copy_from_slice(&value.to_le_bytes()),
                _ => state[offset..offset + 4].copy_from_slice(&(value as f32).to_le_bytes()),
            }
            return state;
        }
        offset += f.kind.bytes() * f.count;
    }
    panic!("no field {name}");
}

#[test]
fn states() {
    for tier in ["authentic", "reference"] {
        let mut sim = played(tier);
        let good = sim.state()[..sim.state_bytes()].to_vec();
        for (name, at, value, got) in [
            ("position", 0, NAN, "NaN"),
            ("position", 1, INF, "inf"),
            ("position", 2, -INF, "-inf"),
            ("position", 0, 1.1e9, "1100000000"),
            ("velocity", 0, NAN, "NaN"),
            ("velocity", 2, INF, "inf"),
            ("velocity", 1, -1.1e6, "-1100000"),
            ("yaw", 0, NAN, "NaN"),
            ("yaw", 0, 1.5e6, "1500000"),
            ("pitch", 0, INF, "inf"),
            ("energy", 0, -1.0, "-1"),
            ("energy", 0, 60.5, "60.5"),
            ("energy", 0, NAN, "NaN"),
            ("damage", 0, -0.5, "-0.5"),
            ("damage", 0, NAN, "NaN"),
            ("friction", 0, 1.5, "1.5"),
            ("friction", 0, NAN, "NaN"),
            ("jump_normal", 2, 3.0, "3"),
            ("jump_normal", 0, NAN, "NaN"),
            ("jump_age", 0, -1.0, "-1"),
        ] {
            let bad = state_with(&*sim, name, at, value);
            // The good one before it must not be taken either.
            let both = [good.clone(), bad].concat();
            let argument = format!("state[1].{name}");
            unchanged(&mut *sim, |s| s.set_state(&[2, 0], &both), &argument, got);
        }
        unchanged(&mut *sim, |s| s.set_state(&[3], &good), "indices", "3");
        unchanged(&mut *sim, |s| s.set_state(&[usize::MAX], &good), "indices", "18446744073709551615");
        unchanged(&mut *sim, |s| s.set_state(&[0, 1], &good), "state", "2 states");
        unchanged(
            &mut *sim,
            |s| s.set_state(&[0], &good[1..]),
            "state",
            &format!("{} bytes", good.len() - 1),
        );
        sim.set_state(&[], &[]).unwrap();
    }
}
