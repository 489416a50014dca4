"""The card of a trained policy: what it is, how it came about and how well it does, as JSON and Markdown."""

from typing import Any

from stable_baselines3 import PPO

from discjump.envs.tasks import TASKS
from discjump_training import intervals, model
from discjump_training.courses import course_of
from discjump_training.episodes import Stage
from discjump_training.errors import ModelError
from discjump_training.recipe import at_full
from discjump_training.runs import seconds_of

#: Fields of the card that the table of its Markdown shows, and their headings.
ROWS = {
    "task": "task",
    "id": "environment",
    "command": "trained by",
    "seed": "seed",
    "steps": "decisions",
    "training_seconds": "seconds of training",
    "commit": "commit",
    "versions": "versions",
    "observation_space": "observations",
    "action_space": "actions",
    "parameters": "weights that act",
    "digest": "SHA-256 of policy.onnx",
}


def make(
    ppo: PPO,
    about: dict[str, Any],
    run: dict[str, Any],
    digest: str,
    *,
    episodes: int | None = None,
    threads: int | None = None,
) -> dict[str, Any]:
    """The card; scores are measured here, on the held-out course of the task, with greedy actions.

    Args:
        ppo: the model.
        about: what its file knows, `model.about`.
        run: what the run's folder knows, its `run.json`; empty where there is none.
        digest: of the exported file.
        episodes: of the course; all by default.
        threads: of the simulator.

    Raises:
        ModelError: if the model was not written by `discjump train`.
    """
    missing = [name for name in ("environment", "seed", "steps", "recipe") if name not in about]
    if missing:
        raise ModelError(
            f"the model does not say its {', '.join(missing)}: expected one that this version of "
            "`discjump train` wrote"
        )
    # Models that are older than the table of tasks are ski's.
    task = TASKS[about.get("task", "ski")]
    course = course_of(task.name, None)
    stage = Stage(course, episodes, at_full(about["environment"]), threads)
    try:
        model.check_spaces(ppo, "the policy", stage.env)
        played = stage.play(model.Greedy(ppo, "policy"))
        layout = [
            {
                "name": field.name,
                "from": field.slice.start,
                "to": field.slice.stop,
                "unit": field.unit,
                "scale": field.scale,
            }
            for field in stage.inner.observation_layout
        ]
    finally:
        stage.close()
    return {
        "schema_version": 1,
        "task": task.name,
        "id": task.id,
        "goal": task.goal,
        "command": f"discjump train {task.name} --recipe recipe.toml --seed {about['seed']}",
        "seed": about["seed"],
        "steps": about["steps"],
        "training_seconds": seconds_of(run) if "seconds" in run else None,
        "commit": about.get("commit"),
        "versions": run.get("versions", {"discjump": about.get("discjump")}),
        "digest": digest,
        "parameters": sum(p.numel() for p in ppo.policy.mlp_extractor.policy_net.parameters())
        + sum(p.numel() for p in ppo.policy.action_net.parameters()),
        "observation_space": str(ppo.observation_space),
        "observation_layout": layout,
        "action_space": str(ppo.action_space),
        "environment": about["environment"],
        "scores": {
            "course": course.name,
            "episodes": len(played.success),
            "actions": "greedy",
            "success": intervals.proportion(played.success).as_dict(),
            "deaths": int(played.death.sum()),
            "seconds": intervals.mean(played.seconds).as_dict(),
            "episode_seconds": [round(value, 3) for value in played.seconds.tolist()],
        },
    }


def markdown(card: dict[str, Any]) -> str:
    """The card for people."""
    scores = card["scores"]
    success, seconds = scores["success"], scores["seconds"]
    lines = [
        f"# A policy for {card['id']}",
        "",
        "Files: `policy.onnx` (input `observation`), `policy.zip` (stable-baselines3's `PPO.load`; opening "
        "it runs code it contains), `recipe.toml`, and this card as `card.json`.",
        "",
        f"On {scores['episodes']} episodes of {scores['course']}, none of whose terrains it was trained on, "
        f"it reaches the {card['goal']} in {success['value']:.1%} "
        f"[{success['low']:.1%}, {success['high']:.1%}] of them, "
        f"with {scores['deaths']} deaths, in {seconds['value']:.2f} s "
        f"[{seconds['low']:.2f}, {seconds['high']:.2f}] (mean; a failure counts as the time limit; "
        "likeliest actions, 95% intervals over episodes).",
        "",
        "| | |",
        "| --- | --- |",
    ]
    for name, heading in ROWS.items():
        value = card[name]
        if isinstance(value, dict):
            value = ", ".join(f"{key} {part}" for key, part in value.items())
        lines.append(f"| {heading} | {_cell(value)} |")
    lines += ["", "| option of the environment | |", "| --- | --- |"]
    lines += [f"| {name} | {_cell(value)} |" for name, value in card["environment"].items()]
    lines += ["", "| columns of an observation | name | times | gives |", "| --- | --- | --- | --- |"]
    lines += [
        f"| {field['from']} to {field['to'] - 1} | {field['name']} | {field['scale']:g} | {field['unit']} |"
        for field in card["observation_layout"]
    ]
    return "\n".join(lines) + "\n"


def _cell(value: object) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    return "not known" if value is None else str(value).replace("|", "\\|")
