#!/usr/bin/env python3
"""196 cameras given to rtlang and to POV-Ray: `look_at` with every pairing of vectors that says on which side `right` is, and many
that do not. POV-Ray draws all of them in one animation. Prints TAP.
SPDX-License-Identifier: MIT
"""
import concurrent.futures
import itertools
import os
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import pictures  # noqa: E402
from tap import Tap  # noqa: E402

WIDTH, HEIGHT = 8, 6
PROCESSES = 7
DIRECTIONS = ["", "direction z", "direction -x", "direction y", "direction <0.3, 0.2, -1>", "direction <1, 1, 0>", "direction -2*z"]
UPS = ["", "up z", "up -y", "up x", "up <0.2, 1, 0.1>", "up <0, 0.5, 0.5>", "up -z"]
RIGHTS = ["", "right <-4/3, 0, 0>", "right -y", "right <0.3, 0, 1>"]
SKIES = ["", "sky z", "sky <1, 2, -1>"]
# Every direction has a colour of its own.
WORLD = """#version 3.7; global_settings { assumed_gamma 1 }
sky_sphere { pigment { average pigment_map {
  [1 gradient x color_map { [0 rgb 0] [1 rgb x] } translate -x/2 scale 2]
  [1 gradient y color_map { [0 rgb 0] [1 rgb y] } translate -y/2 scale 2]
  [1 gradient z color_map { [0 rgb 0] [1 rgb z] } translate -z/2 scale 2] } } }
"""


def cameras():
    for number, words in enumerate(itertools.product(DIRECTIONS, UPS, RIGHTS)):
        # The vectors come before the angle, which takes the length of `right`.
        yield f"camera {{ location <1, 2, -3> {' '.join(words)} {SKIES[number % 3]} angle 100 look_at <0.5, 0.3, 0.4> }}"


def animate(scene, folder, frames, part):
    """Draws one part of the frames."""
    first, last = part * frames // PROCESSES + 1, (part + 1) * frames // PROCESSES
    pictures.run("povray", [pictures.povray(), f"+I{scene}", f"+O{folder}/theirs.png", f"+W{WIDTH}", f"+H{HEIGHT}", "+FN16",
                            "File_Gamma=1.0", "-A", "-D", "-P", "+WT1", "+KFI1", f"+KFF{frames}", f"+SF{first}", f"+EF{last}"])


def main():
    tap = Tap()
    if not pictures.povray():
        tap.skip("cameras", "no povray here")
        return tap.done()
    found = list(cameras())
    with tempfile.TemporaryDirectory() as folder:
        whole = os.path.join(folder, "all.pov")
        with open(whole, "w", encoding="ascii") as out:
            cases = "".join(f"#case({number}) {camera} #break\n" for number, camera in enumerate(found, 1))
            out.write(f"{WORLD}#switch(frame_number)\n{cases}#end\n")
        # POV-Ray sleeps between the pictures of an animation, so several of it do not disturb each other.
        with concurrent.futures.ThreadPoolExecutor(PROCESSES) as pool:
            list(pool.map(lambda part: animate(whole, folder, len(found), part), range(PROCESSES)))
        for number, camera in enumerate(found, 1):
            scene, ours = os.path.join(folder, "one.scn"), os.path.join(folder, "ours.png")
            with open(scene, "w", encoding="ascii") as out:
                out.write(WORLD + camera + "\n")
            pictures.render_rtlang(scene, ours, [], WIDTH, HEIGHT)
            greatest, beyond, pixels = pictures.compare(ours, os.path.join(folder, f"theirs{number:03d}.png"))
            tap.ok(beyond == 0, camera, pictures.verdict(greatest, beyond, pixels)[1])
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
