//! The ends of episodes: on exact ticks, with one flag, and with nothing moving afterwards; and the three
//! ways of beginning the next one.
#![allow(missing_docs)]

mod common;

use common::envs::{Envs, bits, ski};
use discjump_core::batch::{
    Autoreset, EnvironmentsSetup, ResetRequest, Rewards, Status, StatusOutput, StepOutput,
};
use discjump_core::task::{Actions, CourseRequest, Outcome};
use glam::DVec2;

const TIERS: [&str; 5] = ["authentic", "reference", "swept", "fast", "engine"];
/// Forward, straight on.
const WALK: [i8; 5] = [2, 1, 0, 0, 3];

/// A setup whose one episode goes straight north from rest: `metres` to the beacon.
fn north(tier: &str, metres: f64, change: impl Fn(&mut EnvironmentsSetup)) -> Envs {
    let mut setup = ski(1, tier);
    setup.autoreset = Autoreset::Disabled;
    setup.task.levels[0].start_speed = 0.0;
    setup.task.arrival_radius = 20.0;
    change(&mut setup);
    let mut envs = Envs::new(setup);
    let start = DVec2::new(200.0, 200.0);
    let mut course = CourseRequest { start: Some(start), map: Some(0), ..CourseRequest::default() };
    course.goal = Some(start + DVec2::new(0.0, metres));
    // The yaw is drawn: of some seeds, take one that looks north within 10 degrees.
    let seed = (0..1000)
        .find(|&seed| {
            let request =
                ResetRequest { seeds: vec![seed], courses: vec![course], ..ResetRequest::default() };
            envs.reset(&request);
            let ahead = envs.row(0)[4];
            assert!(ahead.abs() <= 1.0);
            ahead > 0.985
        })
        .unwrap();
    let request = ResetRequest { seeds: vec![seed], courses: vec![course], ..ResetRequest::default() };
    envs.reset(&request);
    envs
}

/// Plays until the episode ends; the outcome and the decisions it took.
fn finish(envs: &mut Envs, action: [i8; 5]) -> (Outcome, usize) {
    for decision in 1.. {
        assert!(decision < 10_000);
        envs.step(&action);
        if let Some((outcome, _)) = envs.ended(0) {
            return (outcome, decision);
        }
    }
    unreachable!()
}

#[test]
fn the_time_runs_out_on_its_tick_within_a_decision() {
    for tier in TIERS {
        for (limit, skip) in [(10, 4), (1, 4), (4, 4), (1875, 7), (13, 1), (3, 1000)] {
            let mut envs = north(tier, 400.0, |s| (s.task.time_limit, s.task.frame_skip) = (limit, skip));
            let (outcome, decisions) = finish(&mut envs, WALK);
            assert_eq!(decisions, (limit as usize).div_ceil(skip as usize), "{limit} {skip}");
            assert_eq!(outcome.time, f64::from(limit) * 32.0 / 1000.0, "{limit} {skip}");
            assert_eq!((outcome.timeout, outcome.success, outcome.death), (true, false, false));
            assert_eq!((envs.terminated[0], envs.truncated[0]), (false, true));
            assert_eq!(outcome.length, decisions as i64);
        }
    }
}

/// In the last tick the beacon still counts, and so does death; then it is not a time-out.
#[test]
fn arrival_on_the_last_tick_is_an_arrival() {
    for tier in TIERS {
        let arrive = |limit| {
            let mut envs = north(tier, 60.0, |s| s.task.time_limit = limit);
            let (outcome, _) = finish(&mut envs, WALK);
            (outcome, envs.terminated[0], envs.truncated[0])
        };
        let (free, terminated, truncated) = arrive(10_000);
        assert!(free.success && terminated && !truncated);
        let ticks = (free.time / 0.032).round() as i32;
        let (last, terminated, truncated) = arrive(ticks);
        assert_eq!((last, terminated, truncated), (free, true, false));
        let (short, terminated, truncated) = arrive(ticks - 1);
        assert!(short.timeout && !short.success && !terminated && truncated);
    }
}

/// What one decision of many ticks plays is what many decisions of one tick play, and the ticks of a
/// decision that are left when the episode ends change nothing: not the player, not the clock, and
/// not the reward, whose terms add up alike.
#[test]
fn a_player_freezes_where_his_episode_ends() {
    for tier in TIERS {
        let play = |skip| {
            let mut envs = north(tier, 60.0, |s| (s.task.frame_skip, s.task.time_limit) = (skip, 2000));
            let (outcome, decisions) = finish(&mut envs, WALK);
            (envs, outcome, decisions)
        };
        let (single, expected, ticks) = play(1);
        assert!(expected.success && ticks > 50);
        for skip in [4, 7, 50, 1000] {
            let (mut envs, outcome, decisions) = play(skip);
            assert_eq!(decisions, ticks.div_ceil(skip as usize));
            assert_eq!(envs.batch.state(), single.batch.state(), "{tier} {skip}");
            assert_eq!(envs.row(0), single.row(0));
            let same = Outcome { length: expected.length, total_reward: expected.total_reward, ..outcome };
            assert_eq!(same, expected);
            assert!((outcome.total_reward - expected.total_reward).abs() < 1e-9);

            let (digest, row) = (envs.batch.digest(), envs.row(0).to_vec());
            for _ in 0..3 {
                envs.step(&[0, 2, 1, 1, 6]);
                assert_eq!(envs.batch.digest(), digest);
                assert_eq!(envs.row(0), row);
                assert_eq!((envs.rewards[0], envs.terminated[0], envs.truncated[0]), (0.0, true, false));
                assert!(envs.batch.finished().is_empty());
            }
        }
    }
}

/// Progress in metres, a price per second and a bonus: recomputed from what the outcome reports.
#[test]
fn the_rewards_of_an_episode_add_up() {
    for tier in TIERS {
        let mut envs = Envs::seeded(ski(32, tier), &(0..32).collect::<Vec<_>>());
        let mut sums = [0.0; 32];
        let mut ends = 0;
        for _ in 0..200 {
            envs.play();
            for (env, sum) in sums.iter_mut().enumerate() {
                *sum += envs.rewards[env];
                if let Some((o, _)) = envs.ended(env) {
                    let bonus = if o.success { 5.0 } else { 0.0 };
                    let expected = 0.02 * (o.start_distance - o.distance) - 0.156_25 * o.time + bonus;
                    assert!((o.total_reward - expected).abs() < 1e-9 && (*sum - expected).abs() < 1e-9);
                    assert_eq!([o.success, o.death, o.timeout].iter().filter(|x| **x).count(), 1);
                    assert!((o.mean_speed * o.time - o.path).abs() < 1e-6 * o.path.max(1.0));
                    assert!(o.path + 8.1 >= o.start_distance - o.distance && o.top_speed >= o.mean_speed);
                    (*sum, ends) = (0.0, ends + 1);
                }
            }
        }
        assert!(ends > 100, "{ends}");
    }
}

#[test]
fn the_three_autoreset_modes_play_the_same_episodes() {
    const N: usize = 8;
    for tier in TIERS {
        let play = |autoreset| {
            let mut setup = ski(N, tier);
            setup.autoreset = autoreset;
            let mut envs = Envs::seeded(setup, &(100..100 + N as u64).collect::<Vec<_>>());
            // Every environment's rows, episode by episode, and how each ended.
            let mut rows: Vec<Vec<Vec<Vec<f32>>>> =
                (0..N).map(|e| vec![vec![envs.row(e).to_vec()]]).collect();
            let mut outcomes: Vec<Vec<(Outcome, Vec<u32>)>> = vec![Vec::new(); N];
            let mut over = [false; N];
            for _ in 0..300 {
                envs.play();
                for env in 0..N {
                    if over[env] && autoreset == Autoreset::NextStep {
                        // The step that begins the next episode, whose action was ignored.
                        assert_eq!(
                            (envs.rewards[env], envs.terminated[env] || envs.truncated[env]),
                            (0.0, false)
                        );
                        rows[env].push(vec![envs.row(env).to_vec()]);
                        over[env] = false;
                        continue;
                    }
                    let ended = envs.ended(env);
                    assert_eq!(ended.is_some(), envs.terminated[env] || envs.truncated[env]);
                    match (ended, autoreset) {
                        (None, _) => rows[env].last_mut().unwrap().push(envs.row(env).to_vec()),
                        (Some(end), Autoreset::SameStep) => {
                            outcomes[env].push(end);
                            rows[env].push(vec![envs.row(env).to_vec()]);
                        }
                        (Some(end), _) => {
                            assert_eq!(end.1, common::envs::bits(envs.row(env)));
                            outcomes[env].push(end);
                            over[env] = true;
                        }
                    }
                }
                if autoreset == Autoreset::Disabled && over.contains(&true) {
                    let mask = over.to_vec();
                    envs.reset(&ResetRequest { mask, ..ResetRequest::default() });
                    for env in (0..N).filter(|&e| over[e]) {
                        rows[env].push(vec![envs.row(env).to_vec()]);
                    }
                    over = [false; N];
                }
            }
            (rows, outcomes)
        };
        let (rows, outcomes) = play(Autoreset::SameStep);
        assert!(outcomes.iter().all(|o| o.len() >= 3));
        for other in [Autoreset::NextStep, Autoreset::Disabled] {
            let (their_rows, their_outcomes) = play(other);
            for env in 0..N {
                let n = outcomes[env].len().min(their_outcomes[env].len());
                assert!(n >= 3);
                assert_eq!(outcomes[env][..n], their_outcomes[env][..n], "{tier} {other:?} {env}");
                assert_eq!(rows[env][..n], their_rows[env][..n], "{tier} {other:?} {env}");
                assert!(outcomes[env].iter().enumerate().all(|(k, (o, _))| o.episode == k as u64));
            }
        }
    }
}

/// Also across ends and new beginnings within the step: the columns show what runs after it.
#[test]
fn columns_of_a_step_say_what_the_batch_says_after_it() {
    let [mut twin, mut envs] = [(), ()].map(|()| {
        let mut setup = ski(5, "authentic");
        setup.task.time_limit = 30;
        Envs::seeded(setup, &[1, 2, 3, 4, 5])
    });
    let (mut narrow, [mut distance, mut speed, mut time]) = ([0.0f32; 5], [[0.0; 5]; 3]);
    let (mut outside, mut ends) = ([false; 5], 0);
    for _ in 0..100 {
        let actions = twin.actions();
        twin.step(&actions);
        let output = StepOutput {
            observations: &mut envs.observations,
            rewards: Rewards::F32(&mut narrow),
            terminated: &mut envs.terminated,
            truncated: &mut envs.truncated,
            status: Some(StatusOutput {
                distance: &mut distance,
                speed: &mut speed,
                time: &mut time,
                outside: &mut outside,
            }),
        };
        envs.batch.step(Actions::Int8(&actions), output).unwrap();
        ends += envs.batch.finished().len();
        let rounded: Vec<u32> = twin.rewards.iter().map(|&reward| (reward as f32).to_bits()).collect();
        assert_eq!(narrow.map(f32::to_bits).to_vec(), rounded);
        for (i, status) in twin.batch.status().iter().enumerate() {
            let columns = [distance[i], speed[i], time[i]].map(f64::to_bits);
            assert_eq!(columns, [status.distance, status.speed, status.time].map(f64::to_bits));
            assert_eq!(outside[i], status.outside);
        }
    }
    assert!(ends > 10, "{ends} ends");
}

#[test]
fn a_reset_of_some_leaves_observed_rows_alone() {
    let [mut envs, mut twin] = [(), ()].map(|()| Envs::seeded(ski(4, "authentic"), &[1, 2, 3, 4]));
    (0..20).for_each(|_| envs.play());
    (0..20).for_each(|_| twin.play());
    let mask = vec![false, true, false, true];
    let request = ResetRequest { mask, others_observed: true, ..ResetRequest::default() };
    let row = envs.batch.observation_size();
    envs.observations[..row].fill(7.0);
    envs.batch.reset(&request, &mut envs.observations).unwrap();
    let all = ResetRequest { others_observed: false, ..request };
    twin.batch.reset(&all, &mut twin.observations).unwrap();
    assert_eq!(envs.observations[..row], vec![7.0; row]);
    for env in 1..4 {
        assert_eq!(bits(envs.row(env)), bits(twin.row(env)), "environment {env}");
    }
    let one_by_one: Vec<Status> = (0..4).map(|env| envs.batch.status_of(env)).collect();
    assert_eq!(one_by_one, twin.batch.status());
}
