"""One plan for each of several episodes: draw, simulate, keep the best, draw again."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from discjump_training.planner.proposals import Draft, Elites, Proposal, Sequences
from discjump_training.planner.rollouts import Rollouts
from discjump_training.planner.settings import Settings
from discjump_training.policy import Observations


@dataclass
class Memory:
    """What is known of an episode's future.

    Attributes:
        seed: of its environment: with it the draws begin.
        decision: decisions that were played.
        elites: the best sequences of the last plan, from its first decision; None before the first plan.
        simulated: decisions that were simulated for it.
    """

    seed: int
    decision: int = 0
    elites: Elites | None = None
    simulated: int = 0
    predicted: float = field(default=float("nan"))
    """score of the best sequence of the last plan"""

    def advance(self, played: int) -> None:
        """That many decisions of the plan were played: shift the sequences, repeat their last actions."""
        self.decision += played
        if self.elites is not None:
            left = self.elites.actions[:, played:]
            tail = np.repeat(self.elites.actions[:, -1:], played, axis=1)
            self.elites = Elites(np.concatenate([left, tail], axis=1), self.elites.scores)


class Search:
    """Makes plans.

    Args:
        settings: how.
        rollouts: simulates.
        proposal: draws.
        bins: of the actions' components.
        length: of a sequence, decisions.
        guided: whether a guide completes sequences.
    """

    def __init__(
        self,
        settings: Settings,
        rollouts: Rollouts,
        proposal: Proposal,
        bins: NDArray[np.int64],
        length: int,
        guided: bool,
    ) -> None:
        self._settings = settings
        self._rollouts = rollouts
        self._proposal = proposal
        self._bins = bins
        self._length = length
        self._guided = max(2, round(settings.guided * settings.candidates)) if guided else 0

    def plan(
        self, memories: list[Memory], snapshots: list[bytes], observations: Observations
    ) -> list[Sequences]:
        """The best sequence (decisions, components) for each episode; all must have played equally many
        decisions.

        Args:
            memories: of the episodes; they remember the plan.
            snapshots: of their real states.
            observations: of these, (episodes, size).
        """
        s = self._settings
        self._rollouts.place(snapshots, observations)
        generators = [np.random.default_rng([s.seed, memory.seed, memory.decision]) for memory in memories]
        first = memories[0].elites is None
        for iteration in range(s.iterations * (s.warm_up if first else 1)):
            drafts = [
                self._draft(rng, memory, iteration == 0)
                for rng, memory in zip(generators, memories, strict=True)
            ]
            scores, simulated = self._rollouts.run(drafts)
            for memory, draft, row, count in zip(memories, drafts, scores, simulated, strict=True):
                memory.elites = self._best(memory.elites if iteration else None, draft, row)
                memory.simulated += int(count)
        for memory in memories:
            assert memory.elites is not None
            memory.predicted = float(memory.elites.scores[0])
        return [memory.elites.actions[0] for memory in memories if memory.elites is not None]

    def _draft(self, rng: np.random.Generator, memory: Memory, fresh: bool) -> Draft:
        s = self._settings
        elites = memory.elites or Elites(
            # The middle of each component: no key that moves, all others held.
            np.broadcast_to((self._bins // 2).astype(np.int8), (1, self._length, self._bins.size)),
            np.full(1, -np.inf),
        )
        draft = self._proposal.draw(rng, elites, s.candidates, self._guided, fresh)
        if fresh:
            # The best of the last plan go on; what came into sight is the guide's.
            kept = elites.actions[: max(1, (self._guided or s.candidates) // 4)]
            draft.actions[: len(kept)] = kept
            if self._guided:
                draft.guided[: len(kept)] = (np.arange(self._length) >= self._length - s.commit)[:, None]
                draft.guided[len(kept)] = True
        return draft

    def _best(self, elites: Elites | None, draft: Draft, scores: NDArray[np.float64]) -> Elites:
        """The best of both; of equal ones, which mostly are the same, only one."""
        actions = draft.actions
        if elites is not None:
            actions = np.concatenate([elites.actions, actions])
            scores = np.concatenate([elites.scores, scores])
        order = np.argsort(-scores, kind="stable")
        ranked = scores[order]
        new = np.concatenate([[True], ranked[1:] != ranked[:-1]])
        chosen = order[new][: self._settings.elites]
        return Elites(actions[chosen], scores[chosen])
