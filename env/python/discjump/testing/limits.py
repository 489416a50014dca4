"""A limit of time around calls that may never return."""

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager


class Unanswered(BaseException):
    """The limit has passed. No `Exception`, for code between may catch those and go on waiting."""


class Limit:
    """A limit of time; `check()` raises `Unanswered` when it has passed."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self._end = time.monotonic() + seconds

    def check(self) -> None:
        """Raise `Unanswered` if the limit has passed."""
        if time.monotonic() > self._end:
            raise Unanswered


@contextmanager
def limited(seconds: float) -> Iterator[Limit]:
    """Raise `Unanswered` in the body after `seconds`.

    In the main thread of a system with `SIGALRM` a blocked call is interrupted as well, unless it blocks
    outside of Python's reach or somebody else (a plugin with timeouts) already waits for that signal.
    Elsewhere the limit holds at each `check()`.
    """
    limit = Limit(seconds)
    if not _may_interrupt():
        yield limit
        return

    def interrupt(*_: object) -> None:
        raise Unanswered

    previous = signal.signal(signal.SIGALRM, interrupt)
    # Again every second: what caught the first one would wait on.
    signal.setitimer(signal.ITIMER_REAL, seconds, 1.0)
    try:
        yield limit
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)


def _may_interrupt() -> bool:
    return (
        hasattr(signal, "setitimer")
        and threading.current_thread() is threading.main_thread()
        and signal.getitimer(signal.ITIMER_REAL)[0] == 0
    )
