#!/usr/bin/env python3
"""What `make install` puts in place has no symbols for debuggers, unless `./configure --disable-strip` asked for them.

So that the program stays small, its size has a bar where it is built as the README says: by gcc, at -O2, stripped.

Prints TAP.
SPDX-License-Identifier: MIT
"""
import os
import re
import subprocess
import tempfile

from tap import Tap

MOST_BYTES = 3_000_000  # of the installed program
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
        makefile = file.read()
    strips = "INSTALL_STRIP_FLAG = -s\n" in makefile
    as_usual = strips and re.search("^CFLAGS = -g -O2$", makefile, re.M) and re.search("^CC = .*gcc", makefile, re.M) \
        and "-fsanitize" not in makefile
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([os.environ.get("MAKE", "make"), "-C", BUILD, "install-exec", "DESTDIR=" + folder],
                              capture_output=True, text=True, check=False)
        tap.ok(done.returncode == 0, "make install-exec", done.stderr[-2000:])
        names = []
        for path in sorted(elf_files(folder)):
            names.append(os.path.basename(path).split(".")[0])
            with open(path, "rb") as file:
                tap.equal(b".symtab\0" not in file.read(), strips, os.path.basename(path))
                if as_usual and os.path.basename(path) == "rtlang":
                    size = os.fstat(file.fileno()).st_size
                    tap.ok(size <= MOST_BYTES, f"rtlang takes {size} bytes, at most {MOST_BYTES}")
        tap.ok({"rtlang", "rtcheck", "librtlang"} <= set(names), "programs and library are there", names)
    tap.done()


if __name__ == "__main__":
    main()
