#!/usr/bin/env python3
"""What vapory's documentation shows, with rtlang as `povray`: its scenes, its command line, its picture as an array.

vapory is in no package here. After its README, an element is its name with underscores and its arguments one on each line;
Scene.render() without a file runs `povray FILE +H +W [+A] -D Output_File_Type=P +O-` and reads the PPM from standard
output. Each picture is compared with POV-Ray's, where it is installed. Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "system"))
import pictures  # noqa: E402
import tap  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])


def text(value):
    """A list is a vector, a string and a number stand as they are."""
    return "<" + ",".join(map(str, value)) + ">" if isinstance(value, (list, tuple)) else str(value)


class Element:
    """Element(argument, ...) is `element { argument ... }`."""
    def __init__(self, *arguments):
        self.arguments = arguments

    def __str__(self):
        name = re.sub(r"(?<=.)([A-Z])", r"_\1", type(self).__name__).lower()
        return name + " {\n" + "\n".join(map(text, self.arguments)) + "\n}"


NAMES = ("Camera LightSource Sphere Box Plane Cylinder Cone Torus Texture Pigment Finish Normal Background Fog Union Difference "
         "Intersection Merge Interior")
for NAME in NAMES.split():
    globals()[NAME] = type(NAME, (Element,), {})


class Scene:
    """The text of a scene, and its picture by the program that PATH has for `povray`."""
    def __init__(self, camera, objects=(), atmospheric=(), included=(), declares=()):
        self.text = "\n".join([*(f'#include "{name}"' for name in included), *map(text, declares), *map(text, objects), str(camera),
                               *map(text, atmospheric), "global_settings{\nassumed_gamma 1.0\n}"])

    def run(self, folder, output, width, height, antialiasing=None, quality=None):
        with open(os.path.join(folder, "__temp__.pov"), "w", encoding="ascii") as file:
            file.write(self.text)
        words = ["__temp__.pov", f"+H{height}", f"+W{width}"] + ([f"+Q{quality}"] if quality is not None else [])
        words += [f"+A{antialiasing:f}"] if antialiasing is not None else []
        words += ["-D", "Output_File_Type=P", "+O-"] if output is None else ["Output_File_Type=N", f"+O{output}"]
        return subprocess.run(["povray", *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              env=dict(os.environ, HOME=folder, POVINI=os.path.join(folder, "none.ini"), SDL_VIDEODRIVER="dummy"),
                              timeout=120, check=False)

    def render(self, folder, **how):
        """(height, width, the codes) of the PPM on standard output, as an array of height x width x 3 has them."""
        done = self.run(folder, None, **how)
        header = re.match(rb"P6\s(?:#.*\n)*(\d+)\s+(\d+)\s+255\n", done.stdout)
        assert done.returncode == 0 and header, (done.returncode, done.stdout[:40], done.stderr[-500:])
        codes = done.stdout[header.end():]
        assert len(codes) == 3 * int(header[1]) * int(header[2]), "the picture is not whole"
        return int(header[2]), int(header[1]), codes


LIGHT = LightSource([2, 4, -3], "color", [1, 1, 1])
CAMERA = Camera("location", [0, 2, -3], "look_at", [0, 1, 2])
PURPLE = Sphere([0, 1, 2], 2, Texture(Pigment("color", [1, 0, 1])))
SCENES = {
    "the purple sphere": Scene(CAMERA, objects=[LIGHT, PURPLE]),
    "all parts of a scene": Scene(
        CAMERA, objects=[LIGHT, Background("color", [0.8, 0.9, 1]), Plane([0, 1, 0], 0, Texture(Pigment("color", "Gray50")))],
        atmospheric=[Fog("distance", 10, "color", [0.7, 0.7, 0.8])], included=["colors.inc", "textures.inc"],
        declares=["#declare R = 2;"]),
    "objects made of others": Scene(
        Camera("location", [2, 3, -8], "look_at", [0, 0, 0], "angle", 40),
        objects=[LightSource([5, 8, -9], "color", "White"),
                 Difference(Box([-1, -1, -1], [1, 1, 1]), Sphere([0, 0, 0], 1.3), Texture(Pigment("color", [0.9, 0.5, 0.2]))),
                 Union(Cylinder([0, -1, 0], [0, 1, 0], 0.2), Cone([0, 1, 0], 0.5, [0, 1.6, 0], 0),
                       Texture(Pigment("color", [0.2, 0.6, 0.9]), Finish("phong", 0.8, "reflection", 0.2))),
                 Torus(1.8, 0.1, Texture(Pigment("checker", "color", [1, 1, 0], "color", [0, 0.4, 0], "scale", 0.5)))],
        included=["colors.inc"]),
}
RUNS = {"": {}, ", anti-aliased": {"antialiasing": 0.01}}


def compare(report, name, scene, places, how):
    pictures_made = []
    with tempfile.TemporaryDirectory() as folder:
        for place in filter(None, places):
            os.environ["PATH"] = place + os.pathsep + PATH
            pictures_made.append(scene.render(folder, width=80, height=60, **how))
    own, other = pictures_made[0], pictures_made[-1]
    report.equal(own[:2], (60, 80), f"{name}: an array of 60 x 80 x 3")
    if not places[1]:
        report.skip(f"{name}: POV-Ray's picture", "povray is not installed")
        return
    # With anti-aliasing POV-Ray moves its samples at random: where it takes more, colours are means of a few.
    bar, share = (1, pictures.TIE_SHARE) if not how else (16, 0.02)
    beyond = sum(abs(a - b) > bar for a, b in zip(own[2], other[2]))
    report.ok(beyond <= share * len(own[2]), f"{name}: POV-Ray's picture", f"{beyond} codes differ by more than {bar}")


def main():
    report = tap.Tap()
    with tempfile.TemporaryDirectory() as top:
        places = []
        for name, program in (("rtlang", PROGRAM), ("povray", pictures.povray())):
            os.mkdir(os.path.join(top, name))
            if program:
                os.symlink(program, os.path.join(top, name, "povray"))
            places.append(os.path.join(top, name) if program else None)
        for name, scene in SCENES.items():
            if not places[1] and "textures.inc" in scene.text:
                report.skip(name, "POV-Ray's include files are not installed")
                continue
            for words, how in RUNS.items():
                compare(report, name + words, scene, places, how)
        os.environ["PATH"] = places[0] + os.pathsep + PATH
        done = SCENES["the purple sphere"].run(top, "purple_sphere.png", 40, 30, 0.001)
        report.ok(done.returncode == 0 and os.path.getsize(os.path.join(top, "purple_sphere.png")) > 0, "render() into a file",
                  done.stderr)
        done = SCENES["the purple sphere"].run(top, None, 40, 30, quality=1)
        report.ok(done.returncode == 1 and b"Quality" in done.stderr, "quality=1, without shadows, is refused by name", done.stderr)
        broken = Scene(CAMERA, objects=[Sphere([0, 1, 2], "Nothing")]).run(top, None, 40, 30)
        report.ok(broken.returncode == 1 and not broken.stdout and b"__temp__.pov:" in broken.stderr,
                  "what is wrong with a scene is said with its line, for the exception that vapory raises", broken.stderr)
    report.done()


PATH = os.environ.get("PATH", "")
main()
