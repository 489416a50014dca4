"""Refusals and closing."""

from gymnasium.vector.utils import batch_space

from discjump.testing.registry import check
from discjump.testing.rollout import Rollout, parting
from discjump.testing.subject import Broken, Env, Subject


@check("robustness", needs=["rollout_runs"])
def wrong_actions_are_refused(subject: Subject) -> str:
    """Actions for more or fewer environments raise.

    `VectorEnv.step` asks for an element of `action_space`. An environment that was passed in may be of no use
    afterwards.
    """
    env = _own(subject)
    sizes = _wrong_sizes(subject)
    for size in sizes:
        subject.reset(env, seed=subject.seed)
        _refused(subject, env, size)
        env = _own(subject)
    return f"actions of {' and '.join(map(str, sizes))} environments"


@check("robustness", needs=["new_instance_repeats", "wrong_actions_are_refused"], strict=True)
def refused_actions_change_nothing(subject: Subject) -> str:
    """After actions for more or fewer environments were refused, the rollout goes on as without them.

    No rule of gymnasium's, and its own do not keep it: they step environments before they count the actions.
    """
    sizes, steps = _wrong_sizes(subject), max(0, min(3, subject.quiet - 1))
    for size in sizes:
        env = _own(subject)
        before = subject.drive(env, steps)
        _refused(subject, env, size)
        if steps < subject.length:
            after = subject.step(env, subject.actions.batch(subject.seeds(), steps))
            one, other = Rollout((), [before, subject.rollout.steps[steps]]), Rollout((), [before, after])
            found = parting(one, other, ignored=subject.ignored)
            if found:
                raise Broken(f"the step after refused actions of {size} environments: {found}")
    return f"actions of {' and '.join(map(str, sizes))} environments"


@check("gymnasium")
def close_twice(subject: Subject) -> str:
    """`close` may be called again.

    `VectorEnv.close` returns at once if the environment is closed already. Needs a factory.
    """
    env = subject.another()
    subject.reset(env, seed=subject.seed)
    for time in ("close", "second close"):
        subject.called(time, env.close)
    return "closed twice"


@check("gymnasium", needs=["close_twice"])
def closed_is_set(subject: Subject) -> str:
    """After `close` the attribute `closed` is True.

    `VectorEnv.close`: calls `close_extras` "and set closed as True". Needs a factory.
    """
    env = subject.another()
    if env.closed:
        raise Broken("closed is True before close")
    subject.called("close", env.close)
    closed: object = env.closed
    if closed is not True:
        raise Broken(f"closed after close: expected True, got {closed!r}")
    return "closed is True"


def _own(subject: Subject) -> Env:
    """An environment that may be spoilt."""
    return subject.env if subject.factory is None else subject.another()


def _wrong_sizes(subject: Subject) -> list[int]:
    return [subject.num_envs + 1] + ([subject.num_envs - 1] if subject.num_envs > 1 else [])


def _refused(subject: Subject, env: Env, size: int) -> None:
    space = batch_space(subject.actions.space, size)
    space.seed(subject.seed)
    try:
        subject.step(env, space.sample())
    except Broken:
        return
    raise Broken(f"step: actions of {size} environments were accepted by {subject.num_envs}")
