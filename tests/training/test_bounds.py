"""What disc jumps reach: the searches against recurrences written here, the tables of the physics, and the
environment itself."""

from typing import Any

import gymnasium
import numpy as np
import pytest

from discjump._native import Terrain
from discjump.envs.options.disc_jump import HEIGHTS
from discjump.envs.tasks import DISC_JUMP
from discjump_training.bounds import jumps, markers, reachable, report
from discjump_training.bounds.apex import best, search, steps, two_discs
from discjump_training.bounds.jumps import NEVER, PITCHES, Jumps
from discjump_training.bounds.tries import SMALL, Copies, Results, Tries
from discjump_training.courses import COURSES, Course
from discjump_training.errors import TrainingError
from discjump_training.policy import ARMED_BINS

#: Jump speed, acceleration with jets, energy, and what jets use in a tick.
ARMORS = {
    "light": (75 / 9, 236 / 9 - 20, 60.0, 0.8),
    "medium": (110 / 13, 320 / 13 - 20, 80.0, 1.0),
    "heavy": (150 / 18, 385 / 18 - 20, 110.0, 1.1),
}
TINY = Course("disc-jump-tiny-v1", (3,), 77_100_000, 3, "disc-jump")


def flight(armor):
    """Apex of a jump with jets from its tick on: semi-implicit Euler, jets out below an energy of 1 and lit
    again at 5.
    """
    speed, climb, energy, drain = ARMORS[armor]
    full, height, highest, burning = energy, 0.0, 0.0, False
    for _ in range(400):
        burning = energy >= 1.0 if burning else energy >= 5.0
        energy = min(full, energy + 8 * 0.032 - (drain if burning else 0.0))
        speed += 0.032 * (climb if burning else -20.0)
        height += 0.032 * speed
        highest = max(highest, height)
    return highest


@pytest.mark.parametrize("armor", ARMORS)
def test_jump_and_jets_are_the_recurrences(armor):
    alone = Jumps.grid(lit=steps(-8, 8, 1))
    made = jumps.heights(armor, alone)
    # In float32 the tank comes to 1 and to 5 a tick earlier or later.
    assert made.apex[alone.lit == 0][0] == pytest.approx(flight(armor), rel=0.003)
    assert (made.damage == 0).all()
    # The lower end of the markers' heights is what this reaches, and the radius.
    assert HEIGHTS[armor][0] == round(made.apex.max() + 8.0)


@pytest.mark.parametrize("armor", ARMORS)
def test_the_highest_markers_are_what_a_disc_jump_reaches(armor):
    pitches = np.deg2rad([-88.0, -85.0])
    tried = Jumps.grid(lit=range(4), shot=range(4), pitch=pitches)
    made = jumps.heights(armor, tried)
    assert HEIGHTS[armor][1] == int(made.apex[made.alive].max())


def test_a_jump_without_jets_is_as_the_tables_have_it():
    # physics.md, section 10: 1.60, 1.66 and 1.60 m.
    for armor, apex in (("light", 1.60), ("medium", 1.66), ("heavy", 1.60)):
        made = jumps.heights(armor, Jumps.grid(lit=[NEVER]))
        assert made.apex[0] == pytest.approx(apex, abs=0.005)


def test_decisions_of_two_ticks_are_the_environments():
    tried = Jumps.grid(lit=[0, 2], shot=[1], pitch=[float(PITCHES[0])])
    made = jumps.heights("light", tried, ticks=2)
    plane = Terrain.from_heights(np.zeros((257, 257)))
    env: Any = gymnasium.make_vec(
        DISC_JUMP.id,
        num_envs=2,
        threads=1,
        terrains=[plane],
        start_height=0.0,
        start_speed=0.0,
        marker_height=(2000.0, 2000.0),
        **SMALL,
    ).unwrapped
    env.reset(seed=0)
    action = np.tile([1, 1, 0, 0, 3, 0, 4], (2, 1))
    highest = np.zeros(2)
    for decision in range(-16, 150):
        action[:, 2] = decision == 0
        action[:, 3] = decision >= tried.lit
        action[:, 5] = decision == tried.shot
        action[:, 6] = 0 if decision <= 1 else 4
        env.step(action)
        highest = np.maximum(highest, env.state()["position"][:, 2])
    # He is highest between two ticks of a decision, as it happens: one tick at less than 0.2 m/s.
    np.testing.assert_allclose(highest, made.apex, atol=0.01)
    env.close()


def test_everything_that_is_said_is_searched():
    assert list(steps(-8, 8, 2)) == [-4, -3, -2, -1, 0, 1, 2, 3, 4]
    assert list(steps(-3, 3, 2)) == [-1, 0, 1]
    pair = two_discs(2)
    shots, seconds = pair.shot * 2, pair.second * 2
    assert (seconds - shots >= 56).all()
    assert seconds.max() == 124
    assert {NEVER, 0} == set(pair.first.tolist())
    tried = Jumps.grid([0, 1], [(NEVER, NEVER), (2, 4)], [0, 1, 2], [-1.5])
    assert len(tried) == 12
    assert tried.row(0) == {
        **{"lit": 0, "off": None, "relit": None, "shot": 0},
        **{"second": None, "again": None, "first": 0, "pitch": pytest.approx(-85.944)},
    }


def test_the_dead_do_not_count():
    tried = Jumps.grid(lit=[0, 1])
    made = jumps.Heights(np.array([9.0, 5.0]), np.ones(2), np.zeros(2), np.array([False, True]))
    assert best(tried, made, np.ones(2, np.bool_))["apex"] == 5.0


@pytest.fixture(scope="module")
def found():
    return markers.search(TINY, options={"marker_height": (60.0, 140.0)})


def replayed(course, found, options):
    """Success and time of the schedules, one episode each, in environments of their own."""
    env: Any = gymnasium.make_vec(
        DISC_JUMP.id,
        num_envs=len(found),
        threads=1,
        terrain_seeds=list(course.terrain_seeds),
        **{**options, **SMALL},
    )
    inner = env.unwrapped
    observations, _ = env.reset(seed=[int(course.seeds()[one.episode]) for one in found])
    direction = next(f.slice for f in inner.observation_layout if f.name == "goal_direction")
    ahead, right = observations[:, direction].T
    turns = [markers.turning(one, inner.options) for one in np.arctan2(-right, ahead).astype(np.float64)]
    success, seconds = np.zeros(len(found), np.bool_), np.full(len(found), np.nan)
    running = np.ones(len(found), np.bool_)
    for time in range(260):
        actions = [
            reachable.proof(one).actions(time, turn)[0] for one, turn in zip(found, turns, strict=True)
        ]
        _, _, terminated, truncated, info = env.step(np.array(actions, np.int64))
        ended = running & (terminated | truncated)
        if ended.any():
            success[ended], seconds[ended] = info["is_success"][ended], info["time"][ended]
        running &= ~ended
    env.close()
    return success, seconds


def test_what_is_said_to_be_reached_is_reached(found):
    assert any(one.stage for one in found)
    success, seconds = replayed(TINY, found, {"marker_height": (60.0, 140.0)})
    for one, reached, time in zip(found, success, seconds, strict=True):
        assert reached == (one.stage is not None)
        if reached:
            assert time == pytest.approx(one.seconds, abs=5e-4)


def test_what_is_shipped_is_reached():
    course = COURSES["disc-jump-held-out-v1"]
    shipped = reachable.load(course)
    assert shipped is not None
    assert shipped.fits(course, {})
    some = [one for one in shipped.found[:32] if one.stage is not None]
    assert replayed(course, some, {})[0].all()
    assert reachable.parse(shipped.to_text(), "again") == shipped


def test_it_is_about_one_course_and_one_physics(found):
    made = reachable.made(TINY, {}, found)
    assert made.fits(TINY, {"fan_ranges": [], "fan_bearings": [], "landing": True})
    assert not made.fits(TINY, {"armor": "heavy"})
    assert not made.fits(TINY, {"marker_height": (60.0, 140.0)})
    assert not made.fits(COURSES["disc-jump-held-out-v1"], {})
    assert reachable.load(TINY) is None
    with pytest.raises(TrainingError, match="tiny"):
        reachable.parse(made.to_text()[:-30], "tiny")


def test_stages_are_of_the_sizes_that_are_said():
    tried: list[Any] = []
    for stage, count in zip(markers.STAGES, (600, 2400, 2400, 3840, 576, 3840), strict=True):
        tries = markers.plan(stage, (3, 9), tried)
        assert len(tries) == count
        rng = np.random.default_rng(0)
        missed = rng.uniform(10, 90, count)
        tried.append((tries, Results(np.zeros(count, np.bool_), np.full(count, np.nan), missed)))
    assert len(markers.plan("stand", (5, 5), [])) == 300


def test_turns_end_where_they_should():
    class Options:
        turn_rate, decision_seconds = 2.34375, 0.064

    step = 2.34375 * 0.064 / 3
    for bearing in np.linspace(-3.1, 3.1, 23):
        turns = markers.turning(float(bearing), Options)
        total = (turns - ARMED_BINS[4] // 2).sum(axis=1) * step
        assert abs(total[0]) <= np.pi / 8 + step
        left = (bearing - total[0]) / (np.pi / 4)
        assert left == pytest.approx(round(left), abs=step)
        assert total[1] == pytest.approx(bearing, abs=step)
        assert abs(bearing - total[2]) == pytest.approx(np.pi, abs=step)


def test_copies_begin_where_the_episode_is():
    env: Any = gymnasium.make_vec(
        DISC_JUMP.id, num_envs=2, threads=1, terrain_seeds=[3], marker_height=(60.0, 60.0), **SMALL
    ).unwrapped
    env.reset(seed=[1, 2])
    copies = Copies({"terrain_seeds": [3], "marker_height": (60.0, 60.0), "marker_offset": 0.0}, (4,))
    copies.place(env.snapshot(0))
    tries = Tries.grid({"wait": [0]})
    with pytest.raises(ValueError, match="another layout"):
        copies.play(tries, np.full((1, 1), 3))
    env.close()
    copies.close()


def test_tables_say_what_the_figures_are(found):
    jumper = np.array([True, False, False])
    told = report.marker_figures(found, jumper, np.array([5.0, 16.0, 16.0]))
    reached = [one.stage is not None for one in found]
    assert told["search"]["value"] == pytest.approx(np.mean(reached))
    assert sum(one["episodes"] for one in told["bands"]) == len(found)
    assert f"{100 * np.mean(reached):.1f} [" in report.marker_tables(told, TINY.name)


@pytest.mark.parametrize("ticks", [4])
def test_apex_tables(ticks):
    row = search("heavy", ticks)
    assert row["disc"]["apex"] >= row["lit_after"]["apex"] >= row["jets"]["apex"]
    text = report.apex_tables([row])
    assert f"| heavy | {ticks} | {row['jets']['apex']:.1f} |" in text
