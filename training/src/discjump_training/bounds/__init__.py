"""What disc jumps reach, by exhaustive search: `python -m discjump_training.bounds apex` or `markers`.

__main__   the commands
report     their tables
reachable  which markers of a course were reached: data files that evaluations use
markers    which markers of a course can be reached: stages of schedules for each episode
tries      schedules for an episode, played in copies of it
apex       how high jump, jets and discs lead from rest on a plane
jumps      schedules for that, and how high each leads

Arrows point down only.
"""
