//! Level benches: a running median along east-west lines.
//!
//! A median repeats the values of its neighbours, so it makes dead-level edges, steep flanks between them and many tiny
//! pits. The reference has them along x only: 29% of its east-west edges are level, next to none of the north-south ones.

use super::spectrum::Base;
use crate::terrain::statistics::grid::SIDE;

/// Sum of the widest median's reach to either side.
const REACH: usize = 4;

/// Replaces each height by the median of the 5 around it on its row where the texture field is above its
/// own median, and of the 9 around it elsewhere.
pub(super) fn cut(base: &mut Base) {
    let side = base.side;
    let mut sorted = base.texture.clone();
    let middle = sorted.len() / 2;
    let limit = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
    let mut padded = vec![0.0; side + 2 * REACH];
    let mut shifted: Shifted<9> = [[0.0; SIDE]; 9];
    let mut narrow: Shifted<5> = [[0.0; SIDE]; 5];
    let rows = base.heights.chunks_exact_mut(side).zip(base.texture.chunks_exact(side));
    for (row, texture) in rows {
        padded[REACH..REACH + side].copy_from_slice(row);
        padded[..REACH].copy_from_slice(&row[side - REACH..]);
        padded[REACH + side..].copy_from_slice(&row[..REACH]);
        for (k, shifted) in shifted.iter_mut().enumerate() {
            shifted[..side].copy_from_slice(&padded[k..k + side]);
        }
        narrow.copy_from_slice(&shifted[2..7]);
        sort_middle(&mut narrow, &NETWORK_OF_5);
        sort_middle(&mut shifted, &NETWORK_OF_9);
        for (x, height) in row.iter_mut().enumerate() {
            *height = if texture[x] > limit { narrow[2][x] } else { shifted[4][x] };
        }
    }
}

/// A row and its neighbours, each shifted by one more sample: so that whole rows are compared at once.
type Shifted<const N: usize> = [[f64; SIDE]; N];

/// Exchanges that bring the median of five, and of nine, to the middle.
const NETWORK_OF_5: [(usize, usize); 7] = [(0, 1), (3, 4), (0, 3), (1, 4), (1, 2), (2, 3), (1, 2)];
#[rustfmt::skip]
const NETWORK_OF_9: [(usize, usize); 19] = [
    (1, 2), (4, 5), (7, 8), (0, 1), (3, 4), (6, 7), (1, 2), (4, 5), (7, 8), (0, 3),
    (5, 8), (4, 7), (3, 6), (1, 4), (2, 5), (4, 7), (4, 2), (6, 4), (4, 2),
];

/// Carries out exchanges: the lower value to the first place, the higher to the second.
fn sort_middle<const N: usize>(rows: &mut Shifted<N>, network: &[(usize, usize)]) {
    for &(a, b) in network {
        let [low, high] = rows.get_disjoint_mut([a, b]).expect("two places of the network");
        for (low, high) in low.iter_mut().zip(high) {
            let (x, y) = (*low, *high);
            *low = if y < x { y } else { x };
            // Not `y < x` again: from one condition for both the compiler makes a branch, four times slower.
            *high = if x < y { y } else { x };
        }
    }
}

/// Median of three.
pub(super) fn median3([a, b, c]: [f64; 3]) -> f64 {
    a.min(b).max(a.max(b).min(c))
}

#[cfg(test)]
mod tests {
    use super::{NETWORK_OF_5, NETWORK_OF_9, SIDE, median3, sort_middle};

    fn middle<const N: usize>(network: &[(usize, usize)]) -> impl Fn([f64; N]) -> f64 {
        |values| {
            let mut rows = values.map(|value| [value; SIDE]);
            sort_middle(&mut rows, network);
            rows[N / 2][SIDE - 1]
        }
    }

    /// A network that is right on all sequences of 0 and 1 is right on all sequences.
    #[test]
    fn networks_are_right_on_all_sequences_of_two_values() {
        fn check<const N: usize>(median: impl Fn([f64; N]) -> f64) {
            for bits in 0..1_u32 << N {
                let values: [f64; N] = std::array::from_fn(|k| f64::from(bits >> k & 1));
                let expected = f64::from(u8::from(bits.count_ones() as usize > N / 2));
                assert_eq!(median(values), expected, "{values:?}");
            }
        }
        check(median3);
        check(middle::<5>(&NETWORK_OF_5));
        check(middle::<9>(&NETWORK_OF_9));
    }
}
