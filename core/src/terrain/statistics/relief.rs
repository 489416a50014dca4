//! Hills and basins by topographic prominence, on the torus, with eight neighbours.
//!
//! A water level sinks from the top. Each island is born as a peak; where two islands join, at a saddle, the
//! one with the lower peak ends, and its prominence is its peak's height above the saddle. The highest peak
//! of all gets the full range. Of equal heights the one stored first counts as the higher. A hill is a peak of at least 10 m of prominence, a basin a hill of the negated heights.
//!
//! - `hills_per_km2`, `basins_per_km2`: how many.
//! - `hill_prom_median_m`: median prominence of the hills.
//! - `hill_nn_m`: mean distance from a hill to its nearest other, the shortest way round.

use super::Values;
use super::grid::{Grid, SIDE, SQUARE, index};
use super::order::{mean, ordered_bits, quantile};
use super::texture::TILE_KM2;

/// Least prominence of a hill or basin, metres.
const LEAST: f64 = 10.0;

/// A peak: where it stands (index of the sample) and its prominence in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Column of the sample.
    pub x: usize,
    /// Row of the sample.
    pub y: usize,
    /// Height above the saddle that joins it to higher ground, metres.
    pub prominence: f64,
}

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    let order = ascending(grid.heights());
    let basins = sweep(grid.heights(), &order);
    let hills = sweep(grid.heights(), &descending(grid.heights(), order));
    values.push("hills_per_km2", hills.len() as f64 / TILE_KM2);
    values.push("basins_per_km2", basins.len() as f64 / TILE_KM2);
    let prominences: Vec<f64> = hills.iter().map(|peak| peak.prominence).collect();
    values.push("hill_prom_median_m", quantile(&prominences, 0.5, |prominence| prominence));
    let nearest: Vec<f64> = (0..hills.len()).filter_map(|k| nearest(&hills, k)).collect();
    values.push("hill_nn_m", mean(&nearest));
}

/// All hills of at least 10 m of prominence, from the highest saddle to the lowest; the highest hill comes last.
#[must_use]
pub fn hills(grid: &Grid) -> Vec<Peak> {
    sweep(grid.heights(), &descending(grid.heights(), ascending(grid.heights())))
}

fn nearest(hills: &[Peak], k: usize) -> Option<f64> {
    let apart = |a: usize, b: usize| {
        let distance = a.abs_diff(b);
        distance.min(SIDE - distance)
    };
    let square = |other: &Peak| {
        let (dx, dy) = (apart(hills[k].x, other.x), apart(hills[k].y, other.y));
        dx * dx + dy * dy
    };
    let others = hills.iter().enumerate().filter(|&(other, _)| other != k);
    others.map(|(_, other)| square(other)).min().map(|least| SQUARE * (least as f64).sqrt())
}

/// Indices of the heights from the lowest to the highest, equal ones by index: a radix sort on the
/// order-preserving bits, which skips digits that are the same in all (most are, in quantised heights).
fn ascending(heights: &[f64]) -> Vec<u16> {
    const DIGIT: u32 = 11;
    let keys = heights.iter().map(|&height| ordered_bits(height));
    let mut items: Vec<(u64, u16)> = keys.zip(0..=u16::MAX).collect();
    let differing = items.iter().fold(0, |bits, item| bits | (item.0 ^ items[0].0));
    let mut spare = items.clone();
    for shift in (0..64).step_by(DIGIT as usize) {
        let digit = |key: u64| (key >> shift) as usize & ((1 << DIGIT) - 1);
        if digit(differing) == 0 {
            continue;
        }
        let mut starts = [0_u32; 1 << DIGIT];
        items.iter().for_each(|item| starts[digit(item.0)] += 1);
        let mut start = 0;
        for count in &mut starts {
            start += std::mem::replace(count, start);
        }
        for &item in &items {
            let place = &mut starts[digit(item.0)];
            spare[*place as usize] = item;
            *place += 1;
        }
        std::mem::swap(&mut items, &mut spare);
    }
    items.into_iter().map(|(_, k)| k).collect()
}

/// The same from the highest to the lowest, equal ones still by index.
fn descending(heights: &[f64], mut order: Vec<u16>) -> Vec<u16> {
    order.reverse();
    let height = |at: &u16| heights[usize::from(*at)];
    order.chunk_by_mut(|a, b| height(a) == height(b)).for_each(<[u16]>::reverse);
    order
}

/// Water that sinks from the top: `order` leads from the highest sample to the lowest (or from the lowest to
/// the highest, which makes basins of hills).
///
/// Each sample belongs to the peak that climbing to the highest neighbour leads to, so islands can only join
/// between neighbours of different peaks, when the lower of the two comes up. Looking at these pairs alone, in that order,
/// takes a third of the time of raising sample by sample.
fn sweep(heights: &[f64], order: &[u16]) -> Vec<Peak> {
    let mut rank = vec![0_u16; order.len()];
    for (time, &at) in order.iter().enumerate() {
        rank[usize::from(at)] = time as u16;
    }
    let summit = climb(&rank);
    // Islands are numbered in the order of their births, so the lower number is the higher peak.
    let mut islands = Islands::default();
    let mut island_of = vec![0_u16; order.len()];
    for (time, &at) in order.iter().enumerate() {
        let to = usize::from(summit[usize::from(at)]);
        island_of[usize::from(at)] =
            if to == time { islands.bear(at) } else { island_of[usize::from(order[to])] };
    }
    let mut hills = Vec::new();
    for (time, a, b) in borders(&rank, &island_of) {
        let saddle = heights[usize::from(order[usize::from(time)])];
        if let Some(ended) = islands.join(a, b) {
            let prominence = (heights[ended] - saddle).abs();
            if prominence >= LEAST {
                hills.push(peak(ended, prominence));
            }
        }
    }
    let (highest, lowest) = (usize::from(order[0]), usize::from(order[order.len() - 1]));
    let range = (heights[highest] - heights[lowest]).abs();
    if range >= LEAST {
        hills.push(peak(highest, range));
    }
    hills
}

/// The lowest rank among a sample and its eight neighbours.
fn climb(rank: &[u16]) -> Vec<u16> {
    let row = |y: usize| &rank[(y % SIDE) * SIDE..][..SIDE];
    let mut summit = vec![0_u16; rank.len()];
    let mut lowest = [0_u16; SIDE + 2];
    for y in 0..SIDE {
        let (south, here, north) = (row(y + SIDE - 1), row(y), row(y + 1));
        for x in 0..SIDE {
            lowest[x + 1] = south[x].min(here[x]).min(north[x]);
        }
        lowest[0] = lowest[SIDE];
        lowest[SIDE + 1] = lowest[1];
        for (x, summit) in summit[y * SIDE..][..SIDE].iter_mut().enumerate() {
            *summit = lowest[x].min(lowest[x + 1]).min(lowest[x + 2]);
        }
    }
    summit
}

/// Pairs of neighbours on different islands, as (rank of the later, island, island), by rank.
fn borders(rank: &[u16], island_of: &[u16]) -> Vec<(u16, u16, u16)> {
    let mut pairs = Vec::with_capacity(rank.len());
    for y in 0..SIDE {
        for x in 0..SIDE {
            let here = index(x, y);
            let others = [index(x + 1, y), index(x + SIDE - 1, y + 1), index(x, y + 1), index(x + 1, y + 1)];
            let own = island_of[here];
            if others.iter().all(|&other| island_of[other] == own) {
                continue;
            }
            for other in others {
                if island_of[other] != own {
                    pairs.push((rank[here].max(rank[other]), own, island_of[other]));
                }
            }
        }
    }
    // A counting sort: ranks are small whole numbers.
    let mut starts = vec![0_u32; rank.len() + 1];
    pairs.iter().for_each(|pair| starts[usize::from(pair.0) + 1] += 1);
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut sorted = vec![(0, 0, 0); pairs.len()];
    for pair in pairs {
        let start = &mut starts[usize::from(pair.0)];
        sorted[*start as usize] = pair;
        *start += 1;
    }
    sorted
}

fn peak(at: usize, prominence: f64) -> Peak {
    Peak { x: at % SIDE, y: at / SIDE, prominence }
}

/// Which islands have joined: union-find over their numbers.
#[derive(Default)]
struct Islands {
    /// The sample that each was born at. Samples that are peaks do not touch: there are 16,384 at most.
    peaks: Vec<u16>,
    /// An island that it has joined, or itself.
    joined: Vec<u16>,
}

impl Islands {
    fn bear(&mut self, at: u16) -> u16 {
        let number = self.joined.len() as u16;
        self.peaks.push(at);
        self.joined.push(number);
        number
    }

    /// Joins two islands; the sample of the peak that ends, unless they were one already.
    fn join(&mut self, a: u16, b: u16) -> Option<usize> {
        let (a, b) = (self.root(a), self.root(b));
        let (higher, lower) = (a.min(b), a.max(b));
        self.joined[usize::from(lower)] = higher;
        (higher != lower).then(|| usize::from(self.peaks[usize::from(lower)]))
    }

    fn root(&mut self, mut k: u16) -> u16 {
        while self.joined[usize::from(k)] != k {
            let above = self.joined[usize::from(self.joined[usize::from(k)])];
            self.joined[usize::from(k)] = above;
            k = above;
        }
        k
    }
}
