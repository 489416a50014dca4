"""`discjump falloff`: the three falloff curves of a blast's push, and its damage."""

from pathlib import Path
from typing import Any

import click
import numpy as np

from discjump._options import FiniteRange
from discjump._results import require_matplotlib, save
from discjump.explosions import falloff as curve

FORMULAS = {"tribes": "tribes", "basic": "basic", "linear_boosted": "linear, boosted by 26/11"}
"""Formulas and what the picture calls them."""

METRES = FiniteRange(0.0, 1e6, min_open=True)


@click.command()
@click.option("--radius", type=METRES, default=7.5, show_default=True, help="Of the explosion, m.")
@click.option(
    "--min-box",
    type=FiniteRange(0.0, 1e6),
    default=1.0,
    show_default=True,
    help="Smallest side of the player's box, m: light 1.0, medium 1.4, heavy 1.6.",
)
@click.option("--farthest", type=METRES, default=9.0, show_default=True, help="End of the curves, m.")
@click.option(
    "--cutoff", type=click.Choice(["engine", "radius"]), default="engine", show_default=True, help="Reach."
)
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs/falloff"),
    show_default=True,
    help="Directory for the picture (PNG) and the figures (JSON).",
)
def falloff(radius: float, min_box: float, farthest: float, cutoff: str, out: Path) -> None:
    """Push and damage of a blast by distance from the centre of the player's box.

    Distances are in m. The push is without dimension: times 150 for a disc, over the mass (light 9, medium
    13, heavy 18), it is a change of velocity in m/s. The defaults are a disc and a light.
    """
    require_matplotlib("discjump falloff")
    distance = np.linspace(0.0, farthest, 901)
    power = {name: curve(distance, name, radius, min_box, cutoff)[0] for name in FORMULAS}
    share = curve(distance, "tribes", radius, min_box, cutoff)[1]
    peak = float(distance[power["tribes"].argmax()])
    figures = {
        "radius": radius,
        "min_box": min_box,
        "cutoff": cutoff,
        "distance": distance.tolist(),
        "power": {name: values.tolist() for name, values in power.items()},
        "damage_share": share.tolist(),
        "tribes_peak": {"distance": peak, "power": float(power["tribes"].max())},
    }
    out.mkdir(parents=True, exist_ok=True)
    picture, numbers = out / "falloff.png", out / "falloff.json"
    draw(figures, picture)
    save(numbers, figures)
    click.echo(f'strongest push of "tribes": {figures["tribes_peak"]["power"]:.4f} at {peak:.2f} m')
    click.echo(f"{picture}\n{numbers}")


def draw(figures: dict[str, Any], path: Path) -> None:
    """The curves as a PNG."""
    from matplotlib.figure import Figure  # of the training package: the command alone needs it

    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.add_subplot()
    distance = figures["distance"]
    for name, style in zip(FORMULAS, ("-", "--", "-."), strict=True):
        axes.plot(distance, figures["power"][name], style, linewidth=2.0, label=f"push, {FORMULAS[name]}")
    axes.plot(distance, figures["damage_share"], ":", color="tab:red", label="damage, share of the largest")
    peak = figures["tribes_peak"]
    if peak["power"] > 0.0:
        axes.annotate(
            f"{peak['power']:.3f} at {peak['distance']:.2f} m",
            (peak["distance"], peak["power"]),
            xytext=(12, 12),
            textcoords="offset points",
        )
        axes.plot([peak["distance"]], [peak["power"]], "o", color="tab:blue")
    axes.set(
        xlabel="distance from the blast to the centre of the box, m",
        ylabel="push (times kick over mass: m/s)",
        title=f"Blast of radius {figures['radius']:g} m, smallest box side {figures['min_box']:g} m",
        xlim=(0.0, distance[-1]),
        ylim=(0.0, None),
    )
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=120)
