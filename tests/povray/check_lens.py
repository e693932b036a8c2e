#!/usr/bin/env python3
"""The lens of rtlang's camera beside POV-Ray's: of one size to LENS_BAR, and told apart when one is a twentieth wider.

Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import chance  # noqa: E402
import pictures  # noqa: E402
from tap import Tap  # noqa: E402

SIZE = (64, 48)
SCENE = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 2, -10> right x * 4/3 angle 40 look_at 0 aperture 1.5 blur_samples 100 focal_point <2, 0, -2> }
light_source { <-8, 12, -10> rgb 1 }
plane { y, -1 pigment { rgb 0.5 } finish { ambient 0.1 diffuse 0.8 } }
sphere { <0, 0, -2>, 1 pigment { rgb <1, 0.4, 0.2> } finish { ambient 0.1 diffuse 0.7 } }
sphere { <3, 0, 4>, 1 pigment { rgb <0.2, 1, 0.3> } finish { ambient 0.1 diffuse 0.7 } }
sphere { <-1.4, 0, -5>, 0.6 pigment { rgb <0.2, 0.3, 1> } finish { ambient 0.1 diffuse 0.7 } }
"""


def main():
    tap = Tap()
    if not pictures.povray():
        tap.skip("lens", "povray is not installed")
        return tap.done()
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.pov")
        with open(scene, "w", encoding="ascii") as out:
            out.write(SCENE)
        same = chance.lens_error(scene, folder, [], SIZE)
        tap.ok(abs(same) <= chance.LENS_BAR, f"POV-Ray's lens is {100 * same:+.2f} % wider")
        for factor in 1.05, 0.95:
            other = chance.lens_error(scene, folder, [], SIZE, factor)
            tap.ok(abs(other) > chance.LENS_BAR, f"beside a lens {factor} times as wide: {100 * other:+.2f} %")
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
