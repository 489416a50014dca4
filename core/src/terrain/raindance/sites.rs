//! Where the mission fits: natural crossings for the bridge, and a line of flags through them.

use super::draws::{Draws, MISSION};
use crate::terrain::mission::Bridge;
use crate::terrain::statistics::grid::{Grid, ORIGIN, SIDE, SQUARE};
use crate::terrain::statistics::mission::{PAD, plane};

/// A place for the bridge and the flags, in world coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    /// Under the middle of the bridge.
    pub centre: [f64; 2],
    /// Unit vector along the bridge.
    pub bridge: [f64; 2],
    /// Unit vector from flag 0 to flag 1.
    pub axis: [f64; 2],
    /// Distances of the flags from the centre, metres.
    pub reach: [f64; 2],
    cost: f64,
}

impl Site {
    /// The point `along` metres from the centre towards flag 1.
    pub fn on_axis(&self, along: f64) -> [f64; 2] {
        [self.centre[0] + along * self.axis[0], self.centre[1] + along * self.axis[1]]
    }

    /// Where flags 0 and 1 stand.
    pub fn flags(&self) -> [[f64; 2]; 2] {
        [self.on_axis(-self.reach[0]), self.on_axis(self.reach[1])]
    }

    /// Where the bridge ends.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        [-0.5, 0.5].map(|half| {
            let along = half * Bridge::LENGTH;
            [self.centre[0] + along * self.bridge[0], self.centre[1] + along * self.bridge[1]]
        })
    }
}

/// Height of the bridge's ends above its centre that is looked for, metres. The edits add the rest of the gorge.
const RISE: f64 = 22.0;
/// Ground at the ends that is looked for, metres: a little above the mean.
const RIM: f64 = 43.0;
/// How far apart the tried crossings are at least, squares.
const APART: usize = 6;
/// Directions of a crossing that are tried, in half a turn.
const DIRECTIONS: u32 = 12;
/// How many crossings are looked at more closely.
const CROSSINGS: usize = 12;

#[derive(Clone, Copy)]
struct Crossing {
    x: usize,
    y: usize,
    direction: u32,
    cost: f64,
}

/// The best sites, best first: at most one per crossing.
pub(super) fn search(grid: &Grid, draws: Draws, repeating: bool) -> Vec<Site> {
    let mut sites: Vec<Site> = crossings(grid, repeating)
        .iter()
        .zip(0..)
        .map(|(crossing, k)| flag_line(grid, draws, crossing, k))
        .collect();
    sites.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    sites
}

fn direction(turn: f64) -> [f64; 2] {
    [libm::cos(turn), libm::sin(turn)]
}

fn squares(offset: f64) -> usize {
    // Modulo 256; libm's rint has no say over the platform's rounding mode, floor does the same everywhere.
    (offset / SQUARE + 0.5).floor() as i64 as usize & (SIDE - 1)
}

fn crossings(grid: &Grid, repeating: bool) -> Vec<Crossing> {
    let (side, stride) = if repeating { (SIDE / 4, 2) } else { (SIDE, 4) };
    let turns: Vec<_> = (0..DIRECTIONS)
        .map(|k| {
            let [cos, sin] = direction(std::f64::consts::PI * f64::from(k) / f64::from(DIRECTIONS));
            let end = 0.5 * Bridge::LENGTH;
            (k, squares(end * cos), squares(end * sin))
        })
        .collect();
    let mut found = Vec::new();
    for y in (0..side).step_by(stride) {
        for x in (0..side).step_by(stride) {
            let centre = grid.at(x, y);
            let cost = |&(direction, dx, dy): &(u32, usize, usize)| {
                let ends = [grid.at(x + dx, y + dy), grid.at(x + SIDE - dx, y + SIDE - dy)];
                // A quarter turn further lies the gorge, which must lead somewhere.
                let sides = [grid.at(x + SIDE - dy, y + dx), grid.at(x + dy, y + SIDE - dx)];
                let rises = ends.map(|end| (end - centre - RISE).abs());
                let open = sides.map(|side| (side - centre - 4.0).max(0.0));
                let rim = (0.5 * (ends[0] + ends[1]) - RIM).abs();
                let rim = rim + 2.0 * (rim - 6.0).max(0.0);
                let cost = rises[0] + rises[1] + (ends[0] - ends[1]).abs() + 0.5 * (open[0] + open[1]) + rim;
                Crossing { x, y, direction, cost }
            };
            let best = turns.iter().map(cost).reduce(|a, b| if b.cost < a.cost { b } else { a });
            found.extend(best);
        }
    }
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut chosen: Vec<Crossing> = Vec::new();
    for crossing in found {
        let close = |other: &Crossing| {
            let apart = |a: usize, b: usize| a.abs_diff(b).min(side - a.abs_diff(b));
            apart(crossing.x, other.x) < APART && apart(crossing.y, other.y) < APART
        };
        if !chosen.iter().any(close) {
            chosen.push(crossing);
            if chosen.len() == CROSSINGS {
                break;
            }
        }
    }
    chosen
}

/// The best line of flags through a crossing.
fn flag_line(grid: &Grid, draws: Draws, crossing: &Crossing, number: u32) -> Site {
    let turn = std::f64::consts::PI * f64::from(crossing.direction) / f64::from(DIRECTIONS);
    let centre = [ORIGIN + SQUARE * crossing.x as f64, ORIGIN + SQUARE * crossing.y as f64];
    let bridge = direction(turn);
    // A little of its own for each crossing, so that lines do not fall into ever the same directions.
    let skew = draws.uniform(MISSION + number, -0.5, 0.5);
    let mut best: Option<Site> = None;
    for step in -9..=9 {
        let angle = turn + (f64::from(step) + skew).clamp(-9.0, 9.0) * (std::f64::consts::PI / 36.0);
        for axis in [direction(angle), direction(angle).map(|c| -c)] {
            let pads = |least: f64, sign: f64| {
                [0.0, 8.0, 16.0, 24.0, 32.0].map(|more| {
                    let reach = least + more;
                    let flag = [centre[0] + sign * reach * axis[0], centre[1] + sign * reach * axis[1]];
                    (reach, stand(grid, flag))
                })
            };
            let ridges: f64 = [-100.0, 100.0]
                .iter()
                .map(|along| grid.ground([centre[0] + along * axis[0], centre[1] + along * axis[1]]))
                .map(|height| (RIM + 6.0 - height).max(0.0))
                .sum();
            let (near, far) = (pads(272.0, -1.0), pads(328.0, 1.0));
            for first in &near {
                for second in &far {
                    let unlike = ((first.1.height - second.1.height).abs() - 8.0).max(0.0);
                    let cost = crossing.cost + first.1.cost + second.1.cost + 0.5 * unlike + 0.2 * ridges;
                    if best.is_none_or(|best| cost < best.cost) {
                        best = Some(Site { centre, bridge, axis, reach: [first.0, second.0], cost });
                    }
                }
            }
        }
    }
    best.expect("more than one line was tried")
}

struct Stand {
    height: f64,
    cost: f64,
}

/// How well a flag would stand somewhere: on level and even ground, in a hollow.
fn stand(grid: &Grid, flag: [f64; 2]) -> Stand {
    let (x, y) = (squares(flag[0] - ORIGIN), squares(flag[1] - ORIGIN));
    let heights =
        PAD.map(|(dx, dy)| grid.at(x.wrapping_add_signed(dx as isize), y.wrapping_add_signed(dy as isize)));
    let pad = plane(heights);
    let cost = 3.0 * (pad.residual - 1.5).max(0.0)
        + 60.0 * (pad.slope - 0.15).max(0.0)
        + 0.3 * (pad.mean - 26.0).max(0.0);
    Stand { height: pad.mean, cost }
}
