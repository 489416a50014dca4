//! Statistics of a terrain, and whether they make it "Raindance-like".
//!
//! Input is one tile of 256 x 256 heights in metres, row-major, rows of y (north), columns of x (east), 8 m apart
//! and repeated for ever; 257 x 257 heights are accepted whose last row and column repeat the first.
//! Means are plain averages, standard deviations population ones, percentiles linear between order statistics at
//! rank p/100 (n - 1). Every statistic is defined at the head of the file that measures it:
//!
//! | file | statistics |
//! |---|---|
//! | `heights` | spread of the heights |
//! | `texture` | level benches, pits, curvature: what no power spectrum shows |
//! | `slopes`, `creases` | triangles and the edges between them |
//! | `structure`, `spectrum` | height differences, wavelengths, autocorrelation |
//! | `legs` | descents along straight lines |
//! | `relief`, `descent` | hills, basins, the way of water |
//! | `mission` | flags, gorge, ridges, guard hill |
//!
//! `windows` has the accepted values. Five core statistics (`grad_cv`, `frac_lt5`, `lap_exkurt`, `pits_per_km2`,
//! `flat_edge_x`) see the benches that a matching power spectrum does not give; they are correlated, and are no
//! five independent proofs.
//!
//! Sums are added in a fixed order and functions are `libm`'s, so the values have the same bits on every machine.

mod creases;
mod descent;
pub mod fft;
pub mod grid;
mod heights;
mod legs;
pub(crate) mod mission;
mod order;
pub mod relief;
mod report;
mod slopes;
mod spectrum;
mod structure;
mod texture;
mod triangles;
pub mod windows;

pub use grid::{Error, Grid};
pub use report::{Report, Row};
pub use windows::{Group, WINDOWS, Window};

pub(crate) use report::{check, check_mission};

/// Measured values by name, in the order of measurement.
#[derive(Debug, Default)]
struct Values(Vec<(&'static str, f64)>);

impl Values {
    fn push(&mut self, name: &'static str, value: f64) {
        self.0.push((name, value));
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|(known, _)| *known == name).map(|&(_, value)| value)
    }
}
