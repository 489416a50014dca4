//! Players on bilinear ground.

use crate::common::draws::rough;
use crate::common::lab::*;
use crate::common::{rolling, setup};
use discjump_core::movement::{Engine, Fast, Movement, Sliced, Swept};
use discjump_core::real::{Mask, Scalar};
use discjump_core::rules::Physics;
use discjump_core::terrain::{Heightfield, SurfaceKind};

/// What 20 players on random headings do in 20 s.
#[derive(Debug, Default)]
struct Played {
    /// Horizontal way, m.
    way: f64,
    /// Ticks in which somebody at more than 2 m/s made less than a fifth of his way.
    stuck: usize,
    deepest: f64,
    ends: Vec<[f64; 2]>,
}

fn play<M: Movement, T: Scalar>(field: &Heightfield, kind: SurfaceKind, skis: bool) -> Played {
    let lab = Lab::<T>::of(M::MODEL, &field.clone().with_surface(kind), Physics::default());
    let mut played = Played::default();
    for k in 0..20 {
        let (x, y) = (10.0 * f64::from(k) - 100.0, 7.0 * f64::from(k) - 60.0);
        let mut p: Body<T> = lab.player([x, y, lab.ground(x, y)], [0.0; 3]);
        p.yaw = T::from_f64(0.3 * f64::from(k));
        for tick in 0..625 {
            let turn = if tick % 200 < 100 { 3 } else { -3 };
            let q = lab.tick_as::<M, _>(&p, &input(1, 0, skis, false, turn));
            let (a, b, v) = (floats(p.position), floats(q.position), floats(q.velocity));
            let (step, speed) = ((b[0] - a[0]).hypot(b[1] - a[1]), v[0].hypot(v[1]));
            // A wrap around the tile is no step.
            if step < 20.0 {
                played.way += step;
                played.stuck += usize::from(step < 0.2 * 0.032 * speed && speed > 2.0);
            }
            played.deepest = played.deepest.min(lab.clearance(&q));
            p = q;
            if tick == 155 {
                played.ends.push([b[0] + f64::from(q.tile_x) * 512.0, b[1] + f64::from(q.tile_y) * 512.0]);
            }
        }
    }
    played
}

/// On gentle ground the surfaces differ by centimetres: players go the same way on both, and nobody is
/// stopped by hollow ground. The skiers' hops fall elsewhere in time.
#[test]
fn players_come_to_comparable_places() {
    fn check<M: Movement, T: Scalar>(name: &str) {
        for skis in [false, true] {
            let cut = play::<M, T>(&rolling(), SurfaceKind::Triangles, skis);
            let smooth = play::<M, T>(&rolling(), SurfaceKind::Bilinear, skis);
            let mut apart: Vec<f64> =
                (cut.ends.iter().zip(&smooth.ends)).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).collect();
            apart.sort_by(f64::total_cmp);
            println!("{name}, skis {skis}: {:.0} and {:.0} m, {:.2} m apart", cut.way, smooth.way, apart[10]);
            assert!((cut.way / smooth.way - 1.0).abs() < 0.03, "{name}: {cut:?} {smooth:?}");
            assert!(apart[10] < 3.0, "{name}: {apart:?}");
            assert!(apart[10] > 0.0, "{name}: the surfaces are one");
            assert_eq!(smooth.stuck, 0, "{name}");
            assert!(smooth.deepest > -0.01, "{name}: {smooth:?}");
        }
    }
    check::<Sliced, f32>("authentic");
    check::<Sliced, f64>("reference");
    check::<Swept, f32>("swept");
    check::<Fast, f32>("fast");
    check::<Engine, f32>("engine");
}

/// Where it is steep and hollow a walker has contacts without end; no more of them may stop him than on
/// triangles.
#[test]
fn hollow_ground_stops_nobody() {
    let field = rough(5);
    let cut = play::<Sliced, f64>(&field, SurfaceKind::Triangles, false);
    for smooth in [
        play::<Sliced, f64>(&field, SurfaceKind::Bilinear, false),
        play::<Sliced, f32>(&field, SurfaceKind::Bilinear, false),
        play::<Fast, f32>(&field, SurfaceKind::Bilinear, false),
        play::<Swept, f64>(&field, SurfaceKind::Bilinear, false),
    ] {
        println!("stuck {} ticks of 12,500, on triangles {}", smooth.stuck, cut.stuck);
        assert!(smooth.stuck < 60 && smooth.stuck <= cut.stuck, "{smooth:?}");
        assert!(smooth.way > cut.way);
    }
}

/// Whoever stands stays, to the bit; the ground under his feet is what a query says.
#[test]
fn standing_still_is_standing_still() {
    for k in 0..50 {
        let lab = Lab::<f32>::new(&rough(k).with_surface(SurfaceKind::Bilinear));
        let (x, y) = (f64::from(k as u32) * 2.3 - 60.0, f64::from(k as u32) * 1.7 - 40.0);
        let mut p: Body<f32> = lab.player([x, y, lab.ground(x, y)], [0.0; 3]);
        for _ in 0..100 {
            p = lab.tick(&p, &input(0, 0, false, false, 0));
        }
        assert!((p.position.x.to_f64() - x).hypot(p.position.y.to_f64() - y) < 1e-3, "{k}: {p:?}");
        assert!(lab.clearance(&p).abs() < 1e-3);
        assert!(p.touched.any());
    }
}

/// Two surfaces are two worlds: their digests differ, and neither takes the other's snapshots.
#[test]
fn snapshots_belong_to_a_surface() {
    let field = rolling();
    let smooth = field.clone().with_surface(SurfaceKind::Bilinear);
    assert_ne!(field.digest(), smooth.digest());
    assert_eq!(smooth.clone().with_surface(SurfaceKind::Triangles).digest(), field.digest());
    let [cut, mut other] = [&field, &smooth].map(|map| setup(map, "authentic").build().unwrap());
    let before = other.snapshot();
    let refused = other.restore(&cut.snapshot()).unwrap_err();
    assert!(refused.0.starts_with("snapshot: "), "{refused}");
    assert!(other.snapshot() == before);
    other.restore(&before).unwrap();
}
