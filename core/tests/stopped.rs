//! Steps that are stopped half-way, and steps that panic.
//!
//! A stop is asked for on the caller's thread, between pieces of work. What it leaves behind refuses further
//! use until a snapshot is restored; so does what a panic leaves behind, on the caller's thread or in the pool.
#![allow(missing_docs)]

mod common;

use common::crowd::simulator;
use common::envs::{Envs, ski};
use discjump_core::batch::{RawInput, ResetRequest, Rewards, StepOutput};
use discjump_core::error::InputError;
use discjump_core::task::Actions;
use std::panic::{AssertUnwindSafe, catch_unwind};

const MANY: usize = 3_000;

/// The words of a step that was stopped half-way. The others may have begun all its pieces before the caller
/// was asked for the first time: then it came to its end, and another is stopped.
fn stopped(mut step: impl FnMut() -> Result<(), InputError>) -> String {
    (0..1000).find_map(|_| step().err()).expect("one of many is stopped").to_string()
}

#[test]
fn a_simulator_that_was_stopped_refuses_until_it_is_restored() {
    for threads in [1, 3] {
        let mut sim = simulator(MANY, threads, "authentic");
        let (before, keys) = (sim.snapshot(), vec![RawInput::default(); MANY]);
        let mut looks = 0;
        let refused = stopped(|| {
            looks = 0;
            sim.restore(&before).unwrap();
            sim.step_while(&keys, 2, &mut || {
                looks += 1;
                looks < 2
            })
        });
        assert!(refused.contains("ended half-way: restore a snapshot"), "{refused}");
        assert_eq!(looks, 2, "nobody asks again");
        assert!(sim.whole().is_err() && sim.step(&keys, 1).is_err() && sim.contacts(0, &keys[0]).is_err());
        assert!(sim.restore_one(0, &sim.snapshot_one(0).unwrap()).is_err(), "one player is not all");
        sim.restore(&before).unwrap();
        sim.step(&keys, 2).unwrap();
        let mut other = simulator(MANY, 2, "authentic");
        other.step(&keys, 2).unwrap();
        assert_eq!(sim.digest(), other.digest());
    }
}

#[test]
fn a_step_that_is_never_stopped_is_a_step() {
    let keys = vec![RawInput { forward: 1, ..RawInput::default() }; MANY];
    let mut other = simulator(MANY, 1, "authentic");
    other.step(&keys, 5).unwrap();
    for threads in [1, 3] {
        let mut one = simulator(MANY, threads, "authentic");
        let mut looks = 0;
        one.step_while(&keys, 5, &mut || {
            looks += 1;
            true
        })
        .unwrap();
        // Of several threads the others may have done it all before the caller is asked.
        assert!(looks > 1 || threads > 1);
        assert_eq!(one.digest(), other.digest());
    }
}

#[test]
fn a_simulator_that_panicked_refuses_and_the_pool_lives_on() {
    for threads in [1, 3] {
        let mut sim = simulator(MANY, threads, "authentic");
        let (before, keys) = (sim.snapshot(), vec![RawInput::default(); MANY]);
        sim.fail_next_step();
        assert!(catch_unwind(AssertUnwindSafe(|| sim.step(&keys, 1))).is_err());
        assert!(sim.whole().is_err() && sim.step(&keys, 1).is_err());
        sim.restore(&before).unwrap();
        sim.step(&keys, 1).unwrap();
        let mut other = simulator(MANY, threads, "authentic");
        other.step(&keys, 1).unwrap();
        assert_eq!(sim.digest(), other.digest());
    }
}

#[test]
fn environments_that_were_stopped_or_panicked_refuse() {
    for threads in [1, 3] {
        let mut setup = ski(MANY, "authentic");
        setup.threads = Some(threads);
        let seeds: Vec<u64> = (0..MANY as u64).collect();
        let mut envs = Envs::seeded(setup, &seeds);
        let (before, actions) = (envs.batch.snapshot(), envs.actions());
        let step = |envs: &mut Envs, go_on: &mut dyn FnMut() -> bool| {
            let output = StepOutput {
                observations: &mut envs.observations,
                rewards: Rewards::F64(&mut envs.rewards),
                terminated: &mut envs.terminated,
                truncated: &mut envs.truncated,
                status: None,
            };
            envs.batch.step_while(Actions::Int8(&actions), output, go_on)
        };
        stopped(|| {
            envs.batch.restore(&before).unwrap();
            step(&mut envs, &mut || false)
        });
        assert!(envs.batch.whole().is_err() && step(&mut envs, &mut || true).is_err());
        envs.batch.restore(&before).unwrap();
        step(&mut envs, &mut || true).unwrap();
        let after = envs.batch.digest();

        envs.batch.restore(&before).unwrap();
        envs.batch.fail_next_step();
        assert!(catch_unwind(AssertUnwindSafe(|| step(&mut envs, &mut || true))).is_err());
        assert!(envs.batch.whole().is_err() && step(&mut envs, &mut || true).is_err());
        envs.batch.restore(&before).unwrap();
        step(&mut envs, &mut || true).unwrap();
        assert_eq!(envs.batch.digest(), after);
    }
}

#[test]
fn a_reset_that_was_stopped_early_changes_nothing() {
    let seeds: Vec<u64> = (0..MANY as u64).collect();
    let mut envs = Envs::seeded(ski(MANY, "authentic"), &seeds);
    let before = envs.batch.snapshot();
    let request = ResetRequest { seeds: seeds.iter().map(|s| s + 1).collect(), ..ResetRequest::default() };
    let mut observations = envs.observations.clone();
    assert!(envs.batch.reset_while(&request, &mut observations, &mut || false).is_err());
    assert_eq!(envs.batch.snapshot(), before);
}
