import tomllib
from dataclasses import asdict

import numpy as np
import pytest

from discjump.envs.tasks import TASKS
from discjump_training import baselines, tune
from discjump_training.baselines.script import Script, SkierParameters, TackerParameters, bounds
from discjump_training.baselines.sight import Sight
from discjump_training.baselines.steering import ANGLES, press, wrap
from discjump_training.courses import course_of
from discjump_training.episodes import Stage
from discjump_training.errors import TrainingError
from discjump_training.policy import ARMED_BINS, BINS, Layout, encode


@pytest.fixture(scope="module")
def stages():
    return {task: Stage(course_of(task, "train"), 8, baselines.options(task), threads=1) for task in TASKS}


#: Each with its task.
PLAYERS = [(task, name) for task in TASKS for name in baselines.names(task)]


def layout_and_observation(**values: float | list[float]):
    """A layout in the order of the keywords, every scale 2, and one observation that reads as given."""
    slices: dict[str, slice] = {}
    numbers: list[float] = []
    for name, value in values.items():
        column = np.atleast_1d(value)
        slices[name] = slice(len(numbers), len(numbers) + column.size)
        numbers += list(column / 2.0)
    return Layout(slices, dict.fromkeys(slices, 2.0)), np.array([numbers], dtype=np.float32)


def reading(**changes: float | list[float]):
    values: dict[str, float | list[float]] = {
        "energy": 60.0,
        "velocity": [0.0, 0.0, 0.0],
        "beacon_direction": [1.0, 0.0],
        "beacon_distance": 400.0,
        "closing_speed": 0.0,
        "lateral_speed": 0.0,
        "height": 0.0,
        "fan": [0.0, 0.0, 0.0, 0.0, 0.0],
    }
    return layout_and_observation(**(values | changes))


@pytest.mark.parametrize(("task", "name"), PLAYERS)
def test_actions_lie_in_the_action_space(task, name, stages):
    stage = stages[task]
    policy = baselines.make(name, stage)
    observations, _ = stage.env.reset(seed=0)
    policy.reset(np.ones(8, np.bool_))
    for _ in range(5):
        actions = policy(observations)
        assert stage.env.action_space.contains(actions)
        observations, *_ = stage.env.step(actions)


@pytest.mark.parametrize("task", TASKS)
def test_bins_are_the_environments(task, stages):
    stage = stages[task]
    bins = BINS if task == "ski" else ARMED_BINS
    assert tuple(stage.env.unwrapped.single_action_space.nvec) == stage.bins == bins


@pytest.mark.parametrize("name", baselines.PARAMETERS)
def test_tuned_constants_lie_within_their_bounds(name):
    for (field, value), (low, high) in zip(
        asdict(baselines.tuned(name)).items(), bounds(baselines.PARAMETERS[name]), strict=True
    ):
        assert low <= value <= high, field


def test_tuning_measures_what_it_prints():
    """Caught: the figures beside the constants were measured before they were rounded to four digits."""
    found = tune.search("skier", generations=0, population=5, episodes=1, seed=0, threads=1)
    assert SkierParameters(**tomllib.loads(baselines.to_toml(found))) == found


@pytest.mark.parametrize(("task", "name"), PLAYERS)
def test_episodes_are_the_same_every_time(task, name, stages):
    stage = stages[task]
    first, second = (stage.play(baselines.make(name, stage)) for _ in range(2))
    assert first.seconds.tobytes() == second.seconds.tobytes()
    assert first.episode_return.tobytes() == second.episode_return.tobytes()


def test_scripts_read_by_name_whatever_the_order():
    names = list(reading()[0].slices)
    for order in (names, names[::-1]):
        values: dict[str, float | list[float]] = {
            "velocity": [0.0, 0.0, 7.0],
            "beacon_direction": [0.0, 1.0],
            "lateral_speed": 4.0,
            "energy": 33.0,
            "height": 2.0,
            # Rise over range from the ground, 2 m below the feet: 1 to 5 m above the feet.
            "fan": list((np.arange(1.0, 6.0) + 2.0) / baselines.RANGES),
        }
        full = {name: values.get(name, 0.0) for name in order}
        layout, observation = layout_and_observation(**full)
        see = Sight.of(layout, observation, np.array(baselines.RANGES))
        assert see.bearing == pytest.approx([-np.pi / 2])  # to the right
        assert see.drift == pytest.approx([-4.0])
        assert see.energy == pytest.approx([33.0])
        assert see.climb == pytest.approx([7.0])
        assert see.rise(35.0) == pytest.approx([3.0])
        assert see.rise(11.0) == pytest.approx([1.5])
        assert see.rise(500.0) == pytest.approx([5.0])


def test_a_missing_part_is_named():
    layout, observation = layout_and_observation(velocity=[0.0, 0.0, 0.0])
    with pytest.raises(TrainingError, match=r"no part 'energy'; it has velocity"):
        layout.read(observation, "energy")


def test_without_a_fan_the_rise_ahead_is_refused():
    """Caught: an IndexError out of an empty array."""
    values = {
        name: 0.0 for name in reading()[0].slices if name not in ("fan", "velocity", "beacon_direction")
    }
    layout, observation = layout_and_observation(velocity=[0.0] * 3, beacon_direction=[1.0, 0.0], **values)
    with pytest.raises(TrainingError, match="no part 'fan'"):
        Sight.of(layout, observation, np.array(baselines.RANGES)).rise(20.0)


def test_press_reaches_every_direction_after_its_turn():
    angle = np.linspace(-np.pi, np.pi, 721)
    forward, strafe, turn = press(angle, seconds=0.5)
    # Walking speeds 11 ahead and back, 10 to the sides; left is positive, strafe 1 is right.
    pressed = np.arctan2(-10.0 * strafe, 11.0 * forward)
    assert np.abs(wrap(pressed + turn * 0.5 - angle)) == pytest.approx(0.0, abs=1e-12)
    assert np.abs(turn * 0.5).max() <= np.diff(np.sort(ANGLES)).max() / 2 + 1e-12


def test_encode_rounds_turns_to_bins():
    zero = np.zeros(5)
    off = np.zeros(5, np.bool_)
    turn = np.array([-9.0, -2.0, 0.1, 0.7, 2.0])
    assert encode(zero, zero, off, ~off, turn, 2.0)[:, 4].tolist() == [0, 0, 3, 4, 6]
    assert encode(zero + 1, zero - 1, off, ~off, turn, 2.0)[0, :4].tolist() == [2, 0, 0, 1]


def script(parameters: SkierParameters, layout: Layout) -> Script:
    return Script("test", parameters, layout, np.array(baselines.RANGES), turn_rate=2.0)


def test_the_tacker_presses_against_its_drift_and_keeps_its_side_in_between():
    parameters = TackerParameters(
        **{**asdict(baselines.tuned("tacker")), "angle": 0.7, "tack_drift": 5.0, "tack_speed": 0.0},
    )
    layout, _ = reading()
    policy = script(parameters, layout)
    policy.reset(np.ones(1, np.bool_))
    strafes = [
        policy(reading(lateral_speed=drift, closing_speed=20.0)[1])[0, 1] - 1 for drift in (0, 6, 0, -6, 0)
    ]
    assert strafes == [1, -1, -1, 1, 1]


def test_jets_burn_down_to_the_stop_and_wait_for_the_start():
    parameters = SkierParameters(
        **{**asdict(baselines.tuned("skier")), "jet_start": 30.0, "jet_stop": 10.0, "jet_speed": 50.0,
           "ceiling": 10.0, "sink": 10.0},
    )  # fmt: skip
    layout, _ = reading()
    policy = script(parameters, layout)
    policy.reset(np.ones(1, np.bool_))
    jets = [policy(reading(energy=energy)[1])[0, 3] for energy in (20, 31, 20, 11, 9, 20, 31)]
    assert jets == [0, 1, 1, 1, 0, 0, 1]
    policy.reset(np.ones(1, np.bool_))
    assert policy(reading(energy=20)[1])[0, 3] == 0
