//! Means, moments and order statistics, in one fixed order of addition.

/// Plain average; NaN of nothing.
pub(super) fn mean(values: &[f64]) -> f64 {
    sum(values, |value| value) / values.len() as f64
}

/// Sum of `f` over the values, in eight interleaved partial sums: fixed order, yet vectorisable.
pub(super) fn sum(values: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    let mut parts = [0.0; 8];
    let chunks = values.chunks_exact(8);
    let rest = chunks.remainder();
    for chunk in chunks {
        for lane in 0..8 {
            parts[lane] += f(chunk[lane]);
        }
    }
    for (lane, &value) in rest.iter().enumerate() {
        parts[lane] += f(value);
    }
    ((parts[0] + parts[4]) + (parts[1] + parts[5])) + ((parts[2] + parts[6]) + (parts[3] + parts[7]))
}

/// Mean and population standard deviation.
pub(super) fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let mean = mean(values);
    let variance = sum(values, |value| (value - mean) * (value - mean)) / values.len() as f64;
    (mean, variance.sqrt())
}

/// The lowest and the highest value.
pub(super) fn extremes(values: &[f64]) -> (f64, f64) {
    // Plain comparisons, one instruction each, in lanes; `f64::min` looks for NaN first.
    let mut lanes = [(f64::INFINITY, f64::NEG_INFINITY); 8];
    let (chunks, rest) = values.as_chunks::<8>();
    let see = |lane: &mut (f64, f64), value: f64| {
        lane.0 = if value < lane.0 { value } else { lane.0 };
        lane.1 = if value > lane.1 { value } else { lane.1 };
    };
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, &value)| see(lane, value));
    }
    rest.iter().for_each(|&value| see(&mut lanes[0], value));
    lanes.iter().fold(lanes[0], |all, lane| (all.0.min(lane.0), all.1.max(lane.1)))
}

/// Bits that are ordered as the numbers are; equal ones (0 and -0 too) have equal bits.
pub(super) fn ordered_bits(value: f64) -> u64 {
    let bits = (value + 0.0).to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

/// Quantiles of `values` after `f`, each linear between the order statistics around rank
/// `share * (n - 1)`. `f` must not decrease, so that two values need it instead of all. NaN of nothing.
///
/// Counts the values in equal bins first and sorts only the bins looked for: on 196,608 creases a fifth
/// of the time of two selections.
pub(super) fn quantiles<const N: usize>(
    values: &[f64],
    shares: [f64; N],
    f: impl Fn(f64) -> f64,
) -> [f64; N] {
    const BINS: usize = 2048;
    let Some(last) = values.len().checked_sub(1) else { return [f64::NAN; N] };
    let (low, high) = extremes(values);
    // Subtracting, scaling and rounding never reverse two values, so bins are ordered as values are. Adding
    // 2^52 rounds to a whole number and leaves it in the lowest bits. What is not a number falls into the last bin.
    const ROUNDER: f64 = 4_503_599_627_370_496.0;
    let scale = (BINS - 1) as f64 / (high - low);
    let place = |value: f64| ((value - low) * scale).min((BINS - 1) as f64) + ROUNDER;
    let mut counts = [0_u32; BINS];
    values.iter().for_each(|&value| counts[place(value).to_bits() as usize % BINS] += 1);
    shares.map(|share| {
        let rank = share * last as f64;
        let below = rank.floor() as usize;
        let above = (below + 1).min(last);
        let (mut skipped, mut first) = (0, 0);
        while skipped + counts[first] as usize <= below {
            skipped += counts[first] as usize;
            first += 1;
        }
        let (mut seen, mut end) = (skipped + counts[first] as usize, first);
        while seen <= above {
            end += 1;
            seen += counts[end] as usize;
        }
        let wanted = first as f64 + ROUNDER..=end as f64 + ROUNDER;
        let mut near: Vec<f64> =
            values.iter().copied().filter(|&value| wanted.contains(&place(value))).collect();
        near.sort_unstable_by(f64::total_cmp);
        let (low, high) = (f(near[below - skipped]), f(near[above - skipped]));
        low + (high - low) * (rank - below as f64)
    })
}

/// One of [`quantiles`].
pub(super) fn quantile(values: &[f64], share: f64, f: impl Fn(f64) -> f64) -> f64 {
    quantiles(values, [share], f)[0]
}
