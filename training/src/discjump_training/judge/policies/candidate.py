"""A policy that is not on stage yet."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from discjump_training.episodes import Stage
from discjump_training.policy import Policy

Kind = Literal["baseline", "model", "onnx", "function", "replays"]


@dataclass(frozen=True)
class Candidate:
    """What is known of a policy before it plays.

    Attributes:
        name: in tables.
        kind: what it is.
        make: the policy for a stage; raises a TrainingError where the spaces do not fit.
        needs: options of the environment that it was made for.
        identity: changes when the policy does: what was played before it is not taken for its own.
        run: folder of the training run, where it is from one.
    """

    name: str
    kind: Kind
    make: Callable[[Stage], Policy]
    needs: Mapping[str, Any] = field(default_factory=dict)
    identity: str = ""
    run: Path | None = None


def digest_of(*paths: Path) -> str:
    """Of the content of files."""
    digest = hashlib.blake2b(digest_size=16)
    for path in paths:
        digest.update(hashlib.blake2b(path.read_bytes()).digest())
    return digest.hexdigest()
