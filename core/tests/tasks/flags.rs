//! Flags: a walk over flat ground, whose times are known.

use crate::common::envs::{Envs, ski};
use crate::common::flat;
use discjump_core::batch::{Autoreset, EnvironmentsSetup, ResetRequest};
use discjump_core::task::{Grounds, Level, OUTSIDE_MS, Outcome, Pitch};
use discjump_core::terrain::Maps;
use discjump_core::terrain::mission::Area;
use glam::DVec3;

/// Half the way between the stands, m.
const HALF: f64 = 60.0;
const RADIUS: f64 = 2.5;
/// Walking speed of a light, m/s, and its tick, s.
const WALK: f64 = 11.0;
const TICK: f64 = 0.032;
/// No key; forward; back.
const STAY: [i8; 7] = [1, 1, 0, 0, 3, 0, 4];
const AHEAD: [i8; 7] = [2, 1, 0, 0, 3, 0, 4];
const BACK: [i8; 7] = [0, 1, 0, 0, 3, 0, 4];

fn setup(capture: bool, east: f64) -> EnvironmentsSetup {
    let base = ski(1, "authentic");
    let mut task = base.task.clone();
    (task.frame_skip, task.arrival_radius, task.capture, task.time_limit) = (1, RADIUS, capture, 5000);
    task.levels = vec![Level { from_stand: true, ..Level::beacons((50.0, 60.0), 0.0) }];
    let area = Area { min: [-HALF - 30.0, -50.0], max: [east, 50.0] };
    let stands = [DVec3::new(-HALF, 0.0, 0.0), DVec3::new(HALF, 0.0, 0.0)];
    EnvironmentsSetup {
        maps: Maps::new(&[flat()]).unwrap().into(),
        grounds: Grounds::Stands,
        pitches: vec![Pitch { area, stands }],
        task,
        autoreset: Autoreset::Disabled,
        ..base
    }
}

/// An episode of the western team, whose enemy stands in the east, that begins with the view to him: within
/// 0.3 m at the enemy stand.
fn western(setup: impl Fn() -> EnvironmentsSetup) -> Envs {
    let mut envs = Envs::new(setup());
    let direction = envs.at("goal_direction");
    for seed in 0..20_000 {
        envs.reset(&ResetRequest { seeds: vec![seed], ..ResetRequest::default() });
        let [ahead, right] = [envs.row(0)[direction], envs.row(0)[direction + 1]];
        if envs.batch.goals()[0][0] > 0.0 && ahead > 0.0 && right.abs() < 0.0025 {
            return envs;
        }
    }
    panic!("both teams are drawn, and any yaw");
}

/// Ticks with a key until something is so; panics after a minute.
fn until(envs: &mut Envs, key: [i8; 7], so: impl Fn(&Envs) -> bool) -> usize {
    for tick in 1..2000 {
        envs.step(&key);
        if so(envs) {
            return tick;
        }
    }
    panic!("never");
}

fn outcome(envs: &Envs) -> Option<Outcome> {
    envs.ended(0).map(|(outcome, _)| outcome)
}

/// Seconds at a walk, of which some are spent on getting there: from a rest up to half a second, after turning
/// back at full speed twice that.
fn walked(ticks: usize, metres: f64, spent: f64) {
    let seconds = ticks as f64 * TICK;
    let (least, most) = (metres / WALK, metres / WALK + spent);
    assert!((least..most).contains(&seconds), "{metres} m in {seconds} s, expected {least} to {most}");
}

#[test]
fn a_route_ends_at_the_enemy_flag() {
    let mut envs = western(|| setup(false, HALF + 30.0));
    assert_eq!(envs.batch.goals()[0], [HALF, 0.0, 0.0]);
    let ticks = until(&mut envs, AHEAD, |envs| outcome(envs).is_some());
    walked(ticks, 2.0 * HALF - RADIUS, 0.5);
    let end = outcome(&envs).unwrap();
    assert!(end.success && end.carried && end.taken == 1, "{end:?}");
    assert!((end.start_distance - 2.0 * HALF).abs() < 1e-3, "{end:?}");
}

/// Caught: nothing but the map and the side was drawn, so that of 512 episodes 480 were repeated.
#[test]
fn starts_are_spread_evenly_over_a_disc_about_the_own_stand() {
    const ASIDE: f64 = 2.0;
    const COUNT: u64 = 400;
    let mut setup = setup(false, HALF + 30.0);
    (setup.count, setup.task.levels[0].aside) = (COUNT as usize, ASIDE);
    let seeds: Vec<u64> = (0..COUNT).collect();
    let envs = Envs::seeded(setup, &seeds);
    let (mut inner, mut east) = (0, 0);
    for (row, goal) in envs.batch.goals().into_iter().enumerate() {
        // The stands lie opposite to each other.
        let (x, y) = (envs.place(row).x + goal[0], envs.place(row).y);
        let off = x.hypot(y);
        assert!(off <= ASIDE + 1e-4, "{off} m from the stand");
        inner += i32::from(off < ASIDE / 2.0f64.sqrt());
        east += i32::from(x > 0.0);
    }
    // Half of the area, and half of the disc, hold half of the starts: within four standard deviations.
    assert!((160..=240).contains(&inner) && (160..=240).contains(&east), "{inner} within, {east} east");
}

#[test]
fn a_capture_is_there_and_back() {
    let mut envs = western(|| setup(true, HALF + 30.0));
    let ticks = until(&mut envs, AHEAD, |envs| envs.batch.goals()[0][0] < 0.0);
    walked(ticks, 2.0 * HALF - RADIUS, 0.5);
    assert!(outcome(&envs).is_none(), "the flag is taken, not captured");
    let home = until(&mut envs, BACK, |envs| outcome(envs).is_some());
    walked(home, 2.0 * HALF - 2.0 * RADIUS, 1.0);
    let end = outcome(&envs).unwrap();
    assert!(end.success && end.taken == 1, "{end:?}");
    // Its reward: all the way there and back is a potential.
    let way = 4.0 * HALF - envs.batch.status()[0].distance;
    let expected = 0.02 * way - 0.156_25 * end.time + 5.0;
    assert!((end.total_reward - expected).abs() < 1e-3, "{end:?}: {expected}");
}

#[test]
fn a_flag_goes_home_after_four_and_a_half_seconds_outside() {
    // The area ends at 3 m behind the enemy stand.
    let mut envs = western(|| setup(true, HALF + 3.0));
    until(&mut envs, AHEAD, |envs| envs.batch.goals()[0][0] < 0.0);
    until(&mut envs, AHEAD, |envs| envs.batch.status()[0].outside);
    let ticks = 1 + until(&mut envs, STAY, |envs| envs.batch.goals()[0][0] > 0.0);
    assert_eq!(ticks, OUTSIDE_MS.div_ceil(32) as usize);
    // It is taken again on the way back, though only within the area.
    until(&mut envs, BACK, |envs| envs.batch.goals()[0][0] < 0.0);
    assert!(!envs.batch.status()[0].outside);
    until(&mut envs, BACK, |envs| outcome(envs).is_some());
    assert_eq!(outcome(&envs).unwrap().taken, 2);
}

#[test]
fn who_comes_back_in_time_keeps_the_flag() {
    let mut envs = western(|| setup(true, HALF + 3.0));
    until(&mut envs, AHEAD, |envs| envs.batch.goals()[0][0] < 0.0);
    until(&mut envs, AHEAD, |envs| envs.batch.status()[0].outside);
    (0..60).for_each(|_| envs.step(&STAY));
    until(&mut envs, BACK, |envs| outcome(envs).is_some());
    assert_eq!(outcome(&envs).unwrap().taken, 1);
}

#[test]
fn a_flag_is_not_taken_from_outside_the_area() {
    // The enemy stands on the border; the way there leads along the outside.
    let make = || {
        let mut setup = setup(false, HALF + 30.0);
        setup.pitches[0].area = Area { min: [-HALF - 30.0, 0.0], max: [HALF + 30.0, 50.0] };
        setup
    };
    let mut envs = western(make);
    // Half a metre south of the border, then along it.
    let aside = [1, 2, 0, 0, 3, 0, 4];
    until(&mut envs, aside, |envs| envs.batch.status()[0].outside);
    (0..8).for_each(|_| envs.step(&aside));
    let passed = until(&mut envs, AHEAD, |envs| envs.place(0).x > HALF + 3.0);
    assert!(passed > 100 && outcome(&envs).is_none(), "passed it after {passed} ticks");
}
