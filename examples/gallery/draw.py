#!/usr/bin/env python3
"""Draws the gallery: docs/gallery/*.png and, in docs/gallery.md, the table of what each picture took.

    draw.py [--only=NAME…] [--look]

Each picture is sampled until its error is below GOAL, at 640x480. What both programs take for one ray a pixel at 320x240 is
measured beside it (processor seconds of one thread each, the whole process), by turns, the least of three. With --look pictures of
16 samples go to the current folder and nothing else is written. Wants RTLANG; POV-Ray where it is installed.
SPDX-License-Identifier: MIT
"""
import os
import re
import resource
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
PICTURES = os.path.join(TOP, "docs", "gallery")
PAGE = os.path.join(TOP, "docs", "gallery.md")
RTLANG = os.environ.get("RTLANG", "rtlang")
GOAL = "0.008"

# Picture, scene, and what else its command says; the pictures stand on the page in the order of its text.
SCENES = [
    ("protein", "protein.scn", []),
    ("particles", "particles.scn", []),
    ("still_life", "still_life.scn", []),
    ("crystal", "crystal.pov", ["-H", "580"]),
    ("flake", "flake.scn", []),
    ("ellipsoids", "ellipsoids.scn", []),
    ("cup", "cup.scn", []),
    ("any_size", "any_size.scn", []),
    ("shells", "shells.scn", []),
    ("fog", "fog.scn", []),
]


def seconds(command):
    """Processor seconds of a run, and what it wrote to its streams."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=HERE, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          check=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout


def draw(scene, more, picture, sampling):
    return [RTLANG, "-W", "640", "-H", "480", *more, *sampling, "-o", picture, scene]


def half(size):
    return str(int(size) // 2)


def povray(scene, picture, more):
    """Seconds, or None where POV-Ray is not there or does not draw it."""
    try:
        return seconds(["povray", f"+I{scene}", f"+O{picture}", "+FN", "-D", "+WT1", "-GA", *more])[0]
    except (FileNotFoundError, subprocess.CalledProcessError):
        return None


def one_ray(scene, more, folder):
    """Seconds of rtlang and of POV-Ray (None if it fails) for one ray a pixel: the least of three runs by turns, of one where
    POV-Ray takes long."""
    ours, theirs = [], []
    size = dict(zip(more[::2], more[1::2]))
    while len(ours) < 3 and sum(theirs) < 20.0:
        ours.append(seconds([RTLANG, "-W", "320", "-H", half(size.get("-H", 480)), "--samples=1", "--threads=1",
                             "-o", os.path.join(folder, "one.png"), scene])[0])
        other = povray(scene, f"{folder}/other.png", ["-A", "+W320", "+H" + half(size.get("-H", 480))])
        theirs += [other] if other is not None else []
    return min(ours), min(theirs, default=None)


def row(name, scene, more):
    with tempfile.TemporaryDirectory() as folder:
        once, other = one_ray(scene, more, folder)
    took, said = seconds(draw(scene, more, os.path.join(PICTURES, name + ".png"), [f"--target-error={GOAL}"]))
    objects = re.search(r"(\d+) objects?", said).group(1)
    rays = sum(int(number) for number in re.findall(r"(\d+) (?:camera|shadow|reflected|transmitted)", said))
    error = re.search(r"rmse (\S+), .*? at (\S+) samples", said)
    print(name, said.splitlines()[-1] if "rmse" not in said else error.group(0), flush=True)
    return (f"| [{name}](#{name}) | {int(objects):,} | {once:.2f} | " +
            ("-" if other is None else f"{other:.2f}") +
            f" | {float(error.group(2)):.1f} | {rays / 1e6:.1f} | {took:.1f} | {error.group(1)} |").replace(",", " ")


def extras():
    """What stands beside a picture: where its error lies, POV-Ray's speckles, five frames of the film."""
    seconds(draw("cup.scn", [], os.path.join(PICTURES, "cup_9.png"),
                 ["--samples=9", "--error-map=" + os.path.join(PICTURES, "cup_error.png")]))
    povray("shells.scn", os.path.join(PICTURES, "shells_povray.png"), ["+A0.1", "-J", "+W640", "+H480"])
    for frame in ("0", "0.02", "0.06", "0.25"):
        seconds([RTLANG, "-K", frame, "-W", "320", "-H", "240", f"--target-error={GOAL}", "-o",
                 os.path.join(PICTURES, f"film_{frame.replace('.', '_')}.png"), "film.scn"])


def write_table(rows):
    with open(PAGE, encoding="utf-8") as file:
        before, rest = file.read().split("<!-- table:begin -->\n")
    table, after = rest.split("<!-- table:end -->")
    kept = [line for line in table.splitlines()[2:] if line.split("]")[0] not in [row.split("]")[0] for row in rows]]
    rows = sorted(kept + rows, key=lambda row: [name for name, _, _ in SCENES].index(row[3:].split("]")[0]))
    head = ["| picture | objects | one ray, s | POV-Ray, s | samples | rays, 10⁶ | seconds | error |", "|---" * 8 + "|"]
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(before + "<!-- table:begin -->\n" + "\n".join(head + rows) + "\n<!-- table:end -->" + after)


def main():
    only = [word[len("--only="):] for word in sys.argv[1:] if word.startswith("--only=")]
    scenes = [entry for entry in SCENES if not only or entry[0] in only]
    if "--look" in sys.argv:
        for name, scene, more in scenes:
            seconds(draw(scene, more, os.path.abspath(name + ".png"), ["--samples=16"]))
        return
    os.makedirs(PICTURES, exist_ok=True)
    for entry in scenes:
        write_table([row(*entry)])
    if not only:
        extras()


if __name__ == "__main__":
    main()
