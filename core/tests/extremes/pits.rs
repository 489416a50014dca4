//! Item 7: pits of several steep faces. Valleys are in creases.rs.

use crate::common::lab::*;
use crate::{digits, form};
use discjump_core::movement::Movement;
use discjump_core::real::Scalar;
use discjump_core::rules::Physics;
use discjump_core::scene::Has;
use discjump_core::terrain::{Edge, Heightfield};

/// One vertex so deep that the faces about it have a slope of so many degrees; `corners` are whether the
/// slanting neighbours are as low, which leaves three faces or four about the vertex to slide down.
fn pit(degrees: f64, corners: bool) -> Heightfield {
    let depth = 8.0 * degrees.to_radians().tan();
    let height = |k: usize| {
        let (i, j) = (k % 9, k / 9);
        let low = (i, j) == (4, 4) || corners && (i, j) == (5, 4);
        if low { 0.0 } else { depth }
    };
    Heightfield::new((0..81).map(height).collect(), 9, 9, 8.0, [-32.0, -32.0], Edge::Clamp).unwrap()
}

/// How deep below the ground anybody gets who falls, slides and jets about in a pit, and in the end.
fn depths<M: Movement, T: Scalar>(physics: Physics) -> (f64, f64) {
    let (mut deepest, mut last) = (0.0f64, 0.0f64);
    for (degrees, corners) in [(60.0, false), (60.0, true), (75.0, false), (75.0, true)] {
        let lab = Lab::<T>::of(M::MODEL, &pit(degrees, corners), physics);
        for k in 0..24 {
            let angle = f64::from(k) * 0.9;
            let (x, y) = (3.0 * angle.cos(), 3.0 * angle.sin());
            let speed = 4.0 * f64::from(k % 12);
            let velocity = [-speed * angle.cos(), -speed * angle.sin(), -0.5 * speed];
            let mut p: Body<T> = lab.player([x, y, lab.ground(x, y) + 0.3], velocity);
            for tick in 0..200 {
                let before = p.damage.0;
                p = lab.tick_as::<M, _>(&p, &input(1, 0, tick % 3 == 0, tick > 100, 15));
                assert!(numbers(&p).iter().all(|x| x.is_finite()), "{}: {p:?}", form::<M, T>());
                let Has(damage) = p.damage;
                assert!(damage >= before, "{}", form::<M, T>());
                deepest = deepest.max(-lab.clearance(&p));
            }
            last = last.max(-lab.clearance(&p));
        }
    }
    (deepest, last)
}

fn measured<M: Movement, T: Scalar>(ski_bug: bool, fixup_swept: bool) -> (f64, f64) {
    let depths = depths::<M, T>(Physics { ski_bug: Some(ski_bug), fixup_swept, ..Physics::default() });
    println!("{}, ski bug {ski_bug}, swept fix-up {fixup_swept}: {depths:?}", form::<M, T>());
    depths
}

#[test]
fn e07_nobody_falls_through_a_pit() {
    fn check<M: Movement, T: Scalar>() {
        for ski_bug in [false, true] {
            let (deepest, _) = measured::<M, T>(ski_bug, true);
            assert!(deepest < digits::<T>(1e-9, 1e-3), "{}: {deepest} m", form::<M, T>());
        }
    }
    in_forms!(check, Sliced, Fast);
}

/// The unswept fix-up dips below the opposite face, by less than docs/tiers.md allows, and comes up again.
#[test]
fn e07_swept_dips_in_pits_and_recovers() {
    fn check<M: Movement, T: Scalar>() {
        for ski_bug in [false, true] {
            let (deepest, last) = measured::<M, T>(ski_bug, false);
            assert!(0.05 < deepest && deepest < 2.0, "{}: {deepest} m", form::<M, T>());
            assert!(last < digits::<T>(1e-9, 1e-3), "{}: still {last} m", form::<M, T>());
            // Swept, there is no dip.
            let (deepest, _) = measured::<M, T>(ski_bug, true);
            assert!(deepest < digits::<T>(1e-9, 1e-3), "{}: {deepest} m", form::<M, T>());
        }
    }
    in_forms!(check, Swept);
}

/// The literal reading does fall through.
#[test]
fn e07_anyway_falls_through_a_pit() {
    fn check<M: Movement, T: Scalar>() {
        let (deepest, _) = measured::<M, T>(false, false);
        assert!(deepest > 3.0, "{}: {deepest} m", form::<M, T>());
    }
    in_forms!(check, Anyway);
}
