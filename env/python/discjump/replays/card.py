"""What a replay is, in a few lines."""

from dataclasses import asdict
from typing import Any

import numpy as np

from discjump.envs.tasks import BY_ID, SKI
from discjump.replays.episode import EpisodeReplay, plain_options
from discjump.replays.replay import Header, Replay
from discjump.replays.ticks import TickReplay
from discjump.simulator import Physics

Card = dict[str, str]


def card(replay: Replay, size: int) -> Card:
    """Names and values; `size` is that of the file, bytes."""
    made = replay.made
    told = _episode(replay) if isinstance(replay, EpisodeReplay) else _ticks(replay)
    told["digests"] = f"{len(replay.arrays['digests.state'])}, every {replay.header['every']}"
    told["recorded by"] = f"discjump {made['discjump']} (package and crate), " + ", ".join(
        f"{name} {made[name]}"
        for name in ("machine", "threads", "lanes", "batch", "index")
        if made.get(name) is not None
    )
    return {**told, "size": f"{size:,} bytes"}


def _episode(replay: EpisodeReplay) -> Card:
    options = replay.options
    task = BY_ID.get(str(replay.header["id"]).removeprefix("discjump:"), SKI)
    defaults = plain_options(task.options())
    other = {name: value for name, value in options.items() if value != defaults.get(name)}
    seeds = other.pop("terrain_seeds", None)
    told = {
        "environment": str(replay.header["id"]),
        "task": task.name,
        "fidelity": str(options["fidelity"]),
        "options": _listed(other, asdict(Physics())) or "the defaults",
        "terrain": _terrain(replay, seeds),
        "episode": f"number {replay.episode} of seed {replay.seed}",
    }
    if replay.header["reset"]:
        told["placed"] = _listed(replay.header["reset"], {})
    ticks = replay.options["tick_ms"] * replay.options["frame_skip"]
    told["decisions"] = f"{len(replay.actions)} of {ticks} ms"
    told["outcome"] = _outcome(replay.outcome)
    return told


def _ticks(replay: Replay) -> Card:
    assert isinstance(replay, TickReplay)
    options = replay.options
    ground = replay.header["terrain"]
    where = f"generated, seed {ground['seed']}" if "seed" in ground else "its heights are in the file"
    shape = replay.arrays["inputs"].shape
    other = {name: value for name, value in options.items() if name not in ("scene", "fidelity", "tick_ms")}
    return {
        "simulator": f"{shape[1]} players",
        "scene": str(options["scene"]),
        "fidelity": str(options["fidelity"]),
        "options": _listed(other, asdict(Physics())),
        "terrain": f"{where} ({ground['surface']}, {ground['digest']})",
        "ticks": f"{shape[0]} of {options['tick_ms']} ms",
    }


def _terrain(replay: EpisodeReplay, seeds: Any) -> str:
    digest = replay.header["terrain"]
    if replay.header["terrains"] is not None:
        ground = replay.header["terrains"][0]
        if "seed" in ground:
            return f"generated, seed {ground['seed']} ({digest})"
        shape = "x".join(str(n) for n in np.shape(replay.arrays[ground["heights"]]))
        return f"{shape} heights, {ground['square_size']:g} m apart, in the file ({digest})"
    pool = replay.options["terrain_seeds"] if seeds is None else seeds
    shown = ", ".join(map(str, pool)) if len(pool) <= 8 else f"{pool[0]} ... {pool[-1]}"
    return f"one of the {len(pool)} generated ones of the seeds {shown} ({digest})"


def _outcome(outcome: Header | None) -> str:
    if outcome is None:
        return "recording stopped before the end"
    how = next((name for name in ("is_success", "death", "timeout") if outcome.get(name)), "over")
    word = {"is_success": "arrived", "death": "died", "timeout": "timed out"}.get(how, how)
    return f"{word} after {outcome.get('time', 0):.3f} s, return {outcome.get('return', 0):.4f}"


def _listed(options: Header, physics: Header) -> str:
    words = []
    for name, value in options.items():
        if name == "physics":
            words += [f"physics.{key}={one}" for key, one in value.items() if one != physics.get(key)]
        else:
            words.append(f"{name}={value}")
    return ", ".join(words)
