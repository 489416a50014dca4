"""A certificate: what was played, on what, and the digests that another machine or release can be held to."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

SCHEMA = "discjump-certificate/1"


class BadCertificate(ValueError):
    """A file that is no certificate of a schema that we know."""


@dataclass(frozen=True)
class Digests:
    """The reference of a subject in one tier."""

    digest: str
    """SHA-256 of all bits that the first environments showed."""
    actions: str
    """SHA-256 of what they were told to do."""
    environments: int
    rows: int
    """Of each environment."""
    ends: Mapping[str, int]
    """How many episodes ended, by flag."""
    lanes: list[int]
    """The widths that were played."""


@dataclass(frozen=True)
class RowResult:
    """How a row of the matrix went."""

    subject: str
    tier: str
    row: str
    result: str
    """`pass`, `fail` or `skipped`."""
    compared: int
    """Rows of environments whose bits were compared."""
    seconds: float
    reason: str = ""
    """Why it failed or was skipped; the first difference, in words."""
    difference: Mapping[str, Any] | None = None


@dataclass(frozen=True)
class Certificate:
    """Everything that `discjump verify` found out."""

    form: str
    command: str
    versions: Mapping[str, str]
    machine: Mapping[str, Any]
    """Processor, its features, the build of the native library."""
    digests: Mapping[str, Mapping[str, Digests]]
    """Subject to tier to digests."""
    rows: list[RowResult]
    seconds: float
    schema: str = field(default=SCHEMA)

    @property
    def failed(self) -> list[RowResult]:
        """Rows that failed."""
        return [row for row in self.rows if row.result == "fail"]

    @property
    def counts(self) -> dict[str, int]:
        """Rows by result, and the rows of environments compared in all."""
        results = [row.result for row in self.rows]
        counts = {result: results.count(result) for result in ("pass", "fail", "skipped")}
        return {**counts, "compared": sum(row.compared for row in self.rows)}

    def save(self, path: Path) -> None:
        """Write it as JSON."""
        path.parent.mkdir(parents=True, exist_ok=True)
        record = {"schema": self.schema, "counts": self.counts, **asdict(self)}
        rows = [json.dumps(row) for row in record.pop("rows")]
        text = json.dumps(record, indent=1)[:-2]
        # One line a row: a certificate is read by people as well.
        lines = ",\n  ".join(rows)
        path.write_text(f'{text},\n "rows": [\n  {lines}\n ]\n}}\n')

    @classmethod
    def load(cls, path: Path) -> "Certificate":
        """Read one.

        Raises:
            BadCertificate: no JSON, another schema, or something is missing; says what.
        """
        try:
            record = json.loads(path.read_text())
        except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
            raise BadCertificate(f"{path}: expected a certificate in JSON, got {error}") from error
        schema = record.get("schema") if isinstance(record, dict) else None
        if schema != SCHEMA:
            raise BadCertificate(f"{path}: expected the schema {SCHEMA}, got {schema}")
        try:
            digests = {
                subject: {tier: Digests(**one) for tier, one in tiers.items()}
                for subject, tiers in record["digests"].items()
            }
            rows = [RowResult(**row) for row in record["rows"]]
            names = ("form", "command", "versions", "machine", "seconds")
            return cls(digests=digests, rows=rows, **{name: record[name] for name in names})
        except (KeyError, TypeError, AttributeError) as error:
            raise BadCertificate(f"{path}: expected a whole certificate, got one without {error}") from error


@dataclass(frozen=True)
class Comparison:
    """One subject in one tier, in two certificates."""

    subject: str
    tier: str
    verdict: str
    """`equal`, `different`, `missing` (not in the other) or `gone` (in the other only)."""
    note: str = ""


def compare(ours: Certificate, theirs: Certificate) -> list[Comparison]:
    """Digest by digest; subjects and tiers in the order of the names."""
    keys = {
        (subject, tier) for one in (ours, theirs) for subject in one.digests for tier in one.digests[subject]
    }
    found = []
    for subject, tier in sorted(keys):
        mine = ours.digests.get(subject, {}).get(tier)
        other = theirs.digests.get(subject, {}).get(tier)
        if mine is None:
            found.append(Comparison(subject, tier, "gone", "it was not played here"))
        elif other is None:
            found.append(Comparison(subject, tier, "missing", "the other certificate does not have it"))
        elif mine.digest == other.digest:
            found.append(Comparison(subject, tier, "equal"))
        elif mine.actions != other.actions and subject.startswith("scene "):
            found.append(Comparison(subject, tier, "different", "its players were told to do other things"))
        else:
            found.append(Comparison(subject, tier, "different", meaning(subject)))
    return found


def meaning(subject: str) -> str:
    """What it means that the bits of a subject changed."""
    if subject.startswith("scene "):
        return "bodies move otherwise than they did: CHANGELOG.md must say so, and no id may rest on it"
    name, _, version = subject.rpartition("-v")
    following = f"{name}-v{int(version) + 1}" if version.isdecimal() else "a new id"
    return (
        f"the bits of {subject} changed, so published scores no longer compare: a change that is meant needs "
        f"a new id, {following}, beside which the old one keeps its bits; else it is a defect"
    )
