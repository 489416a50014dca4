"""A small vector environment that keeps every rule, for doubles that break one each."""

from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

NEXT, SAME, DISABLED = AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED


class Walk(VectorEnv[Any, Any, Any]):
    """A noisy walk on a line until |x| > 1 or 15 steps; each environment has its own generator."""

    def __init__(self, num_envs: int = 3, mode: AutoresetMode = NEXT) -> None:
        self.num_envs, self.mode = num_envs, mode
        self.metadata = {"autoreset_mode": mode}
        self.single_observation_space = spaces.Box(-3, 3, (2,), np.float32)
        self.single_action_space = spaces.Discrete(3)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.generators = [np.random.default_rng() for _ in range(num_envs)]
        self.x, self.age = np.zeros(num_envs), np.zeros(num_envs, int)
        self.over = np.zeros(num_envs, bool)

    # What doubles change

    def seeded(self, i: int, seed: int) -> np.random.Generator:
        return np.random.default_rng(seed)

    def first(self, i: int) -> float:
        return float(self.generators[i].uniform(-0.3, 0.3))

    def noise(self, i: int) -> float:
        return float(self.generators[i].normal(0, 0.25))

    def observed(self) -> Any:
        return np.stack([self.x, self.age / 15], axis=1).astype(np.float32)

    def restart(self, i: int) -> None:
        self.x[i], self.age[i], self.over[i] = self.first(i), 0, False

    def masked(self, options: dict[str, Any] | None) -> Any:
        mask = (options or {}).get("reset_mask", np.ones(self.num_envs, bool))
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_ or mask.shape != (self.num_envs,):
            raise ValueError("reset_mask")
        if not mask.any():
            raise ValueError("reset_mask is empty")
        return mask

    def seeds(self, seed: Any) -> list[int | None]:
        return [seed + i for i in range(self.num_envs)] if isinstance(seed, int) else list(seed)

    def info(self, mask: Any) -> dict[str, Any]:
        return {"x": np.where(mask, self.x, 0.0), "_x": mask.copy()}

    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        last = np.full(self.num_envs, None, object)
        for i in np.flatnonzero(ended).tolist():
            last[i] = observation[i].copy()
        inner = {"x": np.where(ended, info["x"], 0.0), "_x": ended.copy()}
        return {
            "final_obs": last,
            "_final_obs": ended.copy(),
            "final_info": inner,
            "_final_info": ended.copy(),
        }

    def checked(self, actions: Any) -> Any:
        if not self.action_space.contains(actions):
            raise ValueError(f"actions: expected {self.action_space}, got {actions!r}")
        return actions

    def move(self, actions: Any, waiting: Any) -> Any:
        """Reward; those that wait for their reset stand still."""
        for i in np.flatnonzero(~waiting).tolist():
            self.x[i] += 0.2 * (actions[i] - 1) + self.noise(int(i))
            self.age[i] += 1
        return np.where(waiting, 0.0, -np.abs(self.x))

    # The environment

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        mask = self.masked(options)
        if seed is not None:
            for i, own in enumerate(self.seeds(seed)):
                if mask[i] and own is not None:
                    self.generators[i] = self.seeded(i, own)
        for i in np.flatnonzero(mask).tolist():
            self.restart(i)
        return self.observed(), self.info(mask)

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        actions = self.checked(actions)
        waiting = self.over.copy() if self.mode is NEXT else np.zeros(self.num_envs, bool)
        reward = self.move(actions, waiting)
        terminated = (np.abs(self.x) > 1) & ~waiting
        truncated = (self.age >= 15) & ~waiting
        self.over = terminated | truncated
        for i in np.flatnonzero(waiting).tolist():
            self.restart(i)
        info = self.info(np.ones(self.num_envs, bool))
        if self.mode is SAME and self.over.any():
            final = self.final(self.over, self.observed(), info)
            for i in np.flatnonzero(self.over).tolist():
                self.restart(i)
            info = {**self.info(np.ones(self.num_envs, bool)), **final}
        return self.observed(), reward, terminated, truncated, info
