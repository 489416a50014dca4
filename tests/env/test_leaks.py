"""Memory: what is made and dropped leaves nothing behind.

Each test repeats a life in a process of its own and asks the C library how many bytes are in use, and Python
how many blocks, before and after. Resident memory is no measure: it grows by what the allocators keep.
`DISCJUMP_LIVES=10000` repeats each life as often, and makes it a million resets.
"""

import os
import subprocess
import sys

import pytest

LIVES = int(os.environ.get("DISCJUMP_LIVES", "1000"))
NUM_ENVS = 64

CODE = """
import ctypes, gc, sys
import numpy as np, gymnasium, discjump

class Mallinfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in (
        "arena", "ordblks", "smblks", "hblks", "hblkhd",
        "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost",
    )]

library = ctypes.CDLL(None)
library.mallinfo2.restype = Mallinfo

def in_use():
    gc.collect()
    info = library.mallinfo2()
    return info.uordblks + info.hblkhd, sys.getallocatedblocks()

TERRAIN = discjump.Terrain.raindance(0)
ACTIONS = np.tile([2, 1, 1, 1, 3], ({num_envs}, 1))
MASK = np.arange({num_envs}) % 2 == 0
ENVS = gymnasium.make_vec("discjump/Ski-v0", num_envs={num_envs}, terrain_seeds=[0])
ENVS.reset(seed=0)
KEPT = []

def life():
    {life}

for _ in range(100):
    life()
bytes_before, blocks_before = in_use()
for _ in range({lives}):
    life()
bytes_after, blocks_after = in_use()
print(bytes_after - bytes_before, blocks_after - blocks_before)
"""

LIVES_OF = {
    "a simulator": "sim = discjump.Simulator(TERRAIN, 64, 'disc_jump', threads=2); "
    "sim.step(sim.inputs(), 2); sim.state(); sim.contacts(0, sim.inputs()[0]); sim.restore(sim.snapshot())",
    "a simulator on a pool": "sim = discjump.Simulator(TERRAIN, 600, threads=3); sim.step(sim.inputs(), 2)",
    "environments": "envs = gymnasium.make_vec('discjump/Ski-v0', num_envs=64, terrain_seeds=[0]); "
    "envs.reset(seed=0); envs.step(ACTIONS); envs.close()",
    "one environment": "env = gymnasium.make('discjump/Ski-v0', terrain_seeds=[0]); "
    "env.reset(seed=0); env.step(ACTIONS[0]); env.close()",
    "environments of stable-baselines3": "import discjump.sb3\n"
    "    envs = discjump.sb3.make_vec_env('discjump/Ski-v0', 64, seed=0, terrain_seeds=[0])\n"
    "    envs.reset(); envs.step(ACTIONS); envs.close()",
    "refusals": "\n    try: ENVS.step(ACTIONS[:3])\n    except ValueError: pass",
}

glibc = pytest.mark.skipif(
    sys.platform != "linux" or not hasattr(__import__("ctypes").CDLL(None), "mallinfo2"),
    reason="asks glibc 2.33 or newer",
)


def left(life: str, lives: int) -> tuple[int, int]:
    """Bytes and Python's blocks that a fresh process has more in use after so many lives."""
    code = CODE.replace("{num_envs}", str(NUM_ENVS)).replace("{lives}", str(lives)).replace("{life}", life)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stderr
    more, blocks = done.stdout.split()
    return int(more), int(blocks)


@glibc
@pytest.mark.parametrize("what", LIVES_OF)
def test_lives_leave_nothing_behind(what):
    more, blocks = left(LIVES_OF[what], LIVES)
    # The interpreter's caches may hold a little more; a leak is at least a byte, or a block, each.
    assert more < LIVES, f"{more} bytes after {LIVES} lives of {what}"
    assert blocks < LIVES / 2, f"{blocks} blocks after {LIVES} lives of {what}"


@glibc
def test_resets_leave_nothing_behind():
    rounds = 100 * LIVES // (NUM_ENVS + NUM_ENVS // 2)
    more, blocks = left("ENVS.reset(); ENVS.reset(options={'reset_mask': MASK}); ENVS.step(ACTIONS)", rounds)
    assert more < rounds
    assert blocks < rounds / 2


@glibc
@pytest.mark.parametrize("size", [1, 1000])
def test_the_measure_sees_a_leak(size):
    """Kept in every life: something small is a block of Python's, something large bytes of malloc's."""
    more, blocks = left(f"KEPT.append(bytes({size} + len(KEPT) % 7))", LIVES)
    assert blocks > LIVES / 2 if size == 1 else more > LIVES * size
