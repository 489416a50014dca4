"""The installed package is the one of this tree."""

import tomllib
from importlib.metadata import version
from pathlib import Path

import discjump

ROOT = Path(__file__).resolve().parent.parent


def test_version_is_that_of_the_workspace():
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    assert discjump.__version__ == version("discjump") == workspace


def test_native_module_is_compiled():
    from discjump import _native

    assert _native.__file__ is not None
    assert Path(_native.__file__).suffix in {".so", ".pyd"}
