"""The long form: ten million ticks in every tier, a million episodes. It goes on where it was stopped."""

import hashlib
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from discjump import _native
from discjump._results import machine, save, versions
from discjump.simulator import FIDELITIES
from discjump.stress import endurance, episodes
from discjump.stress.cases import columns

TICKS, EPISODES = 10_000_000, 1_000_000


Part = tuple[str, float, Callable[[Callable[[float], object]], dict[str, Any]]]


def long_form(out: Path, scale: float, seed: int) -> int:
    """Play it, noting every part that is done in `out`; the exit code."""
    figures, page = out / "long.json", out / "long.md"
    words = ["discjump stress --long"]
    words += [f"--scale {scale:g}"] if scale != 1.0 else []
    words += [f"--draws {seed}"] if seed else []
    command = " ".join([*words, f"--out {out}"])
    record: dict[str, Any] = {"command": command, "parts": {}}
    now = versions("discjump", "numpy")
    if figures.exists():
        try:
            before = json.loads(figures.read_text())
        except ValueError as error:
            raise click.ClickException(
                f"{figures}: expected an earlier result to go on with, got {error}"
            ) from None
        same = ("command", "versions", "build")
        if all(before.get(key) == value for key, value in zip(same, (command, now, build()), strict=True)):
            record = before
            click.echo(f"{figures}: {len(record['parts'])} parts are done already")
    record |= {"machine": machine(), "versions": now, "build": build()}
    parts = planned(scale, seed)
    with click.progressbar(length=100_000, show_pos=False) as bar:
        total = sum(weight for _, weight, _ in parts)
        for name, weight, play in parts:
            share = 100_000 * weight / total
            bar.label = f"{name:<34}"
            if name in record["parts"]:
                bar.update(round(share))
                continue
            shown = [0.0]

            def done(part: float, shown: list[float] = shown, share: float = share) -> None:
                steps = round(share * part) - round(shown[0])
                if steps > 0:
                    shown[0] += steps
                    bar.update(steps)

            began = time.perf_counter()
            result = play(done)
            record["parts"][name] = {**result, "took_seconds": round(time.perf_counter() - began, 1)}
            save(figures, record)
    page.write_text(render(record))
    click.echo(f"\n{page.read_text()}\n{figures}\n{page}")
    return int(any(part["failures"] for part in record["parts"].values()))


def build() -> str:
    """A digest of what plays and asks: the native library and this package's code."""
    folder = Path(__file__).parent
    digest = hashlib.blake2b(Path(_native.__file__).read_bytes(), digest_size=8)
    for path in sorted(folder.glob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def planned(scale: float, seed: int) -> list[Part]:
    """The parts: name, about how long they take (s), and what plays them."""
    ticks, number = max(1000, round(TICKS * scale)), max(len(FIDELITIES), round(EPISODES * scale))
    parts: list[Part] = []
    for column in columns(surfaces=("triangles",)):
        parts.append(
            (
                f"{ticks:,} ticks, {column.tier} {column.precision}",
                ticks * 3e-6,
                lambda done, column=column: endurance.endure(column, ticks, seed, done),  # type: ignore[misc]
            )
        )
    each = -(-number // len(FIDELITIES))
    for fidelity in FIDELITIES:
        parts.append(
            (
                f"{each:,} episodes, {fidelity}",
                each * 6e-5,
                lambda done, fidelity=fidelity: episodes.played(fidelity, each, seed, done),  # type: ignore[misc]
            )
        )
    return parts


def render(record: dict[str, Any]) -> str:
    """The Markdown of a record."""
    machine_, parts = record["machine"], record["parts"]
    described = ", ".join(f"{name} {number}" for name, number in record["versions"].items())
    lines = [
        "# Long form of the stress suite",
        "",
        f"    {record['command']}",
        "",
        f"{machine_['processor']}, {machine_['cores']} cores, Python {machine_['python']}, {described}.",
        "",
    ]
    for wanted, header in (("ticks", endurance.HEADER), ("episodes", episodes.HEADER)):
        rows = {name: part for name, part in parts.items() if f" {wanted}," in name}
        if rows:
            lines += [f"| part | {' | '.join(header.values())} | s | failures |"]
            lines += ["|---|" + "---|" * (len(header) + 2)]
            for name, part in rows.items():
                cells = [
                    str(part[key]) if not isinstance(part[key], int) else f"{part[key]:,}" for key in header
                ]
                failures = "; ".join(part["failures"]) or "none"
                lines.append(f"| {name} | {' | '.join(cells)} | {part['took_seconds']:.0f} | {failures} |")
            lines.append("")
    return "\n".join(lines)
