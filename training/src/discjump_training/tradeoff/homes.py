"""Where policies are trained: the physics of a training, its recipe and its folder."""

import json
from dataclasses import dataclass
from pathlib import Path

from discjump_training import runs
from discjump_training.errors import TrainingError
from discjump_training.recipe import Recipe
from discjump_training.tradeoff.grid import DEFAULT, Config, Plan

RECIPE = Path(__file__).parent / "recipe.toml"
"""Of all trainings."""
QUICK_CHANGES = (
    "rollout.num_envs=64",
    "ppo.batch_size=1024",
    "watch.evaluate_every=1_000_000",
    "watch.evaluate_episodes=4",
    "watch.checkpoint_every=1_000_000",
)
"""Of the recipe, where it only matters whether it runs."""


@dataclass(frozen=True)
class Home:
    """The physics that a policy is trained in."""

    config: Config
    #: Ticks of a decision, if not the task's time between two.
    skip: int | None = None

    @property
    def frame_skip(self) -> int:
        """Ticks of a decision."""
        return self.skip or self.config.frame_skip

    @property
    def name(self) -> str:
        """In tables.

        >>> Home(Config("fast", 64)).name, Home(DEFAULT, 8).name
        ('fast 64 ms', 'authentic 32 ms, frame_skip 8')
        """
        return self.config.name + ("" if self.skip is None else f", frame_skip {self.skip}")

    def recipe(self, plan: Plan, steps: int) -> Recipe:
        """The recipe in this physics."""
        fields = {
            "fidelity": self.config.tier,
            "tick_ms": self.config.tick_ms,
            "surface": self.config.surface,
            "frame_skip": self.frame_skip,
        }
        changes = [f"environment.{key}={json.dumps(value)}" for key, value in fields.items()]
        return Recipe.load(RECIPE, (f"ppo.steps={steps}", *changes, *(QUICK_CHANGES if plan.quick else ())))

    def folder(self, out: Path, seed: int) -> Path:
        """Of a run."""
        return out / self.name.replace(",", "").replace(" ", "-") / f"seed-{seed}"


TASK = Home(DEFAULT)
"""Where policies are judged."""
ASIDE = (
    Home(Config("fast", surface="bilinear")),
    Home(Config("authentic", 64)),
    Home(DEFAULT, 2),
    Home(DEFAULT, 8),
)
"""Trained in beside the tiers: the cheapest ground, the cheapest tick, and other times between decisions."""


def homes(plan: Plan) -> list[Home]:
    """The task's, the tiers, then what else the plan has."""
    tiers = [Home(Config(tier)) for tier in plan.tiers]
    aside = [
        home
        for home in ASIDE
        if home.config in plan.configs() and home.frame_skip in plan.decisions(home.config.tick_ms)
    ]
    return list(dict.fromkeys([TASK, *tiers, *([] if plan.quick else aside)]))


def train(home: Home, plan: Plan, out: Path, seed: int) -> Path:
    """Train where it is not done yet, from the newest checkpoint if there is one; the folder of the run.

    Raises:
        TrainingError: the folder holds a run by another recipe.
        KeyboardInterrupt: Ctrl-C; what was learned up to the update under way is kept.
    """
    # Imported late: torch takes seconds.
    from discjump_training.train import train as learn

    where = home.folder(out, seed)
    recipe = home.recipe(plan, plan.steps)
    begun = bool(runs.checkpoints(where))
    ended = (where / "final.zip").exists()
    if (begun or ended) and Recipe.load(where / "recipe.toml") != recipe:
        raise TrainingError(f"{where} holds a run by another recipe: remove it, or choose another --out")
    if not ended and not learn(recipe, seed, where, resume=begun, quiet=True).finished:
        raise KeyboardInterrupt
    return where
