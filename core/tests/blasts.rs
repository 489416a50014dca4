//! Explosions against the tables of the specification, sections 6 and 10, and their edges (11, item 16).
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::range::*;
use common::*;
use discjump_core::armor::{ARMORS, Armor, HEAVY, LIGHT, MEDIUM};
use discjump_core::arms::{DISC, GRENADE, MORTAR, Weapon};
use discjump_core::blast::{Explosive, Harm, body_points, coverage_on_terrain, damage_share, power, strike};
use discjump_core::input::Input;
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::{Cutoff, Knockback, Physics};
use discjump_core::scene::{Group, Has};
use discjump_core::terrain::{Edge, Heightfield, Maps};
use proptest::prelude::*;

/// Section 6: d0; power basic, boosted, tribes; dv of a light basic, boosted, tribes; dv of a medium
/// and a heavy, tribes; damage of a light.
const TABLE: &str = "
0.00 1.0000 2.3636 0.0000 16.67 39.39 0.00 0.00 0.00 0.4333
0.25 0.9667 2.2848 0.2167 16.11 38.08 3.61 2.50 1.81 0.4333
0.50 0.9333 2.2061 0.4333 15.56 36.77 7.22 5.00 3.61 0.4333
0.75 0.9000 2.1273 0.6500 15.00 35.45 10.83 7.50 5.42 0.4333
1.00 0.8667 2.0485 0.8667 14.44 34.14 14.44 10.00 7.22 0.4333
1.25 0.8333 1.9697 1.0833 13.89 32.83 18.06 12.50 9.03 0.4333
1.50 0.8000 1.8909 1.3000 13.33 31.52 21.67 15.00 10.83 0.4333
1.75 0.7667 1.8121 1.5167 12.78 30.20 25.28 17.50 12.64 0.4333
2.00 0.7333 1.7333 1.7333 12.22 28.89 28.89 20.00 14.44 0.4333
2.25 0.7000 1.6545 1.5000 11.67 27.58 25.00 22.50 16.25 0.4167
2.50 0.6667 1.5758 1.3333 11.11 26.26 22.22 22.38 18.06 0.4000
2.75 0.6333 1.4970 1.2048 10.56 24.95 20.08 19.27 16.87 0.3833
3.00 0.6000 1.4182 1.1000 10.00 23.64 18.33 17.02 14.52 0.3667
3.25 0.5667 1.3394 1.0111 9.44 22.32 16.85 15.27 12.80 0.3500
3.50 0.5333 1.2606 0.9333 8.89 21.01 15.56 13.85 11.46 0.3333
3.75 0.5000 1.1818 0.8636 8.33 19.70 14.39 12.64 10.37 0.3167
4.00 0.4667 1.1030 0.8000 7.78 18.38 13.33 11.60 9.44 0.3000
4.25 0.4333 1.0242 0.7410 7.22 17.07 12.35 10.67 8.64 0.2833
4.50 0.4000 0.9455 0.6857 6.67 15.76 11.43 9.83 7.93 0.2667
4.75 0.3667 0.8667 0.6333 6.11 14.44 10.56 9.05 7.29 0.2500
5.00 0.3333 0.7879 0.5833 5.56 13.13 9.72 8.33 6.70 0.2333
5.25 0.3000 0.7091 0.5353 5.00 11.82 8.92 7.66 6.15 0.2167
5.50 0.2667 0.6303 0.4889 4.44 10.51 8.15 7.02 5.64 0.2000
5.75 0.2333 0.5515 0.4439 3.89 9.19 7.40 6.41 5.16 0.1833
6.00 0.2000 0.4727 0.4000 3.33 7.88 6.67 5.82 4.70 0.1667
6.25 0.1667 0.3939 0.3571 2.78 6.57 5.95 5.25 4.26 0.1500
6.50 0.1333 0.3152 0.3152 2.22 5.25 5.25 4.71 3.83 0.1333
6.75 0.1000 0.2364 0.2739 1.67 3.94 4.57 4.17 3.42 0.1167
7.00 0.0667 0.1576 0.2333 1.11 2.63 3.89 3.65 3.02 0.1000
7.25 0.0333 0.0788 0.1933 0.56 1.31 3.22 3.15 2.64 0.0833
7.50 0.0000 0.0000 0.1538 0.00 0.00 2.56 2.65 2.26 0.0667
7.75 0.0000 0.0000 0.1148 0.00 0.00 1.91 2.16 1.89 0.0500
8.00 0.0000 0.0000 0.0762 0.00 0.00 1.27 1.68 1.53 0.0333
8.25 0.0000 0.0000 0.0379 0.00 0.00 0.63 1.20 1.17 0.0167
8.50 0.0000 0.0000 0.0000 0.00 0.00 0.00 0.74 0.82 0.0000
";

const FORMS: [Knockback; 3] = [Knockback::Basic, Knockback::LinearBoosted, Knockback::Tribes];

fn range<T: Scalar>(armor: &Armor, weapon: &Weapon, knockback: Knockback, cutoff: Cutoff) -> Range<T> {
    let mut range = Range::new(&flat(), weapon, Physics { knockback, cutoff, ..Physics::default() }, 32);
    range.wear(armor);
    range
}

/// Change of speed, straight up, and damage by a disc `d0` below the centre of the box in the air.
fn struck<T: Scalar>(armor: &Armor, knockback: Knockback, cutoff: Cutoff, d0: f64) -> (f64, f64) {
    let mut range = range::<T>(armor, &DISC, knockback, cutoff);
    range.place([0.0, 0.0, 100.0], [0.0; 3]);
    range.blast([0.0, 0.0, 100.0 + armor.height / 2.0 - d0]);
    let [x, y, z] = floats(range.p.velocity);
    assert_eq!((x, y), (0.0, 0.0));
    (z, range.p.damage.get(T::zero()).to_f64())
}

/// Whether `x` rounds to what is printed with `digits` decimals, give or take `slack`.
fn printed(x: f64, wanted: f64, digits: i32, slack: f64) {
    assert!((x - wanted).abs() <= 0.5 * 0.1f64.powi(digits) + slack, "{x} is not {wanted}");
}

fn check_table<T: Scalar>(slack: f64) {
    for line in TABLE.trim().lines() {
        let row: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        let t = T::from_f64;
        let d0 = row[0];
        for (k, form) in FORMS.into_iter().enumerate() {
            let power = power(t(d0), t(1.0), t(7.5), form, Cutoff::Engine);
            printed(power.to_f64(), row[1 + k], 4, slack);
            let (speed, damage) = struck::<T>(&LIGHT, form, Cutoff::Engine, d0);
            // A blast in the very centre has power in these forms, but no direction.
            printed(speed, if d0 == 0.0 { 0.0 } else { row[4 + k] }, 2, slack);
            printed(damage, row[9], 4, slack);
        }
        for (armor, wanted) in [(&MEDIUM, row[7]), (&HEAVY, row[8])] {
            let (speed, _) = struck::<T>(armor, Knockback::Tribes, Cutoff::Engine, d0);
            printed(speed, wanted, 2, slack);
        }
    }
}

#[test]
fn the_table_of_knockback_to_its_printed_digits() {
    check_table::<f64>(1e-9);
    // At 100 m up an f32 holds a place to 4e-6 m, and the steepest of the curves gains 17 m/s in a metre.
    check_table::<f32>(4e-4);
}

#[test]
fn the_peak_is_a_kink_a_box_side_beyond_a_metre() {
    for armor in ARMORS {
        let m = (2.0 * armor.half_width).min(armor.height);
        let at = |d0: f64| power(d0, m, 7.5, Knockback::Tribes, Cutoff::Engine);
        let peak = (1.0 + m) * (1.0 - 1.0 / 7.5);
        assert!((at(1.0 + m) - peak).abs() < 1e-12);
        let h = 1e-6;
        let slope = |d0: f64| (at(d0 + h) - at(d0 - h)) / (2.0 * h);
        assert!((slope(0.5 + m) - (1.0 - 1.0 / 7.5)).abs() < 1e-6, "linear below");
        // d/dx of x / (x - m) - x / R at x = 1 + m.
        assert!((slope(1.0 + m + 2.0 * h) - (-m - 1.0 / 7.5)).abs() < 1e-4, "falling beyond");
    }
}

#[test]
fn two_ends() {
    let tribes = |d0: f64, cutoff| power(d0, 1.0, 7.5, Knockback::Tribes, cutoff);
    assert!((tribes(7.5, Cutoff::Engine) - 2.0 / 13.0).abs() < 1e-12);
    assert_eq!(tribes(7.5, Cutoff::Radius), tribes(7.5, Cutoff::Engine));
    for d0 in [7.500_001, 8.0, 8.499_999] {
        assert!(tribes(d0, Cutoff::Engine) > 0.0);
        assert_eq!(tribes(d0, Cutoff::Radius), 0.0);
        assert_eq!(damage_share(d0, 1.0, 7.5, Cutoff::Radius), 0.0);
        assert!(damage_share(d0, 1.0, 7.5, Cutoff::Engine) > 0.0);
        assert_eq!(struck::<f64>(&LIGHT, Knockback::Tribes, Cutoff::Radius, d0), (0.0, 0.0));
    }
    assert_eq!(tribes(8.5, Cutoff::Engine), 0.0);
    assert_eq!(tribes(f64::INFINITY, Cutoff::Engine), 0.0);
    // A heavy's 9.1 m are reached slantwise only: straight up the cube about the blast ends at 8.8 m.
    let heavy = |direction: f64, d0: f64| {
        let mut range = range::<f64>(&HEAVY, &DISC, Knockback::Tribes, Cutoff::Engine);
        range.place([0.0, 0.0, 100.0], [0.0; 3]);
        let (side, up) = ((direction.cos() * d0), direction.sin() * d0);
        range.blast([side * 0.6, side * 0.8, 101.3 + up]);
        range.p.velocity.length()
    };
    assert!(heavy(0.7, 9.09) > 0.0 && heavy(0.7, 9.11) == 0.0);
    assert!(heavy(1.57, 8.79) > 0.0 && heavy(1.57, 8.81) == 0.0);
}

#[test]
fn a_radius_of_a_metre_reaches_nothing_and_a_huge_box_is_all_ramp() {
    for d0 in [0.0f64, 0.3, 1.0, 1.9, 2.0, 5.0] {
        for radius in [0.5, 1.0] {
            assert_eq!(power(d0, 1.0, radius, Knockback::Tribes, Cutoff::Engine), 0.0);
            assert_eq!(damage_share(d0, 1.0, radius, Cutoff::Engine), 0.0);
        }
        let ramp = power(d0, 100.0, 7.5, Knockback::Tribes, Cutoff::Engine);
        assert!((ramp - d0 * (1.0 - 1.0 / 7.5)).abs() < 1e-12);
    }
}

#[test]
fn a_blast_in_the_centre_hurts_and_does_not_push() {
    for form in FORMS {
        let (speed, damage) = struck::<f64>(&LIGHT, form, Cutoff::Engine, 0.0);
        assert_eq!(speed, 0.0);
        assert!((damage - 0.5 * (1.0 - 1.0 / 7.5)).abs() < 1e-12);
    }
}

/// The cube of half side R about the blast must meet the box: sideways a light feels it to 8 m only.
#[test]
fn the_box_must_meet_the_cube() {
    let push = |at: [f64; 3]| {
        let mut range = range::<f64>(&LIGHT, &DISC, Knockback::Tribes, Cutoff::Engine);
        range.place([0.0, 0.0, 100.0], [0.0; 3]);
        range.blast([at[0], at[1], 101.15 + at[2]]);
        range.p.velocity.length()
    };
    for axis in 0..2 {
        for side in [-1.0, 1.0] {
            let at = |d: f64| core::array::from_fn(|k| if k == axis { side * d } else { 0.0 });
            assert!(push(at(7.999)) > 1.2 && push(at(8.001)) == 0.0);
        }
    }
    assert!(push([0.0, 0.0, 8.49]) > 0.0 && push([0.0, 0.0, -8.49]) > 0.0);
    assert_eq!(push([0.0, 0.0, 8.51]), 0.0);
}

#[test]
fn each_kind_of_shell_has_its_armor_factors() {
    let wanted = [[1.0, 1.2, 1.3], [1.0, 1.0, 1.0], [0.6, 0.8, 0.7]];
    for (armor, factors) in ARMORS.into_iter().zip(wanted) {
        for ((weapon, most), factor) in
            [(&DISC, 0.5), (&GRENADE, 0.4), (&MORTAR, 1.0)].into_iter().zip(factors)
        {
            let mut range = range::<f64>(armor, weapon, Knockback::Tribes, Cutoff::Engine);
            range.blast([0.0, 0.0, 0.0]);
            let scale = 1.0 - 1.0 / weapon.explosive.radius;
            assert!(
                (range.p.damage.0 - most * scale * factor).abs() < 1e-12,
                "{} {}",
                armor.name,
                weapon.name
            );
        }
    }
}

#[test]
fn coverage_scales_both_and_what_is_not_struck_is_untouched() {
    let full = struck::<f64>(&LIGHT, Knockback::Tribes, Cutoff::Engine, 3.0);
    for coverage in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let mut range = range::<f64>(&LIGHT, &DISC, Knockback::Tribes, Cutoff::Engine);
        let at = v3([0.0, 0.0, 1.15 - 3.0]);
        strike(&mut range.p, at, false, coverage, &range.arsenal.explosive, &range.lab.rules);
        assert_eq!((range.p.velocity.z, range.p.damage.0), (0.0, 0.0));
        strike(&mut range.p, at, true, coverage, &range.arsenal.explosive, &range.lab.rules);
        assert!((range.p.velocity.z - coverage * full.0).abs() < 1e-12);
        assert!((range.p.damage.0 - coverage * full.1).abs() < 1e-12);
    }
}

/// Height gained in all from standing, jumping in the tick before `delay` more pass, with a blast on the
/// ground below after them; `None` is a blast before the very tick of the jump.
fn jump_height<T: Scalar>(armor: &Armor, delay: Option<u32>, jumps: bool) -> (f64, f64) {
    let mut range = range::<T>(armor, &DISC, Knockback::Tribes, Cutoff::Engine);
    let idle = Input::idle();
    let jump = Input { jump: jumps, ..idle };
    // Settles on the ground, so that there is something to jump from.
    range.p.contact = Has(discjump_core::player::Contact { normal: V3::up(), age: 0 });
    let mut before = floats(range.p.velocity)[2];
    match delay {
        None => {
            range.blast([0.0; 3]);
            range.tick(&jump);
        }
        Some(delay) => {
            (0..delay).for_each(|k| drop(range.tick(if k == 0 { &jump } else { &idle })));
            before = floats(range.p.velocity)[2];
            range.blast([0.0; 3]);
        }
    }
    let gained = floats(range.p.velocity)[2] - before;
    let mut apex = 0.0f64;
    while floats(range.p.velocity)[2] > 0.0 {
        apex = apex.max(floats(range.p.position)[2]);
        range.tick(&idle);
        apex = apex.max(floats(range.p.position)[2]);
    }
    (gained, apex)
}

#[test]
fn a_disc_at_the_feet() {
    for (armor, speed, apex) in [(&LIGHT, 16.6, 6.6), (&MEDIUM, 12.0, 3.4), (&HEAVY, 9.4, 2.1)] {
        let (gained, reached) = jump_height::<f64>(armor, Some(0), false);
        printed(gained, speed, 1, 0.0);
        printed(reached, apex, 1, 0.0);
    }
}

#[test]
fn jump_and_disc_by_the_ticks_between() {
    for (delay, wanted) in [19.2, 23.2, 27.1, 30.0, 24.8, 21.2, 18.6, 16.6].into_iter().enumerate() {
        printed(jump_height::<f64>(&LIGHT, Some(delay as u32 + 1), true).1, wanted, 1, 0.0);
        printed(jump_height::<f32>(&LIGHT, Some(delay as u32 + 1), true).1, wanted, 1, 1e-3);
    }
    printed(jump_height::<f64>(&LIGHT, None, true).1, 15.2, 1, 0.0);
}

#[test]
fn the_best_jump_and_disc_of_each_armor() {
    for (armor, delay, speed, apex) in
        [(&LIGHT, 4, 28.7, 30.0), (&MEDIUM, 6, 23.9, 21.0), (&HEAVY, 7, 18.7, 14.0)]
    {
        let heights: Vec<f64> = (1..=12).map(|n| jump_height::<f64>(armor, Some(n), true).1).collect();
        let best = (0..12).max_by(|&a, &b| heights[a].total_cmp(&heights[b])).unwrap() as u32 + 1;
        assert_eq!(best, delay, "{}", armor.name);
        let (gained, reached) = jump_height::<f64>(armor, Some(delay), true);
        printed(gained, speed, 1, 0.0);
        printed(reached, apex, 0, 0.0);
    }
}

#[test]
fn a_light_survives_one_disc_jump_and_not_two() {
    let mut range = range::<f32>(&LIGHT, &DISC, Knockback::Tribes, Cutoff::Engine);
    range.blast([0.0; 3]);
    assert!(range.p.damage.0 < range.lab.rules.max_damage);
    range.place([0.0; 3], [0.0; 3]);
    range.blast([0.0; 3]);
    assert!(range.p.damage.0 > range.lab.rules.max_damage);
    assert!((range.p.damage.0 - 0.867).abs() < 5e-4);
}

#[test]
fn a_blast_below_the_ground_is_covered() {
    let maps = Maps::new(&[flat()]).unwrap();
    let at = |z: f64| coverage_on_terrain(&maps.surface::<f64>(), 0, V3::new(3.0, 4.0, z));
    assert_eq!([10.0, 0.0, -0.049, -0.051, -10.0].map(at), [1.0, 1.0, 1.0, 0.0, 0.0]);
    let void = Heightfield::new(vec![0.0; 9], 3, 3, 8.0, [-8.0, -8.0], Edge::Void).unwrap();
    let maps = Maps::new(&[void]).unwrap();
    assert_eq!(coverage_on_terrain(&maps.surface::<f64>(), 0, V3::new(50.0, 0.0, -10.0)), 1.0);

    let mut range = range::<f64>(&LIGHT, &DISC, Knockback::Tribes, Cutoff::Engine);
    range.blast([0.0, 0.0, -1.0]);
    assert_eq!((range.p.velocity.z, range.p.damage.0), (0.0, 0.0));
}

#[test]
fn four_points_of_a_body() {
    let mut range = range::<f64>(&LIGHT, &DISC, Knockback::Tribes, Cutoff::Engine);
    range.place([1.0, 2.0, 3.0], [0.0; 3]);
    let points = |range: &Range<f64>| body_points(&range.p, &range.lab.rules).map(floats);
    let wanted = [[1.0, 2.0, 3.575], [1.0, 2.0, 4.725], [0.75, 2.0, 4.4375], [1.25, 2.0, 4.4375]];
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12);
    assert!(points(&range).into_iter().zip(wanted).all(|(a, b)| close(a, b)), "{:?}", points(&range));
    range.aim(core::f64::consts::FRAC_PI_2, 0.0);
    assert!(close(points(&range)[3], [1.0, 2.25, 4.4375]), "facing west, his right is north");
}

/// Any numbers of a possible world, and some of an impossible one.
fn anything() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..10.0, -1e9..1e9, Just(0.0), Just(1e38), Just(-1e38), Just(1e-40)]
}

fn check_strike<T: Scalar>(
    at: [f64; 3],
    velocity: [f64; 3],
    (damage, radius, kick): (f64, f64, f64),
    form: usize,
) -> Result<(), TestCaseError> {
    for cutoff in [Cutoff::Engine, Cutoff::Radius] {
        let mut range = range::<T>(&LIGHT, &DISC, FORMS[form], cutoff);
        let explosive = Explosive { damage, radius, kick, harm: Harm::Explosion }.rounded();
        range.place([0.0; 3], velocity);
        let mut turned = range.p;
        strike(&mut range.p, v3(at), true, T::lit(1.0), &explosive, &range.lab.rules);
        let gained = floats(range.p.velocity);
        prop_assert!(gained.iter().all(|x| x.is_finite()), "{gained:?}");
        prop_assert!(range.p.damage.0.finite() && range.p.damage.0 >= T::zero());
        // Turned by 90 degrees to the left, the blast and what it does: the same bits.
        turned.velocity = v3([-velocity[1], velocity[0], velocity[2]]);
        strike(&mut turned, v3([-at[1], at[0], at[2]]), true, T::lit(1.0), &explosive, &range.lab.rules);
        prop_assert_eq!(floats(turned.velocity), [-gained[1], gained[0], gained[2]]);
        prop_assert!(turned.damage.0 == range.p.damage.0);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn finite_and_without_a_favourite_direction(
        at in [anything(), anything(), anything()],
        velocity in [-100.0..100.0f64, -100.0..100.0, -100.0..100.0],
        explosive in (0.0..2.0f64, 0.01..100.0f64, 0.0..1000.0f64),
        form in 0..3usize,
    ) {
        check_strike::<f32>(at, velocity, explosive, form)?;
        check_strike::<f64>(at, velocity, explosive, form)?;
    }
}

#[test]
fn a_blast_at_no_place_strikes_nobody() {
    for k in 0..3 {
        let mut range = range::<f32>(&LIGHT, &DISC, Knockback::Tribes, Cutoff::Engine);
        let mut at = [0.0; 3];
        at[k] = f64::NAN;
        strike(&mut range.p, v3(at), true, 1.0, &range.arsenal.explosive, &range.lab.rules);
        assert_eq!((floats(range.p.velocity), range.p.damage.0), ([0.0; 3], 0.0));
    }
}
