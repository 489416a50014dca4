"""The simulator calls no function of the platform's mathematical library.

Contract: two machines with other C libraries give the same bits. `sin` of one is not that of another, in the
last place; who compares certificates relies on none of them being called. Square roots and rounding are exact
by IEEE 754, and belong to the processor.
"""

import ctypes.util
import re
import shutil
import subprocess

import pytest

from discjump import _native

EXACT = {"sqrt", "floor", "ceil", "trunc", "rint", "round", "roundeven", "nearbyint", "fabs", "fmod", "fma"}
"""Functions whose result IEEE 754 or C fixes to the bit."""

HULLS = {"acos", "cos"}
"""What parry3d's convex hull calls when a `Solid.hull` is made: eigenvalues of its points' covariance, which
choose the hull's first points. No tick, no terrain and no mission comes near it."""


def symbols(path, *options, static=False):
    """Names that `nm` lists, without versions; of the dynamic table, or of the one that stripping removes."""
    tool = shutil.which("nm")
    if tool is None:
        pytest.skip("there is no nm here (binutils)")
    found = subprocess.run(
        [tool, *([] if static else ["--dynamic"]), *options, str(path)],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    return {line.split()[-1].partition("@")[0] for line in found.splitlines() if line.strip()}


def library():
    """Path of the C library's mathematical half."""
    name = ctypes.util.find_library("m")
    if name is None or shutil.which("ldconfig") is None:
        pytest.skip("no libm is found here")
    listed = subprocess.run(["ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
    paths = re.findall(rf"\b{re.escape(name)} .*=> (\S+)", listed)
    if not paths:
        pytest.skip("ldconfig does not know libm")
    return paths[0]


def inexact():
    """What the library offers beyond what is exact, in all widths."""
    offered = symbols(library(), "--defined-only")
    exact = {name + suffix for name in EXACT for suffix in ("", "f", "l")}
    return {name for name in offered if re.fullmatch(r"_*[a-z][a-z0-9_]*", name)} - exact


def test_the_list_of_functions_is_one():
    # Else the next test could not fail.
    assert {"sin", "cosf", "exp", "pow", "atan2", "hypot", "sincosf", "cbrt", "tanh"} <= inexact()


def test_the_extension_calls_none_of_them_but_for_hulls():
    wanted = symbols(_native.__file__, "--undefined-only")
    assert "memcpy" in wanted
    assert wanted & inexact() <= HULLS


def test_only_the_eigenvalues_of_hulls_call_them():
    tool = shutil.which("objdump")
    if tool is None:
        pytest.skip("there is no objdump here (binutils)")
    if not any("discjump" in name for name in symbols(_native.__file__, "--defined-only", static=True)):
        pytest.skip("the extension is stripped of its names: make dev keeps them")
    process = subprocess.Popen(
        [tool, "--disassemble", "--no-show-raw-insn", _native.__file__], stdout=subprocess.PIPE, text=True
    )
    callers, function = set(), ""
    assert process.stdout is not None
    for line in process.stdout:
        if named := re.match(r"[0-9a-f]+ <(.*)>:$", line):
            function = named[1]
        elif re.search(r"(call|jmp|bl?)\s.*<(acos|cos)@plt>", line):
            callers.add(function)
    assert process.wait() == 0
    assert all("glamx" in name and "eigen" in name for name in callers)
