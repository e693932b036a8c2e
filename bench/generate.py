#!/usr/bin/env python3
# Writes a scene of N spheres in a cube to standard output: the same text for the same N, on every machine.
# Every sphere spells out its pigment and finish, in a colour of its own, as the exporters of viewers write them. Plain POV-Ray 3.7, so that every peer that reads it is given the same file.
#
# Usage: generate.py COUNT
# SPDX-License-Identifier: MIT
import random
import sys

HEAD = """#version 3.7;
// {count} spheres, written by bench/generate.py.
global_settings {{ assumed_gamma 1 }}
background {{ rgb <0.2, 0.3, 0.4> }}
camera {{ location <0, 0, -3.2> right 4/3*x up y look_at 0 }}
light_source {{ <6, 8, -10>, rgb 1 }}
"""
SPHERE = ("sphere {{ <{:.6f}, {:.6f}, {:.6f}>, {:.6f} "
          "pigment {{ color rgb <{:.4f}, {:.4f}, {:.4f}> }} finish {{ ambient 0.1 diffuse 0.7 phong 0.3 phong_size 20 }} }}\n")


def write_scene(out, count):
    """Centres are uniform in a cube of side 2; radii shrink with the count, so that about as much of it is filled."""
    number = random.Random(1).random  # its sequence is the same in every version of Python
    radius = 0.6 / count ** (1 / 3)
    out.write(HEAD.format(count=count))
    for _ in range(count):
        centre = [0.0] * 3 if count == 1 else [2 * number() - 1 for _ in range(3)]
        colour = [0.2 + 0.8 * number() for _ in range(3)]
        out.write(SPHERE.format(*centre, radius * (0.5 + 0.5 * number()), *colour))


def main():
    if len(sys.argv) != 2 or not sys.argv[1].isdigit() or int(sys.argv[1]) < 1:
        sys.exit("usage: generate.py COUNT")
    write_scene(sys.stdout, int(sys.argv[1]))


if __name__ == "__main__":
    main()
