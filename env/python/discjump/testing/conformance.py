"""Running the checks: `check_vector_env`, and one check at a time for the pytest plugin."""

from collections.abc import Callable, Collection
from typing import Any, Self

from gymnasium.vector import AutoresetMode, VectorEnv

from discjump import _check
from discjump.testing import checks as checks  # fills the registry
from discjump.testing.limits import Unanswered, limited
from discjump.testing.registry import CHECKS, Check
from discjump.testing.report import Outcome, Report, Verdict
from discjump.testing.subject import Broken, Env, Factory, Subject, Untested


class Conformance:
    """Checks of one environment, each made at most once and when it is asked for.

    Arguments as of `check_vector_env`. Closes what it made when used as a context manager.
    """

    def __init__(
        self,
        env: Env | Factory,
        *,
        num_envs: int = 3,
        steps: int = 1000,
        seed: int = 0,
        skip: Collection[str] = (),
        ignore_info: Collection[str] = (),
        reference: Factory | None = None,
        timeout: float = 60.0,
        strict: bool = False,
    ) -> None:
        source: object = env
        if not isinstance(source, VectorEnv) and not callable(source):
            got = type(source).__name__
            raise TypeError(
                f"env: expected a gymnasium.vector.VectorEnv or a callable that makes one, got {got}"
            )
        for name, names in (("skip", skip), ("ignore_info", ignore_info)):
            if isinstance(names, str):
                raise TypeError(f"{name}: expected a collection of names, got the string {names!r}")
        for name in skip:
            _check.choice("skip", name, CHECKS)
        self.skip = frozenset(skip)
        self.strict = _check.flag("strict", strict)
        self.subject = Subject(
            env,
            num_envs=_check.integer("num_envs", num_envs, 1, 2**20),
            steps=_check.integer("steps", steps, 1, 2**31),
            seed=_check.integer("seed", seed, 0, 2**31),
            timeout=_check.real("timeout", timeout, 0.0, 86_400.0, "s", open_low=True),
            ignored=frozenset(ignore_info),
            reference=reference,
        )
        self.name = self.subject.name
        self._outcomes: dict[str, Outcome] = {}
        self._blocked: set[str] = set()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close what the checks made; an environment that was passed in stays open."""
        self.subject.discard()

    @property
    def names(self) -> tuple[str, ...]:
        """The checks that concern this environment, in their order."""
        mode = self.subject.mode
        return tuple(
            name
            for name, check in CHECKS.items()
            if (not isinstance(mode, AutoresetMode) or mode in check.modes)
            and (self.strict or not check.strict)
            and (name != "equals_reference" or self.subject.reference is not None)
        )

    def outcome(self, name: str) -> Outcome:
        """The outcome of one check; those that it needs are made first."""
        if name not in self._outcomes:
            check = CHECKS[_check.choice("check", name, CHECKS)]
            verdict, detail = self._made(check)
            self._outcomes[name] = Outcome(name, verdict, check.source, detail)
        return self._outcomes[name]

    def report(self) -> Report:
        """The outcomes of all checks."""
        mode = self.subject.mode
        shown = mode.name if isinstance(mode, AutoresetMode) else repr(mode)
        outcomes = tuple(self.outcome(name) for name in self.names)
        return Report(self.name, shown, self.subject.num_envs, outcomes)

    def _made(self, check: Check) -> tuple[Verdict, str]:
        subject = self.subject
        if check.name in self.skip:
            return "skip", "left out by the caller"
        if isinstance(subject.mode, AutoresetMode) and subject.mode not in check.modes:
            return "skip", f"not a rule of the mode {subject.mode.name}"
        if len(check.modes) < len(AutoresetMode) and not isinstance(subject.mode, AutoresetMode):
            return "skip", "the autoreset mode is not declared"
        for need in self._needs(check):
            if self.outcome(need).verdict == "fail" or need in self._blocked:
                self._blocked.add(check.name)
                return "skip", f"needs {need}, which {_state(self.outcome(need))}"
        if subject.unanswered is not None:
            return "skip", f"{subject.unanswered} was not done in time, so a call may still be running"
        return self._run(check)

    def _run(self, check: Check) -> tuple[Verdict, str]:
        subject = self.subject
        try:
            with limited(subject.timeout) as subject.limit:
                return "pass", check.run(subject)
        except Untested as reason:
            return "skip", str(reason)
        except Broken as broken:
            # What broke may be in any state.
            subject.forget()
            return "fail", str(broken)
        except Unanswered:
            subject.unanswered = check.name
            subject.discard()
            return "fail", f"not done within {subject.timeout:g} s"
        finally:
            subject.close_others()

    def _needs(self, check: Check) -> tuple[str, ...]:
        disabled = self.subject.mode is AutoresetMode.DISABLED
        # A check that was left out says nothing about those that would need it.
        return tuple(
            n for n in (*check.needs, *(check.when_disabled if disabled else ())) if n not in self.skip
        )


def check_vector_env(
    env: Env | Callable[[int], Any],
    *,
    num_envs: int = 3,
    steps: int = 1000,
    seed: int = 0,
    skip: Collection[str] = (),
    ignore_info: Collection[str] = (),
    reference: Factory | None = None,
    timeout: float = 60.0,
    strict: bool = False,
    raise_on_failure: bool = True,
) -> Report:
    """Check that a vector environment keeps gymnasium's rules and repeats bit for bit.

    Works on any `gymnasium.vector.VectorEnv`, in any of the three autoreset modes; nothing is assumed of its
    spaces. Actions are drawn at random from its action space, with seeds of their own.

    Args:
        env: a vector environment, or a callable that makes one of as many environments as it is told (a
            factory). Checks that need a second environment, or close one, are skipped without a factory. An
            environment that is passed in is played from many resets, stays open and may be of no use
            afterwards.
        num_envs: environments of the batch that a factory is asked for; from 2 on the rows of a batch are
            compared.
        steps: most steps of a rollout; it ends earlier once every environment has ended an episode.
        seed: the seed that the others follow from.
        skip: names of checks to leave out, such as `seeds_differ` for an environment without randomness.
        ignore_info: keys of `info` that need not repeat, dotted: `episode.t` of `RecordEpisodeStatistics`.
        reference: a factory of what the rollout must equal bit for bit, such as a `SyncVectorEnv` of the same
            environment, in the same autoreset mode.
        timeout: seconds for each check. A call that never returns is interrupted in the main thread of a
            POSIX system; elsewhere the limit holds between calls only.
        strict: also the checks that no rule of gymnasium asks for and its own environments fail: refused
            actions must leave no trace.
        raise_on_failure: whether failures raise.

    Returns:
        The report: an outcome (pass, fail or skip, with what was seen) of each check.

    Raises:
        ConformanceError: checks failed; lists all of them, with the first call, environment, field and values
            that differ. An `AssertionError`.
        TypeError, ValueError: an argument is wrong, or the factory makes something else. What the factory
            raises goes through.

    >>> import gymnasium
    >>> report = check_vector_env(lambda n: gymnasium.make_vec("CartPole-v1", n, vectorization_mode="sync"))
    >>> report["seed_repeats"].verdict
    'pass'
    >>> import discjump
    >>> print(check_vector_env(gymnasium.make_vec("discjump/Ski-v0", num_envs=2), steps=20))
    SkiVectorEnv(discjump/Ski-v0, num_envs=2) (autoreset NEXT_STEP, 2 environments): 29 passed, ... skipped
    ...
    """
    with Conformance(
        env,
        num_envs=num_envs,
        steps=steps,
        seed=seed,
        skip=skip,
        ignore_info=ignore_info,
        reference=reference,
        timeout=timeout,
        strict=strict,
    ) as conformance:
        report = conformance.report()
    if raise_on_failure:
        report.raise_on_failure()
    return report


def _state(outcome: Outcome) -> str:
    return "failed" if outcome.verdict == "fail" else "was skipped"
