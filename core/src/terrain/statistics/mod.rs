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
/// scratch
pub fn time_stages(h: &[f64]) {
    let (g, _) = Grid::read(h).unwrap();
    let mut v = Values::default();
    let t = |n: &str, f: &mut dyn FnMut()| {
        let mut m = f64::INFINITY;
        for _ in 0..40 {
            let t = std::time::Instant::now();
            f();
            m = m.min(t.elapsed().as_secs_f64() * 1e3);
        }
        println!("{n} {m:.3} ms");
    };
    t("texture", &mut || texture::measure(&g, &mut v));
    t("heights", &mut || heights::measure(&g, &mut v));
    t("structure", &mut || structure::measure(&g, &mut v));
    t("slopes", &mut || slopes::measure(&g, &mut v));
    t("creases", &mut || creases::measure(&g, &mut v));
    t("legs", &mut || legs::measure(&g, &mut v));
    t("spectrum", &mut || {
        spectrum::measure(&g, &mut v);
    });
    t("descent", &mut || descent::measure(&g, &mut v));
    t("relief", &mut || relief::measure(&g, &mut v));
}
