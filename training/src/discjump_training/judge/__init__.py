"""Judges policies on the fixed episodes of a course: who reaches the goal, how fast, and by how much one is
better.

    page          the HTML report
    leaderboard   rows are replays, each played again before it is shown
    tables        for the terminal and Markdown; results: JSON
    evaluation    all that follows from what was played
    compare       pair by pair; planner: beside a planner's scores
    failures      by cause
    play          plays a course, a stretch at a time; pieces: what goes on after Ctrl-C
    judged        what a policy did, and its figures
    statistics    SciPy's bootstrap and tests
    policies      what a policy can be
    conditions    the course, and what was changed about it

Arrows point down only, to `episodes` and `courses`. From Python:

>>> from discjump_training.courses import course_of
>>> from discjump_training.judge import Conditions, Entrant, evaluation, from_function, judge
>>> def ahead(observation):
...     return [2, 1, 1, 0, 3]
>>> conditions = Conditions(course_of("ski", "validation"), 2, {"time_limit": 1.0}, threads=1)
>>> made = evaluation(conditions, judge([Entrant("ahead", (from_function(ahead),))], conditions))
>>> made.figures[0]["seconds"].value
1.0
"""

from discjump_training.judge.conditions import Conditions
from discjump_training.judge.evaluation import Evaluation, evaluation
from discjump_training.judge.judged import Judged
from discjump_training.judge.play import BrokenOff, Keep, judge
from discjump_training.judge.policies import Candidate, Entrant, entrants, find, from_function

__all__ = [
    "BrokenOff",
    "Candidate",
    "Conditions",
    "Entrant",
    "Evaluation",
    "Judged",
    "Keep",
    "entrants",
    "evaluation",
    "find",
    "from_function",
    "judge",
]
