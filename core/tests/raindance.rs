//! Generated terrain meets every window, what is not Raindance-like does not, and a seed means the same bits everywhere.

use discjump_core::random::{Purpose, uniform};
use discjump_core::terrain::raindance::{Generated, Options, QUANTUM, generate};
use discjump_core::terrain::statistics::fft::{Direction, transform};
use discjump_core::terrain::statistics::{Group, Report};
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_128;

const DEFAULT: Options = Options { repeating: false };
const REPEATING: Options = Options { repeating: true };

fn report(generated: &Generated) -> Report {
    Report::of(&generated.heights, Some(&generated.mission)).expect("heights of the right size")
}

fn assert_raindance_like(seed: u64, options: Options) {
    let generated = generate(seed, options).unwrap_or_else(|error| panic!("{error}"));
    let report = report(&generated);
    let outside: Vec<_> = report.rows.iter().filter(|row| !row.inside).collect();
    assert!(report.passes(), "seed {seed}, {options:?}: {outside:#?}");
    assert_eq!(report.rows.len(), 51);
    assert!(!options.repeating || report.repeats(), "seed {seed}: repetition {}", report.repetition);

    assert_eq!(generated.heights.len(), 257 * 257);
    for &height in &generated.heights {
        assert!(height >= 0.0 && (height / QUANTUM).fract() == 0.0, "seed {seed}: height {height}");
    }
    let mission = &generated.mission;
    let tile = -1024.0..=1024.0;
    for axis in 0..2 {
        assert!(tile.contains(&mission.area.min[axis]) && tile.contains(&mission.area.max[axis]));
    }
    for flag in mission.flags {
        assert!(mission.area.contains([flag[0], flag[1]]), "seed {seed}: flag {flag:?}");
    }
    let [a, b] = mission.bridge.ends;
    assert!((f64::hypot(b[0] - a[0], b[1] - a[1]) - 128.0).abs() < 1e-9);
    assert_eq!(mission.bridge.deck_top, a[2].min(b[2]));
}

#[test]
fn every_seed_is_raindance_like() {
    (0..200_u64).into_par_iter().for_each(|seed| assert_raindance_like(seed, DEFAULT));
    [u64::MAX, u64::MAX / 3, 1 << 32].into_par_iter().for_each(|seed| assert_raindance_like(seed, DEFAULT));
}

#[test]
fn every_seed_is_raindance_like_when_repeating() {
    (0..40_u64).into_par_iter().for_each(|seed| assert_raindance_like(seed, REPEATING));
}

/// Training and evaluation name terrains by seed, in every process and on every machine: so a seed's heights are
/// equal bit for bit, on any thread, to the committed digests.
#[test]
fn seeds_have_the_committed_bits() {
    let golden = include_str!("golden/raindance.txt");
    let cases: Vec<_> = [DEFAULT, REPEATING]
        .into_iter()
        .flat_map(|o| [0_u64, 1, 2, 7, 11, 1 << 40].map(|s| (s, o)))
        .collect();
    let digest = |&(seed, options): &(u64, Options)| {
        let generated = generate(seed, options).unwrap_or_else(|error| panic!("{error}"));
        let bytes: Vec<u8> = generated.heights.iter().flat_map(|height| height.to_le_bytes()).collect();
        let kind = if options.repeating { "repeating" } else { "default" };
        format!("{seed} {kind} {:032x}\n", xxh3_128(&bytes))
    };
    let one_thread: String = cases.iter().map(digest).collect();
    let many_threads: Vec<String> = cases.par_iter().map(digest).collect();
    assert_eq!(one_thread, many_threads.concat());
    assert_eq!(
        one_thread, golden,
        "heights have changed: if that is meant, commit these digests\n{one_thread}"
    );
}

#[test]
fn seeds_differ() {
    let [a, b] = [4, 5].map(|seed| generate(seed, DEFAULT).expect("a terrain").heights);
    let equal = a.iter().zip(&b).filter(|(a, b)| a == b).count();
    assert!(equal < a.len() / 100);
}

/// Several octaves of gradient (Perlin) or value noise, periodic, scaled to the reference's standard deviation.
fn octaves(seed: u64, base_wavelength: usize, gradient: bool) -> Vec<f64> {
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let mut heights = vec![0.0; 65536];
    let cells = 256 * 8 / base_wavelength;
    for octave in 0..5 {
        let cells = cells << octave;
        let amplitude = 0.5_f64.powi(octave);
        let draw = |x: usize, y: usize, which: u32| {
            let cell = ((y % cells) * cells + x % cells) as u32;
            uniform(seed, octave as u64, Purpose::Terrain, cell * 2 + which, -1.0, 1.0)
        };
        for (k, height) in heights.iter_mut().enumerate() {
            let at = [k % 256, k / 256].map(|c| c as f64 * cells as f64 / 256.0);
            let [x, y] = at.map(|c| c as usize);
            let [u, v] = at.map(f64::fract);
            let corner = |dx: usize, dy: usize| {
                if gradient {
                    draw(x + dx, y + dy, 0) * (u - dx as f64) + draw(x + dx, y + dy, 1) * (v - dy as f64)
                } else {
                    draw(x + dx, y + dy, 0)
                }
            };
            let mix = |a: f64, b: f64, t: f64| a + (b - a) * fade(t);
            *height +=
                amplitude * mix(mix(corner(0, 0), corner(1, 0), u), mix(corner(0, 1), corner(1, 1), u), v);
        }
    }
    scaled(heights)
}

fn scaled(heights: Vec<f64>) -> Vec<f64> {
    let mean = heights.iter().sum::<f64>() / 65536.0;
    let deviation = (heights.iter().map(|h| (h - mean) * (h - mean)).sum::<f64>() / 65536.0).sqrt();
    heights.iter().map(|h| 35.6 + 10.81 * (h - mean) / deviation).collect()
}

#[test]
fn plain_noise_is_not_raindance_like() {
    for base_wavelength in [128, 256, 512] {
        for gradient in [true, false] {
            for seed in 0..3 {
                let report = Report::of(&octaves(seed, base_wavelength, gradient), None).expect("256 x 256");
                assert!(!report.passes_without_mission());
                let outside = report.outside(Group::Core);
                assert!(
                    outside >= 4,
                    "{base_wavelength} m, gradient {gradient}, seed {seed}: {outside} outside"
                );
                assert!((report.value("sigma_m").expect("measured") - 10.81).abs() < 1e-9);
            }
        }
    }
}

/// The same power in every mode with other phases: the spectrum is a Raindance, the benches are gone. The statistics
/// that see benches must say so, else matching a spectrum would be enough.
#[test]
fn a_raindance_with_random_phases_is_not_raindance_like() {
    for seed in 0..3 {
        let original = generate(seed, DEFAULT).expect("a terrain");
        let rows = original.heights.chunks_exact(257).take(256);
        let mut re: Vec<f64> = rows.flat_map(|row| row[..256].to_vec()).collect();
        let mut im = vec![0.0; re.len()];
        transform(&mut re, &mut im, 256, Direction::Forward);
        // The phases of a real field of white noise have the symmetry that keeps the result real.
        let mut phases: Vec<f64> =
            (0..65536).map(|k| uniform(seed, 0, Purpose::Goal, k, -1.0, 1.0)).collect();
        let mut phases_im = vec![0.0; re.len()];
        transform(&mut phases, &mut phases_im, 256, Direction::Forward);
        for k in 1..65536 {
            let (modulus, length) = (f64::hypot(re[k], im[k]), f64::hypot(phases[k], phases_im[k]));
            (re[k], im[k]) = (modulus * phases[k] / length, modulus * phases_im[k] / length);
        }
        transform(&mut re, &mut im, 256, Direction::Inverse);
        let heights: Vec<f64> = re.iter().map(|height| height / 65536.0).collect();

        let (before, after) = (report(&original), Report::of(&heights, None).expect("256 x 256"));
        for (a, b) in before.rows.iter().zip(&after.rows) {
            if a.name.starts_with("band_") || a.name.starts_with('S') || a.name.starts_with("acf_") {
                assert!((a.value - b.value).abs() < 1e-6, "{}: {} and {}", a.name, a.value, b.value);
            }
        }
        assert!(!after.passes_without_mission());
        for name in ["grad_cv", "lap_exkurt", "flat_edge_x"] {
            let row = after.rows.iter().find(|row| row.name == name).expect("measured");
            assert!(!row.inside, "seed {seed}: {name} {}", row.value);
        }
    }
}
