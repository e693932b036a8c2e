#!/usr/bin/env python3
"""What millions of particles cost from numpy arrays to a picture, beside the tree and the frame alone, and as text.

    PYTHONPATH=python RTLANG_LIBRARY=.libs/librtlang.so RTLANG=./rtlang bench/particles.py [SPHERES,...] [RUNS] [all]

Without numbers a million spheres and ten million, and a hundred frames in which the million move. Prints seconds and
processor seconds, the least of some runs. Only ratios of one run mean anything: `ratio` is that of all seconds to those
of tree and frame. With "all", also what programs take that read text, which Python writes: rtlang, Tachyon and POV-Ray
(as vapory calls it), where they are installed; and POV-Ray only up to a million spheres.
SPDX-License-Identifier: MIT
"""
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np
import rtlang

WIDTH, HEIGHT = 1920, 1080
FRAMES = 100


def measured(call, runs):
    """Least seconds and least processor seconds of this process and its children, and what the best call gave."""
    best, result = [float("inf")] * 2, None
    for _ in range(runs):
        used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        begun = time.perf_counter()
        made = call()
        wall = time.perf_counter() - begun
        now = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        cpu = sum(b.ru_utime + b.ru_stime - a.ru_utime - a.ru_stime for a, b in zip(used, now))
        result = made if wall < best[0] else result
        best = [min(best[0], wall), min(best[1], cpu)]
    return best + [result]


class Particles:
    """The arrays, and a scene of them."""

    def __init__(self, count):
        rng = np.random.default_rng(1)
        self.side = (count / 1000) ** (1 / 3)
        self.centers = rng.uniform(-self.side, self.side, (count, 3))
        self.radii = rng.uniform(0.05, 0.15, count)
        self.colors = rng.uniform(0.2, 1, (count, 3)).astype(np.float32)
        self.ways = rng.normal(size=(count, 3)) * 0.002
        self.scene = self.group = None
        self.eye = np.array((2.5, 1.0, 3.0)) * self.side

    def whole(self):
        """Arrays to picture, all of it."""
        self.scene = rtlang.Scene()
        self.group = self.scene.spheres(self.centers, self.radii, self.colors)
        self.scene.light((-30, 50, 60))
        self.scene.camera(self.eye, (0, 0, 0), angle=45)
        return self.scene.render(WIDTH, HEIGHT)

    def again(self):
        """Another camera."""
        self.eye[1] += 0.01 * self.side
        self.scene.camera(self.eye, (0, 0, 0), angle=45)
        return self.scene.render(WIDTH, HEIGHT)

    def moved(self):
        """All spheres a little elsewhere; tells what it took alone, for a hundred pictures are large."""
        self.centers += self.ways
        self.group.update(centers=self.centers)
        image = self.scene.render(WIDTH, HEIGHT)
        return image.seconds, image.built["trees"]

    def shuffled(self):
        """All spheres where others were."""
        self.centers = self.centers[::-1].copy()
        self.group.update(centers=self.centers)
        return self.scene.render(WIDTH, HEIGHT)

    def colored(self):
        """Other colors."""
        self.colors = self.colors[::-1].copy()
        self.group.update(colors=self.colors)
        return self.scene.render(WIDTH, HEIGHT)

    def rows(self):
        """Centers, radii and colors as Python's numbers."""
        return zip(self.centers.tolist(), self.radii.tolist(), self.colors.tolist())


# ---- programs that read text, which Python writes

def as_text(particles, folder, program):
    """The scene language, for the program or for POV-Ray."""
    path = os.path.join(folder, "text.pov")
    x, y, z = particles.eye
    with open(path, "w", encoding="ascii") as file:
        file.write("#version 3.7; global_settings { assumed_gamma 1 } light_source { <-30, 50, 60>, rgb 1 }\n"
                   f"camera {{ location <{x}, {y}, {z}> right -16/9*x up y angle 45 look_at 0 }}\n")
        for (x, y, z), radius, (r, g, b) in particles.rows():
            file.write(f"sphere {{ <{x}, {y}, {z}>, {radius} pigment {{ color rgb <{r}, {g}, {b}> }} }}\n")
    size = [f"+W{WIDTH}", f"+H{HEIGHT}"]
    subprocess.run([program, "+I" + path, "+O" + os.path.join(folder, "text.png"), "-D", "-A"] + size
                   if os.path.basename(program) == "povray" else
                   [program, "-q", f"-W{WIDTH}", f"-H{HEIGHT}", "-o", os.path.join(folder, "text.png"), path],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def as_tachyon(particles, folder, program):
    """Tachyon's own scene files, as OVITO and VMD write them."""
    path = os.path.join(folder, "text.dat")
    eye = particles.eye
    ahead = -eye / np.linalg.norm(eye)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"BEGIN_SCENE\nRESOLUTION {WIDTH} {HEIGHT}\nCAMERA\nPROJECTION PERSPECTIVE\nZOOM 2.14\n"
                   "ASPECTRATIO 1.0\nANTIALIASING 0\nRAYDEPTH 5\n"
                   f"CENTER {eye[0]} {eye[1]} {-eye[2]}\nVIEWDIR {ahead[0]} {ahead[1]} {-ahead[2]}\nUPDIR 0 1 0\n"
                   "END_CAMERA\nLIGHT CENTER -30 50 -60 RAD 0.1 COLOR 1 1 1\n")
        for (x, y, z), radius, (r, g, b) in particles.rows():
            file.write(f"SPHERE CENTER {x} {y} {-z} RAD {radius} TEXTURE AMBIENT 0.1 DIFFUSE 0.6 SPECULAR 0 OPACITY 1 "
                       f"COLOR {r} {g} {b} TEXFUNC 0\n")
        file.write("END_SCENE\n")
    subprocess.run([program, path, "-o", os.path.join(folder, "text.tga"), "-format", "TARGA"], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def programs(particles):
    """(name, call) of those that are installed."""
    found = [("text by Python, drawn by rtlang", as_text, os.environ.get("RTLANG", "./rtlang")),
             ("text by Python, drawn by Tachyon", as_tachyon, shutil.which("tachyon")),
             ("text by Python, drawn by POV-Ray", as_text,
              shutil.which("povray") if len(particles.radii) <= 10**6 else None)]
    for name, write, program in found:
        def call(write=write, program=program):
            with tempfile.TemporaryDirectory() as folder:
                write(particles, folder, program)
        if program:
            yield name, call


def report(count, runs):
    """One table, and the peak of memory so far, which is that of the most spheres where their numbers rise."""
    particles = Particles(count)
    rows = []

    def add(name, call, times):
        wall, cpu, image = measured(call, times)
        part = image.seconds if image else {}
        rows.append((name, wall, cpu, part.get("prepare", 0), part.get("trace", 0)))
        return image

    add("arrays to picture, whole call", particles.whole, runs)
    print(f"peak memory of that {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB, numpy's arrays "
          f"{sum(a.nbytes for a in (particles.centers, particles.radii, particles.colors)) / 2**20:.0f} MiB of it")
    add("another camera", particles.again, runs)
    add("other colors", particles.colored, runs)
    frames = FRAMES if count <= 10**6 else runs
    wall, cpu, images = measured(lambda: [particles.moved() for _ in range(frames)], 1)
    rows.append(("all centers moved a little, each frame", wall / frames, cpu / frames,
                 *(sum(seconds[part] for seconds, _ in images) / frames for part in ("prepare", "trace"))))
    trees = images[-1][1] - images[0][1]
    add("all centers elsewhere", particles.shuffled, runs)
    if "all" in sys.argv:
        for name, call in programs(particles):
            add(name, call, 1)
    print(f"{count} spheres, {WIDTH} x {HEIGHT}, {os.cpu_count()} processors, least of {runs} runs (programs: 1; "
          f"moved: the mean of {frames}, of which {trees} built a tree)")
    print(f"{'':38} {'seconds':>8} {'processor':>9} {'tree':>7} {'frame':>7} {'ratio':>6}")
    for name, wall, cpu, tree, frame in rows:
        ratio = f"{wall / (tree + frame):6.2f}" if frame else ""
        print(f"{name:38} {wall:8.3f} {cpu:9.3f} {tree:7.3f} {frame:7.3f} {ratio}", flush=True)


def main():
    counts = sys.argv[1].split(",") if len(sys.argv) > 1 else ("1e6", "1e7")
    for count in counts:
        report(int(float(count)), int(sys.argv[2]) if len(sys.argv) > 2 else 5)


if __name__ == "__main__":
    main()
