"""Numbers, vectors and keys as text, to the last bit."""

import numpy as np
from numpy.typing import NDArray


def described(inputs: NDArray[np.void] | np.void) -> str:
    """The keys of a tick."""
    return ", ".join(f"{name} {shown(inputs[name])}" for name in inputs.dtype.names or ())


def shown(value: object) -> str:
    """A number or a vector, to the last bit."""
    array = np.asarray(value)
    if array.ndim:
        return f"({', '.join(shown(number) for number in array)})"
    return repr(array.item()) if array.dtype.kind != "f" else f"{array[()]!s}"
