"""Who may write to which array."""

from typing import Any

from discjump.testing.batching import to_rows
from discjump.testing.registry import check
from discjump.testing.rollout import FIELDS, parting
from discjump.testing.subject import Broken, Subject
from discjump.testing.trees import difference, frozen, scribble


@check("robustness", needs=["rollout_runs"])
def observations_stay(subject: Subject) -> str:
    """An observation that was returned does not change by later calls.

    `SyncVectorEnv(copy=True)`, the default; a learner that keeps the last observation would else store the
    next.
    """
    return _stays(subject, "observation")


@check("robustness", needs=["rollout_runs"])
def rewards_stay(subject: Subject) -> str:
    """Rewards that were returned do not change by later calls.

    `SyncVectorEnv.step` returns copies.
    """
    return _stays(subject, "reward")


@check("robustness", needs=["rollout_runs"])
def flags_stay(subject: Subject) -> str:
    """`terminated` and `truncated` that were returned do not change by later calls.

    `SyncVectorEnv.step` returns copies.
    """
    return _stays(subject, "terminated") and _stays(subject, "truncated")


@check("robustness", needs=["rollout_runs"])
def infos_stay(subject: Subject) -> str:
    """What `info` holds, `final_obs` among it, does not change by later calls.

    `SyncVectorEnv` makes a new `info` in each call.
    """
    return _stays(subject, "info")


@check("robustness", needs=["rollout_runs", "seed_repeats"])
def caller_may_write(subject: Subject) -> str:
    """Overwriting what was returned, or the actions after the call, changes nothing that comes later.

    Learners do: stable-baselines3 adds the bootstrap of a time limit to the rewards in place.
    """

    def overwrite(actions: Any, returned: tuple[Any, ...]) -> None:
        scribble(returned)
        scribble(actions)

    again = subject.play(subject.env, subject.seed, after=overwrite)
    found = parting(subject.rollout, again, ignored=subject.ignored)
    if found:
        raise Broken(f"after the returned arrays were overwritten: {found}")
    return f"{len(again.frames)} calls"


@check("robustness", needs=["rollout_runs"])
def actions_stay(subject: Subject) -> str:
    """`step` does not write to the actions that it is given.

    No rule of gymnasium's allows it, and learners store the array that they passed.
    """
    given: list[Any] = []

    def remember(step: int, rollout: object, actions: Any) -> Any:
        given.append(frozen(actions))
        return actions

    def compare(actions: Any, returned: object) -> None:
        found = None if actions is None else difference(given[-1], actions)
        if found:
            raise Broken(f"step {len(given)}: actions were changed: {found}")

    subject.play(subject.env, subject.seed, alter=remember, after=compare)
    return f"{len(given)} steps"


def _stays(subject: Subject, name: str) -> str:
    frames = subject.rollout.frames
    subject.play(subject.env, subject.seed + 1, steps=min(4, subject.quiet))
    for at, frame in enumerate(frames):
        place = FIELDS.index(name) if frame.call == "step" else {"observation": 0, "info": 1}.get(name)
        if place is None:
            continue
        now = frozen(frame.returned[place])
        if name == "observation":
            now = to_rows(subject.single_observation_space, now)
        found = difference(getattr(frame, name), now)
        if found:
            raise Broken(
                f"call {at} ({frame.call}): {name}{found.path} was {found.left} when it was returned, "
                f"is {found.right} after later calls"
            )
    return f"{len(frames)} calls"
