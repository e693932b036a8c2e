#!/usr/bin/env python3
"""Draws the gallery: docs/gallery/*.png and, in docs/gallery.md, the table of what each picture took.

    draw.py [--only=NAME…] [--look] [--beside]

Each picture is sampled until its error is below GOAL, at 640x480. What both programs take for one ray a pixel at 320x240 is
measured beside it (processor seconds of one thread each, the whole process), by turns, the least of three. With --look pictures of
16 samples go to the current folder and nothing else is written; with --beside only those that stand beside others are drawn. Wants RTLANG; POV-Ray where it is installed.
SPDX-License-Identifier: MIT
"""
import math
import os
import re
import resource
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
sys.dont_write_bytecode = True  # the folder is distributed as it is
sys.path.insert(0, os.path.join(TOP, "tests", "povray"))
import pictures  # noqa: E402

PICTURES = os.path.join(TOP, "docs", "gallery")
PAGE = os.path.join(TOP, "docs", "gallery.md")
RTLANG = os.environ.get("RTLANG", "rtlang")
GOAL = "0.005"

# The colours of an error map, and of which errors.
LEAST, MOST = 1e-4, 0.1
COLOURS = [(10, 10, 20), (44, 22, 92), (118, 28, 118), (212, 62, 78), (245, 140, 40), (252, 216, 96), (255, 255, 240)]

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
    ("chain", "chain.scn", []),
    ("film", "film.scn", ["--frames=1..100"]),  # by film_row
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


def line_of(name, objects, once, other, samples, rays, took, error):
    return (f"| [{name}](#{name}) | {int(objects):,} | {once:.2f} | " + ("-" if other is None else f"{other:.2f}") +
            f" | {samples:.1f} | {rays / 1e6:.1f} | {took:.1f} | {error} |").replace(",", " ")


def row(name, scene, more):
    with tempfile.TemporaryDirectory() as folder:
        once, other = one_ray(scene, more, folder)
    took, said = seconds(draw(scene, more, os.path.join(PICTURES, name + ".png"), [f"--target-error={GOAL}"]))
    objects = re.search(r"(\d+) objects?", said).group(1)
    rays = sum(int(number) for number in re.findall(r"(\d+) (?:camera|shadow|reflected|transmitted)", said))
    error = re.search(r"rmse (\S+), .*? at (\S+) samples", said)
    print(name, said.splitlines()[-1] if "rmse" not in said else error.group(0), flush=True)
    return line_of(name, objects, once, other, float(error.group(2)), rays, took, error.group(1))


def film_row(name, scene, more):
    """Of all frames together, 320x240, and the greatest of their errors."""
    small, other = ["-W", "320", "-H", "240", *more], None
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "film.png")
        once, said = seconds([RTLANG, *small, "--threads=1", "-o", picture, scene])
        other = povray(scene, picture, ["-A", "+W320", "+H240", "+KFF100"])
        took, said = seconds([RTLANG, *small, f"--target-error={GOAL}", "-o", picture, scene])
    rays = sum(int(number) for number in re.findall(r"(\d+) (?:camera|shadow|reflected|transmitted)", said))
    errors = [(float(error), float(samples)) for error, samples in re.findall(r"rmse (\S+), .*? at (\S+) samples", said)]
    print(name, len(errors), "frames", flush=True)
    return line_of(name, re.search(r"(\d+) objects?", said).group(1), once, other, sum(each for _, each in errors) / len(errors),
                   rays, took, f"{max(each for each, _ in errors):.3g}")


def write_png(path, width, height, values):
    """Eight bits of red, green and blue a pixel."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(values[3 * width * y:3 * width * (y + 1)]) for y in range(height))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def colour(error):
    """From black by red and yellow to white, as the logarithm of the error goes from LEAST to MOST."""
    place = min(max(math.log(max(error, LEAST) / LEAST) / math.log(MOST / LEAST), 0), 1) * (len(COLOURS) - 1)
    low = min(int(place), len(COLOURS) - 2)
    return [round(a + (place - low) * (b - a)) for a, b in zip(COLOURS[low], COLOURS[low + 1])]


def draw_errors(name, scene, folder):
    """A picture of few samples, and beside it the error of each of its pixels."""
    errors = os.path.join(folder, "map.png")
    seconds(draw(scene, [], os.path.join(PICTURES, name + "_9.png"), ["--samples=9", "--error-map=" + errors]))
    width, height, values = pictures.read_png(errors, channels=1)
    shown = [part for value in values for part in colour(value / 65535)]
    write_png(os.path.join(PICTURES, name + "_error.png"), width, height, shown)


def extras():
    """What stands beside a picture: where its error lies, POV-Ray's speckles, five frames of the film."""
    with tempfile.TemporaryDirectory() as folder:
        draw_errors("cup", "cup.scn", folder)
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
            if name == "film":
                more = ["--clock=0.06"]
            seconds(draw(scene, more, os.path.abspath(name + ".png"), ["--samples=16"]))
        return
    os.makedirs(PICTURES, exist_ok=True)
    if "--beside" in sys.argv:
        scenes = []
    for entry in scenes:
        write_table([(film_row if entry[0] == "film" else row)(*entry)])
    if not only:
        extras()


if __name__ == "__main__":
    main()
