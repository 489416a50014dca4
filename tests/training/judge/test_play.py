"""What is played, what is kept of it, and going on after Ctrl-C."""

import json
import signal

import numpy as np
import pytest

from discjump import replays
from discjump_training import baselines
from discjump_training.courses import COURSES, HELD_OUT
from discjump_training.episodes import STUCK_METRES, STUCK_SECONDS, Stage
from discjump_training.judge import BrokenOff, Conditions, Entrant, Keep, entrants, find, judge
from discjump_training.judge import play as playing
from discjump_training.judge.failures import failures
from discjump_training.judge.pieces import Pieces

from .conftest import ahead


@pytest.mark.parametrize("policy", ["random", "tacker"])
def test_stretches_change_nothing(policy, play, monkeypatch):
    whole = play(policy, episodes=7, noise=0.02)
    monkeypatch.setattr(playing, "STRETCH", 3)
    pieces = play(policy, episodes=7, noise=0.02)
    for key in ("time", "top_speed", "moved", "terrain", "goals", "start_distance"):
        np.testing.assert_array_equal(getattr(whole.episodes, key), getattr(pieces.episodes, key))


def test_episodes_are_those_of_the_course(play):
    direct = Stage(HELD_OUT, 5, baselines.OPTIONS)
    played = direct.play(baselines.make("skier", direct))
    np.testing.assert_array_equal(play("skier", episodes=5).table("seconds")[0], played.seconds)


def test_failures_by_cause_with_their_replays(play, tmp_path):
    """Standing still is stuck, running about is not; the replay of each is the episode that was judged."""

    def still(observations):
        return np.tile([1, 1, 0, 0, 3], (len(observations), 1))

    conditions = Conditions(HELD_OUT, 6, threads=1)
    for policy, cause in ((still, "stuck"), ("random", "time-out")):
        one = play(policy, episodes=6, keep=Keep(failures=tmp_path))
        found = failures(one, conditions)
        causes = [each.cause for each in found]
        assert len(found) == 6
        assert causes.count(cause) >= 4, causes
        for each in found:
            assert each.replay is not None
            replay = replays.load(each.replay)
            assert isinstance(replay, replays.EpisodeReplay)
            assert replay.header["claim"] == {
                "policy": one.name,
                "course": HELD_OUT.name,
                "episode": each.episode,
            }
            assert replay.outcome is not None
            assert replay.outcome["time"] == each.time == 60.0
            # The definition, from the replay's own positions.
            frames = np.array([frame.values["state"]["position"] for frame in replay.play()])
            last = frames[-round(STUCK_SECONDS / 0.032) :]
            radius = np.linalg.norm(last - last[-1], axis=1).max()
            if abs(radius - STUCK_METRES) > 1.0:
                assert (each.cause == "stuck") == (radius <= STUCK_METRES)


def test_a_death_is_a_death(play):
    found = play(ahead, episodes=8, changes={"start_speed": 100.0, "armor": "light"})
    episodes = found.episodes
    causes = [one.cause for one in failures(found, Conditions(HELD_OUT, 8, {"start_speed": 100.0}))]
    assert causes.count("death") == int(episodes.death.sum())


def test_a_group_is_its_members_on_the_same_episodes(play):
    group = entrants(("both=skier,tacker",), HELD_OUT, with_baselines=False)
    found = judge(group, Conditions(HELD_OUT, 4, threads=1))[0]
    assert (found.name, found.members, found.actions) == ("both", ("skier", "tacker"), "scripted, 2 runs")
    for row, name in enumerate(found.members):
        np.testing.assert_array_equal(found.table("seconds")[row], play(name).table("seconds")[0])


def test_replays_play_as_a_policy(play, tmp_path):
    played = play("skier", episodes=3, keep=Keep(replays=tmp_path))
    again = play(str(tmp_path), episodes=3)
    assert (again.kind, again.note) == ("replays", "replayed")
    for key in ("time", "top_speed", "damage"):
        np.testing.assert_array_equal(played.table(key), again.table(key))
    heavy = play(str(tmp_path), episodes=3, changes={"armor": "heavy"})
    assert not np.array_equal(heavy.table("top_speed"), played.table("top_speed"))


def test_replays_that_do_not_fit(tmp_path, play, refused):
    play("skier", episodes=2, keep=Keep(replays=tmp_path))
    asked = ("--no-baselines", "--no-page", "--out", tmp_path / "out")
    words = refused("evaluate", tmp_path, "--episodes", 4, *asked)
    assert "has no replay of 2 episodes: 2, 3" in words
    words = refused("evaluate", tmp_path, "--episodes", 2, "--course", "public", *asked)
    assert "expected replays of the course ski-public-v1, it has none among 2" in words
    file = next(tmp_path.glob("*.replay"))
    (tmp_path / "copy.replay").write_bytes(file.read_bytes())
    assert "there is another replay of episode" in refused("evaluate", tmp_path, *asked)
    file.write_bytes(file.read_bytes()[:-9])
    assert str(file) in refused("evaluate", file, *asked)


def test_a_ground_of_the_users(tmp_path, invoke, refused):
    flat, bowl = tmp_path / "flat.npy", tmp_path / "bowl.npy"
    np.save(flat, np.zeros((129, 129)))
    y, x = np.mgrid[-64:65, -64:65]
    np.save(bowl, 0.02 * (x**2 + y**2))
    seconds = {}
    for path in (flat, bowl):
        out = tmp_path / path.stem
        given = ("skier", "--no-baselines", "--no-page", "--episodes", 4, "--terrain", path, "--out", out)
        result = invoke("evaluate", *given, "--square-size", 10)
        assert result.exit_code == 0, result.output
        data = json.loads((out / "evaluation.json").read_text())
        assert data["changes"]["terrain"].startswith(path.name)
        assert data["policies"][0]["causes"] is not None
        seconds[path.stem] = data["policies"][0]["episode_seconds"]
    assert seconds["flat"] != seconds["bowl"]
    asked = ("skier", "--no-baselines", "--no-page", "--episodes", 4, "--out", tmp_path / "out")
    assert "nowhere.npy" in refused("evaluate", *asked, "--terrain", tmp_path / "nowhere.npy")
    bowl.write_bytes(b"nonsense")
    assert "bowl.npy" in refused("evaluate", *asked, "--terrain", bowl)
    np.save(bowl, np.zeros(7))
    assert "expected heights of shape (rows, columns)" in refused("evaluate", *asked, "--terrain", bowl)
    words = refused("evaluate", *asked, "--terrain", flat, "--course", "public")
    assert "course ski-public-v1 fixes its terrains, and --terrain would change them" in words


def test_changes_change_what_they_say_and_nothing_else(play):
    plain, heavy = play("skier"), play("skier", changes={"armor": "heavy"})
    assert not np.array_equal(plain.table("seconds"), heavy.table("seconds"))
    np.testing.assert_array_equal(plain.episodes.start_distance, heavy.episodes.start_distance)
    np.testing.assert_array_equal(plain.table("seconds"), play("skier", noise=0.0).table("seconds"))
    assert not np.array_equal(plain.table("seconds"), play("skier", noise=0.3).table("seconds"))
    short = play("skier", changes={"time_limit": 2.0})
    assert (short.table("seconds") == 2.0).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("armor", "--set: expected option=value, got 'armor'"),
        ("armour=heavy", "--set: expected an option of the task ski: terrain_seeds,"),
        ("armor=paper", "task ski: armor: expected"),
        ("physics.gravity=1", "--set physics:"),
        ("frame_skip=0", "frame_skip: expected"),
    ],
)
def test_changes_that_there_are_not(change, message, refused, tmp_path):
    asked = ("skier", "--no-baselines", "--no-page", "--episodes", 2, "--out", tmp_path)
    assert message in refused("evaluate", *asked, "--set", change)


def test_an_evaluation_that_is_broken_off_goes_on(tmp_path, invoke, monkeypatch):
    monkeypatch.setattr(playing, "STRETCH", 4)
    asked = ("skier", "tacker", "--no-baselines", "--no-page", "--threads", 1, "--episodes", 12)
    whole = invoke("evaluate", *asked, "--out", tmp_path / "whole")
    assert whole.exit_code == 0, whole.output

    play, turns = Stage.play, []

    def interrupted(self, *arguments, **keywords):
        turns.append(self.rows)
        if len(turns) == 5:
            signal.raise_signal(signal.SIGINT)
        return play(self, *arguments, **keywords)

    monkeypatch.setattr(Stage, "play", interrupted)
    # A shell that starts the tests in the background has SIGINT ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        result = invoke("evaluate", *asked, "--out", tmp_path / "out")
    finally:
        signal.signal(signal.SIGINT, before)
    assert result.exit_code == 130, result.output
    assert "Broken off: 16 episodes were played" in result.output
    assert "PARTIAL" in result.output
    partial = json.loads((tmp_path / "out" / "evaluation.json").read_text())
    assert partial["partial"] is True
    assert [(one["name"], one["episodes"], one["partial"]) for one in partial["policies"]] == [
        ("skier", 12, False),
        ("tacker", 4, True),
    ]
    assert partial["comparisons"][0]["episodes"] == 4
    assert (tmp_path / "out" / "evaluation.md").read_text().startswith("**Partial.**")

    turns[:] = [range(0)] * 10
    result = invoke("evaluate", *asked, "--out", tmp_path / "out", "--resume")
    assert result.exit_code == 0, result.output
    assert turns[10:] == [range(4, 8), range(8, 12)]
    for name in ("evaluation.json", "evaluation.md", "evaluation.png"):
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    assert not (tmp_path / "out" / ".unfinished").exists()


def test_what_was_played_of_something_else_is_not_taken(tmp_path):
    candidate = find("skier", HELD_OUT)
    for conditions in (
        Conditions(HELD_OUT, 2, threads=1),
        Conditions(HELD_OUT, 2, {"armor": "heavy"}, threads=1),
        Conditions(HELD_OUT, 2, noise=0.1, threads=1),
        Conditions(COURSES["ski-validation-v1"], 2, threads=1),
    ):
        kept = judge([Entrant("skier", (candidate,))], conditions, Keep(Pieces(tmp_path, resume=True)))
        fresh = judge([Entrant("skier", (candidate,))], conditions)
        np.testing.assert_array_equal(kept[0].table("seconds"), fresh[0].table("seconds"))
    for path in (tmp_path / ".unfinished").iterdir():
        path.write_bytes(path.read_bytes()[:100])
    again = judge([Entrant("skier", (candidate,))], conditions, Keep(Pieces(tmp_path, resume=True)))
    np.testing.assert_array_equal(again[0].table("seconds"), fresh[0].table("seconds"))


def test_broken_off_before_anything_was_played(monkeypatch):
    def interrupted(self, *arguments, **keywords):
        raise KeyboardInterrupt

    monkeypatch.setattr(Stage, "play", interrupted)
    with pytest.raises(BrokenOff) as caught:
        judge(entrants(("skier",), HELD_OUT, with_baselines=False), Conditions(HELD_OUT, 2))
    assert caught.value.judged == []
