"""`discjump verify`: whether the bits of a rollout depend on anything but seeds and actions.

    command       the click command
    report        what it prints
    verification  the whole matrix: every subject, then every process
    certificate   what was found, as JSON, and two of them compared
    machine       processor and build, for the certificate
    children      rows in other processes
    matrix        the rows of one subject
    form          how much is played: full and quick
    run           a batch followed along the reference, until the first bit that differs
    reference     every environment alone: what all else must give
    scenes        scenes of `Simulator` as subjects
    environments  gymnasium ids as subjects
    ways          other ways in: `gymnasium.make`, gymnasium's own vector environment, stable-baselines3
    draws         actions by plain integer arithmetic
    interface     what can be verified
    parts         what a batch shows, as columns

Arrows point down only.
"""

from discjump.verify.certificate import Certificate, Comparison, compare
from discjump.verify.verification import verified, verify

__all__ = ["Certificate", "Comparison", "compare", "verified", "verify"]
