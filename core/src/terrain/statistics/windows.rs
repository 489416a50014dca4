//! The acceptance windows: what every statistic must come to before a terrain may be called Raindance-like.
//!
//! The reference is one map, whose heights are private and not part of this repository: only these numbers of it are.
//! One map has no confidence intervals. The windows are centred on its values and just wide enough for the
//! seed-to-seed spread of a generator that matches it, while gradient noise, ridged noise, power-law spectra, a
//! random-phase field with the reference's own spectrum and thirteen other maps all fall outside.

/// What happens when a statistic is outside its window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Of the whole heightfield; none may be outside.
    Core,
    /// Of the whole heightfield; at most [`MAX_SUPPORTING_OUTSIDE`] may be outside.
    Supporting,
    /// Of the ground under the mission; none may be outside.
    Mission,
}

/// How many supporting statistics may be outside their windows.
pub const MAX_SUPPORTING_OUTSIDE: usize = 2;

/// Least autocorrelation at a lag of 512 m of a terrain that claims to repeat a 512 m cell.
pub const REPETITION_MIN: f64 = 0.95;

/// One statistic and the values accepted for it, bounds included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Name of the statistic.
    pub name: &'static str,
    /// What happens outside the window.
    pub group: Group,
    /// Value of the reference map.
    pub reference: f64,
    /// Least accepted value.
    pub min: f64,
    /// Greatest accepted value.
    pub max: f64,
    /// What the statistic is, in a line. The exact definition stands at the head of the file that measures it.
    pub meaning: &'static str,
}

impl Window {
    /// Whether a value is accepted. NaN is not.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        self.min <= value && value <= self.max
    }
}

const fn window(
    name: &'static str,
    group: Group,
    [reference, min, max]: [f64; 3],
    meaning: &'static str,
) -> Window {
    Window { name, group, reference, min, max, meaning }
}

use Group::{Core, Mission, Supporting};

/// All windows, in the order in which reports list them: reference, least, greatest.
#[rustfmt::skip]
pub const WINDOWS: [Window; 51] = [
    window("sigma_m", Core, [10.81, 10.01, 11.61], "standard deviation of the heights, m"),
    window("spread_p1_p99_m", Core, [50.65, 44.6, 56.6], "99th less 1st percentile of the heights, m"),
    window("slope_mean_deg", Core, [19.15, 17.65, 20.65], "mean slope of the triangles, degrees"),
    window("frac_gt30", Core, [0.163, 0.113, 0.213], "share of triangles steeper than 30 degrees"),
    window("S8_m", Core, [2.417, 2.17, 2.67], "r.m.s. height difference over 8 m, m"),
    window("S32_m", Core, [8.073, 7.37, 8.77], "r.m.s. height difference over 32 m, m"),
    window("S128_m", Core, [16.51, 15.0, 18.0], "r.m.s. height difference over 128 m, m"),
    window("band_gt600", Core, [0.002854, 0.0, 0.03], "share of height variance at wavelengths above 600 m"),
    window("band_240_600", Core, [0.2655, 0.195, 0.335], "share of height variance at 240 to 600 m"),
    window("band_125_240", Core, [0.5993, 0.52, 0.68], "share of height variance at 125 to 240 m"),
    window("band_63_125", Core, [0.1176, 0.083, 0.153], "share of height variance at 63 to 125 m"),
    window("band_31_63", Core, [0.01172, 0.007, 0.017], "share of height variance at 31.5 to 63 m"),
    window("acf_1e_m", Core, [55.76, 49.8, 61.8], "distance where the autocorrelation falls below 1/e, m"),
    window("acf_zero_m", Core, [88.13, 76.0, 100.0], "distance where the autocorrelation falls below 0, m"),
    window("grad_cv", Core, [0.6196, 0.57, 0.67], "standard deviation of the gradient over its mean (Gaussian: 0.523)"),
    window("frac_lt5", Core, [0.09016, 0.055, 0.125], "share of triangles flatter than 5 degrees"),
    window("lap_exkurt", Core, [0.9779, 0.4, 2.5], "excess kurtosis of the Laplacian"),
    window("pits_per_km2", Core, [453.9, 314.0, 594.0], "samples with no lower neighbour, per km^2"),
    window("flat_edge_x", Core, [0.2909, 0.21, 0.37], "share of level east-west edges"),
    window("crest_spacing_m", Core, [192.1, 170.0, 214.0], "length of straight line per descent of 3 m or more, m"),
    window("range_m", Supporting, [70.26, 54.3, 86.3], "highest less lowest height, m"),
    window("frac_gt45", Supporting, [0.01203, 0.002, 0.025], "share of triangles steeper than 45 degrees"),
    window("slope_p99_deg", Supporting, [45.51, 41.0, 50.0], "99th percentile of the slope, degrees"),
    window("S16_m", Supporting, [4.497, 4.1, 4.9], "r.m.s. height difference over 16 m, m"),
    window("S64_m", Supporting, [13.11, 12.0, 14.2], "r.m.s. height difference over 64 m, m"),
    window("band_lt31", Supporting, [0.003072, 0.0015, 0.006], "share of height variance below 31.5 m"),
    window("acf_min", Supporting, [-0.1422, -0.212, -0.072], "lowest autocorrelation up to 504 m"),
    window("crease_p50_deg", Supporting, [6.635, 4.9, 8.3], "median angle between neighbouring triangles, degrees"),
    window("crease_p99_deg", Supporting, [34.01, 27.5, 40.5], "99th percentile of the angle between neighbouring triangles, degrees"),
    window("leg_drop_mean_m", Supporting, [20.57, 18.3, 22.9], "mean drop of a descent along a straight line, m"),
    window("leg_drop_p90_m", Supporting, [36.59, 32.1, 41.1], "90th percentile of the drops of such descents, m"),
    window("hills_per_km2", Supporting, [19.55, 11.1, 28.1], "hills of at least 10 m of prominence, per km^2"),
    window("hill_nn_m", Supporting, [166.6, 112.0, 222.0], "mean distance from a hill to the nearest other, m"),
    window("hill_prom_median_m", Supporting, [21.6, 12.6, 30.6], "median prominence of the hills, m"),
    window("basins_per_km2", Supporting, [15.5, 7.5, 23.5], "basins at least 10 m deep, per km^2"),
    window("descent_len_mean_m", Supporting, [48.81, 30.8, 66.8], "mean length of the steepest way down, m"),
    window("grad_ratio_xy", Supporting, [0.9104, 0.77, 1.05], "r.m.s. gradient east-west over north-south"),
    window("flag_dist_m", Mission, [638.7, 589.0, 689.0], "horizontal distance of the flags, m"),
    window("flag_dz_m", Mission, [16.3, 0.0, 25.0], "difference of the ground heights under the flags, m"),
    window("bridge_off_line_m", Mission, [0.1213, 0.0, 5.0], "distance of the bridge's centre from the line of the flags, m"),
    window("bridge_fraction", Mission, [0.444, 0.37, 0.63], "where the bridge stands on the way from flag 0 to flag 1"),
    window("gorge_depth_m", Mission, [26.54, 22.0, 34.0], "depth of the gorge below the bridge's ends, m"),
    window("rim_diff_m", Mission, [2.26, 0.0, 8.0], "difference of the ground heights at the bridge's ends, m"),
    window("wall_max_deg", Mission, [42.08, 30.0, 54.0], "angle of the steeper wall of the gorge over 24 m, degrees"),
    window("wall_min_deg", Mission, [27.51, 22.0, 46.0], "angle of the gentler wall of the gorge over 24 m, degrees"),
    window("los_block_m", Mission, [12.8, 3.0, 40.0], "ground above the line of sight between the flags, m"),
    window("ridges_on_line", Mission, [2.0, 2.0, 5.0], "tops of 3 m or more between the flags"),
    window("ascent_m", Mission, [90.85, 55.0, 135.0], "total climb on the straight line between the flags, m"),
    window("pad_resid_m", Mission, [1.719, 0.0, 2.0], "r.m.s. unevenness within 24 m of a flag, the worse one, m"),
    window("pad_slope_deg", Mission, [9.868, 0.0, 13.0], "tilt of the ground within 24 m of a flag, the worse one, degrees"),
    window("guard_top_above_rim_m", Mission, [34.15, 12.0, 40.0], "highest ground within 150 m of the bridge above its ends, m"),
];
