"""A player alone in a world, with a launcher: section 12's order of a tick."""

from dataclasses import dataclass, field, replace

from .article import Keys, Player, Rules, turned
from .disc import Launcher, Shooter, after_move, fire
from .ground import Surface, Vec
from .models import tick


@dataclass
class World:
    player: Player
    ground: Surface
    rules: Rules = field(default_factory=Rules)
    launcher: Launcher = field(default_factory=Launcher)
    model: str = "sliced"
    shooter: Shooter = field(default_factory=Shooter)

    def step(self, keys: Keys, pitch: float = 0.0, trigger: bool = False) -> list[Vec]:
        """One tick; where discs burst in it."""
        self.player.yaw = turned(self.player.yaw, keys.turn, self.rules.tick_ms / 1000.0)
        if trigger:
            fire(self.player, pitch, self.shooter, self.launcher)
        tick(self.model, self.player, replace(keys, turn=0.0), self.ground, self.rules)
        return after_move(self.player, self.shooter, self.ground, self.launcher, self.rules.armor)
