import zipfile

import numpy as np
import pytest
from stable_baselines3 import PPO

from discjump_training import baselines, files, model, train
from discjump_training.courses import VALIDATION
from discjump_training.episodes import Stage
from discjump_training.errors import ModelError


@pytest.fixture(scope="module")
def stage():
    return Stage(VALIDATION, 4, {"landing": False}, threads=1)


@pytest.fixture
def ppo(tiny):
    env = train.TimedVecEnv(train.make_env(tiny, 0))
    return train.make_model(tiny, env, 0)


def test_a_saved_model_is_the_same_for_us_and_for_stable_baselines3(ppo, tmp_path):
    path = tmp_path / "model.zip"
    model.save(ppo, path, {"steps": 7}, {"extra": b"\0\1"})
    assert model.about(path) == {"steps": 7}
    assert model.read_entry(path, "extra") == b"\0\1"
    observations = np.random.default_rng(0).normal(size=(32, *ppo.observation_space.shape)).astype(np.float32)
    expected, _ = ppo.predict(observations, deterministic=True)
    for loaded in (model.load(path), PPO.load(path)):
        assert np.array_equal(model.Greedy(loaded, "loaded")(observations), expected)


def test_sampled_actions_repeat_and_leave_the_global_generator_alone(ppo):
    import torch

    observations = np.zeros((64, *ppo.observation_space.shape), dtype=np.float32)
    before = torch.get_rng_state()
    first, second = (model.Sampled(ppo, "a", seed=1) for _ in range(2))
    draws = [first(observations) for _ in range(2)]
    assert torch.equal(torch.get_rng_state(), before)
    assert np.array_equal(draws[0], second(observations))
    assert not np.array_equal(draws[0], draws[1])


def test_a_crash_while_writing_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "file"
    files.write_atomically(path, b"old")

    def crash(descriptor):
        raise OSError("no space left")

    monkeypatch.setattr("os.fsync", crash)
    with pytest.raises(OSError, match="no space left"):
        files.write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_files_that_are_no_models(ppo, tmp_path):
    with pytest.raises(ModelError, match=r"no model file at .*none\.zip"):
        model.load(tmp_path / "none.zip")
    path = tmp_path / "model.zip"
    path.write_bytes(b"PK\3\4 not a zip")
    with pytest.raises(ModelError, match=r"model\.zip is not a readable model file"):
        model.load(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("hello", "world")
    with pytest.raises(ModelError, match=r"is not a whole model file: it lacks data, policy\.optimizer\.pth"):
        model.load(path)
    with zipfile.ZipFile(path, "w") as archive:
        for name in model.ENTRIES:
            archive.writestr(name, "{}")
    with pytest.raises(ModelError, match=r"does not hold a PPO model"):
        model.load(path)
    model.save(ppo, path, {})
    with pytest.raises(ModelError, match=r"has no entry environment\.snapshot"):
        model.read_entry(path, train.ENVIRONMENT_ENTRY)


@pytest.mark.parametrize("keep", [0.2, 0.5, 0.9, 0.99, 0.999])
def test_a_file_cut_off_anywhere_is_refused(ppo, tmp_path, keep):
    path = tmp_path / "model.zip"
    model.save(ppo, path, {})
    content = path.read_bytes()
    path.write_bytes(content[: int(keep * len(content))])
    with pytest.raises(ModelError, match=r"is not a (readable|whole) model file"):
        model.load(path)


def test_a_flipped_byte_is_refused(ppo, tmp_path):
    path = tmp_path / "model.zip"
    model.save(ppo, path, {})
    with zipfile.ZipFile(path) as archive:
        start = archive.getinfo("policy.pth").header_offset
    content = bytearray(path.read_bytes())
    content[start + 500] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(ModelError, match=r"its entry policy\.pth does not match its checksum"):
        model.load(path)


def test_a_model_for_other_observations_is_refused(ppo, tiny, tmp_path):
    model.check_spaces(ppo, tmp_path, Stage(VALIDATION, 4, tiny.environment.judged(), threads=1).env)
    other = Stage(VALIDATION, 4, baselines.OPTIONS, threads=1)
    with pytest.raises(ModelError, match=r"was trained on observations in Box.*but the environment has Box"):
        model.check_spaces(ppo, tmp_path, other.env)
