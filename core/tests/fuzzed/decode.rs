//! Bytes as a case: any bytes are one, so that a fuzzer wastes none. What is missing at the end is zero.

use crate::case::{Case, Keys};
use arbitrary::{Result, Unstructured};
use discjump_core::terrain::{Edge, SurfaceKind};

/// Scales of heights and speeds: from what squares to nothing to what a state may hold.
pub const HEIGHTS: [f64; 8] = [0.0, 1e-6, 1e-3, 0.1, 0.5, 2.0, 10.0, 78.0];
pub const SPEEDS: [f64; 8] = [1e-32, 1e-6, 1e-3, 0.02, 0.1, 0.5, 5.0, 100.0];
pub const SQUARES: [f64; 4] = [8.0, 1.0, 0.25, 100.0];
pub const TICKS_MS: [u32; 8] = [32, 1, 8, 16, 33, 64, 257, 1000];
/// m: more slices than this a tick would only cost time.
pub const LONGEST_WAY: f64 = 400.0;

/// The case that these bytes spell.
pub fn decode(bytes: &[u8]) -> Case {
    spell(&mut Unstructured::new(bytes)).expect("bytes that run out are zeros")
}

fn pick<const N: usize>(u: &mut Unstructured<'_>, from: &[f64; N]) -> Result<f64> {
    Ok(from[usize::from(byte(u)?) % N])
}

/// The next byte, 0 after the last.
fn byte(u: &mut Unstructured<'_>) -> Result<u8> {
    if u.is_empty() { Ok(0) } else { u.arbitrary() }
}

/// From -127 to 127.
fn signed(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(f64::from(byte(u)?.cast_signed().max(-127)))
}

fn spell(u: &mut Unstructured<'_>) -> Result<Case> {
    let shape = byte(u)?;
    let (rows, cols) = (2 + usize::from(shape & 3), 2 + usize::from(shape >> 2 & 3));
    let edge = [Edge::Tile, Edge::Clamp, Edge::Void, Edge::Tile][usize::from(shape >> 4 & 3)];
    let square = SQUARES[usize::from(shape >> 6)];
    let scale = pick(u, &HEIGHTS)?;
    let heights = (0..rows * cols).map(|_| Ok(signed(u)? * scale)).collect::<Result<_>>()?;
    let tick_ms = TICKS_MS[usize::from(byte(u)?) % TICKS_MS.len()];
    let flags = byte(u)?;
    let bit = |k: u8| flags >> k & 1 == 1;
    let more = byte(u)?;
    let place = [signed(u)? / 40.0, signed(u)? / 40.0];
    let above = f64::from(byte(u)?);
    let above = if more & 1 == 1 { 0.0 } else { above * above / 1024.0 };
    let scale = pick(u, &SPEEDS)?;
    let limit = (LONGEST_WAY * 1000.0 / f64::from(tick_ms)).min(1e6);
    let mut velocity = [0.0; 3];
    for part in &mut velocity {
        *part = (signed(u)? * scale).clamp(-limit, limit);
    }
    let yaw = signed(u)? / 41.0;
    let (energy, friction) = (f64::from(byte(u)?) / 255.0, f64::from(byte(u)?) / 255.0);
    let jump_age = i32::from(byte(u)?) * 2;
    let mut keys = Vec::new();
    while !u.is_empty() && keys.len() < 24 {
        keys.push(key(byte(u)?));
    }
    // As the rest of the bytes is short, the first keys are held.
    let held = keys.first().copied().unwrap_or((0, 0, false, false, 0.0));
    keys.extend(core::iter::repeat_n(held, 8));
    Ok(Case {
        rows,
        cols,
        square,
        edge,
        surface: if bit(7) { SurfaceKind::Bilinear } else { SurfaceKind::Triangles },
        heights,
        armor: usize::from(more >> 1) % 3,
        pack: bit(0),
        tick_ms,
        ski_bug: [None, Some(false), Some(true), None][usize::from(flags >> 1 & 3)],
        switches: [!bit(3), bit(4), bit(5)],
        place,
        above,
        velocity,
        yaw,
        energy,
        friction,
        touched: bit(6),
        jump_age,
        keys,
    })
}

fn key(byte: u8) -> Keys {
    let axis = |k: u8| [0, 1, -1, 0][usize::from(byte >> k & 3)];
    let turn = [0.0, 2.0, -40.0, 1000.0][usize::from(byte >> 6)];
    (axis(0), axis(2), byte >> 4 & 1 == 1, byte >> 5 & 1 == 1, turn)
}
