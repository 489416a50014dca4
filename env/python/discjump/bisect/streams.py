"""The frames of a side, from this installation or from a worker of another one."""

import os
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from discjump.bisect.sides import Side, SideError
from discjump.replays import bare
from discjump.replays.bare import play, worker

_BOOT = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("discjump_bare", sys.argv[1])
module = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = module
spec.loader.exec_module(module)
from discjump_bare.worker import main
main()
"""
"""Runs our player by itself, so that the other installation need not have it."""


class Stream:
    """A side being played.

    Attributes:
        installation: what plays it.
    """

    installation: dict[str, Any]

    def frames(self) -> Iterator[play.Frame]:
        """Its frames, the beginning first."""
        raise NotImplementedError

    def close(self) -> None:
        """Stop."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class Here(Stream):
    """Played by this installation."""

    def __init__(self, side: Side) -> None:
        self._side = side
        self.installation = worker.installation()

    def frames(self) -> Iterator[play.Frame]:
        """Its frames."""
        try:
            yield from play.frames(self._side.replay.header, self._side.replay.arrays, self._side.way)
        except (TypeError, ValueError) as error:
            raise SideError(f"{self._side.text}: {error}") from error


class Elsewhere(Stream):
    """Played by another interpreter, over pipes.

    It sees its own packages alone: `PYTHONPATH` is not handed on.

    Raises:
        SideError: it cannot be started, or has no discjump.
    """

    def __init__(self, side: Side) -> None:
        self._side = side
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115  closed by `close`
        boot = [str(side.python), "-P", "-c", _BOOT, str(Path(bare.__file__))]
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        try:
            self._process = subprocess.Popen(
                boot,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                env=environment,
            )
        except OSError as error:
            self._errors.close()
            raise SideError(f"{side.text}: python: expected an interpreter, got {error}") from None
        assert self._process.stdin is not None
        way = {name: getattr(side.way, name) for name in ("threads", "lanes", "batch", "index")}
        with suppress(BrokenPipeError):
            worker.send(self._process.stdin, {**side.replay.header, "way": way}, side.replay.arrays)
            self._process.stdin.close()
        self.installation = self._received()[0]["installation"]

    def frames(self) -> Iterator[play.Frame]:
        """Its frames."""
        while True:
            header, values = self._received()
            if "error" in header:
                raise SideError(f"{self._side.text}: {header['error']}")
            yield play.Frame(header["tick"], header["over"], values)
            if header["over"]:
                return

    def close(self) -> None:
        """Stop the worker."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout, self._errors):
            if pipe is not None:
                with suppress(BrokenPipeError):
                    pipe.close()

    def _received(self) -> tuple[Any, Any]:
        assert self._process.stdout is not None
        try:
            message = worker.receive(self._process.stdout)
        except ValueError as error:
            raise SideError(f"{self._side.text}: its worker does not speak our language: {error}") from None
        if message is None:
            code = self._process.wait()
            self._errors.seek(0)
            said = self._errors.read().decode(errors="replace").strip().splitlines()[-3:]
            raise SideError(f"{self._side.text}: its worker ended with status {code}: {' | '.join(said)}")
        return message


def opened(side: Side) -> Stream:
    """The stream of a side."""
    return Here(side) if side.python is None else Elsewhere(side)
