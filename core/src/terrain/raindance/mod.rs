//! Raindance-like terrain and its mission, generated from a seed.
//!
//! "Raindance-like" is a checkable claim: a terrain may be called so when all 20 core and all 14 mission
//! statistics of [`statistics`](super::statistics) lie in their windows, at most 2 of the 17 supporting ones do
//! not, and opposite edges are equal bit for bit. The windows are centred on one reference map. Its heights are
//! private, are not in this repository and were not used to build the generator: only statistics of them were.
//!
//! # How
//!
//! 1. `spectrum`: hills and detail by spectral synthesis with random phases. The reference has no relief longer than its
//!    512 m cell, most of it at 125 to 240 m and a steep fall below. The shares of three bands of wavelengths are
//!    pinned, because a cell has so few long modes that seeds would wander out of the windows.
//! 2. `benches`: a running median along x, of 5 samples or of 9 as a smooth second field has it. It makes the dead-level
//!    east-west edges, the steep flanks between them and the many tiny pits that no spectrum gives. Then the
//!    mean and the standard deviation are set, and extreme heights drawn in.
//! 3. `sites`: natural crossings are looked for, with both ends of a bridge about 22 m above its middle, and a line of
//!    flags through each, on level ground in hollows. The landscape has no edges, so it is then moved until the
//!    middle between the flags is the middle of the tile.
//! 4. `edits`: what the makers of the reference did by hand. Hollows for the bases, two ridges that hide the flags from
//!    each other, a guard hill, the gorge and its abutments, and a median along x on all this, for the same texture.
//! 5. Heights are rounded to 1/64 m and only then measured, since rounding moves the share of level edges.
//!    A draw that misses a window is thrown away, and the next counter drawn. A site whose mission misses costs only the
//!    next best site.
//!
//! # Limits
//!
//! - Windows around one map say nothing of how maps of that kind vary. Generated terrains vary less in some statistics than
//!   different maps by one author would, and more in none: they are held in windows.
//! - A repeated cell matches its statistics more loosely (about one draw in ten is thrown away) than the default
//!   tile, which has sixteen times the modes: so its terrains are statistically more alike.
//! - Autocorrelation lengths lie in the lower third of their windows, the share of slopes above 30 degrees in the upper third.
//! - No bases, trees or other shapes; the rims of the gorge are equally high within centimetres, those of the
//!   reference differ by 2 m.
//!
//! # Same bits
//!
//! Square roots, divisions, products and sums are IEEE's, in one fixed order; cosines, exponentials and the
//! like are the `libm` crate's, never the platform's; nothing is fused. So heights have the same bits on every machine, at
//! every optimisation level and on any number of threads (digests of some are committed).

mod benches;
mod draws;
mod edits;
mod sites;
mod spectrum;

use super::mission::{Area, Bridge, Mission};
use super::statistics::grid::{Grid, SIDE, SQUARE};
use super::statistics::{check, check_mission};
use crate::float_environment::DefaultFloats;
use draws::Draws;
use sites::Site;
use std::fmt;

/// How many draws are tried before a seed is given up.
pub const MAX_DRAWS: u32 = 64;
/// Heights are whole multiples of this, metres: exact in `f32`, and small in a file.
pub const QUANTUM: f64 = 1.0 / 64.0;
/// Standard deviation and mean of the heights before the mission's edits, metres.
const DEVIATION: f64 = 10.8;
const MEAN: f64 = 35.6;
/// Heights further from the mean than this are drawn towards it, metres, and end at most so much further out. A
/// tile holds sixteen times the ground of the reference's cell and so would have higher peaks and deeper
/// pits; levels stay levels, and the percentiles that are measured lie within.
const TAMED_FROM: f64 = 26.0;
const TAMED_BY: f64 = 14.0;
/// How many sites of one landscape are tried.
const SITES: usize = 6;

/// What kind of terrain to generate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Lay one 512 m cell 4 x 4 before the mission's edits, as the original does. By default the whole 2,048 m
    /// tile is one landscape with the same statistics: more of it for an agent to learn from.
    pub repeating: bool,
}

/// A generated terrain.
#[derive(Clone, Debug, PartialEq)]
pub struct Generated {
    /// 257 x 257 heights in metres, row-major, rows of y (north), columns of x (east), 8 m apart from (-1024, -1024) on;
    /// multiples of [`QUANTUM`], none below zero, the last row and column equal to the first.
    pub heights: Vec<f64>,
    /// The mission, near the middle of the tile.
    pub mission: Mission,
    /// How many draws were thrown away because a statistic was outside its window.
    pub draws: u32,
}

/// Why there is no terrain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// None of [`MAX_DRAWS`] draws met the windows.
    Exhausted {
        /// The seed that was asked for.
        seed: u64,
        /// What was outside its window in the last of them.
        missed: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Exhausted { seed, missed } = self;
        write!(
            f,
            "seed {seed}: none of {MAX_DRAWS} draws was Raindance-like (the last one missed {missed}); use another seed"
        )
    }
}

impl std::error::Error for Error {}

/// Generates the terrain of a seed: the same bits on every machine and every run.
///
/// # Errors
/// [`Error::Exhausted`] if every draw misses a window. Of the seeds tried so far none comes near.
pub fn generate(seed: u64, options: Options) -> Result<Generated, Error> {
    let _floats = DefaultFloats::enter();
    let mut missed = "every draw";
    for attempt in 0..MAX_DRAWS {
        match draw(Draws { seed, attempt }, options) {
            Ok((grid, mission)) => return Ok(Generated { heights: grid.closed(), mission, draws: attempt }),
            Err(name) => missed = name,
        }
    }
    Err(Error::Exhausted { seed, missed })
}

/// One draw, or the first statistic found outside its window.
fn draw(draws: Draws, options: Options) -> Result<(Grid, Mission), &'static str> {
    let mut base = spectrum::base(draws, options.repeating);
    benches::cut(&mut base);
    let natural = lay(base.side, &base.heights);
    let mut missed = "every site";
    for site in sites::search(&natural, draws, options.repeating).into_iter().take(SITES) {
        let (mut grid, site) = centred(&natural, site);
        edits::apply(&mut grid, &site, draws);
        quantise(&mut grid);
        let mission = mission(&grid, &site);
        if let Err(name) = check_mission(&grid, &mission) {
            missed = name;
            continue;
        }
        return check(&grid, options.repeating).map(|()| (grid, mission));
    }
    Err(missed)
}

/// Lays a cell over the tile, with the mean and the standard deviation of the reference.
fn lay(side: usize, cell: &[f64]) -> Grid {
    let count = cell.len() as f64;
    let mean = cell.iter().sum::<f64>() / count;
    let variance = cell.iter().map(|height| (height - mean) * (height - mean)).sum::<f64>() / count;
    let scale = DEVIATION / variance.sqrt();
    let tamed = |height: f64| {
        let deviation = scale * (height - mean);
        let excess = (deviation.abs() - TAMED_FROM).max(0.0);
        MEAN + deviation - (excess - excess / (1.0 + excess / TAMED_BY)).copysign(deviation)
    };
    let cell: Vec<f64> = cell.iter().map(|&height| tamed(height)).collect();
    Grid::from_square((0..SIDE * SIDE).map(|k| cell[k / SIDE % side * side + k % SIDE % side]).collect())
}

/// Moves the landscape, which has no edges, so that the middle between the flags comes to the middle of the tile.
/// By an even number of squares, so that the same squares are cut the same way.
fn centred(grid: &Grid, mut site: Site) -> (Grid, Site) {
    let [from, to] = site.flags();
    let mut moved = [0_i64; 2];
    for axis in 0..2 {
        let middle = 0.5 * (from[axis] + to[axis]);
        moved[axis] = 2 * (middle / (2.0 * SQUARE) + 0.5).floor() as i64;
        site.centre[axis] -= SQUARE * moved[axis] as f64;
    }
    let at = |k: usize| {
        grid.at(
            (k % SIDE).wrapping_add_signed(moved[0] as isize),
            (k / SIDE).wrapping_add_signed(moved[1] as isize),
        )
    };
    (Grid::from_square((0..SIDE * SIDE).map(at).collect()), site)
}

/// Rounds heights to whole quanta, and lifts the tile if any of it lies below zero.
fn quantise(grid: &mut Grid) {
    let round = |height: f64| (height / QUANTUM + 0.5).floor();
    let lowest = grid.heights().iter().copied().fold(f64::INFINITY, f64::min);
    let lift = (-round(lowest)).max(0.0);
    grid.heights_mut().iter_mut().for_each(|height| *height = (round(*height) + lift) * QUANTUM);
}

fn mission(grid: &Grid, site: &Site) -> Mission {
    let grounded = |point: [f64; 2]| [point[0], point[1], grid.ground(point)];
    let flags = site.flags().map(grounded);
    let ends = site.ends().map(grounded);
    // The lower end decides: a step up from the ground to the deck would stop a skier, one down does not.
    let deck_top = ends[0][2].min(ends[1][2]);
    let bridge =
        Bridge { centre: [site.centre[0], site.centre[1], deck_top], ends, width: Bridge::WIDTH, deck_top };
    let middle = [0.5 * (flags[0][0] + flags[1][0]), 0.5 * (flags[0][1] + flags[1][1])];
    Mission { flags, bridge, area: Area::centred(middle) }
}
