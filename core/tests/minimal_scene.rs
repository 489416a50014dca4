//! A scene that models nothing optional: what it leaves out takes no memory, and the same kernel plays it.
#![allow(missing_docs)]

mod common;

use common::lab::*;
use common::*;
use discjump_core::armor::LIGHT;
use discjump_core::input::Input;
use discjump_core::movement::{Engine, Movement, Sliced};
use discjump_core::player::{Contact, Player, fields};
use discjump_core::random::{Purpose, bits};
use discjump_core::real::{Real, Scalar};
use discjump_core::rules::{Model, Physics, Rules};
use discjump_core::scene::{Absent, Has, Sandbox, Scene, Ski};

/// Walking and falling.
#[derive(Clone, Copy, Debug)]
struct Walk;

impl Scene for Walk {
    const NAME: &'static str = "walk";
    const JUMP: bool = false;
    const BLAST: bool = false;
    const SOLIDS: bool = false;
    type BumpLimits<R: Real> = Absent;
    type Arms<R: Real> = Absent;
    type Contact<R: Real> = Absent;
    type Jet<R: Real> = Absent;
    type Energy<R: Real> = Absent;
    type Damage<R: Real> = Absent;
}

/// Bytes of a struct whose fields take `bytes`, padded to its alignment.
fn padded(bytes: usize, align: usize) -> usize {
    bytes.div_ceil(align) * align
}

#[test]
fn absent_fields_take_no_bytes() {
    assert_eq!(size_of::<Absent>(), 0);
    // Position, velocity, yaw, pitch, friction; tile and map; touched, crawled.
    let (reals, ints, flags) = (9, 3, 2);
    assert_eq!(size_of::<Player<Walk, f32>>(), padded(reals * 4 + ints * 4 + flags, 4));
    assert_eq!(size_of::<Player<Walk, f64>>(), padded(reals * 8 + ints * 4 + flags, 8));
    // A ski player also has a contact (normal, age), a flame, energy and damage.
    let (reals, ints, flags) = (reals + 5, ints + 1, flags + 1);
    assert_eq!(size_of::<Player<Ski, f32>>(), padded(reals * 4 + ints * 4 + flags, 4));
    assert_eq!(size_of::<Player<Ski, f64>>(), padded(40 + 16 + (reals - 6) * 8 + 3 * 4 + flags, 8));
    assert_eq!(size_of::<Contact<f32>>(), 16);
    assert_eq!(size_of::<Player<Ski, f32>>() - size_of::<Player<Walk, f32>>(), 16 + 4 + 4);
}

#[test]
fn absent_fields_are_not_written_either() {
    let names = |fields: Vec<discjump_core::player::Field>| fields.iter().map(|f| f.name).collect::<Vec<_>>();
    let walk = names(fields::<Walk, f32>(false));
    assert_eq!(walk, ["velocity", "yaw", "pitch", "touched", "crawled", "friction"]);
    let missing: Vec<_> =
        names(fields::<Ski, f32>(false)).into_iter().filter(|name| !walk.contains(name)).collect();
    assert_eq!(missing, ["energy", "damage", "jetting", "jump_normal", "jump_age"]);
    assert_eq!(Walk::models(), Vec::<&str>::new());
    assert_eq!(Ski::models(), ["jump", "jet", "energy", "landing_damage"]);
}

fn same_place<T: Scalar>(a: &Player<Walk, T>, b: &Player<Sandbox, T>) -> bool {
    floats(a.position) == floats(b.position) && floats(a.velocity) == floats(b.velocity)
}

/// He falls, lands and walks as a player of the fullest scene does who leaves those keys alone, bit for
/// bit; and the keys that the scene does not model do nothing.
fn check<T: Scalar>() {
    let lab = Lab::<T>::new(&rolling());
    let mut walk: Player<Walk, T> = lab.player([10.0, 20.0, 60.0], [5.0, 1.0, 0.0]);
    let mut full: Player<Sandbox, T> = lab.player([10.0, 20.0, 60.0], [5.0, 1.0, 0.0]);
    let mut held = walk;
    let mut landed = 0;
    for tick in 0..400 {
        let (forward, turn) = ([1, 1, 0, -1][tick / 50 % 4], (tick / 30 % 5) as i8 - 2);
        walk = lab.tick(&walk, &input(forward, 1, false, false, turn));
        held = lab.tick(&held, &input(forward, 1, true, true, turn));
        full = lab.tick(&full, &input(forward, 1, false, false, turn));
        assert!(same_place(&walk, &full), "tick {tick}");
        assert_eq!(format!("{walk:?}"), format!("{held:?}"), "tick {tick}");
        landed += usize::from(walk.touched);
    }
    assert!(landed > 100 && lab.clearance(&walk) >= -1e-3 && lab.clearance(&walk) < 1.0);
}

#[test]
fn the_kernel_plays_what_is_left() {
    check::<f32>();
    check::<f64>();
}

/// Everything that moves a player over bare terrain but what a constant or a group leaves out.
macro_rules! without {
    ($scene:ident: $jump:literal, $jet:ty, $energy:ty) => {
        #[derive(Clone, Copy, Debug)]
        struct $scene;

        impl Scene for $scene {
            const NAME: &'static str = "one's own";
            const JUMP: bool = $jump;
            const BLAST: bool = false;
            const SOLIDS: bool = false;
            type BumpLimits<R: Real> = Absent;
            type Arms<R: Real> = Absent;
            type Contact<R: Real> = Has<Contact<R>>;
            type Jet<R: Real> = $jet;
            type Energy<R: Real> = $energy;
            type Damage<R: Real> = Absent;
        }
    };
}

without!(NoJump: false, Has<R::Mask>, Has<R>);
without!(NoJet: true, Absent, Has<R>);
without!(NoEnergy: true, Has<R::Mask>, Absent);

/// `S` with all keys at random moves as the fullest scene does whose player is changed by `change` before each
/// tick, and whose keys are.
fn moves_as<S: Scene, M: Movement>(
    model: Model,
    change: impl Fn(&mut Player<Sandbox, f32>, &mut Input<f32>),
) {
    let lab = Lab::<f32>::of(model, &rolling(), Physics::default());
    let mut own: Player<S, f32> = lab.player([10.0, 20.0, 60.0], [5.0, 1.0, 0.0]);
    let mut full: Player<Sandbox, f32> = lab.player([10.0, 20.0, 60.0], [5.0, 1.0, 0.0]);
    for tick in 0..600u64 {
        let draw = bits(9, tick / 7, Purpose::Start, 0);
        let mut keys = input(
            (draw % 3) as i8 - 1,
            1,
            (draw / 3).is_multiple_of(2),
            !(draw / 6).is_multiple_of(3),
            (draw / 18 % 5) as i8 - 2,
        );
        own = lab.tick_as::<M, S>(&own, &keys);
        change(&mut full, &mut keys);
        full = lab.tick_as::<M, Sandbox>(&full, &keys);
        assert_eq!(
            floats(own.position),
            floats(full.position),
            "{}, tick {tick}",
            std::any::type_name::<S>()
        );
        assert_eq!(
            floats(own.velocity),
            floats(full.velocity),
            "{}, tick {tick}",
            std::any::type_name::<S>()
        );
    }
}

/// What stands in for a scene without a feature where there is none: a key that is not pressed, a full tank.
#[test]
fn a_feature_can_be_left_out_by_the_keys_or_the_state() {
    fn check<M: Movement>(model: Model) {
        moves_as::<NoJump, M>(model, |_, keys| keys.jump = false);
        moves_as::<NoJet, M>(model, |_, keys| keys.jet = false);
        let tank = Rules::<f32>::new(model, &LIGHT, false, 32, Physics::default()).max_energy;
        moves_as::<NoEnergy, M>(model, |player, _| player.energy = Has(tank));
    }
    check::<Sliced>(Model::Article);
    check::<Engine>(Model::Engine);
}
