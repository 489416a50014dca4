//! The envelope of a snapshot: what it is of, how much, and a checksum.

use crate::error::{InputError, refuse};
use xxhash_rust::xxh3::xxh3_128;

const MAGIC: &[u8; 8] = b"DISCJUMP";
const VERSION: u32 = 1;
const HEADER: usize = 8 + 4 + 16 + 8;
const CHECKSUM: usize = 16;

/// Wraps the bytes of `count` players whose layout is described by `layout`.
pub(super) fn seal(layout: &str, count: usize, body: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(HEADER + body.len() + CHECKSUM);
    out.extend(MAGIC);
    out.extend(VERSION.to_le_bytes());
    out.extend(xxh3_128(layout.as_bytes()).to_le_bytes());
    out.extend((count as u64).to_le_bytes());
    out.extend(body);
    let sum = xxh3_128(&out);
    out.extend(sum.to_le_bytes());
    out
}

/// The body of a snapshot, `stride` bytes for each player, after checking that it is whole and of this layout
/// and count.
pub(super) fn open<'a>(
    layout: &str,
    count: usize,
    stride: usize,
    bytes: &'a [u8],
) -> Result<&'a [u8], InputError> {
    if bytes.len() < HEADER + CHECKSUM || &bytes[..8] != MAGIC {
        refuse!(
            "snapshot: expected one made by snapshot(), got {} bytes that do not begin as one",
            bytes.len()
        );
    }
    let (content, sum) = bytes.split_at(bytes.len() - CHECKSUM);
    if xxh3_128(content).to_le_bytes() != sum {
        refuse!("snapshot: its checksum does not match: truncated or corrupted ({} bytes)", bytes.len());
    }
    let version = u32::from_le_bytes(content[8..12].try_into().expect("4 bytes"));
    if version != VERSION {
        refuse!("snapshot: expected format version {VERSION}, got {version}");
    }
    if content[12..28] != xxh3_128(layout.as_bytes()).to_le_bytes() {
        refuse!("snapshot: it is of another layout; this one is {layout}");
    }
    let n = u64::from_le_bytes(content[28..36].try_into().expect("8 bytes"));
    if n != count as u64 {
        refuse!("snapshot: expected {count} players, got {n}");
    }
    let body = &content[HEADER..];
    if body.len() != stride * count {
        refuse!("snapshot: expected {} bytes of players, got {}", stride * count, body.len());
    }
    Ok(body)
}
