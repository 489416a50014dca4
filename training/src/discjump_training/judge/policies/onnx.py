"""Models in ONNX files: one input, observations; an output with actions, or with logits of every bin."""

import json
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from discjump_training.episodes import Stage
from discjump_training.errors import ModelError
from discjump_training.judge.policies.candidate import Candidate, digest_of
from discjump_training.policy import Actions, Mask, Observations

#: Entry of the file's metadata that says what `discjump train` knows of the model, as JSON.
ABOUT = "discjump_training"


def candidate(path: Path, name: str, task: str) -> Candidate:
    """The model in a file.

    Raises:
        ModelError: onnxruntime is not installed, the file is missing or damaged, or of another task.
    """
    session = opened(path)
    about: dict[str, Any] = {}
    try:
        about = json.loads(session.get_modelmeta().custom_metadata_map.get(ABOUT, "{}"))
        needs = dict(about.get("environment", {}))
    except (ValueError, TypeError, AttributeError) as error:
        raise ModelError(f"{path}: its metadata {ABOUT} is not what discjump writes: {error}") from None
    if about.get("task", task) != task:
        raise ModelError(f"{path} was trained for the task {about['task']}, and is asked to play {task}")
    return Candidate(name, "onnx", lambda stage: Onnx(session, path, name, stage), needs, digest_of(path))


def opened(path: Path) -> Any:
    """A session of onnxruntime for the file, on one thread.

    Raises:
        ModelError: see `candidate`.
    """
    try:
        import onnxruntime
    except ImportError:
        raise ModelError(
            f"{path} needs onnxruntime, which is not installed: pip install 'discjump-training[onnx]'"
        ) from None
    if not path.is_file():
        raise ModelError(f"no model file at {path}")
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.log_severity_level = 4
    try:
        return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    # Its exceptions have no common base but Exception.
    except Exception as error:
        first = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise ModelError(f"{path} is not a readable ONNX model: {first}") from None


class Onnx:
    """What an ONNX model does.

    Args:
        session: of onnxruntime.
        path: of its file, for messages.
        name: in tables.
        stage: where it will play.

    Raises:
        ModelError: its inputs or outputs do not fit the environment.
    """

    note = "greedy"

    def __init__(self, session: Any, path: Path, name: str, stage: Stage) -> None:
        self.name = name
        self._session = session
        self._path = path
        space = stage.env.single_action_space
        self._bins = space.nvec if isinstance(space, gymnasium.spaces.MultiDiscrete) else None
        self._width = int(np.prod(space.shape or ()))
        inputs = session.get_inputs()
        size = int(np.prod(stage.env.single_observation_space.shape or ()))
        if len(inputs) != 1 or len(inputs[0].shape) != 2:
            told = ", ".join(f"{one.name} {one.shape}" for one in inputs)
            raise ModelError(f"{path}: expected one input of shape (n, {size}), the model has {told}")
        if isinstance(inputs[0].shape[1], int) and inputs[0].shape[1] != size:
            raise ModelError(
                f"{path} takes observations of {inputs[0].shape[1]} numbers, "
                f"but the environment's have {size}"
            )
        self._input = inputs[0].name
        self._batch: int | None = inputs[0].shape[0] if isinstance(inputs[0].shape[0], int) else None
        self._type = np.float64 if inputs[0].type == "tensor(double)" else np.float32
        self._output: str | None = None

    def reset(self, done: Mask) -> None:
        """Nothing is remembered."""

    def __call__(self, observations: Observations) -> Actions:
        """Actions for a batch of observations."""
        given = observations.astype(self._type)
        if self._batch is None or self._batch == len(given):
            return self._actions(self._run(given))
        # An export with a fixed batch takes so many at a time; what is missing is filled with zeros.
        missing = -len(given) % self._batch
        padded = np.concatenate([given, np.zeros((missing, given.shape[1]), given.dtype)])
        pieces = [self._run(piece) for piece in np.split(padded, len(padded) // self._batch)]
        return self._actions(np.concatenate(pieces)[: len(given)])

    def _run(self, given: NDArray[Any]) -> NDArray[Any]:
        try:
            names = [one.name for one in self._session.get_outputs()]
            outputs = dict(zip(names, self._session.run(names, {self._input: given}), strict=True))
        except Exception as error:
            raise ModelError(f"{self._path} fails at an observation: {str(error).splitlines()[0]}") from None
        if self._output is None:
            self._output = self._chosen(outputs)
        return np.asarray(outputs[self._output])

    def _chosen(self, outputs: dict[str, Any]) -> str:
        """The output that holds actions, else the one with logits."""
        logits = None if self._bins is None else int(self._bins.sum())
        for width in (self._width, logits):
            for name, value in outputs.items():
                if np.ndim(value) == 2 and np.shape(value)[1] == width:
                    return name
        told = ", ".join(f"{name} {np.shape(value)}" for name, value in outputs.items())
        wanted = f"actions (n, {self._width})" + (f" or logits (n, {logits})" if logits else "")
        raise ModelError(f"{self._path}: expected an output of {wanted}, the model has {told}")

    def _actions(self, output: NDArray[Any]) -> Actions:
        if self._bins is None:
            return np.asarray(np.clip(output, -1.0, 1.0), np.float32)
        if output.shape[1] == self._width:
            return np.asarray(np.rint(output), np.int64)
        ends = np.cumsum(self._bins)[:-1]
        return np.stack([np.argmax(part, axis=1) for part in np.split(output, ends, axis=1)], axis=1)
