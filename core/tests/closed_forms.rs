//! The closed forms and tables of docs/physics.md, in every tier. Skiing is in skiing.rs.
#![allow(missing_docs)]

mod common;

use common::*;
use discjump_core::batch::{RawInput, SimulatorSetup as Setup};

/// Semi-implicit Euler, or the trapezoid, which is exact.
#[test]
fn free_fall() {
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        w.set(&[("position", &[0.0, 0.0, 500.0])]);
        let n = 100;
        (0..n).for_each(|_| w.step(IDLE));
        let dt = 0.032;
        let n = f64::from(n);
        let ahead = by_model(tier, n, 0.0);
        near("fall", w.position()[2], 500.0 - 10.0 * dt * dt * (n * n + ahead), 2e-3);
        near("speed", w.velocity()[2], -20.0 * dt * n, 1e-4);
    }
}

/// v^2/2g - v dt/2 in the article's model, v^2/2g in the engine's, with v = J/m.
#[test]
fn jump_apex_on_flat_ground_is_1_603_m_or_1_736_m() {
    for (armor, article, engine) in
        [("light", 1.603, 1.736), ("medium", 1.655, 1.790), ("heavy", 1.603, 1.736)]
    {
        for tier in TIERS {
            let flat = slope(0.0);
            let mut w = World { sim: Setup { armor, ..setup(&flat, tier) }.build().unwrap() };
            (0..3).for_each(|_| w.step(IDLE));
            let start = w.position()[2];
            w.step(JUMP);
            let mut apex = 0.0f64;
            for _ in 0..25 {
                apex = apex.max(w.position()[2] - start);
                w.step(IDLE);
            }
            near(tier, apex, by_model(tier, article, engine), 0.005);
        }
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
            let setup = Setup { armor, energy_pack: pack, ..setup(&flat, tier) };
            let mut w = World { sim: setup.build().unwrap() };
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
fn an_empty_tank_is_full_again_in_7_5_s() {
    for (armor, pack, seconds) in [
        ("light", false, 7.5),
        ("light", true, 60.0 / 11.0),
        ("medium", false, 10.0),
        ("heavy", false, 13.75),
    ] {
        for tier in TIERS {
            let flat = slope(0.0);
            let setup = Setup { armor, energy_pack: pack, ..setup(&flat, tier) };
            let mut w = World { sim: setup.build().unwrap() };
            let full = w.get("energy")[0];
            w.set(&[("energy", &[0.0])]);
            let ticks = (1..1000).find(|_| {
                w.step(IDLE);
                w.get("energy")[0] == full
            });
            near("ticks", f64::from(ticks.unwrap()), seconds / 0.032, 1.0);
        }
    }
}

#[test]
fn jets_push_straight_up_while_a_contact_is_recent() {
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        w.face_east();
        (0..3).for_each(|_| w.step(IDLE));
        w.step(RawInput { jet: 1, ..FORWARD });
        // The sideways gain is walking alone; the jets lift by their full thrust.
        near("up", w.velocity()[2], 236.0 / 9.0 * 0.032 - 0.64, 0.002);
    }
}

/// Directly after a jump the article's jets push sideways in the same tick, the engine's in the next.
#[test]
fn a_jump_turns_the_jets_sideways_at_once_or_a_tick_later() {
    for tier in TIERS {
        let flat = slope(0.0);
        let mut w = world(&flat, tier);
        w.face_east();
        (0..3).for_each(|_| w.step(IDLE));
        let thrust = 236.0 / 9.0 * 0.032;
        let mut ups = Vec::new();
        for input in [RawInput { jet: 1, ..SKI }, RawInput { jet: 1, ..FORWARD }] {
            let before = w.velocity()[2];
            w.step(input);
            ups.push(w.velocity()[2] - before + 0.64);
        }
        near(tier, ups[0], 25.0 / 3.0 + thrust * by_model(tier, 0.2, 1.0), 0.01);
        near(tier, ups[1], thrust * 0.2, 1e-4);
    }
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
        near(tier, f64::from(ticks), 33.0, 0.0);
        near(tier, w.position()[0] - start[0], 20.6, by_model(tier, 0.05, 0.7));
    }
}

/// Forward, sideways and back, and forward and right together: shortened to the faster key.
#[test]
fn walking_reaches_11_m_s_and_10_sideways() {
    for (armor, forward, side) in [("light", 11.0, 10.0), ("medium", 8.0, 7.0), ("heavy", 5.0, 4.0)] {
        for tier in TIERS {
            let flat = slope(0.0);
            for (keys, expected) in [
                ([1, 0], forward),
                ([0, 1], side),
                ([-1, 0], by_model(tier, forward, side)),
                ([1, 1], forward),
                ([-1, -1], by_model(tier, forward, side)),
            ] {
                let mut w = World { sim: Setup { armor, ..setup(&flat, tier) }.build().unwrap() };
                (0..60).for_each(|_| w.step(RawInput { forward: keys[0], strafe: keys[1], ..IDLE }));
                let v = w.velocity();
                near(tier, v[0].hypot(v[1]), expected, 0.02);
            }
        }
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

/// Section 10: the landing that kills from full health, by armor.
#[test]
fn landings_at_157_225_and_245_m_s_kill() {
    for (armor, health, speed) in [("light", 0.66, 157.0), ("medium", 1.0, 225.0), ("heavy", 1.32, 245.0)] {
        for tier in TIERS {
            let flat = slope(0.0);
            let mut w = World { sim: Setup { armor, ..setup(&flat, tier) }.build().unwrap() };
            w.set(&[("position", &[0.0, 0.0, 20.0]), ("velocity", &[0.0, 0.0, -speed])]);
            let mut contact = 0.0;
            while w.get("damage")[0] == 0.0 {
                contact = 0.64 - w.velocity()[2];
                w.step(IDLE);
            }
            let scale = if armor == "heavy" { 0.006 } else { 0.005 };
            // Gravity adds to the speed before the contact.
            near(tier, w.get("damage")[0], health + scale * (contact - speed), 1e-4);
        }
    }
}

/// A contact in tick k allows a jump in ticks k+1 to k+8, in the engine to k+7.
#[test]
fn a_contact_allows_a_jump_in_the_next_8_ticks_or_7() {
    for tier in TIERS {
        let last = (1..=12)
            .take_while(|&delay| {
                let flat = slope(0.0);
                let mut w = world(&flat, tier);
                w.step(IDLE);
                // Lifted off right after the contact: nothing more is touched.
                let p = w.position();
                w.set(&[("position", &[p[0], p[1], p[2] + 300.0])]);
                (1..delay).for_each(|_| w.step(IDLE));
                let before = w.velocity()[2];
                w.step(JUMP);
                w.velocity()[2] > before
            })
            .last();
        near(tier, f64::from(last.unwrap()), by_model(tier, 8.0, 7.0), 0.0);
    }
}
