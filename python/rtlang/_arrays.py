"""numpy arrays as the library reads them: in place where they hold float64 or float32, whatever their strides.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import numpy as np

from . import _library as c
from ._errors import UsageError


def numbers(name, value, shape):
    """An array of float64 or float32 whose shape is `shape`, where None is any length and a leading 1 may be left out.

    Integers are converted; anything else is refused.
    """
    array = value if isinstance(value, np.ndarray) else _made(name, value)
    if array.dtype.kind in "iu":
        array = array.astype(np.float64)
    if array.dtype not in (np.float64, np.float32) or not array.dtype.isnative:
        raise UsageError(f"{name} must be numbers (float64, float32 or integers), not {array.dtype}")
    if not fits(array.shape, shape):
        wanted = " or ".join(_shape_text(s) for s in (shape, shape[1:]))
        raise UsageError(f"{name} must have the shape {wanted}, not {_shape_text(array.shape)}")
    return array


def _made(name, value):
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as fault:
        raise UsageError(f"{name} cannot be made an array: {fault}") from None


def fits(found, wanted):
    """Whether an array of this shape holds one element each, or one for all."""
    return any(len(found) == len(shape) and all(w in (None, f) for f, w in zip(found, shape))
               for shape in (wanted, wanted[1:]))


def _shape_text(shape):
    inner = ", ".join("n" if side is None else str(side) for side in shape)
    return f"({inner},)" if len(shape) == 1 else f"({inner})"


def count_of(arrays):
    """How many elements arrays of (name, array, numbers an element) have together; one for all counts as any number."""
    count, first = None, None
    for name, array, inner in arrays:
        if array is None or array.ndim < inner + 1:
            continue
        if count is None:
            count, first = len(array), name
        elif len(array) != count:
            raise UsageError(f"{name} has {len(array)} elements, and {first} has {count}")
    return 1 if count is None else count


def pass_on(array, inner):
    """The struct for the library. `array` must live as long as the call; its inner axes are one run of numbers."""
    if array is None:
        return c.Array(None, 0, 0, 0)
    kind = c.FLOAT32 if array.dtype == np.float32 else c.FLOAT64
    stride = array.strides[0] if array.ndim == inner + 1 else 0
    step = array.strides[-1] if inner > 0 else 0
    return c.Array(array.ctypes.data, kind, stride, step)


def rows(array):
    """Points of points, (n, 3, 3), as (n, 9): a view where the strides allow it, else a copy."""
    return array.reshape(array.shape[:-2] + (9,))


def colors_of(name, value):
    """(array, numbers an element): red, green, blue, of linear light; with alpha, red, green, blue, transmit."""
    if value is None:
        return None, 3
    array = _made(name, value)
    if array.ndim == 0 or array.shape[-1] not in (3, 4):
        raise UsageError(f"{name} must have the shape (n, 3), (3,), (n, 4) or (4,), not {_shape_text(array.shape)}",
                         suggestion="red, green, blue, and alpha or not; of values, rtlang.colormap makes colors")
    array = numbers(name, array, (None, array.shape[-1]))
    if array.shape[-1] == 3:
        return array, 3
    if np.all(array[..., 3] == 1):
        return array[..., :3], 3
    array = array.copy()
    array[..., 3] = 1 - array[..., 3]
    return array, 4
