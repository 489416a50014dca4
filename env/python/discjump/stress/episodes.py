"""Episodes of `discjump/Ski-v0` with random actions: whatever an agent does, it sees possible numbers."""

import math
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

HEADER = {
    "episodes": "episodes",
    "steps": "decisions",
    "arrivals": "arrivals",
    "timeouts": "time-outs",
    "longest": "longest, decisions",
}
ENVS = 1024
ENOUGH = 1024
"""Episodes among which both kinds of ends must be: one in forty arrives."""
TIME_LIMIT = 8.0
"""s: long enough to arrive where a start is near its beacon, or to go anywhere."""
NEAR = (20.0, 120.0)
"""Distance from start to beacon, m."""


def played(fidelity: str, episodes: int, seed: int, done: Callable[[float], object]) -> dict[str, Any]:
    """Play so many episodes in a tier and ask every step."""
    envs = gymnasium.make_vec(
        "discjump/Ski-v0",
        num_envs=min(ENVS, episodes),
        autoreset_mode=AutoresetMode.SAME_STEP,
        fidelity=fidelity,
        time_limit=TIME_LIMIT,
        goal_distance=NEAR,
        start_speed=60.0,
    )
    number = envs.num_envs
    space: Any = envs.single_observation_space
    action_bins = np.asarray(getattr(envs.single_action_space, "nvec"))  # noqa: B009
    decision = float(envs.unwrapped.options.decision_seconds)  # type: ignore[attr-defined]
    most = math.ceil(TIME_LIMIT / decision)
    rng = np.random.default_rng([seed, episodes])
    failures: list[str] = []
    observations, _ = envs.reset(seed=seed)
    age = np.zeros(number, np.int64)
    steps = arrivals = timeouts = longest = 0

    def possible(what: str, values: Any) -> None:
        inside = np.isfinite(values) & (values >= space.low) & (values <= space.high)
        if not inside.all() and len(failures) < 20:
            failures.append(
                f"{what}: {int((~inside).sum())} numbers out of the space after {steps} decisions"
            )

    possible("first observations", observations)
    while arrivals + timeouts < episodes:
        actions = rng.integers(0, action_bins, (number, len(action_bins)))
        observations, rewards, terminated, truncated, info = envs.step(actions)
        steps += number
        age += 1
        possible("observations", observations)
        if not np.isfinite(rewards).all():
            failures.append(f"a reward that is no number after {steps} decisions")
        ended = terminated | truncated
        if ended.any():
            final = np.stack(list(info["final_obs"][ended]))
            possible("final observations", final)
            longest = max(longest, int(age[ended].max()))
            arrivals += int(terminated.sum())
            timeouts += int((truncated & ~terminated).sum())
            short = truncated & ~terminated & (age != most)
            if short.any():
                failures.append(
                    f"{int(short.sum())} time-outs after {age[short].tolist()} decisions, not {most}"
                )
            age[ended] = 0
            done(min(1.0, (arrivals + timeouts) / episodes))
        if len(failures) > 20:
            break
    if longest > most:
        failures.append(f"an episode of {longest} decisions, expected {most} at most")
    if episodes >= ENOUGH and not (arrivals and timeouts):
        failures.append(f"expected both kinds of ends, got {arrivals} arrivals and {timeouts} time-outs")
    envs.close()
    return {
        "episodes": arrivals + timeouts,
        "steps": steps,
        "arrivals": arrivals,
        "timeouts": timeouts,
        "longest": longest,
        "failures": failures,
    }
