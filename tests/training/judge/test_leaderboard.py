"""Replays are played again before they count; what is not what it claims to be is refused."""

import json

import numpy as np
import pytest

from discjump import replays
from discjump_training.courses import COURSES, HELD_OUT
from discjump_training.judge import Conditions, Entrant, Keep, find, judge
from discjump_training.judge.leaderboard import found, leaderboard

PUBLIC = COURSES["ski-public-v1"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Replays of both scripts: three episodes of two courses each."""
    made = tmp_path_factory.mktemp("replays")
    for course in (HELD_OUT, PUBLIC):
        for name in ("skier", "tacker"):
            entrant = Entrant(name, (find(name, course),))
            judge([entrant], Conditions(course, 3, threads=1), Keep(replays=made / course.kind))
    return made


def first(folder, course=HELD_OUT, policy="skier", row=0):
    return folder / course.kind / f"{course.name}-{row:04}-{policy}.replay"


def test_honest_replays_count(folder, invoke, tmp_path):
    result = invoke("leaderboard", folder, "--episodes", 3, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    assert "12 of 12 replays count." in result.output
    data = json.loads((tmp_path / "leaderboard.json").read_text())
    rows = [(one["course"], one["policy"], one["replays"]) for one in data["standings"]]
    assert rows == [
        (name, policy, 3) for name in (HELD_OUT.name, PUBLIC.name) for policy in ("tacker", "skier")
    ]
    for one in data["standings"]:
        played = judge(
            [Entrant(one["policy"], (find(one["policy"], COURSES[one["course"]]),))],
            Conditions(COURSES[one["course"]], 3, threads=1),
        )[0]
        assert one["score"]["value"] == pytest.approx(played.table("seconds").mean())
    assert "## ski-public-v1" in (tmp_path / "leaderboard.md").read_text()


def test_what_is_missing_counts_as_a_failure(folder):
    made = leaderboard([first(folder)], episodes=4)
    (one,) = made.standings
    (run,) = made.runs
    assert one.score.value == pytest.approx((run.seconds + 3 * 60.0) / 4)
    assert (one.success.value, one.replays, one.episodes) == (0.25, 1, 4)
    assert leaderboard([first(folder)]).standings[0].episodes == HELD_OUT.episodes


def forged_actions(replay):
    actions = replay.actions.copy()
    actions[10] = (actions[10] + 1) % 2
    return replay.changed(arrays={"actions": actions})


def forged_outcome(replay):
    return replay.changed(header={"outcome": {**replay.outcome, "time": 3.2}})


def without_outcome(replay):
    return replay.changed(header={"outcome": {}}, arrays={"actions": replay.actions[:-5]})


def cut(replay):
    return replay.again(decisions=20)


def heavier(replay):
    return replay.changed(header={"options": {**replay.options, "armor": "heavy"}}).again()


def nearer(replay):
    return replay.changed(header={"options": {**replay.options, "goal_distance": [10.0, 20.0]}}).again()


def wider(replay):
    return replay.changed(header={"options": {**replay.options, "arrival_radius": 290.0}}).again()


def elsewhere(replay):
    return replay.changed(header={"reset": {"goal": [0.0, 0.0], "start": [0.0, 10.0]}}).again()


def second_episode(replay):
    return replay.changed(header={"episode": 1}).again()


def claiming(**claim):
    def change(replay):
        return replay.changed(header={"claim": {**replay.header["claim"], **claim}})

    return change


@pytest.mark.parametrize(
    ("forge", "reason"),
    [
        (forged_actions, "it does not come out as recorded: "),
        (forged_outcome, "it does not come out as recorded: outcome.time differs"),
        (without_outcome, "it does not come out as recorded: "),
        (cut, "it stops before the end of its episode"),
        (heavier, "its option armor is heavy, expected light"),
        (nearer, "its option goal_distance is [10.0, 20.0], expected "),
        (wider, "its option arrival_radius is 290.0, expected 8.0"),
        (elsewhere, "its placement is {'goal': [0.0, 0.0], 'start': [0.0, 10.0]}, expected {}"),
        (second_episode, "its number of the episode is 1, expected 0"),
        (claiming(episode=1), "its seed is 10000000000, expected 10000000001"),
        (claiming(episode=-1), "it claims to be episode -1, which is not one of the 3"),
        (claiming(episode=3), "it claims to be episode 3, which is not one of the 3"),
        (claiming(course="ski-validation-v1"), "it is not episode 0 of ski-validation-v1: its "),
        (claiming(course="ski-public-v1"), "it is not episode 0 of ski-public-v1: its "),
        (claiming(course="ski-held-out-v7"), "no course is named 'ski-held-out-v7'"),
        (claiming(course=7), "it does not say whose it is and of which course"),
    ],
)
def test_forged_replays_are_refused(forge, reason, folder, tmp_path):
    forged = forge(replays.load(first(folder))).save(tmp_path / "forged.replay")
    made = leaderboard([forged, first(folder, row=1)], episodes=3)
    assert [one.file for one in made.refused] == [forged]
    assert reason in made.refused[0].reason
    assert [run.episode for run in made.runs] == [1]


def test_a_public_episode_must_be_where_the_course_says(folder, tmp_path):
    replay = replays.load(first(folder, PUBLIC))
    assert isinstance(replay, replays.EpisodeReplay)
    moved = {**replay.header["reset"], "goal": [0.0, 0.0]}
    forged = replay.changed(header={"reset": moved}).again().save(tmp_path / "forged.replay")
    assert "its placement is" in leaderboard([forged]).refused[0].reason


def test_what_the_difficulty_draws_may_be_written_out(folder, tmp_path):
    """As replays have it that were recorded before there were difficulties."""
    replay = replays.load(first(folder))
    assert isinstance(replay, replays.EpisodeReplay)
    options = {**replay.options, "goal_distance": [300.0, 800.0], "start_speed": 10.0}
    made = leaderboard([replay.changed(header={"options": options}).save(tmp_path / "old.replay")])
    assert [run.seconds for run in made.runs] == [leaderboard([first(folder)]).runs[0].seconds]


def test_other_observations_and_decision_times_are_the_same_task(folder, tmp_path):
    replay = replays.load(first(folder))
    assert isinstance(replay, replays.EpisodeReplay)
    options = {**replay.options, "landing": True, "fan_bearings": [5.0], "frame_skip": 2}
    # Every decision twice is the same at half the time between two.
    twice = replay.changed(
        header={"options": options}, arrays={"actions": np.repeat(replay.actions, 2, axis=0)}
    )
    made = leaderboard([twice.again().save(tmp_path / "twice.replay")])
    assert not made.refused
    assert made.runs[0].seconds == pytest.approx(leaderboard([first(folder)]).runs[0].seconds, abs=0.065)
    assert made.standings[0].frame_skips == (2,)


def test_the_name_of_a_file_may_claim(folder, tmp_path):
    replay = replays.load(first(folder))
    header = {key: value for key, value in replay.header.items() if key != "claim"}
    plain = type(replay)(header, replay.arrays)
    assert leaderboard([plain.save(tmp_path / f"{HELD_OUT.name}-0000-me.replay")]).runs[0].policy == "me"
    assert "it does not say whose" in leaderboard([plain.save(tmp_path / "x.replay")]).refused[0].reason


def test_damaged_files_and_the_same_episode_twice(folder, tmp_path):
    content = first(folder).read_bytes()
    for name, data in {
        "a": content,
        "b": content,
        "c": content[:-7],
        "d": b"",
        "e": b"nonsense" * 99,
    }.items():
        (tmp_path / f"{name}.replay").write_bytes(data)
    made = leaderboard(found((tmp_path,)))
    assert [run.file.stem for run in made.runs] == ["a"]
    assert [one.file.stem for one in made.refused] == ["b", "c", "d", "e"]
    assert "is skier's replay of this episode already" in made.refused[0].reason


def test_mistakes_are_explained(tmp_path, folder, refused):
    assert "expected replays (*.replay) in" in refused("leaderboard", tmp_path)
    assert "no course is named 'x'" in refused("leaderboard", folder, "--course", "x")
    words = refused("leaderboard", folder, "--course", PUBLIC.name, "--episodes", 129, "--out", tmp_path)
    assert "has 1 to 128 episodes to offer, not 129" in words
