"""The picture of a record: six panels, each with theory as a line and the simulator as marks."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from discjump.theory import blasts, forms

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Record = dict[str, Any]

THEORY = "0.35"
"""Colour of lines of theory."""
COLOURS = {
    "reference": "black",
    "authentic": "#0072b2",
    "swept": "#009e73",
    "fast": "#d55e00",
    "engine f64": "#8c564b",
    "engine": "#cc79a7",
}
"""Of the tiers, as in the picture of `discjump accuracy`."""


def draw(record: Record, path: Path) -> None:
    """Draw the picture as a PNG."""
    from matplotlib.figure import Figure  # the command alone needs it

    figure = Figure(figsize=(15.5, 9.4), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)  # type: ignore[union-attr, call-arg]
    panels = figure.subplots(2, 3)
    convergence(panels[0, 0], record["convergence"])
    skiing(panels[0, 1], record["hops"])
    shrinking(panels[0, 2], record["limit"])
    pushes(panels[1, 0])
    slopes(panels[1, 1], record["bumps"])
    if record["ledger"] is None:
        panels[1, 2].set_visible(False)
    else:
        account(panels[1, 2], record["ledger"])
    for axes in panels.flat:
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=100)


def convergence(axes: "Axes", rows: list[Record]) -> None:
    """Error of the place by length of the tick, in float64 and once in float32."""
    shown = [
        ("free flight", "reference", "free flight", "black", 11),
        ("braking", "reference", "braking on level ground", "#009e73", 0),
        ("jets ahead", "reference", "jets ahead", "#0072b2", -5),
        ("landing", "reference", "landing on a slope", "#d55e00", -13),
        ("free flight", "engine", "free flight, engine in float32", "#cc79a7", -3),
    ]
    for case, tier, label, colour, aside in shown:
        row = next(row for row in rows if (row["case"], row["tier"]) == (case, tier))
        ticks, median = row["ticks_ms"], row["place"]["median"]
        axes.loglog(ticks, median, "o-", color=colour, markersize=4)
        low = tier == "engine"
        at = (ticks[0], median[0]) if low else (ticks[-1], median[-1])
        axes.annotate(
            label,
            at,
            (4 if low else 8, aside + 9 * low),
            textcoords="offset points",
            color=colour,
            fontsize=9,
        )
    slope = np.array([1.0, 64.0])
    axes.loglog(slope, 3e-3 * slope, ":", color=THEORY, linewidth=1.2)
    axes.annotate("order 1", (3.0, 5e-3), color=THEORY, fontsize=9)
    exact = next(row for row in rows if (row["case"], row["tier"]) == ("free flight", "engine f64"))
    most = max(exact["place"]["median"])
    axes.annotate(f"engine in float64: exact, {most:.0e} m", (1.0, 1.6e-5), color="#8c564b", fontsize=9)
    axes.set_xticks([1, 2, 4, 8, 16, 32, 64], ["1", "2", "4", "8", "16", "32", "64"])
    axes.minorticks_off()
    axes.set_xlim(0.9, 900.0)
    axes.spines["bottom"].set_bounds(0.9, 64.0)
    axes.set_ylim(1e-5, 6.0)
    axes.set(xlabel="length of the tick, ms", ylabel="error of the place after 1 or 2 s, m")
    axes.set_title(
        "Against continuous motion: flight errs by half a\ntick; landings have no order", loc="left"
    )


def skiing(axes: "Axes", rows: list[Record]) -> None:
    """Acceleration by slope: the laws, and every tier."""
    degrees = np.linspace(1.0, 46.0, 200)
    axes.plot(degrees, forms.GRAVITY * np.sin(np.radians(degrees)), ":", color=THEORY)
    axes.annotate("without friction", (36.0, 12.1), ha="right", fontsize=9, color=THEORY)
    for keys, at, label in (("forward", 7.2, "forward held"), ("none", 1.2, "no direction held")):
        law = [forms.hop(slope, keys == "forward", 0.032).acceleration for slope in degrees]
        axes.plot(degrees, law, color=THEORY, linewidth=1.2)
        axes.annotate(label, (29.0, at), fontsize=9)
        for tier, mark in (("reference", "o"), ("fast", "x"), ("engine", "+")):
            of = [row for row in rows if (row["tier"], row["keys"]) == (tier, keys)]
            axes.plot(
                [row["slope"] for row in of],
                [row["acceleration"] for row in of],
                mark,
                color=COLOURS[tier],
                markersize={"o": 6, "x": 5, "+": 8}[mark],
                markerfacecolor="none",
                label=tier if keys == "forward" else None,
            )
    axes.legend(loc="upper left", frameon=False)
    axes.set(xlabel="slope, degrees", ylabel="acceleration along it, m/s²")
    axes.set_title("Skiing: the law of a hop (line) and\nwhat tiers do (marks)", loc="left")


def shrinking(axes: "Axes", rows: list[Record]) -> None:
    """Skiing on one slope by length of the tick: the law's limits."""
    slope = rows[0]["slope"]
    down = forms.GRAVITY * np.sin(np.radians(slope))
    ticks = np.linspace(0.0, 64.0, 200)
    for keys, share, label in (("forward", 1.0, "forward held"), ("none", 0.5, "no direction held")):
        axes.plot(
            ticks,
            [forms.hop(slope, keys == "forward", ms / 1000.0).acceleration for ms in ticks],
            color=THEORY,
        )
        of = [row for row in rows if row["keys"] == keys]
        axes.plot(
            [r["tick_ms"] for r in of], [r["acceleration"] for r in of], "o", color="black", label=label
        )
        name = "g sin" if share == 1.0 else "g sin / 2"
        axes.annotate(f"{label}: {name} as the tick shrinks", (2.0, share * down + 0.15), fontsize=9)
    axes.axvline(32.0, color="0.85", zorder=0)
    axes.annotate(
        "the game", (32.0, axes.get_ylim()[0]), xytext=(3, 4), textcoords="offset points", color="0.5"
    )
    axes.set(xlabel="length of the tick, ms", ylabel="acceleration, m/s²", xlim=(0.0, 66.0))
    axes.set_title(
        f"Skiing's friction is one tick long:\na law of the tick, not of nature ({slope:g} degrees)",
        loc="left",
    )


def pushes(axes: "Axes") -> None:
    """Three formulas, and what a light is given by them."""
    from discjump.theory.lab import TIERS

    fine, coarse = blasts.distances(34 * 25 + 1), blasts.distances(35)
    for formula, style in zip(blasts.FORMULAS, ("-", "--", "-."), strict=True):
        # In the very centre there is no direction, and no push.
        axes.plot(fine[1:], blasts.law("light", formula, fine[1:]), style, color=THEORY, linewidth=1.2)
        got = blasts.pushes(TIERS[1], "light", formula, coarse)
        axes.plot(coarse[1:], got[1:], "o", markersize=4, label=formula.replace("_", ", "))
    axes.legend(frameon=False, title="authentic, by formula")
    axes.set(
        xlabel="from the blast to the middle of the box, m", ylabel="speed gained, m/s", ylim=(0.0, None)
    )
    axes.set_title("A disc's push on a light: section 6 (lines)\nand the simulator (marks)", loc="left")


def slopes(axes: "Axes", rows: list[Record]) -> None:
    """Speed lost by size of the squares."""
    shown = {
        "authentic": ("triangles", "-"),
        "fast": ("triangles", "-"),
        "authentic, bilinear": ("bilinear", ":"),
    }
    for surface, mark in {"plane": "s", "valley": "o", "crest": "^", "cone": "v"}.items():
        for label, (ground, style) in shown.items():
            tier = label.partition(",")[0]
            of = sorted(
                (r for r in rows if (r["surface"], r["ground"], r["tier"]) == (surface, ground, tier)),
                key=lambda r: r["square"],
            )
            axes.plot(
                [r["square"] for r in of],
                [1000.0 * r["mean"] for r in of],
                mark + style,
                color=COLOURS[tier],
                markerfacecolor="none" if ground == "bilinear" else None,
                linewidth=1,
                label=label if surface == "valley" else None,
            )
            if label == "fast":
                aside = {"cone": 1, "plane": -9}.get(surface, -3)
                end = (of[-1]["square"], 1000.0 * of[-1]["mean"])
                axes.annotate(surface, end, xytext=(7, aside), textcoords="offset points")
    theory = sorted(
        (r for r in rows if (r["surface"], r["ground"], r["tier"]) == ("valley", "triangles", "fast")),
        key=lambda r: r["square"],
    )
    axes.plot(
        [r["square"] for r in theory],
        [1000.0 * r["theory"] for r in theory],
        "--",
        color=THEORY,
        label="theory, straight across",
    )
    axes.set(xlabel="side of a square, m (terrain: 8)", ylabel="speed lost, mm/s per metre", xlim=(0.0, 9.5))
    axes.legend(frameon=False)
    axes.set_title(
        "Ghost bumps: what a smooth slope costs for\nbeing cut into triangles, or into patches", loc="left"
    )


def account(axes: "Axes", ledger: Record) -> None:
    """Where energy comes from and goes, by kind of run."""
    runs = [row for row in ledger["rows"] if row["tier"] == "reference" and row["run"] != "coast"]
    kinds = {
        "jumps": ("jumps", "#0072b2"),
        "jets": ("jets", "#56b4e9"),
        "explosions": ("explosions", "#009e73"),
        "contacts": ("contacts (landings)", "#d55e00"),
        "friction and walking": ("friction", "#e69f00"),
        "ticks": ("ticks themselves", "0.3"),
    }
    for line, row in enumerate(runs):
        terms = dict(row["terms"])
        terms["ticks"] = terms["gravity by ticks"] + terms["height of ticks with contacts"]
        ends = {True: 0.0, False: 0.0}
        for name, (label, colour) in kinds.items():
            joules = terms[name]
            axes.barh(
                -line, joules, left=ends[joules > 0.0], color=colour, label=label if line == 0 else None
            )
            ends[joules > 0.0] += joules
        axes.plot([row["change"]] * 2, [-line - 0.4, -line + 0.4], color="black", linewidth=2)
    axes.plot([0.0, 0.0], [0.5, 0.5 - len(runs)], color="black", linewidth=0.7)
    axes.set_yticks([-k for k in range(len(runs))], [row["run"] for row in runs])
    axes.set_ylim(-len(runs) - 0.4, 0.6)
    axes.legend(frameon=False, fontsize=9, ncols=3, loc="lower center", columnspacing=1.0)
    axes.set(xlabel="J/kg: lost to the left, gained to the right; black: change")
    axes.set_title("Where a minute's energy comes from and goes", loc="left")
