"""Section: how many player-ticks and agent steps a second each configuration makes.

Every round times every configuration once, one after the other, so that a busy machine slows all alike; a
round is one piece of work. Players of all tick lengths play the same 8 s of game with the same keys.
"""

import os
from typing import Any

import numpy as np

from discjump import envs
from discjump._results import machine
from discjump.bench import clock, ways
from discjump.bench.clock import Case, Effort, Prepared, Unavailable, spread
from discjump.bench.ways import Players, Vector
from discjump_training.tradeoff.grid import DECISION_MS, Config, Plan
from discjump_training.tradeoff.section import Done, Made, Panel, Speeds
from discjump_training.tradeoff.store import Store, build, code

NAME = "speed"


class Speed:
    """The section."""

    name = NAME

    def work(self, plan: Plan) -> int:
        """Timings."""
        return plan.repeats * len(cases(plan))

    def run(self, plan: Plan, store: Store, done: Done) -> Made:
        """Time what is not in the store, round by round."""
        named = cases(plan)
        effort = Effort(plan.repeats, plan.repeat_seconds, plan.quick)
        identity = {
            "cases": [repr(case) for case in named.values()],
            "effort": [plan.repeat_seconds, plan.quick],
            "machine": machine(),
            "build": build(),
            "code": code(clock, ways, envs),
        }
        prepared: dict[Case, Prepared | Unavailable] = {}

        def once() -> list[float]:
            if not prepared:
                prepared.update(clock.prepare(named.values(), effort))
            seconds = clock.repeat(prepared, done)
            return [seconds[case] / case.units for case in named.values()]

        rounds = []
        for number in range(plan.repeats):
            before = len(prepared)
            rounds.append(store.piece(self.name, {**identity, "round": number}, once))
            if len(prepared) == before == 0:
                done(len(named))
        per_unit = np.array(rounds).reshape(plan.repeats, len(named))
        rows = [_row(key, case, 1.0 / per_unit[:, k]) for k, (key, case) in enumerate(named.items())]
        return {"threads": _threads(), "players": plan.players, "num_envs": plan.num_envs, "rows": rows}

    def tables(self, made: Made) -> list[str]:
        """Physics by configuration, then agent steps by frame skip."""
        return [
            "## Speed",
            "",
            f"Median (quartiles). Physics: a `Simulator` of {made['players']:,} players, scene `ski`, keys "
            f"held for {DECISION_MS} ms. Agent steps: `make_vec` with {made['num_envs']:,} environments on "
            f"{made['threads'][-1]} threads, random actions. A player-second is a second of one player's "
            "game: it compares tick lengths where ticks do not.",
            "",
            *_physics(made),
            "",
            *_agents(made),
            "",
        ]

    def panels(self, made: Made, speeds: Speeds) -> list[Panel]:
        """None: it is the axis of the others."""
        return []


def cases(plan: Plan) -> dict[tuple[Any, ...], Players | Vector]:
    """What is timed, by (what, config, frame_skip, threads)."""
    named: dict[tuple[Any, ...], Players | Vector] = {}
    for config in plan.configs():
        for threads in _threads():
            named["physics", config, None, threads] = Players(
                plan.players,
                threads,
                fidelity=config.tier,
                tick_ms=config.tick_ms,
                surface=config.surface,
                ticks=DECISION_MS // config.tick_ms,
            )
        for frame_skip in plan.decisions(config.tick_ms):
            named["agents", config, frame_skip, _threads()[-1]] = Vector(
                plan.num_envs,
                frame_skip,
                _threads()[-1],
                fidelity=config.tier,
                tick_ms=config.tick_ms,
                surface=config.surface,
            )
    return named


def speeds(made: Made) -> Speeds:
    """What the picture needs."""
    physics: dict[Config, tuple[float, float, float]] = {}
    agents: dict[Config, tuple[float, float, float]] = {}
    for row in made["rows"]:
        config = Config.of(row)
        values = row["player_seconds_per_second"]
        spreads = (values["median"], values["low"], values["high"])
        if row["what"] == "physics" and row["threads"] == made["threads"][-1]:
            physics[config] = spreads
        elif row["what"] == "agents" and row["frame_skip"] == config.frame_skip:
            agents[config] = spreads
    return Speeds(physics, agents)


def _threads() -> list[int]:
    """One, and all cores."""
    return sorted({1, min(os.cpu_count() or 1, 256)})


def _row(key: tuple[Any, ...], case: Players | Vector, rates: Any) -> dict[str, Any]:
    what, config, frame_skip, threads = key
    game_seconds = config.tick_ms / 1000 * (frame_skip or 1)
    return {
        "what": what,
        **config.keys,
        "frame_skip": frame_skip,
        "decision_ms": None if frame_skip is None else config.tick_ms * frame_skip,
        "threads": threads,
        "unit": "player-ticks/s" if what == "physics" else "agent steps/s",
        "rate": spread(rates)._asdict(),
        "player_seconds_per_second": spread(rates * game_seconds)._asdict(),
        "rates": rates.tolist(),
    }


def _physics(made: Made) -> list[str]:
    threads = made["threads"]
    lines = [
        "| configuration | "
        + " | ".join(f"M player-ticks/s, {_plural(n)}" for n in threads)
        + " | "
        + " | ".join(f"thousand player-seconds/s, {_plural(n)}" for n in threads)
        + " |",
        "|---" * (1 + 2 * len(threads)) + "|",
    ]
    cells: dict[Config, list[str]] = {}
    for unit, scale in (("rate", 1e6), ("player_seconds_per_second", 1e3)):
        for row in made["rows"]:
            if row["what"] == "physics":
                cells.setdefault(Config.of(row), []).append(_cell(row[unit], scale))
    return [*lines, *(f"| {config.name} | {' | '.join(of)} |" for config, of in cells.items())]


def _agents(made: Made) -> list[str]:
    lines = [
        "| configuration | frame_skip | decision, ms | M agent steps/s | thousand player-seconds/s |",
        "|---|---|---|---|---|",
    ]
    for row in made["rows"]:
        if row["what"] == "agents":
            lines.append(
                f"| {Config.of(row).name} | {row['frame_skip']} | {row['decision_ms']} "
                f"| {_cell(row['rate'], 1e6)} | {_cell(row['player_seconds_per_second'], 1e3)} |"
            )
    return lines


def _cell(values: dict[str, float], scale: float) -> str:
    median, low, high = (digits(values[name] / scale) for name in ("median", "low", "high"))
    return f"{median} ({low} .. {high})"


def digits(value: float) -> str:
    """Three significant digits, whole numbers from 100 on.

    >>> [digits(value) for value in (0.98765, 12.34, 98765.4)]
    ['0.988', '12.3', '98,765']
    """
    return f"{value:,.0f}" if value >= 99.95 else f"{value:.3g}"


def _plural(threads: int) -> str:
    return f"{threads} thread" + ("s" if threads > 1 else "")
