"""Colors: from sRGB to linear light, and of values along a map.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import Optional

import numpy as np

from ._errors import UsageError


def srgb(colors) -> np.ndarray:
    """Colors as screens and picture programs have them, 0 to 1 in sRGB, as the linear light that scenes take.

    (..., 3) or (..., 4), alpha staying as it is; integers of uint8 go from 0 to 255.
    """
    colors = np.asarray(colors)
    colors = colors / 255 if colors.dtype == np.uint8 else np.array(colors, np.float64)
    if colors.ndim == 0 or colors.shape[-1] not in (3, 4):
        raise UsageError(f"colors must have 3 or 4 numbers each, not the shape {colors.shape}")
    light = colors[..., :3]
    colors[..., :3] = np.where(light <= 0.04045, light / 12.92, ((np.maximum(light, 0) + 0.055) / 1.055) ** 2.4)
    return colors


def colormap(values, name: str = "viridis", low: Optional[float] = None, high: Optional[float] = None) -> np.ndarray:
    """Colors (n, 3), in linear light, of values (n,) along a map of matplotlib, from `low` to `high`.

    Without these, from the least to the greatest value. Raises ImportError where there is no matplotlib.
    """
    import matplotlib  # pylint: disable=import-outside-toplevel
    values = np.asarray(values, np.float64)
    low = np.min(values) if low is None else low
    high = np.max(values) if high is None else high
    share = (values - low) / (high - low) if high > low else np.zeros(values.shape)
    if hasattr(matplotlib, "colormaps"):
        chosen = matplotlib.colormaps[name]
    else:
        from matplotlib import cm  # pylint: disable=import-outside-toplevel
        chosen = cm.get_cmap(name)
    return srgb(chosen(np.clip(share, 0, 1)))[..., :3]
