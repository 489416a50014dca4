//! What must hold of every projectile, whatever the shooter, the weapon, the terrain and the switches.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::range::*;
use common::*;
use discjump_core::arms::{Arms, Arsenal, BURST, FLYING, FREE, Projectile, SLOTS, WEAPONS, visit};
use discjump_core::flight::fire;
use discjump_core::input::Input;
use discjump_core::player::FieldVisitor;
use discjump_core::real::Scalar;
use discjump_core::rules::{Acceleration, DiscFlight, Physics};
use discjump_core::terrain::{Edge, Heightfield};
use proptest::prelude::*;

/// Collects every number of a launcher, by name.
#[derive(Default, PartialEq, Debug)]
struct Numbers(Vec<(&'static str, f64)>);

impl<T: Scalar> FieldVisitor<T> for Numbers {
    fn reals(&mut self, name: &'static str, values: &mut [T]) {
        self.0.extend(values.iter().map(|x| (name, x.to_f64())));
    }
    fn int(&mut self, name: &'static str, value: &mut i32) {
        self.0.push((name, f64::from(*value)));
    }
    fn flag(&mut self, name: &'static str, value: &mut bool) {
        self.0.push((name, f64::from(u8::from(*value))));
    }
}

fn numbers<T: Scalar>(arms: &Arms<T>) -> Vec<(&'static str, f64)> {
    let mut all = Numbers::default();
    visit(&mut arms.clone(), &mut all);
    all.0
}

fn switches(k: usize) -> Physics {
    let accel = [Acceleration::Nominal, Acceleration::None, Acceleration::Mass][k % 3];
    Physics { accel, disc: [DiscFlight::Surface, DiscFlight::Engine][k / 3 % 2], ..Physics::default() }
}

const EDGES: [Edge; 3] = [Edge::Tile, Edge::Clamp, Edge::Void];

fn check_finite<T: Scalar>(
    (seed, edge, weapon, switch, tick_ms): (u64, usize, usize, usize, u32),
    place: [f64; 3],
    velocity: [f64; 3],
    view: [f64; 2],
) -> Result<(), TestCaseError> {
    let field = draws::rough(seed);
    let n = field.rows();
    let field = Heightfield::new(field.heights().to_vec(), n, n, 8.0, field.origin(), EDGES[edge]).unwrap();
    let mut range = Range::<T>::new(&field, WEAPONS[weapon], switches(switch), tick_ms);
    range.place(place, velocity);
    range.aim(view[0], view[1]);
    let input = Input { pitch: T::from_f64(view[1]), fire: true, ..Input::idle() };
    for _ in 0..60 {
        let before = range.arms.ammo;
        let bursts = range.tick(&input);
        prop_assert!(numbers(&range.arms).iter().all(|(_, x)| x.is_finite()), "{:?}", range.arms);
        prop_assert!(floats(range.p.velocity).iter().all(|x| x.is_finite()), "{:?}", range.p);
        prop_assert!((0..=range.arsenal.cycle).contains(&range.arms.cooldown));
        prop_assert!(range.arms.ammo >= 0 && before - range.arms.ammo <= 1);
        for slot in &range.arms.slots {
            prop_assert!([FREE, FLYING, BURST].contains(&slot.phase));
            prop_assert!((0..range.arsenal.life).contains(&slot.age));
            prop_assert!(slot.phase == FREE || (slot.axis.length().to_f64() - 1.0).abs() < 1e-5);
        }
        prop_assert!(bursts.iter().all(|b| b.age > 0));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn everything_stays_finite_and_in_its_place(
        setting in (0..1000u64, 0..3usize, 0..3usize, 0..6usize, prop_oneof![Just(32u32), 1..=1000u32]),
        place in [-64.0..64.0f64, -64.0..64.0, -50.0..80.0],
        velocity in prop_oneof![
            [-60.0..60.0f64, -60.0..60.0, -60.0..60.0],
            [-3e3..3e3f64, -3e3..3e3, -3e3..3e3],
        ],
        view in [-3.0..3.0f64, -1.6..1.6],
    ) {
        check_finite::<f32>(setting, place, velocity, view)?;
        check_finite::<f64>(setting, place, velocity, view)?;
    }
}

/// As fast as a state may be set.
#[test]
fn the_fastest_shooters() {
    for (k, weapon) in WEAPONS.into_iter().enumerate() {
        for velocity in [[1e6, -1e6, 1e6], [-1e6, 0.0, -1e6], [0.0, 0.0, -1e6]] {
            let mut range = Range::<f32>::new(&rolling(), weapon, switches(3 * (k % 2)), 32);
            range.place([3.0, 4.0, 60.0], velocity);
            range.shoot();
            (0..3).for_each(|_| range.fly());
            assert!(numbers(&range.arms).iter().all(|(_, x)| x.is_finite()));
        }
    }
}

/// Its own image when turned by 90 degrees: hills about the origin, an even number of squares a side.
fn round_hills() -> Heightfield {
    let n = 65usize;
    let wave = |i: usize| 6.0 * (core::f64::consts::TAU * (i as f64 - 32.0) / 16.0).cos();
    let heights = (0..n * n).map(|k| wave(k % n) + wave(k / n)).collect();
    Heightfield::new(heights, n, n, 8.0, [-256.0, -256.0], Edge::Tile).unwrap()
}

fn turned([x, y, z]: [f64; 3]) -> [f64; 3] {
    [-y, x, z]
}

fn check_turned(
    weapon: usize,
    switch: usize,
    place: [f64; 3],
    velocity: [f64; 3],
    view: [f64; 2],
) -> Result<(), TestCaseError> {
    let terrain = round_hills();
    let run = |place: [f64; 3], velocity: [f64; 3], yaw: f64| {
        let mut range = Range::<f64>::new(&terrain, WEAPONS[weapon], switches(switch), 32);
        range.place(place, velocity);
        range.aim(yaw, view[1]);
        range.shoot();
        range.flight()
    };
    let here = run(place, velocity, view[0]);
    let there = run(turned(place), turned(velocity), view[0] + core::f64::consts::FRAC_PI_2);
    // A shell's bounces double what rounding parts: they are compared to the first ones only.
    for (k, (a, b)) in here.iter().zip(&there).enumerate().take(40) {
        let world = |p: &Projectile<f64>| {
            let [x, y, z] = floats(p.position);
            [x + 512.0 * f64::from(p.tile_x), y + 512.0 * f64::from(p.tile_y), z]
        };
        let (a, b) = (turned(world(a)), world(b));
        prop_assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-8), "step {k}: {a:?} {b:?}");
    }
    prop_assert_eq!(here.len().min(40), there.len().min(40));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_turned_world_fires_the_turned_shot(
        weapon in 0..3usize,
        switch in 0..6usize,
        place in [-64.0..64.0f64, -64.0..64.0, 12.5..40.0],
        velocity in [-40.0..40.0f64, -40.0..40.0, -20.0..20.0],
        view in [-3.0..1.5f64, -1.2..1.2],
    ) {
        check_turned(weapon, switch, place, velocity, view)?;
    }
}

/// A lane is a player: what is written is what is read, and a slot of one is nobody else's.
#[test]
fn lanes_and_fields() {
    let mut range = Range::<f32>::new(&rolling(), &discjump_core::arms::DISC, Physics::default(), 32);
    range.place([1.0, 2.0, 100.0], [3.0, 4.0, 5.0]);
    (0..120).for_each(|_| drop(range.tick(&trigger(0.4))));
    let arms = range.arms;
    let mut copy = Arms::<f32>::new(&range.arsenal);
    copy.set_lane(0, &arms.lane(0));
    assert_eq!(format!("{arms:?}"), format!("{copy:?}"));
    let names: Vec<_> = numbers(&arms).into_iter().map(|(name, _)| name).collect();
    assert_eq!(&names[..5], ["cooldown", "ammo", "phase", "age", "clock"]);
    assert_eq!(names.len(), 2 + 8 * (3 + 5 + 3 + 3));
    assert_eq!(arms.slots.iter().filter(|s| s.flying()).count(), 3);
}

/// Eight slots are enough for every launcher at every tick length: a projectile is gone before its slot's
/// turn comes again.
#[test]
fn slots_suffice_at_every_tick_length() {
    let ticks = |ms: u32, tick: u32| (f64::from(ms) / f64::from(tick)).ceil() as u32;
    for weapon in WEAPONS {
        let mut most = 0;
        for tick in 1..=1000 {
            let cycle: u32 = weapon.states_ms.iter().map(|&ms| ticks(ms, tick)).sum();
            let life = ticks(weapon.life_ms, tick);
            let arsenal = Arsenal::<f32>::new(weapon, tick, &Physics::default());
            assert_eq!((arsenal.cycle as u32, arsenal.life as u32), (cycle, life));
            most = most.max(life.div_ceil(cycle));
        }
        assert!(most as usize <= SLOTS, "{} takes {most}", weapon.name);
    }
    // And so it is when the trigger is held: no shot comes late.
    for weapon in WEAPONS {
        for tick_ms in [1, 7, 16, 32, 33, 64, 250, 400, 499, 500, 501, 999, 1000] {
            let mut range = Range::<f32>::new(&flat(), weapon, Physics::default(), tick_ms);
            range.place([0.0, 0.0, 5000.0], [0.0; 3]);
            range.aim(0.0, 1.5);
            range.arms.ammo = 1000;
            let cycle = range.arsenal.cycle;
            for tick in 0..(12 * cycle) {
                fire(&mut range.arms, &range.p, true, &range.arsenal);
                range.fly();
                assert_eq!(range.arms.ammo, 999 - tick / cycle, "{} at {tick_ms} ms", weapon.name);
            }
        }
    }
}
