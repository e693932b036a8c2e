#!/usr/bin/env python3
"""Messages are coloured on a terminal and nowhere else, whatever standard output is; a pseudo terminal stands for one.

Without its escape sequences coloured text is the plain one. Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import pty
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
from tap import Tap  # noqa: E402

RTLANG = os.path.abspath(os.environ.get("RTLANG", "./rtlang"))
RTCHECK = os.path.abspath(os.environ.get("RTCHECK", "./rtcheck"))
SCENE = """camera { location -4*z }
#macro Ball(R) sphere { 0, R
\tphong 0.5 } #end
Ball(1)
#include "woods.inc"
#warning "mine\\n"
sphere { 0, rgb 1 }
"""
ESCAPE = re.compile(rb"\x1b\[[0-9;]*m")
FIRST = (b"\x1b[1ms.scn:3:2:\x1b[0m \x1b[1;31merror[E0250]:\x1b[0m \x1b[1munknown property `phong` in sphere\x1b[0m\n"
         b"\x1b[1;34m   3 |\x1b[0m \tphong 0.5 } #end\n\x1b[1;34m     |\x1b[0m \t\x1b[1;31m^~~~~\x1b[0m\n"
         b"\x1b[1;34m     =\x1b[0m \x1b[1;32mhelp:\x1b[0m it belongs in `finish`\n"
         b"\x1b[1ms.scn:4:1:\x1b[0m \x1b[1;36mnote:\x1b[0m in macro `Ball`, called here\n")
RED_NAME = b"\x1b[1;31mrtcheck:\x1b[0m "


def run(command, folder, terminal, **environment):
    """What the program writes to standard error: a terminal, or a pipe while standard output is the terminal."""
    ours, theirs = pty.openpty()
    inner = {name: value for name, value in os.environ.items() if name not in ("NO_COLOR", "TERM")}
    inner.update({"TERM": "xterm", **environment})
    streams = {"stdout": theirs, "stderr": subprocess.PIPE}
    if terminal:
        streams = {"stdout": subprocess.PIPE, "stderr": theirs}
    with subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, env=inner, **streams) as process:
        os.close(theirs)
        text = b""
        if terminal:
            while True:
                try:
                    part = os.read(ours, 65536)
                except OSError:  # nobody holds the other end
                    break
                if not part:
                    break
                text += part
        else:
            text = process.stderr.read()
    os.close(ours)
    return text.replace(b"\r\n", b"\n")


def test_rtlang(tap, folder):
    command = [RTLANG, "--check", "-q", "s.scn"]
    plain = run(command, folder, False)
    tap.ok(b"\x1b" not in plain and b"error[E0250]" in plain, "no colour in a pipe, with a terminal as standard output",
           plain)
    colored = run(command, folder, True)
    tap.equal(colored[:len(FIRST)], FIRST, "a message on a terminal")
    tap.equal(ESCAPE.sub(b"", colored), plain, "the same text but for the colours")
    for name, environment in (("NO_COLOR", {"NO_COLOR": "1"}), ("a dumb terminal", {"TERM": "dumb"}),
                              ("no TERM", {"TERM": ""})):
        tap.equal(run(command, folder, True, **environment), plain, name)
    tap.equal(run(command, folder, True, NO_COLOR=""), colored, "a NO_COLOR that is empty")
    tap.equal(run([*command, "--color=never"], folder, True), plain, "--color=never")
    tap.equal(run([*command, "--color=always"], folder, False, NO_COLOR="1", TERM="dumb"), colored, "--color=always")
    for option in ("--color=auto", "--color=always"):
        told = run([*command, "--diagnostics=json", option], folder, True)
        tap.ok(b"\x1b" not in told and told.startswith(b"{"), "JSON is plain with " + option, told)
    told = run([RTLANG, "--color=always", "--zzz"], folder, False)
    tap.ok(b"\x1b[1;31merror[E0703]:" in told, "a fault of the command line", told)


def test_rtcheck(tap, folder):
    command = [RTCHECK, "--treshold=1", "s.scn"]
    plain = run(command, folder, False)
    tap.equal(plain, b"rtcheck: unknown option `--treshold=1`\ndid you mean `--threshold`?\n",
              "rtcheck in a pipe")
    colored = RED_NAME + plain[len("rtcheck: "):]
    tap.equal(run(command, folder, True), colored, "rtcheck on a terminal")
    tap.equal(run(command, folder, True, NO_COLOR="1"), plain, "rtcheck with NO_COLOR")
    tap.equal(run([command[0], "--color=never", *command[1:]], folder, True), plain, "rtcheck --color=never")
    tap.equal(run([command[0], "--color=always", *command[1:]], folder, False), colored, "rtcheck --color=always")
    tap.equal(run([RTCHECK, "--color=nevr", "s.scn"], folder, False),
              b"rtcheck: option `--color` wants auto, always or never, found `nevr`\ndid you mean `never`?\n",
              "a mistyped value")
    tap.equal(run([RTCHECK, "-width", "s.scn"], folder, False),
              b"rtcheck: unknown option `-w`\ndid you mean `--width`?\n", "one dash")


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "s.scn"), "w", encoding="ascii") as out:
            out.write(SCENE)
        test_rtlang(tap, folder)
        test_rtcheck(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
