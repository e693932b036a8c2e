#!/usr/bin/env python3
"""Scenes of which each rank of MPI has a part: the bytes of one process, its messages, and what is refused.

With CHECK_LONG=1 over 1, 2, 3, 5 and 8 ranks; `memory SPHERES RANKS` says what each rank of such a scene takes at its
peak, beside one process. Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import random
import resource
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_ranks import ENVIRONMENT, of_ranks, ranks, run_checks  # noqa: E402
from check_share import PROGRAM, Place  # noqa: E402

LONG = "CHECK_LONG" in os.environ
COUNTS = (1, 2, 3, 5, 8) if LONG else (3,)
SIZE = ["-W", "80", "-H", "60", "-t", "2"]
HEAD = """#version 3.7; global_settings { assumed_gamma 1 max_trace_level 5 }
background { rgb <0.2, 0.3, 0.5> }
"""
VIEW = "camera { location <0, 2, -8> look_at 0 }\nlight_source { <20, 30, -20>, rgb 1 }\n"
FLOOR = "plane { y, -2 pigment { rgb <0.7, 0.7, 0.6> } finish { reflection 0.2 } }\n"
LOOP = """#declare R = seed(4); #declare I = 0;
#while (I < 300)
  sphere { <rand(R) * 6 - 3, rand(R) * 4 - 2, rand(R) * 6 - 3>, 0.1 + 0.2 * rand(R) pigment { rgb <rand(R), rand(R), 0.4> }
    #if (mod(I, 3) = 0) finish { reflection 0.4 phong 0.6 } #end }
  #declare I = I + 1;
#end
"""


def literal(count, aside=0.0, colours=True, clear=False):
    lines = []
    for i in range(count):
        place = "<%.5f, %.5f, %.5f>" % (random.gauss(0, 2) + aside, random.gauss(0, 1.5), random.gauss(0, 2))
        colour = "rgb <%.3f, %.3f, %.3f>" % (random.random(), random.random(), random.random() if colours else 0.5)
        colour = "rgbf <%.3f, 0.9, 0.8, 0.7>" % random.random() if clear and i % 3 == 0 else colour
        finish = " finish { reflection 0.3 phong 0.5 }" if i % 7 == 0 else ""
        lines.append("sphere { %s, %.4f pigment { %s }%s }\n" % (place, random.uniform(0.02, 0.2), colour, finish))
    return "".join(lines)


def scenes():
    many = literal(9000)
    equal = "".join("sphere { <%d, 0, 0>, 0.6 pigment { rgb <%d, 1, 0> } }\n" % (i % 5 - 2, i % 2) for i in range(400))
    far = VIEW.replace("<0, 2, -8>", "<1048576, 2, -8>").replace("look_at 0", "look_at <1048576, 0, 0>")
    dyadic = "".join("sphere { <%.4f, %.4f, %.4f>, 0.25 pigment { rgb <1, %.3f, 0> } }\n" %
                     (1048576 + random.randint(-48, 48) / 16, random.randint(-32, 32) / 16, random.randint(-40, 40) / 16,
                      random.random()) for _ in range(200))
    return {
        "loop": (HEAD + VIEW + FLOOR + LOOP, []),
        "clear": (HEAD + VIEW + FLOOR + literal(200, clear=True), []),
        "few": (HEAD + VIEW + "sphere { 0, 1 pigment { rgb x } finish { reflection 0.5 } }\n", []),
        "none": (HEAD + VIEW + FLOOR, []),
        "many": (HEAD + VIEW + many + "#declare A = 1;\n" + many[:len(many) // 3].rsplit("\n", 1)[0] + "\n" + FLOOR, []),
        "equal": (HEAD + VIEW + equal, []),
        "far": (HEAD + far.replace("<20, 30, -20>", "<1048596, 30, -20>") + dyadic, []),
        "inside": (HEAD + VIEW + "sphere { <0, 0, -7>, 6 pigment { rgbt <1, 1, 1, 0.8> } }\n" + LOOP, []),
        "large": (HEAD + VIEW + "sphere { <0, -1e4, 0>, 9998 pigment { rgb 0.7 } }\n" + literal(500), []),
        "area": (HEAD + VIEW.replace("rgb 1 }", "rgb 1 area_light x * 9, z * 9, 3, 3 jitter }") + FLOOR + literal(100),
                 ["--sky-light=0.3"]),
        "edges": (HEAD + VIEW + FLOOR + literal(150), ["--antialias=1", "--antialias-threshold=0.1"]),
        "corners": (HEAD + VIEW + literal(150, clear=True), ["--antialias=2", "--antialias-threshold=0.1", "--alpha"]),
        "crop": (HEAD + VIEW + FLOOR + literal(150), ["--crop=10,20,30,25", "--whole"]),
        "flat": (HEAD + VIEW.replace("camera {", "camera { orthographic") + literal(300), []),
    }


def lines_of(text):
    """What is said of the scene, without the summary, and what mpirun's own library says where there is no /sys."""
    return [line for line in text.splitlines() if "seconds:" not in line and not line.startswith("[hwloc/")]


def check_pictures(test, place):
    for name, (text, options) in scenes().items():
        with open(os.path.join(place.path, name + ".scn"), "w", encoding="utf-8") as file:
            file.write(text)
        code, alone = place.run(*SIZE, *options, "-o", "one.png", name + ".scn")
        expected = place.bytes("one.png")
        test.ok(code == 0 and expected, "%s: one process" % name, alone)
        for count in COUNTS:
            code, said = place.run(*SIZE, *options, "--mpi=scene", "-o", "shared.png", name + ".scn", before=ranks(count))
            test.ok(code == 0 and place.bytes("shared.png") == expected, "%s: %d ranks" % (name, count),
                    "exit %d\n%s" % (code, said))
            test.ok(lines_of(said) == lines_of(alone), "%s: %d ranks say the same" % (name, count), said + "----\n" + alone)
            if place.bytes("shared.png"):
                os.unlink(os.path.join(place.path, "shared.png"))


def check_refused(test, place):
    ball = "sphere { 0, 1 %s }\n"
    for name, text, words, code, expected in (
            ("box", "box { 0, 1 pigment { rgb 1 } }\n", [], 2, "refused.scn:5:1: error[E0714]: a scene cannot be shared with this box"),
            ("checker", ball % "pigment { checker rgb 0, rgb 1 }", [], 2, "E0714]: a scene cannot be shared with patterns, layers"),
            ("interior", ball % "pigment { rgbt 1 } interior { ior 1.5 }", [], 2, "E0714]: a scene cannot be shared with patterns"),
            ("fog", "fog { distance 9 color rgb 1 }\n", [], 2, "refused.scn:5:1: error[E0714]: a scene cannot be shared with fog"),
            ("crand", ball % "pigment { rgb 1 } finish { crand 0.2 }", [], 2, "refused.scn:5:1: error[E0714]: a scene cannot be shared with `crand`"),
            ("samples", ball % "", ["--samples=4"], 2, "error[E0703]: a scene that ranks share is drawn with one ray a pixel"),
            ("frames", ball % "", ["--frames=1..2"], 2, "`--mpi=scene` is for one picture"),
            ("fault", ball % "pigment { rgb nowhere }", [], 1, "error[E02"),
            ("lengths", "sphere { 1e200, 1e-200 }\nsphere { 0, 1e-250 }\n", [], 2, "E0714]: a scene cannot be shared with lengths"),
    ):
        with open(os.path.join(place.path, "refused.scn"), "w", encoding="utf-8") as file:
            file.write(HEAD + VIEW + text)
        found, said = place.run(*SIZE, *words, "--mpi=scene", "refused.scn", before=ranks(3))
        test.ok(found == code and expected in said and (said.count("error[") == 1 or name == "frames"), "%s: refused" % name, "exit %d\n%s" % (found, said))
    with open(os.path.join(place.path, "many.scn"), encoding="utf-8") as file, \
            open(os.path.join(place.path, "other.scn"), "w", encoding="utf-8") as other:
        other.write(file.read()[:-3000].rsplit("\n", 1)[0] + "\n")
    shared = "--mpi=scene"
    of_ranks(test, place, "a rank with another scene", 2, "error[E0712]: rank 1 of 2 would draw another picture",
             [shared, "loop.scn"], [shared, "few.scn"])
    of_ranks(test, place, "a rank with less of the scene", 2, "error[E0712]: rank 2 of 3 would draw another picture",
             [shared, "many.scn"], [shared, "many.scn"], [shared, "other.scn"])
    of_ranks(test, place, "a rank without the scene", 3, "error[E0522]: rank 1 of 3 cannot read its part of the scene",
             [shared, "many.scn"], [shared, "nowhere.scn"], [shared, "many.scn"])
    of_ranks(test, place, "a rank whose text ends sooner", 3, "error[E0522]: rank 1 of 2 cannot read its part of the scene",
             [shared, "many.scn"], [shared, "few.scn"])
    found, said = place.run("--mpi=rays", "few.scn")
    test.ok(found == 2 and "tiles or scene" in said, "--mpi=rays", said)
    found, said = place.run(*SIZE, "--mpi=scene", "nowhere.scn", before=ranks(2))
    test.ok(found == 3 and said.count("E0501") == 1, "no scene", said)


def check_continued(test, place):
    """A run that SIGTERM ends, and that another number of ranks continues."""
    code, alone = place.run(*SIZE, "-o", "one.png", "loop.scn")
    words = [*SIZE, "--mpi=scene", "--checkpoint=0", "--resume", "-o", "kept.png", "loop.scn"]
    timer = ["sh", "-c", 'timeout -s TERM 0.05 "$0" "$@" || true']
    code, said = place.run(*words, before=[*ranks(2), *timer])
    code, more = place.run(*words, before=ranks(3))
    test.ok(code == 0 and place.bytes("kept.png") == place.bytes("one.png") and not place.bytes("kept.png.checkpoint"),
            "a run that was ended and continued", alone + said + more)


def check_budget(test, place):
    _, alone = subprocess.getstatusoutput("cd %s && %s --budget many.scn" % (place.path, PROGRAM))
    done = subprocess.run([*ranks(4), PROGRAM, "--budget", "--mpi=scene", "many.scn"], cwd=place.path,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, check=False)

    def value(text, name):
        return int(next(line for line in text.splitlines() if line.startswith(name)).split()[-1])
    shared = done.stdout.decode()
    test.ok(value(shared, "objects") == value(alone, "objects") and
            value(shared, "scene") < 0.9 * value(alone, "scene"), "--budget says what a rank needs", shared + alone)


def measure_memory(count, processes):
    """Bytes at the peak: of one process, and of the ranks."""
    place = Place()
    with open(os.path.join(place.path, "memory.scn"), "w", encoding="utf-8") as file:
        side = count ** (1 / 3)
        file.write(HEAD + "camera { location <0, 0, %g> look_at 0 }\nlight_source { <0, 9, -9> * %g, rgb 1 }\n" % (-1.5 * side, side))
        for _ in range(count):
            file.write("sphere { <%.4f, %.4f, %.4f>, %.3f pigment { rgb <%.1f, %.1f, 0.5> } }\n" % (
                *(side * (random.random() - 0.5) for _ in range(3)), 0.2 + 0.3 * random.random(), random.random(),
                random.random()))
    words = ["-q", "-t", "1", "-W", "320", "-H", "240", "memory.scn", "-o"]
    place.run(*words, "one.png")
    alone = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    peak = ["sh", "-c", 'exec /usr/bin/time -f "peak %M" "$0" "$@"']
    _, text = place.run(*words, "shared.png", "--mpi=scene", before=[*ranks(processes), *peak])
    peaks = [int(line.split()[1]) for line in text.splitlines() if line.startswith("peak")]
    print("one process: %d kB; %d ranks: %s kB, the greatest %.3f of its share; %s bytes" % (
        alone, processes, " ".join(map(str, peaks)), max(peaks) * processes / alone,
        "the same" if place.bytes("one.png") == place.bytes("shared.png") else "OTHER"))
    place.close()


if len(sys.argv) > 3 and sys.argv[1] == "memory":
    os.environ.update(ENVIRONMENT)
    random.seed(int(os.environ.get("SEED", "1")))
    measure_memory(int(sys.argv[2]), int(sys.argv[3]))
else:
    run_checks("scenes that ranks share", check_pictures, check_refused, check_continued, check_budget)
