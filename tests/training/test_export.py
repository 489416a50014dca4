"""A policy that was exported says what it says as a model of stable-baselines3."""

import hashlib
import json
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from gymnasium import spaces

from discjump_training import card, export, model, train
from discjump_training.courses import HELD_OUT
from discjump_training.errors import ModelError
from discjump_training.export_command import export as command
from discjump_training.policy import BINS
from discjump_training.recipe import Recipe

from .conftest import TINY

pytest.importorskip("onnx")
pytest.importorskip("onnxscript")
runtime = pytest.importorskip("onnxruntime")


@pytest.fixture(scope="module", params=[("multi_discrete", True), ("multi_discrete", False), ("box", False)])
def run(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("export") / "run"
    actions, joint = request.param
    changes = (f'environment.actions="{actions}"', f"ppo.joint={str(joint).lower()}")
    recipe = Recipe.load("ski", (*TINY, *changes))
    train.train(recipe, 4, folder, quiet=True)
    return folder


def test_what_is_exported_is_the_policy(run, tmp_path):
    out = tmp_path / "out"
    result = CliRunner().invoke(command, [str(run), "--out", str(out), "--episodes", "8", "--threads", "1"])
    assert result.exit_code == 0, result.output
    assert {path.name for path in out.iterdir()} == {
        "policy.onnx", "policy.zip", "recipe.toml", "card.json", "card.md"
    }  # fmt: skip
    ppo = model.load(out / "policy.zip")
    session = runtime.InferenceSession(str(out / "policy.onnx"))
    assert [one.name for one in session.get_inputs()] == ["observation"]
    assert isinstance(ppo.observation_space, spaces.Box)
    (size,) = ppo.observation_space.shape
    rng = np.random.default_rng(0)
    for rows in (1, 7, 300):
        seen = rng.normal(scale=2.0, size=(rows, size)).astype(np.float32)
        actions, raw = session.run(None, {"observation": seen})
        said, _ = ppo.predict(seen, deterministic=True)
        if isinstance(ppo.action_space, spaces.MultiDiscrete):
            np.testing.assert_array_equal(actions, said)
            bins = [36, 7] if Recipe.load(run / "recipe.toml").ppo.joint else ppo.action_space.nvec
            assert raw.shape == (rows, sum(bins))
            choices = [part.argmax(1) for part in np.split(raw, np.cumsum(bins)[:-1], axis=1)]
            keys = np.unravel_index(choices[0], BINS[:4]) if len(bins) == 2 else choices[:4]
            np.testing.assert_array_equal(actions, np.stack([*keys, choices[-1]], axis=1))
        else:
            np.testing.assert_allclose(actions, said, atol=1e-5)
            np.testing.assert_array_equal(actions, np.clip(raw, -1.0, 1.0))

    told = json.loads(session.get_modelmeta().custom_metadata_map["discjump_training"])
    recipe = Recipe.load(run / "recipe.toml")
    assert (told["task"], told["seed"], told["environment"]) == ("ski", 4, recipe.environment.kwargs())

    made = json.loads((out / "card.json").read_text())
    assert made["digest"] == hashlib.sha256((out / "policy.onnx").read_bytes()).hexdigest()
    assert (made["task"], made["seed"], made["steps"]) == ("ski", 4, told["steps"])
    assert (made["scores"]["course"], made["scores"]["episodes"]) == (HELD_OUT.name, 8)
    assert made["parameters"] == sum(
        parameter.numel()
        for name, parameter in ppo.policy.named_parameters()
        if "policy_net" in name or "action_net" in name
    )
    assert made["observation_layout"][-1]["to"] == size
    assert Recipe.parse(tomllib.loads((out / "recipe.toml").read_text()), "out") == recipe
    text = (out / "card.md").read_text()
    assert made["command"] in text
    assert f"{made['scores']['seconds']['value']:.2f} s" in text


def test_what_cannot_be_exported_is_refused(run, tmp_path):
    ppo = model.load(run / "best.zip")
    with pytest.raises(ModelError, match=r"the model does not say its environment, seed, steps, recipe"):
        card.make(ppo, {}, {}, "")
    ppo.policy.action_space = spaces.Discrete(3)
    with pytest.raises(ModelError, match=r"actions in bins or numbers, got one of .*Discrete\(3\)"):
        export.Actor(ppo.policy)
    result = CliRunner().invoke(command, [str(tmp_path / "none.zip")])
    assert (result.exit_code, "no model file" in result.output) == (1, True), result.output


def test_no_path_of_the_machine_is_in_it(run, tmp_path):
    """Caught: the exporter noted at each node the lines of source it came from, with the paths of the
    machine: a fourth of the file.
    """
    from discjump_training import shipped

    ppo = model.load(run / model.BEST)
    export.to_onnx(ppo, tmp_path / "policy.onnx", {})
    source = Path(export.__file__).parent
    for path in (tmp_path / "policy.onnx", *shipped.FOLDER.glob("*/policy.*")):
        content = path.read_bytes()
        for part in (str(source), source.as_posix(), "site-packages", ".py"):
            assert part.encode() not in content, (path, part)
