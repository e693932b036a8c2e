#!/usr/bin/env python3
"""What the files of pictures say they were drawn from, and --rerun, which draws them again by that.

Digests are compared with Python's own. Prints TAP. SPDX-License-Identifier: MIT
"""
import hashlib
import os
import struct
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tap  # noqa: E402
from picture_bytes import png_chunks  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])
SCENE = """#version 3.7;
global_settings { assumed_gamma 1 }
#include "part.inc"
#ifdef (Add) sphere { <1, 1, 0>, Add pigment { rgb 1 } } #end
#ifdef (By_Header) sphere { <-1, 1, 0>, 0.3 pigment { rgb 1 } } #end
camera { location <0, 1, -5> look_at 0 }
light_source { <5, 5, -5> rgb 1 }
sphere { <clock, frame_number / 9, 0>, 1 pigment { Tint } finish { reflection 0.2 phong 0.5 } }
"""
PART = "#declare Tint = rgb <0.8, 0.4, 0.1>;\n"
# options, the picture
CASES = [
    ([], "plain.png"),
    (["-W", "64", "-H", "48", "--depth=16", "--file-gamma=1.8", "--alpha"], "values.png"),
    (["-W", "64", "-H", "48", "--crop=8,4,40,30", "--whole", "-D", "Add=0.25", "--clock=0.3"], "crop.png"),
    (["-W", "64", "-H", "48", "--samples=4", "--seed=7", "--sampler=halton", "--filter=tent"], "sampled.png"),
    (["-W", "64", "-H", "48", "--samples=8", "--adaptive", "--planes=depth,error"], "adaptive.exr"),
    (["-W", "64", "-H", "48", "--target-error=0.01"], "goal.png"),
    (["-W", "64", "-H", "48", "--time-limit=0.2"], "time.png"),
    (["-W", "64", "-H", "48", "--antialias=2", "--antialias-depth=2", "--antialias-threshold=0"], "finer.png"),
    (["-W", "64", "-H", "48", "--method=forward-connect", "--photons=5e4"], "forward.png"),
    (["-W", "64", "-H", "48", "--frames=1..3"], "frame.png"),
    (["-W", "64", "-H", "48", "--header=with blank.inc", "--threads=1"], "header.png"),
    (["+W64", "+H48", "+SC0.25", "+EC0.75", "+K0.25", "Declare=Add=0.5"], "part.png"),
    (["+W64", "+H48", "+A0.1", "-J", "+K0.25", "+HI'with blank.inc'"], "povray.png"),
]


def attributes(data):
    """Texts of an EXR header."""
    at, found = 8, {}
    while data[at]:
        name, kind, rest = data[at:at + 600].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack("<I", data[at:at + 4])[0]
        if kind == b"string":
            found[name.decode()] = data[at + 4:at + 4 + size].decode()
        at += 4 + size
        del rest
    return found


def notes(path):
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".exr"):
        return attributes(data)
    return dict(body.decode().split("\0", 1) for kind, body in png_chunks(data) if kind == b"tEXt")


def run(folder, *words):
    done = subprocess.run([PROGRAM, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=120, check=False)
    return done.returncode, done.stderr.decode()


def put(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def digest(data):
    return hashlib.blake2b(data, digest_size=32)


def check_origin(report, folder):
    version = subprocess.run([PROGRAM, "--version"], stdout=subprocess.PIPE, check=True).stdout.decode().split()[1]
    parts = digest(digest(PART.encode()).digest()).hexdigest()
    expected = {"Software": f"rtlang {version}", "rtlang:scene": f"blake2b-256 {digest(SCENE.encode()).hexdigest()}",
                "rtlang:files": f"1, blake2b-256 {parts}", "rtlang:options": "--width=320 --height=240"}
    report.equal(notes(os.path.join(folder, "plain.png")), expected, "a picture that is not sampled says its origin")
    found = notes(os.path.join(folder, "adaptive.exr"))
    report.ok(found["Software"] == expected["Software"] and found["rtlang:scene"] == expected["rtlang:scene"] and
              "--samples=8" in found["rtlang:options"] and "rtlang:rmse" in found, "so does EXR", found)
    found = notes(os.path.join(folder, "header.png"))["rtlang:options"]
    report.ok("--header=with\\ blank.inc" in found and "threads" not in found, "blanks are marked", found)
    run(folder, "-q", "-o", "plain.ppm", "s.scn")
    with open(os.path.join(folder, "plain.ppm"), "rb") as file:
        report.equal(file.read(15), b"P6\n320 240\n255\n", "the header of a PPM is as short as its readers expect")


def check_lengths(report, folder):
    wrong = []
    for length in (0, 1, 127, 128, 129, 255, 256, 4095, 4096, 4097, 70000):
        text = ("camera { location -5*z }\n" + "/" * length)[:max(length, 0)].ljust(length, "/")
        text = "//" + text[2:] if length > 1 else " " * length
        put(folder, "length.scn", text)
        run(folder, "-q", "-W", "8", "-H", "8", "length.scn")
        if notes(os.path.join(folder, "length.png")).get("rtlang:scene") != f"blake2b-256 {digest(text.encode()).hexdigest()}":
            wrong.append(length)
    report.equal(wrong, [], "digests of texts of all lengths around the block's")


def check_differences(report, folder):
    for name, text, reason in (("s.scn", SCENE + "// more\n", ": the scene's text is another one"),
                               ("part.inc", PART + "// more\n", ": a file that the scene includes is another one")):
        put(folder, name, text)
        found = run(folder, "--rerun=plain.png", "s.scn")
        report.ok(found[0] == 1 and f"error[E0711]: `plain.png` drawn again has other bytes{reason}\n" in found[1],
                  f"{name} changed: it is told", found)
        put(folder, name, SCENE if name == "s.scn" else PART)
    found = run(folder, "--rerun=plain.png", "-W", "64", "s.scn")
    report.ok(found[0] == 1 and "the options are others" in found[1], "other options are told", found)
    report.equal(run(folder, "--rerun=none.png", "s.scn"), (3, "rtlang: error[E0502]: `none.png` not found\n"),
                 "a picture that is not there")
    report.equal(run(folder, "--rerun=s.scn", "s.scn"),
                 (2, "rtlang: error[E0710]: `s.scn` does not say what it was drawn with\n"
                     "     = help: pictures of other programs, and formats other than PNG and EXR, do not\n"),
                 "what is no picture")
    found = run(folder, "--rerun=plain.png", "s.scn", "s.scn")
    report.ok(found[0] == 2 and "`--rerun` wants one scene" in found[1], "more than one scene", found)
    found = run(folder, "--povray", "--rerun=plain.png", "+Is.scn")
    report.ok(found[0] == 1 and "`--rerun` does not go with POV-Ray's options" in found[1], "not with POV-Ray's", found)


def main():
    report = tap.Tap()
    with tempfile.TemporaryDirectory() as folder:
        put(folder, "s.scn", SCENE)
        put(folder, "part.inc", PART)
        put(folder, "with blank.inc", "#declare By_Header = 1;\n")
        for options, name in CASES:
            is_povray = any(word.startswith("+") for word in options)
            words = [*options, "+Is.scn", f"+O{name}"] if is_povray else ["-q", *options, "-o", name, "s.scn"]
            status, told = run(folder, *words)
            name = "frame2.png" if name == "frame.png" else name
            before = sorted(os.listdir(folder))
            again, said = run(folder, "-t", "2", f"--rerun={name}", "s.scn")
            report.ok(status == 0 and again == 0 and said.endswith(f"{name}: drawn again, the bytes are the same\n"),
                      f"drawn again: {' '.join(options)}", told + said)
            report.equal(sorted(os.listdir(folder)), before, "which leaves no file")
        check_origin(report, folder)
        check_lengths(report, folder)
        check_differences(report, folder)
        status, _ = run(folder, "-q", "--rerun=plain.png", "-o", "kept.png", "s.scn")
        report.ok(status == 0 and os.path.exists(os.path.join(folder, "kept.png")), "-o keeps what was drawn again")
    report.done()


main()
