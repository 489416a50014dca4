"""Finished pieces of work on disk, each under the hash of all it depends on.

A piece is written whole or not at all, so a run that was interrupted anywhere goes on behind its last
piece, and a change of an option, a version or the measuring code remakes what depends on it and no more.
"""

import hashlib
import inspect
import json
import shutil
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

import discjump
from discjump import _native
from discjump_training.files import write_atomically


class Missing(Exception):
    """A piece that a frozen store does not have."""


class Store:
    """Pieces of work, in `pieces/` of a folder.

    Args:
        folder: of the whole measurement; made when the first piece is written.
        frozen: nothing is made any more: a piece that is not there raises `Missing`.
    """

    def __init__(self, folder: Path, *, frozen: bool = False) -> None:
        self.folder = folder
        self.frozen = frozen

    @property
    def pieces(self) -> Path:
        """A folder for each section."""
        return self.folder / "pieces"

    def piece(self, section: str, identity: Mapping[str, Any], make: Callable[[], Any]) -> Any:
        """What `make` returns, from disk if it was made before.

        Args:
            section: folder of the piece.
            identity: JSON-able, all that the result depends on.
            make: does the work; what it returns must be JSON-able, and is returned as JSON gives it back.

        Raises:
            Missing: it is not there, and the store is frozen.
        """
        text = json.dumps(identity, sort_keys=True)
        name = hashlib.blake2b(text.encode(), digest_size=16).hexdigest()
        path = self.pieces / section / f"{name}.json"
        found = _read(path)
        if isinstance(found, dict) and found.get("identity") == json.loads(text):
            return found["made"]
        if self.frozen:
            raise Missing(f"{section}: {path} was not made yet")
        content = json.dumps({"identity": json.loads(text), "made": make()}, allow_nan=False)
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, content.encode())
        return json.loads(content)["made"]

    def forget(self, section: str) -> None:
        """Remove all pieces of a section."""
        shutil.rmtree(self.pieces / section, ignore_errors=True)


def _read(path: Path) -> Any:
    """The content of a JSON file; None if there is none, or it is damaged."""
    try:
        return json.loads(path.read_bytes())
    except (OSError, ValueError):
        return None


@cache
def build() -> dict[str, str]:
    """The physics that results depend on: version, and a digest of the native library's bytes."""
    library = inspect.getfile(_native)
    return {
        "discjump": discjump.__version__,
        "library": _digest(Path(library).read_bytes()),
        "numpy": np.__version__,
    }


def code(*sources: ModuleType | str) -> str:
    """A digest of what makes a result: modules, all Python and TOML of packages, or a `__file__`."""
    files: set[Path] = set()
    for source in sources:
        path = Path(source if isinstance(source, str) else inspect.getfile(source))
        files |= set(path.parent.rglob("*.*")) if path.name == "__init__.py" else {path}
    read = sorted(path for path in files if path.suffix in (".py", ".toml"))
    return _digest(b"".join(path.read_bytes() for path in read))


def _digest(content: bytes) -> str:
    return hashlib.blake2b(content, digest_size=8).hexdigest()
