//! The disc launcher against section 7, section 11 item 19 and the order of a tick in section 12.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::range::*;
use common::*;
use discjump_core::armor::LIGHT;
use discjump_core::arms::{Arsenal, DISC, FREE};
use discjump_core::blast::coverage_on_terrain;
use discjump_core::input::Input;
use discjump_core::real::Scalar;
use discjump_core::rules::{Acceleration, DiscFlight, Physics};
use discjump_core::terrain::{Edge, Heightfield};

const AIR: [f64; 3] = [0.0, 0.0, 500.0];

fn physics(accel: Acceleration, disc: DiscFlight) -> Physics {
    Physics { accel, disc, ..Physics::default() }
}

fn range<T: Scalar>(terrain: &Heightfield, accel: Acceleration, disc: DiscFlight) -> Range<T> {
    Range::new(terrain, &DISC, physics(accel, disc), 32)
}

/// A disc launcher high over flat ground, as the project has it.
fn nominal<T: Scalar>() -> Range<T> {
    let mut range = range(&flat(), Acceleration::Nominal, DiscFlight::Surface);
    range.place(AIR, [0.0; 3]);
    range
}

fn engine() -> Range<f64> {
    let mut range = range(&flat(), Acceleration::Nominal, DiscFlight::Engine);
    range.place(AIR, [0.0; 3]);
    range
}

fn close(a: [f64; 3], b: [f64; 3], within: f64) {
    assert!((0..3).all(|k| (a[k] - b[k]).abs() <= within), "{a:?} is not {b:?}");
}

#[test]
fn the_muzzle_turns_with_the_yaw_and_the_aim_with_the_pitch() {
    let mut range = nominal::<f64>();
    let shot = range.shoot();
    close(floats(shot.position), [0.2, 0.5, 501.5], 1e-12);
    close(floats(shot.velocity), [0.0, 65.0, 0.0], 1e-12);

    let mut range = nominal::<f64>();
    range.aim(core::f64::consts::FRAC_PI_2, 0.5);
    let shot = range.shoot();
    // Facing west: right is north.
    close(floats(shot.position), [-0.5, 0.2, 501.5], 1e-12);
    close(floats(shot.velocity), [-65.0 * 0.5f64.cos(), 0.0, 65.0 * 0.5f64.sin()], 1e-12);
    assert!((shot.axis.length() - 1.0).abs() < 1e-12);
}

#[test]
fn half_of_the_shooters_velocity_is_taken_along() {
    let mut range = nominal::<f64>();
    range.place(AIR, [12.0, -8.0, 30.0]);
    close(floats(range.shoot().velocity), [6.0, 61.0, 15.0], 1e-12);
}

/// It leaves from the place and with the velocity before the move, and moves in the same tick.
#[test]
fn fired_before_the_move_and_flown_after_it() {
    let mut range = nominal::<f64>();
    range.place(AIR, [0.0, 40.0, 0.0]);
    range.tick(&Input { turn: -10.0, ..trigger(0.0) });
    // The view turned before the trigger: 0.32 rad to the right.
    let (sin, cos) = 0.32f64.sin_cos();
    let (vx, vy) = (65.0 * sin, 65.0 * cos + 20.0);
    let gain = (5.0f64 * 0.032).min(80.0 - 65.0 - 20.0 * cos).max(0.0);
    let (vx, vy) = (vx + gain * sin, vy + gain * cos);
    let disc = range.arms.slots[0];
    let muzzle = [0.2 * cos + 0.5 * sin, -0.2 * sin + 0.5 * cos, 501.5];
    close(floats(disc.position), [muzzle[0] + vx * 0.032, muzzle[1] + vy * 0.032, 501.5], 1e-9);
    close(floats(disc.velocity), [vx, vy, 0.0], 1e-9);
    assert_eq!(disc.age, 1);
    assert!((range.p.position.y - 40.0 * 0.032).abs() < 1e-9);
}

#[test]
fn a_shot_every_56_ticks_until_none_is_left() {
    let mut range = nominal::<f32>();
    let mut shots = Vec::new();
    for tick in 0..1200 {
        let before = range.arms.ammo;
        range.tick(&trigger(1.2));
        if range.arms.ammo < before {
            shots.push(tick);
        }
    }
    assert_eq!(shots, (0..15).map(|k| 56 * k).collect::<Vec<_>>());
    assert_eq!((range.arms.ammo, range.arms.cooldown), (0, 0));
    assert!((56.0 * range.lab.rules.dt - 1.792).abs() < 1e-6);
}

#[test]
fn a_trigger_pulled_too_early_is_forgotten_and_one_pulled_late_fires_at_once() {
    let mut range = nominal::<f64>();
    range.tick(&trigger(0.0));
    (1..56).for_each(|_| drop(range.tick(&trigger(0.0))));
    assert_eq!(range.arms.ammo, 14);
    (0..20).for_each(|_| drop(range.tick(&Input::idle())));
    assert_eq!(range.arms.ammo, 14);
    range.tick(&trigger(0.0));
    assert_eq!((range.arms.ammo, range.arms.cooldown), (13, 56));
}

#[test]
fn without_acceleration_203_steps_are_422_metres() {
    let mut range = range::<f64>(&flat(), Acceleration::None, DiscFlight::Surface);
    range.place(AIR, [0.0; 3]);
    range.shoot();
    let flight = range.flight();
    assert_eq!(flight.len(), 203, "gone in the 204th tick");
    let metres = floats(flight[202].position)[1] - 0.5;
    assert!((metres - 203.0 * 0.032 * 65.0).abs() < 1e-9 && (metres - 422.0).abs() < 0.5);
    // Gone without a burst, and nothing of it is left.
    let slot = range.arms.slots[0];
    assert_eq!((slot.phase, slot.age, floats(slot.position)), (FREE, 0, [0.0; 3]));
}

#[test]
fn nominal_acceleration_to_80_in_3_s() {
    for (accel, rate) in [(Acceleration::Nominal, 5.0), (Acceleration::Mass, 2.5)] {
        let mut range = range::<f64>(&flat(), accel, DiscFlight::Surface);
        range.place(AIR, [0.0; 3]);
        range.shoot();
        let flight = range.flight();
        assert_eq!(flight.len(), 203);
        let mut y = 0.5;
        for (k, disc) in flight.iter().enumerate() {
            let speed = (65.0 + rate * 0.032 * (k + 1) as f64).min(80.0);
            y += speed * 0.032;
            close(floats(disc.velocity), [0.0, speed, 0.0], 1e-9);
            close(floats(disc.position), [0.2, y, 501.5], 1e-9);
        }
        let reached = flight.iter().position(|d| d.velocity.y > 80.0 - 1e-9).unwrap() + 1;
        assert_eq!(reached, (15.0f64 / (rate * 0.032)).ceil() as usize);
    }
}

/// Section 11, item 19: without the engine's snap nothing jumps, at 30 m/s along the aim or faster.
#[test]
fn a_fast_shooters_disc_is_neither_slowed_nor_pushed() {
    for (along, wanted) in [(29.0, 79.5 + 0.16), (29.9, 80.0), (30.0, 80.0), (60.0, 95.0)] {
        let mut range = nominal::<f64>();
        range.place(AIR, [10.0, along, 0.0]);
        range.shoot();
        range.fly();
        close(floats(range.arms.slots[0].velocity), [5.0, wanted, 0.0], 1e-9);
    }
}

#[test]
fn a_disc_of_one_who_runs_backwards_faster_than_130_flies_backwards() {
    let mut range = nominal::<f64>();
    range.place(AIR, [0.0, -200.0, 0.0]);
    range.shoot();
    let flight = range.flight();
    assert_eq!(flight.len(), 203);
    assert!(flight.iter().all(|d| d.velocity.y < 0.0));
    assert!(flight.windows(2).all(|w| w[1].position.y < w[0].position.y));
    // At 130 exactly it stands in the air, and then drifts off along its aim.
    let mut range = nominal::<f64>();
    range.place(AIR, [0.0, -130.0, 0.0]);
    assert_eq!(floats(range.shoot().velocity), [0.0; 3]);
    assert_eq!(range.flight().len(), 203);
}

#[test]
fn the_engines_disc_keeps_its_own_clock() {
    let mut range = engine();
    range.shoot();
    let flight = range.flight();
    assert_eq!(flight.len(), 203);
    let mut at = vec![0.5];
    at.extend(flight.iter().map(|d| d.position.y));
    let steps: Vec<f64> = at.windows(2).map(|w| w[1] - w[0]).collect();
    let still: Vec<usize> = (0..203).filter(|&k| steps[k] == 0.0).collect();
    // None in the tick of the shot and the next, then none in every 33rd.
    assert_eq!(still, [0, 1, 34, 67, 100, 133, 166, 199]);
    let moved = steps.iter().filter(|&&s| s != 0.0);
    assert!(moved.clone().all(|s| (s - 65.0 / 30.0).abs() < 1e-9));
    // Over whole rounds of 33 ticks.
    let speed = (at[2 + 5 * 33] - at[2]) / (5.0 * 33.0 * 0.032);
    assert!((speed - 65.66).abs() < 0.005, "{speed}");
}

#[test]
fn the_engines_disc_snaps_to_its_terminal_speed() {
    let mut range = engine();
    range.aim(0.6, 0.0);
    let aim = [-(0.6f64.sin()), 0.6f64.cos(), 0.0];
    // 30 m/s along the aim: every component is just that of the terminal velocity.
    range.place(AIR, [31.0 * aim[0], 31.0 * aim[1], 4.0]);
    range.shoot();
    range.fly();
    close(floats(range.arms.slots[0].velocity), aim.map(|a| 80.0 * a), 1e-9);
    let mut slow = engine();
    slow.aim(0.6, 0.0);
    slow.place(AIR, [29.0 * aim[0], 29.0 * aim[1], 4.0]);
    slow.shoot();
    slow.fly();
    close(floats(slow.arms.slots[0].velocity), [79.5 * aim[0], 79.5 * aim[1], 2.0], 1e-9);
}

/// A ridge a centimetre wide and 10 m high, 8 m beyond a flat field.
fn ridge() -> Heightfield {
    let (rows, cols) = (4097, 3);
    let heights = (0..rows * cols).map(|k| if k / cols == 2048 { 10.0 } else { 0.0 }).collect();
    Heightfield::new(heights, rows, cols, 0.01, [0.0, -20.48], Edge::Clamp).unwrap()
}

fn check_ridge<T: Scalar>(within: f64) {
    for start in [-1.0, -1.7, -2.9, -7.77] {
        let mut range = range::<T>(&ridge(), Acceleration::None, DiscFlight::Surface);
        range.place([0.0, start, 2.0], [0.0; 3]);
        range.shoot();
        let flight = range.flight();
        let last = flight.last().unwrap();
        assert!(last.burst());
        // The ridge's face at 3.5 m up stands 0.0065 m before its crest.
        assert!((last.position.y.to_f64() + 0.0065).abs() < within, "{:?}", last.position);
        assert!(last.axis.y.to_f64() < -0.99);
    }
}

#[test]
fn a_thin_ridge_is_never_flown_through() {
    check_ridge::<f64>(1e-9);
    check_ridge::<f32>(1e-5);
}

#[test]
fn the_engines_disc_bursts_before_the_step_that_hits() {
    let mut range = range::<f64>(&ridge(), Acceleration::None, DiscFlight::Engine);
    range.place([0.0, -7.77, 2.0], [0.0; 3]);
    range.shoot();
    let flight = range.flight();
    let last = flight.last().unwrap();
    // The muzzle is 7.27 m away, a step 2.1667 m long: three are made and the fourth would hit.
    close(floats(last.position), [0.2, -7.27 + 3.0 * 65.0 / 30.0, 3.5], 1e-9);
    assert_eq!(flight.len(), 2 + 4);
}

/// A disc shot at the own feet in the engine bursts at the muzzle.
#[test]
fn at_the_feet_in_the_engine_is_at_the_muzzle() {
    let mut range = range::<f64>(&flat(), Acceleration::Nominal, DiscFlight::Engine);
    range.aim(0.0, -1.5);
    let shot = range.shoot();
    let flight = range.flight();
    assert_eq!(floats(flight.last().unwrap().position), floats(shot.position));
    assert_eq!(flight.len(), 3);
}

#[test]
fn a_wall_within_the_first_step() {
    let mut range = range::<f64>(&ridge(), Acceleration::Nominal, DiscFlight::Surface);
    range.place([0.0, -0.7, 0.0], [0.0; 3]);
    let bursts = range.tick(&trigger(0.0));
    assert_eq!(bursts.len(), 1);
    assert!((bursts[0].position.y + 0.0085).abs() < 1e-9);
    assert_eq!(bursts[0].age, 1);
    // The blast is felt at once, by its own shooter too.
    assert!(range.p.velocity.length() > 5.0 && range.p.damage.0 > 0.4);
    // And it lies in its slot to be read until projectiles move again.
    assert!(range.arms.slots[0].burst());
    range.tick(&Input::idle());
    assert_eq!(range.arms.slots[0].phase, FREE);
}

/// The disc of one who stands with his muzzle in the ground flies until it meets the surface from below.
#[test]
fn a_disc_from_below_the_ground() {
    let mut range = range::<f64>(&flat(), Acceleration::None, DiscFlight::Surface);
    range.place([0.0, 0.0, -12.0], [0.0; 3]);
    range.aim(0.0, 0.5);
    range.shoot();
    let flight = range.flight();
    let last = flight.last().unwrap();
    assert!(last.burst());
    close(floats(last.position), [0.2, 0.5 + 10.5 / 0.5f64.tan(), 0.0], 1e-9);
    // Downwards it meets nothing.
    range.aim(0.0, -0.5);
    range.arms.cooldown = 0;
    range.shoot();
    assert_eq!(range.flight().len(), 203);
}

/// All of the above in f32 beside f64: a disc shot at the ground bursts on it, and its blast is felt.
#[test]
fn a_disc_jump_by_hand() {
    fn check<T: Scalar>() -> f64 {
        let mut range = range::<T>(&flat(), Acceleration::Nominal, DiscFlight::Surface);
        let input = Input { jump: true, ..trigger(-1.5) };
        let bursts = range.tick(&input);
        assert_eq!(bursts.len(), 1);
        assert!(bursts[0].position.z.to_f64().abs() < 1e-4);
        let mut apex = 0.0f64;
        while floats(range.p.velocity)[2] > 0.0 {
            range.tick(&Input::idle());
            apex = apex.max(floats(range.p.position)[2]);
        }
        apex
    }
    let (single, double) = (check::<f32>(), check::<f64>());
    assert!((single - double).abs() < 1e-3);
    assert!((5.0..8.0).contains(&double), "{double}");
}

/// Every burst on rough ground, in either arithmetic, is on the surface and felt.
#[test]
fn bursts_lie_on_the_surface_and_are_not_covered() {
    fn check<T: Scalar>(within: f64) {
        let mut bursts = 0;
        for seed in 0..60 {
            let terrain = draws::rough(seed);
            let mut range = range::<T>(&terrain, Acceleration::Nominal, DiscFlight::Surface);
            let angle = seed as f64;
            range.place([50.0 * angle.sin(), 50.0 * angle.cos(), 30.0], [0.0; 3]);
            range.aim((angle * 0.7) % 3.0, -0.3);
            range.shoot();
            let flight = range.flight();
            let last = flight.last().unwrap();
            if !last.burst() {
                continue;
            }
            bursts += 1;
            let ground = range.lab.ground(last.position.x.to_f64(), last.position.y.to_f64());
            assert!((last.position.z.to_f64() - ground).abs() < within, "{last:?} {ground}");
            assert!((last.axis.length().to_f64() - 1.0).abs() < 1e-6 && last.axis.z > T::zero());
            let surface = range.lab.maps.surface::<T>();
            assert_eq!(coverage_on_terrain(&surface, 0, last.position).to_f64(), 1.0);
        }
        assert!(bursts > 50);
    }
    check::<f64>(1e-9);
    check::<f32>(2e-3);
}

/// A shot across the seam of a tiling map, and the same far away: the same bits, tile for tile.
#[test]
fn tiles_change_no_bit() {
    let run = |tile: [i32; 2]| {
        let mut range = range::<f32>(&rolling(), Acceleration::Nominal, DiscFlight::Surface);
        range.place([250.0, 3.0, 120.0], [3.0, 4.0, 0.0]);
        (range.p.tile_x, range.p.tile_y) = (tile[0], tile[1]);
        range.aim(-1.3, 0.02);
        range.shoot();
        range.flight()
    };
    let (here, mut there) = (run([0, 0]), run([-700_000, 12_345]));
    assert!(here.last().unwrap().tile_x > 0);
    for disc in &mut there {
        disc.tile_x += 700_000;
        disc.tile_y -= 12_345;
    }
    assert_eq!(format!("{here:?}"), format!("{there:?}"));
    assert!(here.iter().all(|d| (-256.0..256.0).contains(&d.position.x)));
}

/// A burst beyond the seam is as far away as it looks.
#[test]
fn a_burst_in_the_next_tile_is_felt() {
    let mut range = range::<f64>(&rolling(), Acceleration::Nominal, DiscFlight::Surface);
    range.place([255.0, 3.0, range.lab.ground(255.0, 3.0)], [0.0; 3]);
    range.aim(-1.5, 0.0);
    let bursts = range.tick(&trigger(-1.0));
    assert_eq!((bursts.len(), bursts[0].tile_x, range.p.tile_x), (1, 1, 0));
    let speed = range.p.velocity.length();
    assert!((10.0..30.0).contains(&speed) && range.p.velocity.x < -1.0, "{:?}", range.p.velocity);
}

#[test]
fn a_light_and_its_constants() {
    let arsenal = Arsenal::<f64>::new(&DISC, 32, &Physics::default());
    assert_eq!((arsenal.cycle, arsenal.life, arsenal.ammo), (56, 204, 15));
    let kick = arsenal.explosive.kick / LIGHT.mass;
    assert!((kick - 150.0 / 9.0).abs() < 1e-12);
}
