"""How many instructions a player-tick and an agent step take, held to committed counts.

    make instructions       fails where a count is more than 5% above the committed one
    make instructions-anew  measures and commits anew (to .ci/instructions.json)

Times on a shared machine wander by tens of percent; instructions do not. Plain code and AVX2 are counted by
callgrind as they run. It knows no AVX-512, so of these kernels the instructions in the binary are counted.
"""

import json
import os
import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path

import click

ROOT = Path(__file__).resolve().parent.parent
COMMITTED = Path(__file__).with_suffix(".json")
SLACK = 0.05
RUNS = {"ticks": ("player-tick", 256 * 4, (20, 120)), "steps": ("agent step of one tick", 256, (50, 250))}
"""Of the example: what it plays, how many of them a call has, and the two lengths whose difference counts."""
KERNELS = {1: "plain", 8: "AVX2"}
"""What callgrind can run, by lanes."""

REMEDY = "if that is meant, make instructions-anew and commit .ci/instructions.json"

Counts = dict[str, float]


@click.command()
@click.option("--write", is_flag=True, help="Commit what is measured.")
def main(write: bool) -> None:
    """Count, and compare with the committed counts."""
    for tool, package in (("valgrind", "valgrind"), ("objdump", "binutils")):
        if shutil.which(tool) is None:
            raise click.ClickException(f"{tool} is needed and not installed: apt-get install {package}")
    binary = build()
    counts = executed(binary) | in_binary(binary)
    rustc = run("rustc", "--version").strip()
    if write:
        COMMITTED.write_text(json.dumps({"rustc": rustc, "counts": counts}, indent=1) + "\n")
    committed = json.loads(COMMITTED.read_text())
    for name, count in counts.items():
        before = committed["counts"].get(name)
        change = "" if before is None else f"{count / before - 1.0:+7.1%}"
        click.echo(f"{count:10,.0f} {change:>8}  {name}")
    failures = compare(counts, committed["counts"])
    if failures:
        toolchain = (
            "" if rustc == committed["rustc"] else f"\ncommitted with {committed['rustc']}, this is {rustc}"
        )
        raise click.ClickException("\n".join(failures) + toolchain)


def compare(counts: Counts, committed: Counts) -> list[str]:
    """What is wrong with the counts, a line each.

    >>> for line in compare({"a": 104.0, "b": 106.0, "new": 1.0}, {"a": 100.0, "b": 100.0, "gone": 2.0}):
    ...     print(line.replace(REMEDY, "REMEDY"))
    b: 106 instructions, the ceiling is 105 (100 and 5%): REMEDY
    new: 1 instructions, no count is committed: REMEDY
    gone: a count of 2 instructions is committed, and nothing of that name was found: REMEDY
    """
    lines = []
    for name, count in counts.items():
        if name not in committed:
            lines.append(f"{name}: {count:,.0f} instructions, no count is committed: {REMEDY}")
        elif count > committed[name] * (1.0 + SLACK):
            ceiling = committed[name] * (1.0 + SLACK)
            why = f"the ceiling is {ceiling:,.0f} ({committed[name]:,.0f} and {SLACK:.0%})"
            lines.append(f"{name}: {count:,.0f} instructions, {why}: {REMEDY}")
    for name in committed.keys() - counts.keys():
        what = (
            f"a count of {committed[name]:,.0f} instructions is committed, and nothing of that name was found"
        )
        lines.append(f"{name}: {what}: {REMEDY}")
    return lines


def build() -> Path:
    """The example, in the profile that ships, beside the very core that the extension has."""
    words = "cargo build --quiet --release --locked -p discjump --example instructions --message-format=json"
    for line in run(*words.split()).splitlines():
        message = json.loads(line)
        if message.get("target", {}).get("name") == "instructions" and message.get("executable"):
            return Path(message["executable"])
    raise click.ClickException("cargo built no example of the name instructions")


def executed(binary: Path) -> Counts:
    """Instructions of a player-tick and of an agent step as they run, by kernel."""
    counts = {}
    for lanes, kernel in KERNELS.items():
        for what, (unit, units, (short, long)) in RUNS.items():
            taken = callgrind(binary, what, long, lanes) - callgrind(binary, what, short, lanes)
            counts[f"{unit}, {kernel}"] = round(taken / ((long - short) * units), 1)
    return counts


def callgrind(binary: Path, what: str, calls: int, lanes: int) -> int:
    """Instructions of a whole run."""
    words = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(binary), what, str(calls)]
    environment = {**os.environ, "DISCJUMP_LANES": str(lanes)}
    done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or found is None:
        raise click.ClickException(f"{' '.join(words)}\nfailed with {lanes} lanes:\n{done.stderr[-2000:]}")
    return int(found[1])


def in_binary(binary: Path) -> Counts:
    """Instructions of every kernel that is compiled for AVX-512."""
    listing = run("objdump", "--disassemble", "--demangle=rust", "--no-show-raw-insn", str(binary))
    counts = count_kernels(listing)
    if not counts:
        raise click.ClickException("no with_avx512 in the binary: was it built with another RUSTFLAGS?")
    return counts


def count_kernels(listing: str) -> Counts:
    """Instructions of each `with_avx512::<Work>` in objdump's listing.

    >>> kernel = "0000000000001000 <core::lanes::with_avx512::<core::batch::Play<core::Ski, core::F32x16>>>:"
    >>> other = ["", "0000000000001010 <other>:", "    1010:\\tret"]
    >>> listing = [kernel, "    1000:\\tvaddps", "    1004:\\tret", *other]
    >>> count_kernels("\\n".join(listing))
    {'in the binary, AVX-512: Play<Ski, F32x16>': 2}
    """
    counts: Counter[str] = Counter()
    kernel = None
    for line in listing.splitlines():
        if heading := re.fullmatch(r"[0-9a-f]+ <(.*)>:", line):
            work = re.fullmatch(r".*::with_avx512::<(.*)>", heading[1])
            kernel = re.sub(r"\w+::", "", work[1]) if work else None
        elif kernel and line.startswith(" "):
            counts[f"in the binary, AVX-512: {kernel}"] += 1
    return dict(sorted(counts.items()))


def run(*words: str) -> str:
    """What a command prints."""
    done = subprocess.run(words, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise click.ClickException(f"{' '.join(words)} failed with status {done.returncode}")
    return done.stdout


if __name__ == "__main__":
    main()
