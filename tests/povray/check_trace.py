#!/usr/bin/env python3
"""Rays and points at random objects: what `trace` and `inside` say, by rtlang and by POV-Ray.

Objects are groups in groups, moved, turned inside out and clipped at random, always the same ones. Five decimals of
each point and normal must be equal. Prints TAP; skips where there is no POV-Ray. SPDX-License-Identifier: MIT
"""
import os
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402

OBJECTS, RAYS, GROUPS_DEEP = 150, 6, 2
HEAD = "#version 3.7; global_settings { assumed_gamma 1 } sphere { 0, 1 } #declare N = <0, 0, 0>;\n"


def number(rng, least, greatest):
    return f"{rng.uniform(least, greatest):.3f}"


def vector(rng, size):
    return f"<{number(rng, -size, size)}, {number(rng, -size, size)}, {number(rng, -size, size)}>"


def word(rng):
    """Something that is said of an object behind its shape."""
    kind = rng.randrange(6)
    if kind == 0:
        return f"translate {vector(rng, 1.5)}"
    if kind == 1:
        return f"rotate {vector(rng, 90)}"
    if kind == 2:
        return f"scale <{number(rng, .5, 2)}, {number(rng, .5, 2)}, {number(rng, .5, 2)}>"
    if kind == 3:
        return f"clipped_by {{ sphere {{ {vector(rng, 1)}, 1.5 }} }}"
    return f"clipped_by {{ plane {{ {vector(rng, 1)}, 0.2 }} }}" if kind == 4 else "inverse"


def shape(rng, deep):
    kind = rng.randrange(9 if deep > 0 else 5)
    if kind == 0:
        text = f"sphere {{ {vector(rng, 1.5)}, {number(rng, .3, 1.5)}"
    elif kind == 1:
        text = f"box {{ {vector(rng, 1.5)}, {vector(rng, 1.5)}"
    elif kind == 2:
        text = f"cylinder {{ {vector(rng, 1.5)}, {vector(rng, 1.5)}, {number(rng, .2, 1)} {rng.choice(['', 'open'])}"
    elif kind == 3:
        text = (f"cone {{ {vector(rng, 1.5)}, {number(rng, 0, 1)}, {vector(rng, 1.5)}, {number(rng, .1, 1)} "
                f"{rng.choice(['', 'open'])}")
    elif kind == 4:
        text = f"plane {{ {vector(rng, 1.5)}, {number(rng, -1, 1)}"
    else:
        group = rng.choice(["union", "merge", "intersection", "difference"])
        text = f"{group} {{ " + " ".join(shape(rng, deep - 1) for _ in range(rng.randint(2, 3)))
    words = [word(rng) for _ in range(rng.randrange(3))]
    if kind > 4:  # POV-Ray keeps the box of a group, although it may be boundless then
        words = [each for each in words if each != "inverse"]
    return " ".join([text, *words]) + " }"


def program():
    rng = random.Random(20)
    lines = [HEAD]
    for i in range(OBJECTS):
        lines.append(f"#declare S = object {{ {shape(rng, GROUPS_DEEP)} }}\n")
        for j in range(RAYS):
            lines.append(f"#declare P = trace(S, {vector(rng, 4)}, {vector(rng, 1.5)}, N); #debug concat(\"{i}.{j} \", "
                         f"vstr(3, P, \",\", 0, 5), \" \", vstr(3, N, \",\", 0, 5), \" \", "
                         f"str(inside(S, {vector(rng, 1.5)}), 0, 0), \"\\n\")\n")
    return "".join(lines)


def main():
    if pictures.povray() is None:
        print("1..0 # SKIP no POV-Ray")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "test.pov"), "w", encoding="ascii") as file:
            file.write(program())
        ours = subprocess.run([os.path.abspath(os.environ["RTLANG"]), "--check", "-q", "test.pov"], cwd=folder,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=False)
        pictures.call([pictures.povray(), "+Itest.pov", "-D", "+W4", "+H3", "-F", "+GDdebug.txt"], cwd=folder,
                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120)
        with open(os.path.join(folder, "debug.txt"), encoding="latin-1") as file:
            theirs = [line.rstrip() for line in file if line[0].isdigit()]
    mine = [line.rstrip() for line in (ours.stdout + ours.stderr).splitlines() if line[:1].isdigit()]
    different = [pair for pair in zip(mine, theirs) if pair[0] != pair[1]]
    passed = len(mine) == len(theirs) == OBJECTS * RAYS and not different
    print(f"1..1\n{'ok' if passed else 'not ok'} 1 - {len(theirs)} rays and points, {len(different)} differ")
    for pair in different[:10]:
        print(f"# rtlang:  {pair[0]}\n# POV-Ray: {pair[1]}")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
