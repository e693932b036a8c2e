#!/usr/bin/env python3
# Writes a scene of spheres to standard output: the same text for the same arguments, on every machine.
#
# Every sphere spells out its pigment and finish, as the exporters of viewers write them. The text is plain POV-Ray 3.7, which
# rtlang reads too, or Tachyon's own format, of the same spheres, camera and light.
#
# Usage: generate.py [KIND] COUNT [povray|tachyon]
#   cube      COUNT spheres in a cube, each in a colour of its own
#   flake     a sphere flake of about COUNT spheres: every ball carries nine of a third of its size
#   molecule  COUNT atoms along a folded chain, in the sizes and colours of four elements
#   sticks    COUNT atoms and nearly twice as many bonds, cylinders
#   nested    COUNT shells, one within the other, the outer ones clear
#   loop      COUNT spheres that a #for makes (POV-Ray and rtlang only)
# SPDX-License-Identifier: MIT
import math
import random
import sys

POVRAY_HEAD = """#version 3.7;
// {count} spheres, written by bench/generate.py.
global_settings {{ assumed_gamma 1 }}
background {{ rgb <0.2, 0.3, 0.4> }}
camera {{ location <0, 0, -3.2> right 4/3*x up y look_at 0 }}
light_source {{ <6, 8, -10>, rgb 1 }}
"""
POVRAY_SPHERE = ("sphere {{ <{:.6f}, {:.6f}, {:.6f}>, {:.6f} "
                 "pigment {{ color rgb <{:.4f}, {:.4f}, {:.4f}>{} }} "
                 "finish {{ ambient 0.1 diffuse 0.7 phong 0.3 phong_size 20 }} }}\n")
POVRAY_ROD = POVRAY_SPHERE.replace("sphere {{", "cylinder {{ <{:.6f}, {:.6f}, {:.6f}>,")
POVRAY_LOOP = """#declare S = seed(1);
#for (I, 1, {count})
    sphere {{ <2*rand(S) - 1, 2*rand(S) - 1, 2*rand(S) - 1>, {radius:.6f}*(1 + rand(S))
        pigment {{ color rgb <rand(S), rand(S), rand(S)> }} finish {{ ambient 0.1 diffuse 0.7 phong 0.3 phong_size 20 }} }}
#end
"""
TACHYON_HEAD = """BEGIN_SCENE
RESOLUTION 800 600
CAMERA ZOOM 1.0 ASPECTRATIO 1.0 ANTIALIASING 0 RAYDEPTH {depth}
  CENTER 0 0 -3.2 VIEWDIR 0 0 1 UPDIR 0 1 0
END_CAMERA
BACKGROUND 0.2 0.3 0.4
LIGHT CENTER 6 8 -10 RAD 0.01 COLOR 1 1 1
"""
TACHYON_SPHERE = ("SPHERE CENTER {:.6f} {:.6f} {:.6f} RAD {:.6f} TEXTURE AMBIENT 0.1 DIFFUSE 0.7 SPECULAR 0.0 "
                  "OPACITY {opacity} PHONG PLASTIC 0.3 PHONG_SIZE 20 COLOR {:.4f} {:.4f} {:.4f} TEXFUNC 0\n")
TACHYON_ROD = TACHYON_SPHERE.replace("SPHERE CENTER", "FCYLINDER BASE {:.6f} {:.6f} {:.6f} APEX")
ELEMENTS = [(0.25, (0.9, 0.9, 0.9)), (0.34, (0.3, 0.3, 0.3)), (0.32, (0.2, 0.2, 0.9)), (0.3, (0.9, 0.1, 0.1))]


# Each kind yields (centre, radius, colour, clear) in order.

def cube(count):
    """Centres are uniform in a cube of side 2; radii shrink with the count, so that about as much of it is filled."""
    number = random.Random(1).random  # its sequence is the same in every version of Python
    radius = 0.6 / count ** (1 / 3)
    for _ in range(count):
        centre = [0.0] * 3 if count == 1 else [2 * number() - 1 for _ in range(3)]
        colour = [0.2 + 0.8 * number() for _ in range(3)]
        yield centre, radius * (0.5 + 0.5 * number()), colour, 0


def flake(count):
    """Ball by ball, outward: the first COUNT of the endless flake."""
    waiting = [((0.0, -0.2, 0.0), 0.8)]
    turns = [(math.cos(a) * s, h, math.sin(a) * s) for h, s, n in ((0.0, 1.0, 6), (0.8, 0.6, 3))
             for a in (2 * math.pi * (i + h) / n for i in range(n))]
    for number, (centre, radius) in enumerate(waiting):
        if number == count:
            break
        depth = round(math.log(0.8 / radius, 3))
        yield centre, radius, (0.9 - 0.1 * depth, 0.7, 0.3 + 0.1 * depth), 0
        if len(waiting) < count:
            waiting.extend((tuple(c + 4 / 3 * radius * t for c, t in zip(centre, turn)), radius / 3) for turn in turns)


def molecule(count):
    number = random.Random(2).random
    step = 2.5 / count ** (1 / 3)
    at = [0.0, 0.0, 0.0]
    for _ in range(count):
        size, colour = ELEMENTS[int(4 * number())]
        yield at, step * size, colour, 0
        towards = [number() - 0.5 - 0.3 * c for c in at]  # the chain stays near the middle
        length = math.sqrt(sum(c * c for c in towards))
        at = [a + 0.4 * step * c / length for a, c in zip(at, towards)]


def sticks(count):
    """Atoms near the places of a lattice, and a bond of each to its neighbour along two axes, whose place is both its ends."""
    number = random.Random(3).random
    side = max(2, round(count ** (1 / 3)))
    step = 2 / side
    atoms = {}
    for i in range(count):
        at = (i % side, i // side % side, i // side // side)
        centre = [step * (a + 0.5 + 0.4 * (number() - 0.5)) - 1 for a in at]
        size, colour = ELEMENTS[int(4 * number())]
        atoms[at] = centre, colour
        yield centre, step * 0.8 * size, colour, 0
    for (x, y, z), (centre, colour) in atoms.items():
        for other in (x + 1, y, z), (x, y + 1, z):
            if other in atoms:
                yield (*centre, *atoms[other][0]), step * 0.08, colour, 0


def nested(count):
    for shell in range(count):
        part = (count - shell) / count
        yield (0.0, 0.0, 0.0), part, (part, 0.6, 1 - part), 0.7 if shell + 1 < count else 0


KINDS = {"cube": cube, "flake": flake, "molecule": molecule, "sticks": sticks, "nested": nested}


def write_povray(out, kind, count):
    out.write(POVRAY_HEAD.format(count=count))
    if kind == "loop":
        out.write(POVRAY_LOOP.format(count=count, radius=0.3 / count ** (1 / 3)))
        return
    for centre, radius, colour, clear in KINDS[kind](count):
        form = POVRAY_ROD if len(centre) == 6 else POVRAY_SPHERE
        out.write(form.format(*centre, radius, *colour, f" transmit {clear}" if clear else ""))


def write_tachyon(out, kind, count):
    # Tachyon counts what a ray goes through, the others do not: as many shells as there are, and out of them again.
    out.write(TACHYON_HEAD.format(depth=2 * count if kind == "nested" else 5))
    for centre, radius, colour, clear in KINDS[kind](count):
        form = TACHYON_ROD if len(centre) == 6 else TACHYON_SPHERE
        out.write(form.format(*centre, radius, *colour, opacity=1 - clear))
    out.write("END_SCENE\n")


WRITERS = {"povray": write_povray, "tachyon": write_tachyon}


def main():
    words = sys.argv[1:]
    kind = words.pop(0) if words and (words[0] in KINDS or words[0] == "loop") else "cube"
    writer = WRITERS.get(words.pop() if len(words) == 2 else "povray")
    if len(words) != 1 or not words[0].isdigit() or int(words[0]) < 1 or not writer or \
            (kind == "loop" and writer is write_tachyon):
        sys.exit("usage: generate.py [cube|flake|molecule|sticks|nested|loop] COUNT [povray|tachyon]")
    writer(sys.stdout, kind, int(words[0]))


if __name__ == "__main__":
    main()
