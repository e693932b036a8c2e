#!/usr/bin/env python3
# Each allocation of runs of several kinds fails in turn, alone or with all after it: the run ends with exit code 4 and
# a message, or does its work without; the old picture stays, nothing is left over, nothing leaks. Prints TAP.
#
# Wants RTLANG, CC and top_srcdir. Takes about fifty allocations of each run; MEMORY_ALL=1 takes all of them.
#
# SPDX-License-Identifier: MIT
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from tap import Tap

RTLANG = os.path.abspath(os.environ["RTLANG"])
SOURCE = os.path.join(os.environ["top_srcdir"], "tests", "system", "failing_memory.c")
OLD = b"an old picture"
LOST_BY_LOADER = 1  # glibc 2.36 loses a block where dlopen fails in _dl_find_object_update
TAKEN = None if os.environ.get("MEMORY_ALL") else 50
tap = Tap()

HEAD = "camera { location <0, 1, -6> look_at 0 }\nlight_source { <5, 9, -5>, 1 area_light x, z, 3, 3 }\n"
FILES = {
    "plain.scn": HEAD + "#for (I, 1, 300) sphere { <mod(I, 9) - 4, 0, I>, 0.4 pigment { rgb <I/300, 1, 0> } } #end\n",
    "shapes.scn": HEAD + """#macro Ball(P, R) sphere { P, R } #end
difference { box { -1, 1 } Ball(0, 1.2) pigment { checker rgb 1 rgb <1, 0, 0> } normal { bumps 0.3 } }
union { cylinder { 0, y, 1 } cone { y, 1, 2*y, 0 } texture { pigment { bozo color_map { [0 rgb 1] [1 rgbt 1] } } }
    interior { ior 1.5 } translate 2*x }
plane { y, -1 finish { reflection 0.3 } }
""",
    "reads.scn": HEAD + """#include "part.inc"
#fopen Data "data.txt" read
#while (defined(Data)) #read (Data, A, B) #debug concat(str(A, 0, 1), "\\n") #end
#declare F = function (x) { x*x + sin(x) }
#declare L = array[3] { 1, 2, 3 }
#declare S = spline { linear_spline 0, 0 1, F(1) 2, L[1] }
sphere { S(0.5), 1 texture { Skin } }
""",
    "part.inc": "#declare Skin = texture { pigment { rgb <1, 0.5, 0> } finish { phong 0.5 } }\n",
    "data.txt": "1, 2,\n3, 4\n",
    "lists.scn": HEAD + """#declare Skin = texture { pigment { rgb <1, 0.5, 0> } }
mesh2 {
    vertex_vectors { 4, <-2, 0, 0>, <-1, 0, 0>, <-2, 1, 0>, <-2, 0, 1> }
    texture_list { 2, texture { Skin } texture { pigment { rgb 1 } } }
    face_indices { 4, <0, 2, 1>, 0, <0, 1, 3>, 1, <0, 3, 2>, 0, <1, 2, 3>, 1 }
    inside_vector <0, 0, 1>
}
mesh { smooth_triangle { 0, z, x, z + x, y, z + y } translate 2*y }
blob { threshold 0.5 sphere { 0, 1, 1 } cylinder { 0, 2*y, 0.5, 1 } pigment { rgb 1 } }
prism { cubic_spline conic_sweep 0, 1, 7, <0, -1>, <1, 0>, <0, 1>, <-1, 0>, <0, -1>, <1, 0>, <0, 1> translate 2*x }
difference { poly { 4, <1, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, -1> }
    torus { 1, 0.2 } pigment { function { sin(9*x) + y } color_map { [0 rgb 0] [1 rgb 1] } } }
#declare F = function { pattern { bozo warp { turbulence 0.5 } } }
#declare Ball = sphere { 0, 1 }
sphere { trace(Ball, -3*z, z), 0.2 + 0.1*F(1, 2, 3) }
fog { fog_type 2 distance 20 fog_alt 1 turbulence 0.3 rgb 1 }
""",
    "letters.scn": HEAD + 'text { ttf "timrom.ttf" "rt" 0.3, 0 pigment { rgb 1 } translate -x }\n',
    "nothing.scn": HEAD + """#if (file_exists("nowhere.inc")) #end
text { ttf "nowhere.ttf" "rt" 0.3, 0 }
#fopen Data "nowhere.txt" read
#include "colours.inc"
""",
    "image.scn": HEAD + 'box { -1, 1 pigment { image_map { png "map.png" } } }\n',
    "wrong.scn": HEAD + "sphere { 0, Raduis pigmant { rgb 1 } }\nspere { 0, 1 }\n",
}
DRAW = ["-q", "-t1", "-W16", "-H12", "-o", "old.png"]
RUNS = {
    "spheres": [*DRAW, "-D", "N=1", "-I", ".", "--allow-read=.", "plain.scn"],
    "samples and an error map": [*DRAW, "--samples=4", "--adaptive", "shapes.scn"],
    "shapes in two threads": [*DRAW, "-t2", "shapes.scn"],
    "include, data, functions": [*DRAW, "reads.scn"],
    "a picture as image_map": [*DRAW, "image.scn"],
    "meshes, blobs, prisms, functions": [*DRAW, "lists.scn"],
    "text": [*DRAW, "letters.scn"],
    "files that are not there": [*DRAW, "nothing.scn"],
    "a faulty scene": [*DRAW, "wrong.scn"],
    "messages in JSON": [*DRAW, "--diagnostics=json", "wrong.scn"],
    "--dump=scene": ["--dump=scene", "shapes.scn"],
    "--format": ["--format", "shapes.scn"],
    "options that are wrong": ["--witdh=5", "plain.scn"],
}


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


class Run:
    """One run of the program with allocation number `at` failing, 0: none."""

    def __init__(self, arguments, at, goes_on=False):
        self.arguments = arguments
        write("old.png", OLD)
        before = set(os.listdir())
        how = {"LD_PRELOAD": os.path.abspath("failing.so"), "FAIL_AT": str(at), "FAIL_LOG": "log", "LC_ALL": "C"}
        environment = {**os.environ, **how, **({"FAIL_ON": "1"} if goes_on else {})}
        done = subprocess.run([RTLANG, *arguments], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=120, check=False)
        self.code, self.said = done.returncode, (done.stdout, done.stderr)
        with open("old.png", "rb") as file:
            self.picture = file.read()
        self.left = set(os.listdir()) - before - {"log"}
        self.calls = self.held = 0
        if os.path.exists("log"):
            with open("log", encoding="ascii") as file:
                self.calls, self.held = map(int, file.read().split())
            os.remove("log")

    def fault(self, good):
        """What is wrong with it, or None."""
        if self.left:
            return "left over: %s" % self.left
        if self.held > good.held + (LOST_BY_LOADER if "letters.scn" in self.arguments else 0):
            return "%d blocks leak" % (self.held - good.held)
        if (self.code, self.said, self.picture) == (good.code, good.said, good.picture):
            return None
        if self.code != 4 or b"E060" not in self.said[1]:
            return "exit %d, %r" % (self.code, self.said[1][:200])
        return None if self.picture == OLD else "the old picture is gone"


def check(name, arguments):
    good = Run(arguments, 0)
    if b"text needs FreeType" in good.said[1] or b"font `timrom.ttf` not found" in good.said[1]:
        tap.skip("%s: every allocation failed in turn" % name, "no FreeType, or none of POV-Ray's fonts")
        return
    step = max(1, good.calls // TAKEN) if TAKEN else 1
    faults = []
    for goes_on in False, True:
        for at in range(1, good.calls + 1, step):
            fault = Run(arguments, at, goes_on).fault(good)
            if fault:
                faults.append("allocation %d of %d%s: %s" % (at, good.calls, " and all after it" * goes_on, fault))
    tap.ok(not faults, "%s: every allocation failed in turn" % name, "%d faults\n%s" % (len(faults), "\n".join(faults)))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        built = subprocess.run("%s -shared -fPIC -O1 -o failing.so '%s'" % (os.environ.get("CC", "cc"), SOURCE),
                               shell=True, stderr=subprocess.PIPE, check=False)
        for name, text in FILES.items():
            write(name, text.encode())
        subprocess.run([RTLANG, "-q", "-W9", "-H7", "-o", "map.png", "plain.scn"], check=True)
        if built.returncode != 0 or Run(["--version"], 0).calls == 0:
            tap.skip("allocations that fail", "nothing can be preloaded")
        else:
            for name, arguments in RUNS.items():
                check(name, arguments)
        os.chdir("/")
    tap.done()


main()
