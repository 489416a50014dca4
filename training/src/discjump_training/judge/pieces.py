"""What was played so far, so that an evaluation that is broken off can go on."""

import hashlib
import io
import json
import shutil
from dataclasses import fields
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

import discjump
from discjump_training.episodes import Episodes
from discjump_training.files import write_atomically

#: Folder within that of the results.
FOLDER = ".unfinished"


class Pieces:
    """Stretches of episodes that were played, in files.

    Args:
        folder: of the results.
        resume: take what is there; else it is removed.
    """

    def __init__(self, folder: Path, *, resume: bool) -> None:
        self._folder = folder / FOLDER
        if not resume:
            self.clear()

    def key(self, **identity: Any) -> str:
        """A name for what is described: all that the result depends on."""
        text = json.dumps({**identity, "release": discjump.__version__}, sort_keys=True, default=str)
        return hashlib.blake2b(text.encode(), digest_size=12).hexdigest()

    def get(self, key: str, rows: range) -> tuple[Episodes, dict[int, Path]] | None:
        """What was played of these rows, and replays that were saved; None where nothing whole is there."""
        try:
            with np.load(self._path(key, rows)) as archive:
                arrays = {name: archive[name] for name in archive.files}
            saved = json.loads(str(arrays.pop("replays")))
        except (OSError, ValueError, KeyError, BadZipFile):
            return None
        replays = {int(row): Path(path) for row, path in saved.items()}
        if not all(path.is_file() for path in replays.values()):
            return None
        parts: dict[str, Any] = {"paths": {}, "extra": {}}
        columns: dict[str, Any] = {}
        for name, value in arrays.items():
            kind, _, item = name.partition("/")
            if kind in parts:
                parts[kind][int(item) if kind == "paths" else item] = value
            else:
                columns[name] = value
        return Episodes(**columns, **parts), replays

    def put(self, key: str, rows: range, played: Episodes, replays: dict[int, Path]) -> None:
        """Keep what was played of these rows."""
        arrays: dict[str, Any] = {
            "replays": np.array(json.dumps({str(row): str(path) for row, path in replays.items()}))
        }
        for one in fields(played):
            value = getattr(played, one.name)
            if isinstance(value, dict):
                arrays |= {f"{one.name}/{item}": array for item, array in value.items()}
            else:
                arrays[one.name] = value
        self._folder.mkdir(parents=True, exist_ok=True)
        buffer = io.BytesIO()
        np.savez(buffer, **arrays)
        write_atomically(self._path(key, rows), buffer.getvalue())

    def clear(self) -> None:
        """Remove all."""
        if self._folder.is_dir():
            shutil.rmtree(self._folder)

    def _path(self, key: str, rows: range) -> Path:
        return self._folder / f"{key}-{rows.start}-{rows.stop}.npz"
