"""`discjump terrain`: statistics of generated terrain against their windows, and its picture."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click
import numpy as np

from discjump._native import Terrain
from discjump._results import save
from discjump.envs import command_map

if TYPE_CHECKING:
    import PIL.Image

SEED = click.IntRange(0, 2**64 - 1)
#: Of concrete in full light.
SOLID = (206, 200, 192)


class Row(NamedTuple):
    """One statistic and its window."""

    name: str
    group: str
    value: float
    low: float
    high: float
    inside: bool


@click.command()
@click.option("--seed", type=SEED, default=0, show_default=True, help="Seed of the terrain.")
@click.option("--repeating", is_flag=True, help="The cell of 512 m that repeats, instead of 2,048 m.")
@click.option(
    "--check",
    type=SEED,
    nargs=2,
    metavar="FIRST LAST",
    help="Check every seed from FIRST to LAST instead, and fail if one misses its windows.",
)
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs/terrain"),
    show_default=True,
    help="Directory for the picture (PNG) and the figures (JSON).",
)
@click.option(
    "--size",
    type=click.IntRange(64, 4096),
    default=1024,
    show_default=True,
    help="Height and width of the picture, pixels.",
)
def terrain(seed: int, repeating: bool, check: tuple[int, int] | None, out: Path, size: int) -> None:
    """Statistics of a generated terrain with their windows, and its shaded relief.

    Lengths are in m, slopes in degrees, band_* and frac_* are shares, *_per_km2 are counts.
    """
    if check is not None:
        _check_range(*check, repeating, out)
        return
    made = Terrain.raindance(seed, repeating=repeating)
    rows = [Row(*row) for row in made.acceptance()]
    click.echo(table(rows, made.statistics()))
    accepted = made.is_raindance_like()
    click.echo(verdict(rows, accepted))
    out.mkdir(parents=True, exist_ok=True)
    picture, figures = out / f"terrain-{seed}.png", out / f"terrain-{seed}.json"
    save_picture(made, picture, size)
    save(
        figures,
        {
            "seed": seed,
            "repeating": repeating,
            "digest": made.digest(),
            "accepted": accepted,
            "acceptance": [row._asdict() for row in rows],
            "statistics": made.statistics(),
        },
    )
    click.echo(f"{picture}\n{figures}")
    if not accepted:
        raise SystemExit(1)


def table(rows: list[Row], statistics: dict[str, float]) -> str:
    """All statistics as text, those with a window first."""
    lines = [f"{'statistic':<24}{'group':<12}{'value':>12}{'from':>12}{'to':>12}"]
    for row in rows:
        mark = "" if row.inside else "  outside"
        lines.append(
            f"{row.name:<24}{row.group:<12}{row.value:>12.5g}{row.low:>12.5g}{row.high:>12.5g}{mark}"
        )
    named = {row.name for row in rows}
    lines += [f"{name:<24}{'-':<12}{value:>12.5g}" for name, value in statistics.items() if name not in named]
    return "\n".join(lines)


def verdict(rows: list[Row], accepted: bool) -> str:
    """One line: how many statistics of each group lie inside.

    >>> verdict([Row("sigma_m", "core", 9.0, 10.0, 20.0, False)], False)
    'FAILS: core 0 of 1 inside'
    """
    inside: dict[str, list[bool]] = {}
    for row in rows:
        inside.setdefault(row.group, []).append(row.inside)
    counts = [f"{group} {sum(members)} of {len(members)} inside" for group, members in inside.items()]
    return f"{'passes' if accepted else 'FAILS'}: {', '.join(counts)}"


def save_picture(terrain: Terrain, path: Path, size: int) -> None:
    """One period of the terrain and what stands on it, as a PNG of `size` x `size` pixels."""
    from PIL import Image  # not needed to step environments

    (west, south), (width, height) = terrain.origin, terrain.size
    window = command_map.Window(west, south, max(width, height))
    picture = Image.fromarray(command_map.finished(command_map.ground(terrain, window, size)))
    standing = _solids(terrain, window, size)
    picture.paste(standing, mask=standing.getchannel("A"))
    picture.save(path)


def _solids(terrain: Terrain, window: command_map.Window, size: int) -> PIL.Image.Image:
    """The solids' upper faces and the flags from above, lit from the north-west, on a transparent ground."""
    from PIL import Image, ImageDraw

    fine = 3  # drawn so much larger, for smooth edges
    layer = Image.new("RGBA", (fine * size, fine * size), (*SOLID, 0))
    draw = ImageDraw.Draw(layer)
    faces = terrain.solid_faces()
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    light = normals @ np.array([-0.3, 0.3, 0.9]) / np.where(lengths > 0, lengths, 1)
    scale = fine * size / window.side
    places = (faces[:, :, :2] - (window.west, window.south)) * (scale, -scale) + (0, fine * size)
    for k in np.argsort(faces[:, :, 2].max(axis=1)):
        if normals[k, 2] > 0:
            shade = tuple(int(c * np.clip(light[k], 0.4, 1)) for c in SOLID)
            draw.polygon([(x, y) for x, y in places[k].tolist()], fill=(*shade, 255))
    for x, y, _ in [] if terrain.mission is None else terrain.mission["flag_stands"]:
        # They stand below a roof: shown through it.
        centre = ((x - window.west) * scale, fine * size - (y - window.south) * scale)
        draw.circle(
            centre, 3.0 * fine, fill=(*command_map.FLAG, 255), outline=(*command_map.AREA, 255), width=fine
        )
    return layer.resize((size, size), Image.Resampling.LANCZOS)


def _check_range(first: int, last: int, repeating: bool, out: Path) -> None:
    if last < first:
        raise click.BadParameter(f"expected FIRST <= LAST, got {first} {last}", param_hint="--check")
    missed: dict[int, list[str]] = {}
    seconds = []
    with click.progressbar(range(first, last + 1), label="terrains", show_pos=True) as seeds:
        for seed in seeds:
            began = time.perf_counter()
            made = Terrain.raindance(seed, repeating=repeating)
            seconds.append(time.perf_counter() - began)
            rows = [Row(*row) for row in made.acceptance()]
            if not made.is_raindance_like():
                missed[seed] = [row.name for row in rows if not row.inside]
    count = last - first + 1
    for seed, names in missed.items():
        click.echo(f"seed {seed} misses {', '.join(names)}")
    mean, longest = sum(seconds) / count, max(seconds)
    click.echo(
        f"{count - len(missed)} of {count} terrains pass; a terrain took {1e3 * mean:.1f} ms on average, "
        f"{1e3 * longest:.1f} ms at most"
    )
    figures = out / f"check-{first}-{last}.json"
    save(
        figures,
        {
            "first": first,
            "last": last,
            "repeating": repeating,
            "missed": missed,
            "mean_seconds": mean,
            "longest_seconds": longest,
        },
    )
    click.echo(str(figures))
    if missed:
        raise SystemExit(1)
