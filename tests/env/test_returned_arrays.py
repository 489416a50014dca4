"""Returned arrays.

Contract: nothing that a user stored ever changes. The simulator uses a buffer again only when nobody holds a
view of it; were it to do so earlier, algorithms that store the last observation after the next step would
learn from observations shifted by one, silently.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from discjump.envs.named import SkiEnv, SkiVectorEnv

from .play import SHORT, random_actions, same_bits


def leaves(value):
    """Every array of numbers in nested dicts, lists and object arrays."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, np.ndarray) and value.dtype != object:
        yield value
    elif isinstance(value, (list, tuple, np.ndarray)):
        for part in value:
            yield from leaves(part)


class Album:
    """Arrays beside copies made when they came."""

    def __init__(self):
        self.pages = []

    def add(self, value):
        self.pages += [(array, array.copy()) for array in leaves(value)]

    def check(self):
        for array, copy in self.pages:
            assert array.tobytes() == copy.tobytes()


@pytest.mark.parametrize(
    "mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP], ids=lambda mode: mode.value
)
@pytest.mark.parametrize("num_envs", [3, 300])
def test_vector(mode, num_envs):
    envs, album = SkiVectorEnv(num_envs, autoreset_mode=mode, **SHORT), Album()
    album.add(envs.reset(seed=0))
    for action in random_actions(0, 50, num_envs):
        album.add(envs.step(action))
    album.add(envs.reset())
    envs.step(action)
    album.check()


def test_vector_keeping_only_a_slice():
    envs = SkiVectorEnv(64, **SHORT)
    row = envs.reset(seed=0)[0][5:6, 2:7]
    before = row.copy()
    for action in random_actions(0, 20, 64):
        envs.step(action)
    assert row.tobytes() == before.tobytes()


def test_single():
    env, album = SkiEnv(terrain_seeds=[0]), Album()
    album.add(env.reset(seed=0))
    for action in random_actions(0, 50, 1)[:, 0]:
        album.add(env.step(action))
    album.check()


def test_stable_baselines3():
    sb3 = pytest.importorskip("discjump.sb3")
    envs, album = sb3.make_vec_env("discjump/Ski-v0", n_envs=40, seed=0, **SHORT), Album()
    album.add(envs.reset())
    for action in random_actions(0, 50, 40):
        album.add(envs.step(action))
    album.check()


def test_what_a_user_writes_into_them_changes_nothing():
    calm, rude = SkiVectorEnv(4, **SHORT), SkiVectorEnv(4, **SHORT)
    calm.reset(seed=0)
    rude.reset(seed=0)[0][:] = 7.0
    for action in random_actions(0, 60, 4):
        one, other = calm.step(action), rude.step(action)
        for left, right in zip(leaves(one), leaves(other), strict=True):
            assert left.tobytes() == right.tobytes()
        for array in leaves(other):
            if array.flags.writeable:
                array[...] = 1


def test_only_masks_that_are_true_everywhere_are_shared_and_they_refuse_to_be_changed():
    envs = SkiVectorEnv(4, **SHORT)
    shared, ends = {id(envs.reset(seed=0)[1]["_distance"])}, 0
    for action in random_actions(0, 200, 4):
        *arrays, info = envs.step(action)
        ends += "_return" in info
        assert all(array.flags.writeable for array in leaves(arrays))
        for key, column in info.items():
            if key in ("_distance", "_speed", "_time", "_outside_mission_area"):
                assert column.all()
                with pytest.raises(ValueError, match="read-only"):
                    column[0] = False
                shared.add(id(column))
            else:
                assert column.flags.writeable, key
    assert len(shared) == 1
    assert ends > 3


@pytest.mark.parametrize("front", ["vector", "single", "stable-baselines3"])
def test_buffers_are_used_again_when_nobody_holds_them(front):
    """Two of each: the caller still holds the last step's while the next one is made."""
    actions = random_actions(9, 200, 40)
    step: Callable[..., Any]
    if front == "vector":
        envs = SkiVectorEnv(40, **SHORT)
        envs.reset(seed=0)
        step = envs.step
    elif front == "single":
        # So long an episode that none ends.
        env, actions = SkiEnv(terrain_seeds=[0], time_limit=600.0), actions[:, 0]
        env.reset(seed=0)
        step = env.step
    else:
        sb3 = pytest.importorskip("discjump.sb3")
        envs = sb3.make_vec_env("discjump/Ski-v0", n_envs=40, seed=0, **SHORT)
        envs.reset()
        step = envs.step
    places: dict[object, set[int]] = {}
    for action in actions:
        result = step(action)
        named = dict(enumerate(result[:3])) | (result[-1] if front == "vector" else {})
        for name, array in named.items():
            if isinstance(array, np.ndarray):
                places.setdefault(name, set()).add(array.ctypes.data)
    assert places
    assert all(len(addresses) <= 2 for addresses in places.values()), places
    assert ("return" in places) == (front == "vector")


def _as_integers(array):
    array.dtype = np.dtype(f"i{array.dtype.itemsize // 2 or 1}")


def _in_two_rows(array):
    array.shape = (2, -1)


def _read_only(array):
    array.setflags(write=False)


@pytest.mark.parametrize("change", [_as_integers, _in_two_rows, _read_only])
def test_a_buffer_that_was_changed_in_place_is_not_used_again(change):
    """A returned array whose dtype a user had set was written to beyond its end when it was used again; one
    of another shape made every later step fail.
    """
    envs, beside = (SkiVectorEnv(64, **SHORT) for _ in range(2))
    envs.reset(seed=1)
    beside.reset(seed=1)
    for actions in random_actions(3, 60, 64):
        result, expected = envs.step(actions), beside.step(actions)
        same_bits(result, expected)
        for array in leaves(result):
            if array.flags.writeable and (change is not _as_integers or array.dtype.itemsize > 1):
                change(array)
        del array, result
