"""The extremes of a ground that is not ours: its steepest faces, lowest pits, highest tips, rims."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from discjump._native import Terrain
from discjump.simulator import SCENES
from discjump.stress import extremes
from discjump.stress.cases import Case, Setting, Start
from discjump.stress.extremes import SPEEDS, Form, case
from discjump.stress.rules import Floats
from discjump.stress.starts import Generator, directions, start

Places = Callable[[Terrain], Floats]


def vertices(terrain: Terrain) -> tuple[Floats, Floats]:
    """Places (rows, columns, 2) and heights of a terrain's vertices."""
    heights = terrain.heights
    rows, columns = heights.shape
    x = terrain.origin[0] + terrain.square_size * np.arange(columns)
    y = terrain.origin[1] + terrain.square_size * np.arange(rows)
    return np.stack(np.meshgrid(x, y), axis=-1), heights


def most(terrain: Terrain, score: Floats, count: int = 32) -> Floats:
    """The places of the vertices that score most, (count, 2)."""
    places, heights = vertices(terrain)
    best = np.argsort(-score.ravel(), kind="stable")[: min(count, heights.size)]
    found: Floats = places.reshape(-1, 2)[best]
    return found


def steepest(terrain: Terrain) -> Floats:
    """Where the ground rises most."""
    gradient = np.gradient(terrain.heights) if min(terrain.heights.shape) > 1 else [terrain.heights]
    return most(terrain, np.hypot(*gradient))


def lowest(terrain: Terrain) -> Floats:
    """Where the neighbours are highest above a vertex: creases and pits."""
    return most(terrain, curvature(terrain))


def highest(terrain: Terrain) -> Floats:
    """Where the neighbours are deepest below a vertex: ridges and tips."""
    return most(terrain, -curvature(terrain))


def curvature(terrain: Terrain) -> Floats:
    """How much the four neighbours are above a vertex on average, m."""
    padded = np.pad(terrain.heights, 1, mode="edge")
    around = padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]
    above: Floats = 0.25 * around - terrain.heights
    return above


def rims(terrain: Terrain) -> Floats:
    """The vertices of the rim."""
    places, heights = vertices(terrain)
    inner = np.zeros(heights.shape, bool)
    inner[1:-1, 1:-1] = True
    found: Floats = places[~inner]
    return found


def around(rng: Generator, terrain: Terrain, players: int, ticks: int, *, places: Places) -> Start:
    """On and over the ground within a square of such places."""
    found = places(terrain)
    xy = found[rng.integers(0, len(found), players)]
    xy = xy + rng.uniform(-1.0, 1.0, xy.shape) * terrain.square_size
    velocity = directions(rng, players) * rng.uniform(0.0, 60.0, players)[:, None]
    velocity[::4] = 0.0
    above = rng.uniform(0.0, 5.0, players) * (rng.random(players) < 0.7)
    return start(rng, terrain, xy, above, velocity, ticks)


def all_over(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """Anywhere on the map."""
    return around(rng, terrain, players, ticks, places=lambda t: vertices(t)[0].reshape(-1, 2))


def speeding(
    rng: Generator, terrain: Terrain, players: int, ticks: int, *, speeds: tuple[float, ...]
) -> Start:
    """From anywhere on the map at each speed in turn."""
    begun = all_over(rng, terrain, max(players, len(speeds)), ticks)
    speed = np.resize(np.array(speeds), len(begun.position))
    velocity = directions(rng, len(speed)) * speed[:, None]
    return replace(begun, velocity=velocity.astype(np.float32).astype(np.float64))


def cases_on(form: Form, terrain: Terrain, setting: Setting) -> list[Case]:
    """Every case on a given ground; explosions and discs where the scene models them."""
    models = SCENES[setting.scene].models

    def made(
        extreme: str, name: str, begin: extremes.Begin, ticks: int | None = None, tick_ms: int = 32
    ) -> Case:
        uniform = replace(setting, tick_ms=tick_ms)
        return case(form, f"own {extreme}", name, lambda: terrain, begin, ticks, setting=uniform)

    cases = [
        made("ground", "anywhere", all_over),
        made("ground", "steepest faces", partial(around, places=steepest)),
        made("ground", "creases and pits", partial(around, places=lowest)),
        made("ground", "ridges and tips", partial(around, places=highest)),
        made("ground", "rims", partial(around, places=rims)),
        made("speeds", "to 1 km/s", partial(speeding, speeds=SPEEDS[:10])),
    ]
    fast = made("speeds", "to 1e5 m/s", partial(speeding, speeds=(1e4, 1e5)), max(8, form.ticks // 4))
    cases.append(replace(fast, heavy=True))
    if terrain.edge == "tile":
        for away in (1e3, 1e6, 9e8):
            tiles = [max(1, int(away / size)) for size in terrain.size]
            cases.append(replace(made("far", f"{away:g} m", all_over), far=(tiles[0], -tiles[1])))
    for tick_ms in form.pick((1, 8, 16, 64, 257, 1000), (1, 100, 1000)):
        cases.append(made("tick lengths", f"{tick_ms:g} ms", all_over, tick_ms=int(tick_ms)))
    cases.append(made("energies", "thresholds", extremes.at_energies))
    if "blast" in models:
        cases.append(made("blasts", "near, in and under", extremes.blown))
    if "discs" in models:
        cases.append(made("discs", "at the feet", extremes.shooting))
    return cases
