//! A minute of skiing over generated terrain, and its account.

use discjump_core::armor::{JUMP_GRACE_MS, LIGHT};
use discjump_core::arms::{Arsenal, DISC};
use discjump_core::blast::{Explosive, power, strike};
use discjump_core::input::Input;
use discjump_core::movement::{Movement, Sliced, Swept};
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::{Model, Physics, Rules};
use discjump_core::scene::Has;
use discjump_core::terrain::raindance::{Options, generate};
use discjump_core::terrain::{Edge, Heightfield, Maps};
use discjump_core::tick::{go, look, push};

use crate::account::{Account, Body, Form, TERMS, energy};
use crate::witness::Witness;

/// Ticks of a run: 60 s.
pub const TICKS: u32 = 1875;
/// Runs of each kind, from places all over the terrain.
pub const STARTS: u32 = 16;

/// What is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Play {
    /// Forward and jump held, in curves.
    Ski,
    /// The same, with jets in bursts: 28 ticks of 70.
    Jets,
    /// As `Ski`, with a disc at the ground below the feet 4 ticks after a jump, every 8 s or so.
    Discs,
    /// Neither keys nor jumps, from 30 m/s: the run that ends at the stop rule.
    Coast,
}

impl Play {
    /// All, with what tables call them.
    pub const ALL: [(Self, &'static str); 4] = [
        (Self::Ski, "ski"),
        (Self::Jets, "ski and jets"),
        (Self::Discs, "ski and discs"),
        (Self::Coast, "coast"),
    ];

    fn keys<T: Scalar>(self, tick: u32) -> Input<T> {
        let t = T::from_f64;
        if self == Self::Coast {
            return Input::idle();
        }
        // Curves of 4.5 s each to the left and to the right.
        let turn = if (tick / 140).is_multiple_of(2) { 0.25 } else { -0.25 };
        let jet = self == Self::Jets && tick % 70 < 28;
        Input { forward: t(1.0), jump: true, jet, turn: t(turn), ..Input::idle() }
    }
}

/// What became of a run.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// Energy at the start and at the end, J/kg above the start's height.
    pub ends: [f64; 2],
    /// J/kg by term.
    pub terms: [f64; TERMS],
    /// Contacts, and ticks that ended at the bump limit.
    pub contacts: [u32; 2],
}

impl Outcome {
    /// What the account does not explain, J/kg: rounding.
    pub fn unexplained(&self) -> f64 {
        self.ends[1] - self.ends[0] - self.terms.iter().sum::<f64>()
    }
}

/// The generated terrain of seed 0.
///
/// # Panics
/// Never: the seed is one of those that are accepted.
pub fn terrain() -> Maps {
    let made = generate(0, Options::default()).expect("a terrain");
    let field =
        Heightfield::new(made.heights, 257, 257, 8.0, [-1024.0; 2], Edge::Tile).expect("a heightfield");
    Maps::new(&[field]).expect("a pool")
}

/// All starts of a play in a tier. Even runs, so that every tier starts alike.
pub fn runs<M: Movement, T: Scalar>(form: Form, maps: &Maps, play: Play) -> Vec<Outcome> {
    (0..STARTS).map(|start| run::<M, T>(form, maps, play, start)).collect()
}

/// In `reference`, `authentic` and both arithmetics of `swept`.
pub fn tiers(maps: &Maps, play: Play) -> [(&'static str, Vec<Outcome>); 4] {
    [
        ("reference", runs::<Sliced, f64>(Form::Sliced, maps, play)),
        ("swept f64", runs::<Swept, f64>(Form::Swept, maps, play)),
        ("authentic", runs::<Sliced, f32>(Form::Sliced, maps, play)),
        ("swept", runs::<Swept, f32>(Form::Swept, maps, play)),
    ]
}

fn run<M: Movement, T: Scalar>(form: Form, maps: &Maps, play: Play, start: u32) -> Outcome {
    let rules = Rules::<T>::new(Model::Article, &LIGHT, false, 32, Physics::default());
    let world = Witness::new(maps.surface::<T>());
    let disc = Arsenal::<T>::new(&DISC, 32, &rules.physics).explosive;
    let mut p = first(maps, &rules, play, start);
    let mut out = Outcome { ends: [energy(&p), 0.0], terms: [0.0; TERMS], contacts: [0; 2] };
    let mut jumped = u32::MAX;
    let mut since_blast = 0u32;
    for tick in 0..TICKS {
        let mut account = Account::new(&p, &rules, form);
        since_blast += 1;
        if play == Play::Discs && jumped == 4 && since_blast > 250 {
            since_blast = 0;
            let surface = maps.surface::<T>();
            let at = V3::new(
                p.position.x,
                p.position.y,
                surface.ground::<T>(p.map, p.position.x, p.position.y).height,
            );
            account.blast(impulse(&p, at, &disc, &rules));
            strike(&mut p, at, true, T::from_f64(1.0), &disc, &rules);
        }
        let input = play.keys(tick);
        look(&mut p, &input, &rules);
        let before = p;
        let old = push::<_, M, T>(&mut p, &input, &rules);
        account.after_forces(&before, &input, &p);
        jumped = if fresh(&before, &input) { 1 } else { jumped.saturating_add(1) };
        go::<_, M, T, _>(&mut p, old, &world, &rules);
        let sweeps = world.take();
        account.after_move(&sweeps, &p);
        let surface = maps.surface::<T>();
        (p.position.x, p.position.y, p.tile_x, p.tile_y) =
            surface.wrap::<T>(p.position.x, p.position.y, p.tile_x, p.tile_y);
        out.contacts[0] += sweeps.iter().filter(|sweep| sweep.hit.hit).count() as u32;
        for (sum, term) in out.terms.iter_mut().zip(account.terms) {
            *sum += term;
        }
    }
    let Has(limits) = p.bump_limits;
    out.contacts[1] = limits.cast_unsigned();
    out.ends[1] = energy(&p);
    out
}

/// A player on the ground, at a place and with a view that are the same in every tier.
fn first<T: Scalar>(maps: &Maps, rules: &Rules<T>, play: Play, start: u32) -> Body<T> {
    let t = T::from_f64;
    // Fractions of the golden ratio and of its like in the plane lie evenly.
    let place = |ratio: f64| (((f64::from(start) + 0.5) * ratio).fract() * 2000.0 - 1000.0).round();
    let (x, y) = (t(place(0.754_877_666_246_693)), t(place(0.569_840_290_998_053)));
    let ground = maps.surface::<f32>().ground::<f32>(0, x.to_f64() as f32, y.to_f64() as f32);
    let mut p = Body::new(rules, V3::new(x, y, t(f64::from(ground.height + 0.25))), 0);
    p.yaw = t(f64::from(start) * 0.375 - 3.0);
    if play == Play::Coast {
        p.velocity = V3::new(T::zero(), t(30.0), T::zero());
    }
    p
}

fn fresh<T: Scalar>(before: &Body<T>, input: &Input<T>) -> bool {
    let Has(contact) = before.contact;
    input.jump && contact.age < JUMP_GRACE_MS
}

/// What a blast adds to a velocity (section 6).
fn impulse<T: Scalar>(p: &Body<T>, at: V3<T>, disc: &Explosive<T>, rules: &Rules<T>) -> V3<T> {
    let away = p.position + V3::up() * (rules.height * T::from_f64(0.5)) - at;
    let d0 = away.length();
    let side = rules.half_width + rules.half_width;
    let power = power(d0, side, disc.radius, rules.physics.knockback, rules.physics.cutoff);
    away * (disc.kick / rules.mass * power / d0)
}
