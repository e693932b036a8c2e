"""Looks: light, finish, lines and background that suit molecules and particles, in one word.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import NamedTuple, Optional, Tuple

import numpy as np

from ._errors import UsageError


class Look(NamedTuple):
    """What a Scene takes where nothing else is said."""
    finish: str
    sky: float
    key: float                  # of the soft light over the viewer's left shoulder; 0: none
    outline: float              # in thousandths of the picture's height; 0: none
    depth_cue: float
    background: Optional[Tuple[float, float, float]]  # None: clear
    samples: int


LOOKS = {
    "publication": Look("ambient 0 diffuse 0.85", 0.75, 0.45, 2.5, 0.0, None, 64),
    "soft": Look("ambient 0 diffuse 0.85 specular 0.15 roughness 0.05", 0.7, 0.5, 0.0, 0.0, (1.0, 1.0, 1.0), 64),
    "deep": Look("ambient 0 diffuse 0.9", 0.8, 0.4, 0.0, 0.75, (0.006, 0.008, 0.014), 64),
}


def look_of(look) -> Optional[Look]:
    """One by its name, or one of the caller's."""
    if look is None or isinstance(look, Look):
        return look
    if look not in LOOKS:
        raise UsageError(f"there is no look {look!r}", suggestion=f"one of {', '.join(LOOKS)}, or a rtlang.Look")
    return LOOKS[look]


def key_light(camera, low, high) -> Tuple[np.ndarray, float]:
    """Where the soft light of a look stands, for a camera and the box around what it sees, and its radius."""
    location, look_at, up = (np.array(getattr(camera, name)) for name in ("location", "look_at", "up"))
    ahead = look_at - location
    ahead = ahead / (np.linalg.norm(ahead) or 1.0)
    side = np.cross(ahead, up if np.any(up) else (0.0, 1.0, 0.0))
    side = side / (np.linalg.norm(side) or 1.0) * (1.0 if camera.right_handed else -1.0)
    distance = 3.0 * max(float(np.linalg.norm(high - low)), 1e-300)
    towards = -ahead + 0.9 * np.cross(side, ahead) * (1.0 if camera.right_handed else -1.0) - 0.7 * side
    return (low + high) / 2 + distance * towards / np.linalg.norm(towards), 0.25 * distance
