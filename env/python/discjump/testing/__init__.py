"""Conformance of any gymnasium vector environment, and its determinism: for your own CI.

    conformance  check_vector_env: runs the checks
    checks       the checks, one function each
    registry     their list
    subject      the environment under test and the rollouts that its checks share
    rollout      what was called and what came back; where two rollouts part
    trees        nested arrays, compared bit for bit
    batching     batches of spaces that numpy has no arrays for
    limits       calls that never return
    report       outcomes and the error that lists the failures
    verdicts     the table of gymnasium's own vector environments

Arrows point down only: verdicts -> conformance -> checks -> registry -> subject -> rollout, limits -> trees.
The pytest plugin on top is the package `discjump_pytest`. Nothing here knows of discjump's own environments
but `verdicts`.
"""

from discjump.testing.conformance import check_vector_env
from discjump.testing.registry import CHECKS
from discjump.testing.report import ConformanceError, Outcome, Report

__all__ = ["CHECKS", "ConformanceError", "Outcome", "Report", "check_vector_env"]
