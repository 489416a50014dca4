//! What `Bodies::contacts` tells is what the next tick does.
//!
//! Each contact turns the velocity out of its surface and adds the outward push of section 4.4; so between two
//! contacts of a tick, and after the last one, the velocity is known from the list alone.
#![allow(missing_docs)]

mod common;

use common::*;
use discjump_core::batch::{Contact, RawInput};
use discjump_core::terrain::{Edge, Heightfield};

fn after(contact: &Contact) -> [f64; 3] {
    let (v, n) = (contact.velocity, contact.normal);
    let impact = -(v[0] * n[0] + v[1] * n[1] + v[2] * n[2]);
    core::array::from_fn(|k| v[k] + n[k] * (impact + 0.001))
}

/// A crease of two planes that rise by 1 in 2 on both sides of x = 0.
fn crease() -> Heightfield {
    let heights = (0..33 * 33).map(|k| 4.0 * f64::from(k % 33 - 16).abs()).collect();
    Heightfield::new(heights, 33, 33, 8.0, [-128.0; 2], Edge::Clamp).unwrap()
}

#[test]
fn velocities_follow_from_contact_to_contact() {
    for (tier, most) in [("authentic", 4), ("reference", 4), ("swept", 4), ("fast", 3)] {
        let map = crease();
        let mut sim = setup(&map, tier).build().unwrap();
        let (mut contacts, mut ticks) = (0, 0);
        // Falls into the crease and rocks in it.
        let keys = RawInput { forward: 1, turn: 0.4, ..RawInput::default() };
        for _ in 0..400 {
            let before = sim.snapshot();
            let found = sim.contacts(0, &keys).unwrap();
            assert_eq!(sim.snapshot(), before, "asking changes nothing");
            assert!(found.len() <= most, "{tier}: {}", found.len());
            for pair in found.windows(2) {
                let (told, expected) = (pair[1].velocity, after(&pair[0]));
                let error = (0..3).map(|k| (told[k] - expected[k]).abs()).fold(0.0, f64::max);
                assert!(error < 1e-5 * (1.0 + told[2].abs()), "{tier}: {told:?}, expected {expected:?}");
            }
            sim.step(&[keys], 1).unwrap();
            contacts += found.len();
            ticks += usize::from(!found.is_empty());
        }
        assert!(ticks > 100 && contacts > ticks, "{tier}: {contacts} contacts in {ticks} ticks");
    }
}

#[test]
fn a_player_in_the_air_has_none_and_one_on_level_ground_has_one() {
    for tier in ["authentic", "reference", "swept", "fast", "engine"] {
        let flat = Heightfield::new(vec![5.0; 9], 3, 3, 8.0, [0.0; 2], Edge::Tile).unwrap();
        let mut sim = setup(&flat, tier).build().unwrap();
        let idle = RawInput::default();
        let found = sim.contacts(0, &idle).unwrap();
        assert_eq!(found.len(), 1, "{tier}: {found:?}");
        assert_eq!(found[0].normal, [0.0, 0.0, 1.0]);
        // The tick after a contact may jump.
        sim.step(&[idle], 1).unwrap();
        let up = RawInput { jump: 1, ..idle };
        assert!(sim.contacts(0, &up).unwrap().is_empty(), "{tier}");
        sim.step(&[up], 4).unwrap();
        assert!(sim.contacts(0, &idle).unwrap().is_empty(), "{tier}");
        let refused = sim.contacts(1, &idle).unwrap_err().to_string();
        assert_eq!(refused, "player: expected 0 to 0, got 1");
        let wrong = RawInput { forward: 2, ..idle };
        assert!(sim.contacts(0, &wrong).unwrap_err().to_string().contains("forward: expected -1, 0 or 1"));
    }
}
