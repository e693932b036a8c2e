#!/usr/bin/env python3
"""Pictures of parts, and of runs that were killed and continued: the bytes of one undisturbed run.

Without words all of it, in short; `kills N` kills N runs. Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tap  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])
HEAD = "#version 3.7; global_settings { assumed_gamma %s max_trace_level 6 }\n"
# Small shapes that samples may miss, glass, an area light, a texture, edges of spheres.
RICH = HEAD % "1" + """
camera { location <0, 2, -7> look_at 0 }
light_source { <5, 8, -6>, rgb 1 area_light x, y, 3, 3 jitter }
light_source { <-5, 3, -6>, rgb <0.2, 0.2, 0.4> }
background { rgb <0.2, 0.3, 0.5> }
plane { y, -1 pigment { checker rgb 0.8 rgb <0.7, 0.2, 0.1> } finish { reflection 0.2 } }
sphere { <0.6, 0, 0>, 1 pigment { rgbt <1, 1, 1, 0.9> } interior { ior 1.5 } finish { phong 0.8 specular 0.5 roughness 0.001 } }
#declare I = 0;
#while (I < 60)
  sphere { <mod(I * 0.37, 4) - 2, mod(I * 0.61, 2) - 0.9, mod(I * 0.83, 3)>, 0.012 + 0.05 * mod(I, 4) / 4
    pigment { rgb <mod(I, 3) / 2, 0.6, 0.3> } finish { specular 0.6 roughness 0.002 } }
  #declare I = I + 1;
#end
"""
OLD = HEAD % "2.2" + """
camera { location <0, 1, -5> look_at 0 }
light_source { <5, 5, -5> rgb 1 }
box { <-1, -1, -1>, <1, 0.5, 1> rotate y * 30 pigment { rgbf <0.8, 0.4, 0.1, 0.3> } }
torus { 1, 0.3 translate y * 0.8 pigment { rgb 0.7 } normal { bumps 0.5 scale 0.2 } finish { phong 1 } }
"""
LENS = HEAD % "1" + """
camera { location <0, 1, -5> look_at 0 aperture 0.4 focal_point 0 blur_samples 12 variance 1 / 1000 confidence 0.95 }
light_source { <5, 5, -5> rgb 1 }
sphere { 0, 1 pigment { rgb <1, 0.5, 0.2> } finish { phong 0.7 } }
plane { y, -1 pigment { rgb 0.5 } }
"""
SIZE = ["-q", "-W", "100", "-H", "75", "-t", "2"]
# What parts can be made of; then what follows from the whole picture. Options, the picture's ending.
APART = [
    ("rich", [], ".png"),
    ("rich", ["--alpha"], ".png"),
    ("old", ["--antialias=1", "--antialias-threshold=0.1"], ".png"),
    ("old", ["--antialias=2", "--antialias-threshold=0.1", "--alpha"], ".tga"),
    ("old", ["--samples=6", "--sampler=jittered", "--seed=3"], ".png"),
    ("rich", ["--samples=16"], ".png"),
    ("rich", ["--samples=9", "--alpha", "--planes=depth,normal,object,albedo,error,samples"], ".exr"),
    ("rich", ["--samples=4", "--no-estimate", "--filter=gaussian"], ".png"),
    ("rich", ["--crop=30,20,50,40", "--whole", "--outline=2", "--depth-cue=0.4", "--sky-light=0.3"], ".png"),
    ("lens", [], ".png"),
]
WHOLE = [
    ("rich", ["--target-error=0.02"], ".png"),
    ("rich", ["--samples=8", "--adaptive", "--planes=error,depth"], ".exr"),
    ("rich", ["--samples=12", "--adaptive", "--filter=tent"], ".png"),
    ("old", ["--target-error=0.01", "--sampler=random"], ".png"),
]


class Place:
    """A folder with the scenes."""

    def __init__(self):
        self.path = tempfile.mkdtemp()
        for name, text in (("rich", RICH), ("old", OLD), ("lens", LENS)):
            with open(os.path.join(self.path, name + ".scn"), "w", encoding="utf-8") as file:
                file.write(text)

    def run(self, *words, before=(), seconds=600):
        done = subprocess.run([*before, PROGRAM, *words], cwd=self.path, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=seconds, check=False)
        return done.returncode, done.stderr.decode(errors="replace")

    def bytes(self, name):
        try:
            with open(os.path.join(self.path, name), "rb") as file:
                return file.read()
        except OSError:
            return None

    def close(self):
        shutil.rmtree(self.path)


def reference(place, scene, options, ending):
    """The picture of one run; how long that took."""
    start = time.monotonic()
    code, text = place.run(*SIZE, *options, "-o", "one" + ending, scene + ".scn")
    assert code == 0, text
    return place.bytes("one" + ending), time.monotonic() - start


def check_parts(test, place):
    for scene, options, ending in APART:
        expected, _ = reference(place, scene, options, ending)
        for parts in (2, 5):
            name = "joined" + ending
            for i in random.sample(range(1, parts + 1), parts):
                kept = ["--checkpoint=0", "--resume"] * (parts == 2)
                code, text = place.run(*SIZE, *options, "--part=%d/%d" % (i, parts), *kept, "-o", name, scene + ".scn")
                if code:
                    test.ok(False, "a part", text)
            files = ["%s.part-%d-of-%d" % (name, i, parts) for i in range(parts, 0, -1)]
            code, text = place.run("-q", "--join", *files)
            test.ok(code == 0 and place.bytes(name) == expected and not place.bytes(files[0] + ".checkpoint"),
                    "%s, %s: %d parts, joined" % (scene, " ".join(options) or "one ray", parts), text)


def said(test, place, words, code, expected):
    found, text = place.run(*words)
    test.ok(found == code and expected in text, "%s: %s" % (" ".join(words), expected.strip()), "exit %d\n%s" % (found, text))


def check_povray_words(test, place):
    """POV-Ray's options, and a part of them that was killed."""
    words = ["+W100", "+H75", "+A0.1", "+Iold.scn"]
    place.run(*words, "+Opov.png")
    for i in 1, 2, 3:
        if i == 2:
            killed_run(place, [*words, "+Oparts.png", "--part=2/3", "--checkpoint=0"], 0.05, signal.SIGKILL)
        place.run(*words, "+Oparts.png", "--part=%d/3" % i, "--checkpoint=0", "--resume")
    code, text = place.run("--join", *["parts.png.part-%d-of-3" % i for i in (1, 2, 3)])
    test.ok(code == 0 and place.bytes("parts.png") == place.bytes("pov.png"), "POV-Ray's options in parts", text)


def check_refusals(test, place):
    place.run(*SIZE, "--part=1/2", "-o", "a.png", "rich.scn")
    place.run(*SIZE, "--part=2/2", "-o", "a.png", "rich.scn")
    place.run(*SIZE, "--part=2/2", "-o", "b.png", "--samples=2", "rich.scn")
    place.run(*SIZE, "--part=2/2", "-o", "c.png", "old.scn")
    place.run(*SIZE, "--part=1/3", "-o", "a.png", "rich.scn")
    one, two = "a.png.part-1-of-2", "a.png.part-2-of-2"
    said(test, place, ["--part=5/4", "rich.scn"], 2, "option `--part` wants a part and the number of parts, as 3/8")
    said(test, place, ["--join", one], 2, "error[E0713]: of 2 parts these are missing: 2\n")
    said(test, place, ["--join", one, two, one], 2, "error[E0713]: `%s` is part 1, and so is `%s`\n" % (one, one))
    said(test, place, ["--join", one, "a.png.part-1-of-3"], 2,
         "error[E0713]: `a.png.part-1-of-3` is a part of 3, where `%s` is one of 2\n" % one)
    said(test, place, ["--join", one, "b.png.part-2-of-2"], 2,
         "error[E0712]: `b.png.part-2-of-2` holds results of another picture: the options are others\n")
    said(test, place, ["--join", one, "c.png.part-2-of-2"], 2,
         "error[E0712]: `c.png.part-2-of-2` holds results of another picture: the scene's text is another one\n")
    said(test, place, ["--join", one, "none"], 3, "error[E0520]: cannot read `none`: No such file or directory\n")
    said(test, place, ["--join", one, "rich.scn"], 3,
         "error[E0520]: `rich.scn` is no file of partial results of this version\n")
    with open(os.path.join(place.path, two), "r+b") as file:
        file.truncate(os.path.getsize(file.name) - 3)
    said(test, place, ["--join", one, two], 3,
         "error[E0520]: `%s` is not whole: bytes are missing, or others than were written\n" % two)
    said(test, place, ["--part=1/2", "--target-error=0.01", "rich.scn"], 2,
         "error[E0703]: `--part` cannot be combined with that: the rounds of `--target-error` follow from the whole picture")
    said(test, place, ["--part=1/2", "--frames=1..3", "rich.scn"], 2, "give each job frames of its own by `--frames`")
    said(test, place, ["--part=1/2", "-o", "-", "rich.scn"], 2, "`--part` wants scene and picture in files")
    said(test, place, ["--checkpoint=1", "--method=forward", "rich.scn"], 2,
         "photons of `--method` cannot be shared or kept")
    shutil.copy(PROGRAM, os.path.join(place.path, "alone"))
    done = subprocess.run(["./alone", "--mpi", "old.scn"], cwd=place.path, stderr=subprocess.PIPE, check=False)
    test.ok(done.returncode == 3 and b"error[E0521]: `--mpi` needs MPI: no rtlang_mpi.so in " in done.stderr,
            "no module for MPI", done.stderr.decode())
    said(test, place, ["--checkpoint=1", "-o", "none/x.png", "rich.scn"], 3, "error[E0505]: cannot write")


def killed_run(place, words, seconds, how):
    """Starts a run and kills it after as long; whether it had ended by itself."""
    process = subprocess.Popen([PROGRAM, *words], cwd=place.path, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    try:
        process.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(how)
    text = process.communicate()[1].decode(errors="replace")
    return process.returncode, text


def stopped_run(place, words, name, size):
    """Starts a run and stops it by SIGTERM, once the file `name` is so large."""
    path = os.path.join(place.path, name)
    process = subprocess.Popen([PROGRAM, *words], cwd=place.path, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    while process.poll() is None and not (os.path.exists(path) and os.path.getsize(path) > size):
        time.sleep(0.002)
    process.terminate()
    text = process.communicate()[1].decode(errors="replace")
    return process.returncode, text


def check_kills(test, place, count):
    """Runs that are killed at random moments, again and again, and continued to the end."""
    killed = wrong = stopped = 0
    ways = WHOLE + APART[5:7] + APART[:1]
    texts = ""
    while killed < count and wrong < 3:
        scene, options, ending = ways[killed % len(ways)]
        expected, seconds = reference(place, scene, options, ending)
        for turn in range(min(4, count)):
            for name in os.listdir(place.path):
                if name.startswith("killed"):
                    os.unlink(os.path.join(place.path, name))
            words = [*SIZE, *options, "--checkpoint=%g" % random.choice([0, 0, 0.01]), "--resume", "-o",
                     "killed" + ending, scene + ".scn"]
            code = 1
            for _ in range(8):
                how = random.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM])
                code, text = killed_run(place, words, random.uniform(0.05, 1.0) * seconds, how)
                killed += code == -signal.SIGKILL
                stopped += code in (-signal.SIGTERM, 128 + signal.SIGTERM)
                if code not in (0, -signal.SIGKILL, -signal.SIGTERM, 128 + signal.SIGTERM):
                    wrong, texts = wrong + 1, texts + text
            code, text = place.run(*words)
            left = place.bytes("killed" + ending + ".checkpoint")
            if code or place.bytes("killed" + ending) != expected or left is not None:
                wrong, texts = wrong + 1, texts + "%s %s: exit %d\n%s" % (scene, options, code, text)
    test.ok(wrong == 0, "%d times killed and %d times stopped at random, then continued: the same pictures"
            % (killed, stopped), texts)


def check_checkpoints(test, place):
    words = [*SIZE, "--samples=100000", "--checkpoint=0", "-o", "kept.png", "rich.scn"]
    code, text = stopped_run(place, words, "kept.png.checkpoint", 100000)
    test.ok(code == 143 and "what was done is kept, and `--resume` continues" in text and
            place.bytes("kept.png") is None and place.bytes("kept.png.checkpoint"),
            "SIGTERM leaves a checkpoint and no picture", "exit %d\n%s" % (code, text))
    said(test, place, [*SIZE, "--samples=256", "--resume", "-o", "kept.png", "rich.scn"], 2,
         "error[E0712]: `kept.png.checkpoint` holds results of another picture: the options are others\n")
    shutil.copy(os.path.join(place.path, "kept.png.checkpoint"), os.path.join(place.path, "kept2.png.checkpoint"))
    said(test, place, [*SIZE, "--samples=100000", "--resume", "-o", "kept2.png", "old.scn"], 2,
         "error[E0712]: `kept2.png.checkpoint` holds results of another picture: the scene's text is another one\n")
    check_torn(test, place)
    place.run(*SIZE, "--part=1/1", "-o", "torn.png", "rich.scn")
    said(test, place, [*SIZE, "--resume", "-o", "torn.png", "rich.scn"], 0, "")
    with open(os.path.join(place.path, "torn.png.checkpoint"), "wb") as file:
        file.write(place.bytes("torn.png.part-1-of-1")[:-200])
    code, text = place.run(*SIZE, "--resume", "-o", "torn.png", "rich.scn")
    test.ok(code == 2 and "holds results of another part" in text, "a part is not continued as a whole", text)
    frames = [*SIZE, "-D", "A=1", "--frames=1..4", "--samples=16"]
    place.run(*frames, "-o", "f.png", "rich.scn")
    for _ in range(3):
        killed_run(place, [*frames, "--checkpoint=0", "--resume", "-o", "g.png", "rich.scn"], random.uniform(0.2, 0.8),
                   signal.SIGKILL)
    code, text = place.run(*frames, "--checkpoint=0", "--resume", "-o", "g.png", "rich.scn")
    test.ok(code == 0 and all(place.bytes("f%d.png" % i) == place.bytes("g%d.png" % i) for i in range(1, 5)),
            "frames, killed and continued", text)


def check_torn(test, place):
    """A machine that stopped while a checkpoint was written to."""
    options = ["--samples=256"]
    expected, _ = reference(place, "rich", options, ".png")
    words = [*SIZE, *options, "--checkpoint=0", "-o", "torn.png", "rich.scn"]
    stopped_run(place, words, "torn.png.checkpoint", 200000)
    path = os.path.join(place.path, "torn.png.checkpoint")
    with open(path, "r+b") as file:
        file.truncate(os.path.getsize(path) - 5)
    code, text = place.run(*words, "--resume")
    test.ok(code == 0 and "warning[W0503]: `torn.png.checkpoint` is not whole: what follows its first " in text and
            place.bytes("torn.png") == expected, "a checkpoint without its end", "exit %d\n%s" % (code, text))


def main():
    test, place = tap.Tap(), Place()
    random.seed(int(os.environ.get("SEED", "1")))
    if sys.argv[1:2] == ["kills"]:
        check_kills(test, place, int(sys.argv[2]))
    else:
        check_parts(test, place)
        check_povray_words(test, place)
        check_refusals(test, place)
        check_checkpoints(test, place)
        check_kills(test, place, 12)
    place.close()
    test.done()


if __name__ == "__main__":
    main()
