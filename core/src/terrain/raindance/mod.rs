//! Raindance-like terrain and its mission, generated from a seed.

mod benches;
mod draws;
mod edits;
mod sites;
mod spectrum;

use super::mission::{Area, Bridge, Mission};
use super::statistics::grid::{Grid, SIDE, SQUARE};
use super::statistics::{check, check_mission};
use draws::Draws;
use sites::Site;
use std::fmt;

/// How many draws are tried before a seed is given up.
pub const MAX_DRAWS: u32 = 64;
/// Heights are whole multiples of this, metres: exact in `f32`, and small in a file.
pub const QUANTUM: f64 = 1.0 / 64.0;
/// Standard deviation and mean of the heights before the mission's edits, metres.
const DEVIATION: f64 = 10.74;
const MEAN: f64 = 35.6;
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
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Exhausted { seed } = self;
        write!(f, "seed {seed}: none of {MAX_DRAWS} draws was Raindance-like; use another seed")
    }
}

impl std::error::Error for Error {}

/// Generates the terrain of a seed: the same bits on every machine and every run.
///
/// # Errors
/// [`Error::Exhausted`] if every draw misses a window. Of the seeds tried so far none comes near.
pub fn generate(seed: u64, options: Options) -> Result<Generated, Error> {
    for attempt in 0..MAX_DRAWS {
        match draw(Draws { seed, attempt }, options) {
            Ok((grid, mission)) => return Ok(Generated { heights: grid.closed(), mission, draws: attempt }),
            Err(reason) => {
                if std::env::var_os("RDBG").is_some() {
                    eprintln!("{seed} {attempt} {reason}")
                }
            }
        }
    }
    Err(Error::Exhausted { seed })
}

/// One draw, or the first statistic found outside its window.
fn draw(draws: Draws, options: Options) -> Result<(Grid, Mission), &'static str> {
    let mut base = spectrum::base(draws, options.repeating);
    benches::cut(&mut base);
    let natural = lay(base.side, &base.heights);
    let mut reason = "no site";
    for site in sites::search(&natural, draws, options.repeating).into_iter().take(SITES) {
        let (mut grid, site) = centred(&natural, site);
        edits::apply(&mut grid, &site, draws);
        quantise(&mut grid);
        let mission = mission(&grid, &site);
        if let Err(missed) = check_mission(&grid, &mission) {
            if std::env::var_os("RDBG").is_some() {
                eprintln!("   site {missed}");
            }
            reason = missed;
            continue;
        }
        return check(&grid, options.repeating).map(|()| (grid, mission));
    }
    Err(reason)
}

/// Lays a cell over the tile, with the mean and the standard deviation of the reference.
fn lay(side: usize, cell: &[f64]) -> Grid {
    let count = cell.len() as f64;
    let mean = cell.iter().sum::<f64>() / count;
    let variance = cell.iter().map(|height| (height - mean) * (height - mean)).sum::<f64>() / count;
    let scale = DEVIATION / variance.sqrt();
    let at = |k: usize| cell[k / SIDE % side * side + k % SIDE % side];
    Grid::from_square((0..SIDE * SIDE).map(|k| MEAN + scale * (at(k) - mean)).collect())
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
/// scratch
pub fn time_stages() {
    let t = |n: &str, f: &mut dyn FnMut()| {
        let mut m = f64::INFINITY;
        for _ in 0..40 {
            let t = std::time::Instant::now();
            f();
            m = m.min(t.elapsed().as_secs_f64() * 1e3);
        }
        println!("{n} {m:.3} ms");
    };
    let d = Draws { seed: 1, attempt: 0 };

    t("base", &mut || {
        std::hint::black_box(spectrum::base(d, false));
    });
    let mut base = spectrum::base(d, false);
    t("bench", &mut || {
        benches::cut(&mut base);
    });
    let mut base = spectrum::base(d, false);
    benches::cut(&mut base);
    t("lay", &mut || {
        std::hint::black_box(lay(base.side, &base.heights));
    });
    let n = lay(base.side, &base.heights);
    t("sites", &mut || {
        std::hint::black_box(sites::search(&n, d, false));
    });
    let s = sites::search(&n, d, false)[0];
    t("centred", &mut || {
        std::hint::black_box(centred(&n, s));
    });
    let (mut g, s) = centred(&n, s);
    let g0 = g.clone();
    t("edits", &mut || {
        g = g0.clone();
        edits::apply(&mut g, &s, d)
    });
    t("quantise", &mut || quantise(&mut g));
    t("mission", &mut || std::hint::black_box(check_mission(&g, &mission(&g, &s))).unwrap());
    t("check", &mut || std::hint::black_box(check(&g, false)).unwrap());
}
