#!/usr/bin/env python3
"""--trace-pixel from the command line: the drawing in a file, the digits, and what is refused. Prints TAP.

Wants RTLANG, the program.

SPDX-License-Identifier: MIT
"""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from tap import Tap  # noqa: E402

RTLANG = os.path.abspath(os.environ["RTLANG"])
SVG = "{http://www.w3.org/2000/svg}"
SCENE = """#version 3.7; global_settings { assumed_gamma 1 } camera { location -5*z look_at 0 }
light_source { <4, 5, -6> rgb 1 } sphere { 0.3*y, 1 finish { reflection 0.5 } } plane { y, -1 }
"""
tap = Tap()
TOUCH = """#version 3.7; global_settings { assumed_gamma 1 }
camera { orthographic location -5*z direction z right x up y } light_source { <-5, 8, -5> rgb 1 }
sphere { x, 1 pigment { rgb 0.5 } }
"""


def trace(*options):
    done = subprocess.run([RTLANG, "-W9", "-H9", *options, "a.scn"], capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stdout, done.stderr


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("a.scn", "w", encoding="ascii") as out:
            out.write(SCENE)
        code, plain, said = trace("--trace-pixel=4,4")
        tap.ok(code == 0 and not said and "the tree of its " in plain and "t1 = " in plain, "the log", said)
        code, text, said = trace("--trace-pixel=4,4", "--trace-svg=ray.svg")
        tap.ok(code == 0 and text == plain and sorted(os.listdir(".")) == ["a.scn", "ray.svg"], "a drawing changes nothing of the log", said)
        root = xml.etree.ElementTree.parse("ray.svg").getroot()
        kinds = [line.get("class") for line in root.iter(SVG + "line")]
        tap.ok(root.tag == SVG + "svg" and root.get("role") == "img" and root.find(SVG + "title").text and
               {"camera", "mirrored", "light", "normal"} <= set(kinds), "it is SVG with a title and its lines", kinds)
        code, text, said = trace("--trace-pixel=4,0", "--trace-svg=ray.svg")
        root = xml.etree.ElementTree.parse("ray.svg").getroot()
        bodies = [each for each in root.iter(SVG + "circle") if each.get("class") == "body"]
        names = {each.text for each in root.iter(SVG + "text")}
        tap.ok("meets nothing" in text and bodies and float(bodies[0].get("cx")) < 640 and names == {"e"},
               "a sphere that the ray passes near by is drawn", text + str(names))
        with open("touch.scn", "w", encoding="ascii") as out:
            out.write(TOUCH)
        done = subprocess.run([RTLANG, "-W1", "-H1", "--trace-pixel=0,0", "--trace-svg=ray.svg", "touch.scn"], capture_output=True, check=False)
        names = {each.text for each in xml.etree.ElementTree.parse("ray.svg").getroot().iter(SVG + "text")}
        tap.ok(done.returncode == 0 and names == {"e", "t1 = t2", "N"}, "two roots at one point have one label", names)
        code, text, said = trace("--trace-pixel=4,4", "--digits=3", "--trace-svg=-")
        tap.ok(code == 0 and len(text.partition("<svg ")[0]) < len(plain) and text.endswith("</svg>\n"), "short numbers; `-` is standard output", said)
        code, text, said = trace("--trace-pixel=4,4", "--trace-svg=nowhere/ray.svg")
        tap.ok(code == 3 and "nowhere/ray.svg" in said, "a file that cannot be written", said)
        for option in "--digits=3", "--trace-svg=ray.svg":
            code, text, said = trace(option)
            tap.ok(code == 2 and "wants `--trace-pixel`" in said, f"{option} alone is refused", said)
        code, text, said = trace("--trace-pixel=4,4", "--digits=18")
        tap.ok(code == 2 and "1 to 17" in said, "no number has 18 digits", said)
        os.chdir("/")
    tap.done()


if __name__ == "__main__":
    main()
