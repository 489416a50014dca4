//! Players and discs among solids, tick by tick, in every tier: what stands stops them, carries them and
//! shades them from blasts; and whoever is far from it does not notice that it stands, in bits.
#![allow(missing_docs)]

mod common;

use common::crew::Crew;
use common::crowd::keys;
use common::*;
use discjump_core::batch::RawInput;
use discjump_core::solids::{Placement, Solid, Solids};
use discjump_core::terrain::Heightfield;
use glam::DVec3;
use std::sync::Arc;

const TIERS: [&str; 5] = ["reference", "authentic", "swept", "fast", "engine"];

fn crew(terrain: &Heightfield, solids: &[Solid], tier: &str, players: usize, per_world: usize) -> Crew {
    let built = Arc::new(Solids::new(solids, terrain.grid()).unwrap());
    let mut s = setup(terrain, tier);
    (s.scene, s.players, s.players_per_world, s.solids) = ("mission", players, per_world, Some(&built));
    Crew::new(&s)
}

fn alone(terrain: &Heightfield, solids: &[Solid], tier: &str) -> Crew {
    crew(terrain, solids, tier, 1, 1)
}

fn cuboid(size: [f64; 3], centre: [f64; 3]) -> Solid {
    Solid::cuboid("box", size.into(), centre.into(), 0.0)
}

#[test]
fn solids_far_away_change_no_bit() {
    let map = rolling();
    let tower = cuboid([10.0, 10.0, 200.0], [500.0, 500.0, 50.0]);
    for tier in TIERS {
        let mut with = alone(&map, core::slice::from_ref(&tower), tier);
        let mut s = setup(&map, tier);
        s.scene = "disc_jump";
        let mut without = Crew::new(&s);
        for tick in 0..300 {
            let input = RawInput { fire: u8::from(tick % 60 == 0), pitch: 0.1, ..keys(3, tick) };
            with.sim.step(&[input], 1).unwrap();
            without.sim.step(&[input], 1).unwrap();
        }
        assert_eq!(with.bytes(0), without.bytes(0), "{tier}");
        assert_eq!(with.sim.projectiles(), without.sim.projectiles(), "{tier}");
    }
}

#[test]
fn a_plate_of_a_millimetre_stops_everyone_at_any_speed() {
    let plate = cuboid([0.001, 200.0, 200.0], [30.0, 0.0, 0.0]);
    for tier in TIERS {
        for speed in [1.0, 20.0, 700.0, 20_000.0, 1e6] {
            for yaw in [0.0f64, 0.6, -1.2] {
                let mut one = alone(&flat(), core::slice::from_ref(&plate), tier);
                let aim = [speed * yaw.cos(), speed * yaw.sin(), 0.0];
                one.put(0, [25.0, 0.0, 20.0], aim);
                for tick in 0..12 {
                    one.sim.step(&[IDLE], 1).unwrap();
                    let p = one.position(0);
                    let beside = p[1].abs() > 100.5;
                    let what = format!("{tier}, {speed} m/s at {yaw}: {p:?} after tick {tick}");
                    assert!(beside || p[0] <= 29.4996, "{what}");
                }
            }
        }
    }
}

#[test]
fn a_level_deck_is_as_good_as_level_ground() {
    // The box touches a level deck with its whole base, where the ground touches the feet: same contacts.
    let deck = cuboid([800.0, 800.0, 2.0], [0.0, 0.0, 19.0]);
    let raised = |z: f64| Heightfield::new(vec![z; 9], 3, 3, 4096.0, [-4096.0; 2], flat().edge()).unwrap();
    for (tier, slack) in
        [("reference", 1e-9), ("authentic", 1e-3), ("swept", 1e-3), ("engine", f64::INFINITY)]
    {
        let mut deck = alone(&flat(), core::slice::from_ref(&deck), tier);
        let mut ground = alone(&raised(20.0), &[], tier);
        for one in [&mut deck, &mut ground] {
            one.put(0, [0.0, 0.0, 21.0], [15.0, 0.0, 0.0]);
        }
        let mut contacts = 0;
        for tick in 0..200 {
            let input = RawInput { jump: u8::from(tick % 50 < 25), turn: 0.3, ..FORWARD };
            deck.sim.step(&[input], 1).unwrap();
            ground.sim.step(&[input], 1).unwrap();
            let (a, b) = (deck.position(0), ground.position(0));
            let apart = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            assert!(apart <= slack, "{tier}, tick {tick}: {a:?} {b:?}");
            assert!(a[2] > 19.999, "{tier}: in the deck at {a:?}");
            contacts += deck.get(0, "touched")[0] as u32;
        }
        assert!(contacts > 10, "{tier}");
    }
}

#[test]
fn low_ledges_are_stepped_on_and_high_ones_are_not() {
    for tier in TIERS {
        for (height, climbs) in [(0.1, true), (0.4, true), (0.65, true), (0.75, false), (1.5, false)] {
            let block = cuboid([6.0, 40.0, height], [10.0, 0.0, 0.5 * height]);
            let mut one = alone(&flat(), &[block], tier);
            one.put(0, [0.0, 0.0, 0.1], [0.0; 3]);
            one.set(0, &[("yaw", &[-core::f64::consts::FRAC_PI_2])]);
            let mut highest = 0.0f64;
            for _ in 0..100 {
                one.sim.step(&[FORWARD], 1).unwrap();
                highest = highest.max(one.position(0)[2]);
            }
            let x = one.position(0)[0];
            if climbs {
                assert!(x > 13.5, "{tier}: walked over {height} m, but is at {x}");
                assert!(highest > height && highest < height + 0.5, "{tier}: {highest} over {height}");
            } else {
                assert!((6.0..6.5).contains(&x), "{tier}: stopped by {height} m, but is at {x}");
            }
        }
    }
}

#[test]
fn a_ramp_is_skied_like_a_slope() {
    // 20 degrees down towards +x, 600 m long; the law of section 10 gives 58.3 m/s after 10 s.
    let (sin, cos) = (20f64.to_radians().sin(), 20f64.to_radians().cos());
    let length = 700.0;
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let (low, high) = (0.0, length * sin);
    let points = [-50.0, 50.0]
        .iter()
        .flat_map(|&y| {
            [
                corner(0.0, y, high),
                corner(length * cos, y, low),
                corner(length * cos, y, -1.0),
                corner(0.0, y, -1.0),
            ]
        })
        .collect();
    let ramp = Solid::hull("ramp", points, Placement::default());
    for (tier, expected) in
        [("reference", 58.3), ("authentic", 58.3), ("swept", 58.3), ("fast", 58.3), ("engine", 58.3)]
    {
        let mut one = alone(&flat(), core::slice::from_ref(&ramp), tier);
        one.put(0, [10.0, 0.0, high + 1.0], [0.0; 3]);
        one.set(0, &[("yaw", &[-core::f64::consts::FRAC_PI_2])]);
        (0..312).for_each(|_| one.sim.step(&[SKI], 1).unwrap());
        let v = one.velocity(0);
        let speed = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((speed - expected).abs() < 0.06 * expected, "{tier}: {speed} m/s instead of {expected}");
        assert!(one.position(0)[2] > 10.0, "{tier}: still on the ramp, {:?}", one.position(0));
    }
}

#[test]
fn a_disc_bursts_on_a_wall_and_the_wall_shades_from_it() {
    let wall = cuboid([40.0, 0.2, 20.0], [0.0, 10.0, 10.0]);
    for tier in TIERS {
        // Player 0 shoots north at the wall; player 1 stands behind it, player 2 before it.
        let mut three = crew(&flat(), core::slice::from_ref(&wall), tier, 3, 3);
        three.put(0, [0.0, 0.0, 0.0], [0.0; 3]);
        three.put(1, [0.2, 11.0, 0.0], [0.0; 3]);
        three.put(2, [4.0, 8.0, 0.0], [0.0; 3]);
        let fire = RawInput { fire: 1, ..IDLE };
        let mut found = None;
        for tick in 0..10 {
            three.sim.step(&[if tick == 0 { fire } else { IDLE }, IDLE, IDLE], 1).unwrap();
            found = found.or(three.sim.blasts().first().copied());
            if found.is_some() {
                break;
            }
        }
        let blast = found.unwrap_or_else(|| panic!("{tier}: no blast"));
        let [x, y, z] = blast.position;
        assert!(
            (x - 0.2).abs() < 1e-4 && (y - 9.9).abs() < 1e-4 && (z - 1.5).abs() < 1e-3,
            "{tier}: {blast:?}"
        );
        assert_eq!(blast.axis, [0.0, -1.0, 0.0], "{tier}");
        assert_eq!(three.get(1, "damage"), [0.0], "{tier}: behind the wall");
        assert!(three.velocity(1)[1].abs() < 0.01, "{tier}: {:?}", three.velocity(1));
        assert!(three.velocity(2)[0] > 3.0, "{tier}: before the wall, {:?}", three.velocity(2));
        assert!(three.get(2, "damage")[0] > 0.1, "{tier}");
    }
}

#[test]
fn a_low_wall_covers_half_of_a_player() {
    // The blast lies on the ground behind a wall of 1 m: what is below the line over its edge is shaded.
    let wall = cuboid([40.0, 0.2, 1.0], [0.0, 2.0, 0.5]);
    let speed = |solids: &[Solid]| {
        let mut one = alone(&flat(), solids, "reference");
        one.put(0, [0.0, 1.0, 0.0], [0.0; 3]);
        one.sim.explode(&[[0.0, 4.0, 0.01]], "disc").unwrap();
        (one.velocity(0).iter().map(|x| x * x).sum::<f64>().sqrt(), one.get(0, "damage")[0])
    };
    let far = cuboid([1.0; 3], [500.0, 0.0, 0.0]);
    let (free, hurt) = speed(&[far]);
    let rays: Vec<f64> = [0.575, 1.725, 1.4375, 1.4375].to_vec();
    // From (0, 4, 0.01) to (+-0.25, 1, h): the edge that the line must clear is at y = 2.1.
    let seen = rays.iter().filter(|&&h| 0.01 + (h - 0.01) * (4.0 - 2.1) / 3.0 > 1.0).count();
    assert!(free > 5.0 && hurt > 0.2);
    let (shaded, less) = speed(&[wall]);
    let share = seen as f64 / 4.0;
    assert!(share > 0.0 && share < 1.0, "{share}");
    assert!(
        (shaded - share * free).abs() < 1e-9 && (less - share * hurt).abs() < 1e-12,
        "{shaded} of {free}"
    );
}

#[test]
fn a_player_inside_a_solid_can_leave_and_never_hangs() {
    let block = cuboid([8.0, 8.0, 8.0], [0.0, 0.0, 4.0]);
    for tier in TIERS {
        for start in [[0.0, 0.0, 1.0], [3.8, 0.0, 2.0], [0.0, 3.9, 7.9], [0.0, 0.0, 7.95]] {
            let mut one = alone(&flat(), core::slice::from_ref(&block), tier);
            one.put(0, start, [0.0; 3]);
            one.set(0, &[("yaw", &[-core::f64::consts::FRAC_PI_2])]);
            for tick in 0..400 {
                let jet = RawInput { jet: u8::from(tick % 60 < 40), jump: 1, ..FORWARD };
                one.sim.step(&[jet], 1).unwrap();
                assert!(
                    one.position(0).iter().chain(&one.velocity(0)).all(|x| x.is_finite()),
                    "{tier} {start:?}"
                );
            }
            assert!(one.position(0)[0] > 4.5, "{tier} from {start:?}: still at {:?}", one.position(0));
        }
    }
}

#[test]
fn armors_stand_off_a_wall_by_half_their_width() {
    let wall = cuboid([1.0, 40.0, 40.0], [10.5, 0.0, 0.0]);
    for (armor, half) in [("light", 0.5), ("medium", 0.7), ("heavy", 0.8)] {
        let built = Arc::new(Solids::new(core::slice::from_ref(&wall), flat().grid()).unwrap());
        let map = flat();
        let mut s = setup(&map, "reference");
        (s.scene, s.armor, s.solids) = ("mission", armor, Some(&built));
        let mut one = Crew::new(&s);
        one.put(0, [5.0, 0.0, 0.01], [0.0; 3]);
        one.set(0, &[("yaw", &[-core::f64::consts::FRAC_PI_2])]);
        (0..150).for_each(|_| one.sim.step(&[FORWARD], 1).unwrap());
        let x = one.position(0)[0];
        assert!(x <= 10.0 - half && x > 10.0 - half - 0.4, "{armor}: {x}");
    }
}

#[test]
fn solids_too_far_for_single_precision_are_refused_there() {
    // They let players through: 8 of 45 rooms at 8 km from the centre did within seconds.
    let far = cuboid([10.0; 3], [3000.0, 0.0, 5.0]);
    let map = flat();
    let built = Arc::new(Solids::new(&[far], map.grid()).unwrap());
    for tier in TIERS {
        let mut s = setup(&map, tier);
        (s.scene, s.solids) = ("mission", Some(&built));
        let made = s.build();
        if tier == "reference" {
            assert!(made.is_ok());
        } else {
            let error = made.err().expect(tier).to_string();
            assert!(error.contains("terrain.solids") && error.contains("3005.0 m"), "{tier}: {error}");
        }
        s.scene = "ski";
        assert!(s.build().is_ok(), "a scene without solids does not look at them");
    }
}
