#!/usr/bin/env python3
"""Light from all sides beside Tachyon's (which OVITO and VMD draw ambient occlusion with): time to equal error.

    PYTHONPATH=python RTLANG_LIBRARY=.libs/librtlang.so bench/sky_light.py [SPHERES]

A ball of spheres (10 000) with no other light, 640 x 480, one thread each. A row is a number of rays of occlusion a
pixel; seconds are processor time less that of a picture with one such ray, so that reading and building are left out;
the error is the root mean square of pixel differences over the mean of the picture, against a picture of the same
program with 1024 rays and other random numbers. Tachyon rounds its pixels to 8 bits, which is a part of its error.
rtlang's samples are whole: each has a ray of its own from the eye, so that edges are smooth; Tachyon's come from one.
`at 10 %` is the row's time brought to an error of 10 % by the law of chance, four times the time for half of the error.
SPDX-License-Identifier: MIT
"""
import math
import os
import resource
import subprocess
import sys
import tempfile

import numpy as np
import rtlang

WIDTH, HEIGHT = 640, 480
RAYS = (16, 64, 256)
REFERENCE = 1024


def processor(who):
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


class Ball:
    """The same spheres for both."""

    def __init__(self, count):
        rng = np.random.default_rng(4)
        places = rng.normal(size=(count, 3))
        self.centers = places / np.linalg.norm(places, axis=1)[:, None] * np.cbrt(rng.uniform(size=count))[:, None]
        self.radius = 0.7 / np.cbrt(count)
        self.scene = rtlang.Scene()
        self.scene.spheres(self.centers, self.radius, (0.8, 0.8, 0.8), finish="ambient 0 diffuse 1")
        self.scene.sky(1.0)
        self.scene.camera((0.0, 0.0, 4.0), (0.0, 0.0, 0.0), angle=math.degrees(2 * math.atan(WIDTH / HEIGHT / 3)))

    def by_rtlang(self, rays, seed):
        begun = processor(resource.RUSAGE_SELF)
        image = self.scene.render(WIDTH, HEIGHT, samples=rays, seed=seed, threads=1)
        return processor(resource.RUSAGE_SELF) - begun, image.pixels.astype(float)

    def by_tachyon(self, rays, folder):
        path, picture = os.path.join(folder, "ball.dat"), os.path.join(folder, "ball.ppm")
        if not os.path.exists(path):
            with open(path, "w", encoding="ascii") as file:
                file.write(f"BEGIN_SCENE\nRESOLUTION {WIDTH} {HEIGHT}\nCAMERA\nPROJECTION PERSPECTIVE\nZOOM 1.5\n"
                           "ASPECTRATIO 1.0\nANTIALIASING 0\nRAYDEPTH 5\nCENTER 0 0 -4\nVIEWDIR 0 0 1\nUPDIR 0 1 0\n"
                           "END_CAMERA\nLIGHT CENTER 0 50 -60 RAD 0.1 COLOR 0 0 0\n")
                for x, y, z in self.centers.tolist():
                    file.write(f"SPHERE CENTER {x} {y} {-z} RAD {self.radius} TEXTURE AMBIENT 0 DIFFUSE 1 SPECULAR 0 "
                               "OPACITY 1 COLOR 0.8 0.8 0.8 TEXFUNC 0\n")
                file.write("END_SCENE\n")
        begun = processor(resource.RUSAGE_CHILDREN)
        subprocess.run(["tachyon", path, "-numthreads", "1", "-add_skylight", "1.0", "-skylight_samples", str(rays),
                        "-o", picture, "-format", "PPM"], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        seconds = processor(resource.RUSAGE_CHILDREN) - begun
        with open(picture, "rb") as file:
            data = file.read()
        return seconds, np.frombuffer(data[-3 * WIDTH * HEIGHT:], np.uint8).reshape(HEIGHT, WIDTH, 3) / 255


def table(name, draw, reference):
    """draw(rays) gives seconds and pixels."""
    draw(1)  # whatever is made once
    base, rows = draw(1)[0], []
    for rays in RAYS:
        seconds, pixels = draw(rays)
        rows.append((rays, seconds - base, math.sqrt(np.mean((pixels - reference) ** 2)) / np.mean(reference)))
    slope = math.log(rows[-1][2] / rows[0][2]) / math.log(rows[-1][0] / rows[0][0])
    print(f"{name}: the mean of its picture {np.mean(reference):.4f}, the error falls with the rays' power of {slope:.2f}")
    print(f"{'rays':>6} {'seconds':>9} {'error':>8} {'at 10 %':>9}")
    for rays, seconds, error in rows:
        print(f"{rays:6} {seconds:9.3f} {100 * error:6.2f} % {seconds * (error / 0.1) ** 2:9.2f}", flush=True)


def main():
    ball = Ball(int(float(sys.argv[1])) if len(sys.argv) > 1 else 10000)
    table("rtlang", lambda rays: ball.by_rtlang(rays, 1), ball.by_rtlang(REFERENCE, 2)[1])
    with tempfile.TemporaryDirectory() as folder:
        table("Tachyon", lambda rays: ball.by_tachyon(rays, folder), ball.by_tachyon(REFERENCE + 1, folder)[1])


if __name__ == "__main__":
    main()
