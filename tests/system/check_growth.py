#!/usr/bin/env python3
"""Nothing costs more than in proportion: messages, names, included files, the length of a line; what a sphere takes; and what
variables owned before is given back.

Instructions are counted by valgrind's cachegrind, so that no clock and no other load decides. The cost of ten times as much
text may be GROWTH times as high; tables that double and caches of the allocator take the rest, and a quadratic part would make it
100. CHECK_LONG=1 takes a million of each and a line of 100 MB; without it some hundreds and thousands. Prints TAP.
SPDX-License-Identifier: MIT
"""
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

from tap import Tap

PROGRAM = os.path.abspath(os.environ["RTLANG"])
IS_LONG = bool(os.environ.get("CHECK_LONG"))
SIZES = (100_000, 1_000_000) if IS_LONG else (400, 4_000)
GROWTH = 13
LINE_BYTES = 100_000_000
DEEPEST = 31
SPHERES, SPHERE_BYTES = 200_000, 136


def deep_includes(count):
    return ['#include "d0.inc"\n'] * (count // DEEPEST)


def misspelt(count):
    yield from (f"#declare scal{i} = 1;\n" for i in range(count))
    yield "sphere { 0, 1 foo " + " ".join(f"scam{i}" for i in range(count)) + " }\n"


# name -> (options, scene by count, exit code)
CASES = {
    "warnings that say the same": ((), lambda count: ["sphere { 0, 0 }\n"] * count, 0),
    "warnings that say different things": ((), lambda count: (f'#warning "{i}"\n' for i in range(count)), 0),
    "names": ((), lambda count: (f"#declare N{i} = {i};\n" for i in range(count)), 0),
    "names that nothing uses": (("-Wall",), lambda count: (f"#declare N{i} = {i};\n" for i in range(count)), 0),
    "locals of a macro": ((), lambda count: ["#macro M()\n", *(f"#local N{i} = {i};\n" for i in range(count)),
                                             "#end\nM()\n"], 0),
    "included files": ((), lambda count: ['#include "empty.inc"\n'] * count, 0),
    "included files in a block": ((), lambda count: ["union { sphere { 0, 1 } sphere { 1, 1 }\n",
                                                     *['#include "empty.inc"\n'] * count, "}\n"], 0),
    "included files in each other": ((), deep_includes, 0),
    "one line": ((), lambda count: ["sphere { 0, 1 } "] * count + ["sphere { 0, R }\n"], 1),
    "unknown names after a missing file": ((), lambda count: ['#include "none.inc"\n'] +
                                           [f"sphere {{ N{i}, 1 }}\n" for i in range(count)], 3),
    "names that are nearly a property": ((), misspelt, 1),
    "arrays copied": ((), lambda count: ["#declare A = array[20]; #declare A[0] = 1;\n", f"#for (I, 1, {count}) #declare B = A; #end\n"], 0),
}

# What is done to a text, an array of texts or an array so often that all values together would take 70 MB and more:
# (before, what is done, TURNS times).
FREED_MOST, FREED_TURNS = 4096, 3000  # kilobytes more than one turn takes
FREED_HEAD = """#version 3.7; #declare S = ""; #declare A = array[200]; #declare A[0] = 1; #declare C = array[2];
#macro Turn(P)
  #declare S = concat(S, "x"); #declare B = A; #declare C[1] = A; #undef B #declare D = array[2] { S, S } #local E = A;
#end
#macro Turns(P) #for (I, 1, TURNS) Turn(P) #local L = A; #declare S = concat(S, "y"); #end #end
#macro Value(P) #for (I, 1, TURNS) #declare S = concat(S, "x"); #declare B = A; #local L = A; #end P #end
#macro Torn(P) sphere { 0, #for (I, 1, TURNS) #declare S = concat(S, "x"); #declare B = A; #end #if (P) 1 } #else 2 } #end #end
"""
FREED = {
    "values at the top": "#for (I, 1, TURNS) Turn(1) #end",
    "values in macros with an element as their argument": "Turns(A[0])",
    "values in a block": "union { sphere { 0, 1 } Turns(A[0]) sphere { 1, 1 } }",
    "values in an expression": "#declare R = 2 * Value(A[0]);",
    "values in a text that a branch tears": "Torn(A[0])",
}


def write_includes(folder):
    for name, text in [("empty.inc", "")] + [
            (f"d{i}.inc", f'#include "d{i + 1}.inc"\n' if i + 1 < DEEPEST else "") for i in range(DEEPEST)]:
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(text)


def write_scene(folder, lines):
    with open(os.path.join(folder, "s.scn"), "w", encoding="ascii") as file:
        file.writelines(lines)


def instructions(folder, options):
    """(number of instructions, exit code) of a check of s.scn."""
    log = os.path.join(folder, "log")
    done = subprocess.run(["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null",
                           f"--log-file={log}", "--error-exitcode=0", PROGRAM, "-q", *options, "--check", "s.scn"],
                          cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          check=False)
    with open(log, encoding="utf-8", errors="replace") as file:
        counted = re.search(r"I\s+refs:\s+([\d,]+)", file.read())
    return int(counted.group(1).replace(",", "")), done.returncode


def check_case(tap, name, folder):
    options, lines, status = CASES[name]
    costs, codes = [], []
    for count in (0, *SIZES):
        write_scene(folder, lines(count))
        cost, code = instructions(folder, options)
        costs.append(cost)
        codes.append(code)
    growth = (costs[2] - costs[0]) / max(1, costs[1] - costs[0])
    tap.ok(growth <= GROWTH and codes[1:] == [status] * 2,
           f"{name}: ten times as many cost {growth:.1f} times as much", f"instructions {costs}, exit codes {codes}")


def check_line(tap, folder):
    """The message at the end of the longest line has its place and a piece of the line."""
    text = "sphere { 0, 1 } "
    write_scene(folder, [text] * (LINE_BYTES // len(text)) + ["sphere { 0, R }\n"])
    done = subprocess.run([PROGRAM, "-q", "--check", "s.scn"], cwd=folder, stderr=subprocess.PIPE, check=False)
    said = done.stderr.decode()
    column = LINE_BYTES // len(text) * len(text) + len("sphere { 0, ") + 1
    tap.ok(done.returncode == 1 and f"s.scn:1:{column}: error[E0201]" in said and len(said) < 1000,
           "a message in a line of 100 MB", said)


def peak(folder, count):
    """Kilobytes of a picture of so many spheres, each with a colour of its own."""
    dice = random.Random(1)
    write_scene(folder, (  # one by one: a child's peak is never told below that of this process
        "sphere {{ <{:.6f}, {:.6f}, {:.6f}>, 0.003 pigment {{ rgb <{:.4f}, {:.4f}, {:.4f}> }} }}\n".format(
            *(dice.uniform(-1, 1) for _ in range(3)), *(dice.random() for _ in range(3))) for _ in range(count)))
    child = subprocess.Popen([PROGRAM, "-q", "-Wno-W0401", "-Wno-W0402", "-t2", "-W8", "-H8", "-o", "s.png", "s.scn"], cwd=folder,
                             stdin=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_maxrss if child.returncode == 0 else float("inf")


def peak_of(folder, text):
    """Kilobytes of a check of a scene."""
    write_scene(folder, [text])
    with subprocess.Popen([PROGRAM, "-q", "--check", "s.scn"], cwd=folder, stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as child:
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_maxrss if child.returncode == 0 else float("inf")


def check_freed(tap, folder):
    """A line for each of FREED: the peak with many turns is that with one."""
    for name, body in FREED.items():
        text = FREED_HEAD + body + " sphere { 0, strlen(S) }\n"
        few, many = (peak_of(folder, text.replace("TURNS", str(turns))) for turns in (1, FREED_TURNS))
        tap.ok(many - few <= FREED_MOST, f"{name}: {FREED_TURNS} turns take {many - few} kB more than one, at most {FREED_MOST}")


def check_memory(tap, folder):
    """What a sphere takes at the peak, when its record is in memory beside what the tree is built from."""
    with open(PROGRAM, "rb") as file:
        if re.search(rb"__[atm]san_init", file.read()):
            tap.skip("memory of values and of a sphere", "sanitizers take more")
            return
    check_freed(tap, folder)
    each = (peak(folder, 2 * SPHERES) - peak(folder, SPHERES)) * 1024 / SPHERES
    tap.ok(each <= SPHERE_BYTES, f"{SPHERES} more spheres take {each:.0f} bytes each, at most {SPHERE_BYTES}")


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        write_includes(folder)
        for name in CASES:
            if shutil.which("valgrind"):
                check_case(tap, name, folder)
            else:
                tap.skip(name, "valgrind is not installed")
        check_memory(tap, folder)
        if IS_LONG:
            check_line(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
