#!/usr/bin/env python3
"""--alpha with --samples: alphas are means, and known ones where the answer is.

Along a slanted edge alpha is the share of the pixel that is covered; behind even glass it is what one ray finds; and in whole
scenes it is what POV-Ray's +UA finds with 82 rays a pixel. Threads, crops and kinds of file change nothing, and what does
not go with --alpha is refused. Prints TAP.
SPDX-License-Identifier: MIT
"""
import math
import os
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import check_alpha  # noqa: E402
import exr  # noqa: E402
import pictures  # noqa: E402
from check_alpha import BACKGROUNDS, CAMERA, GAMMAS, HEIGHT, THINGS, WIDTH, call, read_rgba  # noqa: E402
from tap import Tap  # noqa: E402

HEAD = GAMMAS["3.7"]
TURN = 20.0  # degrees
EDGE = (HEAD + "camera { orthographic location -5*z look_at 0 right 4*x up 3*y }\n"
        f"box {{ <-9, -9, 0>, <0, 9, 1> rotate {TURN}*z pigment {{ rgb 1 }} finish {{ ambient 0 emission rgb <0.8, 0.4, 0.2> }} }}\n")
GLASS = (HEAD + "camera { location -5*z look_at 0 }\nbackground { rgbt <0.2, 0.4, 0.6, 0.5> }\n"
         "plane { z, 0 pigment { rgbft <0.8, 0.6, 0.4, 0.3, 0.25> } finish { ambient 0 emission 0.3 } }\n")
WHOLE = HEAD + CAMERA + BACKGROUNDS["transmit"] + THINGS["layers"]


def rtlang(folder, text, *options, name="out.png"):
    """The path of the picture."""
    scene, path = os.path.join(folder, "scene.scn"), os.path.join(folder, name)
    with open(scene, "w", encoding="ascii") as out:
        out.write(text)
    call([os.environ["RTLANG"], "-q", "--alpha", f"-W{WIDTH}", f"-H{HEIGHT}", "--file-gamma=1",
          *(["--depth=16"] if name.endswith(".png") else []), "-o", path, *options, scene])
    return path


def read_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def covered(column, row):
    """The share of a pixel that the half plane left of the edge covers: the area of the square cut by the line."""
    turn, step = math.radians(TURN), 4.0 / WIDTH
    inward = (-math.cos(turn), -math.sin(turn))  # the edge turns with the box, about z and left-handed: from y to -x
    corners = [((column + i - WIDTH / 2) * step, (HEIGHT / 2 - row - j) * step) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    depths = [x * inward[0] + y * inward[1] for x, y in corners]
    cut = []
    for i in range(4):
        (ax, ay), (bx, by), a, b = corners[i - 1], corners[i], depths[i - 1], depths[i]
        if (a > 0) != (b > 0):
            t = a / (a - b)
            cut.append((ax + t * (bx - ax), ay + t * (by - ay)))
        if b > 0:
            cut.append((bx, by))
    area = sum(cut[i - 1][0] * cut[i][1] - cut[i][0] * cut[i - 1][1] for i in range(len(cut))) / 2
    return abs(area) / step ** 2


def check_edge(tap, folder):
    exact = [covered(i % WIDTH, i // WIDTH) for i in range(WIDTH * HEIGHT)]
    worst = {}
    for samples in (4, 64, 1024):
        values = read_rgba(rtlang(folder, EDGE, f"--samples={samples}"))
        steps = [abs(a / 65535 - b) for a, b in zip(values[3::4], exact)]
        worst[samples] = max(steps)
        # A net of N points misses an area cut off by a line by the boxes that the line goes through: at most 2 / sqrt(N).
        tap.ok(max(steps) <= 2.0 / math.sqrt(samples) and abs(sum(values[3::4]) / 65535 - sum(exact)) <= 0.02 * WIDTH,
               f"{samples} samples: along an edge alpha is within {max(steps):.3f} of what is covered")
    tap.ok(worst[1024] < worst[64] / 2 < worst[4] / 4, f"and comes nearer with more samples: {worst}")
    colours = {tuple(values[i:i + 3]) for i in range(0, len(values), 4) if values[i + 3] > 655}
    tap.ok(all(abs(c - w * 65535) <= 40 for colour in colours for c, w in zip(colour, (0.8, 0.4, 0.2))),
           "where something is seen its colour is not mixed with what is behind", colours)
    tap.ok(all(values[i] == 0 for i in range(0, len(values), 4) if exact[i // 4] == 0.0), "and nothing is where nothing is seen")


def check_even(tap, folder):
    values = {name: read_rgba(rtlang(folder, GLASS, *options)) for name, options in
              (("one ray", ()), ("1 sample", ("--samples=1",)), ("5 samples", ("--samples=5",)),
               ("grid", ("--samples=16", "--sampler=grid")), ("random", ("--samples=9", "--sampler=random")))}
    first = values["one ray"]
    for name, found in values.items():
        worst = max(abs(a - b) for a, b in zip(found, first))
        tap.ok(worst <= 1, f"{name}: even glass is as with one ray, to {worst}/65535")
    tap.ok(len(set(first[3::4])) == 1 and 0 < first[3] < 65535, "and some of what is behind it is seen")
    whole = [read_rgba(rtlang(folder, WHOLE, *options)) for options in ((), ("--samples=1",))]
    tap.ok(whole[0] == whole[1], "one sample is the ray through the middle")


def check_same(tap, folder):
    files = [read_bytes(rtlang(folder, WHOLE, "--samples=12", f"--threads={threads}")) for threads in (1, 3, 7)]
    tap.ok(files[0] == files[1] == files[2], "threads change no byte")
    whole, (left, top, width, height) = read_rgba(rtlang(folder, WHOLE, "--samples=12")), (13, 9, 30, 21)
    # A crop is read at its own size.
    part = rtlang(folder, WHOLE, "--samples=12", f"--crop={left},{top},{width},{height}", name="part.png")
    check_alpha.WIDTH, check_alpha.HEIGHT = width, height
    found = read_rgba(part)
    check_alpha.WIDTH, check_alpha.HEIGHT = WIDTH, HEIGHT
    rows = [whole[4 * (y * WIDTH + left):4 * (y * WIDTH + left + width)] for y in range(top, top + height)]
    tap.ok(found == [value for row in rows for value in row], "a crop is a part of the picture")


def check_exr(tap, folder):
    try:
        channels = exr.read_exr(rtlang(folder, WHOLE, "--samples=12", name="out.exr"))[1]
    except pictures.RunFailed as failure:
        if "E0507" not in failure.text:
            raise
        tap.skip("EXR", "built without OpenImageIO")
        return
    values = read_rgba(rtlang(folder, WHOLE, "--samples=12"))
    worst = max(max(abs(channels["A"][i] - values[4 * i + 3] / 65535), max(
        abs(min(channels[c][i], channels["A"][i]) - values[4 * i + k] / 65535 * channels["A"][i])
        for k, c in enumerate("RGB"))) for i in range(WIDTH * HEIGHT))
    tap.ok(worst <= 1.5 / 65535, f"EXR holds the same, its light multiplied with alpha: within {worst:.2g}")


def check_povray(tap, folder):
    """Both take so many rays that what is left is the error of the means."""
    if not pictures.povray():
        tap.skip("POV-Ray", "povray is not installed")
        return
    for thing in ("two sheets of glass", "sky", "fog", "layers", "mirrors"):
        text = HEAD + CAMERA + BACKGROUNDS["transmit"] + THINGS[thing]
        names = check_alpha.render(text, folder, ["--samples=256"], ["+A0.0", "+AM1", "+R9", "-J"])
        one, other = (read_rgba(name) for name in names)
        light = [[values[i + k] * (values[i + 3] / 65535 if k < 3 else 1) / 65535 for i in range(0, len(values), 4) for k in range(4)]
                 for values in (one, other)]
        steps = [abs(a - b) for a, b in zip(*light)]
        alphas, mean = steps[3::4], math.sqrt(sum(step * step for step in steps) / len(steps))
        tap.ok(max(alphas) <= 0.05 and mean <= 0.004,
               f"{thing}: alpha within {max(alphas):.4f} of POV-Ray's, root mean square of all values {mean:.5f}")


def check_refused(tap, folder):
    scene = os.path.join(folder, "scene.scn")
    with open(scene, "w", encoding="ascii") as out:
        out.write(GLASS)
    for options in (["--samples=4", "--adaptive"], ["--target-error=0.1"], ["--precision=quad"], ["--method=forward"],
                    ["--samples=4", "-oout.jpg"]):
        done = subprocess.run([os.environ["RTLANG"], "-q", "--alpha", "-W8", "-H8", "-oout.png", *options, scene], cwd=folder,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
        tap.ok(done.returncode == 2 and "error[E0703]" in done.stderr and "--alpha" in done.stderr,
               f"{' '.join(options)} is refused", done.stderr)


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        for check in (check_edge, check_even, check_same, check_exr, check_povray, check_refused):
            check(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
