"""Forked and spawned processes, threads, the interpreter's end.

Contract: a child steps with the bits of its parent; nothing hangs; what is in the middle of a step is refused
to everybody else, in other threads and in children.
"""

import multiprocessing
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import discjump
from discjump.envs.named import SkiVectorEnv

from .play import SHORT, random_actions

# Above the batch that is stepped on the caller's thread alone, so that the pool is used.
MANY = 600


def many_steps(threads: int) -> bytes:
    """Bits of a rollout on a pool."""
    envs = SkiVectorEnv(MANY, threads=threads, **SHORT)
    envs.reset(seed=0)
    return b"".join(envs.step(action)[0].tobytes() for action in random_actions(0, 10, MANY))


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
@pytest.mark.parametrize("users", ["pool", "gymnasium", "sb3"])
def test_environments_in_other_processes_have_the_same_bits(users, method):
    script = Path(__file__).with_name("in_processes.py")
    done = subprocess.run(
        [sys.executable, script, users, method], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr


def test_a_forked_child_goes_on_with_its_parents_batch():
    """The batch was made, and its pool used, before the fork; parent and child go on with the same bits."""
    envs = SkiVectorEnv(MANY, threads=3, **SHORT)
    envs.reset(seed=0)
    actions = random_actions(1, 20, MANY)
    envs.step(actions[0])
    receive, send = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            for action in actions[1:]:
                envs.step(action)
            os.write(send, envs._task.batch.digest().encode())
        finally:
            os._exit(0)
    os.close(send)
    for action in actions[1:]:
        envs.step(action)
    with os.fdopen(receive, "rb") as pipe:
        assert pipe.read().decode() == envs._task.batch.digest()
    os.waitpid(child, 0)


def test_two_threads_step_two_batches_exactly():
    """At once, on pools that they share."""
    expected = many_steps(3)
    got: list[bytes] = []
    workers = [threading.Thread(target=lambda: got.append(many_steps(3))) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(timeout=120)
    assert got == [expected] * 4


#: Of a step that takes a second or more, so that what is tried in the middle of it is.
TICKS = 20_000


def long_step(sim):
    """A thread that is in the middle of a long step."""
    thread = threading.Thread(target=sim.step, args=(sim.inputs(), TICKS))
    thread.start()
    deadline = time.monotonic() + 60
    while thread.is_alive() and time.monotonic() < deadline:
        try:
            sim.digest()
        except RuntimeError:
            return thread
    raise AssertionError("the step was over before anybody looked")


def test_what_another_thread_steps_is_refused():
    sim = discjump.Simulator(discjump.Terrain.raindance(0), 4_000, threads=1)
    inputs, snapshot, state = sim.inputs(), sim.snapshot(), sim.state()
    calls: list[Callable[[], object]] = [
        lambda: sim.step(inputs),
        lambda: sim.restore(snapshot),
        lambda: sim.set_state(state),
        lambda: sim.explode(state["position"]),
        sim.state,
        sim.snapshot,
        sim.digest,
    ]
    thread = long_step(sim)
    for call in calls:
        with pytest.raises(RuntimeError, match="one call at a time"):
            call()
    thread.join()
    expected = discjump.Simulator(discjump.Terrain.raindance(0), 4_000, threads=1)
    expected.step(inputs, TICKS)
    assert sim.digest() == expected.digest()


def test_what_was_stepped_during_a_fork_is_refused_in_the_child():
    sim = discjump.Simulator(discjump.Terrain.raindance(0), 4_000, threads=2)
    thread = long_step(sim)
    receive, send = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            words = ""
            try:
                sim.num_players  # noqa: B018
                sim.step(np.zeros(4_000, discjump.INPUT))
            except RuntimeError as refusal:
                words = str(refusal)
            os.write(send, words.encode())
            # Others work: on a pool of the child's own.
            fresh = discjump.Simulator(discjump.Terrain.raindance(0), 4_000, threads=2)
            fresh.step(fresh.inputs(), 3)
            os.write(send, b"|" + fresh.digest().encode())
        finally:
            os._exit(0)
    os.close(send)
    thread.join()
    with os.fdopen(receive, "rb") as pipe:
        words, _, digest = pipe.read().decode().partition("|")
    os.waitpid(child, 0)
    assert "when this process was forked" in words
    fresh = discjump.Simulator(discjump.Terrain.raindance(0), 4_000, threads=2)
    fresh.step(fresh.inputs(), 3)
    assert digest == fresh.digest()


@pytest.mark.parametrize("daemon", [True, False])
def test_the_interpreter_ends_cleanly_during_steps(daemon):
    code = (
        "import threading, time, discjump\n"
        "sims = [discjump.Simulator(discjump.Terrain.raindance(0), 5_000, threads=2) for _ in range(3)]\n"
        "end = time.monotonic() + 0.5\n"
        "def work(sim):\n"
        f"    while {daemon} or time.monotonic() < end:\n"
        "        sim.step(sim.inputs(), 100)\n"
        "for sim in sims:\n"
        f"    threading.Thread(target=work, args=(sim,), daemon={daemon}).start()\n"
        "time.sleep(0.3)\n"
        "print('left')\n"
    )
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
        assert (done.returncode, done.stdout, done.stderr) == (0, "left\n", "")
