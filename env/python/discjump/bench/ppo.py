"""The environment's share of a training run, which the run itself records."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from discjump.bench.figure import Figure, row

COMMAND = ("train", "ski", "--smoke", "--quiet", "--out")


def measure() -> dict[str, Any]:
    """A row of the figures: one short run by the ski recipe, in a process of its own."""
    what, asked = "environment's share of SB3 PPO, ski recipe, one short run", 5.0
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "ski"
        line = "import sys; from discjump.cli import main; main(sys.argv[1:])"
        words = [sys.executable, "-c", line, *COMMAND, str(run)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            why = (done.stderr.strip().splitlines() or ["discjump train failed"])[-1]
            return {"what": what, "unit": "%", "asked": asked, "at_least": False, "missing": why}
        share = 100.0 * json.loads((run / "run.json").read_text())["environment_share"]
    return row(Figure(what, "%", (), lambda: np.array([share]), asked, at_least=False), {})
