//! Every operation, lane by lane, against the scalar: the bits, on all kinds of numbers.

use super::{F32x8, F32x16, Two, Width, lane_width};
use crate::random::{Purpose, bits};
use crate::real::{Int, Mask, Real, V3, Work};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Rounds of every comparison; each is of as many numbers as there are lanes.
const ROUNDS: u64 = 20_000;

/// Numbers at which something can go wrong.
const EDGES: [f32; 28] = [
    0.0,
    -0.0,
    f32::NAN,
    -f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    f32::MAX,
    f32::MIN,
    0.5,
    -0.5,
    1.0,
    -1.0,
    0.999_999_94,
    8_388_609.0,
    16_777_216.0,
    2_147_483_500.0,
    2_147_483_648.0,
    -2_147_483_648.0,
    -2_147_484_000.0,
    4_294_967_296.0,
    1e10,
    -1e10,
    core::f32::consts::PI,
    -core::f32::consts::FRAC_PI_2,
];

/// A number of any kind: an edge, any bits at all, or of everyday size.
fn number(k: u64) -> f32 {
    let draw = bits(1, k, Purpose::Velocity, 0);
    let any = (draw >> 8) as u32;
    match draw % 4 {
        0 => EDGES[any as usize % EDGES.len()],
        1 => f32::from_bits(any),
        2 => f32::from_bits(any & 0x807f_ffff),
        _ => (any as f32 / u32::MAX as f32 - 0.5) * 20.0,
    }
}

/// An integer of any size.
fn integer(k: u64) -> i32 {
    let draw = bits(2, k, Purpose::Velocity, 0);
    let any = (draw >> 8) as i32;
    match draw % 3 {
        0 => any,
        1 => any % 9,
        _ => [0, -1, 1, i32::MIN, i32::MAX, 255, 256, -256][any as usize % 8],
    }
}

/// NaN has one form: which of several comes out is left open by the language, and no bits of a player
/// depend on it.
fn form(x: f32) -> u32 {
    if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() }
}

struct Operands<R: Real> {
    a: R,
    b: R,
    i: R::Int,
    j: R::Int,
    mask: R::Mask,
    other: R::Mask,
    index: R::Int,
}

impl<R: Real<Scalar = f32>> Operands<R> {
    fn lane(&self, lane: usize) -> Operands<f32> {
        Operands {
            a: self.a.lane(lane),
            b: self.b.lane(lane),
            i: self.i.lane(lane),
            j: self.j.lane(lane),
            mask: self.mask.lane(lane),
            other: self.other.lane(lane),
            index: self.index.lane(lane),
        }
    }
}

struct Results<R: Real> {
    reals: [R; 21],
    ints: [R::Int; 12],
    masks: [R::Mask; 10],
    any: bool,
}

/// Every operation of the three traits.
struct All<'a, R: Real> {
    on: &'a Operands<R>,
    pairs: &'a [[f32; 2]],
}

impl<R: Real<Scalar = f32>> Work for All<'_, R> {
    type Output = Results<R>;

    #[inline(always)]
    fn run(self) -> Results<R> {
        let Operands { a, b, i, j, mask, other, index } = *self.on;
        let (sin, cos) = a.sin_cos();
        let unit = V3::new(a, b, a * b);
        let [a0, a1, a2, a3] = R::gather_square(self.pairs, index);
        Results {
            reals: [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a.sqrt(),
                a.abs(),
                a.min(b),
                a.max(b),
                R::select(mask, a, b),
                R::from_int(i),
                a0,
                a1,
                a2,
                a3,
                R::lit(0.1),
                R::splat(3.5),
                sin,
                cos,
                unit.length(),
                R::zero(),
            ],
            ints: [
                a.truncate(),
                a.floor_int(),
                a.ceil_int(),
                R::Int::select(mask, i, j),
                i.wrap(256),
                i.wrap(4),
                i.wrap(77),
                R::Int::splat(-7),
                i.clamp(-100, 200),
                index + index,
                index - j.wrap(1000),
                index * index,
            ],
            masks: [
                a.lt(b),
                a.le(b),
                i.lt(j),
                i.eq(j),
                i.is_odd(),
                mask.and(other),
                mask.or(other),
                mask.not(),
                mask.pick(other, other.not()),
                R::Mask::splat(true),
            ],
            any: mask.and(other).any(),
        }
    }
}

const TABLE: usize = 1000;

fn operands<R: Real<Scalar = f32>>(round: u64) -> Operands<R> {
    let at = |lane: usize, slot: u64| (round * 32 + lane as u64) * 8 + slot;
    let zero = R::Int::splat(0);
    let off = R::Mask::splat(false);
    let (mut i, mut j, mut index, mut mask, mut other) = (zero, zero, zero, off, off);
    for lane in 0..R::LANES {
        i.set_lane(lane, integer(at(lane, 0)));
        j.set_lane(lane, if round.is_multiple_of(3) { integer(at(lane, 0)) } else { integer(at(lane, 1)) });
        index.set_lane(lane, integer(at(lane, 2)).rem_euclid(TABLE as i32 - 1));
        mask.set_lane(lane, integer(at(lane, 3)) & 1 == 1);
        other.set_lane(lane, integer(at(lane, 4)) % 7 == 0);
    }
    let (mut first, mut second) = (R::every(0.0), R::every(0.0));
    for lane in 0..R::LANES {
        first.as_mut()[lane] = number(at(lane, 5));
        second.as_mut()[lane] = number(at(lane, 6));
    }
    let (a, mut b) = (R::pack(&first), R::pack(&second));
    // Equal numbers too: half of the comparisons are about them.
    b.set_lane(round as usize % R::LANES, a.lane(round as usize % R::LANES));
    Operands { a, b, i, j, mask, other, index }
}

fn agrees_with_scalars<R: Real<Scalar = f32>>() {
    let pairs: Vec<[f32; 2]> =
        (0..TABLE as u64).map(|k| [number(1 << 41 | k), number(1 << 42 | k)]).collect();
    let pairs = &pairs[..];
    for round in 0..ROUNDS {
        let on = operands::<R>(round);
        let all = R::enter(All { on: &on, pairs });
        let mut any = false;
        for lane in 0..R::LANES {
            let one = on.lane(lane);
            let expected = All { on: &one, pairs }.run();
            let numbers =
                format!("lane {lane} of {} with {one:?}", R::LANES, one = (one.a, one.b, one.i, one.j));
            for (k, (got, wanted)) in all.reals.iter().zip(expected.reals).enumerate() {
                assert_eq!(form(got.lane(lane)), form(wanted), "real {k}, {numbers}");
            }
            for (k, (got, wanted)) in all.ints.iter().zip(expected.ints).enumerate() {
                assert_eq!(got.lane(lane), wanted, "integer {k}, {numbers}");
            }
            for (k, (got, wanted)) in all.masks.iter().zip(expected.masks).enumerate() {
                assert_eq!(got.lane(lane), wanted, "mask {k}, {numbers}");
            }
            any |= expected.any;
        }
        assert_eq!(all.any, any);
    }
}

fn gather_refuses<R: Real<Scalar = f32>>() {
    for bad in [-1, i32::MIN, 5, i32::MAX] {
        for lane in 0..R::LANES {
            let mut index = R::Int::splat(4);
            index.set_lane(lane, bad);
            let square = catch_unwind(AssertUnwindSafe(|| R::gather_square(&[[0.0; 2]; 6], index)));
            assert!(square.is_err(), "a square at {bad} in lane {lane} of {}", R::LANES);
        }
    }
}

/// One lane of another value, and nothing else, changes; the bits of a mask are those of its lanes.
fn copies_a_lane<R: Real<Scalar = f32>>() {
    for round in 0..ROUNDS / 100 {
        let (from, old) = (operands::<R>(round), operands::<R>(round + ROUNDS));
        let (lane, there) = (round as usize % R::LANES, round as usize / 7 % R::LANES);
        let (mut a, mut i, mut mask) = (old.a, old.i, old.mask);
        a.copy_lane(lane, &from.a, there);
        i.copy_lane(lane, &from.i, there);
        mask.copy_lane(lane, &from.mask, there);
        for at in 0..R::LANES {
            let expected = if at == lane { from.lane(there) } else { old.lane(at) };
            assert_eq!(a.lane(at).to_bits(), expected.a.to_bits());
            assert_eq!(i.lane(at), expected.i);
            assert_eq!(mask.lane(at), expected.mask);
            assert_eq!(mask.bits() >> at & 1 == 1, expected.mask);
        }
        assert_eq!(u64::from(mask.bits()) >> R::LANES, 0);
    }
}

/// Columns become rows, number by number, and nothing else is written; numbers go out as they came in.
fn writes_rows<R: Real<Scalar = f32>>() {
    let mut columns = R::every(R::zero());
    for k in 0..R::LANES {
        let column = operands::<R>(k as u64);
        columns.as_mut()[k] = column.a;
        let integers = R::unpack_int(column.i);
        for lane in 0..R::LANES {
            assert_eq!(column.a.unpack().as_ref()[lane].to_bits(), column.a.lane(lane).to_bits());
            assert_eq!(integers.as_ref()[lane], column.i.lane(lane));
            assert_eq!(R::pack_int(&integers).lane(lane), column.i.lane(lane));
        }
    }
    let untouched = 12345.0f32.to_bits();
    for count in 0..=R::LANES {
        for players in 0..=R::LANES {
            let (stride, at) = (R::LANES + 3, 2);
            let mut rows = vec![f32::from_bits(untouched); R::LANES * stride];
            R::write_rows(&columns, count, &mut rows, stride, at, players);
            for (place, number) in rows.iter().enumerate() {
                let (lane, k) = (place / stride, place % stride);
                let written = lane < players && (at..at + count).contains(&k);
                let expected =
                    if written { columns.as_ref()[k - at].lane(lane).to_bits() } else { untouched };
                assert_eq!(number.to_bits(), expected, "{count} columns of {players} players, place {place}");
            }
        }
    }
    // One number short, a column beyond the row, and more of either than there are lanes.
    let fails = |count: usize, len: usize, at: usize, players: usize| {
        let mut rows = vec![0.0; len];
        let stride = R::LANES;
        let write = || R::write_rows(&columns, count, &mut rows, stride, at, players);
        catch_unwind(AssertUnwindSafe(write)).is_err()
    };
    let whole = R::LANES * R::LANES;
    assert!(!fails(R::LANES, whole, 0, R::LANES));
    assert!(fails(R::LANES, whole - 1, 0, R::LANES) && fails(R::LANES, whole, 1, R::LANES));
    assert!(fails(R::LANES + 1, 4 * whole, 0, 1) && fails(1, 4 * whole, 0, R::LANES + 1));
}

#[test]
fn columns_become_rows() {
    for width in Width::available() {
        match width {
            Width::One => writes_rows::<f32>(),
            Width::Eight => writes_rows::<F32x8>(),
            Width::Sixteen => writes_rows::<F32x16>(),
            Width::ThirtyTwo => writes_rows::<Two<F32x16>>(),
        }
    }
}

#[test]
fn a_lane_is_copied_alone() {
    for width in Width::available() {
        match width {
            Width::One => copies_a_lane::<f32>(),
            Width::Eight => copies_a_lane::<F32x8>(),
            Width::Sixteen => copies_a_lane::<F32x16>(),
            Width::ThirtyTwo => copies_a_lane::<Two<F32x16>>(),
        }
    }
}

#[test]
fn every_operation_has_the_bits_of_the_scalar() {
    for width in Width::available() {
        match width {
            Width::One => agrees_with_scalars::<f32>(),
            Width::Eight => agrees_with_scalars::<F32x8>(),
            Width::Sixteen => agrees_with_scalars::<F32x16>(),
            Width::ThirtyTwo => agrees_with_scalars::<Two<F32x16>>(),
        }
    }
}

#[test]
fn a_gather_beyond_the_table_panics_and_reads_nothing() {
    for width in Width::available() {
        match width {
            Width::One => gather_refuses::<f32>(),
            Width::Eight => gather_refuses::<F32x8>(),
            Width::Sixteen => gather_refuses::<F32x16>(),
            Width::ThirtyTwo => gather_refuses::<Two<F32x16>>(),
        }
    }
}

#[test]
fn a_width_that_is_none_is_refused_by_name() {
    for lanes in [0, 2, 4, 17, 1 << 40] {
        let message = lane_width(Some(lanes), 100).unwrap_err().0;
        assert!(message.starts_with("lanes: expected one of ") && message.ends_with(&format!("got {lanes}")));
    }
    for width in Width::available() {
        assert_eq!(lane_width(Some(width.lanes()), 1).unwrap(), width);
    }
}
