"""The Markdown of a record: everything in it comes from the JSON beside it."""

from typing import Any

from discjump.accuracy.report import number
from discjump_training.tradeoff.grid import LEFT_OUT, SURFACES, TRUTH, Config
from discjump_training.tradeoff.sections import SECTIONS
from discjump_training.tradeoff.speed import speeds

Record = dict[str, Any]


def render(record: Record) -> str:
    """The whole report."""
    machine, versions = record["machine"], record["versions"]
    described = ", ".join(f"{name} {version}" for name, version in versions.items())
    lines = [
        "# Speed against accuracy",
        "",
        f"    {record['command']}",
        "",
        f"{machine['processor']}, {machine['cores']} cores, Python {machine['python']}, {described}.",
        "",
        f"The truth is `{TRUTH.tier}` in ticks of {TRUTH.tick_ms} ms on {TRUTH.surface}: the game's own tick "
        "and terrain. Another tick or surface is another game, and its distance from the truth is what that "
        "choice is worth; what a tier costs within its own game is told beside it.",
        "",
        *[f"- {reason}" for reason in LEFT_OUT],
        "",
        *summary(record),
    ]
    for name, section in SECTIONS.items():
        if name in record["sections"]:
            lines += section.tables(record["sections"][name])
    return "\n".join(lines).rstrip() + "\n"


def summary(record: Record) -> list[str]:
    """A line for each configuration: speed and the errors that one looks at first."""
    columns = _columns(record["sections"])
    configs = [Config.of(row) for row in record["configs"]]
    heads = [head for head, cells in columns.items() if cells]
    if not heads:
        return []
    return [
        "## In short",
        "",
        f"| configuration | {' | '.join(heads)} |",
        "|---" * (1 + len(heads)) + "|",
        *(
            f"| {config.name} | {' | '.join(columns[head].get(config, '') for head in heads)} |"
            for config in configs
        ),
        "",
    ]


def _columns(made: dict[str, Any]) -> dict[str, dict[Config, str]]:
    columns: dict[str, dict[Config, str]] = {}
    if "speed" in made:
        of = speeds(made["speed"])
        for what, values in (("physics", of.physics), ("agents", of.agents)):
            head = f"{what}, thousand player-seconds/s"
            columns[head] = {config: f"{spread[0] / 1e3:,.3g}" for config, spread in values.items()}
    if "errors" in made:
        head = f"skier's path after {made['errors']['seconds'][-1]:.0f} s, m: median (95th percentile)"
        columns[head] = {
            Config.of(row): f"{number(at['median'])} ({number(at['p95'])})"
            for row in made["errors"]["rows"]
            if (row["situation"], row["error"]) == ("ski", "truth")
            for at in [row["at"][-1]["position"]]
        }
    if "outcomes" in made:
        columns["skier's time to the beacon, s [95%]"] = {
            Config.of(row): f"{of['value']:+.2f} [{of['low']:+.2f}, {of['high']:+.2f}]"
            for row in made["outcomes"]["rows"]
            if row["skier"] == "skier" and row["frame_skip"] == Config.of(row).frame_skip
            for of in [row["seconds"]["difference"]]
        }
    if "apex" in made:
        columns["best disc jump, m"] = {
            Config(
                row["tier"], row["tick_ms"], surface
            ): f"{max(h for h in row['apex'] if h is not None):.1f}"
            for row in made["apex"]["rows"]
            for surface in SURFACES
        }
    return columns
