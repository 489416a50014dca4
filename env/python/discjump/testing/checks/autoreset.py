"""What each autoreset mode promises at an episode's end."""

from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from discjump.testing.registry import check
from discjump.testing.rollout import Frame, Rollout, parting
from discjump.testing.subject import Broken, Subject, Untested
from discjump.testing.trees import difference, row, same_values, take

NEXT = frozenset({AutoresetMode.NEXT_STEP})
SAME = frozenset({AutoresetMode.SAME_STEP})
LATER = frozenset({AutoresetMode.NEXT_STEP, AutoresetMode.DISABLED})


@check("gymnasium", needs=["reward_array", "flag_arrays"], modes=NEXT)
def next_step_reset_is_empty(subject: Subject) -> str:
    """NEXT_STEP: the step after an end resets: its reward is 0, and it ends no episode.

    Autoreset documentation of gymnasium and `SyncVectorEnv.step`.
    """
    seen = 0
    for at, ended, frame in _next_steps(subject):
        for index in map(int, np.flatnonzero(ended)):
            where = f"call {at} (step), environment {index}, whose episode ended in call {at - 1}"
            if frame.reward[index] != 0:
                raise Broken(f"{where}: expected reward 0, got {frame.reward[index]}")
            if frame.terminated[index] or frame.truncated[index]:
                flags = f"terminated {frame.terminated[index]}, truncated {frame.truncated[index]}"
                raise Broken(f"{where}: expected no end, got {flags}")
            seen += 1
    return f"{seen} resets"


@check("gymnasium", needs=["flag_arrays", "seed_repeats"], modes=NEXT)
def next_step_ignores_action(subject: Subject) -> str:
    """NEXT_STEP: the step that resets an environment ignores its action.

    Autoreset documentation of gymnasium.
    """
    changed = 0
    for index in sorted({0, subject.num_envs - 1}):

        def alter(step: int, rollout: Rollout, actions: Any, index: int = index) -> Any:
            nonlocal changed
            last = rollout.frames[-1]
            if last.call != "step" or not last.ended[index]:
                return actions
            streams = list(subject.seeds())
            streams[index] = _other_stream(subject, streams[index], step)
            changed += 1
            return subject.actions.batch(streams, step)

        again = subject.play(subject.env, subject.seed, alter=alter)
        found = parting(subject.rollout, again, [(index, index)], subject.ignored, subject.row_fields)
        if found:
            raise Broken(f"with other actions of environment {index} in the steps that reset it: {found}")
    if not changed:
        raise Untested(_no_end(subject))
    return f"{changed} resets"


@check("gymnasium", needs=["flag_arrays"], modes=SAME)
def final_obs_masks(subject: Subject) -> str:
    """SAME_STEP: `info["final_obs"]` is there for those whose episode ended; `_final_obs` says which.

    Autoreset documentation of gymnasium, `SyncVectorEnv.step`.
    """
    return _final_masks(subject, "final_obs")


@check("gymnasium", needs=["flag_arrays"], modes=SAME)
def final_info_masks(subject: Subject) -> str:
    """SAME_STEP: `info["final_info"]`, a dict, is there for those whose episode ended, with its mask.

    As for `final_obs`. Masks inside of it name nobody else either.
    """
    seen = _final_masks(subject, "final_info")
    for at, ended in subject.rollout.ends():
        info = subject.rollout.frames[at].info["final_info"]
        if not isinstance(info, dict):
            raise Broken(f"call {at} (step): info['final_info']: expected a dict, got {type(info).__name__}")
        for key, mask in info.items():
            if isinstance(key, str) and key.startswith("_") and key[1:] in info and (mask & ~ended).any():
                raise Broken(
                    f"call {at} (step): info['final_info'][{key!r}]: expected nothing outside of "
                    f"{ended.tolist()}, got {mask.tolist()}"
                )
    return seen


@check("gymnasium", needs=["observation_in_space", "final_obs_masks"], modes=SAME)
def final_obs_in_space(subject: Subject) -> str:
    """SAME_STEP: each `final_obs` is a single observation, in `single_observation_space`, with its dtype."""
    seen = 0
    for at, index, _, last in _final_observations(subject):
        space = subject.single_observation_space
        if not space.contains(last):
            raise Broken(f"call {at} (step), environment {index}: final_obs {last!r} is not in {space}")
        if isinstance(last, np.ndarray) and last.dtype != space.dtype:
            raise Broken(
                f"call {at} (step), environment {index}: final_obs: expected {space.dtype}, got {last.dtype}"
            )
        seen += 1
    return f"{seen} final observations"


@check("gymnasium", needs=["final_obs_masks"], modes=SAME)
def final_obs_is_the_last(subject: Subject) -> str:
    """SAME_STEP: `final_obs` is the ended episode's last observation, not the next one's first.

    Autoreset documentation of gymnasium. Fails if both are the same at every end that was seen.
    """
    ends = [(row(frame.observation, index), last) for _, index, frame, last in _final_observations(subject)]
    if all(same_values(first, last) for first, last in ends):
        raise Broken(f"at all {len(ends)} ends final_obs is the first observation of the next episode")
    return f"{len(ends)} ends"


@check(
    "sync",
    needs=["unseeded_reset_continues", "next_step_ignores_action", "seed_of_each_environment"],
    modes=LATER,
)
def autoreset_is_a_reset(subject: Subject) -> str:
    """NEXT_STEP, DISABLED: an episode starts as it would by `reset()` of everything at that moment.

    `SyncVectorEnv` resets each environment by its own `reset()`, from its own generator.
    """
    rollout = subject.rollout
    if not rollout.ends():
        raise Untested(_no_end(subject))
    at, ended = rollout.ends()[0]
    if at + 1 >= len(rollout.frames):
        raise Untested("the rollout ends with an episode's end")
    subject.drive(subject.env, subject.quiet + 1)
    reset = subject.reset(subject.env)
    rows = np.flatnonzero(ended)
    found = difference(take(rollout.frames[at + 1].observation, rows), take(reset.observation, rows))
    if found:
        raise Broken(
            f"environments {rows.tolist()}, ended in call {at}: by autoreset and by reset(): {found}"
        )
    return f"environments {rows.tolist()}, ended in call {at}"


def _next_steps(subject: Subject) -> list[tuple[int, NDArray[np.bool_], Frame]]:
    frames = subject.rollout.frames
    found = [(at + 1, ended, frames[at + 1]) for at, ended in subject.rollout.ends() if at + 1 < len(frames)]
    if not found:
        raise Untested(_no_end(subject))
    return found


def _final_masks(subject: Subject, key: str) -> str:
    ends = 0
    for at, frame in enumerate(subject.rollout.frames):
        if frame.call != "step":
            continue
        where, ended, mask = f"call {at} (step): info[{f'_{key}'!r}]", frame.ended, frame.info.get(f"_{key}")
        if mask is None and not ended.any() and key not in frame.info:
            continue
        if mask is None or key not in frame.info:
            raise Broken(f"{where}: expected {ended.tolist()}, but {key!r} or its mask is missing")
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_ or mask.shape != ended.shape:
            raise Broken(f"{where}: expected bool{list(ended.shape)}, got {mask!r}")
        if (mask != ended).any():
            raise Broken(
                f"{where}: expected {ended.tolist()}, as terminated or truncated, got {mask.tolist()}"
            )
        ends += int(ended.sum())
    if not ends:
        raise Untested(_no_end(subject))
    return f"{ends} ends"


def _final_observations(subject: Subject) -> list[tuple[int, int, Frame, Any]]:
    """Each end: call, environment, frame and what `final_obs` holds for it."""
    found = [
        (
            at,
            int(index),
            subject.rollout.frames[at],
            row(subject.rollout.frames[at].info["final_obs"], int(index)),
        )
        for at, ended in subject.rollout.ends()
        for index in np.flatnonzero(ended)
    ]
    if not found:
        raise Untested(_no_end(subject))
    return found


def _other_stream(subject: Subject, stream: int, step: int) -> int:
    """A stream whose action at this step is another one, if there is another."""
    usual = subject.actions.one(stream, step)
    candidates = range(stream + 10_000, stream + 10_032)
    return next((c for c in candidates if difference(usual, subject.actions.one(c, step))), stream)


def _no_end(subject: Subject) -> str:
    return f"no episode ended within {subject.length} steps of random actions: allow more steps"
