"""Environments that break one rule each, named after it."""

import random
import time
from typing import Any

import numpy as np
from gymnasium import spaces
from tests.testing.walk import NEXT, Walk


class OtherActionDtype(Walk):
    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.action_space = spaces.MultiDiscrete([3] * self.num_envs, dtype=np.int32)

    def checked(self, actions: Any) -> Any:
        return super().checked(actions.astype(np.int32))


class NoMode(Walk):
    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.metadata = {}


class FourValues(Walk):
    def step(self, actions: Any) -> Any:
        observation, reward, terminated, _, info = super().step(actions)
        return observation, reward, terminated, info


class RaisesLater(Walk):
    def step(self, actions: Any) -> Any:
        if (self.age > 10).any():
            raise RuntimeError("the eleventh step is too much")
        return super().step(actions)


class NeverAnswers(Walk):
    def step(self, actions: Any) -> Any:
        if (self.age > 5).any():
            while True:
                try:
                    time.sleep(3600)
                except Exception:
                    continue
        return super().step(actions)


class Float64Observation(Walk):
    def observed(self) -> Any:
        return super().observed().astype(np.float64)


class OutOfSpace(Walk):
    def observed(self) -> Any:
        return super().observed() + np.float32(3)


class OutOfSpaceInOneRow(Walk):
    """Inside of the batched space, which is wider than the single one."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.single_observation_space = spaces.Box(-0.1, 0.1, (2,), np.float32)


class RewardColumn(Walk):
    def step(self, actions: Any) -> Any:
        observation, reward, *rest = super().step(actions)
        return observation, reward[:, None], *rest


class RewardNaN(Walk):
    def step(self, actions: Any) -> Any:
        observation, reward, terminated, *rest = super().step(actions)
        reward[terminated] = np.nan
        return observation, reward, terminated, *rest


class RewardList(Walk):
    def step(self, actions: Any) -> Any:
        observation, reward, *rest = super().step(actions)
        return observation, reward.tolist(), *rest


class IntegerFlags(Walk):
    def step(self, actions: Any) -> Any:
        observation, reward, terminated, truncated, info = super().step(actions)
        return observation, reward, terminated.astype(np.int8), truncated, info


class NoInfoMask(Walk):
    def info(self, mask: Any) -> dict[str, Any]:
        return {"x": super().info(mask)["x"]}

    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        return {**super().final(ended, observation, info), "final_info": {}}


class InfoList(Walk):
    def info(self, mask: Any) -> dict[str, Any]:
        info = super().info(mask)
        return {**info, "y": list(self.x), "_y": info["_x"]}


class ReusesObservation(Walk):
    buffer: Any = None

    def observed(self) -> Any:
        if self.buffer is None:
            self.buffer = super().observed()
        self.buffer[...] = super().observed()
        return self.buffer


class ReusesReward(Walk):
    buffer: Any = None

    def move(self, actions: Any, waiting: Any) -> Any:
        if self.buffer is None:
            self.buffer = np.zeros(self.num_envs)
        self.buffer[...] = super().move(actions, waiting)
        return self.buffer


class ReusesFlags(Walk):
    buffer: Any = None

    def step(self, actions: Any) -> Any:
        observation, reward, terminated, truncated, info = super().step(actions)
        if self.buffer is None:
            self.buffer = truncated.copy()
        self.buffer[...] = truncated
        return observation, reward, terminated, self.buffer, info


class ReusesInfo(Walk):
    buffer: Any = None

    def info(self, mask: Any) -> dict[str, Any]:
        if self.buffer is None:
            self.buffer = super().info(mask)
        self.buffer["x"][...] = np.where(mask, self.x, 0)
        return {"x": self.buffer["x"], "_x": mask.copy()}


class ReusesFinalObservation(Walk):
    buffer: Any = None

    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        if self.buffer is None:
            self.buffer = observation.copy()
        self.buffer[ended] = observation[ended]
        final = super().final(ended, observation, info)
        for i in np.flatnonzero(ended):
            final["final_obs"][i] = self.buffer[i]
        return final


class LendsItsState(Walk):
    """Info is the state itself: not reused, but whoever writes to it moves the environment."""

    def restart(self, i: int) -> None:
        self.x = self.x.copy()
        super().restart(i)

    def move(self, actions: Any, waiting: Any) -> Any:
        self.x = self.x.copy()
        return super().move(actions, waiting)

    def info(self, mask: Any) -> dict[str, Any]:
        return {"x": self.x, "_x": mask.copy()}


class ClipsActions(Walk):
    def checked(self, actions: Any) -> Any:
        actions = super().checked(actions)
        np.clip(actions, 0, 1, out=actions)
        return actions


class IgnoresMask(Walk):
    def masked(self, options: dict[str, Any] | None) -> Any:
        super().masked(options)
        return np.ones(self.num_envs, bool)

    def info(self, mask: Any) -> dict[str, Any]:
        return {}

    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        return {**super().final(ended, observation, {"x": self.x}), "final_info": {}}


class MaskSeedsAsOne(Walk):
    """A reset with mask and seed gives all of the mask the same seed."""

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> Any:
        if options and isinstance(seed, int):
            seed = [seed + 1] * self.num_envs
        return super().reset(seed=seed, options=options)


class MaskInfoOfAll(Walk):
    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> Any:
        observation, _ = super().reset(seed=seed, options=options)
        return observation, self.info(np.ones(self.num_envs, bool))


class TakesAnyMask(Walk):
    def masked(self, options: dict[str, Any] | None) -> Any:
        mask = (options or {}).get("reset_mask", np.ones(self.num_envs, bool))
        return np.resize(np.asarray(mask, bool), self.num_envs)


class RefusesMasks(Walk):
    def masked(self, options: dict[str, Any] | None) -> Any:
        if options:
            raise ValueError("no options")
        return super().masked(options)


class IgnoresSeeds(Walk):
    def seeded(self, i: int, seed: int) -> np.random.Generator:
        return self.generators[i]


class OneSeedForAll(Walk):
    def seeded(self, i: int, seed: int) -> np.random.Generator:
        return np.random.default_rng(12345)


class DrawsGlobally(Walk):
    def noise(self, i: int) -> float:
        return float(np.random.normal(0, 0.1))  # noqa: NPY002


class SeedsGlobally(Walk):
    """Repeats, as long as nobody else draws: reset seeds numpy's global generator."""

    def first(self, i: int) -> float:
        state = int(self.generators[i].integers(2**31))
        np.random.seed(state)  # noqa: NPY002
        return float(np.random.uniform(-0.3, 0.3))  # noqa: NPY002


class DrawsFromRandom(Walk):
    def first(self, i: int) -> float:
        random.seed(int(self.generators[i].integers(2**31)))
        return random.uniform(-0.3, 0.3)


class KeepsAge(Walk):
    """A reset with a seed leaves the age of an episode that ended just now: it is still to be reset."""

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> Any:
        over = self.over.copy()
        returned = super().reset(seed=seed, options=options)
        if options is None:
            self.over = over & (self.mode is NEXT)
        return returned


class SeedsFromSystem(Walk):
    """reset() without a seed takes one from the operating system."""

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> Any:
        if seed is None and options is None:
            self.generators = [np.random.default_rng() for _ in range(self.num_envs)]
            # Autoreset goes on with what a reset would have drawn, which is another rule's double.
        return super().reset(seed=seed, options=options)


class FirstSeedOnly(Walk):
    def seeds(self, seed: Any) -> list[int | None]:
        return super().seeds(seed if isinstance(seed, int) else seed[0])


class RefusesLists(Walk):
    def seeds(self, seed: Any) -> list[int | None]:
        if not isinstance(seed, int):
            raise TypeError("seed: expected an int")
        return super().seeds(seed)


class SpawnsSeeds(Walk):
    """Independent seeds, but not s + i."""

    def seeds(self, seed: Any) -> list[int | None]:
        if not isinstance(seed, int):
            return super().seeds(seed)
        return [int(child) for child in np.random.SeedSequence(seed).generate_state(self.num_envs)]


class SpawnsSeedsRefusesLists(SpawnsSeeds):
    def seeds(self, seed: Any) -> list[int | None]:
        if not isinstance(seed, int):
            raise TypeError("seed: expected an int")
        return super().seeds(seed)


class CountsInstances(Walk):
    made = 0

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        type(self).made += 1
        self.number = type(self).made

    def noise(self, i: int) -> float:
        return super().noise(i) + 1e-3 * self.number


class DependsOnPosition(Walk):
    def noise(self, i: int) -> float:
        return super().noise(i) + 1e-6 * i


class DependsOnPositionRefusesLists(DependsOnPosition, RefusesLists):
    pass


class DependsOnBatchSize(Walk):
    def noise(self, i: int) -> float:
        return super().noise(i) + 1e-6 * self.num_envs


class PullsNeighbours(Walk):
    def move(self, actions: Any, waiting: Any) -> Any:
        self.x += 1e-6 * actions.sum()
        return super().move(actions, waiting)


class CountsNeighboursInInfo(Walk):
    """The dtype of a key follows what the others do, as `VectorEnv._add_info` can make it."""

    def step(self, actions: Any) -> Any:
        *rest, info = super().step(actions)
        info["moves"] = np.full(self.num_envs, actions.sum())
        info["_moves"] = np.ones(self.num_envs, bool)
        return *rest, info


class RewardsTheReset(Walk):
    def move(self, actions: Any, waiting: Any) -> Any:
        return np.where(waiting, -1.0, super().move(actions, waiting))


class HeedsActionAtReset(Walk):
    def move(self, actions: Any, waiting: Any) -> Any:
        for i in np.flatnonzero(waiting):
            for _ in range(actions[i]):
                self.noise(int(i))
        return super().move(actions, waiting)


class NoFinalObservation(Walk):
    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        final = super().final(ended, observation, info)
        del final["final_obs"], final["_final_obs"]
        return final


class FinalMaskOfTerminated(Walk):
    """Truncated ends are left out of the mask of `final_obs`."""

    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        final = super().final(ended, observation, info)
        final["_final_obs"] = ended & (np.abs(self.x) > 1)
        return final


class FinalInfoMaskOfAll(Walk):
    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        return {**super().final(ended, observation, info), "_final_info": np.ones(self.num_envs, bool)}


class FinalObservationDtype(Walk):
    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        return super().final(ended, observation.astype(np.float16), info)


class FinalObservationIsNext(Walk):
    """What is kept as last is a view of what the next episode overwrites."""

    def step(self, actions: Any) -> Any:
        observation, reward, terminated, truncated, info = super().step(actions)
        for i in np.flatnonzero(info.get("_final_obs", np.zeros(self.num_envs, bool))):
            info["final_obs"][i] = observation[i].copy()
        return observation, reward, terminated, truncated, info


class FinalObservationIsStale(Walk):
    """What is kept as last is the observation of the step before."""

    before: Any = None

    def final(self, ended: Any, observation: Any, info: dict[str, Any]) -> dict[str, Any]:
        return super().final(ended, self.before, info)

    def step(self, actions: Any) -> Any:
        self.before = self.observed()
        return super().step(actions)


class GoesOnAfterEnd(Walk):
    """An autoreset starts where the last episode started."""

    started: Any = None

    def restart(self, i: int) -> None:
        if self.started is None:
            self.started = np.zeros(self.num_envs)
        over = self.over[i] or self.age[i] >= 15 or abs(self.x[i]) > 1
        super().restart(i)
        if over and self.autoreset:
            self.x[i] = self.started[i]
        self.started[i] = self.x[i]

    autoreset = False

    def step(self, actions: Any) -> Any:
        self.autoreset = True
        try:
            return super().step(actions)
        finally:
            self.autoreset = False


class BroadcastsActions(Walk):
    def checked(self, actions: Any) -> Any:
        return np.resize(actions, self.num_envs)


class MovesBeforeItCounts(Walk):
    """Actions are counted only after the environments were stepped, as `SyncVectorEnv` does."""

    def step(self, actions: Any) -> Any:
        count = len(actions)
        returned = super().step(np.resize(actions, self.num_envs))
        if count != self.num_envs:
            raise ValueError(f"{count} actions for {self.num_envs} environments")
        return returned

    def checked(self, actions: Any) -> Any:
        return actions


class ClosesOnce(Walk):
    def close(self, **kwargs: Any) -> None:
        if self.closed:
            raise RuntimeError("closed already")
        super().close(**kwargs)


class NeverClosed(Walk):
    def close(self, **kwargs: Any) -> None:
        return
