//! What the mission asks of the ground: flags, gorge, ridges, guard hill. Heights are of the triangles.
//!
//! - `flag_dist_m`, `flag_dz_m`: horizontal distance of the flags; difference of the ground heights under them.
//! - `bridge_off_line_m`: distance of the bridge's centre from the line through the flags.
//! - `bridge_fraction`: distance from flag 0 to the centre over that of the flags.
//! - `gorge_depth_m`, `rim_diff_m`: of 129 even samples of the ground from end to end of the bridge, the mean
//!   of the first and last less the lowest; the difference of the first and last.
//! - `wall_max_deg`, `wall_min_deg`: those samples split at the lowest; on each side the largest height
//!   difference over 24 m as an angle; the larger and the smaller of the two.
//! - `los_block_m`: how far the ground between the flags, sampled every metre, rises above the straight line
//!   that joins the points 17.6 m above ground at the two flags.
//! - `ridges_on_line`: tops of that profile, 3 m reversal threshold, more than 8 m from either flag.
//! - `ascent_m`: sum of the profile's positive steps.
//! - `pad_resid_m`, `pad_slope_deg`: least-squares plane through the ground on an 8 m lattice centred on the flag,
//!   points within 24 m: standard deviation of the residual; slope of the plane; the worse flag.
//! - `guard_top_above_rim_m`: highest sample of the heightfield within 150 m of the bridge's centre, above
//!   the mean height of its two ends.

use super::Values;
use super::grid::{Grid, ORIGIN, SQUARE};
use super::legs::REVERSAL;
use crate::terrain::mission::Mission;

/// Height of a flag above the ground for the line of sight, metres.
pub(crate) const EYE: f64 = 17.6;
/// Samples from end to end of the bridge.
const CROSSING: usize = 129;
/// Span over which a wall's steepness counts: samples, and as many metres.
const WALL: usize = 24;

pub(super) fn measure(grid: &Grid, mission: &Mission, values: &mut Values) {
    let [from, to] = mission.flags.map(|flag| [flag[0], flag[1]]);
    let centre = [mission.bridge.centre[0], mission.bridge.centre[1]];
    let distance = length(minus(to, from));
    values.push("flag_dist_m", distance);
    values.push("flag_dz_m", (grid.ground(from) - grid.ground(to)).abs());
    let (line, offset) = (minus(to, from), minus(centre, from));
    values.push("bridge_off_line_m", (line[0] * offset[1] - line[1] * offset[0]).abs() / distance);
    values.push("bridge_fraction", length(offset) / distance);
    let rim = gorge(grid, mission.bridge.ends.map(|end| [end[0], end[1]]), values);
    flag_line(grid, from, to, values);
    let pads = [pad(grid, from), pad(grid, to)];
    values.push("pad_resid_m", pads[0].residual.max(pads[1].residual));
    values.push("pad_slope_deg", libm::atan(pads[0].slope.max(pads[1].slope)).to_degrees());
    values.push("guard_top_above_rim_m", highest_within(grid, centre, 150.0) - rim);
}

/// Measures the ground under the bridge; returns the mean height of its ends.
fn gorge(grid: &Grid, ends: [[f64; 2]; 2], values: &mut Values) -> f64 {
    let ground = profile(grid, ends[0], ends[1], CROSSING);
    let lowest = (0..CROSSING).fold(0, |low, k| if ground[k] < ground[low] { k } else { low });
    let rim = 0.5 * (ground[0] + ground[CROSSING - 1]);
    values.push("gorge_depth_m", rim - ground[lowest]);
    values.push("rim_diff_m", (ground[0] - ground[CROSSING - 1]).abs());
    let steepest = |side: &[f64]| {
        let steps = side.iter().zip(side.iter().skip(WALL)).map(|(a, b)| (b - a).abs() / WALL as f64);
        libm::atan(steps.fold(0.0, f64::max)).to_degrees()
    };
    let walls = [steepest(&ground[..=lowest]), steepest(&ground[lowest..])];
    values.push("wall_max_deg", walls[0].max(walls[1]));
    values.push("wall_min_deg", walls[0].min(walls[1]));
    rim
}

fn flag_line(grid: &Grid, from: [f64; 2], to: [f64; 2], values: &mut Values) {
    let distance = length(minus(to, from));
    // Generated flags stand whole metres apart, but for rounding: which must not decide about the last metre.
    let steps = (distance + 1e-6).floor() as usize;
    let toward = |metres: f64| {
        let share = metres / distance;
        [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share]
    };
    let ground: Vec<f64> = (0..=steps).map(|k| grid.ground(toward(k as f64))).collect();
    let (first, last) = (grid.ground(from) + EYE, grid.ground(to) + EYE);
    let above = |k: usize| ground[k] - (first + (last - first) * (k as f64 / distance));
    values.push("los_block_m", (0..=steps).map(above).fold(f64::NEG_INFINITY, f64::max));
    let inner = |top: &&usize| **top as f64 > 8.0 && (**top as f64) < distance - 8.0;
    values.push("ridges_on_line", tops(&ground).iter().filter(inner).count() as f64);
    values.push("ascent_m", ground.windows(2).map(|pair| (pair[1] - pair[0]).max(0.0)).sum());
}

/// Where an open profile has tops: highest samples that the profile rises 3 m towards, or begins with, and
/// falls 3 m from.
fn tops(profile: &[f64]) -> Vec<usize> {
    let mut tops = Vec::new();
    let (mut high, mut low, mut falling) = (0, 0, false);
    for (k, &height) in profile.iter().enumerate() {
        if falling {
            if height < profile[low] {
                low = k;
            }
            if height - profile[low] >= REVERSAL {
                (high, falling) = (k, false);
            }
        } else {
            if height > profile[high] {
                high = k;
            }
            if profile[high] - height >= REVERSAL {
                tops.push(high);
                (low, falling) = (k, true);
            }
        }
    }
    tops
}

/// How level the ground around a flag is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pad {
    /// Standard deviation of the ground about its plane, metres.
    pub residual: f64,
    /// Steepness of that plane, as a tangent.
    pub slope: f64,
    /// Mean height, metres.
    pub mean: f64,
}

/// The lattice within 24 m of a flag, in squares.
pub(crate) const PAD: [(i32, i32); 29] = pad_lattice();

const fn pad_lattice() -> [(i32, i32); 29] {
    let mut lattice = [(0, 0); 29];
    let (mut count, mut k) = (0, 0);
    while k < 49 {
        let (x, y) = (k % 7 - 3, k / 7 - 3);
        if x * x + y * y <= 9 {
            lattice[count] = (x, y);
            count += 1;
        }
        k += 1;
    }
    lattice
}

/// The least-squares plane of the ground around a flag.
pub(crate) fn pad(grid: &Grid, flag: [f64; 2]) -> Pad {
    let sample =
        |x: i32, y: i32| grid.ground([flag[0] + SQUARE * f64::from(x), flag[1] + SQUARE * f64::from(y)]);
    plane(PAD.map(|(x, y)| sample(x, y)))
}

/// The plane through heights on the lattice [`PAD`]. It is symmetric, so the normal equations are diagonal.
pub(crate) fn plane(heights: [f64; 29]) -> Pad {
    let mean = heights.iter().sum::<f64>() / 29.0;
    let (mut xx, mut xz, mut yz) = (0.0, 0.0, 0.0);
    for ((x, y), height) in PAD.iter().zip(heights) {
        let (x, y) = (SQUARE * f64::from(*x), SQUARE * f64::from(*y));
        xx += x * x;
        xz += x * (height - mean);
        yz += y * (height - mean);
    }
    let (slope_x, slope_y) = (xz / xx, yz / xx);
    let mut squares = 0.0;
    for ((x, y), height) in PAD.iter().zip(heights) {
        let plane = mean + SQUARE * (slope_x * f64::from(*x) + slope_y * f64::from(*y));
        squares += (height - plane) * (height - plane);
    }
    Pad { residual: (squares / 29.0).sqrt(), slope: (slope_x * slope_x + slope_y * slope_y).sqrt(), mean }
}

/// The highest sample of the heightfield within a radius of a point; minus infinity if there is none.
pub(crate) fn highest_within(grid: &Grid, centre: [f64; 2], radius: f64) -> f64 {
    let first = centre.map(|c| ((c - radius - ORIGIN) / SQUARE).ceil() as i64);
    let last = centre.map(|c| ((c + radius - ORIGIN) / SQUARE).floor() as i64);
    let mut highest = f64::NEG_INFINITY;
    for y in first[1]..=last[1] {
        for x in first[0]..=last[0] {
            let vertex = [ORIGIN + SQUARE * x as f64, ORIGIN + SQUARE * y as f64];
            if length(minus(vertex, centre)) <= radius {
                highest = highest.max(grid.at(x as usize, y as usize));
            }
        }
    }
    highest
}

/// Even samples of the ground along a straight line, both ends included.
pub(crate) fn profile(grid: &Grid, from: [f64; 2], to: [f64; 2], count: usize) -> Vec<f64> {
    let at = |k: usize| {
        let share = k as f64 / (count - 1) as f64;
        [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share]
    };
    (0..count).map(|k| grid.ground(at(k))).collect()
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn length(a: [f64; 2]) -> f64 {
    (a[0] * a[0] + a[1] * a[1]).sqrt()
}
