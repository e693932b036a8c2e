#!/usr/bin/env python3
"""Animations beside single runs and beside POV-Ray: seconds of the processor, of programs in turn, so that ratios count.

100 frames of 100 000 spheres, in which the camera moves, or one sphere behind the others. POV-Ray draws few of the frames,
and its time is scaled: it reads the scene again for each. Prints a table; --update writes it into docs/povray.md.
SPDX-License-Identifier: MIT
"""
import argparse
import os
import random
import re
import resource
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(HERE, "..", "tests", "povray"))
import documents  # noqa: E402

PROGRAM = os.path.abspath(os.environ.get("RTLANG", "./rtlang"))
POVRAY = os.environ.get("POVRAY", "povray")
HEAD = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\nlight_source { <5, 5, -15> rgb 1 }\n"
CAMERA = "camera { location <%s, 2, -12> look_at 0 }\n"
MOVED = "sphere { <5 * clock - 2.5, 0, -5>, 0.5 pigment { rgb 1 } }\n"
SIZE = {"rtlang": ["-W320", "-H240"], "povray": ["+W320", "+H240", "-D", "-A"]}


def spheres(count):
    chance = random.Random(1)
    for _ in range(count):
        place = [chance.uniform(-4, 4) for _ in range(3)]
        yield ("sphere { <%.5f, %.5f, %.5f>, %.4f pigment { rgb <%.3f, %.3f, %.3f> } finish { phong 0.5 } }\n" %
               (*place, chance.uniform(0.02, 0.05), *(chance.random() for _ in range(3))))


def cost(words):
    """(seconds of the processor, what was said)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, done.stderr.decode("utf-8", "replace")


def row(name, scene, folder, options):
    picture = os.path.join(folder, "frame.png")
    own = one = peer = float("inf")
    for _ in range(options.turns):
        seconds, said = cost([PROGRAM, *SIZE["rtlang"], f"--frames=1..{options.frames}", "-o", picture, scene])
        own = min(own, seconds)
        one = min(one, cost([PROGRAM, "-q", *SIZE["rtlang"], "--clock=0.5", "-o", picture, scene])[0])
        seconds, _ = cost([POVRAY, scene, *SIZE["povray"], f"+KFF{options.povray_frames}", f"+O{picture}"])
        peer = min(peer, seconds)
    times = re.search(r"the scene read (\d+) times?, its tree built (\d+) times?", said)
    peer *= options.frames / options.povray_frames
    single = one * options.frames
    return (f"| {name} | {times[1]} | {times[2]} | {own:.2f} | {single:.1f} | {single / own:.1f} | {peer:.0f} | {peer / own:.0f} |\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--povray-frames", type=int, default=3)
    parser.add_argument("--spheres", type=int, default=100000)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    balls = "".join(spheres(options.spheres))
    scenes = {"the camera": HEAD + CAMERA % "3 * sin(clock * 3)" + balls, "a sphere": HEAD + CAMERA % "0" + balls + MOVED}
    table = ("| moves | read | trees | rtlang, s | single runs, s | ratio | POV-Ray, s | ratio |\n" + "|---" * 8 + "|\n")
    with tempfile.TemporaryDirectory() as folder:
        for name, text in scenes.items():
            path = os.path.join(folder, "scene.pov")
            with open(path, "w", encoding="ascii") as file:
                file.write(text)
            table += row(name, path, folder, options)
    print(table, end="")
    if options.update:
        documents.write(os.path.join(HERE, "..", "docs", "povray.md"), "frames", table)


main()
