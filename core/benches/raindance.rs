//! Time to generate one terrain, redraws included, and to measure one: `cargo bench --bench raindance`.
//!
//! Divan shows the fastest, slowest, median and mean of the samples; each sample is one seed. For the mean and the 95th
//! percentile over many seeds: `cargo bench --bench raindance -- --percentiles`.

use discjump_core::terrain::raindance::{Options, generate};
use discjump_core::terrain::statistics::Report;
use std::time::Instant;

fn main() {
    if std::env::args().any(|argument| argument == "--percentiles") {
        percentiles();
    } else {
        divan::main();
    }
}

/// Seeds 0 to 399, one after the other on one thread.
fn percentiles() {
    for repeating in [false, true] {
        let mut redraws = 0;
        let mut times: Vec<f64> = (0..400)
            .map(|seed| {
                let start = Instant::now();
                let generated =
                    generate(seed, Options { repeating }).expect("every seed so far has a terrain");
                redraws += divan::black_box(generated).draws;
                start.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        let mean = times.iter().sum::<f64>() / times.len() as f64;
        times.sort_by(f64::total_cmp);
        let at = |share: f64| times[(share * (times.len() - 1) as f64) as usize];
        println!(
            "repeating {repeating}: mean {mean:.2} ms, median {:.2} ms, p95 {:.2} ms, {redraws} redraws in {} seeds",
            at(0.5),
            at(0.95),
            times.len()
        );
    }
}

#[divan::bench(args = [false, true], sample_count = 200, sample_size = 1)]
fn generate_one(bencher: divan::Bencher, repeating: bool) {
    let mut seed = 0;
    let next = || {
        seed += 1;
        seed
    };
    bencher.with_inputs(next).bench_local_values(|seed| generate(seed, Options { repeating }));
}

#[divan::bench]
fn measure_one(bencher: divan::Bencher) {
    let generated = generate(0, Options::default()).expect("seed 0 has a terrain");
    bencher.bench_local(|| Report::of(&generated.heights, Some(&generated.mission)));
}
