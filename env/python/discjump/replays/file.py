"""The file of a replay: sealed, compressed, bounded.

    8 bytes    magic
    4 bytes    version of the schema, little-endian
    4 bytes    length of the body when unpacked, little-endian
    16 bytes   BLAKE2b of the three above and of the packed body
    the rest   the body, packed by LZMA2 without a container of its own; `bare.codec` says what is in it

Reading one runs nothing that is in it, and unpacks no more than it announces, at most `LARGEST` bytes.
"""

import hashlib
import lzma
import struct
from pathlib import Path

from discjump.replays.bare.codec import Arrays, Header, decode, encode
from discjump.replays.errors import ReplayError

MAGIC = b"\x89DJRPLY\n"
VERSION = 1
LARGEST = 2**28
"""Most bytes that a body may have: 256 MiB, a map of 5,000 x 5,000 heights and more."""

_HEAD = struct.Struct("<8sII")
_SEAL = 16
FILTERS: list[dict[str, int]] = [
    {"id": lzma.FILTER_LZMA2, "preset": 9, "dict_size": 2**20, "lc": 0, "lp": 0, "pb": 0}
]
"""Of LZMA2: a minute of drawn actions takes 2,139 bytes so, 2,398 with zlib, 2,224 in an .xz."""


def pack(header: Header, arrays: Arrays) -> bytes:
    """A replay's file.

    Raises:
        ReplayError: it would be larger than `LARGEST`.
    """
    body = encode(header, arrays)
    if len(body) > LARGEST:
        raise ReplayError(f"replay: expected at most {LARGEST:,} bytes unpacked, got {len(body):,}")
    head = _HEAD.pack(MAGIC, VERSION, len(body))
    packed = lzma.compress(body, format=lzma.FORMAT_RAW, filters=FILTERS)
    return head + _seal(head, packed) + packed


def unpack(data: bytes, name: str = "replay") -> tuple[Header, Arrays]:
    """Header and arrays of a replay's file; `name` stands in messages.

    Raises:
        ReplayError: no replay, one of a newer schema, or a damaged one.
    """
    if data[: len(MAGIC)] != MAGIC:
        raise ReplayError(f"{name}: expected a replay of discjump, got a file that does not begin as one")
    if len(data) < _HEAD.size + _SEAL:
        raise ReplayError(f"{name}: the replay is cut off after {len(data)} bytes")
    head, seal, packed = data[: _HEAD.size], data[_HEAD.size : _HEAD.size + _SEAL], data[_HEAD.size + _SEAL :]
    _, version, length = _HEAD.unpack(head)
    if _seal(head, packed) != seal:
        newer = (
            f"; its schema is said to be {version}, and this reads {VERSION}" if version != VERSION else ""
        )
        raise ReplayError(f"{name}: the replay is damaged: its checksum does not match its bytes{newer}")
    if version != VERSION:
        raise ReplayError(
            f"{name}: expected schema {VERSION} of replays, got {version}: a newer discjump wrote it, and "
            "one as new can read it"
        )
    if length > LARGEST:
        raise ReplayError(f"{name}: expected at most {LARGEST:,} bytes unpacked, got {length:,}")
    try:
        unpacker = lzma.LZMADecompressor(format=lzma.FORMAT_RAW, filters=FILTERS)
        body = unpacker.decompress(packed, max_length=length + 1)
        if len(body) != length:
            raise ValueError(f"expected {length} bytes unpacked, got {len(body)} or more")
        return decode(body)
    except (lzma.LZMAError, ValueError) as error:
        raise ReplayError(f"{name}: the replay is malformed: {error}") from None


def read(path: str | Path) -> tuple[Header, Arrays]:
    """Header and arrays of the replay in a file."""
    with Path(path).open("rb") as file:
        # No packed body is larger than an unpacked one, but for a little.
        data = file.read(2 * LARGEST)
    return unpack(data, str(path))


def _seal(head: bytes, packed: bytes) -> bytes:
    return hashlib.blake2b(head + packed, digest_size=_SEAL).digest()
