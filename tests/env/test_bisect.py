"""`discjump.bisect` finds the tick that a plain loop finds, and hands over a replay that shows it again.

Who bisects two tiers, machines or releases acts on one number: the first tick after which a bit differs. It
must be what two simulators stepped side by side say, no tick sooner or later, whatever the frame skip; and an
environment that is played alone, in a batch or on threads must never part from itself.
"""

import itertools
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import discjump
from discjump.bisect import Parting, Side, bisect, ulps
from discjump.bisect.contacts import contact_list
from discjump.bisect.lockstep import differences
from discjump.bisect.sides import SideError, split
from discjump.bisect.start import changes, inputs_of, starting
from discjump.envs.named import SkiEnv
from discjump.replays import EpisodeReplay, TickReplay, load, loads
from discjump.replays.bare.play import Frame

from .recordings import TIERS, bowl, episode, ticks

LONG: dict[str, Any] = {"terrain_seeds": [0], "time_limit": 30.0}


@pytest.fixture(scope="module")
def run() -> EpisodeReplay:
    return episode(seed=4, **LONG)


@pytest.fixture(scope="module")
def path(run, tmp_path_factory):
    return run.save(tmp_path_factory.mktemp("replays") / "run.replay")


def sides(path, b="", a=""):
    one = Side.parsed(f"{path}{a and ','}{a}")
    return one, Side.parsed(b, one) if b else one


def parted(*sides: Side, tolerance: float = 0.0) -> Parting:
    """Where they part, which they do."""
    parting = bisect(sides[0], sides[1], tolerance).parting
    assert parting is not None
    return parting


# ------------------------------------------------------------------------------------ the tick


def first_difference(replay, tier, other):
    """By two environments of a tick per decision, side by side."""
    envs = []
    for fidelity in (tier, other):
        env = SkiEnv(frame_skip=1, fidelity=fidelity, actions=replay.options["actions"], **LONG)
        env.reset(seed=replay.seed)
        envs.append(env)
    one, two = (env.state() for env in envs)
    if any((one[name] != two[name]).any() for name in one.dtype.names or ()):
        return 0
    for tick, action in enumerate(np.repeat(replay.actions, 4, axis=0), 1):
        over = [bool(np.any(env.step(action)[2:4])) for env in envs]
        one, two = (env.state() for env in envs)
        # Numbers: the tiers' dtypes differ.
        if any((one[name] != two[name]).any() for name in one.dtype.names or ()) or over[0] != over[1]:
            return tick
        if any(over):
            break
    return None


@pytest.mark.parametrize("actions", ["multi_discrete", "box"])
@pytest.mark.parametrize("other", ["fast", "swept", "engine"])
def test_two_tiers_part_where_a_plain_loop_says(actions, other, tmp_path):
    replay = episode(seed=4, actions=actions, **LONG)
    one, two = sides(replay.save(tmp_path / "run.replay"), f"fidelity={other}")
    outcome = bisect(one, two)
    expected = first_difference(replay, "authentic", other)
    assert outcome.parting is not None
    assert outcome.parting.tick == expected
    assert outcome.parting.difference.field.startswith("state.")


def test_float64_parts_by_metres_where_a_plain_loop_says(run, path):
    parting = parted(*sides(path, "fidelity=reference"), tolerance=0.001)
    envs = [SkiEnv(frame_skip=1, fidelity=fidelity, **LONG) for fidelity in ("authentic", "reference")]
    for env in envs:
        env.reset(seed=run.seed)
    tick = 0
    for action in np.repeat(run.actions, 4, axis=0):
        tick += 1
        for env in envs:
            env.step(action)
        one, two = (env.state()["position"] for env in envs)
        if np.sqrt(((one - two) ** 2).sum()) > 0.001:
            break
    assert parting.tick == tick
    assert parting.difference.metres == pytest.approx(np.linalg.norm(one - two))
    # Their digits differ from the beginning.
    assert parted(*sides(path, "fidelity=reference")).tick == 0


@pytest.mark.parametrize("fidelity", TIERS)
def test_an_action_held_for_ticks_is_a_decision(fidelity):
    """A tick per decision, its action repeated, gives the states of the frame skip: bisect rests on it."""
    replay = episode(seed=4, fidelity=fidelity, terrain_seeds=[0], time_limit=10.0, frame_skip=3)
    frames = list(replay.play())
    shown = [frame for frame in frames if "decision.state" in frame.values]
    assert len(shown) == len(replay.actions)
    for frame in shown:
        assert frame.values["state"].tobytes() == frame.values["decision.state"].tobytes()
    assert frames[-1].over
    assert frames[-1].tick == len(frames) - 1
    assert frames[-1].values["state"].tobytes() == replay.arrays["final"].tobytes()


@pytest.mark.parametrize(
    "way", ["threads=2", "lanes=1,batch=5", "batch=64,index=63", "threads=3,batch=600,index=0", "batch=9"]
)
def test_nothing_parts_among_others(path, run, way):
    outcome = bisect(*sides(path, way))
    assert outcome.parting is None
    assert outcome.ticks == len(list(run.play())) - 1


@pytest.mark.parametrize("way", ["threads=2,batch=300,index=7", "lanes=1", "batch=4"])
def test_no_ticks_part_among_others(tmp_path, way):
    assert bisect(*sides(ticks().save(tmp_path / "t.replay"), way)).parting is None


def test_what_differs_from_the_beginning(path):
    parting = parted(*sides(path, "seed=5"))
    assert (parting.tick, parting.before) == (0, None)
    assert parting.difference.field == "state.position[0]"


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ("reward.progress=0.5", "reward"),
        ("arrival_radius=9.5", None),
        ("fan_ranges=[30]", "observation (how many)"),
        ("time_limit=2.0", "terminated"),
    ],
)
def test_what_is_no_state_parts_too(path, change, field):
    parting = bisect(*sides(path, change)).parting
    if field is None:
        assert parting is None
        return
    assert parting is not None
    if change.startswith("time_limit"):
        # Ticks of 32 ms: 62.5 of them, so the clock runs out after the 62nd or 63rd.
        assert parting.tick in (62, 63)
        assert parting.difference.field == "truncated"
    elif change.startswith("fan"):
        assert (parting.tick, parting.difference.field) == (0, field)
    else:
        assert (parting.tick, parting.difference.field) == (4, field)


def test_other_actions_part_as_actions(run, path, tmp_path):
    rows = run.actions.copy()
    rows[9, 4] = (rows[9, 4] + 1) % 7
    other = run.changed(arrays={"actions": rows}).save(tmp_path / "other.replay")
    parting = parted(Side.parsed(str(path)), Side.parsed(str(other)))
    assert (parting.tick, parting.difference.field) == (9 * 4 + 1, "action[4]")


def test_one_that_ends_sooner_parts_there(run, path, tmp_path):
    short = run.changed(arrays={"actions": run.actions[:9]}).save(tmp_path / "short.replay")
    parting = parted(Side.parsed(str(path)), Side.parsed(str(short)))
    assert (parting.tick, parting.difference.field) == (36, "end")
    assert (parting.difference.a, parting.difference.b) == ("goes on", "over")


def test_contacts_lie_on_the_ground_with_its_normals(tmp_path):
    """Where two tiers part at a crease: of faces that are there, and in the sliced tier on them.

    (`fast` knows no second face along a tick, and may be under it.)
    """
    both = sides(episode(seed=10, **LONG).save(tmp_path / "crease.replay"), "fidelity=fast")
    parting = parted(*both)
    ground = discjump.Terrain.raindance(0)
    told = contact_list(both, parting)
    assert told[0] != told[1]
    assert [len(lines) for lines in told] == [2, 2]
    for sliced, line in [(True, line) for line in told[0]] + [(False, line) for line in told[1]]:
        numbers = [float(number) for number in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", line)]
        position, normal = np.array(numbers[:3]), np.array(numbers[6:])
        # Either face where the contact is on the edge between two.
        near = position[:2] + 1e-3 * np.array([*itertools.product((-1, 0, 1), repeat=2)])
        assert np.abs(ground.normal(near) - normal).max(axis=1).min() < 1e-5
        assert not sliced or abs(ground.height(position[:2][None])[0] - position[2]) < 0.02


# ------------------------------------------------------------------------------------ the replay from there


@pytest.mark.parametrize("actions", ["multi_discrete", "box"])
@pytest.mark.parametrize("tier", ["authentic", "reference"])
def test_the_replay_starts_there_and_shows_the_same_difference(actions, tier, tmp_path):
    """Also: the keys that it holds are those that the actions stood for, to the last bit of the turn."""
    replay = episode(seed=4, actions=actions, fidelity=tier, **LONG)
    other = "fast" if tier == "authentic" else "authentic"
    both = sides(replay.save(tmp_path / "run.replay"), f"fidelity={other}")
    parting = parted(*both, tolerance=0.0 if tier == "authentic" else 0.0005)
    assert parting is not None
    made = starting(both, parting)
    assert isinstance(made, TickReplay)
    assert made.verify() is None
    assert parting.before is not None
    assert made.arrays["state"].tobytes() == parting.before[0].values["state"].tobytes()
    # The rest of A's run, bit for bit: an environment and a simulator are one.
    rest = [frame.values["state"] for frame in replay.play()][parting.tick - 1 :]
    again = [frame.values["state"] for frame in made.play()][: len(rest)]
    assert [state.tobytes() for state in again] == [state.tobytes() for state in rest]

    path = made.save(tmp_path / "start.replay")
    one = Side.parsed(str(path))
    assert load(path).to_bytes() == made.to_bytes()
    changed = changes(both, made)
    assert changed == f"fidelity={other}"
    if tier == "authentic":
        found = parted(one, Side.parsed(changed, one))
        assert found.tick == 1
        assert found.difference.field == parting.difference.field
        assert (found.difference.a, found.difference.b) == (parting.difference.a, parting.difference.b)


def test_a_replay_of_ticks_starts_later_with_its_discs_and_explosions(tmp_path):
    whole = ticks(length=90)
    spoilt = whole.inputs
    spoilt["turn"][50, 2] += 0.5
    other = whole.changed(arrays={"inputs": spoilt})
    both = (Side("a", whole), Side("b", other))
    parting = parted(*both)
    assert (parting.tick, parting.difference.field, parting.difference.row) == (51, "inputs.turn", 2)
    made = loads(starting(both, parting).to_bytes())
    assert made.verify() is None
    for one, two in zip(itertools.islice(whole.play(), 50, None), made.play(), strict=True):
        for name in ("state", "projectiles", "blasts"):
            if name != "blasts" or two.tick:
                assert one.values[name].tobytes() == two.values[name].tobytes()
    early = starting(
        both, bisect(Side("a", whole), Side("b", whole.changed({"players": 3}))).parting or parting
    )
    assert len(early.arrays["inputs"]) == 40


def test_where_only_rewards_differ_the_episode_is_kept_up_to_there(path):
    both = sides(path, "reward.time=-1")
    made = starting(both, parted(*both))
    assert isinstance(made, EpisodeReplay)
    assert len(made.actions) == 1
    assert made.verify() is None
    assert changes(both, made) == "reward.time=-1"


# ------------------------------------------------------------------------------------ numbers


FLOATS = st.one_of(
    st.floats(width=32, allow_nan=False).map(np.float32), st.floats(allow_nan=False).map(np.float64)
)


@given(FLOATS, st.integers(0, 40), st.booleans())
def test_ulps_are_steps_to_the_neighbour(start, steps, up):
    number = end = start
    with np.errstate(over="ignore", under="ignore"):
        for _ in range(steps):
            end = np.nextafter(end, type(end)(np.inf if up else -np.inf))
    taken = steps
    if np.isinf(end):
        assert ulps(number, end) <= taken
    else:
        assert ulps(number, end) == taken
    assert ulps(end, number) == ulps(number, end)


def test_ulps_of_larger_gaps_and_of_no_numbers():
    assert ulps(np.float32(1.0), np.float32(2.0)) == 2**23
    assert ulps(1.0, 1.0 + 5 * np.spacing(1.0)) == 5
    assert ulps(np.float32(-0.0), np.float32(0.0)) == 0
    assert ulps(np.float64(1.0) + 1e-12, np.float32(1.0)) == 0
    assert ulps(np.nan, 1.0) is None
    assert ulps(np.int32(1), np.int32(2)) is None
    assert ulps(True, False) is None


def frame(value, dtype="f4"):
    state = np.zeros(2, [("position", "f8", 3), ("velocity", dtype, 3)])
    state["velocity"][1, 2] = value
    return Frame(1, False, {"state": state})


@pytest.mark.parametrize(
    ("a", "b"), [(0.0, -0.0), (1.0, np.nextafter(np.float32(1), np.float32(2))), (np.nan, 1.0)]
)
def test_one_bit_is_seen(a, b):
    (found,) = differences(frame(a), frame(b), 0.0)
    assert (found.field, found.row) == ("state.velocity[2]", 1)
    assert not list(differences(frame(a), frame(a), 0.0))


def test_numbers_of_two_lengths_are_compared_as_numbers():
    assert not list(differences(frame(0.5), frame(0.5, "f8"), 0.0))
    (found,) = differences(frame(np.float32(0.1)), frame(0.1, "f8"), 0.0)
    assert (found.ulps, found.counted) == (0, "float32")


@pytest.mark.parametrize("fidelity", ["reference", "authentic"])
def test_keys_are_those_of_the_environment(fidelity):
    """Every bin, and every sixteenth of a box, moves a simulator as it moves the environment."""
    real = np.dtype(np.float64 if fidelity == "reference" else np.float32)
    for kind, rows in (
        ("multi_discrete", np.array([*itertools.product(range(3), range(3), range(2), range(2), range(7))])),
        ("box", np.random.default_rng(0).integers(-16, 17, (200, 5)).astype(np.float32) / np.float32(16)),
    ):
        env = SkiEnv(terrain_seeds=[0], frame_skip=1, fidelity=fidelity, actions=kind, time_limit=60.0)
        env.reset(seed=0, options={"start": (0.0, 40.0), "goal": (0.0, 40000.0)})
        sim = discjump.Simulator(env.terrain, 1, "ski", fidelity=fidelity)
        sim.set_state(np.array([env.state()], sim.state_dtype))
        for action, keys in zip(rows, inputs_of(rows, 2.34375, real), strict=True):
            env.step(action)
            sim.step(np.array([keys]))
            assert sim.state()[0].tobytes() == env.state().tobytes()


# ------------------------------------------------------------------------------------ what is typed


def test_sides_as_one_types_them(path):
    assert split("a,b.replay,threads=3,fidelity=fast") == ("a,b.replay", {"threads": 3, "fidelity": "fast"})
    side = Side.parsed(f"{path},physics.ski_bug=true,seed=8,threads=2")
    assert side.replay.options["physics"]["ski_bug"] is True
    assert isinstance(side.replay, EpisodeReplay)
    assert side.replay.seed == 8
    assert (side.way.threads, side.way.batch, side.way.index) == (2, 1024, 512)
    assert Side.parsed("armor=heavy", side).replay.options["armor"] == "heavy"


def test_another_surface_of_ones_own_ground(tmp_path):
    replay = episode(terrains=[bowl()], goal_distance=(20.0, 60.0))
    both = sides(replay.save(tmp_path / "own.replay"), "surface=bilinear")
    assert bisect(*both).parting is not None
    tick = TickReplay.record(bowl(), ticks().inputs, scene="ski").save(tmp_path / "t.replay")
    assert bisect(*sides(tick, "surface=bilinear")).parting is not None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("fidelty=fast", "fidelty: expected one of seed, episode, threads"),
        ("frame_skip=2", "frame_skip: expected one of"),
        ("tick_ms=16", "tick_ms: expected one of"),
        ("physics.gravity=3", r"physics\.gravity: expected one of"),
        ("threads=0", "threads: expected an integer from 1 to 256, got 0"),
        ("batch=4,index=4", "index: expected an integer from 0 to 3, got 4"),
        ("batch=many", "batch: expected an integer"),
        ("seed=-1", "seed: expected an integer from 0"),
        ("episode=1.5", "episode: expected an integer"),
    ],
)
def test_sides_that_are_none(path, text, message):
    with pytest.raises((SideError, ValueError, TypeError), match=message):
        sides(path, text)


@pytest.mark.parametrize("text", ["fidelity=exact", "armor=7", "lanes=3", "turn_rate=-2"])
def test_sides_that_cannot_be_run(path, text):
    with pytest.raises(SideError, match=text.partition("=")[0]):
        bisect(*sides(path, text))
