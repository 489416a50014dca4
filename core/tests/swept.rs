//! The `swept` tier is the `sliced` one in another form (docs/physics.md, sections 5.1 and 5.2): where they
//! are equal, where they part, and what its fix-up does in creases.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::*;
use core::cell::RefCell;
use discjump_core::input::Input;
use discjump_core::movement::{Movement, Obstacles, Sliced, Swept};
use discjump_core::player::Place;
use discjump_core::random::{Purpose, bits};
use discjump_core::real::V3;
use discjump_core::rules::Physics;
use discjump_core::terrain::{Heightfield, Hit, Surface};
use discjump_core::tick::tick;

/// Bare terrain that writes down the fractions of all contacts.
struct Witness<'a> {
    surface: Surface<'a, f64>,
    contacts: RefCell<Vec<f64>>,
}

impl Obstacles<f64> for Witness<'_> {
    const BODIES: bool = false;
    fn surface(&self) -> &Surface<'_, f64> {
        &self.surface
    }
    fn sweep_bodies(&self, _at: &Place<f64>, _path: V3<f64>, _active: bool) -> Hit<f64> {
        Hit::none()
    }
    fn line_bodies(&self, _at: &Place<f64>, _path: V3<f64>, _active: bool) -> Hit<f64> {
        Hit::none()
    }
    fn step_up(&self, _at: &Place<f64>, _path: V3<f64>, _hit: &Hit<f64>, _active: bool) -> f64 {
        0.0
    }
    fn sweep(&self, at: &Place<f64>, path: V3<f64>, active: bool) -> Hit<f64> {
        let hit = self.surface.sweep::<f64>(at.map, at.position, path, active);
        if hit.hit {
            self.contacts.borrow_mut().push(hit.fraction);
        }
        hit
    }
}

/// What can part the two forms in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cause {
    /// At most one contact, and time before it.
    None,
    /// A contact at once: the player started on the surface.
    AtOnce,
    /// Several contacts: what is left of the tick is cut elsewhere.
    Several,
}

/// One tick by a movement, and what its contacts were.
fn played<M: Movement>(lab: &Lab<f64>, p: &Body<f64>, input: &Input<f64>) -> (Body<f64>, Cause) {
    let world = Witness { surface: lab.maps.surface(), contacts: RefCell::default() };
    let q = tick::<_, M, f64, _>(p, input, &world, &lab.rules);
    let contacts = world.contacts.take();
    let cause = match contacts[..] {
        [] => Cause::None,
        [at] if at > 1e-9 => Cause::None,
        [_] => Cause::AtOnce,
        [_, _, ..] if contacts.contains(&0.0) => Cause::AtOnce,
        _ => Cause::Several,
    };
    (q, cause)
}

fn distance(p: &Body<f64>, q: &Body<f64>) -> f64 {
    let d = p.position - q.position;
    d.dot(d).sqrt()
}

/// Keys that are drawn anew every 10 ticks; jump is nearly always held, as skiers do.
fn drawn(run: u64, tick: u64) -> Input<f64> {
    let draw = bits(run, tick / 10, Purpose::Velocity, 0);
    let key = |at: u64, of: u64| (draw / at % of) as i8;
    input(key(1, 3).min(1), key(3, 3) - 1, key(9, 8) > 0, key(72, 3) == 0, key(216, 21) - 10)
}

/// The same keys by both forms: how far they come apart before the first tick that can part them, when
/// and what that is, and how far apart they are in the end.
fn run(
    terrain: &Heightfield,
    ticks: u64,
    start: &Body<f64>,
    keys: impl Fn(u64) -> Input<f64>,
) -> (f64, Option<(u64, Cause)>, f64) {
    let lab = Lab::<f64>::new(terrain);
    let (mut p, mut q) = (*start, *start);
    let (mut before, mut first) = (0.0f64, None);
    for t in 0..ticks {
        let (a, cause_a) = played::<Sliced>(&lab, &p, &keys(t));
        let (b, cause_b) = played::<Swept>(&lab, &q, &keys(t));
        let cause = if cause_a == Cause::None { cause_b } else { cause_a };
        (p, q) = (a, b);
        if cause != Cause::None {
            first = first.or(Some((t, cause)));
        }
        if first.is_none() {
            before = before.max(distance(&p, &q));
        }
    }
    (before, first, distance(&p, &q))
}

#[test]
fn both_forms_are_equal_on_planes() {
    for degrees in [0.0, 5.0, 10.0, 20.0, 30.0, 45.0] {
        let plane = slope(degrees);
        let lab = Lab::<f64>::new(&plane);
        for name in 0..10 {
            let height = 1000.0 * f64::to_radians(degrees).tan() + 2.0;
            let mut start: Body<f64> = lab.player([-1000.0, 0.0, height], [name as f64, 0.0, 0.0]);
            start.yaw = -core::f64::consts::FRAC_PI_2;
            let ski = |_| input(1, 0, true, false, 0);
            for (apart, first, _) in
                [run(&plane, 312, &start, |t| drawn(name, t)), run(&plane, 312, &start, ski)]
            {
                assert!(first.is_none() && apart < 1e-9, "{degrees} degrees, {name}: {apart:e} m, {first:?}");
            }
        }
    }
}

type Script = fn(u64, u64) -> Input<f64>;

/// Over 20 s on rolling terrain too, until a tick has a second contact; then the rest of the tick is cut
/// into other slices, and they land apart. The counts are printed.
#[test]
fn both_forms_are_equal_on_rolling_terrain_until_a_crease() {
    let terrain = rolling();
    let lab = Lab::<f64>::new(&terrain);
    let scripts: [(&str, Script); 3] = [
        ("ski", |_, _| input(1, 0, true, false, 0)),
        ("drawn keys", drawn),
        ("walk", |_, _| input(1, 0, false, false, 0)),
    ];
    for (what, keys) in scripts {
        let mut parted = Vec::new();
        for name in 0..60u64 {
            let mut start: Body<f64> = lab.player([0.0, 0.0, 60.0], [10.0, 5.0, 0.0]);
            start.yaw = name as f64 * 0.1 - 3.0;
            let (before, first, end) = run(&terrain, 625, &start, |t| keys(name, t));
            assert!(before < 1e-9, "{what}, {name}: {before:e} m before {first:?}");
            if let Some((_, cause)) = first {
                parted.push((end, cause));
            }
        }
        let at_once = parted.iter().filter(|(_, cause)| *cause == Cause::AtOnce).count();
        let visible = parted.iter().filter(|(end, _)| *end > 0.01).count();
        let worst = parted.iter().fold(0.0f64, |w, (end, _)| w.max(*end));
        println!(
            "{what}: {} of 60 runs met what can part them ({at_once} contacts at once, the others creases); \
             {visible} are over 1 cm apart after 20 s, the farthest {worst:.3} m",
            parted.len()
        );
        // Skiers hardly meet one; who walks does so all the time, and it costs him centimetres.
        assert!(what == "walk" || parted.len() <= 15, "{what}: {} runs", parted.len());
        assert!(what != "walk" || worst < 0.1, "{what}: {worst} m");
    }
}

/// Who starts on the ground is pushed out along the normal by a whole slice of what it took from him.
#[test]
fn a_contact_at_once_pushes_out() {
    for (clamp_fixup, expected) in [(false, 0.641 * 0.032), (true, 0.0)] {
        for fixup_swept in [false, true] {
            let physics = Physics { clamp_fixup, fixup_swept, ..Physics::default() };
            let lab = Lab::<f64>::with(&slope(0.0), physics);
            let p: Body<f64> = lab.player([0.0, 0.0, 0.0], [5.0, 0.0, 0.0]);
            let q = lab.tick_as::<Swept, _>(&p, &Input::idle());
            // The tick then goes on with the new velocity.
            near("height", q.position.z, expected + 0.001 * 0.032, 1e-12);
            near("path", q.position.x, 5.0 * 0.032, 1e-12);
        }
    }
}

/// The way out for whoever is below the ground: each contact at once gives what it took as a push.
#[test]
fn a_player_below_the_ground_is_pushed_out_again() {
    for (clamp_fixup, out) in [(false, true), (true, false)] {
        let lab = Lab::<f64>::with(&slope(20.0), Physics { clamp_fixup, ..Physics::default() });
        let mut p: Body<f64> = lab.player([0.0, 0.0, -0.9], [3.0, 0.0, -4.0]);
        let walk = input(0, 1, false, false, 0);
        (0..125).for_each(|_| p = lab.tick_as::<Swept, _>(&p, &walk));
        assert_eq!(lab.clearance(&p) > -1e-9, out, "{} m", lab.clearance(&p));
    }
}
