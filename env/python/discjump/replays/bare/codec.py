"""Plain data as bytes: a header of JSON's types, then arrays of numbers. Reading them runs no code.

4 bytes   length of the header, little-endian
header    JSON, UTF-8; its key "arrays" lists name, dtype and shape of each array
arrays    one after the other, in C order
"""

import json
import math
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

Header = dict[str, Any]
Arrays = dict[str, NDArray[Any]]

_LENGTH = struct.Struct("<I")


def encode(header: Header, arrays: Arrays) -> bytes:
    """Bytes that `decode` takes; structured dtypes lose their padding.

    >>> decode(encode({"seed": 7}, {"heights": np.zeros((1, 2))}))
    ({'seed': 7}, {'heights': array([[0., 0.]])})
    """
    plain = {name: _plain(array) for name, array in arrays.items()}
    listed = [[name, _described(array.dtype), list(array.shape)] for name, array in plain.items()]
    text = json.dumps({**header, "arrays": listed}, separators=(",", ":"), allow_nan=False).encode()
    return b"".join([_LENGTH.pack(len(text)), text, *(array.tobytes() for array in plain.values())])


def decode(data: bytes) -> tuple[Header, Arrays]:
    """Header and arrays of what `encode` made.

    Raises:
        ValueError: anything else, in words.
    """
    if len(data) < _LENGTH.size:
        raise ValueError(f"expected a header, got {len(data)} bytes")
    (length,) = _LENGTH.unpack_from(data)
    at = _LENGTH.size + length
    if at > len(data):
        raise ValueError(f"expected a header of {length} bytes, got {len(data) - _LENGTH.size}")
    try:
        header = json.loads(data[_LENGTH.size : at].decode())
    except (ValueError, RecursionError) as error:
        raise ValueError(f"expected a header of JSON, got something else ({error})") from None
    if not isinstance(header, dict) or not isinstance(header.get("arrays"), list):
        raise ValueError("expected a header with a list of arrays, got something else")
    arrays: Arrays = {}
    for entry in header.pop("arrays"):
        name, dtype, shape = _read(entry)
        size = math.prod(shape) * dtype.itemsize
        if size > len(data) - at:
            raise ValueError(f"expected {size} bytes of the array {name!r}, got {len(data) - at}")
        arrays[name] = np.frombuffer(data[at : at + size], dtype).reshape(shape).copy()
        at += size
    if at != len(data):
        raise ValueError(f"expected nothing after the arrays, got {len(data) - at} bytes")
    return header, arrays


def _plain(array: NDArray[Any]) -> NDArray[Any]:
    """In C order, little-endian and without padding between fields."""
    names = array.dtype.names
    if names is None:
        return np.asarray(array, array.dtype.newbyteorder("<"), order="C")
    packed = np.dtype([(name, _field(array.dtype[name])) for name in names])
    out = np.empty(array.shape, packed)
    for name in names:
        out[name] = array[name]
    return out


def _field(dtype: np.dtype[Any]) -> Any:
    base, shape = (dtype, ()) if dtype.subdtype is None else dtype.subdtype
    return (base.newbyteorder("<"), shape)


def _described(dtype: np.dtype[Any]) -> Any:
    if dtype.names is None:
        return dtype.str
    return [[name, *_parts(dtype[name])] for name in dtype.names]


def _parts(dtype: np.dtype[Any]) -> list[Any]:
    base, shape = (dtype, ()) if dtype.subdtype is None else dtype.subdtype
    return [base.str, list(shape)]


def _read(entry: Any) -> tuple[str, np.dtype[Any], tuple[int, ...]]:
    try:
        name, described, shape = entry
        if isinstance(described, str):
            dtype = _number(described)
        else:
            dtype = np.dtype([(str(key), _number(base), _shape(inner)) for key, base, inner in described])
        return str(name), dtype, _shape(shape)
    except (TypeError, ValueError) as error:
        raise ValueError(f"expected name, dtype and shape of an array, got {entry!r:.80} ({error})") from None


def _number(text: Any) -> np.dtype[Any]:
    dtype = np.dtype(str(text))
    if dtype.kind not in "?biuf" or dtype.subdtype is not None:
        raise ValueError(f"{dtype} is no number")
    return dtype


def _shape(given: Any) -> tuple[int, ...]:
    shape = tuple(int(length) for length in given)
    if any(length < 0 for length in shape) or len(shape) > 4:
        raise ValueError(f"{shape} is no shape")
    return shape
