"""The rows of the matrix: every extreme, and the cases in it (core/docs/physics.md, section 11)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from discjump._native import Terrain
from discjump.stress import grounds
from discjump.stress.cases import Case, Column, Setting, Start, no_keys
from discjump.stress.floor import Floor
from discjump.stress.rules import Floats
from discjump.stress.starts import Generator, directions, generator, lifted, single, start

SPEEDS = (1e-30, 1e-20, 1e-10, 1e-5, 1e-3, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)
"""m/s: from what squares to nothing to what a state may hold."""
TICKS_MS = (1, 2, 8, 16, 31, 33, 64, 100, 255, 256, 257, 1000)


@dataclass(frozen=True)
class Form:
    """How much is played."""

    players: int
    ticks: int
    #: Whether all cases are, or those that tell most in the least time.
    full: bool
    seed: int = 0

    def pick(self, values: Sequence[float], quick: Sequence[float]) -> Sequence[float]:
        """The cases of this form."""
        return values if self.full else quick


FULL = Form(players=96, ticks=96, full=True)
QUICK = Form(players=24, ticks=40, full=False)

Begin = Callable[[Generator, Terrain, int, int], Start]


def case(
    form: Form,
    extreme: str,
    name: str,
    ground: Callable[[], Terrain],
    begin: Begin,
    ticks: int | None = None,
    far: tuple[int, int] | None = None,
    setting: Setting | None = None,
    heavy: bool = False,
) -> Case:
    """A case whose start is drawn from the seed and its name."""

    def begun(terrain: Terrain, column: Column) -> Start:
        rng = generator(form.seed, extreme, name)
        return begin(rng, terrain, form.players, ticks or form.ticks)

    return Case(extreme, name, ground, begun, setting or Setting(), far, heavy)


def anywhere(
    rng: Generator,
    terrain: Terrain,
    players: int,
    ticks: int,
    *,
    within: Floats | float = 200.0,
    above: tuple[float, float] = (0.0, 6.0),
    speed: tuple[float, float] = (0.0, 60.0),
) -> Start:
    """On and over the ground within so many metres of the origin, at speeds any way, a quarter at rest."""
    xy = rng.uniform(-1.0, 1.0, (players, 2)) * within
    height = rng.uniform(*above, players) * (rng.random(players) < 0.7)
    velocity = directions(rng, players) * rng.uniform(*speed, players)[:, None]
    velocity[::4] = 0.0
    return start(rng, terrain, xy, height, velocity, ticks)


def at_speeds(
    rng: Generator, terrain: Terrain, players: int, ticks: int, *, speeds: Sequence[float]
) -> Start:
    """From a few metres up, each speed in turn, any way."""
    count = len(speeds) * max(1, players // (4 * len(speeds)))
    speed = np.resize(np.array(speeds), count)
    xy = rng.uniform(-200.0, 200.0, (count, 2))
    return start(
        rng, terrain, xy, rng.uniform(0.0, 5.0, count), directions(rng, count) * speed[:, None], ticks
    )


def into_spikes(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """At needles, level with a part of them, and onto their tips."""
    square = terrain.square_size
    tip = Floor(terrain).highest
    needle = (np.array([2.0, 2.0]) + 4.0 * rng.integers(0, 6, (players, 2)) - 16.0) * square
    angle = rng.uniform(0.0, 2.0 * np.pi, players)
    way = np.column_stack([np.cos(angle), np.sin(angle)])
    speed = 10.0 ** rng.uniform(1.0, 3.0, players)
    xy = needle - 1.5 * square * way
    xy[::4] = needle[::4] + rng.uniform(-0.1, 0.1, (len(xy[::4]), 2)) * square
    velocity = np.column_stack([way * speed[:, None], rng.uniform(-20.0, 20.0, players)])
    velocity[::4] = np.column_stack([np.zeros((len(xy[::4]), 2)), -speed[::4]])
    above = rng.uniform(0.05, 0.95, players) * tip
    above[::4] = rng.uniform(0.0, 5.0, len(xy[::4]))
    return start(rng, terrain, xy, above, velocity, ticks)


def into_middle(
    rng: Generator, terrain: Terrain, players: int, ticks: int, *, radial: bool, reach: float = 12.0
) -> Start:
    """Down towards the crease at x = 0, or the pit at the origin: dropped, thrown, skied and walked into."""
    xy = rng.uniform(-1.0, 1.0, (players, 2)) * reach
    if not radial:
        xy[:, 1] *= 3.0
    inward = -xy if radial else np.column_stack([-xy[:, 0], rng.uniform(-4.0, 4.0, players)])
    inward /= np.maximum(np.linalg.norm(inward, axis=1, keepdims=True), 1e-9)
    speed = rng.uniform(0.0, 60.0, players) * (rng.random(players) < 0.75)
    velocity = np.column_stack([inward * speed[:, None], -rng.uniform(0.0, 1.0, players) * speed])
    # Along the yaw that looks inward, so that forward keys lead into it.
    yaw = single(np.arctan2(-inward[:, 0], inward[:, 1]))
    return start(rng, terrain, xy, rng.uniform(0.0, 3.0, players), velocity, ticks, yaw=yaw)


def over_edges(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """Along x at and over the brims of cliffs, and at their feet."""
    begun = anywhere(rng, terrain, players, ticks, within=120.0, above=(0.0, 2.0))
    speed = rng.uniform(-80.0, 80.0, players)
    velocity = begun.velocity.copy()
    velocity[:, 0] = speed
    return Start(begun.position, single(velocity), begun.inputs, begun.fields)


def on_lines(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """On grid lines, cuts and vertices, and an ulp beside them."""
    whole = rng.integers(-12, 13, (players, 2)) * terrain.square_size
    off = rng.choice([0.0, 0.0, 3.25], players)
    xy = whole + off[:, None]
    ulps = rng.integers(-1, 2, (players, 2))
    beside = np.nextafter(xy.astype(np.float32), np.where(ulps > 0, np.inf, -np.inf).astype(np.float32))
    xy = np.where(ulps == 0, xy, beside.astype(np.float64))
    velocity = rng.choice([0.0, 15.0, -15.0, 20.0], (players, 2))
    down = -rng.uniform(0.0, 15.0, players)
    return start(rng, terrain, xy, np.full(players, 0.1), np.column_stack([velocity, down]), ticks)


def at_energies(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """Tanks at 0, 1, 5 and full, and an ulp of float32 beside, burning and not, in the air and on ground."""
    full = np.float32(60.0)
    edges = np.array([0.0, 1.0, 5.0, 0.4, 3.0, 60.0], np.float32)
    every = np.concatenate(
        [edges, np.nextafter(edges, np.float32(np.inf)), np.nextafter(edges, np.float32(-np.inf))]
    )
    energy = np.resize(np.clip(every, 0.0, full), players).astype(np.float64)
    burning = (np.arange(players) // len(every)) % 2
    begun = anywhere(rng, terrain, players, ticks, within=50.0)
    inputs = begun.inputs.copy()
    inputs["jet"][:, ::2] = True
    inputs["jet"][10:13] = False
    fields = begun.fields | {"energy": energy, "jetting": burning.astype(np.float64)}
    return Start(begun.position, begun.velocity, inputs, fields)


def blown(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """Explosions at the feet, in the middle of the box to the bit, around, and under the ground."""
    begun = anywhere(rng, terrain, players, ticks, within=50.0, above=(0.0, 3.0), speed=(0.0, 20.0))
    blasts = {}
    for tick in range(2, ticks, 5):
        offset = directions(rng, players) * (10.0 ** rng.uniform(-6.0, 1.0, players))[:, None]
        offset[::3] = 0.0
        offset[1::3, 2] -= rng.uniform(0.0, 2.0, len(offset[1::3]))
        blasts[tick] = begun.position + offset
    # At the very middle of a body at rest: no direction.
    blasts[0] = begun.position + np.array([0.0, 0.0, 1.15])
    return Start(begun.position, begun.velocity, begun.inputs, begun.fields, blasts)


def crowded(rng: Generator, terrain: Terrain, players: int, ticks: int, *, together: int) -> Start:
    """Everybody's explosion at one moment, those of a world all on one point."""
    xy = np.repeat(rng.uniform(-100.0, 100.0, (players // together, 2)), together, axis=0)
    xy += rng.uniform(-4.0, 4.0, xy.shape)
    begun = start(rng, terrain, xy, np.full(len(xy), 0.5), np.zeros((len(xy), 3)), ticks)
    points = begun.position[::together].repeat(together, axis=0) - np.array([0.0, 0.0, 0.25])
    return Start(begun.position, begun.velocity, begun.inputs, begun.fields, {1: points})


def shooting(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """Discs into the ground at the feet, from all at once."""
    begun = anywhere(rng, terrain, players, ticks, within=200.0)
    inputs = begun.inputs.copy()
    inputs["fire"], inputs["pitch"] = True, -1.5
    return Start(begun.position, begun.velocity, inputs, begun.fields)


def buried(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """Under the ground from the beginning: no bound on where they are, but on all else."""
    begun = anywhere(rng, terrain, players, ticks)
    position = begun.position - np.array([0.0, 0.0, 1.0]) * rng.uniform(0.0, 30.0, players)[:, None]
    return Start(single(position), begun.velocity, begun.inputs, begun.fields, buried=True)


def far_away(
    rng: Generator, terrain: Terrain, players: int, ticks: int, *, away: float, seed_of: Begin
) -> Start:
    """A start so many metres off, where the map does not tile and so has fewer digits."""
    begun = seed_of(rng, terrain, players, ticks)
    xy = begun.position[:, :2] + np.array([away, -away])
    above = begun.position[:, 2] - np.nan_to_num(Floor(terrain).height(begun.position[:, :2]))
    position = lifted(Floor(terrain), xy, np.maximum(above, 0.0))
    return Start(position, begun.velocity, begun.inputs, begun.fields)


def beyond_counting(rng: Generator, terrain: Terrain, players: int, ticks: int) -> Start:
    """So far and so fast that the count of tiles comes to its end, 2^30, high above the ground."""
    signs = np.resize([1.0, -1.0], players)
    xy = np.column_stack([9.99e8 * signs, rng.uniform(-100.0, 100.0, players)])
    position = np.column_stack([xy, np.full(players, 9e4)])
    velocity = np.column_stack([1e6 * signs, np.zeros(players), np.full(players, 50.0)])
    return Start(position, velocity, no_keys(ticks, players))


def built_in(form: Form) -> list[Case]:
    """Every case on the suite's own grounds."""
    made = partial(case, form)
    hills = grounds.rolling
    few = max(8, form.ticks // 4)
    cases = [
        made("speeds", "to 1 km/s", hills, partial(at_speeds, speeds=SPEEDS[:10])),
        made("speeds", "1e4 m/s", hills, partial(at_speeds, speeds=[1e4]), few, heavy=True),
        made("speeds", "1e5 m/s", hills, partial(at_speeds, speeds=[1e5]), few, heavy=True),
        made("speeds", "1e6 m/s", hills, partial(at_speeds, speeds=[1e6]), 4, heavy=True),
    ]
    for degrees in form.pick((0, 1, 5, 15, 30, 45, 60), (0, 15, 45)):
        cases.append(made("slopes to 60", f"{degrees:g}", partial(grounds.slope, degrees), anywhere))
    for degrees in form.pick((75, 78.4, 78.5, 85, 89, 89.9, 89.99), (78.5, 89, 89.99)):
        begin = partial(anywhere, within=20.0) if degrees < 89 else partial(anywhere, within=1.5)
        cases.append(made("slopes 75 to 89.99", f"{degrees:g}", partial(grounds.slope, degrees), begin))
    needles = ((10.0, 8.0), (100.0, 8.0), (1e4, 8.0), (20.0, 0.5))
    for height, square in needles if form.full else needles[1::2]:
        ground = partial(grounds.spikes, height, square)
        cases.append(made("spikes", f"{height:g} m on {square:g} m", ground, into_spikes))
    for degrees in (30, 45, 60, 75, 85, 89):
        if form.full or degrees in (30, 60, 75, 89):
            begin = partial(into_middle, radial=False)
            cases.append(made(f"crease {degrees}", "valley", partial(grounds.crease, degrees), begin))
    for degrees in form.pick((45, 60, 75, 85), (60, 75)):
        begin = partial(into_middle, radial=True, reach=6.0)
        cases.append(made("pits", f"{degrees:g}", partial(grounds.pit, degrees), begin))
    for height in form.pick((2, 30, 1000), (30,)):
        cases.append(made("cliffs", f"{height:g} m", partial(grounds.cliffs, height), over_edges))
    for height in form.pick((0, 100, -1e4), (0,)):
        cases.append(made("plain", f"{height:g} m", partial(grounds.plain, height), anywhere))
    for edge in ("tile", "clamp", "void"):
        begin = partial(anywhere, within=12.0)
        cases.append(made("one square", edge, partial(grounds.one_square, edge), begin))
    squares, rows = (4096, 4096) if form.full else (4096, 2)
    begin = partial(anywhere, within=np.array([16000.0, 16000.0 if form.full else 8.0]))
    cases.append(made("4,096 squares", f"{squares} x {rows}", partial(grounds.huge, squares, rows), begin))
    for height in form.pick((1e-6, 1e-3, 1.0, 30.0, 1e3, 1e4), (1e-6, 30.0, 1e4)):
        begin = partial(anywhere, within=60.0)
        cases.append(made("heights", f"{height:g} m", partial(grounds.rough, height), begin))
    cases.append(made("grid lines", "hills", hills, on_lines))
    cases += far_cases(form, hills)
    for tick_ms in form.pick(TICKS_MS, (1, 100, 1000)):
        cases.append(
            made("tick lengths", f"{tick_ms} ms", hills, anywhere, setting=Setting(tick_ms=int(tick_ms)))
        )
    cases += common(form, hills)
    cases.append(made("under the ground", "hills", hills, buried))
    return cases


def far_cases(form: Form, hills: Callable[..., Terrain]) -> list[Case]:
    """Whole tiles away, to the bit; and off maps that do not tile, where f32 has few digits left."""
    made = partial(case, form)
    cases = []
    for away in form.pick((1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9), (1e3, 1e6, 1e9)):
        tiles = max(1, int(away / 512.0) - 1)
        cases.append(made("far, tile", f"{away:g} m", hills, anywhere, far=(tiles, -tiles)))
    lost = Form(4, 90, form.full, form.seed)
    counters = case(
        lost, "far, tile", "2^30 tiles", partial(grounds.plain, edge="tile", square=0.25), beyond_counting
    )
    cases.append(replace(counters, setting=Setting(tick_ms=1000), heavy=True))
    for edge in ("clamp", "void"):
        for away in form.pick((1e3, 1e5, 1e7, 9e8), (1e5, 9e8)):
            begin = partial(far_away, away=away, seed_of=anywhere)
            cases.append(made(f"far, {edge}", f"{away:g} m", partial(hills, edge=edge), begin))
    return cases


def common(form: Form, ground: Callable[[], Terrain]) -> list[Case]:
    """What any ground is asked: energies, explosions, discs."""
    made = partial(case, form)
    crowd = Form(10_000 if form.full else 600, 6, form.full, form.seed)
    together = 100 if form.full else 40
    # Each of those in a world looks at all others in every move.
    worlds = replace(crowd, players=2000 if form.full else 600)
    cases = [
        made("energies", "thresholds", ground, at_energies),
        made("energies", "with a pack", ground, at_energies, setting=Setting(energy_pack=True)),
        made("blasts", "near, in and under", ground, blown),
        case(crowd, "blasts", f"{crowd.players:,} at once", ground, partial(crowded, together=1)),
        case(
            worlds,
            "blasts",
            f"{together} on one point",
            ground,
            partial(crowded, together=together),
            setting=Setting(players_per_world=together),
            heavy=True,
        ),
        case(
            crowd, "discs", f"{crowd.players:,} shooters", ground, shooting, 12, setting=Setting("disc_jump")
        ),
    ]
    return cases
