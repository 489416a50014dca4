"""Bodies without a task: state in, ticks, state out. For physics tests, notebooks and planners."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from discjump import _check, _native
from discjump._native import Terrain

#: One player's keys and view in a tick: forward and strafe in -1, 0, 1; jump, jet and fire pressed or
#: not; turn in rad/s, positive to the left; pitch in radians, up positive. One dtype for all scenes:
#: what a scene does not model is ignored.
INPUT = np.dtype(
    [
        ("forward", "i1"),
        ("strafe", "i1"),
        ("jump", "?"),
        ("jet", "?"),
        ("fire", "?"),
        ("turn", "<f8"),
        ("pitch", "<f8"),
    ],
    align=True,
)


@dataclass(frozen=True)
class Scene:
    """A scene: what it models is all that its players store and compute."""

    #: The public name.
    name: str
    #: The features in it.
    models: tuple[str, ...]
    #: The features that it leaves out.
    leaves_out: tuple[str, ...]


#: Every scene by its name.
SCENES = {
    name: Scene(name, tuple(models), tuple(leaves_out)) for name, models, leaves_out in _native.scenes()
}
WEAPONS = ("disc", "grenade", "mortar")
ARMORS = ("light", "medium", "heavy")
#: Fidelity tiers for playing and training (core/docs/tiers.md says what each does, drops and costs).
FIDELITIES = ("reference", "authentic", "swept", "fast", "engine")
#: Those of a `Simulator`: also the literal reading that tunnels, to be measured and not to be played.
SIMULATOR_FIDELITIES = (*FIDELITIES, "anyway")
#: Arithmetics of a `Simulator`. `reference` is `authentic` in float64 and has no other.
PRECISIONS = ("float32", "float64")

_CHOICES = {
    "knockback": ("tribes", "basic", "linear_boosted"),
    "cutoff": ("engine", "radius"),
    "accel": ("nominal", "none", "mass"),
    "disc": ("surface", "engine"),
}


@dataclass(frozen=True)
class Physics:
    """Switches of the movement model (core/docs/physics.md, section 12)."""

    #: Whether the last contact that a tick allows (the fourth; in `engine` the third) stops the player
    #: dead. None: in `engine` it does, elsewhere not. `fast` never gets there.
    ski_bug: bool | None = None
    #: Whether jets go out at an energy of 1 and light again at 5. Without it an empty tank gives free thrust.
    hysteresis: bool = True
    #: `swept` only: whether a contact at once no longer pushes the player out of the surface.
    clamp_fixup: bool = False
    #: `swept` only: whether the move that redoes the last slice is swept as well.
    fixup_swept: bool = False
    #: How the push of an explosion falls off: "tribes", "basic" or "linear_boosted".
    knockback: str = "tribes"
    #: How far an explosion reaches: "engine" (radius and smallest box side) or "radius".
    cutoff: str = "engine"
    #: How discs accelerate to 80 m/s: "nominal" (5 m/s^2), "none" or "mass" (2.5 m/s^2).
    accel: str = "nominal"
    #: How discs fly: "surface" (swept, bursting where they meet something) or "engine" (the 1998 clock of
    #: 33 ms, unaccelerated, bursting at the place before).
    disc: str = "surface"

    def __post_init__(self) -> None:
        """Check the types and names."""
        if self.ski_bug is not None:
            _check.flag("ski_bug", self.ski_bug)
        for name in ("hysteresis", "clamp_fixup", "fixup_swept"):
            _check.flag(name, getattr(self, name))
        for name, choices in _CHOICES.items():
            _check.choice(name, getattr(self, name), choices)


class Simulator:
    """Many players on one terrain.

    Players start fresh, at rest at the terrain's centre, on the ground.

    >>> import discjump
    >>> terrain = discjump.Terrain.raindance(seed=7)
    >>> sim = discjump.Simulator(terrain, num_players=3, threads=1)
    >>> inputs = sim.inputs()
    >>> inputs["jet"] = True
    >>> sim.step(inputs, ticks=31)
    >>> bool((sim.state()["velocity"][:, 2] > 5.0).all())
    True
    """

    def __init__(
        self,
        terrain: Terrain,
        num_players: int = 1,
        scene: str = "sandbox",
        armor: str = "light",
        energy_pack: bool = False,
        fidelity: str = "authentic",
        physics: Physics | None = None,
        tick_ms: int = 32,
        threads: int | None = None,
        seed: int = 0,
        *,
        players_per_world: int = 1,
        weapon: str = "disc",
        ammo: int | None = None,
        lanes: int | None = None,
        precision: str | None = None,
    ) -> None:
        """Make a simulator.

        Args:
            terrain: where they move.
            num_players: how many in all, 1 to 2^24.
            scene: "ski", "sandbox" (explosions as well), "disc_jump" (a launcher as well) or "mission" (the
                terrain's solids as well); `SCENES` lists what each models.
            armor: "light", "medium" or "heavy".
            energy_pack: whether they wear one: 3 energy/s more.
            fidelity: "reference" (float64), "authentic", "swept", "fast" or "engine" (float32 by themselves);
                see core/docs/tiers.md. "anyway" is there to be measured only: it tunnels.
            physics: switches of the movement model.
            tick_ms: tick length, 1 to 1000 ms; the game's is 32.
            threads: 1 to 256; None for one per core. The bits do not depend on it.
            seed: for scenes that draw something; none of these does.
            players_per_world: how many share a world, 1 to 256, a divisor of num_players: players 0 to n - 1
                the first one, and so on. They block each other; discs and explosions act on all of them.
            weapon: "disc", "grenade" or "mortar", where the scene models discs.
            ammo: shots of a fresh player; None for the weapon's own number, 15.
            lanes: most players side by side: 1, 8, 16 or 32, as far as the processor has them; None: the
                environment variable `DISCJUMP_LANES` says, else the processor. The bits do not depend on it.
                Only "authentic", "swept" and "fast" in float32 have lanes, and only where every player is
                alone in his world.
            precision: "float32" or "float64"; None for the tier's own. Any tier can be had in float64, which
                tells the error of its movement from that of its digits. "reference" is "authentic" in float64
                and refuses "float32".

        Raises:
            ValueError: an argument out of range or unknown, with what was expected.
            TypeError: an argument of another type.
        """
        if not isinstance(terrain, Terrain):
            raise TypeError(f"terrain: expected a discjump.Terrain, got {type(terrain).__name__}")
        if physics is not None and not isinstance(physics, Physics):
            raise TypeError(f"physics: expected a discjump.Physics, got {type(physics).__name__}")
        self._arguments: dict[str, Any] = {
            "terrain": terrain,
            "num_players": num_players,
            "scene": scene,
            "armor": armor,
            "energy_pack": energy_pack,
            "fidelity": fidelity,
            "physics": physics,
            "tick_ms": tick_ms,
            "threads": threads,
            "seed": seed,
            "players_per_world": players_per_world,
            "weapon": weapon,
            "ammo": ammo,
            "lanes": lanes,
            "precision": precision,
        }
        self.seed = _check.integer("seed", seed, 0, _check.SEEDS - 1)
        self._native = _native.Simulator(
            terrain,
            _check.integer("num_players", num_players, 1, 1 << 24),
            _check.integer("players_per_world", players_per_world, 1, 256),
            _check.choice("scene", scene, SCENES),
            _check.choice("armor", armor, ARMORS),
            _check.flag("energy_pack", energy_pack),
            _check.choice("weapon", weapon, WEAPONS),
            None if ammo is None else _check.integer("ammo", ammo, 0, 1_000_000),
            _check.choice("fidelity", fidelity, SIMULATOR_FIDELITIES),
            None if precision is None else _check.choice("precision", precision, PRECISIONS),
            Physics() if physics is None else physics,
            _check.integer("tick_ms", tick_ms, 1, 1000),
            None if threads is None else _check.integer("threads", threads, 1, 256),
            None if lanes is None else _check.integer("lanes", lanes, 1, 32),
        )

    @property
    def num_players(self) -> int:
        """How many players."""
        return self._native.num_players

    @property
    def lanes(self) -> int:
        """How many players are stepped side by side."""
        return self._native.lanes

    @property
    def precision(self) -> str:
        """The arithmetic: "float32" or "float64"."""
        return self._native.precision

    @property
    def scene(self) -> Scene:
        """The scene: `scene.models` is in, `scene.leaves_out` is not."""
        return SCENES[self._native.scene]

    @property
    def player_bytes(self) -> int:
        """Bytes that one player takes in memory."""
        return self._native.player_bytes

    @property
    def state_dtype(self) -> np.dtype[np.void]:
        """The structured dtype of a state.

        position (3 x f8, m), velocity (3, m/s), yaw and pitch (rad), energy, damage, jetting, touched,
        crawled, friction, jump_normal (3), jump_age (i4, ms; ticks in `engine`), bump_limits (i4, ticks that
        ended at the bump limit), cooldown (i4, 56 after the tick of a disc's shot; 1 and 0 can fire), ammo
        (i4). Numbers are f8 in float64, else f4; fields of what the scene does not model are absent.
        """
        return self._native.state_dtype

    def state(self) -> NDArray[np.void]:
        """A copy of all states: structured, shape (num_players,)."""
        return self._native.state()

    def set_state(self, state: NDArray[Any], indices: ArrayLike | None = None) -> None:
        """Overwrite states.

        Args:
            state: dtype `state_dtype`, shape (num_players,), or (len(indices),).
            indices: which players; all where None.

        Raises:
            TypeError: another dtype.
            ValueError: another shape, an index or a value out of range. Then nothing was changed.
        """
        if indices is None:
            chosen = list(range(self.num_players))
        else:
            array = _check.numbers("indices", indices, "integers of shape (n,)")
            if array.ndim != 1 or (array.size and array.dtype.kind not in "iu"):
                raise ValueError(
                    f"indices: expected integers of shape (n,), got {array.dtype} of shape {array.shape}"
                )
            if array.size and (array.min() < 0 or array.max() >= self.num_players):
                raise ValueError(f"indices: expected 0 to {self.num_players - 1}, got {array.tolist()}")
            chosen = [int(i) for i in array]
        self._native.set_state(chosen, _packed("state", state, self.state_dtype, len(chosen)))

    def inputs(self) -> NDArray[np.void]:
        """Inputs with no key pressed: dtype `INPUT`, shape (num_players,)."""
        return np.zeros(self.num_players, INPUT)

    def step(self, inputs: NDArray[Any], ticks: int = 1) -> None:
        """Play ticks, with the same inputs in each.

        Ctrl-C is answered within a tenth of a second: between two ticks, or, where a single tick takes longer
        than half of that, in the middle of one; then only `restore` leads back.

        Args:
            inputs: dtype `INPUT`, shape (num_players,).
            ticks: 0 to 2^32 - 1.

        Raises:
            TypeError: another dtype.
            ValueError: another shape or a value out of range. Then nothing was changed.
            RuntimeError: another thread is stepping it, or an earlier step ended half-way.
        """
        whole = _check.integer("ticks", ticks, 0, 2**32 - 1)
        self._native.step(_packed("inputs", inputs, INPUT, self.num_players), whole)

    def explode(self, points: ArrayLike, weapon: str = "disc") -> None:
        """Set off one explosion per player, at once; nothing stays pending.

        It acts on every player of the player's world. A scene with solids counts what of a body the point
        sees; over bare terrain it sees all, unless it lies more than 5 cm below the surface.

        Args:
            points: shape (num_players, 3), m; a row with a NaN is no explosion.
            weapon: "disc", "grenade" or "mortar".

        Raises:
            ValueError: another shape, a point out of range, or a scene that models no explosions. Then
                nothing was changed.

        >>> import discjump, numpy as np
        >>> sim = discjump.Simulator(discjump.Terrain.from_heights(np.zeros((3, 3))), threads=1)
        >>> sim.explode(sim.state()["position"])  # at the feet of a light
        >>> sim.state()["velocity"][0, 2].round(1)
        np.float32(16.6)
        """
        self._native.explode(points, _check.choice("weapon", weapon, WEAPONS))

    def blasts(self) -> NDArray[np.void]:
        """The projectiles that burst in the last tick, in the order of their shooters.

        Structured, shape (n,): player (i8, who fired), position (3 x f8, m), velocity (3 x f8, m/s), normal
        (3 x f8, of what was met), age (i4, ticks since the shot). What `explode` sets off is not among them.
        """
        return self._native.blasts()

    def projectiles(self) -> NDArray[np.void]:
        """The projectiles under way, as in `blasts`, with aim (3 x f8) instead of normal."""
        return self._native.projectiles()

    def contacts(self, player: int, keys: NDArray[Any] | np.void) -> NDArray[np.void]:
        """The contacts that a player would have in the next tick, in their order; nothing changes.

        Args:
            player: whose tick.
            keys: his input, dtype `INPUT`, shape () or (1,).

        Returns:
            Structured, shape (n,): position (3 x f8, m, of his feet), velocity (3 x f8, m/s, before the
            contact acts) and normal (3 x f8, unit) of each. The players before him in his world stand where
            they stand now.

        Raises:
            TypeError, ValueError: naming the argument, what was expected and what came.

        >>> import discjump, numpy as np
        >>> sim = discjump.Simulator(discjump.Terrain.from_heights(np.zeros((3, 3))), threads=1)
        >>> sim.contacts(0, sim.inputs())["normal"][:, 2]
        array([1.])
        """
        index = _check.integer("player", player, 0, self.num_players - 1)
        row = np.atleast_1d(np.asarray(keys))
        return self._native.contacts(index, _packed("keys", row, INPUT, 1))

    def snapshot(self, player: int | None = None) -> bytes:
        """Everything, or everything of one player, as bytes that `restore` takes."""
        index = None if player is None else _check.integer("player", player, 0, self.num_players - 1)
        return self._native.snapshot(index)

    def restore(self, snapshot: bytes, player: int | None = None) -> None:
        """Go back to a snapshot of a simulator with the same arguments, whatever its threads and lanes.

        With `player` put that one to where he, or any other one, was.

        Raises:
            TypeError: `snapshot` is no bytes, `player` no integer.
            ValueError: a damaged snapshot, or one of another layout or count, or no such player. Then nothing
                was changed.
        """
        if not isinstance(snapshot, bytes):
            raise TypeError(f"snapshot: expected bytes, got {type(snapshot).__name__}")
        index = None if player is None else _check.integer("player", player, 0, self.num_players - 1)
        self._native.restore(snapshot, index)

    def __getstate__(self) -> dict[str, Any]:
        """What makes it again, in this process or another: a copy goes on with the same bits."""
        return {"arguments": self._arguments, "snapshot": self._native.snapshot()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make it again."""
        Simulator.__init__(self, **state["arguments"])
        self._native.restore(state["snapshot"])

    def digest(self) -> str:
        """32 hexadecimal digits that name the players' exact bits (XXH3-128)."""
        return self._native.digest()


def _packed(name: str, array: object, dtype: np.dtype[Any], rows: int) -> bytes:
    """The bytes of a structured array of this dtype and shape (rows,)."""
    if not isinstance(array, np.ndarray) or array.dtype != dtype:
        got = array.dtype if isinstance(array, np.ndarray) else type(array).__name__
        raise TypeError(f"{name}: expected an array of dtype {dtype}, got {got}")
    if array.shape != (rows,):
        raise ValueError(f"{name}: expected shape ({rows},), got {array.shape}")
    return array.tobytes()


#: The structured dtype of a state in the default scene and tier.
STATE = Simulator(Terrain.from_heights(np.zeros((2, 2))), threads=1).state_dtype
