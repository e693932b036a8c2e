#!/usr/bin/env python3
"""The scenes of examples/gallery, small, against the pictures that are committed in tests/golden/gallery.

Four samples a pixel at 64x48 with 3 threads; a scene that says `-D Particles` gets fewer. The scene at 2^-400 has the
values that it has at 1. With UPDATE_GOLDEN=1 (`make update-golden`) the pictures are written anew. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import sys

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests/povray"))
sys.path.insert(0, os.path.join(TOP, "tests/golden"))
sys.dont_write_bytecode = True
import check_golden  # noqa: E402
import pictures  # noqa: E402

GOLDEN = os.path.join(TOP, "tests/golden/gallery")


def render(scene, folder, more=()):
    picture = os.path.join(folder, "picture.png")
    pictures.render_rtlang(scene, picture, [*pictures.include_folders(), os.path.dirname(scene)], 64, 48,
                           ["-t3", "--samples=4", "-DParticles=20000", "-DLevels=3", *more])
    return check_golden.read(picture)


def check(scene, folder):
    golden = os.path.join(GOLDEN, os.path.splitext(os.path.basename(scene))[0] + ".png")
    found = render(scene, folder)
    if check_golden.UPDATE:
        check_golden.write(golden, found)
    yield "the picture is the golden one", check_golden.apart(found, golden, folder)
    if "Exponent" in check_golden.read(scene).decode():
        for exponent in (0, 300):
            other = os.path.join(folder, "other.png")
            check_golden.write(other, render(scene, folder, [f"-DExponent={exponent}"]))
            yield f"the same values at 2^{exponent}", check_golden.apart(found, other, folder, 0)


def main():
    scenes = [scene for ending in ("scn", "pov") for scene in glob.glob(os.path.join(TOP, f"examples/gallery/*.{ending}"))]
    return check_golden.check_all(sorted(scenes), check)


if __name__ == "__main__":
    sys.exit(main())
