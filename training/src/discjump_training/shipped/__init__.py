"""Trained policies that come with the package: a folder per task, as `discjump export` packs them.

policy.zip   stable-baselines3's model: `PPO.load(shipped.policy("ski"))`
policy.onnx  the half that acts, for any ONNX runtime
card.json    command, commit, seed, scores; card.md says it in words
recipe.toml  what it was trained by
"""

import json
from pathlib import Path
from typing import Any

from discjump_training.errors import ModelError

#: What `discjump evaluate` and the others call the shipped policy of the task that is played.
NAME = "ppo"
FOLDER = Path(__file__).parent


def policy(task: str, suffix: str = ".zip") -> Path:
    """File of a task's policy.

    Args:
        task: short name, as in `discjump.envs.tasks.TASKS`.
        suffix: `.zip` or `.onnx`.

    Raises:
        ModelError: none was shipped for that task.

    >>> policy("ski").name
    'policy.zip'
    """
    path = FOLDER / task.replace("-", "_") / f"policy{suffix}"
    if not path.is_file():
        known = sorted(one.parent.name.replace("_", "-") for one in FOLDER.glob(f"*/policy{suffix}"))
        raise ModelError(f"task: expected one with a shipped policy ({', '.join(known)}), got {task!r}")
    return path


def card(task: str) -> dict[str, Any]:
    """The card of a task's policy.

    Raises:
        ModelError: none was shipped for that task.

    >>> card("ski")["id"]
    'discjump/Ski-v0'
    """
    loaded: dict[str, Any] = json.loads(policy(task).with_name("card.json").read_text(encoding="utf-8"))
    return loaded
