"""Resets of some environments: `reset(options={"reset_mask": mask})`.

With the mode DISABLED they are the only way on, and the autoreset documentation of gymnasium describes them.
`SyncVectorEnv` and `AsyncVectorEnv` take them in every mode. One that refuses them in another mode is
skipped; one that takes no notice of the mask and resets everything fails.
"""

from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from discjump.testing.registry import check
from discjump.testing.rollout import CORE, Frame, Rollout, parting
from discjump.testing.subject import Broken, Subject, Untested
from discjump.testing.trees import difference, take

SHARED = ["seed_repeats", "reward_array", "flag_arrays"]


@check("sync", needs=SHARED)
def reset_mask_spares_others(subject: Subject) -> str:
    """A reset with a mask leaves the environments outside of the mask as they are.

    Their rows of the observation are those of the last call, and they go on as if there had been no reset.
    """
    mask, before, after = _masked_reset(subject)
    outside = np.flatnonzero(~mask)
    found = difference(take(before.observation, outside), take(after.observation, outside))
    if found:
        raise Broken(f"reset_mask {mask.tolist()}: the others changed, so the mask was not heeded: {found}")
    steps = _steps_before(subject)
    onward = Rollout(subject.seeds(), [after])
    for step in range(steps, min(steps + 8, subject.length)):
        onward.frames.append(subject.step(subject.env, subject.actions.batch(subject.seeds(), step)))
        if subject.mode is AutoresetMode.DISABLED and onward.frames[-1].ended.any():
            break
    undisturbed = Rollout(subject.seeds(), [after, *subject.rollout.steps[steps:]])
    rows = [(int(i), int(i)) for i in outside]
    found_later = parting(undisturbed, onward, rows, fields=CORE, prefix=True)
    if found_later:
        raise Broken(
            f"reset_mask {mask.tolist()}: environments outside of it went on otherwise: {found_later}"
        )
    return f"{len(outside)} of {subject.num_envs} environments, {len(onward.frames) - 1} steps on"


@check("sync", needs=[*SHARED, "reset_mask_spares_others"])
def reset_mask_resets(subject: Subject) -> str:
    """A reset with a seed and a mask starts those of the mask as the same reset without a mask would."""
    env = subject.env
    first = subject.reset(env, seed=subject.seed + 5)
    mask, _, after = _masked_reset(subject, seed=subject.seed + 5)
    inside = np.flatnonzero(mask)
    found = difference(take(first.observation, inside), take(after.observation, inside))
    if found:
        raise Broken(f"reset_mask {mask.tolist()}: observation of the environments in it: {found}")
    return f"{len(inside)} of {subject.num_envs} environments"


@check("sync", needs=[*SHARED, "reset_mask_spares_others", "info_masks"])
def reset_mask_infos(subject: Subject) -> str:
    """`info` of a reset with a mask speaks of the environments of the mask alone."""
    mask, _, after = _masked_reset(subject)
    _within(after.info, mask, "info")
    return f"keys {', '.join(sorted(map(str, after.info))) or 'none'}"


@check("sync", needs=[*SHARED, "reset_mask_spares_others"])
def reset_mask_refusals(subject: Subject) -> str:
    """A mask of another shape or dtype, or without any True, is refused, and nothing is reset."""
    _masked_reset(subject)
    env, count = subject.env, subject.num_envs
    steps = _steps_before(subject)
    bad: dict[str, NDArray[Any]] = {
        "of another shape": np.ones(count + 1, np.bool_),
        "of integers": np.ones(count, np.int64),
        "without any True": np.zeros(count, np.bool_),
    }
    for what, mask in bad.items():
        before = subject.drive(env, steps)
        try:
            subject.reset(env, mask=mask)
        except Broken:
            pass
        else:
            raise Broken(f"a reset_mask {what} ({mask.dtype}{list(mask.shape)}) was accepted")
        if steps < subject.length:
            after = subject.step(env, subject.actions.batch(subject.seeds(), steps))
            one, other = Rollout((), [before, subject.rollout.steps[steps]]), Rollout((), [before, after])
            found = parting(one, other, ignored=subject.ignored)
            if found:
                raise Broken(f"after a refused reset_mask {what}: {found}")
    return ", ".join(bad)


def _steps_before(subject: Subject) -> int:
    return min(3, subject.quiet)


def _masked_reset(subject: Subject, seed: int | None = None) -> tuple[NDArray[np.bool_], Frame, Frame]:
    """A few steps, then a reset of every other environment: the mask, the last step, the reset."""
    if subject.num_envs < 2:
        raise Untested("needs two environments or more")
    mask = np.array([index % 2 == 0 for index in range(subject.num_envs)])
    before = subject.drive(subject.env, _steps_before(subject))
    try:
        after = subject.reset(subject.env, seed=seed, mask=mask)
    except Broken as refusal:
        subject.discard()
        if subject.mode is AutoresetMode.DISABLED:
            raise
        raise Untested(f"refuses reset masks: {refusal}") from None
    return mask, before, after


def _within(info: dict[str, Any], mask: NDArray[np.bool_], path: str) -> None:
    for key, value in info.items():
        if key.startswith("_") and key[1:] in info and isinstance(value, np.ndarray):
            if (value & ~mask).any():
                raise Broken(
                    f"{path}[{key!r}]: expected nothing outside of {mask.tolist()}, got {value.tolist()}"
                )
        elif isinstance(value, dict):
            _within(value, mask, f"{path}[{key!r}]")
