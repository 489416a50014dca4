"""The Markdown of a record: everything in it comes from the JSON beside it."""

from typing import Any

from discjump.accuracy.report import number
from discjump.terrains import SURFACES
from discjump_training.tradeoff.grid import DEFAULT, LEFT_OUT, TRUTH, Config
from discjump_training.tradeoff.pareto import unbeaten
from discjump_training.tradeoff.sections import SECTIONS, panels
from discjump_training.tradeoff.speed import digits, speeds

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
    """Speed and the errors that one looks at first: of what nothing beats in some panel, then of all."""
    configs = [Config.of(row) for row in record["configs"]]
    best = {DEFAULT, TRUTH} | {
        point.config
        for panel in panels(record["sections"])
        for point, kept in zip(panel.points, unbeaten(panel), strict=True)
        if kept
    }
    return [
        "## In short",
        "",
        f"The default (`{DEFAULT.name}`), the truth, and what no other beats in both speed and error in some "
        "panel of the picture. Below, everything.",
        "",
        *_lines(record["sections"], [config for config in configs if config in best]),
        "",
        "## All configurations",
        "",
        *_lines(record["sections"], configs),
        "",
    ]


def _lines(made: dict[str, Any], configs: list[Config]) -> list[str]:
    columns = {head: cells for head, cells in _columns(made).items() if cells}
    return [
        f"| configuration | {' | '.join(columns)} |",
        "|---" * (1 + len(columns)) + "|",
        *(
            f"| {config.name} | {' | '.join(cells.get(config, '') for cells in columns.values())} |"
            for config in configs
        ),
    ]


def _columns(made: dict[str, Any]) -> dict[str, dict[Config, str]]:
    columns: dict[str, dict[Config, str]] = {}
    if "speed" in made:
        of = speeds(made["speed"])
        for what, values in (("physics", of.physics), ("agents", of.agents)):
            head = f"{what}, thousand player-seconds/s"
            columns[head] = {config: digits(spread[0] / 1e3) for config, spread in values.items()}
    if "instructions" in made:
        columns["instructions a tick, one player at a time"] = {
            Config.of(row): digits(row["per_player_tick"])
            for row in made["instructions"]["rows"]
            if row["lanes"] == 1
        }
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
