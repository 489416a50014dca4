//! Statistics of heights whose statistics can be worked out by hand.

use discjump_core::random::{Purpose, uniform};
use discjump_core::terrain::mission::{Area, Bridge, Mission};
use discjump_core::terrain::statistics::fft::{Direction, transform};
use discjump_core::terrain::statistics::relief::hills;
use discjump_core::terrain::statistics::{Error, Grid, Report, WINDOWS};
use std::f64::consts::TAU;

/// 256 x 256 heights of a function of column and row.
fn heights(f: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    (0..65536).map(|k| f(k % 256, k / 256)).collect()
}

/// A periodic zigzag: 0 at multiples of `period`, rising and falling by `step` per sample.
fn zigzag(k: usize, period: usize, step: f64) -> f64 {
    let phase = k % period;
    step * phase.min(period - phase) as f64
}

fn report(heights: &[f64]) -> Report {
    Report::of(heights, None).expect("heights of the right size")
}

#[track_caller]
fn assert_near(report: &Report, name: &str, expected: f64, tolerance: f64) {
    let found = report.value(name).unwrap_or_else(|| panic!("{name} was not measured"));
    assert!((found - expected).abs() <= tolerance, "{name}: {found}, expected {expected}");
}

#[test]
fn a_sinusoid_has_one_band_and_a_sine_for_a_structure_function() {
    let (amplitude, wavelength) = (12.0, 256.0);
    let report = report(&heights(|x, _| amplitude * (TAU * 8.0 * x as f64 / wavelength).sin()));
    assert_near(&report, "sigma_m", amplitude / 2.0_f64.sqrt(), 1e-9);
    assert_near(&report, "range_m", 2.0 * amplitude, 1e-9);
    for name in ["gt600", "240_600", "125_240", "63_125", "31_63", "lt31"] {
        let expected = f64::from(u8::from(name == "240_600"));
        assert_near(&report, &format!("band_{name}"), expected, 1e-12);
    }
    // sin(a + d) - sin(a) has the mean square 2 sin^2(d / 2); north-south differences are zero.
    for lag in [8.0, 16.0, 32.0, 64.0, 128.0] {
        let expected = amplitude * (0.5 * TAU * lag / wavelength).sin();
        assert_near(&report, &format!("S{lag}_m"), expected, 1e-9);
    }
    assert_near(&report, "crest_spacing_m", 2.0 * wavelength, 1e-9);
    assert_near(&report, "leg_drop_mean_m", 2.0 * amplitude, 1e-9);
    assert!((report.repetition - 1.0).abs() < 1e-12);
}

/// The autocorrelation of a sinusoid is cos(k x); its mean over a circle is the Bessel function J0(k r), which is 1/e at
/// 1.75199 and 0 at 2.40483. Rings of whole samples are no circles: crossings are off by up to a metre, and the
/// lowest value is compared with the mean over the rings themselves.
#[test]
fn the_averaged_autocorrelation_of_a_sinusoid_is_a_bessel_function() {
    for (mode, wavelength) in [(4.0, 512.0), (8.0, 256.0)] {
        let report = report(&heights(|x, _| (TAU * mode * x as f64 / 256.0).sin()));
        assert_near(&report, "acf_1e_m", 1.75199 / TAU * wavelength, 1.0);
        assert_near(&report, "acf_zero_m", 2.40483 / TAU * wavelength, 1.0);
        let mut rings = [(0.0, 0.0); 64];
        for (dx, dy) in (-64..=64_i32).flat_map(|dy| (-64..=64_i32).map(move |dx| (dx, dy))) {
            let ring = f64::hypot(dx.into(), dy.into()).round() as usize;
            if ring < 64 {
                rings[ring].0 += (TAU * mode * f64::from(dx) / 256.0).cos();
                rings[ring].1 += 1.0;
            }
        }
        let lowest = rings.iter().map(|(sum, count)| sum / count).fold(f64::INFINITY, f64::min);
        assert_near(&report, "acf_min", lowest, 1e-9);
    }
}

#[test]
fn bands_follow_the_length_of_the_wave_vector() {
    // sqrt(12^2 + 5^2) = 13: 157.5 m, though 409.6 m along y.
    let wave = |x: usize, y: usize| (TAU * (12 * x + 5 * y) as f64 / 256.0).cos();
    assert_near(&report(&heights(wave)), "band_125_240", 1.0, 1e-12);
}

#[test]
fn a_zigzag_has_one_slope_and_one_crease() {
    let (step, period) = (3.0, 8);
    let report = report(&heights(|x, _| zigzag(x, period, step)));
    let slope = (step / 8.0_f64).atan().to_degrees();
    assert_near(&report, "slope_mean_deg", slope, 1e-9);
    assert_near(&report, "slope_p99_deg", slope, 1e-9);
    assert_near(&report, "grad_cv", 0.0, 1e-9);
    assert_near(&report, "frac_lt5", 0.0, 0.0);
    assert_near(&report, "frac_gt30", 0.0, 0.0);
    // A twelfth of the edges lie on crests and valley floors, the others within planes.
    assert_near(&report, "crease_p50_deg", 0.0, 1e-5);
    assert_near(&report, "crease_p99_deg", 2.0 * slope, 1e-9);
    assert_near(&report, "crest_spacing_m", 2.0 * 64.0, 1e-9);
    assert_near(&report, "leg_drop_mean_m", 12.0, 1e-9);
    assert_near(&report, "leg_drop_p90_m", 12.0, 1e-9);
    // Even columns are 0, 2, 4 and 2 squares from the floor.
    assert_near(&report, "descent_len_mean_m", 16.0, 1e-9);
    // Every sample of the floors, one column in eight, has none lower beside it.
    assert_near(&report, "pits_per_km2", 65536.0 / 8.0 / 4.194304, 1e-9);
}

#[test]
fn gradients_along_x_and_y_are_told_apart() {
    let report = report(&heights(|x, y| zigzag(x, 16, 1.5) + zigzag(y, 32, 2.0)));
    assert_near(&report, "grad_ratio_xy", 0.75, 1e-12);
    assert_near(&report, "slope_mean_deg", (2.5 / 8.0_f64).atan().to_degrees(), 1e-9);
}

#[test]
fn thresholds_of_slope_are_strict() {
    // Exactly 45 degrees everywhere is not steeper than 45.
    let report = report(&heights(|x, _| zigzag(x, 8, 8.0)));
    assert_near(&report, "frac_gt45", 0.0, 0.0);
    assert_near(&report, "frac_gt30", 1.0, 0.0);
    assert_near(&report, "slope_p99_deg", 45.0, 1e-12);
}

#[test]
fn level_edges_are_counted_along_x_alone() {
    let report = report(&heights(|x, y| (x / 2 * 2) as f64 + y as f64));
    assert_near(&report, "flat_edge_x", 0.5, 0.0);
}

/// Cones on a plain: prominence is the height above the plain, the highest has the range, and the plain is
/// one basin.
#[test]
fn hills_are_counted_by_prominence() {
    let cones = [(40, 40, 30.0), (100, 40, 20.0), (250, 40, 14.0), (128, 200, 50.0), (60, 128, 9.5)];
    let apart = |a: usize, b: usize| a.abs_diff(b).min(256 - a.abs_diff(b)) as f64;
    let height = |x: usize, y: usize| {
        let cone = |&(cx, cy, top): &(usize, usize, f64)| top - 2.0 * f64::hypot(apart(x, cx), apart(y, cy));
        cones.iter().map(cone).fold(0.0, f64::max)
    };
    let heights = heights(height);
    let found = report(&heights);
    assert_near(&found, "hills_per_km2", 4.0 / 4.194304, 1e-12);
    assert_near(&found, "hill_prom_median_m", 25.0, 1e-12);
    assert_near(&found, "basins_per_km2", 1.0 / 4.194304, 1e-12);
    // 40 to 250 is 46 squares round the edge; 100 to 40 is 60; from (128, 200) the nearest is (100, 40), 96 down.
    let nearest = [46.0, 60.0, 46.0, f64::hypot(28.0, 96.0)];
    assert_near(&found, "hill_nn_m", 8.0 * nearest.iter().sum::<f64>() / 4.0, 1e-9);

    let (grid, _) = Grid::read(&heights).expect("256 x 256");
    let mut hills: Vec<_> = hills(&grid).iter().map(|hill| (hill.x, hill.y, hill.prominence)).collect();
    hills.sort_by(|a, b| a.2.total_cmp(&b.2));
    assert_eq!(hills, [(250, 40, 14.0), (100, 40, 20.0), (40, 40, 30.0), (128, 200, 50.0)]);
}

/// Two cones that meet above the plain: the lower one's prominence is counted from the saddle.
#[test]
fn prominence_is_counted_from_the_saddle() {
    let ridge = |x: usize, y: usize| {
        let along = if (100..=140).contains(&x) { 20.0 } else { 0.0 };
        let tops = if x == 100 {
            45.0
        } else if x == 140 {
            35.0
        } else {
            along
        };
        if y == 77 { tops } else { 0.0 }
    };
    let (grid, _) = Grid::read(&heights(ridge)).expect("256 x 256");
    let hills: Vec<_> = hills(&grid).iter().map(|hill| (hill.x, hill.prominence)).collect();
    assert_eq!(hills, [(140, 15.0), (100, 45.0)]);
}

/// The gradient of an isotropic Gaussian field is Rayleigh distributed: its deviation over its mean is
/// sqrt(4 / pi - 1) = 0.5227; and its Laplacian is Gaussian.
#[test]
fn a_gaussian_field_has_the_ratio_of_rayleigh() {
    let mut re: Vec<f64> = (0..65536).map(|k| uniform(1, 0, Purpose::Goal, k, -1.0, 1.0)).collect();
    let mut im = vec![0.0; re.len()];
    transform(&mut re, &mut im, 256, Direction::Forward);
    for k in 0..65536 {
        let wrapped = |c: usize| c.min(256 - c) as f64;
        let squared = wrapped(k % 256) * wrapped(k % 256) + wrapped(k / 256) * wrapped(k / 256);
        let gain = (-squared / (2.0 * 15.0 * 15.0)).exp();
        re[k] *= gain;
        im[k] *= gain;
    }
    transform(&mut re, &mut im, 256, Direction::Inverse);
    let report = report(&re);
    assert_near(&report, "grad_cv", 0.5227, 0.01);
    assert_near(&report, "lap_exkurt", 0.0, 0.1);
    assert_near(&report, "grad_ratio_xy", 1.0, 0.05);
}

/// A straight valley along y with sides of slope 1/2, flags and bridge across it.
#[test]
fn a_plain_valley_has_a_plain_mission() {
    let ground = |x: f64| 0.5 * x.abs();
    let at = |x: f64| [x, 3.0, ground(x)];
    let mission = Mission {
        flags: [at(-320.0), at(320.0)],
        bridge: Bridge { centre: at(0.0), ends: [at(-64.0), at(64.0)], width: Bridge::WIDTH, deck_top: 32.0 },
        area: Area::centred([0.0, 3.0]),
    };
    let heights = heights(|x, _| ground(8.0 * x as f64 - 1024.0));
    let report = Report::of(&heights, Some(&mission)).expect("256 x 256");
    for (name, expected) in [
        ("flag_dist_m", 640.0),
        ("flag_dz_m", 0.0),
        ("bridge_off_line_m", 0.0),
        ("bridge_fraction", 0.5),
        ("gorge_depth_m", 32.0),
        ("rim_diff_m", 0.0),
        ("wall_max_deg", 0.5_f64.atan().to_degrees()),
        ("wall_min_deg", 0.5_f64.atan().to_degrees()),
        ("los_block_m", -17.6),
        ("ridges_on_line", 0.0),
        ("ascent_m", 160.0),
        ("pad_resid_m", 0.0),
        ("pad_slope_deg", 0.5_f64.atan().to_degrees()),
        // The highest sample within 150 m lies 144 m to the side.
        ("guard_top_above_rim_m", 72.0 - 32.0),
    ] {
        assert_near(&report, name, expected, 1e-9);
    }
    assert!(!report.passes());
}

#[test]
fn windows_hold_their_reference_and_names_are_unique() {
    for (k, window) in WINDOWS.iter().enumerate() {
        assert!(window.contains(window.reference), "{}", window.name);
        assert!(WINDOWS[..k].iter().all(|other| other.name != window.name), "{}", window.name);
    }
}

#[test]
fn a_step_at_the_edge_is_seen() {
    let closed = |x: usize, y: usize| zigzag(x % 256, 16, 1.0) + zigzag(y % 256, 16, 1.0);
    let mut heights: Vec<f64> = (0..257 * 257).map(|k| closed(k % 257, k / 257)).collect();
    assert!(report(&heights).seamless);
    heights[256] = heights[256].next_up();
    let report = report(&heights);
    assert!(!report.seamless && !report.passes_without_mission());
}

#[test]
fn heights_that_cannot_be_measured_are_refused() {
    assert_eq!(Report::of(&[1.0; 100], None), Err(Error::Length { found: 100 }));
    let mut heights = vec![0.0; 65536];
    heights[256 * 3 + 5] = f64::NAN;
    assert_eq!(Report::of(&heights, None), Err(Error::NotFinite { row: 3, column: 5 }));
}

/// Level ground, spikes as high as numbers go and single peaks must come to some verdict, not to a panic.
#[test]
fn degenerate_heights_are_measured_and_fail() {
    for f in [
        |_: usize, _: usize| 0.0,
        |x, _| if x % 2 == 0 { f64::MAX } else { f64::MIN },
        |x, y| f64::from(u8::from(x == 9 && y == 9)) * 1e9,
        |x, y| if (x + y) % 2 == 0 { 0.0 } else { -0.0 },
        |_, y| 1e-300 * y as f64,
    ] {
        assert!(!report(&heights(f)).passes_without_mission());
    }
}
