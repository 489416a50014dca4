"""What spaces and metadata declare, and whether what comes back is of them."""

from typing import Any

import numpy as np
from gymnasium import Space, spaces
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from discjump.testing.batching import ARRAYS, from_rows
from discjump.testing.registry import check
from discjump.testing.subject import Broken, Subject
from discjump.testing.trees import row


@check("gymnasium")
def spaces_are_batched(subject: Subject) -> str:
    """Batched spaces are `num_envs` single ones: the shapes and dtypes of
    `gymnasium.vector.utils.batch_space`.

    `VectorEnv`, attributes `observation_space`, `single_observation_space` and so on. Bounds may differ
    between environments (`observation_mode="different"`), so only shape and dtype are compared.
    """
    env = subject.env
    if env.num_envs < 1:
        raise Broken(f"num_envs: expected an integer from 1, got {env.num_envs!r}")
    for name in ("observation_space", "action_space"):
        single, batched = getattr(env, f"single_{name}"), getattr(env, name)
        found = _unlike(batch_space(single, env.num_envs), batched, name)
        if found:
            raise Broken(found)
    return f"{env.observation_space}"


@check("gymnasium")
def autoreset_mode_is_declared(subject: Subject) -> str:
    """`metadata["autoreset_mode"]` is a `gymnasium.vector.AutoresetMode`.

    `VectorEnv`: the mode "should be available in metadata"; wrappers and training code choose by it.
    """
    mode = subject.env.metadata.get("autoreset_mode")
    if not isinstance(mode, AutoresetMode):
        raise Broken(f"metadata['autoreset_mode']: expected a gymnasium.vector.AutoresetMode, got {mode!r}")
    return f"{mode}"


@check("gymnasium")
def rollout_runs(subject: Subject) -> str:
    """`reset` returns (observation, info), `step` (observation, reward, terminated, truncated, info).

    `VectorEnv.reset` and `VectorEnv.step`. Random actions of the action space are played through the ends of
    episodes; every other check needs this one.
    """
    rollout = subject.rollout
    ends = sum(int(mask.sum()) for _, mask in rollout.ends())
    return f"{len(rollout.steps)} steps of {subject.num_envs} environments, {ends} episodes ended"


@check("gymnasium", needs=["rollout_runs"])
def observation_dtype(subject: Subject) -> str:
    """Observations have the structure, shape and dtype that `observation_space` declares.

    `VectorEnv.observation_space`. `Space.contains` also takes what can be cast safely; buffers of learners
    are made of the declared dtype.
    """
    for at, frame in enumerate(subject.rollout.frames):
        found = _unlike_value(subject.observation_space, frame.returned[0], "observation")
        if found:
            raise Broken(f"call {at} ({frame.call}): {found}")
    return "as declared"


@check("gymnasium", needs=["observation_dtype"])
def observation_in_space(subject: Subject) -> str:
    """Every observation is in `observation_space`, and every row of it in `single_observation_space`.

    `VectorEnv.observation_space` and `VectorEnv.single_observation_space`.
    """
    for at, frame in enumerate(subject.rollout.frames):
        observation = from_rows(subject.single_observation_space, frame.observation)
        if not subject.observation_space.contains(observation):
            for index in range(subject.num_envs):
                one = row(frame.observation, index)
                if not subject.single_observation_space.contains(one):
                    raise Broken(
                        f"call {at} ({frame.call}), environment {index}: {one!r} is not in "
                        f"single_observation_space {subject.single_observation_space}"
                    )
            raise Broken(f"call {at} ({frame.call}): observation is not in {subject.observation_space}")
        for index in range(subject.num_envs):
            if not subject.single_observation_space.contains(row(frame.observation, index)):
                raise Broken(
                    f"call {at} ({frame.call}), environment {index}: not in single_observation_space"
                )
    return f"{len(subject.rollout.frames)} observations"


@check("gymnasium", needs=["rollout_runs"])
def reward_array(subject: Subject) -> str:
    """Rewards are a numpy array of shape (num_envs,), of one real dtype, without NaN or infinity.

    `VectorEnv`: "a NumPy array of shape (num_envs,)"; gymnasium's passive checker warns of NaN and infinity.
    """
    dtypes = set()
    for at, frame in enumerate(subject.rollout.frames):
        if frame.call == "step":
            reward = frame.returned[1]
            _array(at, "reward", reward, (subject.num_envs,))
            if not np.issubdtype(reward.dtype, np.floating) and not np.issubdtype(reward.dtype, np.integer):
                raise Broken(f"call {at} (step): reward: expected a real dtype, got {reward.dtype}")
            if not np.isfinite(frame.reward).all():
                raise Broken(f"call {at} (step): reward: expected finite numbers, got {frame.reward}")
            dtypes.add(reward.dtype)
            if len(dtypes) > 1:
                raise Broken(f"call {at} (step): reward: expected one dtype, got {sorted(map(str, dtypes))}")
    return ", ".join(map(str, dtypes))


@check("gymnasium", needs=["rollout_runs"])
def flag_arrays(subject: Subject) -> str:
    """`terminated` and `truncated` are numpy arrays of shape (num_envs,) and dtype bool.

    `VectorEnv`, as for rewards. Both of one environment may be true at once.
    """
    counts = np.zeros(2, int)
    for at, frame in enumerate(subject.rollout.frames):
        if frame.call == "step":
            for index, name in enumerate(("terminated", "truncated")):
                flag = frame.returned[2 + index]
                _array(at, name, flag, (subject.num_envs,))
                if flag.dtype != np.bool_:
                    raise Broken(f"call {at} (step): {name}: expected dtype bool, got {flag.dtype}")
                counts[index] += int(np.sum(flag))
    return f"{counts[0]} terminated, {counts[1]} truncated"


@check("gymnasium", needs=["rollout_runs"])
def info_masks(subject: Subject) -> str:
    """Every key of `info` has one entry for each environment and a mask `_key`: bool, shape (num_envs,).

    `VectorEnv._add_info`: "Every key of info is paired with a boolean mask `_key`". Inside of a dict the
    dict's own mask may stand for theirs, as `RecordEpisodeStatistics` has it.
    """
    for at, frame in enumerate(subject.rollout.frames):
        _masked(f"call {at} ({frame.call}): info", frame.returned[-1], subject.num_envs)
    keys = {key for frame in subject.rollout.frames for key in frame.info if f"_{key}" in frame.info}
    return f"keys {', '.join(sorted(map(str, keys)))}" if keys else "info is always empty"


def _masked(path: str, info: dict[str, Any], num_envs: int, nested: bool = False) -> None:
    for key, value in info.items():
        if key.startswith("_") and key[1:] in info:
            if not isinstance(value, np.ndarray) or value.dtype != np.bool_ or value.shape != (num_envs,):
                got = (
                    f"{value.dtype}{list(value.shape)}" if isinstance(value, np.ndarray) else repr(value)[:80]
                )
                raise Broken(f"{path}[{key!r}]: expected bool[{num_envs}], got {got}")
            continue
        if f"_{key}" not in info and not nested:
            raise Broken(f"{path}[{key!r}]: there is no mask {f'_{key}'!r}")
        if isinstance(value, dict):
            _masked(f"{path}[{key!r}]", value, num_envs, nested=True)
        elif not isinstance(value, np.ndarray) or value.ndim == 0 or len(value) != num_envs:
            got = str(value.shape) if isinstance(value, np.ndarray) else type(value).__name__
            raise Broken(f"{path}[{key!r}]: expected an array of {num_envs} entries or a dict, got {got}")


def _array(at: int, name: str, value: Any, shape: tuple[int, ...]) -> None:
    if not isinstance(value, np.ndarray):
        raise Broken(f"call {at} (step): {name}: expected a numpy array, got {type(value).__name__}")
    if value.shape != shape:
        raise Broken(f"call {at} (step): {name}: expected shape {shape}, got {value.shape}")


def _unlike(expected: Space[Any], came: Any, path: str) -> str | None:
    """How one space differs from another in structure, shape or dtype."""
    if isinstance(expected, spaces.Dict):
        if not isinstance(came, spaces.Dict) or expected.keys() != came.keys():
            return f"{path}: expected a Dict of {sorted(expected.keys())}, got {came}"
        pairs = [(expected[key], came[key], f"{path}[{key!r}]") for key in expected.keys()]  # noqa: SIM118
    elif isinstance(expected, spaces.Tuple):
        if not isinstance(came, spaces.Tuple) or len(expected) != len(came):
            return f"{path}: expected a Tuple of {len(expected)}, got {came}"
        pairs = [
            (one, other, f"{path}[{i}]") for i, (one, other) in enumerate(zip(expected, came, strict=True))
        ]
    else:
        if not isinstance(came, Space) or (came.shape, came.dtype) != (expected.shape, expected.dtype):
            shown = f"{came.dtype}{came.shape}" if isinstance(came, Space) else repr(came)
            return f"{path}: expected {expected.dtype}{expected.shape}, got {shown}"
        return None
    return next((found for found in (_unlike(*pair) for pair in pairs) if found), None)


def _unlike_value(space: Space[Any], value: Any, path: str) -> str | None:
    """How a value differs from a space in structure, shape or dtype."""
    if isinstance(space, spaces.Dict):
        if not isinstance(value, dict) or space.keys() != value.keys():
            return f"{path}: expected a dict of {sorted(space.keys())}, got {_kind(value)}"
        pairs = [(space[key], value[key], f"{path}[{key!r}]") for key in space.keys()]  # noqa: SIM118
    elif isinstance(space, spaces.Tuple):
        if not isinstance(value, tuple) or len(space) != len(value):
            return f"{path}: expected a tuple of {len(space)}, got {_kind(value)}"
        pairs = [(one, part, f"{path}[{i}]") for i, (one, part) in enumerate(zip(space, value, strict=True))]
    elif isinstance(space, ARRAYS):
        if not isinstance(value, np.ndarray) or (value.dtype, value.shape) != (
            np.dtype(space.dtype),
            space.shape,
        ):
            return f"{path}: expected {space.dtype}{space.shape}, got {_kind(value)}"
        return None
    else:
        return None
    return next((found for found in (_unlike_value(*pair) for pair in pairs) if found), None)


def _kind(value: Any) -> str:
    return f"{value.dtype}{value.shape}" if isinstance(value, np.ndarray) else type(value).__name__
