//! Bytes as a world, a player and his keys; what must hold of every tick is the tests' own
//! (core/tests/fuzzed).
#![no_main]

#[path = "../../tests/fuzzed/case.rs"]
mod case;
#[path = "../../tests/fuzzed/decode.rs"]
mod decode;

/// The widths of lanes beside 1 that this processor has.
fn widths() -> impl Iterator<Item = usize> {
    #[cfg(target_arch = "x86_64")]
    let wide = is_x86_feature_detected!("avx2").then_some(8);
    #[cfg(not(target_arch = "x86_64"))]
    let wide: Option<usize> = None;
    wide.into_iter()
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let case = decode::decode(bytes);
    if let Err(sentence) = case.check() {
        panic!("{sentence}\n{case:?}");
    }
});
