"""The command `discjump export`."""

import hashlib
import json
from pathlib import Path

import click

from discjump_training.cli import clean_errors


@click.command()
@click.argument("policy", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(file_okay=False, path_type=Path), help="Folder.  [default: export, beside it]"
)
@click.option("--episodes", type=click.IntRange(min=1), help="Of the held-out course.  [default: all]")
@click.option("--threads", type=click.IntRange(min=1), help="Of the simulator.  [default: all cores]")
def export(policy: Path, out: Path | None, episodes: int | None, threads: int | None) -> None:
    """Pack a trained policy for others: ONNX, stable-baselines3's zip, recipe and card.

    POLICY is the folder of a run (its best model) or a model file that `discjump train` wrote. The folder
    gets policy.onnx, policy.zip, recipe.toml, card.json and card.md; the scores on the card are measured
    now, on the task's held-out course.

    Opening a model file runs code it contains: open only files you trust.
    """
    with clean_errors():
        # Imported late: torch takes seconds, and --help should not.
        from discjump_training import card, model
        from discjump_training.export import to_onnx
        from discjump_training.files import write_atomically
        from discjump_training.recipe import Recipe

        source = policy / model.BEST if policy.is_dir() else policy
        ppo, about = model.load(source), model.about(source)
        run_file = source.parent / "run.json"
        run = json.loads(run_file.read_text(encoding="utf-8")) if run_file.is_file() else {}
        recipe = Recipe.parse(about.get("recipe", {}), f"the recipe in {source}")

        folder = out or source.parent / "export"
        folder.mkdir(parents=True, exist_ok=True)
        to_onnx(ppo, folder / "policy.onnx", {"task": recipe.task, **about})
        digest = hashlib.sha256((folder / "policy.onnx").read_bytes()).hexdigest()
        made = card.make(ppo, about, run, digest, episodes=episodes, threads=threads)
        model.save_to_play(ppo, folder / "policy.zip", about)
        write_atomically(folder / "recipe.toml", recipe.to_toml(help=True).encode())
        write_atomically(folder / "card.json", (json.dumps(made, indent=1) + "\n").encode())
        write_atomically(folder / "card.md", card.markdown(made).encode())
    scores = made["scores"]
    click.echo(
        f"{folder / 'policy.onnx'}: {scores['success']['value']:.1%} succeed, "
        f"{scores['seconds']['value']:.2f} s on {scores['course']}"
    )
