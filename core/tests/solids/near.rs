//! The broad phase never overlooks anything, and rejects nearly everyone who is far.

use crate::common::random::Random;
use crate::common::solids::built;
use discjump_core::solids::{Solid, Solids};
use glam::DVec3;

fn scattered(count: usize, random: &mut Random) -> Solids {
    let mut block = |_| {
        let size = (0..3).map(|_| 10f64.powf(random.within(-1.0, 2.0))).collect::<Vec<_>>();
        let centre = DVec3::new(1000.0 * random.wide(), 1000.0 * random.wide(), 100.0 * random.wide());
        Solid::cuboid("block", DVec3::from_slice(&size), centre, random.within(0.0, 6.0))
    };
    built(&(0..count).map(&mut block).collect::<Vec<_>>())
}

#[test]
fn whatever_a_sweep_meets_is_near() {
    let mut random = Random::new(40);
    let (mut met, mut far, mut asked) = (0, 0, 0);
    for count in [1, 3, 30, 300] {
        let solids = scattered(count, &mut random);
        let corners: Vec<DVec3> = solids.faces().flat_map(|(_, corners)| corners).collect();
        for k in 0..20_000 {
            let mut feet = DVec3::new(1200.0 * random.wide(), 1200.0 * random.wide(), 150.0 * random.wide());
            if k % 2 == 0 {
                let on = corners[random.index(corners.len())];
                feet = on
                    + 10f64.powf(random.within(-1.0, 1.5))
                        * DVec3::new(random.wide(), random.wide(), random.wide());
            }
            let path = DVec3::new(random.wide(), random.wide(), random.wide())
                * 10f64.powf(random.within(-2.0, 2.5));
            let reach = path.abs().max_element() + 2.6;
            let near = solids.near(feet.x, feet.y, feet.z, reach);
            if solids.sweep_box(feet, path, 0.8, 2.6).is_some() || overlaps(&solids, feet) {
                met += 1;
                assert!(near, "{feet:?} {path:?}");
            }
            if k % 2 == 1 && reach < 16.0 {
                asked += 1;
                far += usize::from(!near);
            }
        }
    }
    println!("{met} met, {far} of {asked} far");
    assert!(met > 2000 && 2 * far > asked, "{met} met, {far} of {asked} far");
}

/// Whether the box cuts a face: one that lies wholly within a solid may be far from all of them.
fn overlaps(solids: &Solids, feet: DVec3) -> bool {
    [DVec3::X, DVec3::Y, DVec3::Z].iter().any(|&axis| {
        [1e-9, -1e-9].iter().any(|side| solids.sweep_box(feet, axis * *side, 0.8, 2.6).is_some())
    })
}

/// Worlds are shared by threads.
#[test]
fn solids_are_shared() {
    fn shared<T: Send + Sync>() {}
    shared::<Solids>();
}

#[test]
fn nothing_is_near_where_nothing_stands() {
    let solids = Solids::default();
    assert!(!solids.near(0.0, 0.0, 0.0, 1.0) && !solids.near(0.0, 0.0, 0.0, 1e9));
    assert_eq!(solids.sweep_box(DVec3::ZERO, DVec3::X, 0.5, 2.3), None);
    assert_eq!(solids.ray(DVec3::ZERO, DVec3::X), None);
    assert_eq!((solids.count(), solids.overlap(DVec3::ZERO, 0.5, 2.3)), (0, None));
    let one = scattered(1, &mut Random::new(41));
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        assert!(!one.near(bad, 0.0, 0.0, 1.0) && !one.near(0.0, 0.0, bad, 1.0));
    }
}

/// A player above a bridge deck or below it is told from one beside it: heights count.
#[test]
fn heights_count() {
    let solids =
        built(&[Solid::cuboid("deck", DVec3::new(128.0, 16.0, 1.0), DVec3::new(0.0, 0.0, 40.0), 0.7)]);
    assert!(solids.near(0.0, 0.0, 41.0, 4.0));
    assert!(!solids.near(0.0, 0.0, 46.0, 4.0));
    assert!(!solids.near(0.0, 0.0, 30.0, 4.0));
    // Within the bounds of the deck seen from above, but far from the deck itself.
    assert!(!solids.near(45.0, -35.0, 40.0, 4.0));
}
