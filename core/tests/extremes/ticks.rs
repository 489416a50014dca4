//! Items 6 and 18: ages that are whole numbers, and ticks of 1 to 1000 ms.

use crate::common::lab::*;
use crate::common::{IDLE, JET, JUMP, TIERS, World, by_model as by_tier, draws, setup, slope};
use crate::{form, lab};
use discjump_core::batch::SimulatorSetup;
use discjump_core::movement::Movement;
use discjump_core::real::Scalar;
use discjump_core::rules::Model;
use discjump_core::scene::Has;

const LENGTHS: [u32; 14] = [1, 2, 7, 8, 16, 31, 32, 33, 64, 100, 255, 256, 257, 1000];

fn world(terrain: &discjump_core::terrain::Heightfield, tier: &str, tick_ms: u32) -> World {
    World { sim: SimulatorSetup { tick_ms, ..setup(terrain, tier) }.build().unwrap() }
}

/// A contact allows jumps while its age is below 256 ms, counted in whole milliseconds: ceil(256 / tick) ticks,
/// whatever 256 sums of the tick in floating point would be. The engine counts 7 ticks of any length.
#[test]
fn e06_ages_are_counted_exactly_at_any_tick_length() {
    let flat = slope(0.0);
    for tier in TIERS {
        for tick_ms in LENGTHS {
            let jumps = |delay: u32| {
                let mut w = world(&flat, tier, tick_ms);
                w.step(IDLE);
                assert_eq!(w.get("touched"), [1.0], "{tier}, {tick_ms} ms");
                // Lifted off right after the contact: nothing more is touched.
                let p = w.position();
                w.set(&[("position", &[p[0], p[1], p[2] + 90_000.0]), ("velocity", &[0.0; 3])]);
                (1..delay).for_each(|_| w.step(IDLE));
                let before = w.velocity()[2];
                w.step(JUMP);
                w.velocity()[2] > before + 8.0 - 0.021 * f64::from(tick_ms)
            };
            let last = by_tier(tier, f64::from(256u32.div_ceil(tick_ms)), 7.0) as u32;
            assert!(jumps(last) && !jumps(last + 1), "{tier}, {tick_ms} ms: {last} ticks");
        }
    }
}

/// A jump after n ticks of any length: v t - g t (t + dt) / 2, in the engine v t - g t^2 / 2. So the apex is
/// 1.669, 1.603 and 1.480 m at 16, 32 and 64 ms.
#[test]
fn e18_a_jump_at_any_tick_length() {
    fn check<M: Movement, T: Scalar>() {
        for tick_ms in LENGTHS {
            let lab = lab::<M, T>(&slope(0.0), tick_ms);
            let mut p: Body<T> = lab.player([0.0; 3], [0.0; 3]);
            let Has(contact) = &mut p.contact;
            contact.age = 0;
            let (v, dt) = (75.0 / 9.0, f64::from(tick_ms) / 1000.0);
            let mut apex = 0.0f64;
            for n in 1.. {
                p = lab.tick_as::<M, _>(&p, &input(0, 0, n == 1, false, 0));
                let t = f64::from(n) * dt;
                let lag = if M::MODEL == Model::Engine { 0.0 } else { dt };
                let z = v * t - 10.0 * t * (t + lag);
                if z < 0.05 {
                    break;
                }
                let got = p.position.z.to_f64();
                assert!((got - z).abs() < 1e-4, "{}, {tick_ms} ms, tick {n}: {got}, not {z}", form::<M, T>());
                apex = apex.max(got);
            }
            let known = [(16, 1.669), (32, 1.603), (64, 1.480)].into_iter().find(|k| k.0 == tick_ms);
            if let (Some((_, wanted)), true) = (known, M::MODEL == Model::Article) {
                // The highest of the ticks is at most so far from v^2 / 2g - v dt / 2.
                assert!((apex - wanted).abs() < 2.5 * dt * dt + 5e-4, "{tick_ms} ms: {apex}");
            }
        }
    }
    in_every_form!(check);
}

/// What is given by the second is spent by the second: the tank by burning, and the speed by friction.
#[test]
fn e18_per_second_constants_scale() {
    let flat = slope(0.0);
    for tier in TIERS {
        for tick_ms in LENGTHS {
            let dt = f64::from(tick_ms) / 1000.0;
            let mut w = world(&flat, tier, tick_ms);
            w.set(&[("position", &[0.0, 0.0, 3000.0]), ("energy", &[60.0])]);
            // The first 2 s: 25 - 8 energy/s are lost, and 236/9 - 20 m/s^2 gained.
            let ticks = (2.0 / dt).floor();
            (0..ticks as u32).for_each(|_| w.step(JET));
            let spent = 60.0 - w.get("energy")[0];
            assert!((spent - 17.0 * ticks * dt).abs() < 1e-2, "{tier}, {tick_ms} ms: {spent}");
            let rise = w.velocity()[2];
            assert!((rise - (236.0 / 9.0 - 20.0) * ticks * dt).abs() < 1e-2, "{tier}, {tick_ms} ms: {rise}");
            // Friction takes 40 m/s^2.
            let mut w = world(&flat, tier, tick_ms);
            w.set(&[("position", &[0.0, 0.0, 3000.0]), ("velocity", &[500.0, 0.0, 0.0])]);
            w.set(&[("touched", &[1.0]), ("friction", &[1.0])]);
            w.step(IDLE);
            let lost = 500.0 - w.velocity()[0];
            assert!((lost - 40.0 * dt).abs() < 1e-3, "{tier}, {tick_ms} ms: {lost}");
        }
    }
}

/// Random play on rough ground at every tick length: always a possible player.
#[test]
fn e18_every_tick_length_leaves_possible_players() {
    fn check<M: Movement, T: Scalar>() {
        for (k, tick_ms) in LENGTHS.into_iter().enumerate() {
            let lab = lab::<M, T>(&draws::rough(k as u64), tick_ms);
            let dt = f64::from(tick_ms) / 1000.0;
            for run in 0..6i32 {
                let angle = f64::from(run) * 1.3;
                let (x, y) = (40.0 * angle.cos(), 40.0 * angle.sin());
                let mut p: Body<T> = lab.player([x, y, lab.ground(x, y) + 1.0], [30.0, -20.0, -10.0]);
                for tick in 0..150i32 {
                    let before = p;
                    let key = |n: i32| (((tick / 9 + run) * n) % 3 - 1) as i8;
                    p = lab.tick_as::<M, _>(&p, &input(key(1), key(2), tick % 2 == 0, tick % 50 < 25, 10));
                    let what = format!("{}, {tick_ms} ms: {before:?} {p:?}", form::<M, T>());
                    assert!(numbers(&p).iter().all(|x| x.is_finite()), "{what}");
                    assert!(
                        p.damage.0 >= before.damage.0 && (T::zero()..=T::lit(60.0)).contains(&p.energy.0)
                    );
                    let speed = |p: &Body<T>| floats(p.velocity).iter().map(|v| v * v).sum::<f64>().sqrt();
                    let gain = (20.0 + 236.0 / 9.0 + 40.0) * dt + 75.0 / 9.0 + 4.0 * 0.001;
                    assert!(speed(&p) <= speed(&before) * (1.0 + 1e-6) + gain + 1e-4, "{what}");
                    let held = ["Sliced", "Fast"].iter().any(|n| form::<M, T>().contains(n));
                    assert!(!held || lab.clearance(&p) > -2e-2, "{what}: {} m", lab.clearance(&p));
                }
            }
        }
    }
    in_every_form!(check);
}
