"""The list of unsafe code is whole: core/docs/unsafe.md against the sources."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_every_unsafe_block_is_listed() -> None:
    found = {}
    for path in [*ROOT.glob("core/src/**/*.rs"), *ROOT.glob("env/src/**/*.rs")]:
        lines = [line.split("//")[0] for line in path.read_text().splitlines()]
        # Attributes and lints are no blocks.
        count = sum(len(re.findall(r"\bunsafe\b(?!_)", line)) for line in lines)
        if count:
            found[path.relative_to(ROOT).as_posix()] = count
    page = (ROOT / "core/docs/unsafe.md").read_text()
    listed = {
        name: int(count) for name, count in re.findall(r"^\| `([^`]+)` \| (\d+) \|", page, re.MULTILINE)
    }
    assert listed == found
