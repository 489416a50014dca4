"""The movement of Tribes 1 (skiing, jetting, disc jumping), batched for reinforcement learning."""

from importlib.metadata import version

from discjump import _native as _native

__version__ = version("discjump")

__all__ = ["__version__"]
