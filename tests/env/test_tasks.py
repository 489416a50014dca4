"""What every task keeps to: gymnasium's and stable-baselines3's checkers, conformance, words for bad input.

Contract: all tasks have the front ends of `discjump/Ski-v0`; whoever writes for one of them may put another
id in its place.
"""

import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import discjump
from discjump.bisect import Side, bisect
from discjump.envs import infos, named
from discjump.envs.tasks import TASKS
from discjump.replays import load, loads, record
from discjump.testing import check_vector_env

from .play import same_bits
from .recordings import bowl

ARMED = [name for name in TASKS if name != "ski"]
ONE_MAP: dict[str, Any] = {"terrain_seeds": [0]}
VARIANTS: dict[str, dict[str, Any]] = {
    "default": {},
    "box": {"actions": "box"},
    "easy, heavy": {"difficulty": "easy", "armor": "heavy", "energy_pack": True},
    "hard, medium": {"difficulty": "hard", "armor": "medium"},
    "curriculum, float64": {"curriculum": True, "fidelity": "reference"},
}
HERE = discjump.Terrain.raindance(0)
STANDS = ((-60.0, 0.0), (60.0, 20.0))


def vector(name, num_envs=3, **options):
    made: Any = getattr(named, TASKS[name].classes[1])(num_envs, **{**ONE_MAP, **options})
    return made


def single(name, **options):
    made: Any = getattr(named, TASKS[name].classes[0])(**{**ONE_MAP, **options})
    return made


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("name", TASKS)
class TestCheckers:
    """Other people's, without a warning."""

    @pytest.fixture
    def env(self, name, variant):
        made = gymnasium.make(TASKS[name].id, render_mode="rgb_array", **ONE_MAP, **VARIANTS[variant])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield made.unwrapped

    def test_gymnasium(self, env):
        check_env(env)

    def test_stable_baselines3(self, env):
        env_checker = pytest.importorskip("stable_baselines3.common.env_checker")
        env_checker.check_env(env)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
@pytest.mark.parametrize("name", TASKS)
def test_conformance(name, mode):
    def make(num_envs):
        options = {"time_limit": 2.0, "autoreset_mode": mode, "curriculum": mode == "SameStep"}
        return vector(name, num_envs, **options)

    assert check_vector_env(make, num_envs=3, steps=40).passed


@pytest.mark.parametrize("name", TASKS)
def test_conformance_with_callables(name):
    def make(num_envs):
        functions = {"observation_fn": half, "reward_fn": speed}
        return vector(name, num_envs, time_limit=2.0, **functions)

    assert check_vector_env(make, num_envs=3, steps=40).passed


def half(observations):
    return observations.array / 2


def speed(transition):
    return transition.after["speed"].astype(float)


WRONG = {
    **{
        (name, str(options)): (name, options, kind, words)
        for name in TASKS
        for options, kind, words in [
            (
                {"difficulty": "medium"},
                ValueError,
                "difficulty: expected one of 'easy', 'standard', 'hard', got 'm",
            ),
            ({"difficulty": 1}, TypeError, "difficulty: expected one of .* got 1 of type int"),
            ({"curriculum": 1}, TypeError, "curriculum: expected True or False, got 1 of type int"),
            ({"armor": "Light"}, ValueError, "armor: expected one of .* got 'Light'; did you mean 'light'"),
            ({"start_speed": -1}, ValueError, r"start_speed: expected a number in \[0, 100\] m/s, got -1"),
            ({"reward": {"climb": np.inf}}, ValueError, r"reward\['climb'\]: expected a number"),
            ({"observation_fn": 1}, TypeError, "observation_fn: expected a callable, got 1"),
        ]
    },
    **{
        (name, str(options)): (name, options, kind, words)
        for name in ARMED
        for options, kind, words in [
            ({"ammo": -1}, ValueError, "ammo: expected an integer from 0 to 1000000, got -1"),
            ({"ammo": 3.0}, TypeError, "ammo: expected an integer from 0 to 1000000, got 3.0 of type float"),
            ({"goal_distance": (1, 2)}, TypeError, "goal_distance: expected one of the options"),
        ]
    },
    **{
        ("disc-jump", str(options)): ("disc-jump", options, kind, words)
        for options, kind, words in [
            (
                {"marker_height": 60.0},
                TypeError,
                "marker_height: expected a sequence of two numbers in m, got 60",
            ),
            (
                {"marker_height": (80, 60)},
                ValueError,
                r"marker_height: expected least <= largest, got \(80, 60\)",
            ),
            ({"marker_height": (1,)}, ValueError, "marker_height: expected two numbers in m, got 1"),
            (
                {"marker_height": (0, np.nan)},
                ValueError,
                r"marker_height\[1\]: expected a number in \[0, 1e\+06\]",
            ),
            (
                {"marker_offset": -1},
                ValueError,
                r"marker_offset: expected a number in \[0, 1e\+06\] m, got -1",
            ),
            (
                {"start_height": 1001},
                ValueError,
                r"start_height: expected a number in \[0, 1000\] m, got 1001",
            ),
        ]
    },
    **{
        (name, str(options)): (name, options, kind, words)
        for name in ("route", "flag-run")
        for options, kind, words in [
            ({"flags": 3}, TypeError, "flags: expected a sequence of two places in m, got 3"),
            ({"flags": (STANDS[0],)}, ValueError, "flags: expected two places in m, got 1"),
            ({"flags": (STANDS[0], (1.0,))}, ValueError, r"flags\[1\]: expected .* got shape \(1,\)"),
            ({"flags": (STANDS[0], (np.nan, 1.0))}, ValueError, r"flags"),
            (
                {"flags": (STANDS[0], STANDS[0])},
                ValueError,
                r"flags(\[0\])?: expected more than 5 m between them, got 0",
            ),
            (
                {"flags": (STANDS[0], (9e5, 0.0))},
                ValueError,
                r"flags(\[0\])?: expected places within the area",
            ),
            ({"start_distance": (5.0, 1.0)}, ValueError, "start_distance: expected least <= largest"),
            ({"terrains": [bowl()]}, ValueError, r"terrains\[0\]: expected one with a mission, .* or flags="),
        ]
    },
}


@pytest.mark.parametrize(
    ("name", "options", "kind", "words"), WRONG.values(), ids=lambda value: str(value)[:40]
)
@pytest.mark.parametrize("many", [False, True])
def test_bad_options(name, options, kind, words, many):
    with pytest.raises(kind, match=f"^{words}"):
        (vector if many else single)(name, **options)


@pytest.mark.parametrize("name", TASKS)
def test_bad_actions_and_places_change_nothing(name):
    envs = vector(name)
    envs.reset(seed=0)
    envs.action_space.seed(0)
    good = envs.action_space.sample()
    before = envs._task.batch.digest()
    bins = envs.single_action_space.nvec
    for wrong in (good[:2], good[:, :-1], good.astype(np.float64), np.tile(bins, (3, 1)), good - 9):
        with pytest.raises((TypeError, ValueError), match=r"^actions.*: expected"):
            envs.step(wrong)
    places = [
        {"start": (1.0,)},
        {"start": (np.inf, 0.0)},
        {"goal": "north"},
        {"goal": (0.0, 1.0, 2.0, 3.0)},
        {"terrain_seed": 77},
        {"flag": (0.0, 0.0)},
    ]
    for options in places:
        with pytest.raises((TypeError, ValueError), match=r"^options"):
            envs.reset(options=options)
    assert envs._task.batch.digest() == before
    same_bits(envs.step(good), _fresh(name, good))


def _fresh(name, action):
    envs = vector(name)
    envs.reset(seed=0)
    return envs.step(action)


def test_a_marker_is_put_where_it_is_asked_for():
    env = single("disc-jump")
    env.reset(seed=0, options={"start": (10.0, 20.0), "goal": (11.0, 22.0, 190.0)})
    np.testing.assert_array_equal(env.goal(), (11.0, 22.0, 190.0))
    env.reset(seed=0, options={"start": (10.0, 20.0), "goal": (11.0, 22.0)})
    np.testing.assert_array_equal(env.goal()[:2], (11.0, 22.0))
    ground = float(HERE.height([(10.0, 20.0)])[0])
    low, high = env.options.level("standard").goal_distance
    assert low - 1e-3 <= env.goal()[2] - ground <= high + 1e-3


@pytest.mark.parametrize("name", ["route", "flag-run"])
def test_a_flag_is_nowhere_else(name):
    env = single(name)
    env.reset(seed=0)
    before = env.snapshot()
    with pytest.raises(
        ValueError, match=r"^options\['goal'\]: expected none where the goal is the enemy flag"
    ):
        env.reset(options={"goal": (0.0, 0.0)})
    assert env.snapshot() == before


@pytest.mark.parametrize("curriculum", [False, True])
@pytest.mark.parametrize("name", TASKS)
def test_infos_are_those_of_the_table(name, curriculum):
    assert infos.__doc__ is not None
    env = single(name, time_limit=1.0, curriculum=curriculum, reward_fn=speed)
    assert list(env.reset(seed=0)[1]) == ["distance", "speed", "time", "outside_mission_area"]
    over = False
    while not over:
        *_, terminated, truncated, info = env.step(env.action_space.sample())
        over = terminated or truncated
    own = {"disc-jump": {"marker_height"}, "route": {"carrying", "flags_taken"}}
    own["flag-run"] = own["route"]
    rows = [line.split("|")[1].strip() for line in infos.__doc__.splitlines() if line.startswith("| ")]
    every = {key for row in rows for key in row.split(", ")} - {"key"}
    some = own.get(name, set()) | {"native_return"} | ({"level"} if curriculum else set())
    optional = set().union(*own.values()) | {"native_return", "level"}
    assert set(info) == (every - optional) | some


def recorded(name, seed=1, decisions=None, **options):
    """The replay of an episode with drawn actions, mostly forward."""
    env = record(gymnasium.make(TASKS[name].id, **{**ONE_MAP, "time_limit": 3.0, **options}), every=4)
    env.reset(seed=seed)
    env.action_space.seed(seed)
    over = False
    while not over:
        action = env.action_space.sample()
        action[0] = 2
        over = any(env.step(action)[2:4])
    return env.replays[0]


@pytest.mark.parametrize("name", ARMED)
def test_replays_survive_their_file_verify_and_are_bisected(name, tmp_path):
    made = recorded(name)
    path = made.save(tmp_path / "run.replay")
    read: Any = load(path)
    assert read.verify() is None
    assert read.actions.shape[1] == 7
    # In a batch, at another index: the same; in another armor another path.
    one = Side.parsed(str(path))
    assert bisect(one, Side.parsed("batch=3,index=2,threads=2", one), 0.0).parting is None
    parting = bisect(one, Side.parsed("armor=heavy", one), 0.0).parting
    assert parting is not None
    changed = dict(read.arrays)
    changed["actions"] = np.where(np.arange(7) == 3, 1 - read.actions, read.actions)
    assert type(read)(read.header, changed).verify() is not None


@pytest.mark.parametrize("name", ["route", "flag-run"])
class TestGroundsOfOnesOwn:
    """Replays of episodes on given terrains: what stands there and where the flags are is in the file."""

    def test_a_solid_under_the_start(self, name):
        block = discjump.Solid.box((20.0, 20.0, 6.0), (-60.0, 0.0, 20.0), name="block")
        ground = bowl().with_solids([block])
        options = {"terrains": [ground], "terrain_seeds": [0], "flags": ((-60.0, 0.0, 23.5), STANDS[1])}
        made = recorded(name, **options)
        assert loads(made.to_bytes()).verify() is None
        assert made.header["terrains"][0]["solids"] is not None
        # Without the block another episode: it matters.
        header = {**made.header, "terrains": [{**made.header["terrains"][0], "solids": None}]}
        seeds = [recorded(name, seed, **options) for seed in range(3)]
        assert all(one.verify() is None for one in seeds)
        bare = [type(one)({**one.header, "terrains": header["terrains"]}, one.arrays) for one in seeds]
        assert any(one.verify() is not None for one in bare)

    def test_generated_missions_with_other_solids(self, name):
        for ground in (HERE, HERE.with_solids([]), HERE.with_surface("bilinear")):
            made = recorded(name, terrains=[ground])
            assert made.verify() is None
        assert recorded(name, terrains=[HERE]).header["terrains"][0]["solids"] is None


@pytest.mark.parametrize("name", TASKS)
def test_a_curriculum_is_not_recorded(name):
    for made in (single(name, curriculum=True), vector(name, curriculum=True)):
        with pytest.raises(ValueError, match=r"env: expected one without curriculum, .* got curriculum=True"):
            record(made)
