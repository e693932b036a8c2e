#!/usr/bin/env python3
"""What `make install` puts in place has no symbols for debuggers, unless `./configure --disable-strip` asked for them.

Prints TAP.
SPDX-License-Identifier: MIT
"""
import os
import subprocess
import tempfile

from tap import Tap

BUILD = os.path.dirname(os.path.abspath(os.environ["RTLANG"]))


def elf_files(folder):
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            with open(path, "rb") as file:
                if not os.path.islink(path) and file.read(4) == b"\x7fELF":
                    yield path


def main():
    tap = Tap()
    with open(os.path.join(BUILD, "Makefile"), encoding="utf-8") as file:
        strips = "INSTALL_STRIP_FLAG = -s\n" in file.read()
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([os.environ.get("MAKE", "make"), "-C", BUILD, "install-exec", "DESTDIR=" + folder],
                              capture_output=True, text=True, check=False)
        tap.ok(done.returncode == 0, "make install-exec", done.stderr[-2000:])
        names = []
        for path in sorted(elf_files(folder)):
            names.append(os.path.basename(path).split(".")[0])
            with open(path, "rb") as file:
                tap.equal(b".symtab\0" not in file.read(), strips, os.path.basename(path))
        tap.ok({"rtlang", "rtcheck", "librtlang"} <= set(names), "programs and library are there", names)
    tap.done()


if __name__ == "__main__":
    main()
