"""One session of the library: calls with statuses become calls with exceptions.

A session is used by one thread at a time; a second one is refused. Rendering continues in a thread of its own, so that
Ctrl-C reaches Python. SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import ctypes
import re
import threading
import warnings
import weakref

from . import _library as c
from ._errors import BY_STATUS, Error, SceneWarning, UsageError


class Session:
    """Owns an rt_session. With `with` it is closed at the end."""

    def __init__(self):
        self._errors, self._warnings = [], []
        self._progress, self._fault = None, None
        self._lock = threading.Lock()
        # The library keeps the functions, so they must live as long. They hold the session weakly: in a cycle its
        # memory would wait for Python's collector, which counts objects and not gigabytes.
        self._callbacks = c.Callbacks(None, c.DIAGNOSTIC(_weakly(self._diagnostic)), c.MESSAGE(),
                                      c.PROGRESS(_weakly(self._progressed)))
        self._handle = c.LIBRARY.rt_session_new(ctypes.byref(self._callbacks))
        if not self._handle:
            raise MemoryError("no memory for a session of rtlang")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if getattr(self, "_handle", None):
            c.LIBRARY.rt_session_free(self._handle)
            self._handle = None

    def close(self):
        """Gives all memory back. Closing twice is fine; any other call then raises UsageError."""
        with self._mine("close"):
            handle, self._handle = self._handle, None
            if handle:
                c.LIBRARY.rt_session_free(handle)

    @property
    def is_closed(self):
        return self._handle is None

    # ---- callbacks, which may come from any thread

    def _diagnostic(self, _, diagnostic):
        found = diagnostic.contents
        text = found.text.decode("utf-8", "replace")
        place = found.file.decode("utf-8", "replace") if found.file else ""
        if found.line:
            place += f":{found.line}:{found.column}"
        suggestion = re.search(r"^ +(?:\d+ )?[|=] help: (.*)$", text, re.MULTILINE)
        told = Error(found.message.decode("utf-8", "replace"), found.code.decode("ascii"), place,
                     suggestion.group(1) if suggestion else "", text)
        (self._errors if found.severity == c.ERROR else self._warnings).append(told)

    def _progressed(self, _, done):
        if self._progress and not self._fault:
            try:
                self._progress(done)
            except BaseException as fault:  # pylint: disable=broad-except
                self._fault = fault
                c.LIBRARY.rt_cancel(self._handle)

    # ---- calls

    def _mine(self, name):
        return _Turn(self._lock, name)

    def call(self, name, *arguments, level=3):
        """Calls a function of the library; a status that is a fault becomes an exception."""
        with self._mine(name):
            self._check_open()
            status = getattr(c.LIBRARY, name)(self._handle, *arguments)
            self._finish(name, status, level + 1)

    def ask(self, name, *arguments):
        """Calls one without a status."""
        with self._mine(name):
            self._check_open()
            return getattr(c.LIBRARY, name)(self._handle, *arguments)

    def _check_open(self):
        if self._handle is None:
            raise UsageError("the scene is closed")

    def _finish(self, name, status, level):
        errors, told = self._errors, self._warnings
        self._errors, self._warnings = [], []
        for warning in told:
            warnings.warn(warning.text.rstrip(), SceneWarning, stacklevel=level)
        if status in (c.OK, c.CANCELLED):
            return
        kind = BY_STATUS[status]
        if not errors:
            raise kind(f"{name} was refused: an argument is out of range, or the scene is lost by an earlier fault")
        first = errors[0]
        text = "".join(error.text for error in errors)
        raise kind(first.message, first.code, first.place, first.suggestion, text)

    def render(self, threads, progress):
        """True when the picture is whole, False when it was cancelled and what is there can be used."""
        with self._mine("render"):
            self._check_open()
            self._progress, self._fault = progress, None
            c.LIBRARY.rt_resume(self._handle)
            interrupt, result, is_done = None, [], threading.Event()

            def work():
                result.append(c.LIBRARY.rt_render(self._handle, threads))
                is_done.set()

            threading.Thread(target=work).start()
            while not is_done.is_set():
                try:
                    while not is_done.wait(0.05):  # the signal may have reached another thread
                        pass
                except KeyboardInterrupt as pressed:
                    interrupt = pressed
                    c.LIBRARY.rt_cancel(self._handle)
            self._progress = None
            c.LIBRARY.rt_resume(self._handle)
            self._finish("render", result[0], 5)
            if self._fault and not isinstance(self._fault, KeyboardInterrupt):
                raise self._fault
            if result[0] != c.CANCELLED:
                return True
            error = c.SamplingError()
            c.LIBRARY.rt_get_error(self._handle, ctypes.byref(error))
            if not error.samples > 0:
                raise interrupt or self._fault or KeyboardInterrupt()
            return False


def _weakly(method):
    """A function that calls the method while its object lives."""
    reference = weakref.WeakMethod(method)

    def call(*arguments):
        alive = reference()
        if alive:
            alive(*arguments)

    return call


class _Turn:
    """A lock that does not wait."""

    def __init__(self, lock, name):
        self._lock, self._name = lock, name

    def __enter__(self):
        if not self._lock.acquire(blocking=False):
            raise UsageError(f"{self._name}: another thread is using this scene", suggestion="one scene a thread")

    def __exit__(self, *_):
        self._lock.release()
