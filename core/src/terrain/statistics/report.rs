//! All statistics of a terrain beside their windows, and the verdict.

use super::grid::{Error, Grid};
use super::windows::{Group, MAX_SUPPORTING_OUTSIDE, REPETITION_MIN, WINDOWS};
use super::{Values, creases, descent, heights, legs, relief, slopes, spectrum, structure, texture};
use crate::terrain::mission::Mission;

/// One statistic beside its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Name of the statistic.
    pub name: &'static str,
    /// What happens when it is outside.
    pub group: Group,
    /// Its value; NaN where it is not defined (the spectrum of level ground).
    pub value: f64,
    /// Value of the reference map.
    pub reference: f64,
    /// Least accepted value.
    pub min: f64,
    /// Greatest accepted value.
    pub max: f64,
    /// Whether the value is accepted.
    pub inside: bool,
}

/// The statistics of one terrain.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// In the order of [`WINDOWS`]; without rows of the group `Mission` if no mission was given.
    pub rows: Vec<Row>,
    /// Whether opposite edges are equal bit for bit, so that tiles meet without a step.
    pub seamless: bool,
    /// Autocorrelation at a lag of 512 m, the lower of east and north. It is 1 for a repeated 512 m cell, and
    /// has a window only for terrain that claims to be one: see [`Report::repeats`].
    pub repetition: f64,
}

impl Report {
    /// Measures 256 x 256 or 257 x 257 heights (metres, row-major, rows of y), and the mission's ground if
    /// there is one.
    ///
    /// # Errors
    /// [`Error`] if there are neither that many heights, or one of them is not finite.
    pub fn of(heights: &[f64], mission: Option<&Mission>) -> Result<Self, Error> {
        let (grid, seamless) = Grid::read(heights)?;
        let mut values = Values::default();
        let mut repetition = f64::NAN;
        for stage in STAGES {
            stage(&grid, &mut values, &mut repetition);
        }
        if let Some(mission) = mission {
            super::mission::measure(&grid, mission, &mut values);
        }
        Ok(Self { rows: rows(&values), seamless, repetition })
    }

    /// The value of a statistic, if it was measured.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.rows.iter().find(|row| row.name == name).map(|row| row.value)
    }

    /// How many statistics of a group are outside their windows.
    #[must_use]
    pub fn outside(&self, group: Group) -> usize {
        self.rows.iter().filter(|row| row.group == group && !row.inside).count()
    }

    /// Whether the terrain and its mission are Raindance-like: every core and every mission statistic
    /// inside its window, at most two supporting ones outside, and no step at the edges. False without a mission.
    #[must_use]
    pub fn passes(&self) -> bool {
        let has_mission = self.rows.iter().any(|row| row.group == Group::Mission);
        has_mission && self.outside(Group::Mission) == 0 && self.passes_without_mission()
    }

    /// The same of the heightfield alone: core, supporting and edges, whatever the mission.
    #[must_use]
    pub fn passes_without_mission(&self) -> bool {
        self.seamless
            && self.outside(Group::Core) == 0
            && self.outside(Group::Supporting) <= MAX_SUPPORTING_OUTSIDE
    }

    /// Whether the terrain may claim to repeat a 512 m cell.
    #[must_use]
    pub fn repeats(&self) -> bool {
        self.repetition >= REPETITION_MIN
    }
}

type Stage = fn(&Grid, &mut Values, &mut f64);

/// Everything that is measured without a mission, what is cheap and likely to be outside first.
const STAGES: [Stage; 7] = [
    |grid, values, _| texture::measure(grid, values),
    |grid, values, _| heights::measure(grid, values),
    |grid, values, _| structure::measure(grid, values),
    |grid, values, _| slopes::measure(grid, values),
    |grid, values, _| legs::measure(grid, values),
    |grid, values, repetition| *repetition = spectrum::measure(grid, values),
    |grid, values, _| {
        creases::measure(grid, values);
        descent::measure(grid, values);
        relief::measure(grid, values);
    },
];

fn rows(values: &Values) -> Vec<Row> {
    let row = |value: f64, window: &super::Window| Row {
        name: window.name,
        group: window.group,
        value,
        reference: window.reference,
        min: window.min,
        max: window.max,
        inside: window.contains(value),
    };
    WINDOWS.iter().filter_map(|window| values.get(window.name).map(|value| row(value, window))).collect()
}

/// [`Report::passes`] for the generator, which wants to know early: whether the terrain passes, measured only as
/// far as it takes to know. With `repeating`, it must repeat a 512 m cell too. Else the first reason found, for statistics
/// of the generator itself.
pub(crate) fn check(grid: &Grid, repeating: bool) -> Result<(), &'static str> {
    let mut values = Values::default();
    let mut repetition = f64::NAN;
    for stage in STAGES {
        stage(grid, &mut values, &mut repetition);
        let rows = rows(&values);
        let outside = |group: Group| rows.iter().filter(move |row| row.group == group && !row.inside);
        if let Some(row) = outside(Group::Core).next() {
            return Err(row.name);
        }
        if let Some(row) = outside(Group::Supporting).nth(MAX_SUPPORTING_OUTSIDE) {
            return Err(row.name);
        }
    }
    if repeating && repetition < REPETITION_MIN { Err("repetition") } else { Ok(()) }
}

/// Whether the mission's ground passes; else the first statistic that is outside.
pub(crate) fn check_mission(grid: &Grid, mission: &Mission) -> Result<(), &'static str> {
    let mut values = Values::default();
    super::mission::measure(grid, mission, &mut values);
    rows(&values).iter().find(|row| !row.inside).map_or(Ok(()), |row| Err(row.name))
}
