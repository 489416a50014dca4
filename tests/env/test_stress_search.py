"""Random search over terrain, states and keys, with shrinking, by the checks of `discjump stress`."""

import os
from typing import Any

import hypothesis.extra.numpy as hnp
import numpy as np
from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st

import discjump
from discjump.stress import play, repeats
from discjump.stress.blasts import blasts
from discjump.stress.cases import PRECISIONS, SURFACES, TIERS, Case, Column, Setting, Start
from discjump.stress.checks import judge
from discjump.stress.expected import expected
from discjump.stress.floor import Floor
from discjump.stress.starts import lifted, single

PLAYERS = 3

COLUMNS = st.builds(
    Column, st.sampled_from(TIERS), st.sampled_from(PRECISIONS), st.sampled_from(SURFACES)
).filter(lambda column: (column.tier, column.precision) != ("reference", "float32"))

SETTINGS = st.builds(
    Setting,
    scene=st.sampled_from(["ski", "sandbox", "disc_jump"]),
    armor=st.sampled_from(["light", "medium", "heavy"]),
    energy_pack=st.booleans(),
    tick_ms=st.sampled_from([32, 1, 16, 33, 100, 1000]),
    physics=st.builds(
        discjump.Physics,
        ski_bug=st.sampled_from([None, False, True]),
        hysteresis=st.booleans(),
        clamp_fixup=st.booleans(),
        fixup_swept=st.booleans(),
    ),
)


@st.composite
def terrains(draw: Any) -> discjump.Terrain:
    """Two to seven vertices either way, of any steepness."""
    rows, cols = draw(st.integers(2, 7)), draw(st.integers(2, 7))
    scale = draw(st.sampled_from([0.0, 1e-6, 1e-3, 1.0, 30.0, 1e3, 1e4]))
    shares = draw(hnp.arrays(np.float32, (rows, cols), elements=st.floats(-1, 1, width=32)))
    heights = (shares * np.float32(scale)).astype(np.float64)
    edge = draw(st.sampled_from(["tile", "clamp", "void"]))
    if edge == "tile":
        heights[-1], heights[:, -1] = heights[0], heights[:, 0]
        heights[-1, -1] = heights[0, 0]
    return discjump.Terrain.from_heights(heights, draw(st.sampled_from([8.0, 1.0, 0.25, 100.0])), edge=edge)


@st.composite
def starts(draw: Any, terrain: discjump.Terrain, column: Column, setting: Setting) -> Start:
    """A few players on or above the ground, and up to twelve ticks of keys."""
    size = np.array(terrain.size)
    spot = st.floats(-0.25, 1.25, width=32)
    # In steps that the simulator's float32, counted from the middle, has too: a hair beyond a rim with
    # nothing behind it would be lifted onto no ground, and then begin inside the map, buried.
    xy = np.array([[draw(spot), draw(spot)] for _ in range(PLAYERS)]) * size + terrain.origin
    xy = np.rint(xy * 1024.0) / 1024.0
    above = np.array([draw(st.one_of(st.just(0.0), st.floats(0.0, 50.0))) for _ in range(PLAYERS)])
    # Who is faster would only cost time.
    limit = min(1e6, 400.0 * 1000.0 / setting.tick_ms)
    fast = st.sampled_from([1e-30, 1e-6, 0.1, 1.0, 30.0, 300.0, limit])
    velocity = np.array(
        [[draw(st.floats(-1, 1, width=32)) for _ in range(3)] for _ in range(PLAYERS)]
    ) * draw(fast)
    rest = st.floats(0.0, 1.0, width=32)
    inputs = np.zeros((draw(st.integers(1, 12)), PLAYERS), discjump.INPUT)
    for row in inputs:
        for name, values in (
            ("forward", st.integers(-1, 1)),
            ("strafe", st.integers(-1, 1)),
            ("jump", st.booleans()),
            ("jet", st.booleans()),
            ("fire", st.booleans()),
            ("turn", st.sampled_from([0.0, 3.0, -1000.0])),
            ("pitch", st.sampled_from([0.0, -1.5, 1e300])),
        ):
            row[name] = draw(values)
    fields = {
        "yaw": single(np.array([draw(st.floats(-3, 3, width=32)) for _ in range(PLAYERS)])),
        "energy": single(np.full(PLAYERS, 60.0 * draw(rest))),
        "friction": single(np.full(PLAYERS, draw(rest))),
        "touched": np.full(PLAYERS, draw(st.booleans())),
    }
    points = {}
    if setting.scene != "ski" and draw(st.booleans()):
        points[0] = lifted(Floor(terrain), xy, np.zeros(PLAYERS)) + draw(st.floats(-3, 3, width=32))
    position = lifted(Floor(terrain), np.clip(xy, -9e8, 9e8), above)
    return Start(position, single(velocity), inputs, fields, points)


@st.composite
def cases(draw: Any) -> tuple[Case, Column]:
    terrain, column, setting = draw(terrains()), draw(COLUMNS), draw(SETTINGS)
    start = draw(starts(terrain.with_surface(column.surface), column, setting))
    return Case("own ground", "drawn", lambda: terrain, lambda *_: start, setting), column


# The same draws every time, so that a failure is about the change; others with `DISCJUMP_SEARCH` set.
@settings(
    max_examples=150,
    deadline=None,
    derandomize="DISCJUMP_SEARCH" not in os.environ,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(cases())
def test_nothing_is_found_that_is_not_expected(drawn):
    case, column = drawn
    terrain, start = play.prepared(case, column)
    record = play.play(terrain, start, column, case.setting)
    found = [*judge(record), blasts(record), repeats.repeat(record, crowd=False)]
    note(f"{column}, {case.setting}, heights {terrain.heights.tolist()}, squares of {terrain.square_size} m")
    assert [f for f in found if f is not None and expected(column, case.label, f) is None] == []
