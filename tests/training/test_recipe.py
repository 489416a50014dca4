import re
import tomllib

import pytest

from discjump.envs.options import REWARD
from discjump.envs.tasks import TASKS
from discjump_training import recipe
from discjump_training.errors import RecipeError
from discjump_training.recipe import Recipe, Section


def sections(kind: type[Section]):
    yield kind
    for field in kind.model_fields.values():
        if isinstance(field.annotation, type) and issubclass(field.annotation, Section):
            yield from sections(field.annotation)


def test_every_field_is_explained():
    for section in sections(Recipe):
        for name, field in section.model_fields.items():
            assert field.description, f"{section.__name__}.{name}"


@pytest.mark.parametrize("name", recipe.names())
def test_shipped_recipes_load_and_survive_toml(name):
    loaded = Recipe.load(name)
    assert Recipe.parse(tomllib.loads(loaded.to_toml()), "again") == loaded
    assert Recipe.parse(tomllib.loads(loaded.to_toml(help=True)), "again") == loaded


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("ppo.gama=0.9", r"ppo\.gama: unknown field; known are .*gamma"),
        ("sky.blue=1", r"sky: unknown field; known are task, environment"),
        ("ppo.gamma='high'", r"ppo\.gamma: .*number, got 'high'"),
        ("ppo.gamma=1.5", r"ppo\.gamma: .*less than or equal to 1, got 1\.5"),
        ("ppo.n_epochs=2.5", r"ppo\.n_epochs: .*integer, got 2\.5"),
        ("ppo.n_epochs=true", r"ppo\.n_epochs: .*integer, got True"),
        ("rollout.num_envs=0", r"rollout\.num_envs: .*greater than 0, got 0"),
        ("ppo.batch_size=1000", r"ppo\.batch_size: must divide .*32768, got 1000"),
        ("environment.tick_ms=0", r"environment: tick_ms: expected an integer from 1 to 1000, got 0"),
        ("environment.frame_skip='4'", r"environment: frame_skip: expected an integer"),
        ("environment.frameskip=4", r"environment: frameskip: expected one of .*did you mean 'frame_skip'"),
        ("environment.terrain_seeds=[10_000]", r"environment: terrain_seeds: the course says which"),
        ("task='sky'", r"task: expected one of ski.*, got 'sky'"),
        ("environment=3", r"environment: .*dictionary"),
        ("environment.tick_ms=2000", r"environment: tick_ms: expected an integer from 1 to 1000, got 2000"),
        (
            "environment.surface='cubic'",
            r"environment: surface: expected one of 'triangles', 'bilinear', got 'cubic'",
        ),
        ("environment.fidelity='exact'", r"environment: fidelity: expected one of"),
        ("environment.course='ski-v9'", r"no course of ski is named 'ski-v9'; there are ski-train-v1"),
        ("watch.evaluate_episodes=100_000", r"evaluate_episodes: ski-validation-v1 has 512"),
        ("ppo.gamma", r"expected section\.field=value, got 'ppo\.gamma'"),
        ("environment.actions='box'", r"ppo\.joint: needs environment\.actions = \"multi_discrete\""),
        ("ppo.activation=tanh", r"the value must be written as in TOML"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(override, message):
    with pytest.raises(RecipeError, match=message):
        Recipe.load("ski", (override,))


def test_the_reward_by_default_is_the_environments():
    """Caught: the recipe said -0.156 per second where the environment says -0.15625."""
    assert Recipe.load("ski").environment.kwargs()["reward"] == REWARD


def test_physics_left_out_is_the_tasks():
    """Recipes of runs that are older than a field still load."""
    older = tomllib.loads(Recipe.load("ski").to_toml())
    del older["environment"]["tick_ms"], older["environment"]["surface"]
    assert Recipe.parse(older, "older") == Recipe.load("ski")
    other = Recipe.load(
        "ski", ("environment.tick_ms=16", 'environment.surface="bilinear"')
    ).environment.kwargs()
    assert (other["tick_ms"], other["surface"]) == (16, "bilinear")


def test_unreadable_files_are_refused(tmp_path):
    with pytest.raises(
        RecipeError, match=r"cannot read the recipe .*recipes by name: disc-jump, flag-run, route, ski"
    ):
        Recipe.load(tmp_path / "none.toml")
    broken = tmp_path / "broken.toml"
    broken.write_text("[ppo\n")
    with pytest.raises(RecipeError, match=r"broken\.toml is not TOML"):
        Recipe.load(broken)
    broken.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(RecipeError, match=r"cannot read"):
        Recipe.load(broken)


def test_what_a_recipe_says_the_environment_takes():
    """The options come from the task's own class: nothing is lost or altered on the way there."""
    for task in TASKS.values():
        told = Recipe.load(task.name).environment.kwargs()
        made, default = task.options.from_keywords(told), task.options()
        changed = tomllib.loads(Recipe.load(task.name).to_toml()).get("environment", {})
        for name in told:
            assert getattr(made, name) == getattr(default, name) or name in changed
        assert not {"terrain_seeds", "terrains"} & set(told)


def test_a_recipe_that_says_nothing_is_the_tasks_own():
    bare = Recipe.parse({"task": "ski"}, "bare")
    assert bare == Recipe.parse({}, "empty") == Recipe()
    assert (bare.environment.course, bare.watch.evaluate_course) == ("ski-train-v1", "ski-validation-v1")


def test_options_are_explained_by_their_docstrings():
    text = Recipe.load("ski").to_toml(help=True)
    assert "# Length of an episode, s; it ends truncated.\ntime_limit = 60.0\n" in text
    assert re.search(r"# Bearings of the fan [^\n]*\n# left; empty: no fan\.\nfan_bearings", text)
