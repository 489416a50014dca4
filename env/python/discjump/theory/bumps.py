"""Ghost bumps: speed that a smooth slope costs for being cut into triangles, or into bilinear patches.

What slides is a player whom nothing brakes but contacts: no keys, and after every tick he is made to forget
that he touched the ground, so that ground friction never acts. On a smooth surface he would keep

    E = v^2 / 2 + g z - g dt v_z / 2

which semi-implicit Euler keeps exactly in the air and along a plane (the last term is what its tick makes of
v^2 / 2 + g z). What E loses is lost to contacts; as a speed, per metre of way, it is the figure told here. At
an edge where the ground turns by an angle a, a contact takes 1 - cos a of the speed across the edge. Squares
of side h on a surface of curvature k turn it by k h every h metres: k^2 h / 2 of the speed per metre.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from discjump._native import Terrain
from discjump.simulator import Physics, Simulator
from discjump.theory.forms import GRAVITY
from discjump.theory.lab import TICK_MS, Floats, State, Tier, exact32, make, start

SQUARES = (8.0, 4.0, 2.0, 1.0)
"""Sides of the squares, m."""
GROUNDS = ("triangles", "bilinear")
"""What a square is: two triangles, or a patch without an edge in it."""
BEARINGS = (0.0, 7.0, 13.0, 19.0, 26.0, 31.0, 38.0, 45.0)
"""Of the way down, degrees from the grid's y axis."""
RADIUS = 100.0
"""Of the curved surfaces, m."""
MOST_TICKS = 600
"""Far beyond the end of every slide that gets there."""
PLAYERS = 16
"""Beside each other, drawn over the width of a square."""


@dataclass(frozen=True)
class Surface:
    """A smooth surface, and a slide down it."""

    #: What it is, for the report.
    what: str
    #: Height at (u, w), m: along the way down and across it.
    height: Callable[[Floats, Floats], Floats]
    #: Where on u the slide begins and ends, m.
    ends: tuple[float, float]
    #: Speed at the beginning, m/s.
    speed: float
    #: Curvature along the way, 1/m.
    curvature: float = 0.0


def _valley(u: Floats, w: Floats) -> Floats:
    inside = np.clip(u, -0.8 * RADIUS, 0.8 * RADIUS)
    z: Floats = RADIUS - np.sqrt(RADIUS**2 - inside**2)
    return z


def _crest(u: Floats, w: Floats) -> Floats:
    return -_valley(u, w)


def _plane(u: Floats, w: Floats) -> Floats:
    z: Floats = -np.tan(np.radians(25.0)) * u
    return z


def _cone(u: Floats, w: Floats) -> Floats:
    z: Floats = -np.tan(np.radians(25.0)) * np.hypot(u, w)
    return z


SURFACES = {
    "plane": Surface("25 degrees steep", _plane, (-45.0, 45.0), 10.0),
    "valley": Surface("a cylinder of 100 m, hollow; across it", _valley, (-60.0, 20.0), 10.0, 1.0 / RADIUS),
    "crest": Surface("a cylinder of 100 m, from its top down", _crest, (5.0, 60.0), 5.0, 1.0 / RADIUS),
    "cone": Surface("25 degrees steep; straight down from 40 m off its tip", _cone, (40.0, 110.0), 10.0),
}
"""By name."""


def cut(surface: Surface, square: float, bearing: float, ground: str = GROUNDS[0]) -> Terrain:
    """The surface sampled at the corners of squares of so many metres, its way down turned by `bearing`."""
    half = 128.0
    axis = square * np.arange(round(2.0 * half / square) + 1) - half
    x, y = np.meshgrid(axis, axis)
    angle = np.radians(bearing)
    u, w = np.sin(angle) * x + np.cos(angle) * y, np.cos(angle) * x - np.sin(angle) * y
    return Terrain.from_heights(surface.height(u, w), square, (-half, -half), "clamp").with_surface(ground)


@dataclass(frozen=True)
class Slide:
    """What came of `PLAYERS` slides."""

    #: Speed lost per metre of way, (m/s)/m, by those whom no bump limit stopped.
    lost: Floats
    #: The same by theory, from edges alone that lie straight across a way of the surface's curvature.
    theory: float
    #: How many had a tick that ended at the bump limit: its time is dropped, so they hang while gravity acts.
    hung: int


def slide(
    tier: Tier, surface: Surface, square: float, bearing: float, ground: str = GROUNDS[0], seed: int = 0
) -> Slide:
    """Slides of players who start beside each other."""
    terrain = cut(surface, square, bearing, ground)
    angle = np.radians(bearing)
    ahead = np.array([np.sin(angle), np.cos(angle)])
    aside = np.array([np.cos(angle), -np.sin(angle)])
    rng = np.random.default_rng(seed)
    begin = surface.ends[0] + rng.uniform(0.0, 8.0, PLAYERS)
    xy = exact32(begin[:, None] * ahead + rng.uniform(-4.0, 4.0, PLAYERS)[:, None] * aside)
    # Along the triangle under the feet, on it.
    normal = terrain.normal(xy)
    climb = -(normal[:, :2] @ ahead) / normal[:, 2]
    along = np.column_stack([np.broadcast_to(ahead, (PLAYERS, 2)), climb])
    velocity = surface.speed * along / np.linalg.norm(along, axis=1, keepdims=True)
    # A dead stop at the limit would hide what the edges take.
    sim = make(tier, terrain, PLAYERS, physics=Physics(ski_bug=False))
    start(sim, {"position": np.column_stack([xy, terrain.height(xy)]), "velocity": velocity})

    inputs = sim.inputs()
    # The first tick may be a landing, for it begins on the ground.
    sim.step(inputs)
    state = forget(sim)
    first, place = energy(tier, state), state["position"]
    lost, way, squares = np.full(PLAYERS, np.nan), np.zeros(PLAYERS), np.zeros(PLAYERS)
    for _ in range(MOST_TICKS):
        sim.step(inputs)
        state = forget(sim)
        speed = np.linalg.norm(state["velocity"].astype(np.float64), axis=1)
        on = np.isnan(lost)
        step = np.linalg.norm(state["position"] - place, axis=1) * on
        way, squares, place = way + step, squares + step * speed**2, state["position"]
        done = on & (place[:, :2] @ ahead >= surface.ends[1])
        kept = np.sqrt(np.maximum(0.0, speed**2 + 2.0 * (first - energy(tier, state))))
        lost[done] = (kept[done] - speed[done]) / way[done]
        if not np.isnan(lost).any():
            break
    hung = np.isnan(lost) | (state["bump_limits"] > 0)
    if hung.all():
        return Slide(np.zeros(0), float("nan"), PLAYERS)
    gone = (0.5 * square * surface.curvature**2 * squares)[~hung]
    # About the mean speed, as one loses v dv = k^2 h v^2 / 2 per metre.
    speeds = np.sqrt(squares[~hung] / way[~hung])
    return Slide(lost[~hung], float(np.mean(gone / (speeds * way[~hung]))), int(hung.sum()))


def measure(
    tier: Tier,
    name: str,
    square: float,
    bearings: Sequence[float] = BEARINGS,
    ground: str = GROUNDS[0],
) -> dict[str, Any]:
    """Slides down one surface in squares of one size, in every bearing.

    Returns:
        `lost`: mean by bearing, (m/s)/m, None where nobody got through without the bump limit; `mean` and
        `worst`: of all slides that did; `theory`: edges alone, straight across; `hung`: how many did not.
    """
    made = [slide(tier, SURFACES[name], square, bearing, ground) for bearing in bearings]
    through = np.concatenate([one.lost for one in made])
    return {
        "surface": name,
        "ground": ground,
        "tier": tier.name,
        "square": square,
        "bearings": list(bearings),
        "lost": [float(one.lost.mean()) if one.lost.size else None for one in made],
        "mean": float(through.mean()) if through.size else None,
        "worst": float(through.max()) if through.size else None,
        "theory": made[0].theory if np.isfinite(made[0].theory) else None,
        "hung": sum(one.hung for one in made),
        "slides": PLAYERS * len(made),
    }


def forget(sim: Simulator) -> State:
    """Make all players forget that they touched the ground; their states."""
    state = sim.state()
    state["touched"] = False
    sim.set_state(state)
    return state


def energy(tier: Tier, state: State) -> Floats:
    """What a smooth surface keeps, J/kg."""
    v = state["velocity"].astype(np.float64)
    # The engine moves at mean speeds, for which v^2/2 + g z itself is kept in the air.
    late = 0.5 * TICK_MS / 1000.0 if tier.model == "article" else 0.0
    kept: Floats = 0.5 * (v**2).sum(axis=1) + GRAVITY * (state["position"][:, 2] - late * v[:, 2])
    return kept
