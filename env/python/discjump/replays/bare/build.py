"""Terrains, environments and simulators from plain data, by discjump's public names alone."""

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np

import discjump

from .codec import Arrays, Header


class CannotBuild(ValueError):
    """This installation cannot make what was recorded; the message says what it lacks."""


def terrain(plain: Mapping[str, Any], arrays: Arrays) -> discjump.Terrain:
    """The terrain that `plain` describes: by its seed, or by its heights.

    Raises:
        CannotBuild: this installation makes other bits of it.
    """
    name = plain.get("heights")
    if name is None:
        made = discjump.Terrain.raindance(plain["seed"], repeating=plain["repeating"])
        made = made.with_surface(plain["surface"])
    else:
        x, y = plain["origin"]
        made = discjump.Terrain.from_heights(
            arrays[name], plain["square_size"], (x, y), plain["edge"], plain["surface"]
        )
    if made.digest() != plain["digest"]:
        raise CannotBuild(
            f"terrain: expected the bits {plain['digest']}, got {made.digest()}: this installation makes "
            "another terrain of the same seed or heights"
        )
    if plain.get("solids") is not None:
        made = made.with_solids([_solid(one, arrays) for one in plain["solids"]])
    return made


def _solid(plain: Mapping[str, Any], arrays: Arrays) -> discjump.Solid:
    return discjump.Solid(
        plain["kind"],
        plain["name"],
        arrays[plain["points"]],
        arrays[plain["faces"]],
        tuple(plain["position"]),
        tuple(plain["rotation"]),
        plain["scale"],
    )


def options(header: Header, arrays: Arrays) -> dict[str, Any]:
    """Keyword arguments of the recorded environment."""
    given = dict(header["options"])
    given["physics"] = _made("physics", discjump.Physics, given["physics"])
    if header["terrains"] is not None:
        given.pop("terrain_seeds", None)
        given["terrains"] = [terrain(one, arrays) for one in header["terrains"]]
        given["surface"] = None
    return given


def environment(
    header: Header, arrays: Arrays, num_envs: int | None = None, **more: Any
) -> tuple[Any, dict[str, Any]]:
    """The recorded environment by `gymnasium.make` (`make_vec` with `num_envs`), and its keyword arguments.

    Raises:
        CannotBuild: this installation does not have its id, or one of its options.
    """
    name = header["id"]
    keywords = {**options(header, arrays), **more}
    try:
        if num_envs is None:
            return gymnasium.make(name, **keywords), keywords
        return gymnasium.make_vec(name, num_envs=num_envs, **keywords), keywords
    except gymnasium.error.UnregisteredEnv:
        known = ", ".join(sorted(key for key in gymnasium.registry if key.startswith("discjump/")))
        raise CannotBuild(
            f"id: this recording needs {name}, and discjump {discjump.__version__} has {known}: install a "
            f"version that has it (it was recorded with {header['made']['discjump']})"
        ) from None
    except (TypeError, ValueError) as error:
        raise _unfit(header, error) from error


def simulator(header: Header, arrays: Arrays, copies: int = 1, **more: Any) -> discjump.Simulator:
    """The recorded simulator with its players `copies` times over, where they began.

    Raises:
        CannotBuild: this installation does not have its scene, or one of its arguments.
    """
    keywords = {**header["options"], **more}
    keywords["physics"] = _made("physics", discjump.Physics, keywords["physics"])
    try:
        sim = discjump.Simulator(terrain(header["terrain"], arrays), header["players"] * copies, **keywords)
        if "snapshot" not in arrays:
            sim.set_state(states(sim, np.tile(arrays["state"], copies)))
        elif copies == 1:
            sim.restore(arrays["snapshot"].tobytes())
        else:
            raise ValueError("projectiles are under way where it begins, so that it can only be played alone")
        return sim
    except (TypeError, ValueError) as error:
        raise _unfit(header, error) from error


def _unfit(header: Header, error: Exception) -> Exception:
    if isinstance(error, CannotBuild):
        return error
    return CannotBuild(
        f"options: discjump {discjump.__version__} does not take those of this recording, made with "
        f"{header['made']['discjump']}: {error}"
    )


def states(sim: discjump.Simulator, given: Any) -> Any:
    """States in the simulator's own dtype: numbers rounded where it has fewer digits."""
    made = sim.state()
    for name in made.dtype.names or ():
        if name in given.dtype.names:
            made[name] = given[name]
    return made


def inputs(rows: Any) -> Any:
    """Inputs as the simulator takes them: its dtype has padding, which recordings leave out."""
    made = np.zeros(rows.shape, discjump.INPUT)
    for name in rows.dtype.names:
        made[name] = rows[name]
    return made


def _made(name: str, kind: type, plain: Mapping[str, Any]) -> Any:
    try:
        return kind(**plain)
    except (TypeError, ValueError) as error:
        raise CannotBuild(
            f"{name}: discjump {discjump.__version__} does not take {plain}: {error}"
        ) from error
