"""A sampling planner whose model is the simulator itself: it shows what is possible at least.

    command     `discjump plan`
    sweep       many settings, one table (`python -m discjump_training.planner.sweep`)
    report      tables of what was planned
    play        plays the episodes of a course: `plan`
    store       the folder of results: partial ones are kept, finished ones not planned again
    planned     what came out, and (observation, action) pairs for imitation
    team        who takes part: guide, value and objective for a task
    search      one plan: draw, simulate, keep the best, draw again
    rollouts    simulates the candidates of many episodes in one batch
    proposals   where action sequences come from
    guides      models and scripts that complete sequences; value networks
    objectives  what is wanted, by task
    flight      where a flight with jets leads
    settings    how hard and how far

Arrows point down only: command, sweep -> report, play -> store, team, search -> planned, rollouts,
proposals -> guides, objectives -> flight, settings.

The model is exact: candidates begin at copies of the real states and are simulated with the same bits. What
is predicted within the horizon happens. A plan is a function of the settings, the course's episode and the
files of the models alone: neither threads, nor the episodes beside it, nor an interruption change a bit.
"""

from discjump_training.planner.planned import Cost, Outcome, Pairs, Planned
from discjump_training.planner.play import plan
from discjump_training.planner.settings import Settings

__all__ = ["Cost", "Outcome", "Pairs", "Planned", "Settings", "plan"]
