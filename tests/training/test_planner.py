"""The planner's model is the simulator itself: what it predicts happens, bit for bit, and the same arguments
give the same bits whatever threads, groups and interruptions. Everything that is compared with it, from
imitation to the scores in percent of the planner's, rests on that.
"""

import json
from typing import Any

import gymnasium
import numpy as np
import pytest
from stable_baselines3 import PPO

import discjump.sb3
from discjump.envs.tasks import SKI
from discjump_training import baselines, model
from discjump_training.courses import Course
from discjump_training.episodes import Stage
from discjump_training.errors import TrainingError
from discjump_training.planner import Settings, plan, proposals
from discjump_training.planner.guides import Networks
from discjump_training.planner.objectives import Rewards, Seconds, to_beacon
from discjump_training.planner.planned import load_replay
from discjump_training.planner.proposals import Draft
from discjump_training.planner.rollouts import Rollouts
from discjump_training.planner.search import Memory, Search
from discjump_training.planner.settings import PROPOSALS
from discjump_training.planner.store import RESULTS, Store
from discjump_training.policy import Layout

COURSE = Course("tiny-v1", (3,), 77_000_000, 5)
SHORT = {"goal_distance": (90.0, 130.0)}
SMALL = Settings(candidates=32, horizon=2.0, iterations=2, warm_up=2, commit=2, elites=6)


def same(a, b):
    """Whether outcomes, actions and digests of every state and observation are equal."""
    assert [(one.episode, one.seconds, one.decisions, one.cost.decisions) for one in a.outcomes] == [
        (one.episode, one.seconds, one.decisions, one.cost.decisions) for one in b.outcomes
    ]
    for row, replay in a.replays.items():
        assert replay.arrays.keys() == b.replays[row].arrays.keys()
        for key, array in replay.arrays.items():
            assert array.tobytes() == b.replays[row].arrays[key].tobytes(), (row, key)


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    return plan(
        "ski", COURSE, episodes=4, settings=SMALL, options=SHORT, threads=1, out=tmp_path_factory.mktemp("p")
    )


@pytest.fixture(scope="module")
def untrained(tmp_path_factory):
    env = discjump.sb3.make_vec_env("discjump/Ski-v0", n_envs=2, seed=0, terrain_seeds=[3])
    path = tmp_path_factory.mktemp("model") / "model.zip"
    ppo = PPO(
        "MlpPolicy", env, n_steps=8, batch_size=16, policy_kwargs={"net_arch": [16]}, seed=1, device="cpu"
    )
    model.save(ppo, path, {"environment": {}})
    return path


@pytest.mark.parametrize("proposal", PROPOSALS)
def test_threads_and_groups_change_no_bit(proposal):
    settings = Settings(**{**SMALL.as_dict(), "proposal": proposal, "candidates": 300, "iterations": 1})
    few: dict[str, Any] = {"episodes": 3, "settings": settings, "options": SHORT}
    one = plan("ski", COURSE, **few, threads=1, group=1)
    same(one, plan("ski", COURSE, **few, threads=2, group=3))


def test_a_model_changes_that_not(untrained):
    few: dict[str, Any] = {"episodes": 3, "settings": SMALL, "options": SHORT, "guides": [str(untrained)]}
    one = plan("ski", COURSE, **few, threads=1, group=1)
    same(one, plan("ski", COURSE, **few, threads=2, group=2))


def test_an_interruption_changes_no_bit_and_nothing_is_planned_twice(planned, tmp_path, monkeypatch):
    how = {"episodes": 4, "settings": SMALL, "options": SHORT, "threads": 1, "out": tmp_path}
    add = Store.add
    added = []

    def interrupted(self, outcome, replay):
        add(self, outcome, replay)
        added.append(outcome.episode)
        if len(added) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(Store, "add", interrupted)
    with pytest.raises(KeyboardInterrupt):
        plan("ski", COURSE, **how)
    stored = json.loads((tmp_path / RESULTS).read_text())
    assert stored["partial"]
    assert [one["episode"] for one in stored["episodes"]] == sorted(added)
    resumed = plan("ski", COURSE, **how, resume=True)
    assert sorted(added) == [0, 1, 2, 3]
    same(planned, resumed)
    assert not json.loads((tmp_path / RESULTS).read_text())["partial"]


def test_replays_verify(planned):
    for one in planned.outcomes:
        replay = load_replay(planned.replay_path(one.episode))
        assert (replay.seed, replay.episode) == (COURSE.base_seed + one.episode, 0)
        assert replay.outcome is not None
        assert replay.outcome["is_success"] == one.success
        assert replay.outcome["time"] == one.seconds
        assert replay.verify() is None


@pytest.mark.parametrize("guided", [False, True])
@pytest.mark.parametrize("value", [False, True])
def test_what_is_predicted_happens(untrained, guided, value):
    """The score of the best sequence is found again from its actions alone, among other candidates; the real
    environment that takes them arrives at the same state, observation and score.
    """
    options: dict[str, Any] = {"terrain_seeds": [3], **SHORT}
    networks = Networks([model.load(untrained)])
    real: Any = gymnasium.make_vec("discjump/Ski-v0", num_envs=2, threads=1, **options).unwrapped
    objective = (
        Rewards(networks.gamma, networks.value)
        if value
        else Seconds(Layout.of(real.observation_layout), 60.0, to_beacon)
    )
    length = SMALL.decisions(real.options.decision_seconds)
    rollouts = Rollouts("discjump/Ski-v0", options, 32, 1, objective, networks if guided else None)
    bins = real.single_action_space.nvec
    proposal = proposals.make(SMALL, bins, length, real.options.decision_seconds)
    search = Search(SMALL, rollouts, proposal, bins, length, guided=guided)
    observations, _ = real.reset(seed=[5, 6])
    memories = [Memory(5), Memory(6)]
    snapshots = [real.snapshot(0), real.snapshot(1)]
    best = search.plan(memories, snapshots, observations)

    actions = np.zeros((32, length, len(bins)), np.int8)
    actions[17] = best[1]
    rollouts.place([snapshots[1]], observations[1:])
    scores, _ = rollouts.run([Draft(actions, np.zeros((0, length, len(bins)), np.bool_))])
    assert scores[0, 17] == memories[1].predicted

    objective.begin(2)
    for time in range(length):
        seen, rewards, terminated, truncated, info = real.step(
            np.stack([b[time] for b in best]).astype(np.int64)
        )
        assert not (terminated | truncated).any()
        objective.add(rewards, terminated, np.ones(2, np.bool_), info)
    real_scores = objective.scores(seen, np.ones(2, np.bool_), 1)
    if value:
        # A network asked about one observation may round otherwise than about 32.
        np.testing.assert_allclose(real_scores, [memory.predicted for memory in memories], rtol=1e-6)
    else:
        assert real_scores.tolist() == [memory.predicted for memory in memories]


def test_it_is_faster_than_the_scripted_skier():
    settings = Settings(candidates=64, horizon=3.0, iterations=2, warm_up=3, commit=2)
    ours = plan("ski", COURSE, settings=settings, options=SHORT, threads=1)
    stage = Stage(COURSE, None, {**baselines.OPTIONS, **SHORT}, 1)
    skier = stage.play(baselines.make("skier", stage))
    assert ours.success.all()
    assert (ours.seconds < skier.seconds).all()


def test_a_script_can_guide():
    ours = plan("ski", COURSE, episodes=1, settings=SMALL, guides=["tacker"], options=SHORT, threads=1)
    assert ours.values == ()
    assert ours.success.all()


def test_pairs_are_what_a_policy_would_have_seen_and_done(planned):
    pairs = planned.pairs()
    count = sum(one.decisions for one in planned.outcomes)
    assert pairs.observations.shape[0] == pairs.actions.shape[0] == count
    first = planned.replays[2]
    rows = pairs.episode == 2
    np.testing.assert_array_equal(pairs.actions[rows], first.actions)
    seat, begun = next(first.decisions())
    del seat
    np.testing.assert_array_equal(pairs.observations[rows][0], np.ravel(begun[0]))
    blind = planned.pairs(fan_ranges=[], landing=False)
    assert blind.observations.shape[1] < pairs.observations.shape[1]
    np.testing.assert_array_equal(blind.observations[:, :3], pairs.observations[:, :3])
    with pytest.raises(TrainingError, match="change the observation alone"):
        planned.pairs(arrival_radius=20.0)


def test_windows_stay_within_the_bins():
    rng = np.random.default_rng(0)
    bins = np.array([3, 2, 7])
    values, where, last = proposals.windows(rng, 2_000, 20, bins)
    assert (values >= 0).all()
    assert (values < bins).all()
    assert {tuple(np.unique(values[..., i][where[..., i]])) for i in range(3)} == {
        (0, 1, 2),
        (0, 1),
        tuple(range(7)),
    }
    touched: Any = where.any(axis=2)
    latest = np.where(touched.any(axis=1), 20 - np.argmax(touched[:, ::-1], axis=1), 0)
    assert (latest <= last).all()


def test_the_categorical_distribution_is_the_one_asked_for():
    """Shares of drawn bins against the mixture of elites and the uniform distribution (four-sigma bounds)."""
    settings = Settings(candidates=64, proposal="cem", explore=0.2)
    bins = np.array([3, 2])
    elites = proposals.Elites(np.array([[[2, 0]], [[2, 1]], [[0, 1]], [[2, 1]]], np.int8), np.zeros(4))
    proposal = proposals.make(settings, bins, 1, SKI.options().decision_seconds)
    drawn = proposal.draw(np.random.default_rng(1), elites, 40_000, 0, True).actions[:, 0]
    expected = [[0.25, 0.0, 0.75], [0.25, 0.75]]
    for column, shares in enumerate(expected):
        for value, share in enumerate(shares):
            wanted = 0.8 * share + 0.2 / bins[column]
            found = (drawn[:, column] == value).mean()
            assert abs(found - wanted) < 4 * np.sqrt(wanted * (1 - wanted) / 40_000)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"candidates": 1}, "candidates: expected an integer from 2 to 65536, got 1"),
        ({"horizon": 0.0}, r"horizon: expected a number in \(0, 120\] s, got 0.0"),
        ({"horizon": float("nan")}, r"horizon: expected a number in \(0, 120\] s, got nan"),
        ({"proposal": "magic"}, "proposal: expected one of evolve, cem, mppi, got 'magic'"),
        ({"elites": 256}, "elites: expected fewer than the 256 candidates, got 256"),
        ({"guided": 1.5}, r"guided: expected a number in \[0, 1\], got 1.5"),
        ({"seed": -1}, "seed: expected an integer from 0"),
        ({"iterations": True}, "iterations: expected an integer from 1 to 1000, got True"),
    ],
)
def test_wrong_settings_are_named(wrong, message):
    with pytest.raises(TrainingError, match=message):
        Settings(**wrong)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"task": "fly"}, "task: expected one of ski.*, got 'fly'"),
        ({"course": "nowhere-v1"}, "course: expected one of .*, got 'nowhere-v1'"),
        ({"episodes": 6}, "1 to 5 episodes to offer, not 6"),
        ({"group": 0}, "group: expected at least 1 episode, got 0"),
        ({"guides": ["nobody.zip"]}, "no model file at nobody.zip"),
        ({"guides": ["skier", "tacker"]}, "expected models, or one script alone"),
        ({"guides": ["random"]}, "expected a model file.*skier, tacker"),
        ({"values": ["skier"]}, "no model file at skier"),
        ({"settings": Settings(horizon=1.0, commit=9)}, "commit: expected at most 8 decisions"),
        ({"resume": True}, "resume: expected a folder"),
    ],
)
def test_what_does_not_exist_is_named(wrong, message):
    with pytest.raises(TrainingError, match=message):
        plan(**{"task": "ski", "course": COURSE, "settings": SMALL, **wrong})


def test_a_model_of_other_observations_is_refused(untrained):
    with pytest.raises(TrainingError, match="was trained on observations in"):
        plan("ski", COURSE, settings=SMALL, guides=[str(untrained)], options={"landing": False})


def test_folders_are_not_mixed_up(planned):
    how = {"episodes": 4, "options": SHORT, "out": planned.folder}
    with pytest.raises(TrainingError, match="holds a plan already"):
        plan("ski", COURSE, settings=SMALL, **how)
    with pytest.raises(TrainingError, match="was planned with settings"):
        plan("ski", COURSE, settings=Settings(), **how, resume=True)
    with pytest.raises(TrainingError, match="holds 4 episodes, more than the 2"):
        plan("ski", COURSE, settings=SMALL, **{**how, "episodes": 2}, resume=True)


def test_a_damaged_folder_is_refused(planned, tmp_path):
    (tmp_path / RESULTS).write_text((planned.folder / RESULTS).read_text()[:-40])
    with pytest.raises(TrainingError, match="is not what discjump plan wrote"):
        plan("ski", COURSE, episodes=4, settings=SMALL, options=SHORT, out=tmp_path, resume=True)
