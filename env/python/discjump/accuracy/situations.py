"""The eight situations. Each is played on several grounds; starts and keys are drawn, from fixed seeds."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from discjump._native import Terrain
from discjump.accuracy import grounds, scripts
from discjump.accuracy.bridge import bridge
from discjump.accuracy.plays import Places, Play, browse

Generator = np.random.Generator
Maker = Callable[[Generator, str, Terrain, int, int], Play]

CREASES = (30.0, 37.5, 45.0, 60.0)
"""Slopes of the sides of the valleys, degrees."""
JUMP, FIRE = 24, 312
"""Ticks of the disc jump and of the shot in `blast`: long enough after the start to stand still."""


@dataclass(frozen=True)
class Situation:
    """What is played, and where."""

    #: One sentence for the report.
    what: str
    #: Grounds by name, made when asked for.
    grounds: Callable[[], dict[str, Terrain]]
    #: (generator, name of the ground, terrain, players, ticks) to a play.
    make: Maker

    def plays(self, seed: int, starts: int, ticks: int) -> list[Play]:
        """`starts` players, shared out evenly among the grounds. Other seeds draw other starts and keys."""
        made = self.grounds()
        shares = [starts // len(made) + (index < starts % len(made)) for index in range(len(made))]
        return [
            self.make(np.random.default_rng([seed, index]), name, terrain, share, ticks)
            for index, ((name, terrain), share) in enumerate(zip(made.items(), shares, strict=True))
            if share
        ]


def ski(rng: Generator, name: str, terrain: Terrain, count: int, ticks: int) -> Play:
    """Downhill to begin with, jump and forward held, in gentle curves."""
    places = browse(rng, terrain, count)
    velocity = places.along(terrain, rng.uniform(0.0, 20.0, count))
    inputs = scripts.turning(rng, scripts.held(ticks, count, forward=1, jump=True))
    return Play(name, terrain, "sandbox", places.above(terrain), velocity, places.yaw, inputs)


def jet(rng: Generator, name: str, terrain: Terrain, count: int, ticks: int) -> Play:
    """As `ski`, with jets in bursts and sideways keys."""
    places = browse(rng, terrain, count)
    velocity = places.along(terrain, rng.uniform(5.0, 25.0, count))
    inputs = scripts.turning(rng, scripts.held(ticks, count, forward=1, jump=True))
    inputs = scripts.bursts(rng, inputs)
    return Play(name, terrain, "sandbox", places.above(terrain), velocity, places.yaw, inputs)


def crest(rng: Generator, name: str, terrain: Terrain, count: int, ticks: int) -> Play:
    """Uphill at 30 to 50 m/s at a ridge 30 to 110 m away, and over it."""

    def before_ridge(places: Places) -> NDArray[np.bool_]:
        reach = np.arange(0.0, 162.0, 2.0)
        xy = places.xy[:, None] + reach[:, None] * places.ahead[:, None]
        profile = terrain.height(xy.reshape(-1, 2)).reshape(len(places.xy), -1)
        top = profile.argmax(axis=1)
        rise = profile.max(axis=1) - profile[:, 0]
        beyond = np.minimum(top + 20, len(reach) - 1)
        fall = profile.max(axis=1) - profile[np.arange(len(top)), beyond]
        away = reach[top]
        near: NDArray[np.bool_] = (away >= 30.0) & (away <= 110.0) & (rise >= 6.0) & (fall >= 6.0)
        return near

    places = browse(rng, terrain, count, before_ridge, uphill=True)
    velocity = places.along(terrain, rng.uniform(30.0, 50.0, count))
    inputs = scripts.held(ticks, count, forward=1, jump=True)
    return Play(name, terrain, "sandbox", places.above(terrain), velocity, places.yaw, inputs)


def crease(rng: Generator, name: str, terrain: Terrain, count: int, ticks: int) -> Play:
    """Down one side of a valley and up the other, within 30 degrees of straight across, in gentle curves."""
    x = grounds.PERIOD * rng.integers(-3, 4, count) + rng.uniform(10.0, 50.0, count)
    places = Places(
        np.column_stack([x, rng.uniform(-200.0, 200.0, count)]).astype(np.float32).astype(np.float64),
        np.pi / 2 + rng.uniform(-np.pi / 6, np.pi / 6, count),
    )
    velocity = places.along(terrain, rng.uniform(0.0, 20.0, count))
    inputs = scripts.turning(rng, scripts.held(ticks, count, forward=1, jump=True), most=0.2)
    return Play(name, terrain, "sandbox", places.above(terrain), velocity, places.yaw, inputs)


def landing(rng: Generator, name: str, terrain: Terrain, count: int, ticks: int) -> Play:
    """Falling at 25 to 60 m/s from 3 to 10 m above a slope of 10 to 50 degrees, and skiing on."""

    places = browse(rng, terrain, count, partial(_sloped, terrain, 10.0, 50.0))
    velocity = rng.uniform(0.0, 15.0, count)[:, None] * np.column_stack([places.ahead, np.zeros(count)])
    velocity[:, 2] = -rng.uniform(25.0, 60.0, count)
    inputs = scripts.held(ticks, count, forward=1, jump=True)
    above = places.above(terrain, rng.uniform(3.0, 10.0, count))
    return Play(name, terrain, "sandbox", above, velocity, places.yaw, inputs)


def blast(rng: Generator, name: str, terrain: Terrain, count: int, ticks: int) -> Play:
    """A disc jump from rest, then skiing on; half of them fire a disc at the ground after 10 s.

    The explosion of the disc jump goes off at a point on the ground within half a metre of the start, 1 to 8
    ticks after the jump. Below its peak a push grows by 14 m/s for each metre of distance
    (core/docs/physics.md, section 6), so every disc multiplies an error: with one every two seconds even
    `reference` forgets its start within 20 s, and nothing could be told about the tiers.
    """
    # From about 41 degrees on, who has once slid goes on sliding.
    places = browse(rng, terrain, count, partial(_sloped, terrain, 0.0, 35.0))
    inputs = scripts.turning(rng, scripts.held(ticks, count, forward=1, jump=True))
    # Standing still up to the jump, or the point would not be where the feet are.
    inputs["forward"][:JUMP] = 0
    inputs["jump"][:JUMP] = False
    inputs["turn"][:JUMP] = 0.0
    inputs["pitch"] = np.float32(-1.5)
    inputs["fire"][FIRE : FIRE + 1, ::2] = True

    xy = places.xy + rng.uniform(-0.35, 0.35, (count, 2))
    xy = xy.astype(np.float32).astype(np.float64)
    points = np.column_stack([xy, terrain.height(xy)])
    delay = rng.integers(1, 9, count)
    blasts = {JUMP + n: np.where((delay == n)[:, None], points, np.nan) for n in range(1, 9)}
    rest = np.zeros((count, 3))
    return Play(name, terrain, "disc_jump", places.above(terrain, 0.05), rest, places.yaw, inputs, blasts)


def _sloped(terrain: Terrain, least: float, most: float, places: Places) -> NDArray[np.bool_]:
    """Where the slope is between two angles, degrees."""
    slope = np.degrees(np.arccos(terrain.normal(places.xy)[:, 2]))
    between: NDArray[np.bool_] = (slope >= least) & (slope <= most)
    return between


def _creases() -> dict[str, Terrain]:
    return {f"{degrees:g} degrees": grounds.creased(degrees) for degrees in CREASES}


def _steep() -> dict[str, Terrain]:
    return {f"rough hills {seed}": grounds.steep(seed) for seed in range(4)}


SITUATIONS = {
    "ski": Situation("forward and jump held, in gentle curves, on generated hills", grounds.rolling, ski),
    "jet": Situation("the same with jets in bursts and sideways keys", grounds.rolling, jet),
    "crest": Situation("at 30 to 50 m/s uphill and over a ridge", grounds.rolling, crest),
    "crease": Situation("through V valleys with sides of 30, 37.5, 45 and 60 degrees", _creases, crease),
    "steep": Situation("as ski, on rough hills with a median slope of 60 degrees", _steep, ski),
    "landing": Situation("falls onto slopes at 25 to 60 m/s, then skiing", grounds.rolling, landing),
    "blast": Situation(
        "a disc jump, then skiing; every other one fires a disc at the ground after 10 s",
        grounds.rolling,
        blast,
    ),
    "bridge": Situation(
        "running and skiing over the mission's bridge and through a base", grounds.rolling, bridge
    ),
}
"""All situations by name."""
