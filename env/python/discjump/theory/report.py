"""The Markdown of a record: everything in it comes from the JSON beside it."""

from math import radians, sin
from typing import Any

Record = dict[str, Any]


def render(record: Record) -> str:
    """The whole report."""
    machine = record["machine"]
    described = ", ".join(f"{name} {number}" for name, number in record["versions"].items())
    parts = [
        "# Theory, measured",
        "",
        f"    {record['command']}",
        "",
        f"{machine['processor']}, Python {machine['python']}, {described}. "
        "[README](README.md) says what the tables mean.",
        *section("Order of convergence: error of the place, m", convergence(record["convergence"])),
        *section("Single figures: closed form by ticks, and each tier's distance from it", figures(record)),
        *section("Explosions: largest difference from section 6, m/s", blasts(record["blasts"])),
        *section("Skiing on planes: acceleration along the slope, m/s²", hops(record["hops"])),
        *section("The same on 20 degrees by length of the tick, `reference`", limit(record["limit"])),
        *section("Ghost bumps: speed lost per metre of way, (mm/s)/m", bumps(record["bumps"])),
    ]
    if record["ledger"] is not None:
        parts += section("Energy of a minute's skiing, J/kg", ledger(record["ledger"]))
    return "\n".join([*parts, ""])


def section(title: str, lines: list[str]) -> list[str]:
    """A heading and what is under it."""
    return ["", f"## {title}", "", *lines]


def table(head: list[str], rows: list[list[str]]) -> list[str]:
    """Lines of a Markdown table."""
    return [f"| {' | '.join(cells)} |" for cells in [head, ["---"] * len(head), *rows]]


def convergence(rows: list[Record]) -> list[str]:
    """Error of the place: at some lengths of the tick, its order, and what of it is float32's."""
    made = []
    for row in rows:
        place = row["place"]
        at = dict(zip(row["ticks_ms"], place["median"], strict=True))
        rounding = place["rounding"] and dict(zip(row["ticks_ms"], place["rounding"], strict=True))
        cells = [f"{at[ms]:.2g}" for ms in (1, 8, 32, 64)]
        cells += [order(place["order"]), row["theory"]]
        cells += [f"{rounding[ms]:.0e}" if rounding else "-" for ms in (1, 32)]
        made.append([row["case"], f"`{row['tier']}`", *cells])
    head = ["motion", "tier", "1 ms", "8 ms", "32 ms", "64 ms", "order", "by theory"]
    return table([*head, "float32 at 1 ms", "at 32 ms"], made)


def order(fitted: Record | None) -> str:
    """Median and range of the fitted slopes.

    >>> order({"median": 1.0, "low": 0.98, "high": 1.021}), order(None)
    ('1.00 (0.98 to 1.02)', 'exact')
    """
    if fitted is None:
        return "exact"
    return f"{fitted['median']:.2f} ({fitted['low']:.2f} to {fitted['high']:.2f})"


def figures(record: Record) -> list[str]:
    """Closed forms and distances."""
    tiers = list(record["figures"][0]["measured"])
    models = record["models"]
    made = []
    for row in record["figures"]:
        off = [row["measured"][tier] - row[models[tier]] for tier in tiers]
        shown = [number(row[name]) for name in ("smooth", "article", "engine")]
        made.append([f"{row['name']}{', ' if row['unit'] else ''}{row['unit']}", *shown, *map(distance, off)])
    return table(["", "without ticks", "`article`", "`engine`", *(f"`{tier}`" for tier in tiers)], made)


def number(value: float) -> str:
    """At most four decimals.

    >>> number(109), number(1.60298667)
    ('109', '1.603')
    """
    return f"{value:.4f}".rstrip("0").rstrip(".")


def distance(value: float) -> str:
    """One digit.

    >>> distance(0.0), distance(-1.234e-13)
    ('0', '-1e-13')
    """
    return "0" if value == 0.0 else f"{value:.0e}"


def blasts(rows: list[Record]) -> list[str]:
    """One line for each armor and formula."""
    tiers = list(dict.fromkeys(row["tier"] for row in rows))
    made: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        cells = made.setdefault((row["armor"], row["formula"]), [])
        if not cells:
            cells.append(f"{row['peak']:.2f} at {row['peak_at']:.2f} m")
        cells.append(distance(row["largest"]))
    head = ["armor", "formula", "strongest, m/s", *(f"`{tier}`" for tier in tiers)]
    return table(head, [[*key, *cells] for key, cells in made.items()])


def hops(rows: list[Record]) -> list[str]:
    """Law and measured acceleration, period in ticks, and how far a hop's own account is off."""
    tiers = list(dict.fromkeys(row["tier"] for row in rows))
    made = []
    for row in rows:
        if row["tier"] != tiers[0]:
            continue
        alike = [r for r in rows if (r["slope"], r["keys"]) == (row["slope"], row["keys"])]
        law = row["law"]
        cells = [f"{law['acceleration']:.3f}", *(f"{r['acceleration']:.3f}" for r in alike)]
        dt = row["tick_ms"] / 1000.0
        cells += [f"{law['period'] / dt:.1f}", *(f"{r['period'] / dt:.1f}" for r in (alike[0], alike[-1]))]
        made.append([f"{row['slope']:g}", row["keys"], *cells, share(row)])
    names = [f"`{tier}`" for tier in tiers]
    head = ["slope", "keys", "law", *names, "hop by law, ticks", names[0], names[-1], "off by, % of 20 sin"]
    return table(head, made)


def share(row: Record) -> str:
    """How far the law is off, in per cent of gravity's share."""
    off = 100.0 * (row["acceleration"] - row["law"]["acceleration"]) / (20.0 * sin(radians(row["slope"])))
    return f"{off:+.1f}"


def limit(rows: list[Record]) -> list[str]:
    """Law and measured by length of the tick."""
    made = []
    for row in rows:
        law = row["law"]
        cells = [f"{x:.4f}" for x in (law["acceleration"], row["acceleration"], law["period"], row["period"])]
        made.append([f"{row['tick_ms']}", row["keys"], *cells, f"{row['hop_error']:.0e}"])
    return table(["ms", "keys", "law", "measured", "hop by law, s", "measured", "a hop's account, m/s"], made)


def bumps(rows: list[Record]) -> list[str]:
    """A line for each surface and tier, a column for each size of square."""
    sizes = sorted({row["square"] for row in rows}, reverse=True)
    made: dict[tuple[str, str, str], dict[float, Record]] = {}
    for row in rows:
        made.setdefault((row["surface"], row["ground"], row["tier"]), {})[row["square"]] = row
    lines = []
    for (surface, ground, tier), by in made.items():
        cells = [milli(by[size]["mean"]) for size in sizes]
        largest = by[sizes[0]]
        hung = " / ".join(f"{by[size]['hung']}" for size in sizes)
        cells = [milli(largest["theory"]), *cells, milli(largest["worst"]), hung]
        lines.append([surface, ground, f"`{tier}`", *cells])
    head = ["surface", "squares", "tier", f"theory, {sizes[0]:g} m", *(f"{size:g} m" for size in sizes)]
    return table([*head, f"worst, {sizes[0]:g} m", f"hung, of {rows[0]['slides']}"], lines)


def milli(value: float | None) -> str:
    """Thousandths, two decimals."""
    return "-" if value is None else f"{1000.0 * value:.2f}"


def ledger(figures: Record) -> list[str]:
    """The core's account."""
    rows = figures["rows"]
    names = list(rows[0]["terms"])
    made = [
        [
            row["run"],
            f"`{row['tier']}`",
            *(joules(row["terms"][name]) for name in names),
            joules(row["change"]),
            f"{row['unexplained']:.0e}",
        ]
        for row in rows
    ]
    return table(["run", "tier", *names, "change", "unexplained, most"], made)


def joules(value: float) -> str:
    """Whole ones; what is less than half of one to one digit."""
    return f"{value:.0f}" if value == 0.0 or abs(value) >= 0.5 else f"{value:.0e}"
