//! Items 17 and 21: the lines of the grid, and what lies outside the map.

use crate::common::lab::*;
use crate::common::{TIERS, rolling, setup};
use crate::{digits, form, lab, next};
use discjump_core::batch::RawInput;
use discjump_core::input::Input;
use discjump_core::movement::Movement;
use discjump_core::real::Scalar;
use discjump_core::terrain::{Edge, Heightfield};

/// Hills about the origin, so that half of all places are negative.
fn hills(edge: Edge) -> Heightfield {
    let field = rolling();
    Heightfield::new(field.heights().to_vec(), 65, 65, 8.0, [-256.0, -256.0], edge).unwrap()
}

/// Vertices, edges, diagonals and seams, an ulp to either side of them, on both sides of 0 and on them: who
/// drops there lands there, and who runs along them stays on the ground.
#[test]
fn e17_on_the_lines_of_the_grid() {
    fn check<M: Movement, T: Scalar>() {
        let lines = [-256.0, -252.0, -64.0, -12.0, -8.0, -4.0, 0.0, 4.0, 8.0, 20.0, 248.0];
        for edge in [Edge::Tile, Edge::Clamp] {
            let lab = lab::<M, T>(&hills(edge), 32);
            for (x, y) in lines.iter().flat_map(|&x| lines.iter().map(move |&y| (x, y))) {
                for (a, b) in
                    [(x, y), (next::<T>(x, true), y), (x, next::<T>(y, false)), (next::<T>(x, false), y)]
                {
                    let z = lab.ground(a, b) + 0.1;
                    for run in [[0.0, 0.0], [20.0, 0.0], [0.0, -20.0], [15.0, 15.0], [-15.0, 15.0]] {
                        let mut p: Body<T> = lab.player([a, b, z], [run[0], run[1], -12.0]);
                        let what = format!("{}: from ({a:?}, {b:?}) along {run:?}", form::<M, T>());
                        p = lab.tick_as::<M, _>(&p, &Input::idle());
                        assert!(p.touched || run != [0.0, 0.0], "{what}");
                        for _ in 0..3 {
                            let deep = -lab.clearance(&p);
                            assert!(deep < digits::<T>(1e-9, 2e-3) + dip::<M>(), "{what}: {deep} m");
                            assert!(numbers(&p).iter().all(|x| x.is_finite()), "{what}");
                            p = lab.tick_as::<M, _>(&p, &Input::idle());
                        }
                    }
                }
            }
        }
    }
    in_forms!(check, Sliced, Swept, Fast, Engine);
}

/// What a form may dip on gentle hills: the unswept fix-up at a crease; the engine's sphere counts the plane under
/// its middle, and so cuts into the next face.
fn dip<M: Movement>() -> f64 {
    let name = core::any::type_name::<M>();
    if name.ends_with("Swept") || name.ends_with("Engine") { 0.2 } else { 0.0 }
}

/// A place just west of 0 is in the square west of it: truncation would put it in the one east of it.
#[test]
fn e17_negative_places_are_floored() {
    fn check<M: Movement, T: Scalar>() {
        // Rises to the west of 0 only.
        let heights = (0..81).map(|k| 4.0 * f64::from((4 - k % 9).max(0))).collect();
        let lab = lab::<M, T>(&Heightfield::new(heights, 9, 9, 8.0, [-32.0; 2], Edge::Clamp).unwrap(), 32);
        for x in [-1e-3, -0.5, -7.9, -8.1] {
            assert!((lab.ground(x, 0.0) + 0.5 * x).abs() < 1e-6);
            let p: Body<T> = lab.player([x, 0.0, 0.1 - 0.5 * x], [0.0, 0.0, -20.0]);
            let q = lab.tick_as::<M, _>(&p, &Input::idle());
            // Turned down the western face's slope.
            assert!(q.touched && q.velocity.x > T::lit(5.0), "{} at {x}: {:?}", form::<M, T>(), q.velocity);
        }
    }
    in_every_form!(check);
}

/// A weightless mile outside each kind of map: ground, hills or nothing, for players and for what they fire.
#[test]
fn e21_projectiles_outside_the_map() {
    for tier in TIERS {
        for (edge, bursts) in [(Edge::Tile, true), (Edge::Clamp, true), (Edge::Void, false)] {
            let map = hills(edge);
            let mut s = setup(&map, tier);
            s.scene = "disc_jump";
            let mut sim = s.build().unwrap();
            let mut state = sim.state();
            crate::common::write_fields(&*sim, &mut state, &[("position", &[5e5, -5e5, 80.0])]);
            sim.set_state(&[0], &state).unwrap();
            let down = RawInput { fire: 1, pitch: -1.5, ..crate::common::IDLE };
            let burst = (0..120).any(|_| {
                sim.step(&[down], 1).unwrap();
                assert!(sim.projectiles().iter().all(|s| s.position.iter().all(|x| x.is_finite())));
                !sim.blasts().is_empty()
            });
            assert_eq!(burst, bursts, "{tier}, {}", edge.name());
        }
    }
}
