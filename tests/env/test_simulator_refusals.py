"""What a `Simulator`, its methods and its switches refuse: by the argument's name, with nothing changed."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from discjump import INPUT, Physics, Simulator

from .worlds import FLAT, everything, pair

POINTS: list[tuple[Any, type[Exception], str]] = [
    (None, TypeError, "points"),
    ("here", TypeError, "points"),
    (np.zeros((2, 3), bool), TypeError, "points"),
    (np.zeros((2, 3), complex), TypeError, "points"),
    (np.zeros(3), ValueError, "points.*shape"),
    (np.zeros((2, 2)), ValueError, "points.*shape"),
    (np.zeros((1, 2, 3)), ValueError, "points.*shape"),
    (np.zeros((3, 3)), ValueError, "points.*2 rows, got 3"),
    ([[0.0, 0.0, 0.0], [0.0]], ValueError, "points.*ragged"),
    ([[0.0, 0.0, 0.0], [0.0, np.inf, 0.0]], ValueError, r"points\[1\].*inf"),
    ([[0.0, 0.0, 0.0], [0.0, 0.0, 1e6]], ValueError, r"points\[1\].*1000000"),
    ([[2e9, 0.0, 0.0], [0.0, 0.0, 0.0]], ValueError, r"points\[0\].*2000000000"),
]


def played() -> Simulator:
    sim = pair()
    inputs = sim.inputs()
    inputs["forward"], inputs["fire"], inputs["pitch"] = 1, True, 0.3
    sim.step(inputs, 20)
    return sim


def refused(
    sim: Simulator, kind: type[Exception], message: str, call: Callable[..., object], *arguments: Any
) -> None:
    """The call raises, and changes nothing."""
    before = everything(sim)
    with pytest.raises(kind, match=message):
        call(*arguments)
    assert everything(sim) == before


@pytest.mark.parametrize(("points", "kind", "message"), POINTS)
def test_bad_points(points: Any, kind: type[Exception], message: str) -> None:
    """Caught: rows of different lengths were refused by numpy, which does not know whose they are."""
    sim = played()
    refused(sim, kind, message, sim.explode, points)
    refused(sim, ValueError, "weapon.*'disc'.*'rocket'", sim.explode, np.zeros((2, 3)), "rocket")
    refused(sim, TypeError, "weapon", sim.explode, np.zeros((2, 3)), 3)


def inputs_with(name: str, value: Any) -> np.ndarray[Any, Any]:
    inputs = np.zeros(2, INPUT)
    inputs[name][1] = value
    return inputs


def test_bad_inputs() -> None:
    sim = played()
    values = [("forward", 2), ("strafe", -128), ("turn", np.nan), ("turn", 1001.0), ("pitch", np.inf)]
    for name, value in values:
        refused(sim, ValueError, rf"inputs\[1\]\.{name}", sim.step, inputs_with(name, value))
    bits = np.zeros(2, INPUT)
    bits.view(np.uint8)[2] = 7
    refused(sim, ValueError, r"inputs\[0\]\.jump", sim.step, bits)
    packed = np.dtype([(name, INPUT[name]) for name in INPUT.names or ()])
    others: list[Any] = [None, [], np.zeros(2), np.zeros(2, packed), np.zeros(2, INPUT.newbyteorder())]
    for wrong in others:
        refused(sim, TypeError, "inputs", sim.step, wrong)
    for shape in (1, (2, 1), ()):
        refused(sim, ValueError, "inputs", sim.step, np.zeros(shape, INPUT))
    whole = [(-1, ValueError), (2**32, ValueError), (2**70, ValueError), (1.0, TypeError), (True, TypeError)]
    for ticks, kind in whole:
        refused(sim, kind, "ticks", sim.step, sim.inputs(), ticks)
    sim.step(sim.inputs(), 0)
    # Views with gaps are taken as they read.
    apart = np.zeros(4, INPUT)[::2]
    sim.step(apart)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("position", np.nan),
        ("position", 1e10),
        ("velocity", 1.1e6),
        ("velocity", -np.inf),
        ("yaw", 2e6),
        ("pitch", np.nan),
        ("energy", -1.0),
        ("energy", 61.0),
        ("damage", -1e-3),
        ("friction", 1.5),
        ("jump_normal", 0.0),
        ("jump_age", -1),
        ("bump_limits", -1),
        ("cooldown", -1),
        ("cooldown", 1_000_001),
        ("ammo", -1),
        ("ammo", 1_000_001),
    ],
)
def test_bad_states(name: str, value: float) -> None:
    sim = played()
    state = sim.state()
    state["position"][0] += 1.0
    state[name][1] = value
    refused(sim, ValueError, rf"state\[1\]\.{name}", sim.set_state, state)


def test_bad_indices() -> None:
    """Caught: rows of different lengths were refused by numpy, which does not know whose they are."""
    sim = played()
    one = sim.state()[:1]
    for indices in ([2], [-1], [2**62], [0.5], [True], [[0]], "0", [[0], [0, 1]]):
        refused(sim, ValueError, "indices", sim.set_state, one, indices)
    refused(sim, ValueError, r"state: expected shape \(2,\)", sim.set_state, one)
    refused(sim, ValueError, r"state: expected shape \(2,\)", sim.set_state, one, [0, 1])
    refused(sim, TypeError, "state", sim.set_state, np.zeros(2))
    sim.set_state(sim.state()[:0], [])


@pytest.mark.parametrize("snapshot", [None, "text", 3, bytearray(b"bytes")])
def test_a_snapshot_that_is_no_bytes(snapshot: Any) -> None:
    """Caught: the argument was named in a note only."""
    sim = played()
    refused(sim, TypeError, "snapshot: expected bytes, got", sim.restore, snapshot)


def test_snapshots_of_other_worlds() -> None:
    sim = played()
    good = sim.snapshot()
    others = [pair(players_per_world=1), pair(players=4), pair(ammo=3), pair(weapon="mortar"), pair("swept")]
    for other in others:
        refused(sim, ValueError, "snapshot", sim.restore, other.snapshot())
    for bad in (b"", good[:-1], good + b"x", good[:-1] + bytes([good[-1] ^ 1])):
        refused(sim, ValueError, "snapshot", sim.restore, bad)
    sim.restore(good)


OPTIONS: list[tuple[dict[str, Any], type[Exception], str]] = [
    ({"num_players": 0}, ValueError, "num_players"),
    ({"num_players": 2**24 + 1}, ValueError, "num_players"),
    ({"num_players": 2**70}, ValueError, "num_players"),
    ({"num_players": 1.0}, TypeError, "num_players"),
    ({"num_players": True}, TypeError, "num_players"),
    ({"players_per_world": 0}, ValueError, "players_per_world"),
    ({"players_per_world": 3}, ValueError, r"players_per_world.*divisor of num_players \(4\)"),
    ({"players_per_world": 8}, ValueError, "players_per_world"),
    ({"players_per_world": 257, "num_players": 257}, ValueError, "players_per_world"),
    ({"players_per_world": 2**70}, ValueError, "players_per_world"),
    ({"players_per_world": None}, TypeError, "players_per_world"),
    ({"ammo": -1}, ValueError, "ammo"),
    ({"ammo": 1_000_001}, ValueError, "ammo"),
    ({"ammo": 1.5}, TypeError, "ammo"),
    ({"weapon": "disk"}, ValueError, "weapon.*did you mean 'disc'"),
    ({"weapon": None}, TypeError, "weapon"),
    ({"scene": "discjump"}, ValueError, "scene.*did you mean 'disc_jump'"),
    ({"fidelity": "anyhow"}, ValueError, "fidelity"),
    ({"tick_ms": 0}, ValueError, "tick_ms"),
    ({"tick_ms": 1001}, ValueError, "tick_ms"),
    ({"tick_ms": 2**40}, ValueError, "tick_ms"),
    ({"tick_ms": 32.0}, TypeError, "tick_ms"),
    ({"threads": 0}, ValueError, "threads"),
    ({"threads": 2**70}, ValueError, "threads"),
    ({"seed": -1}, ValueError, "seed"),
    ({"seed": "1"}, TypeError, "seed"),
    ({"physics": 0}, TypeError, "physics"),
    ({"physics": {}}, TypeError, "physics"),
    ({"physics": {"ski_bug": True}}, TypeError, "physics"),
    ({"physics": "tribes"}, TypeError, "physics"),
    ({"physics": Physics}, TypeError, "physics"),
    ({"terrain": None}, TypeError, "terrain"),
    ({"terrain": np.zeros((9, 9))}, TypeError, "terrain"),
]


@pytest.mark.parametrize(("options", "kind", "message"), OPTIONS, ids=[str(case[0])[:40] for case in OPTIONS])
def test_bad_options(options: dict[str, Any], kind: type[Exception], message: str) -> None:
    """Caught: numbers beyond 64 bits were an OverflowError and wrong switches an AttributeError, neither of
    which named the argument; switches that are false, as `{}`, were taken for none; any seed was taken."""
    arguments: dict[str, Any] = {"terrain": FLAT, "num_players": 4}
    with pytest.raises(kind, match=message):
        Simulator(**(arguments | options))


SWITCHES = [
    ({"ski_bug": 1}, TypeError),
    ({"ski_bug": "no"}, TypeError),
    ({"hysteresis": None}, TypeError),
    ({"clamp_fixup": 0}, TypeError),
    ({"fixup_swept": "yes"}, TypeError),
    ({"knockback": "quadratic"}, ValueError),
    ({"knockback": None}, TypeError),
    ({"cutoff": "Engine"}, ValueError),
    ({"accel": 5}, TypeError),
    ({"accel": "broken"}, ValueError),
    ({"disc": ""}, ValueError),
    ({"ski_bugs": True}, TypeError),
]


@pytest.mark.parametrize(("switch", "kind"), SWITCHES, ids=[str(case[0]) for case in SWITCHES])
def test_bad_switches(switch: dict[str, Any], kind: type[Exception]) -> None:
    name = re.escape(next(iter(switch)))
    with pytest.raises(kind, match=name):
        Physics(**switch)
