#!/usr/bin/env python3
"""Planes of a picture, as channels of an EXR: depth, normals, numbers of objects and colours of what each pixel sees,
beside distances, normals and objects computed here from the scene's numbers; the same with samples, crops, any number
of threads and any precision; alpha and error together. Scenes are drawn at random. Prints TAP.

Wants RTLANG. RTLANG_SEED repeats a run. SPDX-License-Identifier: MIT
"""
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from exr import read_exr  # noqa: E402
from tap import Tap  # noqa: E402

RTLANG = os.path.abspath(os.environ["RTLANG"])
SEED = int(os.environ.get("RTLANG_SEED") or time.time_ns() % 2**32)
WIDTH, HEIGHT = 40, 30
SURFACE = ("Z", "normal.X", "normal.Y", "normal.Z", "object", "albedo.R", "albedo.G", "albedo.B")
HEAD = "#version 3.7; global_settings { assumed_gamma 1 }\n"
tap = Tap()


def rtlang(scene, *options, size=(WIDTH, HEIGHT), output="out.exr"):
    with open("scene.scn", "w", encoding="ascii") as file:
        file.write(HEAD + scene)
    done = subprocess.run([RTLANG, "-W", str(size[0]), "-H", str(size[1]), "-o", output, *options, "scene.scn"],
                          stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=120, check=False)
    return done.returncode, done.stderr.decode("utf-8", "replace")


def planes(scene, *options, **how):
    status, said = rtlang(scene, "--planes=depth,normal,object,albedo", *options, **how)
    if status:
        raise SystemExit(f"Bail out! {said}")
    return read_exr("out.exr")[1]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def vector(a):
    return "<%r, %r, %r>" % tuple(a)


class Ball:
    """The equation of a sphere, solved as the textbook does."""
    def __init__(self, rng):
        self.centre = [rng.uniform(-2, 2), rng.uniform(-1.5, 1.5), rng.uniform(-1, 3)]
        self.radius, self.colour = rng.uniform(0.2, 0.9), [rng.uniform(0, 1) for _ in range(3)]
        self.text = f"sphere {{ {vector(self.centre)}, {self.radius!r} pigment {{ rgb {vector(self.colour)} }} }}\n"

    def meet(self, eye, way):
        f = [a - b for a, b in zip(eye, self.centre)]
        b, c = dot(way, f), dot(f, f) - self.radius ** 2
        h = b * b - c
        if h < 0:
            return math.inf, None
        t = -b - math.sqrt(h) if -b - math.sqrt(h) > 0 else -b + math.sqrt(h)
        normal = [(x + t * y) / self.radius for x, y in zip(f, way)]
        seen = normal if dot(normal, way) < 0 else [-x for x in normal]
        return (t, seen) if t > 0 else (math.inf, None)


class Slab:
    """A box along the axes, of which the faces are met one by one."""
    def __init__(self, rng):
        self.low = [rng.uniform(-2, 1), rng.uniform(-1.5, 1), rng.uniform(-1, 2)]
        self.high = [x + rng.uniform(0.2, 0.9) for x in self.low]
        self.colour = [rng.uniform(0, 1) for _ in range(3)]
        self.text = f"box {{ {vector(self.low)}, {vector(self.high)} pigment {{ rgb {vector(self.colour)} }} }}\n"

    def meet(self, eye, way):
        best = math.inf, None
        for axis in range(3):
            for side in (self.low, self.high):
                t = (side[axis] - eye[axis]) / way[axis] if way[axis] else math.inf
                at = [x + t * y for x, y in zip(eye, way)]
                if 0 < t < best[0] and all(i == axis or self.low[i] <= at[i] <= self.high[i] for i in range(3)):
                    best = t, [-math.copysign(1, way[axis]) if i == axis else 0 for i in range(3)]
        return best


def expected(shapes, eye, x, y):
    """What the pixel sees of a camera at `eye` that looks along z, 4/3 wide and 1 high at the distance 1:
    (distance, normal, number), number."""
    way = [(x + 0.5) / WIDTH - 0.5, 0.5 - (y + 0.5) / HEIGHT, 1.0]
    way[0] *= 4 / 3
    length = math.sqrt(dot(way, way))
    way = [w / length for w in way]
    met = sorted((shape.meet(eye, way) + (i,) for i, shape in enumerate(shapes)), key=lambda hit: hit[0])
    return met[0], met[0][2]


def test_random(rng):
    """All channels of 20 scenes of spheres and boxes against the equations; single pixels at an edge may differ."""
    apart, pixels, objects, beyond = 0, 0, set(), 0.0
    for _ in range(20):
        shapes = [rng.choice((Ball, Slab))(rng) for _ in range(rng.choice((3, 8, 20)))]
        eye = [rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), -5.0]
        scene = "camera { location %s direction z right 4/3*x up y }\n" % vector(eye) + "".join(s.text for s in shapes)
        found = planes(scene)
        for i in range(WIDTH * HEIGHT):
            (t, normal, _), index = expected(shapes, eye, i % WIDTH, i // WIDTH)
            told = [found[name][i] for name in SURFACE]
            wanted = [math.inf] + 7 * [0] if t == math.inf else [t, *normal, index + 1, *shapes[index].colour]
            pixels += 1
            objects.add(told[4])
            if told[4] != wanted[4]:
                apart += 1
            elif t < math.inf:
                beyond = max(beyond, *(abs(a - b) / max(1, abs(b)) for a, b in zip(told, wanted)))
            elif told != wanted:
                apart += 1
    tap.ok(apart <= pixels / 10000 and beyond < 2e-6 and len(objects) > 10,
           f"{pixels} pixels of random spheres and boxes: distance, normal, object, colour are those of the equations",
           f"{apart} pixels see another object, the others are off by {beyond:g}")


SCENE = """camera { location <0, 1, -6> look_at <0, 0.5, 0> }
light_source { <-5, 8, -6>, 1 }
background { rgbt <.2, .3, .5, 1> }
plane { y, 0 pigment { checker rgb 1, rgb .2 } normal { bumps .5 } }
union { sphere { <-1.5, 1, 0>, 1 } cylinder { <-1.5, 0, 0>, <-1.5, 2.5, 0>, .3 } pigment { rgb <.8, .1, .1> } }
difference { box { <0, 0, -.5>, <1, 1, .5> } sphere { <.5, 1, -.5>, .4 } pigment { rgb <.1, .8, .1> } }
sphere { <2.5, 1, 1>, 1 texture { pigment { rgb <.6, .4, .2> } } texture { pigment { rgbt <1, .5, 1, .75> } } }
sphere { <0, 2.2, 0>, .5 pigment { rgbf <1, 1, 0, .5> } scale <1.2, 1, 1> }
"""


def test_kinds():
    """Objects that are no single spheres and boxes."""
    found = planes(SCENE)
    numbers = set(found["object"])
    tap.equal(numbers, {0, 1, 2, 3, 4, 5, 6}, "objects are counted as the text declares them: of a union each shape, a "
              "difference as one")
    colours = {number: set() for number in range(7)}
    for number, *colour in zip(found["object"], *(found["albedo." + c] for c in "RGB")):
        colours[number].add(tuple(round(c, 6) for c in colour))
    tap.equal((colours[0], colours[1], colours[2], colours[4]),
              ({(0, 0, 0)}, {(1, 1, 1), (0.2, 0.2, 0.2)}, {(0.8, 0.1, 0.1)}, {(0.1, 0.8, 0.1)}),
              "colours are those of the pigments at the points that are seen")
    tap.equal((colours[5], colours[6]), ({(0.7, 0.425, 0.4)}, {(0.5, 0.5, 0)}),
              "through layers as far as these let light through, of what is clear as far as it is opaque")
    lengths = {round(math.hypot(*n), 6) for n in zip(*(found["normal." + c] for c in "XYZ"))}
    normals = zip(found["object"], *(found["normal." + c] for c in "XYZ"))
    floor = {tuple(normal) for number, *normal in normals if number == 1}
    tap.ok(lengths == {0, 1} and floor == {(0, 1, 0)}, "normals are of length 1, without bumps", f"{lengths} {floor}")
    inside = planes("camera { location 0 look_at z } sphere { 0, 2 pigment { rgb 1 } }")
    along = [-x * z for x, z in zip(inside["normal.Z"], inside["Z"])]
    tap.ok(set(map(lambda z: round(z, 6), inside["Z"])) == {2} and min(along) > 0,
           "from within the far side is seen, and its normal is turned to the eye")


def test_ray_log():
    """Distance and normal of pixels are those that --trace-pixel reports."""
    found, fine = planes(SCENE), 0
    for x, y in ((20, 15), (8, 14), (24, 16), (33, 12), (20, 7), (5, 28)):
        with open("scene.scn", "w", encoding="ascii") as file:
            file.write(HEAD + SCENE)
        said = subprocess.run([RTLANG, "-W", str(WIDTH), "-H", str(HEIGHT), f"--trace-pixel={x},{y}", "scene.scn"],
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=60, check=False).stdout.decode()
        hit = re.search(r"at t = (\S+), off by less", said)
        fine += hit is not None and math.isclose(float(hit[1]), found["Z"][y * WIDTH + x], rel_tol=1e-6)
    tap.equal(fine, 6, "distances are those of --trace-pixel")


def test_same():
    """The same numbers, however the picture is made."""
    plain = planes(SCENE)
    ways = [("with samples", ("--samples=4",)), ("adaptive", ("--samples=6", "--adaptive")),
            ("with one thread", ("-t", "1")), ("with three", ("-t", "3")), ("antialiased", ("--antialias=2",)),
            ("with alpha", ("--alpha",)), ("forward", ("--method=forward-connect", "--photons=1000"))]
    for name, options in ways:
        other = SCENE.split("plane")[0] + "sphere { 0, 1 }" if name == "forward" else SCENE
        found = planes(other, *options)
        want = planes(other) if other != SCENE else plain
        tap.ok(all(found[c] == want[c] for c in SURFACE), f"the same planes {name}")
    left, top, width, height = 7, 5, 20, 11
    part = planes(SCENE, f"--crop={left},{top},{width},{height}")
    cut = {c: [plain[c][(top + i // width) * WIDTH + left + i % width] for i in range(width * height)] for c in SURFACE}
    tap.ok(all(part[c] == cut[c] for c in SURFACE), "a part has the planes of the whole there")
    lens = SCENE.replace("look_at", "aperture 1 focal_point 0 blur_samples 9 look_at")
    blurred = planes(lens)
    tap.ok(all(blurred[c] == plain[c] for c in SURFACE), "a lens does not blur them")


def test_together():
    """Light is what it is without planes, and channels do not exclude each other."""
    rtlang(SCENE, "--samples=8", "--alpha")
    light = read_exr("out.exr")[1]
    status, said = rtlang(SCENE, "--samples=8", "--alpha", "--planes=error,samples,depth")
    found = read_exr("out.exr")[1]
    tap.equal(sorted(found), ["A", "B", "G", "R", "Z", "error", "samples"], "alpha, error, samples and depth in a file")
    tap.ok(status == 0 and all(found[c] == light[c] for c in "RGBA"), "beside the same light", said)
    tap.ok(set(found["samples"]) == {8} and max(found["error"]) > 0, "samples and errors of each pixel")
    rtlang(SCENE, "--samples=8", "--adaptive", "--planes=samples")
    counts = read_exr("out.exr")[1]["samples"]
    told = float(re.search(r"at (\S+) samples a pixel", rtlang(SCENE, "--samples=8", "--adaptive")[1])[1])
    # Corners, which pixels share, are about one ray a pixel, and count as a sample of a pixel that has nothing else.
    beside = told - sum(count for count in counts if count > 1) / len(counts)
    tap.ok(len(set(counts)) > 2 and 0.9 < beside < 1.1, "adaptive runs tell where samples went", f"{beside} {told}")


def test_refused():
    for options, output, words in ((("--planes=depth",), "out.png", "`--planes` wants a picture in EXR"),
                                   (("--planes=depths",), "out.exr", "error, samples, depth, normal"),
                                   (("--planes=depth,",), "out.exr", "error, samples, depth, normal"),
                                   (("--planes=samples",), "out.exr", "only a sampled picture has the planes"),
                                   (("--planes=error", "--samples=4", "--no-estimate"), "out.exr",
                                    "only a sampled picture has the planes")):
        if os.path.exists(output):
            os.remove(output)
        status, said = rtlang(SCENE, *options, output=output)
        tap.ok(status == 2 and words in said and not os.path.exists(output),
               f"refused: {' '.join(options)} to {output}", f"{status} {said}")


def main():
    print(f"# RTLANG_SEED={SEED} repeats this run")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if "E0507" in rtlang(SCENE)[1]:
            tap.skip("planes of a picture", "built without OpenImageIO")
        else:
            test_random(random.Random(SEED))
            test_kinds()
            test_ray_log()
            test_same()
            test_together()
            test_refused()
        os.chdir("/")
    tap.done()


main()
