"""Policies for others: ONNX, with a card that says where the numbers come from.

The exported graph takes observations (n, size) float32, as the environment of the card's options gives them,
and has two outputs: `action`, the likeliest one, as `PPO.predict(..., deterministic=True)` returns it; and
`logits` (n, sum of the bins) float32 to draw from, bin after bin of each action (of a joint policy first
the 36 choices of keys, see `joint.JointKeys.decode`), or `mean` (n, actions) float32 before it is clipped,
where actions are numbers. The file's metadata `discjump_training` holds what the model file knows about
itself (task, options of the environment, seed, steps, recipe), as JSON.
"""

import json
from pathlib import Path
from typing import Any, cast

import torch
from gymnasium import spaces
from stable_baselines3 import PPO
from stable_baselines3.common.distributions import MultiCategoricalDistribution
from stable_baselines3.common.policies import ActorCriticPolicy
from torch import Tensor, nn

from discjump_training.errors import ModelError, TrainingError
from discjump_training.files import write_atomically
from discjump_training.joint import likeliest

OPSET = 18
#: Entry of the file's metadata.
METADATA = "discjump_training"


class Actor(nn.Module):
    """The half of a policy that acts.

    Args:
        policy: of observations that are vectors, and actions in bins or numbers.

    Raises:
        ModelError: for any other policy.
    """

    def __init__(self, policy: ActorCriticPolicy) -> None:
        super().__init__()
        action = policy.action_space
        vector = isinstance(policy.observation_space, spaces.Box) and len(policy.observation_space.shape) == 1
        if not vector or not isinstance(action, spaces.MultiDiscrete | spaces.Box):
            raise ModelError(
                "expected a policy of vectors with actions in bins or numbers, got one of "
                f"{policy.observation_space} and {action}"
            )
        self.hidden = policy.mlp_extractor.policy_net
        self.head = cast(nn.Linear, policy.action_net)
        self.choices = (
            policy.action_dist if isinstance(policy.action_dist, MultiCategoricalDistribution) else None
        )
        if isinstance(action, spaces.Box):
            self.register_buffer("low", torch.as_tensor(action.low))
            self.register_buffer("high", torch.as_tensor(action.high))

    @property
    def outputs(self) -> tuple[str, str]:
        """Names of the outputs."""
        return ("action", "mean" if self.choices is None else "logits")

    def forward(self, observation: Tensor) -> tuple[Tensor, Tensor]:
        """(action, logits) or (action, mean)."""
        said = self.head(self.hidden(observation))
        if self.choices is None:
            low, high = cast(Tensor, self.low), cast(Tensor, self.high)
            return torch.minimum(torch.maximum(said, low), high), said
        return likeliest(self.choices, said), said


def to_onnx(ppo: PPO, path: Path, about: dict[str, Any]) -> None:
    """Write the acting half of a model to an ONNX file, whole or not at all; any number of rows goes in.

    Raises:
        ModelError: if the policy is of a kind that cannot be exported.
        TrainingError: if the packages that write ONNX are missing.
    """
    actor = Actor(ppo.policy).eval()
    size = int(ppo.observation_space.shape[0])  # type: ignore[index]
    try:
        program = torch.onnx.export(
            actor,
            (torch.zeros(2, size),),
            input_names=["observation"],
            output_names=list(actor.outputs),
            dynamic_shapes={"observation": {0: torch.export.Dim("n")}},
            opset_version=OPSET,
            dynamo=True,
            verbose=False,
        )
    except ImportError as error:
        raise TrainingError(f"export to ONNX needs {error.name}: pip install onnx onnxscript") from error
    assert program is not None
    # The exporter notes at each node which lines of source it came from: paths of this machine.
    for part in (program.model.graph, *program.model.graph, *program.model.functions.values()):
        part.metadata_props.clear()
        part.doc_string = None
    program.model.metadata_props[METADATA] = json.dumps(about)
    write_atomically(path, program.model_proto.SerializeToString())
