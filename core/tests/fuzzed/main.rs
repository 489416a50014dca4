//! Random search over terrain, state and keys: by proptest, which shrinks what it finds, and by the corpus that
//! a coverage-guided fuzzer left (`make fuzz`; core/fuzz). Both ask the same of every tick.
#![allow(missing_docs)]

mod case;
#[path = "../common/mod.rs"]
mod common;
mod decode;

use case::{Case, Keys};
use common::widths;
use decode::{HEIGHTS, LONGEST_WAY, SPEEDS, SQUARES, TICKS_MS, decode};
use discjump_core::terrain::{Edge, SurfaceKind};
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::RngSeed;
use std::path::Path;

/// Every input that the fuzzer kept, as it would play it.
#[test]
fn the_fuzzers_corpus_holds() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/ticks");
    let mut files: Vec<_> =
        std::fs::read_dir(&corpus).expect("a corpus").map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 438, "{} inputs in {}", files.len(), corpus.display());
    for file in files {
        let case = decode(&std::fs::read(&file).unwrap());
        if let Err(sentence) = case.check() {
            panic!("{}: {sentence}\n{case:?}", file.display());
        }
    }
}

/// No bytes, some and many are a case.
#[test]
fn any_bytes_are_a_case() {
    for length in [0, 1, 7, 40, 400] {
        for byte in [0, 0x55, 0xff] {
            let case = decode(&vec![byte; length]);
            assert!(case.check().is_ok(), "{length} bytes {byte}");
        }
    }
}

fn keys() -> impl Strategy<Value = Vec<Keys>> {
    let turn = select(vec![0.0, 2.0, -40.0, 1000.0]);
    proptest::collection::vec((-1..2i8, -1..2i8, any::<bool>(), any::<bool>(), turn), 1..30)
}

type Ground = (usize, usize, f64, Edge, SurfaceKind, Vec<f64>);

fn ground() -> impl Strategy<Value = Ground> {
    let surface = select(vec![SurfaceKind::Triangles, SurfaceKind::Bilinear]);
    let edge = select(vec![Edge::Tile, Edge::Tile, Edge::Clamp, Edge::Void]);
    let heights = (select(HEIGHTS.to_vec()), proptest::collection::vec(-127.0..127.0f64, 36))
        .prop_map(|(scale, drawn)| drawn.into_iter().map(|h| h * scale).collect());
    (2..7usize, 2..7usize, select(SQUARES.to_vec()), edge, surface, heights)
}

fn cases() -> impl Strategy<Value = Case> {
    let uniform =
        (0..3usize, any::<bool>(), select(TICKS_MS.to_vec()), any::<Option<bool>>(), any::<[bool; 3]>());
    let motion = (select(SPEEDS.to_vec()), [-127.0..127.0f64, -127.0..127.0, -127.0..127.0], -3.1..3.1f64);
    let place = ([-3.2..3.2f64, -3.2..3.2], prop_oneof![Just(0.0), 0.0..20.0f64]);
    let rest = (0.0..=1.0f64, 0.0..=1.0f64, any::<bool>(), 0..600i32);
    (ground(), uniform, place, motion, rest, keys()).prop_map(
        |(ground, uniform, place, (scale, velocity, yaw), rest, keys)| {
            let limit = (LONGEST_WAY * 1000.0 / f64::from(uniform.2)).min(1e6);
            Case {
                rows: ground.0,
                cols: ground.1,
                square: ground.2,
                edge: ground.3,
                surface: ground.4,
                heights: ground.5,
                armor: uniform.0,
                pack: uniform.1,
                tick_ms: uniform.2,
                ski_bug: uniform.3,
                switches: uniform.4,
                place: place.0,
                above: place.1,
                velocity: velocity.map(|part| (part * scale).clamp(-limit, limit)),
                yaw,
                energy: rest.0,
                friction: rest.1,
                touched: rest.2,
                jump_age: rest.3,
                keys,
            }
        },
    )
}

/// The same draws every time, so that a failure is about the change; others with `DISCJUMP_SEARCH` set.
fn seed() -> RngSeed {
    if std::env::var_os("DISCJUMP_SEARCH").is_some() { RngSeed::Random } else { RngSeed::Fixed(0) }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, rng_seed: seed(), ..ProptestConfig::default() })]

    #[test]
    fn every_tick_holds_whatever_is_drawn(case in cases()) {
        if let Err(sentence) = case.check() {
            return Err(TestCaseError::fail(sentence));
        }
    }
}
