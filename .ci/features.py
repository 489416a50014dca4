"""That scenes pay nothing for what they leave out: instructions against a build that lacks it.

    make features              one player at a time
    .ci/features.py --lanes 8  8 players side by side (AVX2)

For everything that a scene can model there is a scene of all but that (core/examples/left_out.rs). It is
counted by callgrind in a build that has the thing, and in one without the thing's cargo feature and code.
Fails where the former takes more than 1% more, a player is larger, or the two end in other bits.
"""

import json
import os
import subprocess
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import NamedTuple

import click

from discjump.bench import instructions

ROOT = Path(__file__).resolve().parent.parent
FEATURES = ("jump", "jet", "energy", "landing_damage", "discs", "blast", "solids", "bump_limits")
SCENES = ("ski", "sandbox", "disc_jump", "mission")
MOST = 1.01
"""Instructions of a scene that leaves something out, over the same in a build without it."""
CALLS = 100


class Counted(NamedTuple):
    """What was counted of a scene."""

    instructions: float
    """Per player-tick."""
    size: int
    """Bytes of a player."""
    digest: str
    """Of all players at the end."""


@click.command()
@click.option("--lanes", type=click.Choice(["1", "8"]), default="1", help="Players side by side.")
def main(lanes: str) -> None:
    """Build, count and compare."""
    if not instructions.available():
        raise click.ClickException("valgrind is needed and not installed: apt-get install valgrind")
    # One compiler thread and one simulated processor at a time, mostly: two builds at once, each in a folder
    # of its own, since cargo lets nobody else into one.
    folders: SimpleQueue[Path] = SimpleQueue()
    for k in range(2):
        folders.put(ROOT / "target" / "left_out" / str(k))

    def counted(features: Sequence[str]) -> dict[str, Counted]:
        folder = folders.get()
        try:
            return count(build(features, lanes, folder))
        finally:
            folders.put(folder)

    builds = [FEATURES, *(tuple(other for other in FEATURES if other != feature) for feature in FEATURES)]
    with ThreadPoolExecutor(2) as workers:
        with_all, *lacking = workers.map(counted, builds)
    failures = []
    for feature, built in zip(FEATURES, lacking, strict=True):
        there, without = with_all[feature], built[feature]
        ratio = there.instructions / without.instructions
        click.echo(f"{feature:15} {there.instructions:8,.1f} / {without.instructions:8,.1f} = {ratio:.4f}")
        failures += compare(feature, there, without)
    if failures:
        raise click.ClickException("\n".join(failures))


def compare(feature: str, there: Counted, without: Counted) -> list[str]:
    """What is wrong with a scene that leaves a feature out, in a build that has it and in one without.

    >>> compare("energy", Counted(1009.0, 76, "ab"), Counted(1000.0, 76, "ab"))
    []
    >>> for line in compare("energy", Counted(1011.0, 80, "ab"), Counted(1000.0, 76, "cd")):
    ...     print(line)
    energy: a scene without it takes 1,011.0 instructions a player-tick, and 1,000.0 where it is not compiled
    energy: a scene without it has players of 80 bytes, and of 76 where it is not compiled
    energy: a scene without it ends with digest ab, and with cd where it is not compiled
    """
    said = []
    if there.instructions > MOST * without.instructions:
        counts = f"{there.instructions:,.1f} instructions a player-tick, and {without.instructions:,.1f}"
        said.append(f"takes {counts}")
    if there.size > without.size:
        said.append(f"has players of {there.size} bytes, and of {without.size}")
    if there.digest != without.digest:
        said.append(f"ends with digest {there.digest}, and with {without.digest}")
    return [f"{feature}: a scene without it {words} where it is not compiled" for words in said]


def build(features: Sequence[str], lanes: str, folder: Path) -> Path:
    """The example with these features, and none of the public scenes: their kernels take minutes."""
    words = ["cargo", "build", "--release", "--locked", "-p", "discjump-core", "--example", "left_out"]
    words += ["--no-default-features", "--target-dir", str(folder)]
    words += ["--features", ",".join(features), "--quiet", "--message-format=json"]
    environment = {**os.environ, "LEFT_OUT_LANES": lanes}
    done = subprocess.run(words, cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise click.ClickException(f"{' '.join(words)} failed with status {done.returncode}")
    for line in done.stdout.splitlines():
        message = json.loads(line)
        if message.get("target", {}).get("name") == "left_out" and message.get("executable"):
            return Path(message["executable"])
    raise click.ClickException("cargo built no example of the name left_out")


def count(binary: Path) -> dict[str, Counted]:
    """What the example plays, by what it leaves out."""
    lines: list[str] = []
    parts = instructions.marked([str(binary), str(CALLS)], lines.append)
    scenes, refusals = lines[: -len(SCENES)], lines[-len(SCENES) :]
    for name, line in zip(SCENES, refusals, strict=True):
        if not line.startswith("scene:") or f'cargo feature "{name}"' not in line:
            raise click.ClickException(f"expected the refusal of scene {name}, got {line!r}")
    counted = {}
    # The parts are what came before a scene's calls, and the calls, in turn.
    for line, taken in zip(scenes, parts[1::2], strict=True):
        name, ticks, size, digest = line.split()
        counted[name] = Counted(taken / int(ticks), int(size), digest)
    return counted


if __name__ == "__main__":
    main()
