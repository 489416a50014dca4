//! The edits by hand that make a mission of a landscape, as the reference has them: hollows for the bases, ridges
//! that hide the flags from each other, a guard hill, the gorge and its abutments.

use super::benches::median3;
use super::draws::{Draws, MISSION};
use super::sites::Site;
use crate::terrain::statistics::grid::{Grid, ORIGIN, SIDE, SQUARE, index};
use crate::terrain::statistics::mission::EYE;

/// Counters of the draws below: after those of the sites.
const GORGE: u32 = MISSION + 64;

/// A base's hollow: level to here, natural from there, metres from the flag.
const HOLLOW: [f64; 2] = [28.0, 72.0];
/// Ridges on the flag line: distance from the crossing, metres.
const RIDGE_AT: f64 = 100.0;
/// Half the width of a ridge at its foot, metres.
const RIDGE_FOOT: f64 = 56.0;
/// Half the length of a ridge: full height to here, gone from there, metres.
const RIDGE_LENGTH: [f64; 2] = [36.0, 100.0];
/// A ridge's top above the rim, and above the line of sight, at least, metres.
const RIDGE_ABOVE_RIM: f64 = 11.0;
const RIDGE_ABOVE_SIGHT: f64 = 7.0;
/// Slopes of the gorge's walls.
const WALLS: [f64; 2] = [0.90, 0.58];
/// Ground about an end of the bridge: level with the deck to here, natural from there, metres.
const ABUTMENT: [f64; 2] = [6.0, 26.0];
/// Half the width of the gorge's floor, metres.
const FLOOR: f64 = 14.0;

/// Edits the ground for a site. Returns nothing: the ground tells.
pub(super) fn apply(grid: &mut Grid, site: &Site, draws: Draws) {
    let before = grid.heights().to_vec();
    for flag in site.flags() {
        hollow(grid, flag);
    }
    let ends = site.ends().map(|end| grid.ground(end));
    let rim = 0.5 * (ends[0] + ends[1]);
    let sight = site.flags().map(|flag| grid.ground(flag) + EYE);
    for along in [-RIDGE_AT, RIDGE_AT] {
        let share = (along + site.reach[0]) / (site.reach[0] + site.reach[1]);
        let line = sight[0] + (sight[1] - sight[0]) * share;
        ridge(grid, site, along, (rim + RIDGE_ABOVE_RIM).max(line + RIDGE_ABOVE_SIGHT));
    }
    guard_hill(grid, site, rim);
    gorge(grid, site, rim, draws);
    abutments(grid, site, rim);
    same_texture(grid, &before);
}

/// 0 up to `from`, 1 beyond `to`, smooth between.
fn smooth(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Calls `f` with each sample within `radius` of a point: its offset from there, and its height to change.
fn around(grid: &mut Grid, centre: [f64; 2], radius: f64, mut f: impl FnMut([f64; 2], &mut f64)) {
    let first = centre.map(|c| ((c - radius - ORIGIN) / SQUARE).ceil() as i64);
    let last = centre.map(|c| ((c + radius - ORIGIN) / SQUARE).floor() as i64);
    let heights = grid.heights_mut();
    for y in first[1]..=last[1] {
        for x in first[0]..=last[0] {
            let offset = [ORIGIN + SQUARE * x as f64 - centre[0], ORIGIN + SQUARE * y as f64 - centre[1]];
            if offset[0] * offset[0] + offset[1] * offset[1] <= radius * radius {
                f(offset, &mut heights[index(x as usize, y as usize)]);
            }
        }
    }
}

fn length(a: [f64; 2]) -> f64 {
    (a[0] * a[0] + a[1] * a[1]).sqrt()
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Pulls the ground around a flag half-way to its mean.
fn hollow(grid: &mut Grid, flag: [f64; 2]) {
    let (mut sum, mut count) = (0.0, 0.0);
    around(grid, flag, 0.5 * (HOLLOW[0] + HOLLOW[1]), |_, height| {
        sum += *height;
        count += 1.0;
    });
    let mean = sum / count;
    around(grid, flag, HOLLOW[1], |offset, height| {
        let pull = 0.5 * (1.0 - smooth(HOLLOW[0], HOLLOW[1], length(offset)));
        *height += pull * (mean - *height);
    });
}

/// Raises a ridge across the flag line.
fn ridge(grid: &mut Grid, site: &Site, along: f64, top: f64) {
    let radius = length([RIDGE_FOOT, RIDGE_LENGTH[1]]);
    around(grid, site.on_axis(along), radius, |offset, height| {
        let across = dot(offset, [-site.axis[1], site.axis[0]]).abs();
        let rise = 1.0 - smooth(0.0, RIDGE_FOOT, dot(offset, site.axis).abs());
        let rise = rise * (1.0 - smooth(RIDGE_LENGTH[0], RIDGE_LENGTH[1], across));
        *height += rise * (top - *height).max(0.0);
    });
}

/// Raises the highest ground near the crossing until the whole range is about that of the reference.
fn guard_hill(grid: &mut Grid, site: &Site, rim: f64) {
    let lowest = grid.heights().iter().copied().fold(f64::INFINITY, f64::min);
    let (mut top, mut peak) = (f64::NEG_INFINITY, [0.0, 0.0]);
    around(grid, site.centre, 140.0, |offset, height| {
        if length(offset) >= 80.0 && *height > top {
            (top, peak) = (*height, offset);
        }
    });
    let target = (lowest + 70.0).clamp(rim + 16.0, rim + 37.0);
    let lift = (target - top).max(0.0);
    let peak = [site.centre[0] + peak[0], site.centre[1] + peak[1]];
    around(grid, peak, 64.0, |offset, height| *height += lift * (1.0 - smooth(0.0, 64.0, length(offset))));
}

/// Cuts the gorge, and fills what would be missing of its walls under the bridge.
fn gorge(grid: &mut Grid, site: &Site, rim: f64, draws: Draws) {
    let floor = rim - draws.uniform(GORGE, 24.0, 28.0);
    let walls = if draws.bits(GORGE + 1) & 1 == 0 { WALLS } else { [WALLS[1], WALLS[0]] };
    let swing = draws.uniform(GORGE + 2, 5.0, 10.0);
    let phase = draws.uniform(GORGE + 3, 0.0, std::f64::consts::TAU);
    let bend = |v: f64| swing * (libm::sin(v / 26.0 + phase) - libm::sin(phase));
    let across = [-site.bridge[1], site.bridge[0]];
    around(grid, site.centre, 170.0, |offset, height| {
        let (u, v) = (dot(offset, site.bridge), dot(offset, across));
        let from_axis = u - bend(v);
        let wall = walls[usize::from(from_axis > 0.0)];
        let wanted = (floor + wall * (from_axis.abs() - FLOOR).max(0.0)).min(rim);
        let cut = (*height - wanted).max(0.0)
            * (1.0 - smooth(64.0, 84.0, u.abs()))
            * (1.0 - smooth(96.0, 150.0, v.abs()));
        let fill = (wanted - *height).max(0.0)
            * (1.0 - smooth(64.0, 92.0, u.abs()))
            * (1.0 - smooth(24.0, 60.0, v.abs()));
        *height += fill - cut;
    });
}

/// Levels the ground at the ends of the bridge with its deck.
fn abutments(grid: &mut Grid, site: &Site, rim: f64) {
    for end in site.ends() {
        around(grid, end, ABUTMENT[1], |offset, height| {
            *height += (1.0 - smooth(ABUTMENT[0], ABUTMENT[1], length(offset))) * (rim - *height);
        });
    }
}

/// Gives what was edited the benches of the rest: a median of three along x.
fn same_texture(grid: &mut Grid, before: &[f64]) {
    let edited = grid.heights().to_vec();
    let heights = grid.heights_mut();
    for y in 0..SIDE {
        for x in 0..SIDE {
            let at = index(x, y);
            if (edited[at] - before[at]).abs() > 1e-6 {
                heights[at] = median3([edited[index(x + SIDE - 1, y)], edited[at], edited[index(x + 1, y)]]);
            }
        }
    }
}
