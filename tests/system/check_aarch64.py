#!/usr/bin/env python3
"""A build for aarch64, run by qemu: it compiles, and draws the same pictures as the usual build, bit for bit.

Configures and builds in a folder of its own with a cross compiler; for `make check-long`. What it needs and does not find is
told by the word that skips it; on Debian: dpkg --add-architecture arm64, then gcc-aarch64-linux-gnu, libjpeg-dev:arm64,
libpng-dev:arm64 and qemu-user. Wants RTLANG (the usual build's) and top_srcdir; AARCH64_BUILD names a folder to keep the build in. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from tap import Tap

TOP = os.path.abspath(os.environ.get("top_srcdir", "."))
HOST = "aarch64-linux-gnu"
PACKAGES = f"/usr/lib/{HOST}/pkgconfig"
SCENES = ["01_", "04_", "06_", "08_", "10_", "12_"]  # of examples
POVRAY = ["fog_", "normal", "pattern", "transport", "camera_fisheye", "light"]  # a scene of tests/povray whose name begins so


def run(*command, cwd=None, **more):
    environment = {**os.environ, **more}
    done = subprocess.run(command, cwd=cwd, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          check=False, timeout=3000)
    return done.returncode, done.stdout, done.stderr.decode(errors="replace")


def missing():
    """What keeps this from being tried, or None."""
    if not os.environ.get("CHECK_LONG"):
        return "it takes minutes: make check-long"
    if not os.path.exists(f"{TOP}/configure"):
        return "the source tree has no configure"
    for program in f"{HOST}-gcc", "qemu-aarch64":
        if not shutil.which(program):
            return f"{program} is not installed"
    for name in "libpng", "libjpeg":
        if not os.path.exists(f"{PACKAGES}/{name}.pc"):
            return f"{name}-dev:arm64 is not installed"
    return None


def build(tap, folder):
    configure = [f"{TOP}/configure", f"--host={HOST}", "--without-openimageio", "--disable-study", "--disable-shared",
                 "--disable-dependency-tracking", "CFLAGS=-O1", f"CC={HOST}-gcc"]
    for step in configure, ["make", "-j2", "rtlang"]:
        if step is configure and os.path.exists(f"{folder}/Makefile"):
            continue
        code, out, err = run(*step, cwd=folder, PKG_CONFIG_LIBDIR=PACKAGES)
        if code != 0:
            return tap.ok(False, f"it compiles for {HOST}", (out.decode(errors="replace") + err)[-2000:])
    return tap.ok(True, f"it compiles for {HOST}")


def picture(command, scene, name):
    """The bytes of a picture, or what was said instead."""
    code, _, err = run(*command, "-q", "-W40", "-H30", "-t2", "-I", f"{TOP}/share/rtlang", "-o", name, scene, cwd=os.path.dirname(scene))
    if code != 0:
        return f"{code}: {err}"
    with open(name, "rb") as file:
        return file.read()


def check_pictures(tap, folder):
    other = ["qemu-aarch64", "-L", "/", f"{folder}/rtlang"]
    scenes = [path for prefix in SCENES for path in sorted(glob.glob(f"{TOP}/examples/{prefix}*.scn"))[:1]]
    scenes += [path for prefix in POVRAY for path in sorted(glob.glob(f"{TOP}/tests/povray/{prefix}*.scn"))[:1]]
    with tempfile.TemporaryDirectory() as pictures:
        for scene in scenes:
            usual = picture([os.path.abspath(os.environ["RTLANG"])], scene, f"{pictures}/usual.png")
            here = picture(other, scene, f"{pictures}/here.png")
            tap.ok(isinstance(usual, bytes) and usual == here, f"{os.path.basename(scene)}: the same bytes",
                   here if isinstance(here, str) else "other bytes")
    code, out, err = run(*other, "--dump=scene", scenes[-1])
    _, expected, _ = run(os.environ["RTLANG"], "--dump=scene", scenes[-1])
    tap.ok(code == 0 and out == expected, "the same scene records", err[:300])


def main():
    tap = Tap()
    why = missing()
    if why:
        tap.skip("a build for aarch64", why)
        return tap.done()
    with tempfile.TemporaryDirectory() as own:
        folder = os.environ.get("AARCH64_BUILD") or own
        os.makedirs(folder, exist_ok=True)
        if build(tap, folder):
            check_pictures(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
