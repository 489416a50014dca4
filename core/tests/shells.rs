//! The grenade launcher and the mortar (appendix): gravity, bounces, arming, and an end to all of them.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::range::*;
use common::*;
use discjump_core::arms::{FREE, GRENADE, MORTAR, Motion, Weapon};
use discjump_core::input::Input;
use discjump_core::real::Scalar;
use discjump_core::rules::Physics;
use discjump_core::terrain::{Edge, Heightfield};

const DT: f64 = 0.032;

fn range<T: Scalar>(terrain: &Heightfield, weapon: &Weapon) -> Range<T> {
    Range::new(terrain, weapon, Physics::default(), 32)
}

fn elasticity(weapon: &Weapon) -> f64 {
    let Motion::Shell { elasticity, .. } = weapon.motion else { panic!() };
    elasticity
}

/// A shell of a weapon, let go at a place with a velocity.
fn dropped<T: Scalar>(terrain: &Heightfield, weapon: &Weapon, at: [f64; 3], velocity: [f64; 3]) -> Range<T> {
    let mut range = range::<T>(terrain, weapon);
    range.shoot();
    let shell = &mut range.arms.slots[0];
    (shell.position, shell.velocity) = (v3(at), v3(velocity));
    range
}

#[test]
fn the_table_of_the_appendix() {
    for (weapon, speed, cycle, arms) in [(&GRENADE, 54.8, 32, 32), (&MORTAR, 74.2, 63 + 16, 63)] {
        let range = range::<f64>(&flat(), weapon);
        assert!((range.arsenal.speed - speed).abs() < 0.05);
        assert_eq!(range.arsenal.cycle, cycle);
        let discjump_core::arms::Flight::Shell { arms: armed, .. } = range.arsenal.flight else { panic!() };
        assert_eq!(armed, arms);
    }
}

/// Gravity first, then the place: after n ticks v0 t - g t (t + dt) / 2.
#[test]
fn a_parabola() {
    for weapon in [&GRENADE, &MORTAR] {
        let mut range = range::<f64>(&flat(), weapon);
        range.place([0.0, 0.0, 2000.0], [10.0, 0.0, -6.0]);
        range.aim(0.0, 0.8);
        let shot = range.shoot();
        let (speed, v) = (weapon.speed, floats(shot.velocity));
        assert!((v[0] - 5.0).abs() < 1e-12 && (v[1] - speed * 0.8f64.cos()).abs() < 1e-12);
        assert!((v[2] - (speed * 0.8f64.sin() - 3.0)).abs() < 1e-12);
        let flight = range.flight();
        assert_eq!(flight.len(), 249, "8 s are 250 ticks, and it is gone in the last");
        for (k, shell) in flight.iter().enumerate() {
            let t = (k + 1) as f64 * DT;
            let z = 2001.5 + v[2] * t - 10.0 * t * (t + DT);
            let wanted = [0.2 + 5.0 * t, 0.5 + v[1] * t, z];
            assert!((0..3).all(|i| (floats(shell.position)[i] - wanted[i]).abs() < 1e-8));
        }
    }
}

/// Dropped on flat ground, each bounce takes its share of the speed along the normal, and nothing
/// sideways.
#[test]
fn a_bounce_keeps_the_tangent_and_its_share_of_the_normal() {
    for weapon in [&GRENADE, &MORTAR] {
        let mut range = dropped::<f64>(&flat(), weapon, [0.0, 0.0, 0.3], [7.0, -3.0, -30.0]);
        range.fly();
        let shell = range.arms.slots[0];
        let impact = 30.0 + 20.0 * DT;
        let out = elasticity(weapon) * impact + 0.001;
        assert!((shell.velocity.z - out).abs() < 1e-9);
        assert_eq!((shell.velocity.x, shell.velocity.y), (7.0, -3.0));
        // The rest of the tick goes on with the new velocity.
        let left = DT - 0.3 / impact;
        assert!((shell.position.z - out * left).abs() < 1e-9);
        assert!((shell.position.x - 7.0 * DT).abs() < 1e-9);
    }
}

#[test]
fn a_bounce_off_a_slope_turns_about_its_normal() {
    let mut range = dropped::<f64>(&slope(30.0), &GRENADE, [0.0, 0.0, 0.1], [0.0, 2.0, -20.0]);
    range.fly();
    let (sin, cos) = 30.0f64.to_radians().sin_cos();
    let fallen = 20.0 + 20.0 * DT;
    // Downhill is (cos, 0, -sin), the normal (sin, 0, cos).
    let (along, out) = (fallen * sin, 0.45 * fallen * cos + 0.001);
    let wanted = [along * cos + out * sin, 2.0, out * cos - along * sin];
    let got = floats(range.arms.slots[0].velocity);
    assert!((0..3).all(|k| (got[k] - wanted[k]).abs() < 1e-9), "{got:?} {wanted:?}");
}

/// Lobbed at the ground it bounces on, and bursts at the first contact after its time; where it is then,
/// it is on the ground.
fn check_arming<T: Scalar>(weapon: &Weapon, armed: i32, within: f64) {
    let mut range = range::<T>(&flat(), weapon);
    range.aim(0.3, -0.6);
    range.shoot();
    let flight = range.flight();
    let bounces = flight.windows(2).filter(|w| w[0].velocity.z < w[1].velocity.z).count();
    assert!(bounces >= 1, "{bounces}");
    let last = flight.last().unwrap();
    assert!(last.burst() && last.age > armed, "{}", last.age);
    assert!(last.position.z.to_f64().abs() < within);
    assert!(flight.iter().all(|s| s.position.z.to_f64() > -within));
    // It lay on the ground or hopped a little: no long wait.
    assert!(last.age <= armed + 20, "{}", last.age);
}

#[test]
fn bounces_then_bursts_once_armed() {
    check_arming::<f64>(&GRENADE, 32, 1e-9);
    check_arming::<f32>(&GRENADE, 32, 1e-4);
    check_arming::<f64>(&MORTAR, 63, 1e-9);
    check_arming::<f32>(&MORTAR, 63, 1e-4);
}

/// Armed in the air, it bursts where it first comes down.
#[test]
fn a_long_shot_bursts_where_it_lands() {
    for (weapon, metres) in [(&GRENADE, 150.0), (&MORTAR, 275.0)] {
        let mut range = range::<f64>(&flat(), weapon);
        range.aim(0.0, core::f64::consts::FRAC_PI_4);
        range.shoot();
        let flight = range.flight();
        let last = flight.last().unwrap();
        assert!(last.burst());
        // The range of v^2 / g at 45 degrees, from 1.5 m up, a little less for the tick's own parabola.
        let reached = last.position.y - 0.5;
        let v = weapon.speed * core::f64::consts::FRAC_1_SQRT_2;
        // v t - 10 t (t + dt) + 1.5 = 0.
        let b = v - 10.0 * DT;
        let t = (b + (b * b + 60.0).sqrt()) / 20.0;
        assert!((reached - v * t).abs() < 0.03, "{reached} {}", v * t);
        assert!((reached - metres).abs() < 2.5, "{reached}");
    }
}

/// At rest in a pit of any steepness: no hang, never below the ground, and a burst when its time has come.
fn check_pit<T: Scalar>(degrees: f64, deepest: f64) {
    let depth = 8.0 * degrees.to_radians().tan();
    let heights = (0..25).map(|k| if k == 12 { 0.0 } else { depth }).collect();
    let pit = Heightfield::new(heights, 5, 5, 8.0, [-16.0, -16.0], Edge::Clamp).unwrap();
    for (weapon, armed) in [(&GRENADE, 32), (&MORTAR, 63)] {
        for start in [[0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [0.7, -0.4, depth], [-3.0, 2.0, 1.5 * depth]] {
            for velocity in [[0.0; 3], [3.0, 1.0, -20.0], [-40.0, 55.0, -60.0]] {
                let mut range = dropped::<T>(&pit, weapon, start, velocity);
                let flight = range.flight();
                for shell in &flight {
                    let at = floats(shell.position);
                    let under = range.lab.ground(at[0], at[1]) - at[2];
                    assert!(under < deepest, "{under} m under, {degrees} degrees, {start:?} {velocity:?}");
                }
                let last = flight.last().unwrap();
                if velocity == [0.0; 3] {
                    assert!(last.burst() && (armed + 1..=armed + 60).contains(&last.age), "{}", last.age);
                }
            }
        }
    }
}

#[test]
fn pits_and_creases() {
    for degrees in [10.0, 45.0, 60.0, 75.0] {
        check_pit::<f64>(degrees, 1e-9);
        check_pit::<f32>(degrees, 1e-4);
    }
}

#[test]
fn rough_ground_holds_them() {
    fn check<T: Scalar>(deepest: f64) {
        let (mut bursts, mut bounced) = (0, 0);
        for seed in 0..100 {
            let mut range = range::<T>(&draws::rough(seed), [&GRENADE, &MORTAR][seed as usize % 2]);
            let angle = seed as f64;
            let (x, y) = (50.0 * angle.sin(), 50.0 * angle.cos());
            range.place([x, y, range.lab.ground(x, y)], [5.0, 0.0, 0.0]);
            range.aim((angle * 0.7) % 3.0, 1.4 * (angle * 1.7).sin());
            let muzzle = range.shoot().position;
            if muzzle.z.to_f64() < range.lab.ground(muzzle.x.to_f64(), muzzle.y.to_f64()) {
                continue;
            }
            let flight = range.flight();
            for shell in &flight {
                let at = floats(shell.position);
                let under = range.lab.ground(at[0], at[1]) - at[2];
                assert!(under < deepest, "{under} m under the ground, seed {seed}");
            }
            bursts += usize::from(flight.last().unwrap().burst());
            bounced += usize::from(flight.windows(2).any(|w| w[0].velocity.z < w[1].velocity.z));
        }
        assert!(bursts > 60 && bounced > 30, "{bursts} {bounced}");
    }
    check::<f64>(1e-9);
    check::<f32>(2e-3);
}

/// Fired from within a hill it rises out of it, or, downwards, off the ground it is under.
#[test]
fn a_shell_from_below_the_ground_comes_out() {
    for pitch in [1.0, -1.0] {
        let mut range = range::<f64>(&flat(), &GRENADE);
        range.place([0.0, 0.0, -3.0], [0.0; 3]);
        range.aim(0.0, pitch);
        range.shoot();
        let flight = range.flight();
        assert!(flight.iter().any(|s| s.position.z > 1.0));
        let last = flight.last().unwrap();
        assert!(last.burst() && last.position.z.abs() < 1e-9);
    }
}

#[test]
fn over_nothing_it_falls_until_its_life_ends() {
    let terrain = Heightfield::new(vec![0.0; 9], 3, 3, 8.0, [-8.0, -8.0], Edge::Void).unwrap();
    let mut range = range::<f32>(&terrain, &MORTAR);
    range.shoot();
    let flight = range.flight();
    assert_eq!(flight.len(), 249);
    assert!(flight[248].position.z < -500.0);
    assert_eq!(range.arms.slots[0].phase, FREE);
}

/// Jumping on one's own grenade: straight down, it comes back after its bounce and bursts beside its
/// shooter, who never meets it on the way.
#[test]
fn a_grenade_jump() {
    let mut range = range::<f32>(&flat(), &GRENADE);
    range.tick(&trigger(-2.0));
    let mut ticks = 1;
    while range.tick(&Input::idle()).is_empty() {
        ticks += 1;
        assert!(ticks < 200);
    }
    // Up at 0.45 of the muzzle speed and down again.
    let wanted = 2.0 * 0.45 * GRENADE.speed / 20.0 / DT;
    assert!((f64::from(ticks) - wanted).abs() < 4.0, "{ticks} {wanted}");
    assert!(range.p.velocity.z > 1.0 && range.p.damage.0 > 0.2);
}
