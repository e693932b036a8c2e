"""A picture: numbers, what is known of its error, and files.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import ctypes
import os
from typing import Optional, Tuple, Union

import numpy as np

from . import _library as c
from ._errors import UsageError
from ._session import Session


class Image:
    """What Scene.render returns. It is independent of the scene, which may change or be closed.

    pixels    float32 (height, width, 3): red, green, blue in linear light, not clamped, row 0 at the top
    alpha     float32 (height, width), 1 where shapes hide the background; None unless rendered with alpha=True.
              The light of `pixels` is multiplied with it
    planes    {name: array} of the planes that Scene.render was asked for: float32 `error`, `depth` and uint32 `samples`,
              `object` of (height, width), float32 `normal` and `albedo` of (height, width, 3)
    samples   rays a pixel, in the mean
    rmse      estimated root mean square error of `pixels` against the converged picture, None if it is not known
    interval  (low, high) that holds it with 95 % confidence, None likewise
    end       why sampling ended: "done", "target", "time" or "interrupted"
    seconds   {"prepare": ..., "trace": ...}: for the tree and what else is prepared, and for the rays
    built     {"trees": ..., "refits": ...}: how many trees all pictures of the scene took until then, and how often that
              of the spheres stayed and was made to fit
    """

    def __init__(self, pixels: np.ndarray, alpha: Optional[np.ndarray] = None, samples: float = 1.0,
                 rmse: Optional[float] = None, interval: Optional[Tuple[float, float]] = None, end: str = "done",
                 seconds: Optional[dict] = None, planes: Optional[dict] = None, built: Optional[dict] = None):
        self.pixels, self.alpha, self.samples, self.planes = pixels, alpha, samples, planes or {}
        self.rmse, self.interval, self.end, self.seconds = rmse, interval, end, seconds or {}
        self.built = built or {}

    @property
    def width(self) -> int:
        return self.pixels.shape[1]

    @property
    def height(self) -> int:
        return self.pixels.shape[0]

    def __repr__(self) -> str:
        error = "" if self.rmse is None else f", rmse {self.rmse:.2g}"
        return f"<rtlang.Image {self.width} x {self.height}, {self.samples:g} samples a pixel{error}>"

    def _session(self) -> Session:
        """A session that holds this picture."""
        pixels = np.ascontiguousarray(self.pixels, np.float32)
        if pixels.ndim != 3 or pixels.shape[2] != 3:
            raise UsageError(f"pixels must have the shape (height, width, 3), not {self.pixels.shape}")
        clear = None
        if self.alpha is not None:
            clear = np.ascontiguousarray(np.float32(1) - self.alpha, np.float32)
            if clear.shape != pixels.shape[:2]:
                raise UsageError(f"alpha must have the shape {pixels.shape[:2]}, not {clear.shape}")
        session = Session()
        session.call("rt_set_pixels", self.width, self.height, pixels.ctypes.data,
                     None if clear is None else clear.ctypes.data)
        return session

    def to_array(self, dtype: Union[str, type] = np.uint8, gamma: Optional[float] = None) -> np.ndarray:
        """The picture encoded as in a file: (height, width, 3), or 4 with alpha; colors not multiplied with it.

        dtype  uint8 or uint16, clamped and rounded; float32, linear and unclamped
        gamma  None: sRGB; else the power, 1 for linear values
        """
        dtype = np.dtype(dtype)
        if dtype not in (np.uint8, np.uint16, np.float32):
            raise UsageError(f"dtype must be uint8, uint16 or float32, not {dtype}")
        out = np.empty((self.height, self.width, 3 if self.alpha is None else 4), dtype)
        with self._session() as session:
            output = c.Output(8 * dtype.itemsize, gamma or 0.0, 0)
            session.call("rt_get_pixels", ctypes.byref(output), out.ctypes.data, out.nbytes)
        return out

    def png(self, depth: int = 8) -> bytes:
        """The bytes of a PNG file of 8 or 16 bits, in sRGB."""
        data, size = ctypes.POINTER(ctypes.c_ubyte)(), ctypes.c_size_t()
        with self._session() as session:
            session.call("rt_get_png", ctypes.byref(c.Output(depth, 0.0, 0)), ctypes.byref(data), ctypes.byref(size))
            return ctypes.string_at(data, size.value)

    def save(self, path: Union[str, "os.PathLike[str]"], depth: Optional[int] = None) -> None:
        """Writes a file whole or not at all; the format by the ending of its name (PNG, EXR, PPM, Targa;
        others need OpenImageIO, which a wheel does not have).

        depth  8, 16, or 32 for float; None: what suits the format
        """
        with self._session() as session:
            session.call("rt_write", os.fsencode(path), ctypes.byref(c.Output(depth or 0, 0.0, 0)))

    def _repr_png_(self) -> bytes:
        """A notebook shows it."""
        return self.png()
