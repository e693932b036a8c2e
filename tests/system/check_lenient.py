#!/usr/bin/env python3
"""--lenient: the picture of a scene with what rtlang has not is that of the same scene without it, and its file says so.

The expected pictures are drawn of texts from which the blocks were cut by hand. Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import subprocess
import sys
import tempfile
import zlib

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tap  # noqa: E402
from picture_bytes import png_chunks  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])
# [[...]] is what rtlang has not
SCENE = """#version 3.7;
global_settings { assumed_gamma 1 [[radiosity { count 50 }]] [[photons { spacing 0.1 }]] max_trace_level 6 }
camera { location <0, 1, -5> look_at 0 }
light_source { <5, 5, -5> rgb 1 [[photons { reflection on }]] }
[[media { emission 0.1 }]]
#declare Metal = finish { [[subsurface { translucency 0.3 }]] phong 0.5 reflection 0.2 };
#declare Skin = texture { pigment { rgb <0.8, 0.3, 0.2> } finish { Metal } };
union { sphere { <-1, 0, 0>, 1 } sphere { <1, 0, 0>, 1 } texture { Skin } }
sphere { <0, 1, -1>, 0.4 pigment { rgbt 0.8 } interior { ior 1.4 [[media { absorption 1 }]] [[dispersion 1.1]] } }
#declare Unused = texture { pigment { facets } };
"""
WARNING = ("drawn without radiosity in global_settings, photons in global_settings, media, subsurface in finish, "
           "dispersion in interior")


def notes(path):
    with open(path, "rb") as file:
        texts = [body.split(b"\0", 1) for kind, body in png_chunks(file.read()) if kind == b"tEXt"]
    return {name.decode(): text.decode() for name, text in texts}


def pixels(path):
    with open(path, "rb") as file:
        return zlib.decompress(b"".join(body for kind, body in png_chunks(file.read()) if kind == b"IDAT"))


def run(folder, *words):
    done = subprocess.run([PROGRAM, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=120, check=False)
    return done.returncode, done.stderr.decode()


def cut(text):
    while "[[" in text:
        begin, end = text.index("[["), text.index("]]")
        text = text[:begin] + text[end + 2:]
    return text


def main():
    report = tap.Tap()
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("whole.scn", SCENE.replace("[[", "").replace("]]", "")), ("cut.scn", cut(SCENE))):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        at = lambda name: os.path.join(folder, name)  # noqa: E731
        status, told = run(folder, "whole.scn")
        report.equal((status, os.path.exists(at("whole.png"))), (1, False), "without --lenient it is a fault")
        report.ok("`--lenient` draws without it; the picture then lacks light that surfaces throw on one another" in told,
                  "which says what would be lacking", told)
        status, told = run(folder, "--lenient", "whole.scn")
        report.equal((status, told.count("warning[W0409]")), (0, 5), "with --lenient it is drawn, and each word told once")
        report.ok("facets" not in told, "what is not used is not told", told)
        status, _ = run(folder, "cut.scn")
        report.equal(pixels(at("whole.png")), pixels(at("cut.png")), "the pixels are those of the scene cut by hand")
        report.equal(notes(at("whole.png")).get("Warning"), WARNING, "the file says what it was drawn without")
        report.ok("Warning" not in notes(at("cut.png")), "and nothing where nothing was left out")
        status, told = run(folder, "-q", "--lenient", "-Werror", "-o", "error.png", "whole.scn")
        report.equal((status, os.path.exists(at("error.png"))), (1, False), "warnings can be made errors")
        status, _ = run(folder, "--povray", "+Iwhole.scn", "+W32", "+H24", "+Opovray.png")
        report.equal(status, 1, "in POV-Ray's place it is a fault, too")
        status, _ = run(folder, "--povray", "--lenient", "+Iwhole.scn", "+W32", "+H24", "+Opovray.png")
        report.equal((status, notes(at("povray.png")).get("Warning")), (0, WARNING), "unless --lenient stands beside it")
    report.done()


main()
