"""Train an agent with stable-baselines3's PPO: the whole of it, from top to bottom.

Environments and a model are made (or loaded), `PPO.learn` alternates between collecting experience and
updating, and a `Watcher` looks in between the two: it evaluates, saves and stops. What a run leaves behind
is described in `runs`.

An interrupted run that is resumed goes through the same numbers as one that never stopped.
"""

import base64
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import configure
from stable_baselines3.common.utils import LinearSchedule
from stable_baselines3.common.vec_env import VecEnvWrapper
from stable_baselines3.common.vec_env.base_vec_env import VecEnvObs, VecEnvStepReturn
from tqdm import tqdm

import discjump.sb3
from discjump.envs.tasks import TASKS
from discjump_training import episodes, model, runs
from discjump_training.courses import COURSES, run_seed
from discjump_training.errors import RecipeError, TrainingError
from discjump_training.files import write_atomically
from discjump_training.joint import JointPolicy
from discjump_training.recipe import Recipe
from discjump_training.runs import Point, Progress

ACTIVATIONS = {"tanh": torch.nn.Tanh, "relu": torch.nn.ReLU}
ENVIRONMENT_ENTRY = "environment.snapshot"


@dataclass(frozen=True)
class Result:
    """How a run ended."""

    folder: Path
    steps: int
    finished: bool
    progress: Progress


class TimedVecEnv(VecEnvWrapper):
    """Counts the seconds spent stepping, so that the environment's share of the training time is known."""

    def __init__(self, inner: discjump.sb3.TaskVecEnv) -> None:
        super().__init__(inner)
        self.inner = inner
        self.seconds = 0.0

    def reset(self) -> VecEnvObs:
        """Reset all environments."""
        return self.venv.reset()

    def step_wait(self) -> VecEnvStepReturn:
        """Step, against the clock."""
        start = time.perf_counter()
        result = self.venv.step_wait()
        self.seconds += time.perf_counter() - start
        return result


def train(recipe: Recipe, seed: int, folder: Path, *, resume: bool = False, quiet: bool = False) -> Result:
    """Train by `recipe` in `folder`, from the start or from the newest checkpoint there.

    Args:
        recipe: what to do. When resuming, the caller passes the recipe of the run.
        seed: 0 to `courses.MAX_RUN_SEED`; runs of different seeds share no episode. Ignored when resuming.
        folder: must hold no run, unless resuming; what one left that broke off before its first checkpoint is
            removed.
        resume: go on from the newest checkpoint in `folder`.
        quiet: no progress bar.

    Raises:
        TrainingError: if the folder is taken, there is nothing to resume, or everything is done already.
    """
    checkpoint = runs.newest_checkpoint(folder) if resume else None
    if checkpoint is None:
        runs.check_is_free(folder)
        progress = Progress(seed)
    else:
        progress = Progress.from_dict(model.about(checkpoint)["progress"])

    # More threads gain little for so small a network and collapse on a busy machine; validation of every
    # distribution's arguments costs 10-18 % of the training time.
    torch.set_num_threads(1)
    torch.distributions.Distribution.set_default_validate_args(False)

    env = TimedVecEnv(make_env(recipe, progress.seed))
    try:
        if checkpoint is None:
            runs.clear(folder)
        (folder / "checkpoints").mkdir(parents=True, exist_ok=True)
        learner = (
            make_model(recipe, env, progress.seed)
            if checkpoint is None
            else load_model(checkpoint, recipe, env)
        )
        learner.set_logger(configure(str(folder / "tensorboard"), ["tensorboard"]))
        left = recipe.ppo.steps - learner.num_timesteps
        if left <= 0:
            raise TrainingError(
                f"{folder} is trained for {learner.num_timesteps:,} decisions already; "
                "ask for more with --steps"
            )
        write_atomically(folder / "recipe.toml", recipe.to_toml(help=True).encode())
        watch = Watcher(recipe, folder, progress, env, quiet)
        with stopping_gently(watch):
            learner.learn(left, callback=watch, reset_num_timesteps=False)
        return Result(folder, watch.steps, watch.finished, progress)
    finally:
        env.close()


def make_env(recipe: Recipe, seed: int) -> discjump.sb3.TaskVecEnv:
    """The training environments of the run `seed`.

    Raises:
        RecipeError: if they cannot be made as the recipe says.
    """
    course = COURSES[recipe.environment.course]
    try:
        return discjump.sb3.make_vec_env(
            TASKS[recipe.task].id,
            n_envs=recipe.rollout.num_envs,
            seed=run_seed(seed),
            threads=recipe.rollout.threads,
            terrain_seeds=list(course.terrain_seeds),
            **recipe.environment.kwargs(),
        )
    except (TypeError, ValueError) as error:
        raise RecipeError(f"the environment does not accept the recipe: {error}") from error


def make_model(recipe: Recipe, env: TimedVecEnv, seed: int) -> PPO:
    """PPO with fresh weights."""
    ppo = recipe.ppo
    return PPO(
        JointPolicy if ppo.joint else "MlpPolicy",
        env,
        learning_rate=schedule(recipe),
        n_steps=recipe.rollout.n_steps,
        batch_size=ppo.batch_size,
        n_epochs=ppo.n_epochs,
        gamma=ppo.gamma,
        gae_lambda=ppo.gae_lambda,
        clip_range=ppo.clip_range,
        ent_coef=ppo.ent_coef,
        vf_coef=ppo.vf_coef,
        max_grad_norm=ppo.max_grad_norm,
        stats_window_size=1_024,
        policy_kwargs={"net_arch": list(ppo.hidden), "activation_fn": ACTIVATIONS[ppo.activation]},
        # stable-baselines3 seeds the environments with this too: hence the spaced seed, not the plain one.
        seed=run_seed(seed),
        device="cpu",
    )


def schedule(recipe: Recipe) -> LinearSchedule:
    """Learning rate as a function of the share of the run that is left."""
    return LinearSchedule(recipe.ppo.learning_rate, recipe.ppo.final_learning_rate, 1.0)


def load_model(checkpoint: Path, recipe: Recipe, env: TimedVecEnv) -> PPO:
    """PPO, environments and random generators as they were at the checkpoint."""
    # force_reset would begin new episodes; the snapshot below puts the environments back where they were.
    learner = model.load(checkpoint, env=env, force_reset=False, learning_rate=schedule(recipe))
    env.inner.restore(model.read_entry(checkpoint, ENVIRONMENT_ENTRY))
    generators = model.about(checkpoint)["generators"]
    torch.set_rng_state(torch.frombuffer(bytearray(base64.b64decode(generators["torch"])), dtype=torch.uint8))
    state = generators["numpy"]
    np.random.set_state(("MT19937", np.array(state["key"], dtype=np.uint32), state["pos"], 0, 0.0))  # noqa: NPY002
    return learner


class Watcher(BaseCallback):
    """Between two updates: evaluates, saves, reports, and stops when asked to.

    stable-baselines3 calls `_on_rollout_start` right after each update: only there is the model whole, and
    only there do we save, so that a resumed run repeats nothing and skips nothing.
    """

    def __init__(
        self, recipe: Recipe, folder: Path, progress: Progress, env: TimedVecEnv, quiet: bool
    ) -> None:
        super().__init__()
        self.recipe, self.folder, self.progress, self.env = recipe, folder, progress, env
        self.validation = episodes.Stage(
            COURSES[recipe.watch.evaluate_course],
            recipe.watch.evaluate_episodes,
            recipe.environment.judged(),
            recipe.rollout.threads,
        )
        self.bar = tqdm(total=recipe.ppo.steps, unit=" steps", unit_scale=True, disable=quiet, smoothing=0.05)
        self.stop = False
        self._break_off = False
        self.finished = False
        self.steps = 0
        self._commit = runs.commit()
        self._mark = 0.0
        self._environment_mark = 0.0

    @property
    def _ppo(self) -> PPO:
        assert isinstance(self.model, PPO)
        return self.model

    def _on_training_start(self) -> None:
        self.steps = self.model.num_timesteps
        self.bar.update(self.steps)
        self._mark = time.perf_counter()

    def _on_rollout_start(self) -> None:
        if self.model.num_timesteps > self.steps:
            # Read once: a Ctrl-C after this waits for the next update, or no checkpoint would be written.
            self._break_off = self.stop
            self._after_update()
        self._mark, self._environment_mark = time.perf_counter(), self.env.seconds

    def _on_step(self) -> bool:
        return not self._break_off

    def _on_rollout_end(self) -> None:
        now = time.perf_counter()
        environment = self.env.seconds - self._environment_mark
        self.progress.clock.environment += environment
        self.progress.clock.policy += now - self._mark - environment
        self._mark = now

    def _on_training_end(self) -> None:
        # What is broken off is a rollout that had just begun: everything was saved before it.
        if not self._break_off:
            self.finished = True
            self._after_update()
        self.bar.close()

    def _after_update(self) -> None:
        clock, watch = self.progress.clock, self.recipe.watch
        clock.update += time.perf_counter() - self._mark
        self.bar.update(self.model.num_timesteps - self.steps)
        self.steps = self.model.num_timesteps
        successes: Any = self.model.ep_success_buffer
        self.bar.set_postfix(success=f"{np.mean(successes):.0%}" if successes else "-", refresh=False)
        if self.finished or self.steps - self.progress.evaluated_at >= watch.evaluate_every:
            self._evaluate()
        due = self.steps - self.progress.checkpointed_at >= watch.checkpoint_every
        if self.finished or self._break_off or due:
            self._checkpoint()

    def _evaluate(self) -> None:
        start = time.perf_counter()
        self.progress.evaluated_at = self.steps
        played = self.validation.play(model.Greedy(self._ppo, "under training"))
        point = Point(
            steps=self.steps,
            training_seconds=round(self.progress.clock.training, 3),
            validation_success=float(played.success.mean()),
            validation_seconds=float(played.seconds.mean()),
            training_success=_mean(self.model.ep_success_buffer),
            training_return=_mean([info["r"] for info in self.model.ep_info_buffer or []]),
            learning_rate=float(self.model.policy.optimizer.param_groups[0]["lr"]),
        )
        self.progress.curve.append(point)
        runs.write_curve(self.folder / "curve.csv", self.progress.curve)
        self.logger.record("validation/success", point.validation_success)
        self.logger.record("validation/seconds", point.validation_seconds)
        score, best = TASKS[self.recipe.task].score, self.progress.best
        if best is None or point.rank(score) > best.rank(score):
            self.progress.best = point
            model.save(self._ppo, self.folder / model.BEST, self._about())
        self.progress.clock.evaluation += time.perf_counter() - start
        self.bar.write(
            f"{self.steps:>12,} decisions: {point.validation_success:6.1%} succeed, "
            f"{point.validation_seconds:5.2f} s on {self.recipe.watch.evaluate_course}"
        )

    def _checkpoint(self) -> None:
        self.progress.checkpointed_at = self.steps
        about = self._about() | {
            "progress": asdict(self.progress),
            "generators": {
                "torch": base64.b64encode(torch.get_rng_state().numpy().tobytes()).decode(),
                "numpy": _numpy_state(),
            },
        }
        # The final model comes before the final checkpoint: killed in between, the run goes on from the
        # checkpoint before and ends again, while one with all its decisions done could not be resumed.
        if self.finished:
            model.save(self._ppo, self.folder / "final.zip", self._about())
        snapshot = self.env.inner.snapshot()
        store = self.folder / "checkpoints"
        model.save(self._ppo, store / f"{self.steps:012d}.zip", about, {ENVIRONMENT_ENTRY: snapshot})
        for old in runs.checkpoints(self.folder)[: -self.recipe.watch.keep_checkpoints]:
            old.unlink()
        runs.write_run(self.folder, self.recipe, self.progress, self.steps, self._commit)

    def _about(self) -> dict[str, Any]:
        return {
            "steps": self.steps,
            "task": self.recipe.task,
            "seed": self.progress.seed,
            "environment": self.recipe.environment.kwargs(),
            "recipe": self.recipe.model_dump(),
            "discjump": metadata.version("discjump"),
            "commit": self._commit,
        }


@contextmanager
def stopping_gently(watch: Watcher) -> Iterator[None]:
    """The first Ctrl-C (or SIGTERM) stops after the update under way, a second one at once."""

    def stop(number: int, frame: FrameType | None) -> None:
        if watch.stop:
            raise KeyboardInterrupt
        watch.stop = True
        watch.bar.write(
            "Stopping after the update under way (a few seconds); again to stop at once and lose it."
        )

    previous = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


def _mean(values: Any) -> float:
    return float(np.mean(values)) if values else float("nan")


def _numpy_state() -> dict[str, Any]:
    # stable-baselines3 shuffles minibatches with numpy's global generator.
    _, key, position, _, _ = np.random.get_state()  # noqa: NPY002
    return {"key": np.asarray(key).tolist(), "pos": int(position)}
