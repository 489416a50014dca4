//! The world has no favourite place and no favourite direction: runs moved by whole tiles, mirrored, and
//! turned by 90 degrees.
#![allow(missing_docs)]

mod common;

use common::draws::*;
use common::lab::*;
use common::*;
use discjump_core::movement::{Anyway, Engine, Fast, Movement, Sliced, Swept};
use discjump_core::real::Scalar;
use discjump_core::rules::Physics;
use discjump_core::terrain::{Edge, Heightfield};
use proptest::prelude::*;

/// The same run with its start in another tile: the same bits, place for place.
fn check_translated<M: Movement, T: Scalar>(
    (place, velocity, yaw): Start,
    tiles: [i32; 2],
    keys: &[Keys],
) -> Result<(), TestCaseError> {
    let lab = Lab::<T>::of(M::MODEL, &rough(5), Physics::default());
    // Places that a far world position can hold.
    let place = place.map(|x| (x * 1024.0).round() / 1024.0);
    let run = |shift: [i32; 2]| {
        let offset = shift.map(|t| f64::from(t) * 128.0);
        let world = glam::DVec3::new(place[0] + offset[0], place[1] + offset[1], place[2] + 20.0);
        let (local, tile) = lab.maps.to_local(world).unwrap();
        let mut p: Body<T> = lab.player(local.to_array(), velocity);
        (p.tile_x, p.tile_y, p.yaw) = (tile.x, tile.y, T::from_f64(yaw));
        for &(forward, strafe, jump, jet, turn) in keys {
            (0..10).for_each(|_| p = lab.tick_as::<M, _>(&p, &input(forward, strafe, jump, jet, turn)));
        }
        p
    };
    let (here, mut there) = (run([0, 0]), run(tiles));
    there.tile_x -= tiles[0];
    there.tile_y -= tiles[1];
    // Debug output tells every two floats apart.
    prop_assert_eq!(format!("{here:?}"), format!("{there:?}"));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 50, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whole_tiles_change_no_bit(
        start in start(),
        tiles in [-1_000_000..1_000_000i32, -1_000_000..1_000_000i32],
        keys in keys(),
    ) {
        check_translated::<Sliced, f32>(start, tiles, &keys)?;
        check_translated::<Sliced, f64>(start, tiles, &keys)?;
        check_translated::<Swept, f32>(start, tiles, &keys)?;
        check_translated::<Fast, f32>(start, tiles, &keys)?;
        check_translated::<Engine, f32>(start, tiles, &keys)?;
        check_translated::<Anyway, f32>(start, tiles, &keys)?;
    }
}

/// A world and its image: mirrored east to west, or turned by 90 degrees to the left.
#[derive(Clone, Copy)]
enum Image {
    Mirror,
    Turn,
}

impl Image {
    fn terrain(self, field: &Heightfield) -> Heightfield {
        let n = field.cols();
        let at = |i: usize, j: usize| field.heights()[j * n + i];
        let heights = (0..n * n)
            .map(|k| match self {
                Self::Mirror => at(n - 1 - k % n, k / n),
                // (x, y) goes to (-y, x), so the image at (i, j) is what was at (j, -i).
                Self::Turn => at(k / n, n - 1 - k % n),
            })
            .collect();
        Heightfield::new(heights, n, n, 8.0, field.origin(), field.edge()).unwrap()
    }

    fn vector(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Mirror => [-x, y, z],
            Self::Turn => [-y, x, z],
        }
    }

    /// Yaw, turn rate and strafe key.
    fn keys(self, yaw: f64, turn: i8, strafe: i8) -> (f64, i8, i8) {
        match self {
            Self::Mirror => (-yaw, -turn, -strafe),
            Self::Turn => (yaw + core::f64::consts::FRAC_PI_2, turn, strafe),
        }
    }
}

/// How far a run of 5 s and the image of the same run in the image of the world part, in metres.
fn parted<M: Movement, T: Scalar>(image: Image, start: Start, keys: &[Keys]) -> f64 {
    let (mut place, velocity, yaw) = start;
    let field = centred();
    let lab = Lab::<T>::of(M::MODEL, &field, Physics::default());
    let other = Lab::<T>::of(M::MODEL, &image.terrain(&field), Physics::default());
    place[2] += lab.ground(place[0], place[1]);
    let mut p: Body<T> = lab.player(place, velocity);
    let mut q: Body<T> = other.player(image.vector(place), image.vector(velocity));
    p.yaw = T::from_f64(yaw);
    q.yaw = T::from_f64(image.keys(yaw, 0, 0).0);
    let mut worst = 0.0f64;
    for &(forward, strafe, jump, jet, turn) in keys.iter().take(16) {
        let (_, turn_there, strafe_there) = image.keys(0.0, turn, strafe);
        for _ in 0..10 {
            p = lab.tick_as::<M, _>(&p, &input(forward, strafe, jump, jet, turn));
            q = other.tick_as::<M, _>(&q, &input(forward, strafe_there, jump, jet, turn_there));
            let (a, b) = (image.vector(floats(p.position)), floats(q.position));
            let apart = |k: usize| {
                let d = (a[k] - b[k]).abs();
                // The same place may be counted in the next tile.
                if k < 2 { d.min((d - 512.0).abs()) } else { d }
            };
            worst = (0..3).fold(worst, |w, k| w.max(apart(k)));
        }
    }
    worst
}

/// Rolling terrain about the origin, 64 squares a side: even, so that its image is cut the same way.
fn centred() -> Heightfield {
    let field = rolling();
    Heightfield::new(field.heights().to_vec(), 65, 65, 8.0, [-256.0, -256.0], Edge::Tile).unwrap()
}

proptest! {
    // One seed: how far rounding lets two runs part has a tail, and the bounds are for these runs.
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    /// East and west are the same to the last bit: nothing is added in another order.
    #[test]
    fn a_mirrored_world_plays_the_mirrored_run(start in start(), keys in keys()) {
        prop_assert_eq!(parted::<Sliced, f32>(Image::Mirror, start, &keys), 0.0);
        prop_assert_eq!(parted::<Sliced, f64>(Image::Mirror, start, &keys), 0.0);
    }

    /// The other tiers to rounding: a place a hair west of the middle is rounded when it is counted from
    /// its square's western corner, and one a hair east of it is not, and they hit what that moves.
    #[test]
    fn the_other_tiers_mirror_to_rounding(start in start(), keys in keys()) {
        let single = [
            parted::<Swept, f32>(Image::Mirror, start, &keys),
            parted::<Fast, f32>(Image::Mirror, start, &keys),
            parted::<Engine, f32>(Image::Mirror, start, &keys),
            parted::<Anyway, f32>(Image::Mirror, start, &keys),
        ];
        prop_assert!(single.iter().all(|d| *d < 5e-3), "{single:?}");
        let double = [
            parted::<Swept, f64>(Image::Mirror, start, &keys),
            parted::<Fast, f64>(Image::Mirror, start, &keys),
            parted::<Engine, f64>(Image::Mirror, start, &keys),
            parted::<Anyway, f64>(Image::Mirror, start, &keys),
        ];
        prop_assert!(double.iter().all(|d| *d < 1e-11), "{double:?}");
    }

    /// A turned one only to rounding: sums over x and y come in another order.
    #[test]
    fn a_turned_world_plays_the_turned_run(start in start(), keys in keys()) {
        let single = parted::<Sliced, f32>(Image::Turn, start, &keys);
        prop_assert!(single < 5e-3, "{single:e} m");
        let double = [
            parted::<Sliced, f64>(Image::Turn, start, &keys),
            parted::<Swept, f64>(Image::Turn, start, &keys),
            parted::<Fast, f64>(Image::Turn, start, &keys),
            parted::<Engine, f64>(Image::Turn, start, &keys),
            parted::<Anyway, f64>(Image::Turn, start, &keys),
        ];
        prop_assert!(double.iter().all(|d| *d < 1e-11), "{double:?} m");
    }
}
