"""Single figures against their closed forms: each is one run, told by the tick and without ticks."""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from discjump.theory import forms
from discjump.theory.lab import TICK_MS, Floats, State, Tier, level, play

JUMP_TICKS_MS = (8, 16, 32, 64)
"""Lengths of a tick at which the jump's apex is told."""
FALL_SECONDS = 3.2
BURN_SECONDS = 2.048
START_SPEED = 5.0
"""Along the key when the fading burn begins, m/s: beyond a fifth of the fade-out speed."""
DUTY_TICKS = 250
MODELS = ("article", "engine")


@dataclass(frozen=True)
class Figure:
    """What one run must give."""

    name: str
    unit: str
    #: Without ticks.
    smooth: float
    #: By ticks, in either model.
    article: float
    engine: float
    measure: Callable[[Tier], float]

    def row(self, tiers: tuple[Tier, ...]) -> dict[str, Any]:
        """The figure and what every tier gives."""
        return {
            "name": self.name,
            "unit": self.unit,
            "smooth": self.smooth,
            "article": self.article,
            "engine": self.engine,
            "measured": {tier.name: self.measure(tier) for tier in tiers},
        }


def figures(dt: float = TICK_MS / 1000.0) -> list[Figure]:
    """All figures, at the game's tick where none is named."""
    made = [_fall(dt)]
    made += [_jump(armor, TICK_MS) for armor in forms.ARMORS]
    made += [_jump("light", tick_ms) for tick_ms in JUMP_TICKS_MS if tick_ms != TICK_MS]
    for armor in forms.ARMORS:
        for pack in (False, True):
            made += _burn(armor, pack, dt)
    made += _fading(dt)
    for armor, speed in (("light", 40.0), ("medium", 35.0), ("heavy", 35.0)):
        made += _stop(armor, speed, dt)
    return [*made, _duty(), _refill(dt)]


def _resting(**fields: Any) -> dict[str, Floats]:
    """One player's fields, at rest on level ground where nothing else is said."""
    return {name: np.array([value], np.float64) for name, value in ({"position": [0.0] * 3} | fields).items()}


def _fall(dt: float) -> Figure:
    ticks = round(FALL_SECONDS / dt)
    fields = _resting(position=[0.0, 0.0, 200.0], velocity=[0.0, 0.0, 30.0])

    def measure(tier: Tier) -> float:
        return float(_last(play(tier, level(), fields, {}, ticks))["position"][0, 2]) - 200.0

    article, engine = (forms.way(model, 30.0, -forms.GRAVITY, dt, ticks) for model in MODELS)
    return Figure(
        f"height after {ticks * dt:g} s of flight, from 30 m/s up", "m", engine, article, engine, measure
    )


def _jump(armor: str, tick_ms: int) -> Figure:
    speed, dt = forms.ARMORS[armor].jump, tick_ms / 1000.0
    ticks = int(speed / (forms.GRAVITY * dt)) + 2

    def measure(tier: Tier) -> float:
        states = play(
            tier, level(), _resting(jump_age=0), {"jump": True}, ticks, tick_ms=tick_ms, armor=armor
        )
        return _highest(states)

    article, engine = (forms.apex(model, speed, dt) for model in MODELS)
    smooth = speed**2 / (2.0 * forms.GRAVITY)
    return Figure(f"apex of a jump, {armor}, ticks of {tick_ms} ms", "m", smooth, article, engine, measure)


def _burn(armor: str, pack: bool, dt: float) -> list[Figure]:
    kind = forms.ARMORS[armor]
    smooth, ticks = forms.smooth_burn(kind, pack), forms.burn_ticks(kind, pack, dt)
    article, engine = (forms.burn(model, kind, pack, dt) for model in MODELS)
    name = f"full burn, {armor}{', pack' if pack else ''}"
    # The key is held up to the apex: a tank that has cut out does not come back to 5 before it.
    fall = int(article.speed / (forms.GRAVITY * dt)) + 2

    def states(tier: Tier) -> list[State]:
        fields = _resting(energy=kind.energy)
        keys = {"jet": True}
        return list(play(tier, level(), fields, keys, ticks + 2, armor=armor, energy_pack=pack))

    def burned(tier: Tier) -> float:
        return float(sum(state["jetting"][0] for state in states(tier)[1:]))

    def speed(tier: Tier) -> float:
        return float(states(tier)[ticks]["velocity"][0, 2])

    def apex(tier: Tier) -> float:
        end = states(tier)[ticks]
        fields = {name: end[name] for name in ("position", "velocity")} | {"energy": np.zeros(1)}
        return _highest(play(tier, level(), fields, {}, fall, armor=armor, energy_pack=pack))

    return [
        Figure(f"{name}: ticks", "", smooth.seconds / dt, ticks, ticks, burned),
        Figure(f"{name}: speed at its end", "m/s", smooth.speed, article.speed, engine.speed, speed),
        Figure(f"{name}: apex", "m", smooth.apex, article.apex, engine.apex, apex),
    ]


def _fading(dt: float) -> list[Figure]:
    light, ticks = forms.ARMORS["light"], round(BURN_SECONDS / dt)
    smooth = forms.fading(light, START_SPEED, 0.0, ticks * dt)
    article, engine = (forms.fading_ticks(model, light, START_SPEED, dt, ticks) for model in MODELS)
    fields = _resting(position=[0.0, 0.0, 200.0], velocity=[0.0, START_SPEED, 0.0])

    def measure(tier: Tier, name: str) -> float:
        return float(_last(play(tier, level(), fields, {"jet": True, "forward": 1}, ticks))[name][0, 1])

    name = f"jets ahead for {ticks * dt:g} s, from {START_SPEED:g} m/s"
    return [
        Figure(f"{name}: {what}", unit, wanted, article[k], engine[k], partial(measure, name=field))
        for k, (what, unit, wanted, field) in enumerate(
            [("speed", "m/s", smooth.speed, "velocity"), ("way", "m", smooth.way, "position")]
        )
    ]


def _stop(armor: str, speed: float, dt: float) -> list[Figure]:
    kind = forms.ARMORS[armor]
    ticks, way = forms.stop(kind, speed, dt)
    fields = _resting(velocity=[0.0, speed, 0.0])

    def states(tier: Tier) -> list[State]:
        return list(play(tier, level(), fields, {}, ticks + 5, armor=armor))

    def lasted(tier: Tier) -> float:
        return float(sum(state["velocity"][0, 1] > 0.0 for state in states(tier)))

    def gone(tier: Tier) -> float:
        return float(states(tier)[-1]["position"][0, 1])

    name = f"stop from {speed:g} m/s, {armor}"
    return [
        Figure(f"{name}: ticks", "", speed / kind.ground / dt, ticks, ticks, lasted),
        Figure(f"{name}: way", "m", speed**2 / (2.0 * kind.ground), way, way, gone),
    ]


def _duty() -> Figure:
    fields = _resting(position=[0.0, 0.0, 5000.0], energy=0.0)

    def measure(tier: Tier) -> float:
        states = list(play(tier, level(), fields, {"jet": True}, 100 + DUTY_TICKS))
        return float(np.mean([state["jetting"][0] for state in states[-DUTY_TICKS:]]))

    # What is burned is what comes in; 8 ticks of 25 are exactly that.
    share = forms.RECHARGE / forms.ARMORS["light"].drain
    return Figure("share of ticks that an empty tank burns", "", share, share, share, measure)


def _refill(dt: float) -> Figure:
    light = forms.ARMORS["light"]
    smooth = light.energy / forms.RECHARGE / dt
    ticks = int(np.ceil(smooth))

    def measure(tier: Tier) -> float:
        states = play(tier, level(), _resting(energy=0.0), {}, ticks + 10)
        return float(sum(state["energy"][0] < light.energy for state in states))

    return Figure("ticks from empty to full, light", "", smooth, ticks, ticks, measure)


def _last(states: Iterator[State]) -> State:
    last: State = deque(states, maxlen=1)[0]
    return last


def _highest(states: Iterator[State]) -> float:
    return float(max(state["position"][0, 2] for state in states))
