"""What replays raise."""


class ReplayError(ValueError):
    """A replay that cannot be read, or cannot be played here; the message says why."""
