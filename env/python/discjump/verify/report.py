"""What `discjump verify` prints: a certificate's summary, what failed, and how it compares."""

from collections.abc import Sequence

from discjump.verify.certificate import Certificate, Comparison

SHOWN = 20
"""Failed rows that are printed; the certificate has all."""


def summary(certificate: Certificate) -> str:
    """Digests and counts."""
    lines = [f"{'':<34}{'tier':<11}{'rows':>5}{'fail':>6}  digest"]
    for subject, tiers in certificate.digests.items():
        for tier, digests in tiers.items():
            rows = [row for row in certificate.rows if (row.subject, row.tier) == (subject, tier)]
            failed = sum(row.result == "fail" for row in rows)
            lines.append(f"{subject:<34}{tier:<11}{len(rows):>5}{failed:>6}  {digests.digest[:16]}")
    counts = certificate.counts
    lines.append(
        f"{counts['pass']} rows passed, {counts['fail']} failed, {counts['skipped']} skipped; "
        f"{counts['compared']:,} rows of environments compared bit for bit in {certificate.seconds:.0f} s"
    )
    for reason in dict.fromkeys(
        f"{row.row}: {row.reason}" for row in certificate.rows if row.result == "skipped"
    ):
        lines.append(f"skipped: {reason}")
    return "\n".join(lines)


def failures(certificate: Certificate) -> str:
    """Each failed row with its first difference."""
    failed = certificate.failed
    lines = [f"FAIL {row.subject}, {row.tier}, row {row.row}\n     {row.reason}" for row in failed[:SHOWN]]
    if len(failed) > SHOWN:
        lines.append(f"... and {len(failed) - SHOWN} more rows, all of them in the certificate")
    return "\n".join(lines)


def comparison(ours: Certificate, theirs: Certificate, found: Sequence[Comparison], name: str) -> str:
    """Subject by subject; versions and machines of both."""
    lines = [f"against {name}", f"  here:  {made(ours)}", f"  there: {made(theirs)}"]
    for one in found:
        note = f": {one.note}" if one.note else ""
        lines.append(f"  {one.verdict:<10}{one.subject}, {one.tier}{note}")
    return "\n".join(lines)


def made(certificate: Certificate) -> str:
    """What a certificate was made with."""
    packages = ", ".join(f"{package} {version}" for package, version in certificate.versions.items())
    machine = certificate.machine
    native = machine.get("native", {})
    return (
        f"{packages}; Python {machine.get('python')}; crate {native.get('crate')} for "
        f"{native.get('architecture')}; {machine.get('processor')}, lanes {machine.get('lanes')}"
    )
