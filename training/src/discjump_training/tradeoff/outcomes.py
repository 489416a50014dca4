"""Section: what a scripted skier notices: when he arrives, how fast he gets, how much he is hurt."""

from functools import partial
from typing import Any

from discjump import envs
from discjump_training import baselines, courses, episodes, intervals
from discjump_training.courses import HELD_OUT
from discjump_training.intervals import Estimate
from discjump_training.tradeoff import skiers
from discjump_training.tradeoff.grid import DECISION_MS, TRUTH, Config, Plan
from discjump_training.tradeoff.section import Done, Made, Panel, Speeds, points
from discjump_training.tradeoff.skiers import FIGURES, compared, play
from discjump_training.tradeoff.store import Store, build, code

SKIERS = baselines.scripts("ski")
FLOOR = 0.01
"""Of the picture's error axis, s."""


class Outcomes:
    """The section."""

    name = "outcomes"

    def work(self, plan: Plan) -> int:
        """Configurations and decisions, times skiers."""
        return len(SKIERS) * len(cases(plan))

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Play what is not in the store, and compare."""
        base = {
            "course": HELD_OUT.name,
            "episodes": plan.episodes,
            "build": build(),
            "code": code(envs, baselines, episodes, courses, skiers),
        }
        rows = []
        for skier in SKIERS:

            def played(skier: str, config: Config, frame_skip: int) -> Any:
                identity = {**base, "skier": skier, **config.keys, "frame_skip": frame_skip}
                make = partial(play, skier, config, frame_skip, plan.episodes)
                return store.piece(self.name, identity, make)

            truth = played(skier, TRUTH, TRUTH.frame_skip)
            for config, frame_skip in cases(plan):
                own = played(skier, config, frame_skip)
                identity = {
                    **base,
                    "skier": skier,
                    **config.keys,
                    "frame_skip": frame_skip,
                    "against": TRUTH.keys,
                }
                identity["code"] = code(envs, baselines, episodes, courses, skiers, intervals)
                row = store.piece(self.name, identity, partial(compared, own, truth))
                decision_ms = config.tick_ms * frame_skip
                head = {"skier": skier, **config.keys, "frame_skip": frame_skip, "decision_ms": decision_ms}
                rows.append({**head, **row})
                done(1)
        return {
            "course": HELD_OUT.name,
            "episodes": plan.episodes,
            "truth": {**TRUTH.keys, "frame_skip": TRUTH.frame_skip},
            "interval": f"{intervals.CONFIDENCE:.0%}, BCa bootstrap over episodes",
            "rows": rows,
        }

    def tables(self, made: Made) -> list[str]:
        """A table for each skier: decisions as the task's, then others."""
        lines = [
            "## Outcome error",
            "",
            f"The first {made['episodes']} episodes of {made['course']}, played by the scripted baselines "
            "`skier` and `tacker`. Differences are those of the same episode from the truth, with "
            f"{made['interval']}; \u201ctypical\u201d is the median episode's, without its sign. Failures "
            "count as 60 s.",
            "",
        ]
        for skier in dict.fromkeys(row["skier"] for row in made["rows"]):
            of = [row for row in made["rows"] if row["skier"] == skier]
            task = [row for row in of if row["decision_ms"] == DECISION_MS]
            skips = [row for row in of if (row["tick_ms"], row["surface"]) == (TRUTH.tick_ms, TRUTH.surface)]
            lines += [
                f"### {skier}, a decision each {DECISION_MS} ms",
                "",
                *_table(task, "configuration"),
                "",
            ]
            lines += [f"### {skier}, by frame_skip", "", *_table(skips, "frame_skip"), ""]
        return lines

    def panels(self, made: Made, speeds: Speeds) -> list[Panel]:
        """Time to the beacon of the first skier."""
        rows = [
            row for row in made["rows"] if row["skier"] == SKIERS[0] and row["decision_ms"] == DECISION_MS
        ]
        if not rows:
            return []
        return [
            Panel(
                f"Scripted {SKIERS[0]}: time to the beacon",
                f"agents, a decision each {DECISION_MS} ms",
                "mean difference from the truth, at most (95%)",
                "s",
                points(
                    {Config.of(row): at_most(row["seconds"]["difference"]) for row in rows}, speeds.agents
                ),
                FLOOR,
            )
        ]


def cases(plan: Plan) -> list[tuple[Config, int]]:
    """Configurations at the task's time between decisions; at the truth's tick and surface at others too."""
    found: list[tuple[Config, int]] = []
    for config in plan.configs():
        plain = (config.tick_ms, config.surface) == (TRUTH.tick_ms, TRUTH.surface)
        skips = plan.decisions(config.tick_ms) if plain else [config.frame_skip]
        found += [(config, skip) for skip in skips]
    return found


def at_most(difference: dict[str, float]) -> float:
    """How far a difference may be from 0: the end of its interval that is further away.

    >>> at_most({"value": -0.1, "low": -0.3, "high": 0.1})
    0.3
    """
    return max(abs(difference["low"]), abs(difference["high"]))


def _table(rows: list[dict[str, Any]], by: str) -> list[str]:
    heads = [f"{what}: mean | difference | typical" for what in FIGURES.values()]
    lines = [f"| {by} | {' | '.join(heads)} | success, % |", "|---" * (2 + 3 * len(heads)) + "|"]
    for row in rows:
        name = Config.of(row).name
        name += f", {row['frame_skip']} ({row['decision_ms']} ms)" if by == "frame_skip" else ""
        cells = []
        for key in FIGURES:
            digits = 3 if key == "damage" else 2
            figure = row[key]
            of = Estimate(**figure["difference"])
            cells += [
                f"{figure['mean']:.{digits}f}",
                f"{of.value:+.{digits}f} [{of.low:+.{digits}f}, {of.high:+.{digits}f}]",
                f"{figure['typical']:.{digits}f}",
            ]
        lines.append(f"| {name} | {' | '.join(cells)} | {100 * row['success']['value']:.1f} |")
    return lines
