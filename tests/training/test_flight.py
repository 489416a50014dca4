"""Where a flight leads: the planner's objectives against flights that are played here."""

from typing import Any

import gymnasium
import numpy as np
import pytest

from discjump import Simulator
from discjump._native import Terrain
from discjump.envs.tasks import TASKS
from discjump_training.planner import objectives
from discjump_training.planner.flight import apex, miss
from discjump_training.policy import Layout

SMALL = {"fan_bearings": [], "fan_ranges": [], "landing": False}


@pytest.mark.parametrize("armor", ["light", "medium", "heavy"])
def test_the_apex_is_that_of_a_flight_in_the_simulator(armor):
    plane = Terrain.from_heights(np.zeros((9, 9)))
    sim = Simulator(plane, 24, "disc_jump", armor=armor, threads=1)
    rng = np.random.default_rng(0)
    state = sim.state()
    state["position"][:, 2] = 500.0
    state["velocity"][:, 2] = rise = rng.uniform(-5.0, 60.0, 24)
    state["energy"] = energy = rng.uniform(10.0, 60.0, 24)
    sim.set_state(state)
    keys = sim.inputs()
    keys["jet"] = True
    highest, when = np.full(24, 500.0), np.zeros(24)
    for tick in range(400):
        sim.step(keys)
        height = sim.state()["position"][:, 2]
        when = np.where(height > highest, 0.032 * (tick + 1), when)
        highest = np.maximum(highest, height)
    told, time = apex(rise, energy, armor)
    np.testing.assert_allclose(highest - 500.0, np.maximum(told, 0.0), rtol=0.03, atol=2.5)
    np.testing.assert_allclose(when[told > 5], time[told > 5], rtol=0.08, atol=0.2)


def of_task(name, count=8, **options):
    env: Any = gymnasium.make_vec(TASKS[name].id, num_envs=count, threads=1, **{**SMALL, **options}).unwrapped
    observations, _ = env.reset(seed=5)
    return env, Layout.of(env.observation_layout), observations


def test_who_stands_under_a_low_marker_misses_nothing():
    env, layout, seen = of_task("disc-jump", marker_height=(30.0, 30.0), start_speed=0.0, start_height=0.0)
    state = env.state()
    aside = np.hypot(*(env.goals() - state["position"])[:, :2].T)
    missed = miss(layout, seen, "light", 8.0)
    np.testing.assert_allclose(missed, np.maximum(aside - 6.0, 0.0), atol=0.3)
    env.close()


def test_nobody_dies_because_the_way_is_long():
    """Caught: a death counted as the time limit, a runner alive with a long way to go as up to twice that."""
    env, layout, seen = of_task("route", count=2)
    limit = env.options.time_limit
    seconds = objectives.Seconds(layout, limit, lambda layout, some: np.full(len(some), 1.5 * limit))
    seconds.begin(2)
    ended = np.array([True, False])
    info = {"time": np.array([3.0, 3.0]), "is_success": np.array([False, False])}
    seconds.add(np.zeros(2), ended, np.ones(2, np.bool_), info)
    died, lives = seconds.scores(seen, ~ended, 2)
    assert died < lives
    env.close()


def test_a_success_is_better_than_any_flight_and_the_sooner_the_better():
    env, layout, seen = of_task("disc-jump", count=4)
    flight = objectives.make("disc-jump", layout, env.options)
    flight.begin(4)
    ended, success = np.array([True, True, True, False]), np.array([True, True, False, False])
    flight.add(
        np.zeros(4),
        ended,
        np.ones(4, np.bool_),
        {"time": np.array([3.0, 9.0, 5.0, 5.0]), "is_success": success},
    )
    scores = flight.scores(seen, ~ended, 2)
    assert scores[:3].tolist() == [-3.0, -9.0, -16.0 - objectives.FAR]
    assert scores[2] < scores[3] < scores[1]
    env.close()


def test_without_the_flag_there_are_two_legs_to_go():
    env, layout, seen = of_task("flag-run", count=2)
    there = objectives.to_stand(layout, seen)
    whole = objectives.to_capture(layout, seen)
    assert (whole - there > 500.0 / 31.0).all()
    carrying = seen.copy()
    carrying[:, layout.slices["carrying"]] = 1.0
    np.testing.assert_array_equal(
        objectives.to_capture(layout, carrying), objectives.to_stand(layout, carrying)
    )
    env.close()


def test_every_task_has_an_objective():
    assert set(objectives.OBJECTIVES) == set(TASKS)


def test_taking_the_flag_is_progress():
    """Caught: to the guess of FlagRun the way home began where the flag is taken, so plans hovered before it
    until time was out.
    """
    env, layout, seen = of_task("flag-run", count=1)
    near, taken = seen.copy(), seen.copy()
    for name, at_the_flag, after in (
        ("goal_distance", 10.0, 700.0),
        ("closing_speed", 40.0, -40.0),
        ("goal_height", 0.0, 60.0),
        ("energy", 60.0, 0.0),
        ("carrying", 0.0, 1.0),
    ):
        near[:, layout.slices[name]] = at_the_flag / layout.scales[name]
        taken[:, layout.slices[name]] = after / layout.scales[name]
    assert objectives.to_capture(layout, taken) < objectives.to_capture(layout, near)
    env.close()
