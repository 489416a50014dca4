"""What a policy can be, and how its name is read.

candidate   a policy that is not on stage yet
find        from a name to a candidate; groups of them
sb3         models of stable-baselines3
onnx        models in ONNX files
function    Python callables
tape        replays, whose actions are played again
noise       any of them with noise on its observations
"""

from discjump_training.judge.policies.candidate import Candidate
from discjump_training.judge.policies.find import Entrant, entrants, find
from discjump_training.judge.policies.function import from_function

__all__ = ["Candidate", "Entrant", "entrants", "find", "from_function"]
