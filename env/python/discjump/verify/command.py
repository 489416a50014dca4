"""The command `discjump verify`."""

import shlex
from pathlib import Path

import click

from discjump.simulator import FIDELITIES, SCENES
from discjump.verify import children, report
from discjump.verify.certificate import BadCertificate, Certificate, compare
from discjump.verify.form import FULL, QUICK
from discjump.verify.verification import subjects, verified, work

OUT = Path("runs/verify/certificate.json")


@click.command()
@click.option(
    "--quick", is_flag=True, help="Every axis, but not all crossed: under 20 seconds on 2 quiet cores."
)
@click.option("--ids", multiple=True, metavar="ID", help="An id; may be given several times. All if absent.")
@click.option(
    "--tiers",
    type=click.Choice(list(FIDELITIES)),
    multiple=True,
    help="A tier; may be given several times. All if absent.",
)
@click.option(
    "--scenes",
    type=click.Choice([*SCENES, "none"]),
    multiple=True,
    help="A scene of `Simulator`; may be given several times. All if absent.",
)
@click.option(
    "--processes",
    type=click.Choice([*children.METHODS, "none"]),
    multiple=True,
    help="How child processes are started; may be given several times. Each way if absent.",
)
@click.option(
    "--against",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Another certificate (another machine, another release, a golden one): fail where a digest differs.",
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False, path_type=Path),
    default=OUT,
    show_default=True,
    help="The certificate.",
)
def verify(
    quick: bool,
    ids: tuple[str, ...],
    tiers: tuple[str, ...],
    scenes: tuple[str, ...],
    processes: tuple[str, ...],
    against: Path | None,
    out: Path,
) -> None:
    """Prove that a rollout's bits depend on seeds and actions, and on nothing else.

    Every id in every tier, and every scene of `Simulator`, is played alone, one player at a time, on one
    thread. Then again in batches of 1, 3, 64 and 4,096, on 1, 2, 3 and 16 threads, in every lane width of the
    processor, at other indices, in forked, spawned and fork-server children, from snapshots, after resets in
    other orders, in every autoreset mode, and through gymnasium.make, gymnasium's own vector environment and
    stable-baselines3. State, observation, reward, flags and info of every decision must be the same bits.

    Writes a certificate, which another machine or release can be held to by --against. Fails where a row
    does, with the first number that differs.
    """
    theirs = None if against is None else loaded(against)
    words = [*(["--quick"] if quick else []), *_repeated("--ids", ids), *_repeated("--tiers", tiers)]
    words += [*_repeated("--scenes", scenes), *_repeated("--processes", processes)]
    try:
        chosen = subjects(ids or None, tiers or FIDELITIES, _given(scenes))
    except ValueError as error:
        raise click.BadParameter(str(error)) from error
    methods = _given(processes)
    ways = children.METHODS if methods is None else tuple(methods)
    with click.progressbar(length=work(chosen, ways), show_pos=True) as bar:

        def done(label: str) -> None:
            bar.label = f"{label[:40]:<40}"
            bar.update(1)

        certificate = verified(
            chosen, QUICK if quick else FULL, ways, shlex.join(["discjump", "verify", *words]), done
        )
    certificate.save(out)
    click.echo(report.summary(certificate))
    bad = bool(certificate.failed)
    if bad:
        click.echo(report.failures(certificate))
    if theirs is not None:
        found = compare(certificate, theirs)
        if ids or tiers or scenes:
            found = [one for one in found if one.verdict != "gone"]
        click.echo(report.comparison(certificate, theirs, found, str(against)))
        bad |= any(one.verdict != "equal" for one in found)
    click.echo(str(out))
    raise SystemExit(1 if bad else 0)


def loaded(path: Path) -> Certificate:
    """A certificate, before the long work."""
    try:
        return Certificate.load(path)
    except BadCertificate as error:
        raise click.ClickException(str(error)) from error


def _given(names: tuple[str, ...]) -> list[str] | None:
    """None: all of them; `none`: not one."""
    return [name for name in names if name != "none"] if names else None


def _repeated(option: str, values: tuple[str, ...]) -> list[str]:
    return [word for value in values for word in (option, value)]
