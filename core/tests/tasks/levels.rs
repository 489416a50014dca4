//! Levels of difficulty: up after three successes in a row, down after three failures.

use crate::common::envs::{Envs, ski};
use discjump_core::batch::{Autoreset, EnvironmentsSetup};
use discjump_core::task::{Level, Outcome};

/// Beacons next door, at some distance, and beyond what can be reached in the time.
fn setup(count: usize) -> EnvironmentsSetup {
    let mut setup = ski(count, "authentic");
    setup.task.time_limit = 100;
    let level = |metres: f64| Level::beacons((metres, metres), 0.0);
    setup.task.levels = vec![level(10.0), level(14.0), level(120.0)];
    EnvironmentsSetup { autoreset: Autoreset::NextStep, ..setup }
}

/// The outcomes of every environment's episodes, in their order.
fn played(count: usize, seeds: &[u64], steps: usize) -> Vec<Vec<Outcome>> {
    let mut envs = Envs::seeded(setup(count), seeds);
    let mut ends = vec![Vec::new(); count];
    for step in 0..steps {
        envs.play();
        for (env, outcome) in envs.batch.finished() {
            ends[*env].push(*outcome);
        }
        // In the middle of it all: nothing is forgotten by a snapshot.
        if step == steps / 2 {
            let snapshot = envs.batch.snapshot();
            envs = Envs::new(setup(count));
            envs.batch.restore(&snapshot).unwrap();
            let n = envs.batch.observation_size() * count;
            envs.observations = vec![0.0; n];
            envs.step(&[2, 1, 1, 0, 3].repeat(count));
            for (env, outcome) in envs.batch.finished() {
                ends[*env].push(*outcome);
            }
        }
    }
    ends
}

/// What the rule makes of a list of successes, from its words.
fn expected(successes: &[bool]) -> Vec<i64> {
    let (mut level, mut row, mut last) = (0_i64, 0, None);
    let mut levels = Vec::new();
    for &success in successes {
        levels.push(level);
        row = if last == Some(success) { row + 1 } else { 1 };
        last = Some(success);
        if row >= 3 {
            let next = (level + if success { 1 } else { -1 }).clamp(0, 2);
            if next != level {
                (level, row, last) = (next, 0, None);
            }
        }
    }
    levels
}

#[test]
fn levels_follow_successes_and_failures_in_a_row() {
    let seeds: Vec<u64> = (0..16).collect();
    let ends = played(16, &seeds, 600);
    let (mut up, mut down) = (0, 0);
    for episodes in &ends {
        let successes: Vec<bool> = episodes.iter().map(|e| e.success).collect();
        let levels: Vec<i64> = episodes.iter().map(|e| e.level).collect();
        assert_eq!(levels, expected(&successes), "{successes:?}");
        for e in episodes {
            let metres = [10.0, 14.0, 120.0][e.level as usize];
            assert!((e.start_distance - metres).abs() < 1e-3, "{e:?}");
        }
        up += levels.windows(2).filter(|pair| pair[1] > pair[0]).count();
        down += levels.windows(2).filter(|pair| pair[1] < pair[0]).count();
    }
    assert!(up >= 16 && down >= 4, "{up} up, {down} down");
}

#[test]
fn levels_of_an_environment_do_not_depend_on_the_others() {
    let among = played(16, &(0..16).collect::<Vec<_>>(), 300);
    let alone = played(1, &[5], 300);
    assert_eq!(format!("{:?}", among[5]), format!("{:?}", alone[0]));
}
