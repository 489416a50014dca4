//! The contract of snapshots, in bits.
//!
//! A snapshot holds everything: going on from it, in the same batch or in another one of the same layout,
//! gives the bits of never having stopped. One that is damaged, cut short, of another layout or of another
//! count is refused, and nothing changes.
#![allow(missing_docs)]

mod common;

use common::crowd::{play, simulator};
use common::envs::{Envs, ski};
use common::*;
use discjump_core::batch::{Autoreset, EnvironmentsSetup};
use discjump_core::random::{Purpose, bits};
use discjump_core::terrain::{Edge, Heightfield, Maps};

const TIERS: [&str; 5] = ["authentic", "reference", "swept", "fast", "engine"];

#[test]
fn a_simulator_goes_on_from_a_snapshot() {
    for tier in TIERS {
        for round in 0..6 {
            let stop = bits(round, 0, Purpose::Start, 0) % 150;
            let names = [1, 2, 3];
            let mut whole = simulator(3, 1, tier);
            play(&mut *whole, &names, 0..stop);
            let snapshot = whole.snapshot();
            play(&mut *whole, &names, stop..200);

            let mut other = simulator(3, 1, tier);
            other.restore(&snapshot).unwrap();
            assert_eq!(other.snapshot(), snapshot);
            play(&mut *other, &names, stop..200);
            assert_eq!(other.digest(), whole.digest(), "{tier}, from tick {stop}");
            assert_eq!(other.state(), whole.state());
            // And back, in the batch that had gone on.
            whole.restore(&snapshot).unwrap();
            play(&mut *whole, &names, stop..200);
            assert_eq!(other.digest(), whole.digest(), "{tier}, back to tick {stop}");
        }
    }
}

#[test]
fn environments_go_on_from_a_snapshot() {
    for tier in TIERS {
        for autoreset in [Autoreset::SameStep, Autoreset::NextStep, Autoreset::Disabled] {
            for round in 0..4 {
                let stop = bits(round, 0, Purpose::Start, 1) as usize % 120;
                let make = || {
                    let mut setup = ski(5, tier);
                    setup.autoreset = autoreset;
                    Envs::seeded(setup, &[1, 2, 3, 4, 5])
                };
                let mut whole = make();
                (0..stop).for_each(|_| whole.play());
                let (snapshot, seen) = (whole.batch.snapshot(), whole.observations.clone());
                let mut other = make();
                other.batch.restore(&snapshot).unwrap();
                other.observations = seen;
                for _ in stop..120 {
                    whole.play();
                    other.play();
                    for env in 0..5 {
                        assert_eq!(whole.returned(env), other.returned(env), "{tier} {autoreset:?} {stop}");
                    }
                }
                assert_eq!(whole.batch.digest(), other.batch.digest());
            }
        }
    }
}

#[test]
fn a_damaged_snapshot_is_refused_and_changes_nothing() {
    for tier in TIERS {
        let mut sim = simulator(2, 1, tier);
        play(&mut *sim, &[1, 2], 0..40);
        let snapshot = sim.snapshot();
        play(&mut *sim, &[1, 2], 40..60);
        let before = sim.digest();
        let mut refuse = |bytes: &[u8], what: String| {
            let error = sim.restore(bytes).expect_err(&what).to_string();
            assert!(error.starts_with("snapshot: "), "{what}: {error}");
            assert_eq!(sim.digest(), before, "{what}");
        };
        for at in 0..snapshot.len() {
            for flip in [1, 0x80, 0xff] {
                let mut bytes = snapshot.clone();
                bytes[at] ^= flip;
                refuse(&bytes, format!("byte {at} flipped by {flip}"));
            }
            refuse(&snapshot[..at], format!("cut to {at} bytes"));
        }
        refuse(&[snapshot.clone(), vec![0]].concat(), "a byte too many".into());
        refuse(&[snapshot.clone(), snapshot.clone()].concat(), "twice".into());
        sim.restore(&snapshot).unwrap();
        assert_ne!(sim.digest(), before);
    }
}

#[test]
fn a_damaged_snapshot_of_environments_is_refused_and_changes_nothing() {
    let mut envs = Envs::seeded(ski(1, "authentic"), &[9]);
    (0..10).for_each(|_| envs.play());
    let snapshot = envs.batch.snapshot();
    envs.play();
    let before = envs.batch.digest();
    for at in 0..snapshot.len() {
        let mut bytes = snapshot.clone();
        bytes[at] ^= 0x40;
        assert!(envs.batch.restore(&bytes).is_err(), "byte {at} flipped");
        assert!(envs.batch.restore(&snapshot[..at]).is_err(), "cut to {at} bytes");
        assert_eq!(envs.batch.digest(), before);
    }
}

#[test]
fn a_snapshot_of_another_layout_or_count_is_refused() {
    let map = rolling();
    let flat = Heightfield::new(vec![0.0; 9], 3, 3, 8.0, [0.0; 2], Edge::Tile).unwrap();
    let base = setup(&map, "authentic");
    let mut sim = base.build().unwrap();
    let before = sim.digest();
    let mut others = vec![
        ("tier", setup(&map, "reference")),
        ("terrain", setup(&flat, "authentic")),
        ("players", base),
        ("armor", base),
        ("pack", base),
        ("tick", base),
        ("scene", base),
        ("ski_bug", base),
        ("hysteresis", base),
    ];
    others[2].1.players = 2;
    others[3].1.armor = "heavy";
    others[4].1.energy_pack = true;
    others[5].1.tick_ms = 16;
    others[6].1.scene = "ski";
    others[7].1.physics.ski_bug = Some(true);
    others[8].1.physics.hysteresis = false;
    for (what, other) in others {
        let error = sim.restore(&other.build().unwrap().snapshot()).expect_err(what).to_string();
        let named = if what == "players" { "expected 1 players, got 2" } else { "another layout" };
        assert!(error.starts_with("snapshot: ") && error.contains(named), "{what}: {error}");
        assert_eq!(sim.digest(), before, "{what}");
    }
    // Threads are no part of the layout.
    let mut other = base;
    other.threads = Some(2);
    sim.restore(&other.build().unwrap().snapshot()).unwrap();
}

type Change = fn(&mut EnvironmentsSetup);

#[test]
fn an_environments_snapshot_of_another_layout_or_count_is_refused() {
    let mut envs = Envs::seeded(ski(2, "authentic"), &[1, 2]);
    let before = envs.batch.digest();
    let changes: [(&str, Change); 8] = [
        ("count", |s| s.count = 3),
        ("tier", |s| s.fidelity = "reference".into()),
        ("armor", |s| s.armor = "medium".into()),
        ("frame_skip", |s| s.task.frame_skip = 5),
        ("time limit", |s| s.task.time_limit = 251),
        ("reward", |s| s.task.reward.time = 0.0),
        ("terrain", |s| s.maps = Maps::new(&[rolling(), rolling()]).unwrap().into()),
        // The next episodes are drawn within it.
        ("area", |s| s.pitches[1].area.max[0] += 1.0),
    ];
    for (what, change) in changes {
        let mut setup = ski(2, "authentic");
        change(&mut setup);
        let seeds: Vec<u64> = (0..setup.count as u64).collect();
        let other = Envs::seeded(setup, &seeds);
        let error = envs.batch.restore(&other.batch.snapshot()).expect_err(what).to_string();
        assert!(error.starts_with("snapshot: "), "{what}: {error}");
        assert_eq!(envs.batch.digest(), before, "{what}");
    }
}

#[test]
fn one_player_or_environment_is_moved_between_batches() {
    for tier in TIERS {
        let mut many = simulator(9, 1, tier);
        let names: Vec<u64> = (1..=9).collect();
        play(&mut *many, &names, 0..60);
        let mut few = simulator(2, 1, tier);
        few.restore_one(1, &many.snapshot_one(6).unwrap()).unwrap();
        assert_eq!(few.snapshot_one(1), many.snapshot_one(6));
        play(&mut *many, &names, 60..90);
        play(&mut *few, &[77, 7], 60..90);
        assert_eq!(few.snapshot_one(1), many.snapshot_one(6), "{tier}");
        let before = few.snapshot();
        let whole = many.snapshot();
        for (player, bytes) in [(2, &many.snapshot_one(0).unwrap()), (0, &whole)] {
            assert!(few.restore_one(player, bytes).is_err());
            assert_eq!(few.snapshot(), before);
        }
        assert!(many.snapshot_one(9).is_err());

        let mut envs = Envs::seeded(ski(9, tier), &names);
        (0..20).for_each(|_| envs.play());
        let mut other = Envs::seeded(ski(1, tier), &[50]);
        other.batch.restore_one(0, &envs.batch.snapshot_one(8).unwrap()).unwrap();
        assert_eq!(other.batch.snapshot_one(0), envs.batch.snapshot_one(8));
        assert!(envs.batch.snapshot_one(9).is_err());
    }
}
