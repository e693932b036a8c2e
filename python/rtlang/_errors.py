"""What goes wrong, as exceptions and warnings that say what, where, and what to do instead.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import re


class Error(Exception):
    """A fault. `code` is that of docs/diagnostics.md ("E0460"), `place` what it is about ("spheres[17]",
    "scene.scn:3:8", or ""), `index` the element of an array or None, `suggestion` what to do instead or "", `text` all
    of it as the program rtlang prints it."""

    def __init__(self, message: str, code: str = "E0709", place: str = "", suggestion: str = "", text: str = ""):
        self.message, self.code, self.place, self.suggestion = message, code, place, suggestion
        found = re.search(r"\[(\d+)\]$", place)
        self.index = int(found.group(1)) if found else None
        where = place + ": " if place else ""
        more = f" ({suggestion})" if suggestion else ""
        self.text = text or f"{where}error[{code}]: {message}{more}"
        super().__init__(self.text.rstrip())


class SceneError(Error, ValueError):
    """A number, a text or a file of the scene is wrong."""


class UsageError(Error, ValueError):
    """An argument of the wrong kind, or a call out of order."""


class FileError(Error):
    """A file could not be read or written."""


class LimitError(Error, MemoryError):
    """Memory or another limit is exhausted."""


class SceneWarning(UserWarning):
    """What is odd about a scene, but can be drawn."""


BY_STATUS = {1: SceneError, 2: UsageError, 3: FileError, 4: LimitError}
