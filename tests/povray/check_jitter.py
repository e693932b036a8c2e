#!/usr/bin/env python3
"""Area lights with `jitter`, and `crand`, beside POV-Ray's, as samples of one distribution: each column of a picture of a half shadow whose edge is
upright has rows that are equal but for chance, so the means of both programs' columns are compared by a z-test.

The same test rejects a light without jitter, so it can tell. A scene with shapes is held by chance.py, which
`make survey` uses, too: as it is, and with the light of one program moved by a twentieth of its size, which must be told
apart. Prints TAP.
SPDX-License-Identifier: MIT
"""
import os
import statistics
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import chance  # noqa: E402
import pictures  # noqa: E402
from tap import Tap  # noqa: E402

WIDTH, HEIGHT = 48, 256
POVRAY_HEIGHT = 32  # its blocks of 32 by 32 pixels have the same random numbers, so that more rows would say nothing new
SCENE = """#version 3.7; global_settings { assumed_gamma 1 }
camera { orthographic location -4*z right 3*x up y direction z }
light_source { -10*z, 1 area_light 2*x, 2*y, 4, 4 %s }
box { <0, -50, -5>, <50, 50, -4.9> no_image }
plane { -z, 0 pigment { rgb 1 } finish { ambient 0 diffuse 0.9 } }
"""
LIGHTS = {"plain": "jitter", "circular": "circular jitter", "adaptive": "adaptive 0 jitter", "turned": "circular orient jitter"}
# Of 48 columns and four lights none is beyond 5 by chance but once in 9000 runs; the mean of the squares of 48 normal numbers
# is above 2 once in 20000.
GREATEST, MEAN_SQUARE = 5.0, 2.0

SHAPES = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 2, -8> right x*4/3 angle 45 look_at 0 }
light_source { <-4 + %s, 8, -6>, rgb 1.2 area_light 3*x, 3*z, 5, 5 jitter %s }
plane { y, -1 pigment { rgb 0.9 } finish { ambient 0.1 diffuse 0.8 } }
sphere { <0, 0, 0>, 1 pigment { rgb <1, 0.4, 0.2> } finish { ambient 0.1 diffuse 0.7 phong 0.4 } }
difference { box { <1.5, -1, -1>, <3, 0.5, 1> } sphere { <2.2, 0.5, -1>, 0.7 } pigment { rgb <0.3, 0.8, 0.4> } }
cylinder { <-2.5, -1, 1>, <-2, 1.5, 0>, 0.3 pigment { rgb <0.3, 0.4, 1> } }
"""
SHAPES_SIZE = (96, 72)
MOVED = 0.15  # a twentieth of the light's 3


def judge_shapes(tap, folder):
    """Two lines for each kind of jittered light: like POV-Ray's, and told apart when it is moved."""
    for light in "", "circular orient", "adaptive 1":
        scene = os.path.join(folder, "shapes.pov")
        draws = {}
        for moved in 0, MOVED:
            with open(scene, "w", encoding="ascii") as out:
                out.write(SHAPES % (moved, light))
            draws[moved] = chance.draw_rtlang(scene, folder, [], SHAPES_SIZE)
            if moved == 0:
                theirs = chance.draw_povray(scene, folder, [], SHAPES_SIZE)
        like, apart = chance.judge(draws[0], theirs), chance.judge(draws[MOVED], theirs)
        name = light or "plain"
        tap.ok(like["like"] and like["loose"] >= 40, f"shapes, {name}: {chance.words(like)}")
        tap.ok(not apart["like"], f"shapes, {name}, the light moved by a twentieth: {chance.words(apart)}")


GRAIN = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 2, -8> right x*4/3 angle 45 look_at 0 }
light_source { <-4, 8, -6>, rgb 0.8 }
light_source { <6, 3, -9>, rgb <0.3, 0.4, 0.5> }
plane { y, -1 pigment { rgb 0.9 } finish { ambient 0.1 diffuse 0.8 crand %s } }
sphere { <0, 0, 0>, 1 pigment { rgb <1, 0.4, 0.2> } finish { diffuse 0.7 brilliance 1.5 phong 0.4 crand 0.2 } }
sphere { <2, 0, 0>, 0.9 texture { gradient y texture_map { [0 pigment { rgb 0.7 } finish { crand 0.4 }] [1 pigment { rgb 0.4 }] } } }
"""


def judge_grain(tap, folder):
    """`crand`: like POV-Ray's, and told apart when it is a tenth more."""
    scene = os.path.join(folder, "grain.pov")
    draws = {}
    for amount in 0.3, 0.33:
        with open(scene, "w", encoding="ascii") as out:
            out.write(GRAIN % amount)
        draws[amount] = chance.draw_rtlang(scene, folder, [], SHAPES_SIZE)
        if amount == 0.3:
            theirs = chance.draw_povray(scene, folder, [], SHAPES_SIZE)
    like, apart = chance.judge(draws[0.3], theirs), chance.judge(draws[0.33], theirs)
    tap.ok(like["like"] and like["loose"] >= 40, f"crand: {chance.words(like)}")
    tap.ok(not apart["like"], f"crand, a tenth more: {chance.words(apart)}")


LAYERS = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location -5 * z look_at 0 }
light_source { -1000 * z, rgb 1 }
#declare Grainy = finish { ambient 0.2 diffuse 0.6 crand 0.1 }
plane { z, 0
    texture { pigment { rgb 0.5 } finish { Grainy } }
    texture { pigment { rgb 1 transmit 0.6 } finish { Grainy } }
    texture { pigment { rgb 1 transmit 0.6 } finish { Grainy } }
    texture { pigment { rgb 0.7 transmit 1 } finish { Grainy } }
}
"""


def judge_layers(tap, folder):
    """Each layer has grain of its own, a clear one, too: all of one would be twice as uneven."""
    scene, picture = os.path.join(folder, "layers.pov"), os.path.join(folder, "layers.png")
    with open(scene, "w", encoding="ascii") as out:
        out.write(LAYERS)
    found = []
    for program in pictures.render_rtlang, pictures.render_povray:
        program(scene, picture, [], *SHAPES_SIZE)
        values = pictures.read_png(picture, depths=(16,))[2][::3]
        found.append((statistics.fmean(values), statistics.variance(values)))
    (mean, variance), (their_mean, their_variance) = found
    z = (mean - their_mean) / ((variance + their_variance) / (SHAPES_SIZE[0] * SHAPES_SIZE[1])) ** 0.5
    tap.ok(abs(z) < 4, f"crand of layers: the means are {z:.2f} of their errors apart")
    tap.ok(0.9 < variance / their_variance < 1.1, f"crand of layers: the variance is {variance / their_variance:.3f} times POV-Ray's")


def columns(path):
    """[(mean, variance of the mean)] of the columns, in shares of light."""
    width, height, values = pictures.read_png(path)
    found = []
    for x in range(width):
        column = [values[3 * (y * width + x)] / 65535 for y in range(height)]
        found.append((statistics.fmean(column), statistics.variance(column) / height))
    return found


def scores(one, other):
    """z of each column in which anything is left to chance."""
    return [(a - b) / (va + vb) ** 0.5 for (a, va), (b, vb) in zip(one, other) if vb * POVRAY_HEIGHT > 1e-4]


def render(program, text, folder, height=HEIGHT):
    scene, picture = os.path.join(folder, "scene.pov"), os.path.join(folder, "picture.png")
    with open(scene, "w", encoding="ascii") as out:
        out.write(text)
    program(scene, picture, [], WIDTH, height)
    return columns(picture)


def is_like(found):
    return max(map(abs, found)) <= GREATEST and statistics.fmean(z * z for z in found) <= MEAN_SQUARE


def words(found):
    return (f"{len(found)} columns, greatest |z| {max(map(abs, found)):.2f}, "
            f"mean z² {statistics.fmean(z * z for z in found):.2f}")


def main():
    tap = Tap()
    if not pictures.povray():
        tap.skip("jitter", "povray is not installed")
        return tap.done()
    with tempfile.TemporaryDirectory() as folder:
        for name, light in LIGHTS.items():
            ours = render(pictures.render_rtlang, SCENE % light, folder)
            theirs = render(pictures.render_povray, SCENE % light, folder, POVRAY_HEIGHT)
            found = scores(ours, theirs)
            tap.ok(len(found) >= 12 and is_like(found), f"{name}: {words(found)}", found)
            spread = sum(v for _, v in ours) * HEIGHT / (sum(v for _, v in theirs) * POVRAY_HEIGHT)
            tap.ok(0.8 < spread < 1.25, f"{name}: the variances of rtlang's columns are {spread:.3f} times POV-Ray's")
            still = scores(render(pictures.render_rtlang, SCENE % light.replace("jitter", ""), folder), theirs)
            tap.ok(not is_like(still), f"{name}: without jitter it is told apart: {words(still)}")
        judge_shapes(tap, folder)
        judge_grain(tap, folder)
        judge_layers(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
