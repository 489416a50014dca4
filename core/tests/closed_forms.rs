//! The closed forms and tables of docs/physics.md, in both tiers.
#![allow(missing_docs)]

mod common;

use common::*;
use discjump_core::batch::RawInput;

const TIERS: [&str; 2] = ["authentic", "reference"];

fn near(what: &str, got: f64, expected: f64, tolerance: f64) {
    assert!((got - expected).abs() <= tolerance, "{what}: expected {expected} +- {tolerance}, got {got}");
}

#[test]
fn free_fall_is_semi_implicit_euler() {
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        w.set(&[("position", &[0.0, 0.0, 500.0])]);
        let n = 100;
        (0..n).for_each(|_| w.step(IDLE));
        let dt = 0.032;
        let n = f64::from(n);
        near("fall", w.position()[2], 500.0 - 20.0 * dt * dt * n * (n + 1.0) / 2.0, 1e-3);
        near("speed", w.velocity()[2], -20.0 * dt * n, 1e-4);
    }
}

#[test]
fn jump_apex_on_flat_ground_is_1_603_m() {
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        (0..3).for_each(|_| w.step(IDLE));
        let start = w.position()[2];
        w.step(JUMP);
        let mut apex = 0.0f64;
        for _ in 0..25 {
            apex = apex.max(w.position()[2] - start);
            w.step(IDLE);
        }
        near("apex", apex, 1.603, 0.005);
    }
}

#[test]
fn full_burn_lasts_109_ticks_and_lifts_49_6_m() {
    for (armor, pack, ticks, speed, apex) in [
        ("light", false, 109, 21.7, 49.6),
        ("medium", false, 107, 15.8, 33.3),
        ("heavy", false, 130, 5.8, 12.9),
        ("light", true, 132, 26.3, 72.8),
        ("medium", true, 122, 18.0, 43.3),
        ("heavy", true, 146, 6.5, 16.2),
    ] {
        for tier in TIERS {
            let flat = slope(0.0);
            let mut s = setup(&flat, tier);
            (s.armor, s.energy_pack) = (armor, pack);
            let mut w = World { sim: s.build().unwrap() };
            let mut burned = 0;
            let mut highest = 0.0f64;
            let mut cutoff_speed = 0.0;
            let mut out = false;
            for _ in 0..600 {
                w.step(if out { IDLE } else { JET });
                if w.get("jetting")[0] == 1.0 {
                    burned += 1;
                    cutoff_speed = w.velocity()[2];
                } else {
                    out = true;
                }
                highest = highest.max(w.position()[2]);
            }
            assert_eq!(burned, ticks, "{armor} pack {pack} {tier}");
            near("speed at cut-off", cutoff_speed, speed, 0.06);
            near("apex", highest, apex, 0.06);
        }
    }
}

/// High above the ground with the jet key held, once the rhythm of an empty tank has set in.
fn ticks_burned_of_250_on_an_empty_tank(w: &mut World) -> f64 {
    w.set(&[("position", &[0.0, 0.0, 5000.0]), ("energy", &[0.0])]);
    (0..100).for_each(|_| w.step(JET));
    (0..250)
        .map(|_| {
            w.step(JET);
            w.get("jetting")[0]
        })
        .sum()
}

#[test]
fn holding_jets_on_an_empty_tank_burns_8_ticks_of_25() {
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        let burned = ticks_burned_of_250_on_an_empty_tank(&mut w);
        near("ticks of 250", burned, 80.0, 1.0);
    }
}

#[test]
fn without_hysteresis_the_empty_tank_burns_every_other_tick() {
    let flat = slope(0.0);
    let mut s = setup(&flat, "reference");
    s.physics.hysteresis = false;
    let mut w = World { sim: s.build().unwrap() };
    let burned = ticks_burned_of_250_on_an_empty_tank(&mut w);
    assert_eq!(burned, 125.0);
}

#[test]
fn sideways_thrust_fades_with_the_speed_along_the_pressed_direction() {
    // (speed along the key, expected gain sideways, expected gain up without gravity), m/s in a tick.
    let thrust = 236.0 / 9.0 * 0.032;
    for (speed, share) in [(-10.0, 0.8), (0.0, 0.8), (4.4, 0.8), (11.0, 0.5), (22.0, 0.0), (40.0, 0.0)] {
        for tier in TIERS {
            let flat = slope(0.0);
            let mut w = world(&flat, tier);
            w.face_east();
            w.set(&[("position", &[0.0, 0.0, 500.0]), ("velocity", &[speed, 0.0, 0.0])]);
            w.step(RawInput { jet: 1, ..FORWARD });
            near("sideways", w.velocity()[0] - speed, share * thrust, 1e-5);
            near("up", w.velocity()[2] + 0.64, (1.0 - share) * thrust, 1e-5);
        }
    }
}

#[test]
fn jets_push_straight_up_while_a_contact_is_recent() {
    let flat = slope(0.0);
    let mut w = world(&flat, "reference");
    w.face_east();
    (0..3).for_each(|_| w.step(IDLE));
    w.step(RawInput { jet: 1, ..FORWARD });
    // The sideways gain is walking alone; the jets lift by their full thrust.
    near("up", w.velocity()[2], 236.0 / 9.0 * 0.032 - 0.64, 0.002);
}

#[test]
fn forty_metres_a_second_stop_within_20_6_m() {
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        let start = w.position();
        w.set(&[("velocity", &[40.0, 0.0, 0.0])]);
        let mut ticks = 0;
        while w.velocity()[0] > 0.0 && ticks < 100 {
            w.step(IDLE);
            ticks += 1;
        }
        near("ticks", f64::from(ticks), 33.0, 0.0);
        near("distance", w.position()[0] - start[0], 20.6, 0.05);
    }
}

#[test]
fn walking_reaches_11_m_s_and_10_sideways() {
    let flat = slope(0.0);
    let mut w = world(&flat, "authentic");
    for (input, expected) in
        [(FORWARD, 11.0), (RawInput { strafe: 1, ..IDLE }, 10.0), (RawInput { forward: -1, ..IDLE }, 11.0)]
    {
        (0..60).for_each(|_| w.step(input));
        let v = w.velocity();
        near("walk", v[0].hypot(v[1]), expected, 0.02);
    }
}

#[test]
fn skiing_downhill_gives_the_table_of_section_10() {
    // Speed after 10 s. The table gives single instants of a rhythm in which the speed across the
    // slope swings by the jump itself, so the instant must lie in the swing of the hop around it.
    for (degrees, forward, none) in [
        (5.0, 15.0, 7.0),
        (10.0, 27.8, 1.3),
        (15.0, 42.0, 11.1),
        (20.0, 58.3, 14.9),
        (30.0, 88.6, 25.3),
        (45.0, 133.5, 30.1),
    ] {
        for tier in TIERS {
            let plane = slope(degrees);
            for (input, expected) in [(SKI, forward), (JUMP, none)] {
                let mut w = skier(&plane, degrees, tier);
                (0..300).for_each(|_| w.step(input));
                let swing: Vec<f64> = (0..28)
                    .map(|_| {
                        w.step(input);
                        w.speed()
                    })
                    .collect();
                let low = swing.iter().copied().fold(f64::MAX, f64::min);
                let high = swing.iter().copied().fold(0.0, f64::max);
                println!("{degrees} deg, forward {}: {low:.2} to {high:.2} ({expected})", input.forward);
                assert!(low - 0.1 <= expected && expected <= high + 0.1, "{degrees} deg: {low} to {high}");
            }
        }
    }
}

#[test]
fn skiing_accelerates_by_the_law_of_section_10() {
    // Along the slope, from contact to contact: 20 sin - 1.28 cos / T with the downhill key, and with
    // no keys 20 sin - (8.333 sin cos + 1.28 cos) / T.
    for degrees in [10.0, 20.0, 30.0, 45.0] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        for (input, jump, lost) in [
            (SKI, 25.0 / 3.0 - 1.28 * sin, 1.28 * cos),
            (JUMP, 25.0 / 3.0 * cos * cos - 1.28 * sin, 25.0 / 3.0 * sin * cos + 1.28 * cos),
        ] {
            let period = 2.0 * jump / (20.0 * cos);
            let law = 20.0 * sin - lost / period;
            let plane = slope(degrees);
            let mut w = skier(&plane, degrees, "reference");
            w.set(&[("velocity", &[40.0 * cos, 0.0, -40.0 * sin])]);
            let mut contacts = Vec::new();
            for tick in 0..400 {
                w.step(input);
                if w.get("touched")[0] == 1.0 {
                    let v = w.velocity();
                    contacts.push((f64::from(tick) * 0.032, v[0] * cos - v[2] * sin));
                }
            }
            let ((t0, v0), (t1, v1)) = (contacts[1], contacts[contacts.len() - 1]);
            let got = (v1 - v0) / (t1 - t0);
            // At 45 degrees without keys a hop is 14 ticks and the law is 10 % high, as it is against
            // the table, whose 30.1 m/s after 10 s lies below the law's 31.5.
            if !(degrees == 45.0 && input.forward == 0) {
                near("acceleration", got, law, 0.015 * 20.0 * sin);
            }
        }
    }
}

fn skier(plane: &discjump_core::terrain::Heightfield, degrees: f64, tier: &str) -> World {
    let mut w = world(plane, tier);
    w.set(&[("position", &[-1200.0, 0.0, 1200.0 * f64::to_radians(degrees).tan()])]);
    w.face_east();
    w
}

#[test]
fn without_jumping_there_is_no_skiing() {
    for tier in TIERS {
        let plane = slope(30.0);
        let mut w = world(&plane, tier);
        let (s, c) = f64::to_radians(30.0).sin_cos();
        w.set(&[("velocity", &[40.0 * c, 0.0, -40.0 * s]), ("touched", &[1.0]), ("friction", &[1.0])]);
        (0..63).for_each(|_| w.step(IDLE));
        near("speed after 2 s", w.speed(), 0.0, 0.05);
    }
}

#[test]
fn a_landing_at_30_m_s_costs_0_041() {
    // Section 10: starting 5 m up at 30 m/s down, 33.2 m/s at contact.
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        w.set(&[("position", &[0.0, 0.0, 5.0]), ("velocity", &[0.0, 0.0, -30.0])]);
        (0..10).for_each(|_| w.step(IDLE));
        near("damage", w.get("damage")[0], 0.041, 0.0005);
    }
}

#[test]
fn a_contact_allows_a_jump_in_the_next_8_ticks() {
    for delay in 1..=10 {
        let flat = slope(0.0);
        let mut w = world(&flat, "authentic");
        w.step(IDLE);
        // Lifted off right after the contact: nothing more is touched.
        let p = w.position();
        w.set(&[("position", &[p[0], p[1], p[2] + 300.0]), ("jump_age", &[0.0])]);
        (1..delay).for_each(|_| w.step(IDLE));
        let before = w.velocity()[2];
        w.step(JUMP);
        let jumped = w.velocity()[2] > before;
        assert_eq!(jumped, delay <= 8, "delay {delay}");
    }
}

#[test]
fn a_player_without_keys_stands_on_75_degrees() {
    let plane = slope(75.0);
    let mut w = world(&plane, "reference");
    (0..10).for_each(|_| w.step(IDLE));
    let start = w.position();
    (0..200).for_each(|_| w.step(IDLE));
    let end = w.position();
    near("crept", (end[0] - start[0]).abs() + (end[2] - start[2]).abs(), 0.0, 0.01);
}
