"""Models of stable-baselines3's algorithms and in ONNX files."""

import sys
from typing import Any

import gymnasium
import numpy as np
import pytest
import torch
from stable_baselines3 import A2C, PPO, SAC, TD3

from discjump.sb3 import make_vec_env
from discjump_training import model
from discjump_training.courses import HELD_OUT
from discjump_training.errors import ModelError
from discjump_training.judge import find
from discjump_training.judge.policies import onnx, sb3

TASK = "discjump/Ski-v0"
ENV: dict[str, Any] = {"n_envs": 2, "seed": 0, "threads": 1}


@pytest.fixture(scope="module")
def ppo():
    torch.set_num_threads(1)
    return PPO(
        "MlpPolicy", make_vec_env(TASK, **ENV), n_steps=8, batch_size=8, policy_kwargs={"net_arch": [8]}
    )


@pytest.mark.parametrize("kind", [PPO, A2C, SAC, TD3])
def test_any_algorithm_is_known_and_plays(kind, tmp_path, play):
    options: dict[str, Any] = {} if kind in (PPO, A2C) else {"actions": "box"}
    made = kind("MlpPolicy", make_vec_env(TASK, **ENV, **options), policy_kwargs={"net_arch": [8]})
    path = tmp_path / "model.zip"
    made.save(path)
    assert sb3.algorithm(path) is kind
    # The task's own way through the environment, without any of ours.
    env = gymnasium.make(TASK, terrain_seeds=list(HELD_OUT.terrain_seeds), **options)
    observation, _ = env.reset(seed=HELD_OUT.base_seed)
    over = False
    while not over:
        action, _ = made.predict(observation, deterministic=True)
        observation, _, terminated, truncated, info = env.step(action)
        over = terminated or truncated
    found = play(str(path), episodes=1)
    assert found.episodes.top_speed[0] == pytest.approx(info["top_speed"], rel=1e-5)
    assert (found.kind, found.note) == ("model", "greedy")


def test_sampled_actions_are_the_same_every_time_and_not_greedy(ppo, tmp_path, play):
    path = tmp_path / "model.zip"
    model.save(ppo, path, {})
    candidates = [find(str(path), HELD_OUT, sampled=sampled) for sampled in (True, True, False)]
    from discjump_training.judge import Conditions, Entrant, judge

    asked = Conditions(HELD_OUT, 3, {"time_limit": 4.0}, threads=1, sampled=True)
    first, again, greedy = (judge([Entrant("m", (one,))], asked)[0] for one in candidates)
    np.testing.assert_array_equal(first.table("mean_speed"), again.table("mean_speed"))
    assert not np.array_equal(first.table("mean_speed"), greedy.table("mean_speed"))


def test_models_that_do_not_fit_are_refused(ppo, tmp_path, refused):
    path = tmp_path / "model.zip"
    asked = ("--no-baselines", "--episodes", 2, "--no-page", "--out", tmp_path / "out")
    ppo.save(path)
    assert "was trained on observations in Box" in refused("evaluate", path, *asked, "--set", "landing=false")
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    assert "model.zip is not a readable model file" in refused("evaluate", path, *asked)
    path.write_bytes(b"PK\x05\x06" + bytes(18))
    assert "is not a whole model file: it lacks data, policy.pth" in refused("evaluate", path, *asked)
    model.save(ppo, path, {"task": "chess"})
    assert "was trained for the task chess, and is asked to play ski" in refused("evaluate", path, *asked)


def export(ppo, path, *, logits, batch=None, size=None, metadata=None):
    """The policy's network as ONNX, from its weights, by onnx's own helpers."""
    import onnx as format_
    from onnx import TensorProto, helper, numpy_helper

    net = ppo.policy
    layers = [one for one in net.mlp_extractor.policy_net if isinstance(one, torch.nn.Linear)]
    layers.append(net.action_net)
    width = size or layers[0].in_features
    nodes, weights, last = [], [], "observations"
    for index, layer in enumerate(layers):
        values = {f"w{index}": layer.weight.detach().numpy().T, f"b{index}": layer.bias.detach().numpy()}
        if index == 0 and size is not None:
            values["w0"] = np.zeros((size, layer.out_features), np.float32)
        weights += [
            numpy_helper.from_array(np.ascontiguousarray(value), name) for name, value in values.items()
        ]
        out = "logits" if index == len(layers) - 1 else f"z{index}"
        nodes.append(helper.make_node("Gemm", [last, f"w{index}", f"b{index}"], [out]))
        last = out
        if out != "logits":
            nodes.append(helper.make_node("Tanh", [out], [f"a{index}"]))
            last = f"a{index}"
    outputs = [helper.make_tensor_value_info("logits", TensorProto.FLOAT, [batch, 17])]
    if not logits:
        bins = [3, 3, 2, 2, 7]
        weights.append(numpy_helper.from_array(np.array(bins, np.int64), "bins"))
        parts = [f"part{i}" for i in range(5)]
        nodes.append(helper.make_node("Split", ["logits", "bins"], parts, axis=1))
        nodes += [helper.make_node("ArgMax", [p], [f"{p}max"], axis=1, keepdims=1) for p in parts]
        nodes.append(helper.make_node("Concat", [f"{p}max" for p in parts], ["actions"], axis=1))
        outputs = [helper.make_tensor_value_info("actions", TensorProto.INT64, [batch, 5])]
    given = helper.make_tensor_value_info("observations", TensorProto.FLOAT, [batch, width])
    graph = helper.make_graph(nodes, "policy", [given], outputs, weights)
    made = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=9)
    if metadata is not None:
        helper.set_model_props(made, {onnx.ABOUT: metadata})
    format_.save(made, path)
    return path


@pytest.mark.parametrize("form", [{"logits": True}, {"logits": False}, {"logits": True, "batch": 3}])
def test_an_onnx_model_plays_as_the_model_it_is_from(ppo, tmp_path, play, form):
    pytest.importorskip("onnxruntime", reason="the extra discjump-training[onnx] is not installed")
    pytest.importorskip("onnx", reason="the extra discjump-training[test] is not installed")
    ppo.save(tmp_path / "model.zip")
    path = export(ppo, tmp_path / "model.onnx", **form)
    changes = {"time_limit": 5.0}
    ours, theirs = (play(str(one), episodes=4, changes=changes) for one in (path, tmp_path / "model.zip"))
    assert ours.kind == "onnx"
    np.testing.assert_array_equal(ours.table("top_speed"), theirs.table("top_speed"))
    np.testing.assert_array_equal(ours.table("mean_speed"), theirs.table("mean_speed"))


def test_onnx_models_that_do_not_fit_are_refused(ppo, tmp_path, refused):
    pytest.importorskip("onnxruntime", reason="the extra discjump-training[onnx] is not installed")
    pytest.importorskip("onnx", reason="the extra discjump-training[test] is not installed")
    path = tmp_path / "model.onnx"
    asked = ("--no-baselines", "--episodes", 2, "--no-page", "--out", tmp_path / "out")
    export(ppo, path, logits=True, size=9)
    assert "takes observations of 9 numbers, but the environment's have 37" in refused(
        "evaluate", path, *asked
    )
    export(ppo, path, logits=True, metadata='{"task": "chess"}')
    assert "was trained for the task chess" in refused("evaluate", path, *asked)
    export(ppo, path, logits=True, metadata="{")
    assert "its metadata discjump_training is not what discjump writes" in refused("evaluate", path, *asked)
    path.write_bytes(b"nonsense")
    assert "model.onnx is not a readable ONNX model" in refused("evaluate", path, *asked)
    path.unlink()
    assert f"no model file at {path}" in refused("evaluate", path, *asked)


def test_without_onnxruntime_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    with pytest.raises(ModelError, match=r"needs onnxruntime.*pip install 'discjump-training\[onnx\]'"):
        find(str(tmp_path / "model.onnx"), HELD_OUT)
