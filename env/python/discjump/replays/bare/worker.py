"""Plays a recording on one end of a pipe: a job comes in, the installation and its frames go out.

A message is 8 bytes of length, little-endian, and so many bytes of `codec`.
"""

import platform
import struct
import sys
from typing import IO, Any

from . import build, play
from .codec import Arrays, Header, decode, encode

_LENGTH = struct.Struct("<Q")


def send(pipe: IO[bytes], header: Header, arrays: Arrays) -> None:
    """Write a message."""
    data = encode(header, arrays)
    pipe.write(_LENGTH.pack(len(data)) + data)
    pipe.flush()


def receive(pipe: IO[bytes]) -> tuple[Header, Arrays] | None:
    """The next message; None where the other end is closed.

    Raises:
        ValueError: no message of `send`.
    """
    head = pipe.read(_LENGTH.size)
    if not head:
        return None
    if len(head) < _LENGTH.size:
        raise ValueError(f"expected a message, got {head!r}")
    (length,) = _LENGTH.unpack(head)
    data = pipe.read(length)
    if len(data) != length:
        raise ValueError(f"expected a message of {length} bytes, got {len(data)}")
    return decode(data)


def installation() -> dict[str, Any]:
    """What plays here."""
    import numpy

    import discjump

    return {
        "discjump": discjump.__version__,
        "where": str(discjump.__file__),
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "machine": platform.machine(),
    }


def main() -> None:
    """One job from standard input, frames to standard output; what others print goes to standard error."""
    out, sys.stdout = sys.stdout.buffer, sys.stderr
    job = receive(sys.stdin.buffer)
    if job is None:
        return
    header, arrays = job
    send(out, {"installation": installation()}, {})
    try:
        for frame in play.frames(header, arrays, play.Way(**header["way"])):
            send(out, {"tick": frame.tick, "over": frame.over}, frame.values)
    except build.CannotBuild as error:
        send(out, {"error": str(error)}, {})
    except BrokenPipeError:
        sys.stderr.close()
