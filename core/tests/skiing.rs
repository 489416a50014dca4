//! Skiing, sliding and standing on planes: the tables and laws of docs/physics.md, sections 4.4 and 10, in
//! every tier.
#![allow(missing_docs)]

mod common;

use common::*;
use discjump_core::batch::RawInput;

#[test]
fn skiing_downhill_gives_the_table_of_section_10() {
    // Speed after 10 s. The table gives single instants of a rhythm in which the speed across the
    // slope swings by the jump itself, so the instant must lie in the swing of the hop around it.
    for (degrees, article, engine) in [
        (5.0, [15.0, 7.0], [12.9, 2.6]),
        (10.0, [27.8, 1.3], [26.7, 8.7]),
        (15.0, [42.0, 11.1], [41.6, 9.7]),
        (20.0, [58.3, 14.9], [58.3, 19.9]),
        (30.0, [88.6, 25.3], [89.8, 30.0]),
        (45.0, [133.5, 30.1], [135.3, 35.1]),
    ] {
        for tier in TIERS {
            let plane = slope(degrees);
            for (k, input) in [SKI, JUMP].into_iter().enumerate() {
                let expected = by_model(tier, article[k], engine[k]);
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
                println!(
                    "{tier} {degrees} deg, forward {}: {low:.2} to {high:.2}, at 10 s {:.2} ({expected})",
                    input.forward, swing[12]
                );
                assert!(
                    low - 0.1 <= expected && expected <= high + 0.1,
                    "{tier} {degrees} deg: {low} to {high}, expected {expected}"
                );
            }
        }
    }
}

/// Along the slope, from contact to contact: 20 sin - 1.28 cos / T with the downhill key, and with no
/// keys 20 sin - (8.333 sin cos + 1.28 cos) / T. In the engine a hop lasts 0.7 ticks longer.
#[test]
fn skiing_accelerates_by_the_law_of_section_10() {
    for degrees in [5.0, 10.0, 20.0, 30.0, 45.0] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        for (input, jump, lost) in [
            (SKI, 25.0 / 3.0 - 1.28 * sin, 1.28 * cos),
            (JUMP, 25.0 / 3.0 * cos * cos - 1.28 * sin, 25.0 / 3.0 * sin * cos + 1.28 * cos),
        ] {
            for tier in TIERS {
                let period = 2.0 * jump / (20.0 * cos) + by_model(tier, 0.0, 0.7 * 0.032);
                let law = 20.0 * sin - lost / period;
                let (got, hop) = hops(tier, degrees, input);
                println!(
                    "{tier} {degrees} deg, forward {}: {got:.3} m/s^2, law {law:.3}; hop {hop:.3} s, {period:.3}",
                    input.forward
                );
                // At 45 degrees without keys a hop is 14 ticks and the law is 10 % high, as it is against
                // the table, whose 30.1 m/s after 10 s lies below the law's 31.5.
                if degrees == 45.0 && input.forward == 0 {
                    continue;
                }
                let share = if degrees < 10.0 { 0.03 } else { 0.015 };
                near(tier, got, law, share * 20.0 * sin);
                // Contacts fall on whole ticks, a little before the surface is reached.
                near(tier, hop, period, 0.06 * period);
            }
        }
    }
}

/// Acceleration along a plane and period of the hops of 12.8 s from 40 m/s on.
fn hops(tier: &str, degrees: f64, input: RawInput) -> (f64, f64) {
    let (sin, cos) = f64::to_radians(degrees).sin_cos();
    let plane = slope(degrees);
    let mut w = skier(&plane, degrees, tier);
    w.set(&[("velocity", &[40.0 * cos, 0.0, -40.0 * sin])]);
    let mut contacts = Vec::new();
    let mut flying = true;
    for tick in 0..400 {
        w.step(input);
        let touched = w.get("touched")[0] == 1.0;
        // The engine's sphere still overlaps the plane in the tick that jumps off.
        if touched && flying {
            let v = w.velocity();
            contacts.push((f64::from(tick) * 0.032, v[0] * cos - v[2] * sin));
        }
        flying = !touched;
    }
    let last = contacts.len() - 1;
    let ((t0, v0), (t1, v1)) = (contacts[1], contacts[last]);
    ((v1 - v0) / (t1 - t0), (t1 - t0) / (last - 1) as f64)
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
        near(tier, w.speed(), 0.0, 0.05);
    }
}

/// On 45 degrees it takes longer: 12.9 m/s are left after 2 s, and they become fewer.
#[test]
fn without_jumping_45_degrees_brake_too() {
    for tier in ARTICLE {
        let plane = slope(45.0);
        let mut w = world(&plane, tier);
        let v = 40.0 * core::f64::consts::FRAC_1_SQRT_2;
        w.set(&[("velocity", &[v, 0.0, -v])]);
        (0..62).for_each(|_| w.step(IDLE));
        near(tier, w.speed(), 12.9, 0.1);
        let earlier = w.speed();
        (0..10).for_each(|_| w.step(IDLE));
        assert!(w.speed() < earlier, "{tier}: {} m/s", w.speed());
    }
}

#[test]
fn a_player_without_keys_stands_on_75_degrees() {
    for tier in ARTICLE {
        let plane = slope(75.0);
        let mut w = world(&plane, tier);
        (0..10).for_each(|_| w.step(IDLE));
        let start = w.position();
        (0..200).for_each(|_| w.step(IDLE));
        let end = w.position();
        near(tier, (end[0] - start[0]).abs() + (end[2] - start[2]).abs(), 0.0, 0.01);
    }
}
