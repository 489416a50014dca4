//! Scenes that model all but one thing, for `.ci/features.py` to count their instructions: in a build that has
//! the thing, and in one that was compiled without it.
//!
//! `left_out CALLS`: plays every such scene, or in a build without a feature the one that leaves it out, for so
//! many calls of 4 ticks of 64 players on one thread; 8 players side by side where the environment variable
//! `LEFT_OUT_LANES` was 8 when it was compiled. Callgrind is told where the calls begin and end by
//! `getppid`, which nothing else calls. Prints a line for each scene: what it leaves out, player-ticks, bytes
//! of a player, digest at the end. At last a line for each public scene that the build leaves out: the refusal.

use discjump_core::arms::Arms;
use discjump_core::batch::{RawInput, SimulatorSetup};
use discjump_core::movement::Sliced;
use discjump_core::player::Contact;
use discjump_core::random::{Purpose, bits};
use discjump_core::real::Real;
use discjump_core::rules::Physics;
use discjump_core::scene::{Absent, Has, NAMES, Scene, scenes};
use discjump_core::terrain::{Edge, Heightfield};

const COUNT: usize = 64;
/// Only these are compiled, which takes a third of the time.
const LANES: usize = match option_env!("LEFT_OUT_LANES") {
    Some(lanes) if matches!(lanes.as_bytes(), b"8") => 8,
    _ => 1,
};
/// Ticks of a call.
const TICKS: u32 = 4;
/// Sets of keys, taken in turn.
const SETS: usize = 16;

macro_rules! group {
    (has, $fields:ty) => { Has<$fields> };
    (no, $fields:ty) => { Absent };
}

/// A scene, by what it models.
macro_rules! scene {
    ($scene:ident = $name:literal {
        $jump:literal, $jet:tt, $energy:tt, $damage:tt, $discs:tt, $blast:literal, $solids:literal, $limits:tt
    }) => {
        #[derive(Clone, Copy, Debug)]
        #[allow(dead_code, reason = "a build without a feature has one of them")]
        struct $scene;

        impl Scene for $scene {
            const NAME: &'static str = $name;
            const JUMP: bool = $jump;
            const BLAST: bool = $blast;
            const SOLIDS: bool = $solids;
            type Contact<R: Real> = Has<Contact<R>>;
            type Jet<R: Real> = group!($jet, R::Mask);
            type Energy<R: Real> = group!($energy, R);
            type Damage<R: Real> = group!($damage, R);
            type Arms<R: Real> = group!($discs, Arms<R>);
            type BumpLimits<R: Real> = group!($limits, R::Int);
        }
    };
}

// Each is named by what it leaves out; in the order jump, jet, energy, landing damage, discs, blast, solids, limits.
scene! { Jump = "jump" { false, has, has, has, has, true, true, has } }
scene! { Jet = "jet" { true, no, has, has, has, true, true, has } }
scene! { Energy = "energy" { true, has, no, has, has, true, true, has } }
scene! { LandingDamage = "landing_damage" { true, has, has, no, has, true, true, has } }
scene! { Discs = "discs" { true, has, has, has, no, true, true, has } }
scene! { Blast = "blast" { true, has, has, has, has, false, true, has } }
scene! { Solids = "solids" { true, has, has, has, has, true, false, has } }
scene! { BumpLimits = "bump_limits" { true, has, has, has, has, true, true, no } }

/// Plays the scenes without these features that compile in this build.
macro_rules! play_without {
    ($work:expr, $($feature:tt $scene:ident),+) => {
        $(
            #[cfg(any(
                not(feature = $feature),
                all(
                    feature = "jump", feature = "jet", feature = "energy", feature = "landing_damage",
                    feature = "discs", feature = "blast", feature = "solids", feature = "bump_limits"
                )
            ))]
            $work.play::<$scene>();
        )+
    };
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [calls] = &arguments[..] else { panic!("usage: left_out CALLS") };
    let work = Work { terrain: hills(), calls: calls.parse().expect("CALLS is a number") };
    play_without! {
        work, "jump" Jump, "jet" Jet, "energy" Energy, "landing_damage" LandingDamage, "discs" Discs, "blast" Blast,
        "solids" Solids, "bump_limits" BumpLimits
    }
    let listed = scenes();
    for scene in NAMES.into_iter().filter(|name| listed.iter().all(|scene| scene.name != *name)) {
        let refused = work.setup(scene).build().err().expect("a scene that is left out");
        println!("{refused}");
    }
}

/// Hills of some 25 m every 64 to 256 m.
fn hills() -> Heightfield {
    let n = 65;
    let wave = |i: usize, k: f64| (core::f64::consts::TAU * k * (i % (n - 1)) as f64 / (n - 1) as f64).sin();
    let height = |(i, j): (usize, usize)| {
        30.0 + 10.0 * wave(i, 2.0) * wave(j, 2.0) + 4.0 * wave(i + 3, 5.0) + 3.0 * wave(j, 7.0)
    };
    let heights = (0..n * n).map(|k| height((k % n, k / n))).collect();
    Heightfield::new(heights, n, n, 8.0, [0.0, 0.0], Edge::Tile).expect("valid heights")
}

/// What is played.
struct Work {
    terrain: Heightfield,
    calls: usize,
}

impl Work {
    fn setup<'a>(&'a self, scene: &'a str) -> SimulatorSetup<'a> {
        SimulatorSetup {
            terrain: &self.terrain,
            solids: None,
            players: COUNT,
            players_per_world: 1,
            scene,
            armor: "light",
            energy_pack: false,
            weapon: "disc",
            ammo: None,
            fidelity: "authentic",
            precision: None,
            physics: Physics::default(),
            tick_ms: 32,
            threads: Some(1),
            lanes: None,
        }
    }

    #[allow(dead_code, reason = "a build without a public scene may have none of these either")]
    fn play<S: Scene>(&self) {
        let mut sim = self.setup(S::NAME).build_own::<S, Sliced, LANES>().expect("a valid setup");
        let keys: Vec<RawInput> = (0..(SETS * COUNT) as u64).map(keys).collect();
        let sets: Vec<_> = keys.chunks_exact(COUNT).collect();
        let mut play = |calls| {
            for inputs in sets.iter().cycle().take(calls) {
                sim.step(inputs, TICKS).expect("valid inputs");
            }
        };
        play(1);
        mark();
        play(self.calls);
        mark();
        let ticks = self.calls * COUNT * TICKS as usize;
        println!("{} {ticks} {} {}", S::NAME, sim.player_bytes(), sim.digest());
    }
}

fn mark() {
    let _ = std::os::unix::process::parent_id();
}

fn keys(k: u64) -> RawInput {
    let draw = bits(2, k, Purpose::Velocity, 0);
    RawInput {
        forward: (draw % 3) as i8 - 1,
        strafe: (draw / 3 % 3) as i8 - 1,
        jump: u8::from(!(draw / 9).is_multiple_of(4)),
        jet: (draw / 36 % 2) as u8,
        fire: 1,
        turn: (draw / 72 % 7) as f64 - 3.0,
        pitch: -0.5,
    }
}
