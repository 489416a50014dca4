//! Environments: what they are made from, actions, outputs and resets.

use crate::common::envs::{Envs, ski};
use crate::{INF, NAN, refused};
use discjump_core::batch::{Autoreset, EnvironmentsSetup, ResetRequest, Rewards, StatusOutput, StepOutput};
use discjump_core::error::InputError;
use discjump_core::observe::Observation;
use discjump_core::task::{ActionKind, Actions, CourseRequest, Pitch};
use discjump_core::terrain::mission::Area;
use discjump_core::terrain::{Edge, Heightfield, Maps};
use glam::DVec2;

#[test]
fn environments() {
    let build = |change: fn(&mut EnvironmentsSetup)| {
        let mut s = ski(2, "authentic");
        change(&mut s);
        s.build()
    };
    assert!(build(|_| ()).is_ok());
    refused(build(|s| s.count = 0), "num_envs", "0");
    refused(build(|s| s.count = usize::MAX), "num_envs", "18446744073709551615");
    refused(build(|s| s.threads = Some(0)), "threads", "0");
    refused(build(|s| s.fidelity = "fastest".into()), "fidelity", "\"fastest\"");
    refused(build(|s| s.armor = String::new()), "armor", "\"\"");
    refused(build(|s| s.tick_ms = 0), "tick_ms", "0");
    refused(build(|s| s.task.frame_skip = 0), "frame_skip", "0");
    refused(build(|s| s.task.frame_skip = 1001), "frame_skip", "1001");
    refused(build(|s| s.task.time_limit = 0), "time_limit", "0");
    refused(build(|s| s.task.time_limit = -5), "time_limit", "-5");
    refused(build(|s| s.task.arrival_radius = 0.0), "arrival_radius", "0");
    refused(build(|s| s.task.arrival_radius = NAN), "arrival_radius", "NaN");
    refused(build(|s| s.task.levels[0].goal_distance = (5.0, 50.0)), "goal_distance", "(5, 50)");
    refused(build(|s| s.task.levels[0].goal_distance = (50.0, 40.0)), "goal_distance", "(50, 40)");
    refused(build(|s| s.task.levels[0].goal_distance = (NAN, 40.0)), "goal_distance", "NaN");
    refused(build(|s| s.task.levels[0].goal_distance = (40.0, INF)), "goal_distance", "inf");
    refused(build(|s| s.task.levels[0].goal_distance = (600.0, 700.0)), "goal_distance", "600");
    refused(build(|s| s.task.levels[0].start_speed = -1.0), "start_speed", "-1");
    refused(build(|s| s.task.levels[0].start_speed = NAN), "start_speed", "NaN");
    refused(build(|s| s.task.turn_rate = 0.0), "turn_rate", "0");
    refused(build(|s| s.task.turn_rate = INF), "turn_rate", "inf");
    refused(build(|s| s.task.reward.progress = NAN), "reward", "NaN");
    refused(build(|s| s.task.reward.arrival = -INF), "reward", "-inf");
    refused(build(|s| s.lanes = Some(3)), "lanes", "3");
    refused(build(|s| s.pitches.truncate(1)), "areas", "1");
    refused(build(|s| s.pitches[1].area.min[0] = NAN), "areas[1]", "NaN");
    refused(
        build(|s| s.pitches[0].area = Area { min: [9.0, 0.0], max: [0.0, 900.0] }),
        "areas[0]",
        "[9.0, 0.0]",
    );
    refused(build(|s| s.pitches[1].area.max[1] = 1e9), "areas[1]", "1000000000.0");
    refused(Observation::new(&[181.0], &[5.0], true), "fan_bearings", "181");
    refused(Observation::new(&[NAN], &[5.0], true), "fan_bearings", "NaN");
    refused(Observation::new(&[0.0], &[-1.0], true), "fan_ranges", "-1");
    refused(Observation::new(&[0.0], &[INF], true), "fan_ranges", "inf");
    refused(Observation::new(&[0.0; 100], &[1.0; 100], true), "fan", "100 bearings");
}

/// Runs `call` on environments that have been played, and checks that it changes nothing.
#[track_caller]
fn envs_unchanged(
    envs: &mut Envs,
    call: impl FnOnce(&mut Envs) -> Result<(), InputError>,
    argument: &str,
    got: &str,
) {
    let look = |e: &Envs| {
        let rest = (e.observations.clone(), e.rewards.clone(), e.batch.final_observations().to_vec());
        (e.batch.digest(), e.batch.state(), format!("{:?}", e.batch.finished()), rest)
    };
    let before = look(envs);
    refused(call(envs), argument, got);
    assert_eq!(look(envs), before, "{argument}: {got}");
}

fn step(envs: &mut Envs, actions: Actions<'_>) -> Result<(), InputError> {
    let Envs { batch, observations, rewards, terminated, truncated } = envs;
    let rewards = Rewards::F64(rewards);
    batch.step(actions, StepOutput { observations, rewards, terminated, truncated, status: None })
}

#[test]
fn actions_of_a_decision() {
    let mut envs = Envs::seeded(ski(3, "authentic"), &[1, 2, 3]);
    (0..80).for_each(|_| envs.play());
    for (column, bad) in [(0, 3), (0, -1), (1, 3), (2, 2), (3, -128), (4, 7)] {
        let mut actions = [1i8, 1, 0, 0, 3].repeat(3);
        actions[5 + column] = bad;
        let argument = format!("actions[1, {column}]");
        envs_unchanged(&mut envs, |e| step(e, Actions::Int8(&actions)), &argument, &bad.to_string());
        let wide: Vec<i64> = actions.iter().map(|&a| i64::from(a)).collect();
        envs_unchanged(&mut envs, |e| step(e, Actions::Int64(&wide)), &argument, &bad.to_string());
    }
    // Beyond what a narrower integer holds: not wrapped around into range.
    let far = [1i64, 1, 0, 0, 1 << 32].repeat(3);
    envs_unchanged(&mut envs, |e| step(e, Actions::Int64(&far)), "actions[0, 4]", "4294967296");
    envs_unchanged(&mut envs, |e| step(e, Actions::Int8(&[1; 14])), "actions", "14");
    envs_unchanged(&mut envs, |e| step(e, Actions::Int32(&[])), "actions", "0");
    envs_unchanged(&mut envs, |e| step(e, Actions::Float(&[0.0; 15])), "actions", "floats");

    let mut setup = ski(3, "authentic");
    setup.actions = ActionKind::Box;
    let mut envs = Envs::seeded(setup, &[1, 2, 3]);
    step(&mut envs, Actions::Float(&[0.9; 15])).unwrap();
    for (bad, got) in [(f32::NAN, "NaN"), (1.0f32.next_up(), "1.0000001"), (f32::NEG_INFINITY, "-inf")] {
        let mut actions = [0.0; 15];
        actions[13] = bad;
        envs_unchanged(&mut envs, |e| step(e, Actions::Float(&actions)), "actions[2, 3]", got);
    }
    envs_unchanged(&mut envs, |e| step(e, Actions::Int8(&[1; 15])), "actions", "integers");
}

#[test]
fn outputs_of_a_decision() {
    let mut envs = Envs::seeded(ski(2, "authentic"), &[1, 2]);
    let actions = [1i8, 1, 0, 0, 3].repeat(2);
    for short in 0..8 {
        envs_unchanged(
            &mut envs,
            |e| {
                let Envs { batch, observations, rewards, terminated, truncated } = e;
                let cut = |k: usize, n: usize| if short == k { n - 1 } else { n };
                let n = observations.len();
                let [mut distance, mut speed, mut time] = [[0.0; 2]; 3];
                let mut outside = [false; 2];
                let output = StepOutput {
                    observations: &mut observations[..cut(0, n)],
                    rewards: Rewards::F64(&mut rewards[..cut(1, 2)]),
                    terminated: &mut terminated[..cut(2, 2)],
                    truncated: &mut truncated[..cut(3, 2)],
                    status: Some(StatusOutput {
                        distance: &mut distance[..cut(4, 2)],
                        speed: &mut speed[..cut(5, 2)],
                        time: &mut time[..cut(6, 2)],
                        outside: &mut outside[..cut(7, 2)],
                    }),
                };
                batch.step(Actions::Int8(&actions), output)
            },
            "output",
            "2",
        );
    }
}

#[test]
fn resets() {
    let mut envs = Envs::new(ski(2, "authentic"));
    let reset = |e: &mut Envs, request: ResetRequest| e.batch.reset(&request, &mut e.observations);
    let none = ResetRequest::default;
    envs_unchanged(&mut envs, |e| step(e, Actions::Int8(&[1; 10])), "step", "expected every environment");
    envs_unchanged(&mut envs, |e| reset(e, none()), "seeds", "none");
    // One of two: the other still has no seed.
    let seeds = vec![1, 2];
    reset(&mut envs, ResetRequest { seeds: seeds.clone(), mask: vec![true, false], ..none() }).unwrap();
    envs_unchanged(&mut envs, |e| reset(e, none()), "seeds", "environment 1");
    reset(&mut envs, ResetRequest { seeds, ..none() }).unwrap();
    (0..80).for_each(|_| envs.play());

    let course = |change: fn(&mut CourseRequest)| {
        let mut course = CourseRequest::default();
        change(&mut course);
        ResetRequest { courses: vec![CourseRequest::default(), course], ..none() }
    };
    envs_unchanged(&mut envs, |e| reset(e, ResetRequest { seeds: vec![1], ..none() }), "seeds", "1");
    envs_unchanged(&mut envs, |e| reset(e, ResetRequest { mask: vec![true; 3], ..none() }), "mask", "3");
    let courses = vec![CourseRequest::default(); 5];
    envs_unchanged(&mut envs, |e| reset(e, ResetRequest { courses, ..none() }), "options", "5");
    for (change, what, got) in [
        ((|c| c.map = Some(2)) as fn(&mut CourseRequest), "terrain", "2"),
        (|c| c.start = Some(DVec2::new(NAN, 0.0)), "start", "NaN"),
        (|c| c.start = Some(DVec2::new(0.0, 2e9)), "start", "2000000000"),
        (|c| (c.start, c.height) = (Some(DVec2::ZERO), Some(INF)), "start", "inf"),
        (|c| c.goal = Some(DVec2::new(0.0, -INF)), "goal", "-inf"),
    ] {
        let argument = format!("environment 1: {what}");
        envs_unchanged(&mut envs, |e| reset(e, course(change)), &argument, got);
    }
    envs_unchanged(&mut envs, |e| e.batch.reset(&none(), &mut [0.0; 3]), "observations", "3");
    reset(&mut envs, none()).unwrap();
}

/// Where nothing tiles there may be no ground to start on.
#[test]
fn a_start_beyond_a_void_map() {
    let mut setup = ski(1, "authentic");
    let map = Heightfield::new(vec![5.0; 65 * 65], 65, 65, 8.0, [0.0; 2], Edge::Void).unwrap();
    setup.maps = Maps::new(&[map]).unwrap().into();
    setup.pitches.truncate(1);
    setup.autoreset = Autoreset::Disabled;
    // Episodes begin on the map, in the middle of a step too, or the area is refused.
    let mut beyond = ski(1, "authentic");
    beyond.maps = setup.maps.clone();
    beyond.pitches = vec![Pitch::bare(Area { min: [-1.0, 0.0], max: [512.0; 2] })];
    refused(beyond.build(), "areas[0]", "[-1.0, 0.0]");
    setup.pitches[0].area = Area { min: [0.0; 2], max: [512.0; 2] };
    let mut envs = Envs::seeded(setup, &[4]);
    let course = CourseRequest { start: Some(DVec2::new(-1.0, 5.0)), ..CourseRequest::default() };
    let request = ResetRequest { courses: vec![course], ..ResetRequest::default() };
    envs_unchanged(
        &mut envs,
        |e| e.batch.reset(&request, &mut e.observations),
        "environment 0: start",
        "(-1, 5)",
    );
}
