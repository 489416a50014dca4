"""Ctrl-C and defects in the middle of a call.

Contract: Ctrl-C is answered within a tenth of a second, and what is left is whole or refuses; a panic becomes
a Python exception, and what it left behind refuses further use until a snapshot is restored.
"""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import discjump
from discjump.envs.named import SkiEnv, SkiVectorEnv
from discjump.sb3 import make_vec_env

from .play import SHORT, random_actions, same_bits


@pytest.fixture(autouse=True)
def ctrl_c_is_heard():
    """A process that a shell starts in the background ignores SIGINT, and Python then installs no handler."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupted(call, after: float = 0.3) -> float:
    """Seconds from Ctrl-C to its KeyboardInterrupt in the middle of `call`."""
    sent = []

    def send() -> None:
        time.sleep(after)
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    sender = threading.Thread(target=send)
    sender.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
        return time.perf_counter() - sent[0]
    finally:
        sender.join()


@pytest.mark.parametrize("fidelity", ["authentic", "reference", "engine"])
@pytest.mark.parametrize("players", [1, 10_000])
def test_ctrl_c_ends_many_ticks_between_two(fidelity, players):
    """It bounds no time, but would have no end without an answer."""
    terrain = discjump.Terrain.raindance(0)
    sim = discjump.Simulator(terrain, players, fidelity=fidelity, threads=2)
    inputs = sim.inputs()
    inputs["forward"] = 1
    interrupted(lambda: sim.step(inputs, 2**32 - 1))
    # Everybody has played the same ticks, whole ones, and plays on.
    assert len({row.tobytes() for row in sim.state()}) == 1
    sim.step(inputs)
    assert len({row.tobytes() for row in sim.state()}) == 1


def test_a_decision_that_is_stopped_half_way_leaves_a_batch_that_refuses():
    count = 300_000
    envs = SkiVectorEnv(count, threads=1, fidelity="reference", frame_skip=64, terrain_seeds=[0])
    envs.reset(seed=0)
    before = envs.snapshot()
    actions = np.tile([2, 1, 1, 1, 3], (count, 1))
    interrupted(lambda: envs.step(actions))
    for call in (lambda: envs.step(actions), envs.reset, envs.state, envs.snapshot, envs.goals):
        with pytest.raises(RuntimeError, match="ended half-way: restore a snapshot"):
            call()
    envs.restore(before)
    assert envs.snapshot() == before


def test_a_reset_that_is_stopped_leaves_a_batch_that_can_be_reset():
    envs = SkiVectorEnv(2_000_000, threads=1, terrain_seeds=[0])
    interrupted(lambda: [envs.reset(seed=0) for _ in range(100)], after=0.1)
    # Nobody may step what was not observed.
    if envs._task.batch.fresh:
        with pytest.raises(Exception, match="reset"):
            envs.step(np.tile([2, 1, 1, 1, 3], (2_000_000, 1)))


def test_ctrl_c_is_answered_by_what_its_handler_raises():
    class Mine(Exception):
        pass

    def handler(*_: object) -> None:
        raise Mine

    sim = discjump.Simulator(discjump.Terrain.raindance(0), 100, threads=1)
    previous = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Mine):
            sim.step(sim.inputs(), 2**32 - 1)
    finally:
        signal.signal(signal.SIGALRM, previous)
    sim.step(sim.inputs())


@pytest.mark.parametrize("players", [3, 2_000])
def test_a_panic_becomes_an_exception_and_the_simulator_refuses(players, capfd):
    sim = discjump.Simulator(discjump.Terrain.raindance(0), players, threads=3)
    sim.step(sim.inputs(), 5)
    before, digest = sim.snapshot(), sim.digest()
    sim._native.fail_next_step()
    with pytest.raises(RuntimeError, match=r"a defect of discjump ended this call half-way: .*made to fail"):
        sim.step(sim.inputs())
    state = np.zeros(players, sim.state_dtype)
    for call in (
        lambda: sim.step(sim.inputs()),
        lambda: sim.set_state(state),
        lambda: sim.contacts(0, sim.inputs()[0]),
        lambda: sim.explode(np.zeros((players, 3))),
        lambda: sim.snapshot(0),
        sim.state,
        sim.snapshot,
        sim.digest,
    ):
        with pytest.raises(RuntimeError, match="ended half-way: restore a snapshot"):
            call()
    sim.restore(before)
    assert sim.digest() == digest
    sim.step(sim.inputs())
    assert "made to fail" in capfd.readouterr().err


@pytest.mark.parametrize("envs", [3, 2_000])
def test_a_panic_among_environments_becomes_an_exception(envs, capfd):
    batch = SkiVectorEnv(envs, threads=3, **SHORT)
    batch.reset(seed=0)
    action = random_actions(0, 1, envs)[0]
    before = batch.snapshot()
    batch._task.batch.fail_next_step()
    with pytest.raises(RuntimeError, match="a defect of discjump"):
        batch.step(action)
    for call in (lambda: batch.step(action), batch.reset, batch.state, batch.snapshot):
        with pytest.raises(RuntimeError, match="ended half-way"):
            call()
    batch.restore(before)
    twin = SkiVectorEnv(envs, threads=1, **SHORT)
    twin.reset(seed=0)
    same_bits(batch.step(action), twin.step(action))
    # The pool works on, for others as well.
    assert "made to fail" in capfd.readouterr().err


def test_a_panic_reaches_every_front_end(capfd):
    single = SkiEnv(**SHORT)
    single.reset(seed=0)
    single._task.batch.fail_next_step()
    with pytest.raises(RuntimeError, match="a defect of discjump"):
        single.step(np.array([2, 1, 1, 1, 3]))
    with pytest.raises(RuntimeError, match="ended half-way"):
        single.step(np.array([2, 1, 1, 1, 3]))
    envs = make_vec_env("discjump/Ski-v0", n_envs=2, **SHORT)
    envs.reset()
    envs._task.batch.fail_next_step()
    with pytest.raises(RuntimeError, match="a defect of discjump"):
        envs.step(random_actions(0, 1, 2)[0])
    with pytest.raises(RuntimeError, match="ended half-way"):
        envs.reset()
    capfd.readouterr()


def test_python_itself_is_interrupted_as_ever():
    """A script in a loop of short steps."""
    code = (
        "import discjump, numpy as np, os, signal, threading\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "envs = __import__('discjump.sb3').sb3.make_vec_env('discjump/Ski-v0', 64, terrain_seeds=[0])\n"
        "envs.reset()\n"
        "threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        "while True: envs.step(np.tile([2, 1, 1, 1, 3], (64, 1)))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode != 0
    assert "KeyboardInterrupt" in done.stderr
