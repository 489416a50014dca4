"""What callgrind runs for `instructions`: `python -m discjump.bench.counted CASES`.

CASES is a file: a pickle of cases and how many calls of each. Prints a line for every case that is done.
"""

import gc
import os
import pickle
import sys
from collections.abc import Sequence
from pathlib import Path

from discjump.bench.clock import Case


def play(cases: Sequence[tuple[Case, int]]) -> None:
    """Each case for no calls, then for its calls, marked before, between and after."""
    gc.disable()
    for case, calls in cases:
        ready = case.make()
        ready.time(1)
        os.getppid()
        ready.time(0)
        os.getppid()
        ready.time(calls)
        os.getppid()
        print(flush=True)


if __name__ == "__main__":
    play(pickle.loads(Path(sys.argv[1]).read_bytes()))
