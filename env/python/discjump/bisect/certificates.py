"""Two certificates of `discjump verify`: which id and tier differ, and the episodes they were made of."""

from __future__ import annotations

import importlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from discjump.bisect.sides import Side, SideError, split
from discjump.replays import EpisodeReplay, Recorder

SCHEMA = "discjump-certificate/1"


@dataclass(frozen=True)
class Certificates:
    """Two of them.

    Attributes:
        texts: what the user typed.
        found: what is in the files.
        pythons: interpreters of the builds that they are of; None: this installation.
    """

    texts: tuple[str, str]
    found: tuple[dict[str, Any], dict[str, Any]]
    pythons: tuple[str | None, str | None]

    @classmethod
    def of(cls, a: str, b: str) -> Certificates | None:
        """Two certificates from what was typed as sides; None where A is none.

        Raises:
            SideError: only one of them is, or one is changed otherwise than by `python`.
        """
        parts = [split(a), split(b)]
        found = [_read(path) for path, _ in parts]
        if found[0] is None:
            return None
        if found[1] is None:
            raise SideError(f"{b}: expected a certificate like A ({SCHEMA}), got something else")
        for (path, _), certificate in zip(parts, found, strict=True):
            _check_shape(path, certificate)
        pythons = [change.pop("python", None) for _, change in parts]
        for text, (_, change) in zip((a, b), parts, strict=True):
            if change:
                raise SideError(
                    f"{text}: expected no change of a certificate but python, got {', '.join(change)}"
                )
        return cls((a, b), (found[0], found[1]), (pythons[0], pythons[1]))

    def differing(self) -> list[tuple[str, str]]:
        """Subjects and tiers that both have, and whose digests differ, in A's order."""
        one, other = (certificate["digests"] for certificate in self.found)
        return [
            (subject, tier)
            for subject, tiers in one.items()
            for tier, digest in tiers.items()
            if tier in other.get(subject, {}) and digest["digest"] != other[subject][tier]["digest"]
        ]

    def text(self) -> str:
        """What they say of each other."""
        lines = []
        for name, text, found in zip("AB", self.texts, self.found, strict=True):
            lines.append(f"{name}  {text}: discjump {found['versions'].get('discjump')}, {_processor(found)}")
            failed = [row for row in found["rows"] if row["result"] == "fail"]
            lines += [f"   fails by itself: {row['subject']}, {row['tier']}, {row['row']}" for row in failed]
        shared = sum(
            len(set(tiers) & {*self.found[1]["digests"].get(subject, {})})
            for subject, tiers in self.found[0]["digests"].items()
        )
        differing = self.differing()
        lines.append(f"{shared - len(differing)} of {shared} digests that both have are equal")
        lines += [f"   differ: {subject}, {tier}" for subject, tier in differing]
        if differing and self.pythons == (None, None):
            lines.append("to find the tick, say which interpreter has the other build:")
            lines.append("   CERTIFICATE,python=OTHER/bin/python")
        return "\n".join(lines)

    def sides(self) -> Iterator[tuple[Side, Side]]:
        """The digested episodes of the first id and tier that differ, each on both builds.

        Raises:
            SideError: what differs is no environment's, or this installation cannot play it.
        """
        ids = [pair for pair in self.differing() if pair[0].startswith("discjump/")]
        if not ids:
            raise SideError(f"{self.texts[0]}: expected an environment among what differs, got scenes alone")
        name, tier = ids[0]
        count = int(self.found[0]["digests"][name][tier]["environments"])
        for replay in episodes(name, tier, count):
            label = f"{name}, {tier}, seed {replay.seed}"
            yield Side(label, replay, python=self.pythons[0]), Side(label, replay, python=self.pythons[1])


def episodes(name: str, tier: str, count: int) -> Iterator[EpisodeReplay]:
    """The first episodes of the environments that a certificate's digest is of, played here.

    Raises:
        SideError: this installation has no `discjump.verify`, or not the id.
    """
    try:
        environments = importlib.import_module("discjump.verify.environments")
        reference = importlib.import_module("discjump.verify.reference")
        played = reference.record(environments.Environment(name, tier), np.arange(count))
    except (ImportError, gymnasium.error.Error) as error:
        raise SideError(
            f"{name}, {tier}: this installation cannot play what the certificates did: {error}"
        ) from error
    env = Recorder(gymnasium.make(name, fidelity=tier))
    for row, seed in enumerate(played.seeds):
        begun = np.flatnonzero(played.begun[row])
        env.reset(seed=int(seed))
        for action in played.actions[row, 1 : begun[1]]:
            env.step(action)
        yield env.replays.pop()


def _read(path: str) -> dict[str, Any] | None:
    """The certificate in a file; None where it is none."""
    try:
        found = json.loads(Path(path).read_bytes())
    except (OSError, ValueError):
        return None
    whole = isinstance(found, dict) and found.get("schema") == SCHEMA
    return found if whole and {"digests", "rows", "versions", "machine"} <= found.keys() else None


def _check_shape(path: str, certificate: Any) -> None:
    """Refuse a certificate that lacks what is read here.

    Raises:
        SideError: names the file.
    """
    try:
        for tiers in certificate["digests"].values():
            for digest in tiers.values():
                digest["digest"], digest["environments"]
        for row in certificate["rows"]:
            row["result"], row["subject"], row["tier"], row["row"]
        certificate["versions"].get, certificate["machine"].get
    except (AttributeError, LookupError, TypeError):
        raise SideError(f"{path}: expected a certificate of `discjump verify`, got a malformed one") from None


def _processor(certificate: dict[str, Any]) -> str:
    return str(certificate["machine"].get("processor", "an unknown machine"))
