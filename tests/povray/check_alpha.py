#!/usr/bin/env python3
"""--alpha against POV-Ray's +UA: what is behind a scene, in all four channels, within 2/65535.

Scenes that each have something to see through, drawn with all kinds of backgrounds, as scenes of version 3.7 and of 3.6, and
with both ways of anti-aliasing; EXR, too. That it changes no picture where nothing is behind. Prints TAP.
SPDX-License-Identifier: MIT
"""
import concurrent.futures
import os
import shutil
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import exr  # noqa: E402
import pictures  # noqa: E402
from tap import Tap  # noqa: E402

WIDTH, HEIGHT = 64, 48
TIES = 2e-3  # silhouettes are a large part of small pictures
BACKGROUNDS = {
    "none": "",
    "opaque": "background { rgb <0.5, 0.25, 0.1> }",
    "transmit": "background { rgbt <0.5, 0.25, 0.1, 0.4> }",
    "filter": "background { rgbft <0.5, 0.35, 0.1, 0.3, 0.4> }",
    "clear": "background { rgbt 1 }",
}
CAMERA = "camera { location <0, 0.5, -4> look_at 0 angle 50 } light_source { <-4, 6, -5>, 0.9 }\n"
THINGS = {
    "two sheets of glass": """sphere { 0, 1 pigment { rgbft <0.8, 0.6, 0.4, 0.3, 0.2> } finish { emission 0.3 } }
        sphere { <0.7, 0.3, 1>, 0.8 pigment { rgbft <0.2, 0.9, 0.5, 0.4, 0.3> } }""",
    "mirrors": """sphere { 0, 1 pigment { rgbt <0.8, 0.6, 0.4, 0.3> } finish { reflection { 0.1, 0.7 } conserve_energy } }
        sphere { <1.2, 0.3, 1>, 0.8 pigment { rgb <0.2, 0.9, 0.5> } finish { reflection 0.5 } }
        sphere { <-1.5, 0, 0>, 0.4 pigment { rgbt 0.8 } }""",
    "glass": """sphere { 0, 1 pigment { rgbft <0.9, 0.8, 0.7, 0.5, 0.4> } interior { ior 1.5 fade_distance 1 fade_power 2
        fade_color <0.5, 0.6, 0.7> } }""",
    "layers": """sphere { 0, 1 texture { pigment { checker rgbft <0.2, 0.9, 0.5, 0.4, 0.1>, rgbt <1, 1, 0, 0.8> scale 0.3 } }
        texture { pigment { rgbft <0.8, 0.6, 0.4, 0.3, 0.2> } } }""",
    "sky": """sky_sphere { pigment { gradient y color_map { [0 rgbft <0.3, 0.2, 0.7, 0.25, 0.3>] [1 rgbt <1, 0, 0, 0.9>] } }
        pigment { rgbft <0.8, 0.5, 0.6, 0.35, 0.4> } }
        sphere { 0, 1 pigment { rgbft <0.8, 0.6, 0.4, 0.3, 0.2> } finish { reflection 0.3 } }""",
    "fog": """fog { distance 5 rgbft <0.1, 0.2, 0.3, 0.6, 0.3> } fog { distance 7 rgbft <0.7, 0.2, 0.1, 0.5, 0.4> }
        sphere { 0, 1 hollow pigment { rgbft <0.8, 0.6, 0.4, 0.3, 0.2> } finish { reflection 0.3 } }""",
    "bumps": """sphere { 0, 1 pigment { rgbft <0.8, 0.6, 0.4, 0.3, 0.4> } normal { onion 0.4 scale 0.4 } interior { ior 1.2 }
        finish { reflection 0.2 } }""",
    "a fisheye": """camera { fisheye location -4*z angle 60 right 1.33*x up y }
        sphere { 0, 1 pigment { rgbft <0.8, 0.6, 0.4, 0.3, 0.2> } }""",
}
GAMMAS = {"3.7": "#version 3.7; global_settings { assumed_gamma 1 }\n", "gamma 2.2": "#version 3.7; global_settings { assumed_gamma 2.2 }\n",
          "sRGB": "#version 3.7; global_settings { assumed_gamma srgb }\n", "3.6": "#version 3.6; global_settings { assumed_gamma 1 }\n",
          "3.6 without gamma": "#version 3.6;\n", "no version": "global_settings { assumed_gamma 1 }\n"}


def read_rgba(path):
    """The values of a 16-bit PNG with alpha, from the top row."""
    width, height, values = pictures.read_png(path, 4, (16,))
    if (width, height) != (WIDTH, HEIGHT):
        raise ValueError(f"{path}: {width}x{height}")
    return values


def call(arguments):
    done = pictures.call(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120)
    if done.returncode:
        raise pictures.RunFailed(arguments[0], done.returncode, done.stdout.decode("utf-8", "replace"))


def render(text, folder, ours=(), theirs=(), kind=("png", "+FN16")):
    """The two files of a scene."""
    scene = os.path.join(folder, "scene.pov")
    names = [os.path.join(folder, f"{who}.{kind[0]}") for who in ("ours", "theirs")]
    with open(scene, "w", encoding="ascii") as out:
        out.write(text)
    depth = ["--depth=16"] if kind[0] == "png" else []
    call([os.environ["RTLANG"], "-q", "--alpha", f"-W{WIDTH}", f"-H{HEIGHT}", "--file-gamma=1", "-o", names[0], *depth, *ours, scene])
    call([pictures.povray(), f"+I{scene}", f"+O{names[1]}", f"+W{WIDTH}", f"+H{HEIGHT}", kind[1], "+UA", "File_Gamma=1.0", "-D",
          "-P", *(theirs or ["-A"])])
    return names


def apart(one, other):
    """Each pixel's greatest difference. What is not there has no colour; of little, colours are as exact as their share."""
    found = []
    for i in range(0, len(one), 4):
        alpha = other[i + 3] / 65535
        colour = max(abs(one[i + k] - other[i + k]) for k in range(3)) * (alpha if alpha < 0.25 else 1)
        found.append(max(colour, abs(one[i + 3] - other[i + 3])))
    return found


def compare(case):
    """What is to be said of a case: passed, words, and more when it is not."""
    name, text, ours, theirs = case
    with tempfile.TemporaryDirectory() as folder:
        try:
            one, other = (read_rgba(path) for path in render(text, folder, ours, theirs))
        except pictures.RunFailed as failure:
            return False, name, failure.text
    steps = apart(one, other)
    beyond = sum(step > pictures.CODE_BAR for step in steps)
    return (beyond <= TIES * len(steps),
            f"{name}: max {max(steps):.0f}/65535, {beyond} of {len(steps)} pixels beyond {pictures.CODE_BAR}/65535",
            [(i, one[4 * i:4 * i + 4], other[4 * i:4 * i + 4]) for i in range(len(steps)) if steps[i] > pictures.CODE_BAR][:4])


def cases():
    """(name, scene, rtlang's options, POV-Ray's) of each pair of pictures."""
    glass = GAMMAS["3.7"] + CAMERA + BACKGROUNDS["transmit"] + THINGS["two sheets of glass"]
    return ([(f"{thing}, background {background}", GAMMAS["3.7"] + CAMERA + statement + words, (), ())
             for thing, words in THINGS.items() for background, statement in BACKGROUNDS.items()] +
            [(f"{thing}, {gamma}", head + CAMERA + BACKGROUNDS["transmit"] + THINGS[thing], (), ())
             for gamma, head in GAMMAS.items() for thing in ("layers", "sky", "fog", "mirrors")] +
            [(f"anti-aliasing {method} from {threshold}", glass,
              [f"--antialias={method}", f"--antialias-threshold={threshold}"],
              [f"+A{threshold}", f"+AM{method}", "+R3", "-J"]) for method in (1, 2) for threshold in (0.1, 0.4)])


def compare_opaque(tap, folder):
    """Where nothing is behind, the colours are those without alpha."""
    text = GAMMAS["3.7"] + CAMERA + BACKGROUNDS["opaque"] + THINGS["glass"]
    ours = render(text, folder)[0]
    plain = os.path.join(folder, "plain.png")
    call([os.environ["RTLANG"], "-q", f"-W{WIDTH}", f"-H{HEIGHT}", "--file-gamma=1", "--depth=16", "-o", plain,
          os.path.join(folder, "scene.pov")])
    values, expected = read_rgba(ours), pictures.read_png(plain)[2]
    tap.ok([value for i, value in enumerate(values) if i % 4 < 3] == expected and set(values[3::4]) == {65535},
           "with an opaque background the colours are those of the picture without alpha")


def compare_exr(tap, folder):
    """Colours are multiplied with alpha there. POV-Ray writes numbers of 16 bits, which oiiotool makes ones of 32."""
    if not shutil.which("oiiotool"):
        tap.skip("EXR", "oiiotool is not installed")
        return
    text = GAMMAS["gamma 2.2"] + CAMERA + BACKGROUNDS["transmit"] + THINGS["two sheets of glass"]
    try:
        ours, theirs = render(text, folder, kind=("exr", "+FE"))
    except pictures.RunFailed as failure:
        if "E0507" in failure.text:
            tap.skip("EXR", "built without OpenImageIO")
            return
        raise
    wide = os.path.join(folder, "wide.exr")
    call(["oiiotool", theirs, "-d", "float", "--compression", "zip", "-o", wide])
    one, other = exr.read_exr(ours)[1], exr.read_exr(wide)[1]
    worst = max(abs(a - b) / max(abs(b), 2.0 ** -14) for c in "RGBA" for a, b in zip(one[c], other[c]))
    tap.ok(worst <= 2.0 ** -10, f"EXR: within {worst:.2g} of POV-Ray's numbers, which have 11 bits")


def main():
    tap = Tap()
    if not pictures.povray():
        tap.skip("alpha", "povray is not installed")
        return tap.done()
    with tempfile.TemporaryDirectory() as folder:
        with concurrent.futures.ThreadPoolExecutor(2 * (os.cpu_count() or 1)) as pool:
            for passed, name, more in pool.map(compare, cases()):
                tap.ok(passed, name, more)
        compare_opaque(tap, folder)
        compare_exr(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
