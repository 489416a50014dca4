"""Closed forms of the model (core/docs/physics.md, sections 2, 4, 6, 10), in plain Python.

Nothing here comes from the simulator. `article` integrates by semi-implicit Euler, v += a dt and then
p += v dt; `engine` moves by the mean of the old and the new velocity.
"""

import math
from dataclasses import dataclass

GRAVITY = 20.0
"""m/s^2."""
BOOST = 26.0 / 11.0
"""Of the formula `linear_boosted`."""
DISC_RADIUS, DISC_KICK = 7.5, 150.0
"""m; mass units times m/s."""
RECHARGE, PACK = 8.0, 3.0
"""Energy per second."""
CUT_OFF, REIGNITE = 1.0, 5.0
"""Energy at which jets go out, and light again."""
GROUND_LIGHT = 40.0
"""Ground acceleration of a light, m/s^2."""


@dataclass(frozen=True)
class Armor:
    """A column of section 2's table; SI units, forces per mass."""

    mass: float
    ground: float
    jump: float
    jet: float
    fade: float
    energy: float
    drain: float
    height: float
    min_box: float


ARMORS = {
    "light": Armor(9.0, 40.0, 75 / 9, 236 / 9, 22.0, 60.0, 25.0, 2.3, 1.0),
    "medium": Armor(13.0, 35.0, 110 / 13, 320 / 13, 17.0, 80.0, 31.25, 2.4, 1.4),
    "heavy": Armor(18.0, 35.0, 150 / 18, 385 / 18, 12.0, 110.0, 34.375, 2.6, 1.6),
}


def way(model: str, speed: float, acceleration: float, dt: float, ticks: int) -> float:
    """How far a constant acceleration moves in so many ticks, m.

    >>> way("engine", 0.0, 20.0, 0.1, 10), round(way("article", 0.0, 20.0, 0.1, 10), 12)
    (10.0, 11.0)
    """
    seconds = ticks * dt
    extra = 0.5 * acceleration * seconds * dt if model == "article" else 0.0
    return speed * seconds + 0.5 * acceleration * seconds * seconds + extra


def apex(model: str, speed: float, dt: float) -> float:
    """The highest of the places after each tick of a throw straight up, m.

    `speed` is the one before gravity's first tick.

    At most v^2/2g - v dt/2 + g dt^2/8 in `article` and v^2/2g in `engine`, and at most g dt^2/8 less.

    >>> [round(apex(model, 25 / 3, 0.032), 3) for model in ("article", "engine")]
    [1.603, 1.736]
    """
    middle = speed / (GRAVITY * dt) - (0.5 if model == "article" else 0.0)
    around = (max(0, math.floor(middle)), max(0, math.ceil(middle)))
    return max(way(model, speed, -GRAVITY, dt, n) for n in around)


def burn_ticks(armor: Armor, pack: bool, dt: float) -> int:
    """Ticks that a full tank burns: lit as long as more than `CUT_OFF` was left by the tick before."""
    lost = (armor.drain - RECHARGE - PACK * pack) * dt
    return math.ceil((armor.energy - CUT_OFF) / lost)


@dataclass(frozen=True)
class Burn:
    """A full tank, straight up from rest: when it is empty, and the highest place after that."""

    seconds: float
    speed: float
    height: float
    apex: float


def burn(model: str, armor: Armor, pack: bool, dt: float) -> Burn:
    """By ticks."""
    ticks, up = burn_ticks(armor, pack, dt), armor.jet - GRAVITY
    speed, height = up * ticks * dt, way(model, 0.0, up, dt, ticks)
    return Burn(ticks * dt, speed, height, height + apex(model, speed, dt))


def smooth_burn(armor: Armor, pack: bool) -> Burn:
    """Without ticks."""
    seconds = (armor.energy - CUT_OFF) / (armor.drain - RECHARGE - PACK * pack)
    up = armor.jet - GRAVITY
    speed, height = up * seconds, 0.5 * up * seconds**2
    return Burn(seconds, speed, height, height + speed**2 / (2.0 * GRAVITY))


@dataclass(frozen=True)
class Flight:
    """Along the keys and up: speeds and ways since the start."""

    speed: float
    way: float
    climb_speed: float
    climb: float


def fading(armor: Armor, speed: float, climb_speed: float, seconds: float) -> Flight:
    """Jets and a direction key held in the air, without ticks, up to the fade-out speed.

    With s = 1 - v/v_f the speed along the key follows v' = T (1 - v/v_f): it nears v_f exponentially. Below
    v_f/5 the share is 0.8 and the speed grows evenly.
    """
    most = 0.8
    kink = armor.fade * (1.0 - most)
    even = min(max(0.0, (kink - speed) / (most * armor.jet)), seconds)
    up = (1.0 - most) * armor.jet - GRAVITY
    along = speed * even + 0.5 * most * armor.jet * even**2
    climb = climb_speed * even + 0.5 * up * even**2
    speed, climb_speed = speed + most * armor.jet * even, climb_speed + up * even

    rest, rate = seconds - even, armor.jet / armor.fade
    missing, decay = armor.fade - speed, math.exp(-rate * rest)
    more = armor.fade * rest - missing * (1.0 - decay) / rate
    # Its integral over time: the upward thrust is T v / v_f.
    twice = 0.5 * armor.fade * rest**2 - missing * (rest / rate - (1.0 - decay) / rate**2)
    return Flight(
        armor.fade - missing * decay,
        along + more,
        climb_speed + rate * more - GRAVITY * rest,
        climb + climb_speed * rest + rate * twice - 0.5 * GRAVITY * rest**2,
    )


def fading_ticks(model: str, armor: Armor, speed: float, dt: float, ticks: int) -> tuple[float, float]:
    """Speed and way along the key by ticks, from a speed between v_f/5 and v_f.

    Each tick takes the thrust at its beginning: what is missing to v_f shrinks by 1 - T dt/v_f.
    """
    shrink = 1.0 - armor.jet * dt / armor.fade
    missing = armor.fade - speed
    last = missing * shrink**ticks
    passed = missing * (1.0 - shrink**ticks) / (1.0 - shrink)
    # Sum over the speeds after each tick, or over the means of before and after.
    gaps = passed - missing + last if model == "article" else passed - 0.5 * (missing - last)
    return armor.fade - last, dt * (ticks * armor.fade - gaps)


def stop(armor: Armor, speed: float, dt: float) -> tuple[int, float]:
    """Ticks and metres to a standstill on level ground: the first tick has no contact behind it yet.

    Both models, for in a tick without friction both move by v dt, and after a contact at the new velocity.
    """
    step = armor.ground * dt
    braking = math.ceil(speed / step)
    return braking + 1, dt * (braking * speed - 0.5 * step * braking * (braking - 1))


def power(formula: str, distance: float, min_box: float) -> float:
    """A disc's push by distance from the box's centre (section 6)."""
    if formula != "tribes":
        return max(0.0, 1.0 - distance / DISC_RADIUS) * (BOOST if formula == "linear_boosted" else 1.0)
    nearer = max(distance - min_box, 1.0)
    return distance / nearer - distance / DISC_RADIUS if nearer < DISC_RADIUS else 0.0


@dataclass(frozen=True)
class Hop:
    """One hop of a skier on a plane, by section 10."""

    period: float
    acceleration: float
    #: Along the slope by jump and friction, m/s per hop.
    lost: float


def hop(degrees: float, forward: bool, dt: float) -> Hop:
    """A light's hop, with the key downhill or no key held: friction takes one tick of it."""
    sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    jump, friction = ARMORS["light"].jump, GROUND_LIGHT * dt
    leaving = (jump if forward else jump * cos * cos) - friction * sin
    lost = (0.0 if forward else jump * sin * cos) + friction * cos
    period = 2.0 * leaving / (GRAVITY * cos)
    return Hop(period, GRAVITY * sin - lost / period, lost)


def slide_and_land(
    degrees: float, height: float, forward: float, down: float, seconds: float
) -> tuple[float, float]:
    """A fall onto a plane and the slide after it, without ticks and keys: speed and way along the plane.

    From `height` m above the plane, at `forward` m/s level and downhill and `down` m/s downwards. The contact
    takes what is across the plane; from then on friction, level and 40 m/s^2, brakes by 40 cos.

    Raises:
        ValueError: he is still in the air at the end.
    """
    sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    along, across = forward * cos + down * sin, forward * sin - down * cos
    fall = GRAVITY * cos
    flight = (across + math.sqrt(across**2 + 2.0 * fall * height * cos)) / fall
    if flight > seconds:
        raise ValueError(f"seconds: expected at least the {flight:.3f} s of the fall, got {seconds}")
    slid = seconds - flight
    landed = along + GRAVITY * sin * flight
    brake = GRAVITY * sin - GROUND_LIGHT * cos
    way_in_air = along * flight + 0.5 * GRAVITY * sin * flight**2
    return landed + brake * slid, way_in_air + landed * slid + 0.5 * brake * slid**2
