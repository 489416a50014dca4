//! Simulators of many players, each with keys drawn for his name rather than his index.

use super::{rolling, setup};
use discjump_core::batch::{Bodies, RawInput};
use discjump_core::random::{Purpose, bits};

/// Keys of one player in one tick, drawn for his name rather than his index.
pub fn keys(name: u64, tick: u64) -> RawInput {
    let draw = bits(name, tick / 10, Purpose::Velocity, 0);
    RawInput {
        forward: (draw % 3) as i8 - 1,
        strafe: (draw / 3 % 3) as i8 - 1,
        jump: u8::from([true, true, true, false][(draw / 9 % 4) as usize]),
        jet: (draw / 36 % 2) as u8,
        fire: 0,
        turn: (draw / 72 % 7) as f64 - 3.0,
        pitch: 0.1,
    }
}

pub fn simulator(players: usize, threads: usize, tier: &str) -> Box<dyn Bodies> {
    let map = rolling();
    let mut s = setup(&map, tier);
    (s.players, s.threads) = (players, Some(threads));
    s.build().unwrap()
}

pub fn play(sim: &mut dyn Bodies, names: &[u64], ticks: std::ops::Range<u64>) {
    for tick in ticks {
        let inputs: Vec<_> = names.iter().map(|&n| keys(n, tick)).collect();
        sim.step(&inputs, 1).unwrap();
    }
}
