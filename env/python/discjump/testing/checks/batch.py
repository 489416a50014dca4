"""What a batch's size, order and neighbours must not decide."""

from collections.abc import Sequence

from discjump.testing.registry import check
from discjump.testing.rollout import CORE, Rollout, parting
from discjump.testing.subject import Broken, Subject, Untested


@check(
    "determinism",
    needs=["seed_repeats", "reward_array", "flag_arrays"],
    when_disabled=["reset_mask_spares_others"],
)
def neighbours_do_not_matter(subject: Subject) -> str:
    """An environment's rollout does not depend on the actions of the others."""
    found = _by_neighbours(subject, CORE)
    if found:
        raise Broken(found)
    return f"environments 0 and {subject.num_envs - 1}, {subject.length} steps"


@check("determinism", needs=["info_masks", "final_obs_masks", "final_info_masks", "neighbours_do_not_matter"])
def neighbours_leave_infos(subject: Subject) -> str:
    """What `info` says of an environment does not depend on the actions of the others.

    If it does, the other comparisons of single environments leave `info` out.
    """
    found = _by_neighbours(subject, ("info",))
    if found:
        raise Broken(found)
    return f"environments 0 and {subject.num_envs - 1}, {subject.length} steps"


@check(
    "determinism",
    needs=["rollout_runs", "seed_repeats", "neighbours_do_not_matter", "seed_of_each_environment"],
)
def position_does_not_matter(subject: Subject) -> str:
    """An environment gives the same rollout at any index of the batch, for the same seed and actions.

    Seen by giving all the same seed; where lists of seeds are refused, by shifting all by one.
    """
    if subject.num_envs < 2:
        raise Untested("needs two environments or more")
    last = subject.num_envs - 1
    if subject.takes_lists is None:
        alike = [subject.seed] * subject.num_envs
        left = right = subject.play(subject.env, alike)
        rows = [(0, i) for i in range(1, subject.num_envs)]
    else:
        left, right = subject.rollout, subject.play(subject.env, subject.seed + 1)
        rows = [(i + 1, i) for i in range(last)]
    return _alike(subject, left, right, rows, "the same seed and actions at another index")


@check("determinism", needs=["new_instance_repeats", "position_does_not_matter"])
def batch_size_does_not_matter(subject: Subject) -> str:
    """An environment gives the same rollout alone and in a larger batch, for the same seed and actions."""
    last = subject.num_envs - 1
    alone = subject.play(subject.another(1), subject.seed + last)
    _alike(subject, subject.rollout, alone, [(last, 0)], f"seed {subject.seed + last} alone")
    size = 2 * subject.num_envs + 1
    larger = subject.play(subject.another(size), subject.seed)
    rows = [(i, i) for i in range(subject.num_envs)]
    _alike(subject, subject.rollout, larger, rows, f"among {size}")
    return f"1, {subject.num_envs} and {size} environments, {subject.length} steps"


@check("determinism", needs=["seed_repeats"])
def equals_reference(subject: Subject) -> str:
    """The rollout is, bit for bit, that of the reference (only if one is given).

    `SyncVectorEnv` over as many single environments is the natural one.
    """
    if subject.reference is None:
        raise Untested("no reference was given")
    reference = subject.another(make=subject.reference)
    mode = reference.metadata.get("autoreset_mode")
    if mode is not subject.mode:
        raise Broken(f"the reference has the autoreset mode {mode}, this environment {subject.mode}")
    again = subject.play(reference, subject.seed)
    rows = [(i, i) for i in range(subject.num_envs)]
    return _alike(subject, subject.rollout, again, rows, "against the reference")


def _by_neighbours(subject: Subject, fields: Sequence[str]) -> str | None:
    """How the first or last environment parts when all others act otherwise."""
    for index, again in subject.among_others.items():
        found = parting(subject.rollout, again, [(index, index)], subject.ignored, fields)
        if found:
            return f"with other actions for all but environment {index}: {found}"
    return None


def _alike(subject: Subject, left: Rollout, right: Rollout, rows: list[tuple[int, int]], what: str) -> str:
    found = parting(left, right, rows, subject.ignored, subject.row_fields)
    if found:
        raise Broken(f"{what}: {found}")
    return f"{what}, {subject.length} steps"
