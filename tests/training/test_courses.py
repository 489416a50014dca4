import json
from itertools import combinations
from typing import Any

import numpy as np
import pytest

import discjump
from discjump.envs.tasks import TASKS
from discjump_training.courses import (
    COURSES,
    MAX_RUN_SEED,
    ROWS,
    SEED_SPACING,
    Course,
    Row,
    course,
    course_of,
    public,
    publish,
    run_seed,
)
from discjump_training.courses.table import FIRST, SLOTS
from discjump_training.episodes import Stage
from discjump_training.errors import TrainingError
from discjump_training.recipe import Recipe

#: Frozen: a change of a course needs a new name.
PUBLISHED = {
    "ski-train-v1": (range(16), 4_500_000_000, 4_096),
    "ski-validation-v1": (range(5_000, 5_008), 5_000_000_000, 512),
    "ski-held-out-v1": (range(10_000, 10_016), 10_000_000_000, 512),
    "ski-public-v1": (range(20_000, 20_008), 20_000_000_000, 128),
}
#: Digests of public courses, frozen likewise.
DIGESTS = {
    "ski-public-v1": "1ae67b525bb976f4",
    "disc-jump-public-v1": "de3030ca499125d4",
    "route-public-v1": "045c8d8c6195e645",
    "flag-run-public-v1": "e410a7ada9742839",
}


def test_courses_are_the_published_ones():
    found = {
        name: (range(one.terrain_seeds[0], one.terrain_seeds[-1] + 1), one.base_seed, one.episodes)
        for name, one in COURSES.items()
    }
    assert {name: found.get(name) for name in PUBLISHED} == PUBLISHED


def test_every_task_has_its_courses():
    assert set(ROWS) == set(TASKS)
    assert len({one.slot for one in ROWS.values()}) == len(ROWS)
    for task in TASKS:
        kinds = {one.kind for one in COURSES.values() if one.task == task}
        assert kinds == {"train", "validation", "held-out", "public"}
        for kind in kinds:
            assert course_of(task, kind).kind == kind
        assert course_of(task, None).kind == "held-out"


def all_courses() -> list[Course]:
    """Those that there are, and those of tasks to come, in the last slots."""
    rows = [Row(f"task{slot}", slot) for slot in range(SLOTS) if slot not in {r.slot for r in ROWS.values()}]
    made = [one for row in rows for one in row.courses()]
    made += [Course(f"{r.task}-public-v1", r.pool("public"), r.base_seed("public"), 10_000) for r in rows]
    return [*COURSES.values(), *made]


def test_no_two_courses_share_a_terrain_or_an_episode():
    """Of whatever tasks; trainings of all tasks draw from one pool, which no other course touches."""
    for a, b in combinations(all_courses(), 2):
        terrains = set(a.terrain_seeds) & set(b.terrain_seeds)
        assert not terrains or (a.kind == b.kind == "train"), (a.name, b.name)
        assert a.base_seed + a.episodes <= b.base_seed or b.base_seed + b.episodes <= a.base_seed, (
            a.name,
            b.name,
        )


def test_training_runs_share_no_environment_seed_with_each_other_or_a_course():
    widest = 100_000
    assert Recipe.load("ski").rollout.num_envs <= widest <= SEED_SPACING
    last = run_seed(MAX_RUN_SEED) + widest
    assert all(last < one.base_seed for one in all_courses())
    assert last < min(FIRST.values())
    # numpy's global generator, which stable-baselines3 seeds with the same number, takes 32 bits.
    assert run_seed(MAX_RUN_SEED) < 2**32


def test_seeds_are_consecutive_and_unsigned():
    seeds = course("ski-held-out-v1").seeds(3)
    assert seeds.dtype == np.uint64
    assert seeds.tolist() == [10_000_000_000, 10_000_000_001, 10_000_000_002]


def test_what_there_is_not_is_refused():
    with pytest.raises(TrainingError, match=r"no course is named 'ski-v0'; there are ski-train-v1"):
        course("ski-v0")
    with pytest.raises(TrainingError, match=r"'ski-public-v9': of ski-public there is ski-public-v1"):
        course("ski-public-v9")
    with pytest.raises(TrainingError, match=r"no courses are listed for the task 'chess'"):
        publish.write("chess")
    with pytest.raises(TrainingError, match=r"has 1 to 512 episodes to offer, not 513"):
        course("ski-held-out-v1").seeds(513)
    for seed in (-1, MAX_RUN_SEED + 1):
        with pytest.raises(TrainingError, match=r"seed must be in 0\.\.4000"):
            run_seed(seed)


@pytest.mark.parametrize("name", [one.name for one in COURSES.values() if one.places])
def test_a_public_course_is_what_was_published(name):
    one = course(name)
    assert one.digest() == DIGESTS[name]
    public.check_terrains(one)
    made = publish.make(ROWS[one.task], one.version)
    assert public.parse(json.dumps(made), "made") == one
    # As many episodes on every terrain.
    counts = np.unique([place.terrain_seed for place in one.places], return_counts=True)[1]
    assert len(set(counts.tolist())) == 1


def test_a_public_course_starts_where_it_says():
    one = course("ski-public-v1")
    stage = Stage(one, 6, threads=1)
    env: Any = stage.env
    env.reset(seed=[int(seed) for seed in one.seeds(6)], options=one.placement(range(6)))
    for row, place in enumerate(one.places[:6]):
        position, goal = stage.inner.state()["position"][row], stage.inner.goals()[row]
        assert position[:2].tolist() == pytest.approx(place.start, abs=1e-4)
        assert goal[:2].tolist() == pytest.approx(place.goal, abs=1e-4)
        assert stage.inner.terrains[stage.inner.terrain_index[row]].seed == place.terrain_seed


def test_changed_public_courses_are_refused(monkeypatch):
    text = json.dumps(publish.make(ROWS["ski"]))
    assert public.parse(text, "x.json").name == "ski-public-v1"
    moved = json.loads(text)
    moved["episodes"][3]["goal"][0] += 0.1
    with pytest.raises(TrainingError, match=r"x\.json was changed: its digest is 1ae67b525bb976f4, its"):
        public.parse(json.dumps(moved), "x.json")
    with pytest.raises(TrainingError, match="expected schema 1 of public courses, got 9"):
        public.parse(json.dumps({**moved, "schema_version": 9}), "x.json")
    for damaged in ("", "[]", "{}", '{"schema_version": 1}', text[:-100]):
        with pytest.raises(TrainingError, match=r"x\.json is no public course"):
            public.parse(damaged, "x.json")
    with pytest.raises(TrainingError, match="there already: a published course is never changed"):
        publish.write("ski")
    other = discjump.Terrain.raindance(1)
    monkeypatch.setattr(discjump, "Terrain", type("T", (), {"raindance": staticmethod(lambda seed: other)}))
    with pytest.raises(TrainingError, match="expected terrain 20000 with the digest"):
        public.check_terrains.__wrapped__(course("ski-public-v1"))


def test_a_task_without_start_and_goal_has_terrain_and_environment_seeds():
    made = public.parse(json.dumps(publish.make(Row("ski", 0, placed=False))), "x.json")
    assert made.placement(range(2)) == {"terrain_seed": [20_000, 20_001]}
