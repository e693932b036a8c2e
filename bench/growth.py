#!/usr/bin/env python3
"""Growth laws: what N of a kind cost, in time and memory, here and with POV-Ray.

    bench/growth.py [--kind=NAME,…|curved] [--sizes=N,…] [--seconds=S] [--trace=WxH] [--turns=N]

For each kind a scene of N parts, N growing by ten until a run takes more than S seconds (10): processor seconds of one thread
and peak memory of the whole process at 160x120, rtlang's and POV-Ray's of the same file, one after the other; then the
exponents of both between the two largest sizes that both drew. With --trace instead what tracing takes of N parts (1000) of
each kind that stand alone: processor seconds of a run of that size less those of one of 16x12, the least of several turns
(8), and the geometric mean of the ratios; --kind=curved is tori, blobs, text, a height field of 512x512 and the like. Wants RTLANG and POV-Ray; takes a quarter of an hour.
SPDX-License-Identifier: MIT
"""
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile

RTLANG = os.environ.get("RTLANG", "rtlang")
HEAD = """#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 10 }
background { rgb <0.2, 0.3, 0.4> }
camera { location <0, 0, -3.2> right 4/3*x up y look_at 0 }
light_source { <6, 8, -10>, rgb 1 }
"""


class Places:
    """The same places and colours for the same seed, on every machine."""

    def __init__(self, count):
        self.number = random.Random(count).random
        self.size = 0.6 / max(1, count) ** (1 / 3)

    def place(self, reach=1.0):
        return [reach * (2 * self.number() - 1) for _ in range(3)]

    def paint(self):
        return "pigment {{ rgb <{:.3f}, {:.3f}, {:.3f}> }}".format(*(0.2 + 0.8 * self.number() for _ in range(3)))


def vector(numbers):
    return "<" + ", ".join(f"{number:.6g}" for number in numbers) + ">"


def near(place, far):
    return [number + far for number in place]


def each(form):
    """A kind whose parts are made one by one: form(places) is one of them."""
    def scene(count):
        places = Places(count)
        for _ in range(count):
            yield form(places)
    return scene


def sphere(p, more=""):
    return f"sphere {{ {vector(p.place())}, {p.size * (0.5 + 0.5 * p.number()):.6g} {p.paint()} {more} }}\n"


def box(p, more=""):
    corner = p.place()
    return f"box {{ {vector(corner)}, {vector(near(corner, p.size))} {p.paint()} {more} }}\n"


def rod(p):
    start = p.place()
    stop = [a + p.size * 2 * (p.number() - 0.5) for a in start]
    return f"cylinder {{ {vector(start)}, {vector(stop)}, {p.size / 5:.6g} {p.paint()} }}\n"


def cone(p):
    start = p.place()
    stop = [a + p.size * 2 * (p.number() - 0.5) for a in start]
    return f"cone {{ {vector(start)}, {p.size / 3:.6g}, {vector(stop)}, 0 {p.paint()} }}\n"


def triangle(p, more=""):
    corners = [p.place()]
    corners += [[a + p.size * 2 * (p.number() - 0.5) for a in corners[0]] for _ in range(2)]
    if more:
        corners = [c for corner in corners for c in (corner, near(p.place(0.3), 1))]
    return f"{more}triangle {{ {', '.join(map(vector, corners))} {p.paint()} }}\n"


def disc(p):
    return f"disc {{ {vector(p.place())}, {vector(near(p.place(), 0.1))}, {p.size / 2:.6g} {p.paint()} }}\n"


def ellipsoid(p):
    return (f"sphere {{ 0, 1 scale {vector([p.size * (0.3 + 0.5 * p.number()) for _ in range(3)])} "
            f"rotate {vector(p.place(180))} translate {vector(p.place())} {p.paint()} }}\n")


def turned(p, size):
    return f"scale {size:.6g} rotate {vector(p.place(180))} translate {vector(p.place())} {p.paint()}"


def shaped(text, size=1.0):
    """A shape of size 1 or so, at a place of each and turned."""
    return lambda p: f"{text} {turned(p, size * p.size)} }}\n"


TORUS = "torus { 0.4, 0.15"
QUARTIC = "quartic { <1, 0, 0, 0, 2, 0, 0, 2, 0, -0.365, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0.275, 0, 0, 0, 0, 1, 0, -0.365, 0, 0.01890625>"
SUPERELLIPSOID = "superellipsoid { <0.25, 0.25>"
FLOWER = "lathe { cubic_spline 6 <0.1, -0.7>, <0.2, -0.5>, <0.5, -0.2>, <0.2, 0.1>, <0.4, 0.5>, <0.5, 0.7>"
VASE = "sor { 6 <0.1, -0.7>, <0.2, -0.5>, <0.5, -0.2>, <0.2, 0.1>, <0.4, 0.5>, <0.5, 0.7>"
STAR = "prism { quadratic_spline 0, 0.3, 8 <-0.5, -0.5>, <0, -0.6>, <0.5, -0.1>, <0.2, 0.3>, <0, 0.6>, <-0.4, 0.4>, <-0.4, -0.2>, <0, -0.6>"
WORD = 'text { ttf "timrom.ttf" "Rays" 0.2, 0'
WAVES = ("isosurface { function { x*x + y*y + z*z - 0.2 + 0.05 * sin(9*x) * sin(9*y) * sin(9*z) } "
         "contained_by { sphere { 0, 0.7 } } max_gradient 3")


def drops(p, count=6):
    """A blob of some drops."""
    parts = [f"sphere {{ {vector(p.place(0.4))}, 0.5, 1 }}" for _ in range(count)]
    return f"blob {{ threshold 0.5 {' '.join(parts)} {turned(p, p.size)} }}\n"


def hills(count):
    """A height field of so many columns and rows, from a function."""
    yield (f"height_field {{ function {count}, {count} {{ 0.5 + 0.2 * sin(13*x) * cos(11*y) + 0.1 * sin(67*x + 3) * sin(59*y) }} "
           "translate -0.5 scale <4, 0.8, 4> rotate -35*x pigment { rgb 0.8 } }\n")


def ball_of_faces(count):
    """One mesh2 of about so many triangles, a ball with bumps."""
    rows = max(2, round((count / 2) ** 0.5))
    yield f"mesh2 {{ vertex_vectors {{ {(rows + 1) * rows}"
    for i in range(rows + 1):
        for j in range(rows):
            a, b = math.pi * i / rows, 2 * math.pi * j / rows
            r = 1 + 0.05 * math.sin(9 * a) * math.sin(7 * b)
            yield f",\n<{r * math.sin(a) * math.cos(b):.6f}, {r * math.cos(a):.6f}, {r * math.sin(a) * math.sin(b):.6f}>"
    yield f" }}\nface_indices {{ {2 * rows * rows}"
    for i in range(rows):
        for j in range(rows):
            here, right = i * rows + j, i * rows + (j + 1) % rows
            yield f",\n<{here}, {right}, {here + rows}>,\n<{right}, {right + rows}, {here + rows}>"
    yield " }\npigment { rgb 0.8 } }\n"


def large(text):
    """One that fills the picture; it has no size to grow by."""
    def scene(_count):
        yield f"{text} rotate <-60, 20, 0> scale 2.2 pigment {{ rgb 0.8 }} }}\n"
    return scene


def pair(word, other):
    def form(p):
        here = p.place()
        beside = [a + p.size * 0.4 for a in here]
        second = (f"sphere {{ {vector(beside)}, {p.size * 0.5:.6g} }}" if other == "sphere" else
                  f"box {{ {vector(here)}, {vector(near(here, p.size * 0.6))} }}")
        return f"{word} {{ sphere {{ {vector(here)}, {p.size * 0.6:.6g} }} {second} {p.paint()} }}\n"
    return form


def within(head, form, tail=""):
    def scene(count):
        yield head
        yield from each(form)(count)
        yield tail
    return scene


def whole(word, form, tail="pigment { rgb 0.8 } }\n", head=""):
    return within(f"{word} {{ {head}\n", form, tail)


def plain_sphere(p):
    return f"sphere {{ {vector(p.place())}, {p.size:.6g} }}\n"


def clusters(form):
    def scene(count):
        places = Places(count)
        for i in range(count):
            text = form(places)
            yield f"object {{ {text.strip()} translate 1e6*x }}\n" if i % 2 else text
    return scene


def half_spaces(count):
    number = random.Random(count).random
    yield "intersection {\n"
    for _ in range(count):
        direction = [2 * number() - 1 for _ in range(3)]
        yield f"plane {{ {vector(direction)}, 1 }}\n"
    yield "pigment { rgb 0.8 } }\n"


def clips(count):
    places = Places(count)
    yield "sphere { 0, 1 pigment { rgb 0.8 } clipped_by {\n union {\n"
    for _ in range(count):
        yield f"sphere {{ {vector(places.place())}, 0.4 }}\n"
    yield "} } }\n"


def veils(count):
    for i in range(count):
        yield f"box {{ <-1, -1, {2 + i / count:.6g}>, <1, 1, {2 + (i + 0.5) / count:.6g}> pigment {{ rgbt <1, 1, 1, 0.99> }} }}\n"
    yield "plane { z, 4 pigment { rgb 1 } }\n"


def shells(count):
    for i in range(count):
        yield (f"sphere {{ 0, {1 - 0.9 * i / count:.6g} pigment {{ rgbt <1, 1, 1, 0.98> }} finish {{ ambient 0 diffuse 0.02 }} "
               "interior { ior 1.01 } }\n")


def text_grows(count):
    yield f'#declare S = ""; #declare I = 0; #while (I < {count}) #declare S = concat(S, "x"); #declare I = I + 1; #end\n'
    yield "sphere { 0, strlen(S) / strlen(S) pigment { rgb 1 } }\n"


def array_copied(count):
    yield ("#macro Take(A) A[0] #end #declare A = array[1000]; #declare I = 0; #while (I < 1000) #declare A[I] = I; "
           f"#declare I = I + 1; #end #declare I = 0; #while (I < {count}) #declare B = A; #declare I = I + 1; #end\n")
    yield "sphere { 0, 1 + Take(A) pigment { rgb 1 } }\n"


def extents(count):
    places = Places(count)
    yield "#declare U = union {\n"
    for _ in range(count):
        yield plain_sphere(places)
    yield "pigment { rgb 1 } }\n#declare I = 0; #while (I < 100) #declare E = min_extent(U); #declare I = I + 1; #end object { U }\n"


def transforms(count):
    yield "sphere { 0, 1 pigment { rgb 1 }\n"
    for _ in range(count):
        yield "rotate 3*y translate 0.001*x\n"
    yield "}\n"


def terms(count):
    yield "#declare S = " + " + ".join(["1"] * count) + ";\nsphere { 0, S / S pigment { rgb 1 } }\n"


KINDS = {
    "spheres": each(sphere),
    "spheres, no_shadow": each(lambda p: sphere(p, "no_shadow")),
    "spheres, no_image": each(lambda p: sphere(p, "no_image")),
    "cylinders": each(rod),
    "cones": each(cone),
    "boxes": each(box),
    "triangles": each(triangle),
    "smooth triangles": each(lambda p: triangle(p, "smooth_")),
    "discs": each(disc),
    "ellipsoids": each(ellipsoid),
    "unions of two": each(pair("union", "sphere")),
    "differences": each(pair("difference", "sphere")),
    "intersections": each(pair("intersection", "box")),
    "merges": each(pair("merge", "sphere")),
    "clipped": each(lambda p: sphere(p, f"clipped_by {{ plane {{ y, {p.place()[1]:.4g} }} }}")),
    "inverse spheres": each(lambda p: sphere(p, "inverse")),
    "inverse boxes": each(lambda p: box(p, "inverse")),
    "tori": each(shaped(TORUS)),
    "quartics": each(shaped(QUARTIC)),
    "blobs": each(drops),
    "superellipsoids": each(shaped(SUPERELLIPSOID, 0.5)),
    "lathes": each(shaped(FLOWER)),
    "surfaces of revolution": each(shaped(VASE)),
    "prisms": each(shaped(STAR)),
    "texts": each(shaped(WORD, 0.6)),
    "isosurfaces": each(shaped(WAVES)),
    "one torus": large(TORUS),
    "one quartic": large(QUARTIC),
    "one blob": whole("blob", lambda p: f"sphere {{ {vector(p.place())}, {2 * p.size:.6g}, 1 }}\n", head="threshold 0.4"),
    "one superellipsoid": large("superellipsoid { <0.25, 0.25> scale 0.5"),
    "one lathe": large(FLOWER),
    "one surface of revolution": large(VASE),
    "one prism": large(STAR),
    "one text": large(WORD + " translate -0.9*x scale 0.7"),
    "one isosurface": large(WAVES),
    "one height field": hills,
    "one mesh2": ball_of_faces,
    "equal boxes in one place": each(lambda p: "box { -0.5, 0.5 pigment { rgb 0.7 } }\n"),
    "boxes in a large box": within("box { -1e6, 1e6 pigment { rgb 0.6 } }\n", box),
    "boxes on a large disc": within("disc { -y, y, 1e6 pigment { rgb 0.6 } }\n", box),
    "two clusters of boxes": clusters(box),
    "two clusters of spheres": clusters(sphere),
    "one union of boxes": whole("union", box),
    "one union of triangles": whole("union", triangle),
    "one merge of spheres": whole("merge", plain_sphere),
    "one intersection of spheres": whole("intersection", lambda p: f"sphere {{ {vector(p.place(0.3))}, 1 }}\n"),
    "one intersection of planes": half_spaces,
    "one difference from a union": whole("difference", plain_sphere, "} pigment { rgb 0.8 } }\n", "sphere { 0, 1 } union {"),
    "one clip by a union": clips,
    "clear boxes in a row": veils,
    "glass shells": shells,
    "concat": text_grows,
    "arrays copied": array_copied,
    "min_extent 100 times": extents,
    "transforms of one": transforms,
    "terms of a sum": terms,
}


ALONE = ["spheres", "spheres, no_shadow", "spheres, no_image", "cylinders", "cones", "boxes", "triangles", "smooth triangles",
         "discs", "ellipsoids", "unions of two", "differences", "intersections", "merges", "clipped", "inverse spheres",
         "inverse boxes"]
CURVED = ["tori", "blobs", "superellipsoids", "lathes", "surfaces of revolution", "prisms", "texts", "one torus",
          "one quartic", "one blob", "one superellipsoid", "one lathe", "one surface of revolution", "one prism", "one text",
          "one isosurface", "one height field", "one intersection of spheres"]
COUNTS = {"one blob": 50, "one height field": 512, "one intersection of spheres": 100}  # where it is not told
TRACE_TURNS = 8


def run(command, folder):
    """Processor seconds, megabytes; None where it failed."""
    with subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
    return None if status else (usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def measure(kind, count, folder):
    with open(os.path.join(folder, "s.pov"), "w", encoding="ascii") as file:
        file.write(HEAD)
        file.writelines(KINDS[kind](count))
    limited = ["timeout", "100"]
    ours = run([*limited, RTLANG, "-q", "-t1", "-W160", "-H120", "--max-memory=8G", "-oo.png", "s.pov"], folder)
    theirs = None
    if shutil.which("povray"):
        theirs = run([*limited, "povray", "+Is.pov", "+Ot.png", "-D", "-A", "+WT1", "-GA", "+W160", "+H120"], folder)
    return ours, theirs


def rtlang_of(width, height):
    return [RTLANG, "-q", "-t1", f"-W{width}", f"-H{height}", "-oo.png", "s.pov"]


def povray_of(width, height):
    return ["povray", "+Is.pov", "+Ot.png", "-D", "-A", "+WT1", "-GA", f"+W{width}", f"+H{height}"]


def trace(kinds, told, size, turns, folder):
    """What tracing takes; the programs take turns."""
    logs = []
    print(f"| {told or 1000} of each, {size} | rtlang s | POV-Ray s | ratio |\n|---|---|---|---|")
    for kind in kinds:
        with open(os.path.join(folder, "s.pov"), "w", encoding="ascii") as file:
            file.write(HEAD)
            file.writelines(KINDS[kind](told or COUNTS.get(kind, 1000)))
        least = {}
        for _ in range(turns):
            for form in rtlang_of, povray_of:
                for width, height in map(int, size.split("x")), (16, 12):
                    key = form, width == 16
                    least[key] = min(least.get(key, math.inf), run(form(width, height), folder)[0])
        ours, theirs = (least[form, False] - least[form, True] for form in (rtlang_of, povray_of))
        logs.append(math.log(max(ours, 1e-4) / max(theirs, 1e-4)))
        print(f"| {kind} | {ours:.4f} | {theirs:.3f} | {ours / max(theirs, 1e-4):.2f} |", flush=True)
    print(f"| geometric mean | | | {math.exp(sum(logs) / len(logs)):.3f} |")


def exponent(points, what):
    """Of the last two sizes, where the larger takes long enough to be seen."""
    if len(points) < 2 or points[-1][1][what] < (0.05, 8)[what]:
        return "-"
    (n, low), (m, high) = points[-2:]
    return f"{math.log(high[what] / max(low[what], 1e-3)) / math.log(m / n):.2f}"


def law(kind, sizes, seconds, folder):
    mine, other = [], []
    for count in sizes:
        ours, theirs = measure(kind, count, folder)
        print(f"    {kind} {count}: " + ", ".join("failed" if run is None else f"{run[0]:.3f} s {run[1]:.0f} MB"
                                                for run in (ours, theirs)), flush=True)
        if ours:
            mine.append((count, ours))
        if theirs:
            other.append((count, theirs))
        if max([run[0] for run in (ours, theirs) if run] or [seconds]) >= seconds:
            break
    cells = [exponent(points, what) for what in (0, 1) for points in (mine, other)]
    both = [(a, b) for n, a in mine for m, b in other if n == m]
    ratio = f"{both[-1][0][0] / max(both[-1][1][0], 1e-3):.2f}" if both else "-"
    print(f"| {kind} | {mine[-1][0] if mine else 0} | {ratio} | {' | '.join(cells)} |", flush=True)


def main():
    options = dict(word[2:].split("=", 1) for word in sys.argv[1:])
    kinds = CURVED if options.get("kind") == "curved" else options["kind"].split(",") if "kind" in options else list(KINDS)
    sizes = [int(size) for size in options.get("sizes", "10,100,1000,10000,100000").split(",")]
    with tempfile.TemporaryDirectory() as folder:
        if "trace" in options:
            trace(kinds if "kind" in options else ALONE, sizes[0] if "sizes" in options else None, options["trace"],
                  int(options.get("turns", TRACE_TURNS)), folder)
            return
        print("| kind | N | time / POV-Ray's | exponent of time | POV-Ray's | of memory | POV-Ray's |\n|---|---|---|---|---|---|---|")
        for kind in kinds:
            law(kind, sizes, float(options.get("seconds", "10")), folder)


if __name__ == "__main__":
    main()
