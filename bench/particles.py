#!/usr/bin/env python3
"""What a million particles cost from numpy arrays to a picture, beside the tree and the frame alone, and as text.

    PYTHONPATH=python RTLANG_LIBRARY=.libs/librtlang.so RTLANG=./rtlang bench/particles.py [SPHERES] [RUNS]

Prints seconds and processor seconds, the least of some runs. Only ratios of one run mean anything.
SPDX-License-Identifier: MIT
"""
import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
import rtlang

WIDTH, HEIGHT = 1920, 1080


def measured(call, runs):
    """Least seconds and least processor seconds of this process and its children, and what the call gave last."""
    best, result = [float("inf")] * 2, None
    for _ in range(runs):
        used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        begun = time.perf_counter()
        result = call()
        wall = time.perf_counter() - begun
        now = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        cpu = sum(b.ru_utime + b.ru_stime - a.ru_utime - a.ru_stime for a, b in zip(used, now))
        best = [min(best[0], wall), min(best[1], cpu)]
    return best + [result]


def main():
    count = int(float(sys.argv[1])) if len(sys.argv) > 1 else 10**6
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    rng = np.random.default_rng(1)
    side = (count / 1000) ** (1 / 3)
    centers, radii = rng.uniform(-side, side, (count, 3)), rng.uniform(0.05, 0.15, count)
    colors = rng.uniform(0.2, 1, (count, 3)).astype(np.float32)
    kept = []

    def whole():
        kept.clear()
        scene = rtlang.Scene()
        kept.extend((scene, scene.spheres(centers, radii, colors)))
        scene.light((-30, 50, 60))
        scene.camera((2.5 * side, side, 3 * side), (0, 0, 0), angle=45)
        return scene.render(WIDTH, HEIGHT)

    def turned():
        turned.angle += 0.01
        kept[0].camera((2.5 * side, side * (1 + turned.angle), 3 * side), (0, 0, 0), angle=45)
        return kept[0].render(WIDTH, HEIGHT)
    turned.angle = 0.0

    def moved():
        kept[1].update(centers=centers)
        return kept[0].render(WIDTH, HEIGHT)

    def text():
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "text.scn")
            with open(path, "w", encoding="ascii") as file:
                file.write("#version 3.7; global_settings { assumed_gamma 1 } light_source { <-30, 50, 60>, rgb 1 }\n"
                           f"camera {{ location <{2.5 * side}, {side}, {3 * side}> right -16/9*x up y angle 45\n"
                           "look_at 0 }\n")
                for (x, y, z), radius, (r, g, b) in zip(centers.tolist(), radii.tolist(), colors.tolist()):
                    file.write(f"sphere {{ <{x}, {y}, {z}>, {radius} pigment {{ color rgb <{r}, {g}, {b}> }} }}\n")
            subprocess.run([os.environ.get("RTLANG", "./rtlang"), "-q", f"-W{WIDTH}", f"-H{HEIGHT}", "-o",
                            os.path.join(folder, "text.png"), path], check=True)

    rows = []
    for name, call, times in (("arrays to picture, whole call", whole, runs), ("another camera", turned, runs),
                              ("all centers moved", moved, runs), ("text written and drawn by the program", text, 1)):
        wall, cpu, image = measured(call, times)
        part = image.seconds if image else {}
        rows.append((name, wall, cpu, part.get("prepare", 0), part.get("trace", 0)))
    print(f"{count} spheres, {WIDTH} x {HEIGHT}, {os.cpu_count()} processors, least of {runs} runs (text: 1)")
    print(f"{'':40} {'seconds':>8} {'processor':>9} {'tree':>7} {'frame':>7} {'ratio':>6}")
    for name, wall, cpu, tree, frame in rows:
        ratio = f"{wall / (tree + frame):6.2f}" if frame else ""
        print(f"{name:40} {wall:8.3f} {cpu:9.3f} {tree:7.3f} {frame:7.3f} {ratio}")
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
