//! Episodes have the same bits whichever way they are stepped: 1, 8 or 16 environments side by side, on
//! one thread or two, with rewards of either width, with the status beside them or asked for later.
#![allow(missing_docs)]

mod common;

use common::envs::ski;
use common::widths;
use discjump_core::batch::{
    Autoreset, Environments, EnvironmentsSetup, ResetRequest, Rewards, StatusOutput, StepOutput,
};
use discjump_core::random::{Purpose, bits};
use discjump_core::solids::{Solid, Solids};
use discjump_core::task::{ActionKind, Actions, Grounds, Level, Pitch};
use discjump_core::terrain::mission::Area;
use discjump_core::terrain::{Edge, Heightfield, Maps, SurfaceKind};
use glam::DVec3;
use std::sync::Arc;

/// Two maps of hills with steep faces.
fn maps(edge: Edge, surface: SurfaceKind) -> Arc<Maps> {
    let wave = |i: usize| (core::f64::consts::TAU * 2.0 * (i % 32) as f64 / 32.0).sin();
    let field = |tall: f64| {
        let heights = (0..33 * 33).map(|k| tall * wave(k % 33) * wave(k / 33)).collect();
        Heightfield::new(heights, 33, 33, 8.0, [-128.0, -128.0], edge).unwrap().with_surface(surface)
    };
    Arc::new(Maps::new(&[field(12.0), field(30.0)]).unwrap())
}

fn setup(count: usize, fidelity: &str, edge: Edge, autoreset: Autoreset) -> EnvironmentsSetup {
    let area = Area { min: [-100.0, -90.0], max: [110.0, 95.0] };
    let maps = maps(edge, SurfaceKind::Triangles);
    let mut setup =
        EnvironmentsSetup { maps, pitches: vec![Pitch::bare(area); 2], autoreset, ..ski(count, fidelity) };
    setup.task.time_limit = 70;
    setup
}

/// A batch, and all that it returns.
struct Played {
    batch: Box<dyn Environments>,
    observations: Vec<f32>,
    rewards: Vec<f64>,
    flags: [Vec<bool>; 2],
    status: [Vec<f64>; 3],
    outside: Vec<bool>,
}

impl Played {
    fn new(setup: EnvironmentsSetup) -> Self {
        let n = setup.count;
        let mut batch = setup.build().unwrap();
        let mut observations = vec![0.0; n * batch.observation_size()];
        let seeds = (0..n as u64).map(|k| 5 + k).collect();
        batch.reset(&ResetRequest { seeds, ..ResetRequest::default() }, &mut observations).unwrap();
        Self {
            batch,
            observations,
            rewards: vec![0.0; n],
            flags: [vec![false; n], vec![false; n]],
            status: [vec![0.0; n], vec![0.0; n], vec![0.0; n]],
            outside: vec![false; n],
        }
    }

    fn step(&mut self, actions: Actions<'_>) {
        let [terminated, truncated] = &mut self.flags;
        let [distance, speed, time] = &mut self.status;
        let status = Some(StatusOutput { distance, speed, time, outside: &mut self.outside });
        let rewards = Rewards::F64(&mut self.rewards);
        let observations = &mut self.observations;
        self.batch
            .step(actions, StepOutput { observations, rewards, terminated, truncated, status })
            .unwrap();
        for (k, status) in self.batch.status().iter().enumerate() {
            let columns = (self.status[0][k], self.status[1][k], self.status[2][k], self.outside[k]);
            assert_eq!(columns, (status.distance, status.speed, status.time, status.outside), "status {k}");
        }
    }

    /// All of it, as bytes and texts that compare bit by bit.
    fn all(&self) -> (Vec<u8>, String) {
        let numbers = self.observations.iter().chain(self.batch.final_observations());
        let mut bytes: Vec<u8> = numbers.flat_map(|x| x.to_le_bytes()).collect();
        bytes.extend(self.rewards.iter().flat_map(|x| x.to_le_bytes()));
        (bytes, format!("{:?} {:?} {}", self.flags, self.batch.finished(), self.batch.digest()))
    }
}

fn draw(step: u64, k: usize) -> u64 {
    bits(step, k as u64, Purpose::Velocity, 7) >> 8
}

/// Plays the same actions in both and compares every bit as they go; returns how many episodes ended.
fn agree(one: &mut Played, other: &mut Played, steps: u64, kind: ActionKind) -> usize {
    let (n, bins) = (one.batch.len(), one.batch.action_bins());
    let (row, mut ends) = (bins.len(), 0);
    for step in 0..steps {
        let choice = |k: usize| (draw(step / 3, k) % bins[k % row] as u64) as i64;
        let keys: Vec<i64> = (0..n * row).map(choice).collect();
        let small: Vec<i8> = keys.iter().map(|&key| key as i8).collect();
        let floats: Vec<f32> = (0..n * row).map(|k| (draw(step / 3, k) % 13) as f32 / 6.0 - 1.0).collect();
        // Either is as good as the other: both forms of the same keys are taken.
        let (mine, theirs) = match kind {
            ActionKind::MultiDiscrete => (Actions::Int64(&keys), Actions::Int8(&small)),
            ActionKind::Box => (Actions::Float(&floats), Actions::Float(&floats)),
        };
        one.step(mine);
        other.step(theirs);
        assert!(
            one.all() == other.all(),
            "step {step} of {} and {} lanes",
            one.batch.lanes(),
            other.batch.lanes()
        );
        ends += one.batch.finished().len();
    }
    ends
}

#[test]
fn every_width_plays_the_same_episodes() {
    for fidelity in ["authentic", "swept", "fast"] {
        for (edge, autoreset, kind) in [
            (Edge::Tile, Autoreset::NextStep, ActionKind::MultiDiscrete),
            (Edge::Void, Autoreset::SameStep, ActionKind::Box),
            (Edge::Clamp, Autoreset::Disabled, ActionKind::MultiDiscrete),
        ] {
            for count in [5, 37] {
                let make = |lanes| {
                    let actions = kind;
                    let setup = setup(count, fidelity, edge, autoreset);
                    Played::new(EnvironmentsSetup { lanes: Some(lanes), actions, ..setup })
                };
                for lanes in widths().filter(|&lanes| lanes <= 16) {
                    let (mut one, mut many) = (make(1), make(lanes));
                    assert_eq!(many.batch.lanes(), lanes);
                    assert!(one.all() == many.all(), "after the reset");
                    let ends = agree(&mut one, &mut many, 60, kind);
                    assert!(ends >= count, "{ends} ends of {count} environments are too few to test by");
                    // And from each other's snapshots, in the middle of episodes.
                    let snapshot = one.batch.snapshot();
                    one.batch.restore(&many.batch.snapshot()).unwrap();
                    many.batch.restore(&snapshot).unwrap();
                    agree(&mut one, &mut many, 10, kind);
                }
            }
        }
    }
}

#[test]
fn every_width_plays_the_same_episodes_on_bilinear_ground() {
    for (fidelity, edge) in [("authentic", Edge::Tile), ("swept", Edge::Clamp), ("fast", Edge::Void)] {
        let make = |lanes| {
            let maps = maps(edge, SurfaceKind::Bilinear);
            Played::new(EnvironmentsSetup {
                lanes: Some(lanes),
                maps,
                ..setup(37, fidelity, edge, Autoreset::SameStep)
            })
        };
        for lanes in widths().filter(|&lanes| lanes <= 16) {
            let (mut one, mut many) = (make(1), make(lanes));
            assert!(one.all() == many.all(), "after the reset");
            let ends = agree(&mut one, &mut many, 60, ActionKind::MultiDiscrete);
            assert!(ends >= 37, "{ends} ends are too few to test by");
        }
        let cut = Played::new(setup(37, fidelity, edge, Autoreset::SameStep));
        assert!(cut.all() != make(1).all(), "the surface is not seen");
    }
}

/// Goals in the air or on stands, with discs; the stands of the second map are elsewhere, and walls around them.
fn armed(count: usize, fidelity: &str, grounds: Grounds, autoreset: Autoreset) -> EnvironmentsSetup {
    let mut setup = setup(count, fidelity, Edge::Tile, autoreset);
    let level = Level { start_height: 5.0, aside: 10.0, ..Level::beacons((10.0, 60.0), 20.0) };
    setup.task.levels = vec![level, Level { from_stand: true, ..level }];
    (setup.task.arrival_radius, setup.task.capture, setup.task.time_limit) = (4.0, true, 110);
    (setup.grounds, setup.ammo) = (grounds, 3);
    let stand = |x: f64, y: f64| DVec3::new(x, y, 5.0);
    setup.pitches[0].stands = [stand(-20.0, 0.0), stand(20.0, 10.0)];
    setup.pitches[1].stands = [stand(-5.0, -25.0), stand(0.0, 25.0)];
    let walls = |pitch: &Pitch| {
        let wall = |at: DVec3| Solid::cuboid("wall", DVec3::new(1.0, 6.0, 30.0), at + 4.0 * DVec3::X, 0.3);
        Arc::new(Solids::new(&pitch.stands.map(wall), setup.maps.grid()).unwrap())
    };
    setup.solids = setup.pitches.iter().map(walls).collect();
    setup
}

#[test]
fn every_width_plays_the_same_episodes_with_discs_flags_and_solids() {
    for fidelity in ["authentic", "swept", "fast"] {
        for (grounds, autoreset, kind) in [
            (Grounds::Marker, Autoreset::NextStep, ActionKind::MultiDiscrete),
            (Grounds::Stands, Autoreset::SameStep, ActionKind::Box),
            (Grounds::Stands, Autoreset::NextStep, ActionKind::MultiDiscrete),
        ] {
            let make = |lanes| {
                let setup = armed(37, fidelity, grounds, autoreset);
                Played::new(EnvironmentsSetup { lanes: Some(lanes), actions: kind, ..setup })
            };
            for lanes in widths().filter(|&lanes| lanes <= 16) {
                let (mut one, mut many) = (make(1), make(lanes));
                assert_eq!(many.batch.lanes(), lanes);
                assert!(one.all() == many.all(), "after the reset");
                let ends = agree(&mut one, &mut many, 60, kind);
                assert!(ends >= 37, "{ends} ends are too few to test by");
                let snapshot = one.batch.snapshot();
                one.batch.restore(&many.batch.snapshot()).unwrap();
                many.batch.restore(&snapshot).unwrap();
                agree(&mut one, &mut many, 10, kind);
            }
        }
    }
}

#[test]
fn threads_and_lanes_of_a_batch_that_is_shared_out() {
    let count = 1100;
    let make = |threads, lanes| {
        let setup = setup(count, "authentic", Edge::Tile, Autoreset::SameStep);
        Played::new(EnvironmentsSetup { threads: Some(threads), lanes, ..setup })
    };
    for lanes in widths().filter(|&lanes| lanes <= 16) {
        let (mut one, mut shared) = (make(1, Some(1)), make(3, Some(lanes)));
        assert!(agree(&mut one, &mut shared, 40, ActionKind::MultiDiscrete) > 0);
    }
}

#[test]
fn rewards_in_f32_are_those_in_f64_rounded() {
    let mut played = Played::new(setup(37, "authentic", Edge::Tile, Autoreset::NextStep));
    let mut other = Played::new(setup(37, "authentic", Edge::Tile, Autoreset::NextStep));
    let actions = [2i8, 1, 1, 1, 3].repeat(37);
    let mut rounded = vec![0.0f32; 37];
    for _ in 0..40 {
        played.step(Actions::Int8(&actions));
        let [terminated, truncated] = &mut other.flags;
        let (observations, rewards) = (&mut other.observations, Rewards::F32(&mut rounded));
        let output = StepOutput { observations, rewards, terminated, truncated, status: None };
        other.batch.step(Actions::Int8(&actions), output).unwrap();
        let expected: Vec<f32> = played.rewards.iter().map(|&x| x as f32).collect();
        assert_eq!(rounded, expected);
    }
}

#[test]
fn the_parts_of_a_step_are_timed_where_that_is_asked_for() {
    let mut played = Played::new(setup(300, "authentic", Edge::Tile, Autoreset::SameStep));
    let actions = [2i8, 1, 1, 0, 3].repeat(300);
    played.step(Actions::Int8(&actions));
    assert!(played.batch.parts().is_empty());
    played.batch.time_parts(true);
    (0..5).for_each(|_| played.step(Actions::Int8(&actions)));
    let parts = played.batch.parts();
    let names: Vec<_> = parts.iter().map(|part| part.0).collect();
    assert_eq!(names, ["input", "physics", "task", "observation", "output"]);
    assert!(parts.iter().all(|part| part.1 > 0.0), "{parts:?}");
    played.batch.time_parts(false);
    assert!(played.batch.parts().is_empty());
}
