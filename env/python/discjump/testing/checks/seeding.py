"""What a seed decides."""

import random
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

from discjump.testing.registry import check
from discjump.testing.rollout import CORE, Rollout, parting
from discjump.testing.subject import Broken, Env, Subject, Untested
from discjump.testing.trees import difference, take

ROWS = ["rollout_runs", "seed_repeats", "neighbours_do_not_matter"]


@check("gymnasium", needs=["rollout_runs"])
def seed_repeats(subject: Subject) -> str:
    """`reset(seed=s)` and the same actions give the same rollout, bit for bit, after any other.

    `Env.reset`: a seed makes the random number generator anew.
    """
    again = subject.play(subject.env, subject.seed)
    found = parting(subject.rollout, again, ignored=subject.ignored)
    if found:
        raise Broken(f"the second rollout of seed {subject.seed}: {found}")
    return f"{len(again.frames)} calls of {subject.num_envs} environments"


@check("gymnasium", needs=["rollout_runs", "seed_repeats"])
def reset_forgets(subject: Subject) -> str:
    """A reset with a seed, in the middle of an episode or right after an end, leaves nothing of before.

    `VectorEnv.reset` resets all environments; an autoreset that was still to come is dropped.
    """
    env, seen = subject.env, []
    halves = {"in the middle of an episode": min(subject.quiet, 5)}
    if subject.quiet < subject.length:
        halves["right after an episode's end"] = subject.quiet + 1
    for when, steps in halves.items():
        subject.drive(env, steps)
        again = subject.play(env, subject.seed, steps=min(subject.length, 32), settle=False)
        found = parting(subject.rollout, again, ignored=subject.ignored, prefix=True)
        if found:
            raise Broken(f"after a reset {when}: {found}")
        seen.append(when)
    return ", ".join(seen)


@check("gymnasium", needs=["rollout_runs", "seed_repeats"])
def unseeded_reset_continues(subject: Subject) -> str:
    """`reset()` without a seed goes on with the generator that the last seed made: it repeats as well.

    `Env.reset`: with None "and the environment already has a PRNG", it "will not be reset".
    """
    first, second = (_two_episodes(subject, subject.env) for _ in range(2))
    found = parting(first, second, ignored=subject.ignored)
    if found:
        raise Broken(f"reset() after the same seed and actions: {found}")
    return f"{len(first.frames)} calls"


@check("determinism", needs=["rollout_runs", "seed_repeats"])
def global_generators_do_not_matter(subject: Subject) -> str:
    """A rollout neither depends on the global generators of numpy and `random`, nor changes them."""
    kept, marks = (np.random.get_state(), random.getstate()), iter(range(1, 10**9))  # noqa: NPY002

    def disturb() -> None:
        mark = next(marks)
        np.random.seed(mark)  # noqa: NPY002
        random.seed(mark)
        state[:] = [_numpy_state(), random.getstate()]

    def compare(actions: object, returned: object) -> None:
        if _numpy_state() != state[0]:
            raise Broken(f"{_call(actions)} drew from numpy's global generator, or seeded it")
        if random.getstate() != state[1]:
            raise Broken(f"{_call(actions)} drew from the global generator of `random`, or seeded it")

    state: list[Any] = [None, None]
    try:
        again = subject.play(subject.env, subject.seed, before=disturb, after=compare)
    finally:
        np.random.set_state(kept[0])  # noqa: NPY002
        random.setstate(kept[1])
    found = parting(subject.rollout, again, ignored=subject.ignored)
    if found:
        raise Broken(f"with other states of the global generators: {found}")
    return f"{len(again.frames)} calls"


@check("sync", needs=ROWS)
def seed_list(subject: Subject) -> str:
    """`reset(seed=[...])`: each environment follows its own entry.

    `SyncVectorEnv.reset`. Skipped if a list is refused, for the base class declares an int.
    """
    if subject.takes_lists is not None:
        raise Untested(f"refuses lists of seeds: {subject.takes_lists}")
    if subject.num_envs < 2:
        raise Untested("needs two environments or more")
    one = list(subject.seeds(subject.seed + 100))
    other = [seed + 50 for seed in one]
    other[1] = one[1]
    left, right = subject.play(subject.env, one), subject.play(subject.env, other, streams=one)
    found = parting(left, right, [(1, 1)], subject.ignored, subject.row_fields)
    if found:
        raise Broken(f"environment 1 has the seed {one[1]} in {one} and in {other}: {found}")
    return f"{one} and {other}"


@check("sync", needs=[*ROWS, "seed_list"])
def seed_of_each_environment(subject: Subject) -> str:
    """`reset(seed=s)` gives environment i the seed s + i.

    `SyncVectorEnv.reset`: "int - [seed, seed+1, ..., seed+n]". Seen by a list of these seeds; where lists are
    refused, by the first observations of seeds s and s + 1, which must be one environment apart.
    """
    if subject.takes_lists is None:
        again = subject.play(subject.env, list(subject.seeds()))
        found = parting(subject.rollout, again, ignored=subject.ignored)
        if found:
            raise Broken(f"seed={subject.seed} and seed={list(subject.seeds())}: {found}")
        return "as the list of these seeds"
    if subject.num_envs < 2:
        raise Untested("needs two environments or more")
    later = subject.reset(subject.env, seed=subject.seed + 1)
    last = subject.num_envs - 1
    shifted = difference(
        take(subject.rollout.frames[0].observation, range(1, last + 1)), take(later.observation, range(last))
    )
    if shifted:
        raise Broken(
            f"environments from 1 of seed {subject.seed} and from 0 of seed {subject.seed + 1}: {shifted}"
        )
    return "first observations of s and s + 1 are one environment apart"


@check("determinism", needs=["rollout_runs", "seed_repeats"])
def seeds_differ(subject: Subject) -> str:
    """Other seeds give other rollouts under the same actions.

    An environment without any randomness fails: let the call leave this check out (`skip=["seeds_differ"]`).
    """
    other = subject.play(subject.env, subject.seed + 1000, streams=subject.seeds())
    for i in range(subject.num_envs):
        if parting(subject.rollout, other, [(i, i)], fields=CORE):
            return f"seeds {subject.seed} and {subject.seed + 1000}"
    raise Broken(
        f"seeds {subject.seed} and {subject.seed + 1000} give the same {subject.length} steps: the "
        "seed is not used, or nothing is random (then skip this check)"
    )


@check("determinism", needs=["rollout_runs", "seed_repeats"])
def new_instance_repeats(subject: Subject) -> str:
    """A second environment of the same making gives the same rollout, bit for bit."""
    again = subject.play(subject.another(), subject.seed)
    found = parting(subject.rollout, again, ignored=subject.ignored)
    if found:
        raise Broken(f"a new environment, seed {subject.seed}: {found}")
    return f"{len(again.frames)} calls"


def _two_episodes(subject: Subject, env: Env) -> Rollout:
    """Some steps after a seed, then `reset()` and some more."""
    streams, rollout = subject.seeds(), Rollout(subject.seeds())
    subject.drive(env, min(subject.quiet, 8))
    rollout.frames.append(subject.reset(env))
    for step in range(min(subject.length, 16)):
        rollout.frames.append(subject.step(env, subject.actions.batch(streams, step)))
        if subject.mode is AutoresetMode.DISABLED and rollout.frames[-1].ended.any():
            break
    return rollout


def _numpy_state() -> object:
    state = np.random.get_state(legacy=False)  # noqa: NPY002
    return state["state"]["pos"], state["state"]["key"].tobytes(), state["has_gauss"]


def _call(actions: object) -> str:
    return "reset" if actions is None else "step"
