//! Descents along straight lines over the terrain.
//!
//! Each of the 256 rows and 256 columns is a closed profile, walked once round from its highest sample (the
//! first if several) back to it. Tops and bottoms alternate: a lowest sample becomes a bottom once the profile
//! is 3 m above it, a highest one a top once the profile is 3 m below it; the start is a top. A leg
//! leads from a top to the next bottom.
//!
//! - `crest_spacing_m`: length of all profiles, 512 x 2048 m, over the number of legs.
//! - `leg_drop_mean_m`, `leg_drop_p90_m`: mean and 90th percentile of their drops.

use super::Values;
use super::grid::{Grid, SIDE, TILE};
use super::order::{mean, quantile};

/// A profile must turn back by this much before a turning point counts, metres.
pub(super) const REVERSAL: f64 = 3.0;

pub(super) fn measure(grid: &Grid, values: &mut Values) {
    let mut drops = Vec::with_capacity(8192);
    let mut column = [0.0; SIDE];
    for k in 0..SIDE {
        closed_profile(grid.row(k), &mut drops);
        for (y, height) in column.iter_mut().enumerate() {
            *height = grid.at(k, y);
        }
        closed_profile(&column, &mut drops);
    }
    values.push("crest_spacing_m", 2.0 * SIDE as f64 * TILE / drops.len() as f64);
    values.push("leg_drop_mean_m", mean(&drops));
    values.push("leg_drop_p90_m", quantile(&drops, 0.9, |drop| drop));
}

/// Adds the drops of a closed profile's legs.
fn closed_profile(profile: &[f64], drops: &mut Vec<f64>) {
    let start = (0..profile.len()).fold(0, |best, k| if profile[k] > profile[best] { k } else { best });
    let (mut top, mut low, mut falling) = (profile[start], profile[start], true);
    let round = profile[start..].iter().chain(&profile[..=start]);
    for &height in round {
        if falling {
            low = low.min(height);
            if height - low >= REVERSAL {
                drops.push(top - low);
                top = height;
                falling = false;
            }
        } else {
            top = top.max(height);
            if top - height >= REVERSAL {
                low = height;
                falling = true;
            }
        }
    }
}
