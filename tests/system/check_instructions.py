#!/usr/bin/env python3
"""What certainty, absent features, errors of samples and quick ways of reading cost, in instructions.

The certified sphere test costs at most 1.6 times the instructions of the textbook's in the same loop, one by one and in
vectors, and takes the way of double-word arithmetic in no ordinary scene; a scene without sky and fog runs nothing of
either; the kernel that is chosen for a scene executes what one does that was compiled with nothing but what the scene
has; the error of a sampled picture costs at most some 2 % of the sampling; spheres that a loop reads or computes cost a
share of what they cost the usual way; stretched spheres cost at most twice what plain ones do; rays that miss a
polyhedron of planes ask none of them; boxes in two groups far apart cost what those of one group do; and ten times as many parts of one composite cost a ray at most twice as much. Counted by callgrind, so that no clock decides. The bars are of gcc's code; where
clang's takes more, the bar of its own stands beside.
SPDX-License-Identifier: MIT
"""
import glob
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from tap import Tap

IS_CLANG = "clang" in subprocess.run(f"{os.environ.get('CC', 'cc')} --version", shell=True, stdout=subprocess.PIPE,
                                     stderr=subprocess.DEVNULL, text=True, check=False).stdout
BAR = 1.75 if IS_CLANG else 1.6
PROGRAM = os.environ["COUNT_SPHERE_TESTS"]
TOP = os.environ.get("top_srcdir", ".")
# The loop over single spheres, and that over blocks of eight in vectors of two and of four.
LOOPS = {"one by one": PROGRAM, "in vectors of two": PROGRAM.replace("_tests", "_blocks"),
         "in vectors of four": PROGRAM.replace("_tests", "_blocks_v3")}
ORDINARY = ["01_one_sphere", "04_", "08_", "10_sphere_flake"]
RTLANG = os.environ["RTLANG"]
VALGRIND = os.environ.get("VALGRIND") or shutil.which("valgrind")


def instructions(program, function, folder):
    """Instructions executed inside calls of a function."""
    command = [VALGRIND, "--tool=callgrind", f"--callgrind-out-file={folder}/out", f"--toggle-collect={function}", program]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", run.stderr)
    return (int(found.group(1)) if found else 0), run.stdout.split()


BALLS = "sphere { 5 * z, 1 pigment { rgbt 0.5 } finish { reflection 0.3 } } light_source { <3, 4, -5> rgb 1 }\n"
# What a scene has -> the functions that its rays run.
AROUND = {"sky_sphere { pigment { gradient y } }": "sky_light", "fog { distance 5 rgb 0.5 }": "fog_between"}


SPHERE = "sphere { 5 * z, 1 pigment { rgb 1 } } light_source { <3, 4, -5> rgb 1 }\n"
MANY = ("#declare S = seed(7); light_source { <-8, 12, -10> rgb 1 }\n#for (I, 1, 300) sphere { <rand(S) * 8 - 4, rand(S) * 6 - 3,"
        " rand(S) * 8 + 4>, 0.1 + 0.25 * rand(S) pigment { rgb <rand(S), rand(S), rand(S)> } } #end\n")
# Scene, samples a pixel: what is computed for a pixel is paid once for each doubling of its samples.
SAMPLED = [("one sphere", SPHERE, 4), ("one sphere", SPHERE, 16), ("one sphere", SPHERE, 64), ("300 spheres", MANY, 16)]
# Large enough that some of the pixels tell the error, and that what is computed once a round does not count.
SAMPLED_SIZE = ("-W160", "-H120")
# By samples a pixel; of the 300 spheres many are small, whose lists, looks and replicas come on top.
ESTIMATE_BAR = {4: 1.027 if IS_CLANG else 1.02, 16: 1.02, 64: 1.02}
SMALL_BAR = 1.05 if IS_CLANG else 1.02  # halves and replicas of pixels with strata are weighted, too
# Of an adaptive run over a plain one without an error, as many samples in the mean: rounds look at all pixels, and the
# pixels that are asked most have more in them than the mean one.
ADAPTIVE_BAR = 2.1 if IS_CLANG else 1.85
# Of tracing a scene by the kernel that is chosen for it, over a kernel compiled with nothing but what the scene has.
# Only opaque against clear is worth a kernel of its own; all else together is a twentieth at the most.
ABSENT_BAR = 1.07 if IS_CLANG else 1.05
KERNELS = PROGRAM.replace("count_sphere_tests", "count_kernels")

# Loops that place a sphere a turn -> the most that each costs of what it costs with --no-literals.
PIGMENT = "pigment { rgb <0.8, 0.3, 0.2> }"
LOOP = '#fopen F "{data}" read #for (I, 1, {count}) '
REPEATED = {
    "a #read of numbers": (LOOP + "#read (F, X, Y, Z, R) sphere { <X, Y, Z>, R " + PIGMENT + " } #end", 0.20),
    "a #read for a macro": ("#macro Ball(P, R) sphere { P, R " + PIGMENT + " } #end " + LOOP + "#read (F, X, Y, Z, R) Ball(<X, Y, Z>, R) #end", 0.32),
    "a #for": ("#for (I, 1, {count}) sphere { <mod(I, 10), I/10, 2*I - 1>, 0.4 " + PIGMENT + " } #end", 0.21 if IS_CLANG else 0.19),
    "a #while": ("#declare I = 0; #while (I < {count}) sphere { <I, 0.5*I, 1>, 0.4 " + PIGMENT + " } #declare I = I + 1; #end", 0.22),
    "literals": ("{spheres}", 0.05),
}
REPEATED_COUNTS = 500, 1500
LITERAL_COUNTS = 4000, 12000 # more than the scanner's buffer holds


# Stretched spheres -> the most that a scene of them costs of one of as many others, in tracing and in all: those that
# are said by a centre and a radius alone are read by the fastest way that there is.
STRETCHED_BAR = 2.0
STRETCHED_SIZE = ("-W320", "-H240")
STRETCHED_COUNT = 8000
STRETCHED = "sphere {{ 0, .1 scale <1,2,1> translate <{at}> }}"
UNSTRETCHED = {"spheres of a centre and a radius": ("sphere {{ <{at}>, .126 }}", ("render_film", "main")),
               "spheres that are moved": ("sphere {{ 0, .126 translate <{at}> }}", ("main",)),
               "spheres that are scaled": ("sphere {{ 0, .14 scale 0.9 translate <{at}> }}", ("main",))}

# Kinds whose parts are tested some rays at a time -> the most that tracing them costs of tracing as many spheres. Ray by
# ray it was 2.7, 1.9 and 2.1.
SOLIDS = {"cylinder {{ <{at}>, <{at}> + <.2, .2, .2>, .04": 2.1,
          "box {{ <{at}>, <{at}> + .15": 1.75,
          "triangle {{ <{at}>, <{at}> + <.2, .1, 0>, <{at}> + <0, .2, .1>": 1.85}
SPHERE_OF = "sphere {{ <{at}>, .1 }}"


def file_instructions(scene, function, folder, *options):
    """Instructions executed inside calls of a function while a scene is drawn; None when callgrind cannot tell."""
    command = [VALGRIND, "--tool=callgrind", f"--callgrind-out-file={folder}/out", f"--toggle-collect={function}",
               "--trace-children=yes", RTLANG, "-q", "-t1", "-W16", "-H12", "--isa=plain", "-I", f"{TOP}/share/rtlang",
               *options, "-o", f"{folder}/picture.png", scene]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.findall(r"Collected : (\d+)", run.stderr)
    return max(map(int, found)) if found and run.returncode == 0 else None


def scene_instructions(text, function, folder, *options):
    """The same for a scene's text."""
    scene = os.path.join(folder, "scene.scn")
    with open(scene, "w", encoding="utf-8") as out:
        out.write(text)
    return file_instructions(scene, function, folder, *options)


def judge_loop(tap, name, program, folder):
    """The instructions of both tests in a loop, and that both find the same, without double words."""
    textbook, _ = instructions(program, "count_textbook", folder)
    certified, counts = instructions(program, "count_certified", folder)
    if not textbook or not certified:
        tap.skip(f"instructions of the sphere test {name}", "callgrind does not run this program")
        return
    tap.ok(certified <= BAR * textbook,
           f"{name}: the certified test takes {certified / textbook:.3f} times the instructions of the textbook's")
    tap.ok(counts[0] == counts[1] and int(counts[1]) > 100 and counts[2] == "0",
           f"{name}: {counts[1]} hits in an ordinary scene, {counts[2]} tests were doubtful")


def judge_around(tap, folder):
    """A line for each of AROUND: its function runs in a scene that has it and in no other."""
    for statement, function in AROUND.items():
        without, with_it = (scene_instructions(BALLS + more, function, folder) for more in ("", statement))
        if without is None or with_it is None:
            tap.skip(function, "callgrind does not run rtlang")
        else:
            tap.ok(without == 0 and with_it > 0,
                   f"{function}: {without} instructions where there is none, {with_it} where there is")


def judge_clip(tap, folder):
    """A box that holds the sphere that it clips takes no instruction of a ray; one that does not takes some."""
    taken = {clip: scene_instructions(SPHERE.replace("pigment", clip + " pigment"), "render_film", folder)
             for clip in ("", "clipped_by { box { <-1.1, -1.1, 3.9>, <1.1, 1.1, 6.1> } }", "clipped_by { box { <-1.1, -1.1, 3.9>, <1.1, 0.5, 6.1> } }")}
    counts = list(taken.values())
    if not all(counts):
        tap.skip("clips", "callgrind does not run rtlang")
    else:
        tap.ok(counts[1] <= counts[0] < counts[2], f"a sphere takes {counts[0]} instructions, {counts[1]} in a box that "
               f"holds it, {counts[2]} in one that cuts it")


def judge_ordinary(tap, folder):
    """No sphere of an example is decided by double words; one that is met at its very edge is."""
    touched = "camera { orthographic location <1 / 32, 1 + 1 / 24, -5> look_at <1 / 32, 1 + 1 / 24, 0> right x up y }\nsphere { 0, 1 } light_source { 9, 1 }\n"
    if not scene_instructions(touched, "sphere_exact", folder):
        tap.skip("double words in ordinary scenes", "callgrind does not run rtlang")
        return
    for prefix in ORDINARY:
        scene = sorted(glob.glob(f"{TOP}/examples/{prefix}*.scn"))[0]
        count = file_instructions(scene, "sphere_exact", folder)
        tap.ok(count == 0, f"{os.path.basename(scene)}: {count} instructions in double words")


def judge_absent(tap, folder):
    """A line for each scene of count_kernels: what it has not costs nothing."""
    count = int(subprocess.run([KERNELS], capture_output=True, text=True, check=True).stdout)
    for number in range(count):
        taken, said = {}, {}
        if subprocess.run([KERNELS, str(number), "all"], capture_output=True, check=False).returncode != 0:
            tap.ok(False, f"the kernel of scene {number} is chosen by its features")
            continue
        for which in "all", "own":
            command = [VALGRIND, "--tool=callgrind", f"--callgrind-out-file={folder}/out", "--toggle-collect=render_film",
                       KERNELS, str(number), which]
            run = subprocess.run(command, capture_output=True, text=True, check=False)
            found = re.search(r"Collected : (\d+)", run.stderr)
            taken[which], said[which] = int(found.group(1)) if found else 0, run.stdout.strip().partition(" ")
        if not taken["all"] or not taken["own"]:
            tap.skip("the kernels that are chosen", "callgrind does not run this program")
            return
        ratio = taken["all"] / taken["own"]
        tap.ok(said["all"][0] == said["own"][0] and 1 / ABSENT_BAR <= ratio <= ABSENT_BAR,
               f"{said['own'][2]}: the kernel `{said['all'][2]}` executes {100 * (ratio - 1):+.2f} % of the instructions of its own")


def judge_estimate(tap, folder):
    """A line for each of SAMPLED: the instructions of sampling with and without its error."""
    for name, text, samples in SAMPLED:
        told, untold = (scene_instructions(text, "sampling_run", folder, *SAMPLED_SIZE, f"--samples={samples}", *more)
                        for more in ((), ("--no-estimate",)))
        if not told or not untold:
            tap.skip(f"the error of {name}", "callgrind does not run rtlang")
        else:
            bar = SMALL_BAR if text == MANY else ESTIMATE_BAR[samples]
            tap.ok(told <= bar * untold, f"the error of {name} at {samples} samples costs "
                   f"{100 * (told / untold - 1):.2f} % of the instructions, at most {100 * (bar - 1):.1f} %")


def judge_adaptive(tap, folder):
    """The instructions of adaptive sampling beside those of as many samples everywhere."""
    chosen, plain = (scene_instructions(MANY, "sampling_run", folder, *SAMPLED_SIZE, "--samples=16", more)
                     for more in ("--adaptive", "--no-estimate"))
    if not chosen or not plain:
        tap.skip("adaptive samples of 300 spheres", "callgrind does not run rtlang")
    else:
        tap.ok(chosen <= ADAPTIVE_BAR * plain, f"adaptive samples of 300 spheres, 16 in the mean, take "
               f"{chosen / plain:.2f} of the instructions of 16 everywhere, at most {ADAPTIVE_BAR}")


def judge_repeated(tap, folder):
    """A line for each of REPEATED: instructions for a sphere, as the difference of two counts."""
    data = os.path.join(folder, "data.csv")
    with open(data, "w", encoding="utf-8") as out:
        out.writelines(f"{i % 17 - 8}.{i:06d}, -0.{i:06d}, {i}.5, 0.{i % 89 + 10}5,\n" for i in range(max(REPEATED_COUNTS)))
    for name, (text, bar) in REPEATED.items():
        counts = LITERAL_COUNTS if "{spheres}" in text else REPEATED_COUNTS
        texts = [text.replace("{data}", data).replace("{count}", str(count)).replace("{spheres}", "".join(
            f"sphere {{ <{i % 17 - 8}.{i:06d}, -0.{i:06d}, {i}.5>, 0.{i % 89 + 10}5 {PIGMENT} }}\n" for i in range(count))) for count in counts]
        taken = [[scene_instructions(one, "eval_source", folder, *more) for one in texts] for more in ((), ("--no-literals",))]
        if not all(map(all, taken)):
            tap.skip(name, "callgrind does not run rtlang")
            continue
        quick, usual = ((many - few) / (counts[1] - counts[0]) for few, many in taken)
        tap.ok(quick <= bar * usual, f"a sphere of {name} costs {quick:.0f} instructions, {quick / usual:.2f} of the usual way's, at most {bar}")


def spheres_text(statement):
    """A cloud of spheres before a light."""
    draw = random.Random(1)
    places = (",".join(f"{draw.uniform(-5, 5):.4f}" for _ in range(3)) for _ in range(STRETCHED_COUNT))
    return ("camera { location <0, 0, -14> look_at 0 } light_source { <20, 30, -20> rgb 1 } "
            "#default { pigment { rgb <0.8, 0.5, 0.3> } }\n" + "\n".join(statement.format(at=at) for at in places))


def judge_stretched(tap, folder):
    """A line for each of UNSTRETCHED and what is counted of it: tracing, and the whole program."""
    stretched = {}
    for name, (statement, functions) in UNSTRETCHED.items():
        for function in functions:
            if function not in stretched:
                stretched[function] = scene_instructions(spheres_text(STRETCHED), function, folder, *STRETCHED_SIZE)
            other = scene_instructions(spheres_text(statement), function, folder, *STRETCHED_SIZE)
            if not stretched[function] or not other:
                tap.skip(f"stretched spheres, {function}", "callgrind does not run rtlang")
                continue
            ratio = stretched[function] / other
            what = "all" if function == "main" else "tracing"
            tap.ok(ratio <= STRETCHED_BAR, f"stretched spheres take {ratio:.2f} times the instructions of {name}, {what}")


def judge_solids(tap, folder):
    """A line for each of SOLIDS."""
    spheres = scene_instructions(spheres_text(SPHERE_OF), "render_film", folder, *STRETCHED_SIZE)
    for statement, bar in SOLIDS.items():
        name = statement.split()[0]
        own = scene_instructions(spheres_text(statement + " }}"), "render_film", folder, *STRETCHED_SIZE)
        if not own or not spheres:
            tap.skip(f"tracing of {name}s", "callgrind does not run rtlang")
            continue
        tap.ok(own <= bar * spheres, f"a {name} takes {own / spheres:.2f} times the instructions of a sphere, tracing")


def polyhedra_text(more):
    """Octahedra of planes in rows, each cut with something more."""
    faces = " ".join(f"plane {{ <{x}, {y}, {z}>, 0.2 }}" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1))
    places = (f"<{column - 3.5}, {row - 2.5}, 0>" for row in range(6) for column in range(8))
    return ("camera { location <0, 0, -9> look_at 0 } light_source { <20, 30, -20> rgb 1 } "
            "#default { pigment { rgb <0.8, 0.5, 0.3> } }\n" +
            "\n".join(f"intersection {{ {faces} {more} translate {at} }}" for at in places))


def judge_polyhedra(tap, folder):
    """What planes enclose has a box, as if one that holds it had been cut with it."""
    own, boxed = (scene_instructions(polyhedra_text(more), "render_film", folder, "-W64", "-H48")
                  for more in ("", "box { -0.5, 0.5 }"))
    if not own or not boxed:
        tap.skip("polyhedra of planes", "callgrind does not run rtlang")
        return
    tap.ok(own <= boxed, f"polyhedra of planes take {own / boxed:.2f} times the instructions of those cut with boxes")


CLUSTERS_BAR = 1.5


def judge_clusters(tap, folder):
    """Of boxes in two groups, of which one is so far away that nothing is seen of it, the other is traced as if it stood alone."""
    taken = []
    for far in ("", "translate 1e6 * x"):
        draw, text = random.Random(3), ["camera { location <0.3, 0.4, -4> look_at 0 } light_source { <20, 30, -20> rgb 1 }"]
        for i in range(3000):
            at = [draw.uniform(-1, 1) for _ in range(3)]
            text.append(f"box {{ <{at[0]:.4f}, {at[1]:.4f}, {at[2]:.4f}>, <{at[0] + .04:.4f}, {at[1] + .04:.4f}, {at[2] + .04:.4f}> {far if i % 2 else ''} }}")
        taken.append(scene_instructions("\n".join(text), "render_film", folder, "-W32", "-H24"))
    if not all(taken):
        tap.skip("groups of boxes", "callgrind does not run rtlang")
        return
    ratio = taken[1] / taken[0]
    tap.ok(ratio <= CLUSTERS_BAR, f"half of the boxes 10^6 away: {ratio:.2f} times the instructions, at most {CLUSTERS_BAR}")


# Composites of many parts: what stands before and behind the parts.
MANY_PARTS = {"a box without a union of spheres": ("difference { box { -1, 1 } union {", "} }"), "a merge of spheres": ("merge {", "}"),
              "a sphere that a union of spheres clips": ("sphere { 0, 1 clipped_by { union {", "} } }"),
              "an intersection with a union of spheres": ("intersection { box { -1, 1 } union {", "} }")}
PARTS_COUNTS, PARTS_BAR = (200, 2000), 2.0


def judge_parts(tap, folder):
    """A line for each of MANY_PARTS: rays ask the parts alone whose boxes they meet. The parts together take the same room."""
    for name, (before, behind) in MANY_PARTS.items():
        taken = []
        for count in PARTS_COUNTS:
            draw = random.Random(count)
            parts = "\n".join(f"sphere {{ <{draw.uniform(-1, 1):.4f}, {draw.uniform(-1, 1):.4f}, {draw.uniform(-1, 1):.4f}>, {0.6 / count ** (1 / 3):.4f} }}"
                              for _ in range(count))
            text = f"camera {{ location <0.3, 0.4, -4> look_at 0 }} light_source {{ <20, 30, -20> rgb 1 }}\n{before}\n{parts}\n{behind}"
            taken.append(scene_instructions(text, "render_film", folder, "-W32", "-H24"))
        if not all(taken):
            tap.skip(name, "callgrind does not run rtlang")
            continue
        ratio = taken[1] / taken[0]
        tap.ok(ratio <= PARTS_BAR, f"{name}: ten times as many take {ratio:.2f} times the instructions, at most {PARTS_BAR}")


def main():
    tap = Tap()
    if not VALGRIND:
        tap.skip("instructions", "valgrind is not installed")
        return tap.done()
    with tempfile.TemporaryDirectory() as folder:
        for name, program in LOOPS.items():
            if os.path.exists(program):
                judge_loop(tap, name, program, folder)
        judge_around(tap, folder)
        judge_clip(tap, folder)
        judge_ordinary(tap, folder)
        if os.path.exists(KERNELS):
            judge_absent(tap, folder)
        judge_estimate(tap, folder)
        judge_adaptive(tap, folder)
        judge_repeated(tap, folder)
        judge_stretched(tap, folder)
        judge_solids(tap, folder)
        judge_polyhedra(tap, folder)
        judge_clusters(tap, folder)
        judge_parts(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
