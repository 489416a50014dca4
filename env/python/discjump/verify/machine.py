"""The machine and the build that a certificate names."""

import platform
from typing import Any

from discjump import _native
from discjump._results import machine
from discjump.simulator import Simulator
from discjump.verify.environments import WIDTHS
from discjump.verify.scenes import ground


def described() -> dict[str, Any]:
    """Processor, operating system, lanes, and the build of the native library."""
    return {
        **machine(),
        "architecture": platform.machine(),
        "system": platform.system(),
        "libc": " ".join(platform.libc_ver()),
        "lane_widths": lane_widths(),
        "lanes": Simulator(ground(), 4096, threads=1).lanes,
        "native": build(),
    }


def lane_widths() -> list[int]:
    """Those that this processor has."""
    found = []
    for width in WIDTHS:
        try:
            Simulator(ground(), lanes=width, threads=1)
        except ValueError:
            continue
        found.append(width)
    return found


def build() -> dict[str, Any]:
    """Crate version, target and profile of the native library, and the processor's features that it sees."""
    found: dict[str, Any] = _native.build()
    return found
