//! Item 20: numbers that are none, no aim at all, and huge angles.

use crate::common::crew::Crew;
use crate::common::{FORWARD, IDLE, TIERS, rolling, setup};
use discjump_core::batch::RawInput;
use discjump_core::tick::MAX_PITCH;

const NAN: f64 = f64::NAN;
const INF: f64 = f64::INFINITY;

fn crew(tier: &str) -> Crew {
    let map = rolling();
    let mut s = setup(&map, tier);
    (s.scene, s.players, s.players_per_world) = ("disc_jump", 4, 2);
    let mut crew = Crew::new(&s);
    crew.sim.step(&[FORWARD; 4], 20).unwrap();
    crew
}

/// Refused by name in every tier, for every player, and nothing is changed: not those before him either.
#[test]
fn e20_nan_and_infinite_inputs_change_nothing() {
    for tier in TIERS {
        let mut crew = crew(tier);
        let before = (crew.sim.digest(), crew.sim.snapshot());
        for player in 0..4 {
            for bad in [NAN, INF, -INF] {
                for (turn, pitch, name) in [(bad, 0.0, "turn"), (0.0, bad, "pitch")] {
                    let mut inputs = [FORWARD; 4];
                    (inputs[player].turn, inputs[player].pitch) = (turn, pitch);
                    let error = crew.sim.step(&inputs, 3).unwrap_err().0;
                    assert!(
                        error.starts_with(&format!("inputs[{player}].{name}: expected")),
                        "{tier}: {error}"
                    );
                }
                for name in
                    ["position", "velocity", "yaw", "pitch", "energy", "damage", "friction", "jump_normal"]
                {
                    let count = crew.get(player, name).len();
                    for k in 0..count {
                        let mut values = crew.get(player, name);
                        values[k] = bad;
                        let mut state = crew.bytes(player);
                        crate::common::write_fields(&*crew.sim, &mut state, &[(name, &values)]);
                        let error = crew.sim.set_state(&[player], &state).unwrap_err().0;
                        assert!(error.starts_with(&format!("state[0].{name}")), "{tier}: {error}");
                    }
                }
                // One number of a point that is no number is no explosion; an infinite one is refused.
                let mut points = [[NAN; 3]; 4];
                points[player] = [0.0, 0.0, bad];
                let refused = crew.sim.explode(&points, "disc");
                assert_eq!(refused.is_err(), bad.is_infinite(), "{tier}: {refused:?}");
            }
        }
        assert_eq!((crew.sim.digest(), crew.sim.snapshot()), before, "{tier}");
    }
}

/// No key is no direction: jets push straight up, a jump goes along the normal's up, and nothing is divided by
/// the length of nothing, at any yaw.
#[test]
fn e20_no_wish_is_no_direction() {
    for tier in TIERS {
        for yaw in [0.0, 3.0, -1e6, 1e6] {
            let mut crew = crew(tier);
            crew.put(0, [10.0, 20.0, 500.0], [0.0; 3]);
            crew.set(0, &[("yaw", &[yaw]), ("jump_age", &[0.0]), ("jump_normal", &[0.6, 0.0, 0.8])]);
            let both = RawInput { jump: 1, jet: 1, ..IDLE };
            crew.sim.step(&[both, IDLE, IDLE, IDLE], 1).unwrap();
            let v = crew.velocity(0);
            let up = 75.0 / 9.0 * 0.8 + (236.0 / 9.0 - 20.0) * 0.032;
            assert!(v[0] == 0.0 && v[1] == 0.0 && (v[2] - up).abs() < 1e-4, "{tier}, yaw {yaw}: {v:?}");
        }
    }
}

/// Yaws of a million radians are wrapped, more are refused; pitches of any size look 88 degrees up or down, and
/// the aim of a shot has length 1; the fastest turn keeps the yaw on the circle.
#[test]
fn e20_huge_angles() {
    let pi = core::f64::consts::PI;
    for tier in TIERS {
        for yaw in [1e6, -1e6, 123_456.789, pi, -pi] {
            let mut crew = crew(tier);
            crew.set(0, &[("yaw", &[yaw])]);
            let kept = crew.get(0, "yaw")[0];
            assert!(kept.abs() <= pi + 1e-6, "{tier}: {kept}");
            // The same view, to what f32 holds of a million radians.
            let turns = (yaw - kept) / (2.0 * pi);
            assert!((turns - turns.round()).abs() < 0.02, "{tier}: {yaw} became {kept}");
            let mut state = crew.bytes(0);
            crate::common::write_fields(&*crew.sim, &mut state, &[("yaw", &[1.1e6_f64.copysign(yaw)])]);
            assert!(crew.sim.set_state(&[0], &state).unwrap_err().0.starts_with("state[0].yaw"));
        }
        for pitch in [MAX_PITCH, 1.6, -1.6, 1e6, -1e300, f64::MAX] {
            for turn in [1000.0, -1000.0] {
                let mut crew = crew(tier);
                let wild = RawInput { fire: 1, pitch, turn, ..FORWARD };
                for _ in 0..40 {
                    crew.sim.step(&[wild, IDLE, IDLE, IDLE], 1).unwrap();
                    assert!(crew.get(0, "yaw")[0].abs() <= pi + 1e-6, "{tier}");
                    let looks = crew.get(0, "pitch")[0];
                    assert!(
                        (looks - MAX_PITCH.copysign(pitch)).abs() < 1e-6,
                        "{tier}: {pitch} became {looks}"
                    );
                    for shot in crew.sim.projectiles() {
                        let length = shot.axis.iter().map(|a| a * a).sum::<f64>().sqrt();
                        assert!((length - 1.0).abs() < 1e-6, "{tier}: {shot:?}");
                    }
                    assert!(
                        crew.velocity(0).iter().chain(&crew.position(0)).all(|x| x.is_finite()),
                        "{tier}"
                    );
                }
            }
        }
    }
}
