"""What commands that publish figures share: JSON files, and the machine and versions they name."""

import json
import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import click


def save(path: Path, figures: dict[str, Any]) -> None:
    """Write figures as JSON: whole, or not at all where the command is stopped in the middle."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(f"{path.name}.new")
    fresh.write_text(json.dumps(figures, indent=1) + "\n")
    fresh.replace(path)


def machine() -> dict[str, Any]:
    """The machine that figures were made on: processor, cores, version of Python."""
    return {"processor": _processor(), "cores": os.cpu_count(), "python": platform.python_version()}


def versions(*packages: str) -> dict[str, str]:
    """Versions of those of the packages that are installed.

    >>> sorted(versions("numpy", "no-such-package"))
    ['numpy']
    """
    found = {}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found


def require_matplotlib(command: str) -> None:
    """Fail before the long work, not after it, where the picture cannot be drawn.

    Raises:
        click.ClickException: matplotlib is not installed; says how to install it.
    """
    try:
        import matplotlib.figure  # noqa: F401
    except ImportError as error:
        raise click.ClickException(
            f"{command} needs the package matplotlib, which is not installed ({error}): "
            "pip install matplotlib"
        ) from error


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor()
