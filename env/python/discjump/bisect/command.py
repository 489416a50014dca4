"""The command `discjump bisect`."""

import shlex
from pathlib import Path
from typing import Any

import click

from discjump._options import FiniteRange
from discjump._results import save
from discjump.bisect import report
from discjump.bisect.certificates import Certificates
from discjump.bisect.contacts import contact_list
from discjump.bisect.lockstep import Outcome
from discjump.bisect.lockstep import bisect as run
from discjump.bisect.sides import Side, SideError
from discjump.bisect.start import changes, starting
from discjump.replays import ReplayError

OUT = Path("runs/bisect")


@click.command()
@click.argument("a", metavar="A")
@click.argument("b", metavar="B")
@click.option(
    "--tolerance",
    type=FiniteRange(0.0, 1e9),
    default=0.0,
    show_default=True,
    metavar="METRES",
    help="Stop where positions are farther apart than this; 0: at the first bit of anything.",
)
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=OUT,
    show_default=True,
    help="Directory for the finding (bisect.json) and the replay that starts there (bisect.replay).",
)
def bisect(a: str, b: str, tolerance: float, out: Path) -> None:
    """Find the first tick after which two runs differ.

    A and B are replays (from `discjump evaluate --replays`, `discjump.replays.record` or this command), each
    with what is changed in it: FILE,NAME=VALUE,... B may leave FILE out: then it is A's. What can be changed:

    \b
      fidelity=fast           any option of the environment or simulator:
                              armor, surface, physics.ski_bug, seed, episode ...
      threads=3 lanes=8       how it is played: must change no bit
      batch=64 index=17       the same among others, at a place
      python=OTHER/bin/python another installation plays it, of whatever release

    Examples:

    \b
      discjump bisect old.replay new.replay
      discjump bisect run.replay fidelity=fast
      discjump bisect run.replay fidelity=reference --tolerance 0.01
      discjump bisect run.replay threads=3,batch=4096,index=77
      discjump bisect run.replay python=/opt/old/bin/python

    Two certificates of `discjump verify` are compared digest by digest; with python=OTHER/bin/python after
    one of them, the episodes of the first id and tier that differ are run on both builds.

    Both sides play in lockstep, every tick, and every bit is compared: inputs, state, flags, and where a
    decision ends observation, reward and info. Exit status: 0 the same, 1 they part, 2 a side cannot be run.
    """
    try:
        certificates = Certificates.of(a, b)
        if certificates is not None:
            click.echo(certificates.text())
            if not certificates.differing() or certificates.pythons == (None, None):
                raise SystemExit(1 if certificates.differing() else 0)
        for sides in [pair(a, b)] if certificates is None else certificates.sides():
            outcome = run(*sides, tolerance=tolerance)
            if outcome.parting is not None:
                break
        figures = told(sides, outcome, tolerance, out)
        save(out / "bisect.json", figures)
    except BrokenPipeError:
        raise
    except (SideError, ReplayError, OSError) as error:
        click.echo(f"Error: {error}", err=True)
        raise SystemExit(2) from error
    raise SystemExit(0 if figures["same"] else 1)


def pair(a: str, b: str) -> tuple[Side, Side]:
    """The sides as they were typed."""
    one = Side.parsed(a)
    return one, Side.parsed(b, one)


def told(sides: tuple[Side, Side], outcome: Outcome, tolerance: float, out: Path) -> dict[str, Any]:
    """Print what was found, write the replay that starts there, and return the figures."""
    parting = outcome.parting
    contacts: report.Contacts = ([], []) if parting is None else contact_list(sides, parting)
    click.echo(report.text(sides, outcome, contacts))
    figures = report.as_json(sides, outcome, contacts)
    if parting is not None:
        made = starting(sides, parting)
        path = made.save(out / "bisect.replay")
        again = shlex.join(["discjump", "bisect", str(path), changes(sides, made)])
        figures |= {"replay": str(path), "command": again}
        click.echo(f"\nstarts there:  {path}\ngo on with:    {again}")
        if tolerance:
            click.echo("               (both from the state of the side that it was recorded of)")
    return figures
