#!/usr/bin/env python3
# What the kernel forbids a run: calls that an intruder would make are planted into the program and must fail, while all
# that a run needs still works, and pictures are the same with and without. Prints TAP.
#
# Wants RTLANG, CC and top_srcdir.
#
# SPDX-License-Identifier: MIT
import os
import subprocess
import sys
import tempfile
import threading

sys.dont_write_bytecode = True
from tap import Tap

RTLANG = os.path.abspath(os.environ["RTLANG"])
SOURCE = os.path.join(os.environ["top_srcdir"], "tests", "system", "intruder.c")
GOOD = b"""#include "part.inc"
camera { location -5*z look_at 0 }
light_source { <5, 5, -5>, 1 }
sphere { 0, 1 pigment { image_map { png "map.png" } } finish { F } }
"""
OFTEN = ["read: EACCES", "write: EACCES", "make: EACCES"]
ALWAYS = ["socket: EPERM", "connect: EPERM", "kill: EPERM", "ptrace: EPERM"]
LATE = (b"rtlang: error[E0612]: the run takes more than 0.5 seconds; %s\n"
        b"     = help: `--max-time` allows more\n")
tap = Tap()


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def rtlang(*arguments, **environment):
    return subprocess.run([RTLANG, *arguments], env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, check=False)


def test_intruder(has_landlock, has_seccomp):
    built = subprocess.run("%s -shared -fPIC -O1 -o intruder.so '%s'" % (os.environ.get("CC", "cc"), SOURCE),
                           shell=True, stderr=subprocess.PIPE, check=False)
    planted = {"LD_PRELOAD": os.path.abspath("intruder.so"), "INTRUDER_OUT": os.path.abspath("../elsewhere")}
    free = rtlang("-q", "--no-confinement", "-o", "out/free.png", "good.scn", **planted).stderr.decode()
    if built.returncode != 0 or "read: done\n" not in free:
        tap.skip("planted calls", "nothing can be preloaded: " + built.stderr.decode()[:200])
        return
    tap.ok("fork: done\n" in free and "socket: done\n" in free, "without confinement an intruder may do it all", free)
    os.remove("../elsewhere/new")
    os.remove("../elsewhere/link")
    for options in [[], ["--untrusted"]]:
        name = "planted calls" + " ".join(["", *options])
        said = rtlang("-q", *options, "-o", "out/x.png", "good.scn", **planted).stderr.decode().splitlines()
        wanted = OFTEN * has_landlock + ["symlink: EPERM", *ALWAYS, "fork: EPERM", "copy: EPERM",
                                                                          "execute: EPERM"] * has_seccomp
        tap.ok(all(line in said for line in wanted), "%s are stopped" % name, "%s\n%s" % (wanted, said))
        tap.equal(sorted(os.listdir("../elsewhere")), ["secret"], "%s leave nothing elsewhere" % name)
        if has_seccomp:
            tap.equal([line for line in said if line.startswith("code")], ["code: EPERM" if options else "code: done"],
                      "%s: memory that can be run" % name)
    test_serving_intruder(planted, has_landlock, has_seccomp)
    test_intruder_in_reader(planted, has_landlock, has_seccomp)


def test_intruder_in_reader(planted, has_landlock, has_seccomp):
    """What a file makes of libjpeg stays in the process that reads it, may do less still, and is a message."""
    write("jpeg.scn", GOOD.replace(b"png \"map.png\"", b"jpeg \"whole.jpg\""))
    if rtlang("-q", "-W16", "-H12", "-o", "whole.jpg", "map.scn").returncode != 0:
        tap.skip("a reader that is taken over", "JPEG cannot be written")
        return
    write("old.png", b"old")
    done = rtlang("-q", "-o", "old.png", "jpeg.scn", INTRUDER_READER="1", **planted)
    said = done.stderr.decode().splitlines()
    wanted = ["read: EACCES"] * has_landlock + ["write: EPERM", "make: EPERM", "symlink: EPERM", *ALWAYS, "code: EPERM",
                                                "fork: EPERM", "copy: EPERM", "execute: EPERM"] * has_seccomp
    tap.ok(all(line in said for line in wanted), "planted calls in the process that reads pictures are stopped",
           "%s\n%s" % (wanted, said))
    located = [line for line in said if line.startswith("jpeg.scn:4:")]
    tap.equal((done.returncode, located, read("old.png"), sorted(os.listdir("../elsewhere"))),
              (3, ["jpeg.scn:4:42: error[E0511]: `whole.jpg` cannot be read as a jpeg file: the process that read it was "
                   "ended by signal 4"], b"old", ["secret"]), "and its fall is a message about the picture")


def test_formats():
    """Pictures read by libraries are the same pixels from a process of their own."""
    for word, ending in ("jpeg", "jpg"), ("tiff", "tif"), ("exr", "exr"), ("hdr", "hdr"), ("tga", "tga"), ("ppm", "ppm"):
        picture = "same." + ending
        if rtlang("-q", "-W16", "-H12", "-o", picture, "map.scn").returncode != 0:
            tap.skip("pictures in " + word, "it cannot be written")
            continue
        write("same.scn", GOOD.replace(b"png \"map.png\"", ("%s \"%s\"" % (word, picture)).encode()))
        write("cut.scn", read("same.scn").replace(b"same.", b"cut."))
        write("cut." + ending, read(picture)[:len(read(picture)) // 2])
        for scene in "same.scn", "cut.scn":
            outcomes = []
            for options in [], ["--no-confinement"]:
                write("old.png", b"old")
                done = rtlang("-q", "-W32", "-H24", *options, "-o", "old.png", scene)
                outcomes.append((done.returncode, done.stderr, read("old.png")))
            tap.equal(outcomes[0], outcomes[1], "%s is the same with and without: %s" % (picture, scene))


def reads_ppm():
    """Whether pictures in PPM can be read, which takes OpenImageIO."""
    write("map.ppm", b"P6 1 1 255\n\xff\xff\xff")
    can_read = b"E0507" not in rtlang("--check", "ppm.scn").stderr
    os.remove("map.ppm")
    return can_read


def test_slow_reader():
    """Of a file that takes its reader long nobody waits for the end."""
    if not reads_ppm():
        tap.skip("a reader that takes long", "built without OpenImageIO")
        return
    write("huge.scn", GOOD.replace(b"png \"map.png\"", b"ppm \"huge.ppm\""))
    with open("huge.ppm", "wb") as file:
        file.write(b"P3 9000 9000 255\n")
        for _ in range(9000):
            file.write(b"200 100 50 " * 9000)
    done = rtlang("-q", "--max-time=0.5", "-o", "old.png", "huge.scn")
    tap.equal((done.returncode, done.stderr), (4, LATE % b"nothing was written"), "--max-time ends the reading of a picture")
    os.remove("huge.ppm")


def test_serving_intruder(planted, has_landlock, has_seccomp):
    """A program that answers connections makes none, and starts nothing."""
    done = rtlang("--watch", "--max-time=1", "good.scn", **planted)
    if b"E0514" in done.stderr:
        tap.skip("planted calls in a program that serves", "built without libmicrohttpd")
        return
    said = done.stderr.decode().splitlines()
    wanted = OFTEN * has_landlock + ["symlink: EPERM", *ALWAYS, "fork: EPERM", "execute: EPERM"] * has_seccomp
    tap.ok(done.returncode == 0 and all(line in said for line in wanted), "planted calls in a program that serves are stopped",
           "%s\n%s" % (wanted, said))
    tap.equal(sorted(os.listdir("../elsewhere")), ["secret"], "and leave nothing elsewhere")


def swapped_runs(name, own, secret, scene, count):
    """Runs of a scene while a file of it is now the scene's own, now a link out of its folder."""
    write("../elsewhere/" + name, secret)
    write("swapped.scn", scene)
    os.symlink("../elsewhere/" + name, "leading_out")
    write("own", own)
    stop = threading.Event()

    def swap():
        while not stop.is_set():
            for source in "leading_out", "own":
                os.link(source, "next", follow_symlinks=False)
                os.replace("next", name)

    os.link("own", name)
    swapper = threading.Thread(target=swap)
    swapper.start()
    runs = [rtlang("-q", "--no-confinement", "-W4", "-H3", "-o", "-.ppm", "swapped.scn") for _ in range(count)]
    stop.set()
    swapper.join()
    for path in "own", "leading_out", "../elsewhere/" + name:
        os.remove(path)
    return runs


def test_swapped():
    """The program by itself never reads what a link leads to that comes after it was judged."""
    runs = swapped_runs("swapped.inc", b"#declare A = 1;\n", b"#error \"the secret was read\"\n",
                        b"#for (I, 1, 40)\n#include \"swapped.inc\"\n#end\nsphere { 0, 1 }\n", 150)
    read_runs = [done for done in runs if b"secret" in done.stderr]
    tap.ok(not read_runs, "a link that is swapped while it is read does not lead out",
           "%d of %d runs read it" % (len(read_runs), len(runs)))
    refused = sum(b"error[E0508]" in done.stderr for done in runs)
    tap.ok(0 < refused, "which was tried: %d of %d runs met the link, %d met none" %
           (refused, len(runs), sum(done.returncode == 0 for done in runs)))
    white, black = b"P6 1 1 255\n\xff\xff\xff", b"P6 1 1 255\n\0\0\0"
    if not reads_ppm():
        tap.skip("a picture that is swapped", "built without OpenImageIO")
        return
    runs = swapped_runs("map.ppm", black, white, read("ppm.scn"), 40)
    drawn = [done.stdout for done in runs if done.returncode == 0]
    tap.ok(drawn and b"\xff" not in b"".join(out[-36:] for out in drawn), "nor does a picture's",
           "%d of %d runs drew it" % (sum(b"\xff" in out[-36:] for out in drawn), len(runs)))


def test_several():
    """The first run's rules are those of all scenes and frames."""
    for folder in "one", "two":
        os.mkdir(folder)
        write(folder + "/own.inc", b"#declare F = finish { phong 0.5 }\n")
        write(folder + "/own.png", read("map.png"))
        write(folder + "/%s.scn" % folder, GOOD.replace(b"part.inc", b"own.inc").replace(b"map.png", b"own.png"))
    write("one/wrong.scn", b"sphere { 0, Radius }\n")
    scenes = ["one/wrong.scn", "one/one.scn", "two/two.scn"]
    names = ["one.png", "two.png"]
    frames = ["out/f%d.png" % i for i in range(1, 4)]
    outcomes = []
    for options in [], ["--no-confinement"]:
        done = rtlang("-q", *options, "-I", "one", "-I", "two", *scenes)
        moved = rtlang("-q", *options, "-I", "two", "--frames=1..3", "-o", "out/f.png", "two/two.scn")
        outcomes.append((done.returncode, done.stderr, moved.returncode, moved.stderr,
                         [os.path.exists(name) and read(name) for name in names + frames]))
        for name in names + frames:
            if os.path.exists(name):
                os.remove(name)
    tap.equal(outcomes[0], outcomes[1], "the same with and without: scenes in several folders, and frames")
    tap.ok(outcomes[0][0] == 1 and b"wrong.scn:1:13: error" in outcomes[0][1] and outcomes[0][2:4] == (0, b"") and
           all(outcomes[0][4]),
           "scenes in several folders, after one that is wrong, and frames are drawn", outcomes)
    # Each scene's session asks povray.ini where include files are.
    os.mkdir("../library")
    write("../library/own_library.inc", b"sphere { 0, 1 }\n")
    write("../own.ini", b"Library_Path=" + os.path.abspath("../library").encode() + b"\n")
    write("library.scn", b"camera { location -5*z }\nlight_source { 9, 1 }\n#include \"own_library.inc\"\n")
    done = rtlang("-q", "--check", "library.scn", "library.scn", POVINI=os.path.abspath("../own.ini"))
    tap.equal((done.returncode, done.stderr), (0, b""), "further scenes find the folders of povray.ini, too")
    write("one/thief.scn", b'#include "../two/own.inc"\n')
    done = rtlang("-q", "--check", "two/two.scn", "one/thief.scn")
    tap.ok(done.returncode == 3 and b"one/thief.scn:1:10: error[E0508]" in done.stderr,
           "the folder of another scene is not read", done)


def test_several_intruders(has_landlock, has_seccomp):
    """Whatever the first scene comes to, the kernel holds to the rules."""
    planted = {"LD_PRELOAD": os.path.abspath("intruder.so"), "INTRUDER_OUT": os.path.abspath("../elsewhere")}
    wanted = OFTEN * has_landlock + ["fork: EPERM"] * has_seccomp
    if os.path.exists("intruder.so"):
        said = rtlang("-q", "one/wrong.scn", "two/two.scn", **planted).stderr.decode().splitlines()
        tap.ok(all(line in said for line in wanted), "planted calls after several scenes are stopped",
               "%s\n%s" % (wanted, said))


def test_runs():
    """What a run needs, with and without."""
    runs = {
        "threads": ["-q", "-t4", "-W300", "-H200", "-o", "out/p.png", "good.scn"],
        "the current folder": ["-q", "-o", "p.png", "good.scn"],
        "an old picture": ["-q", "-o", "old.png", "good.scn"],
        "a link to a picture": ["-q", "-o", "link.png", "good.scn"],
        "a link to nothing": ["-q", "-o", "dangling.png", "good.scn"],
        "another folder's scene": ["-q", "-o", "p.png", "-I", "inc", "scenes/far.scn"],
        "standard output": ["-q", "-o", "-", "good.scn"],
        "a device": ["-q", "-o", "/dev/null", "good.scn"],
        "samples and an error map": ["-q", "--samples=4", "--error-map=out/map.png", "-o", "out/p.png", "good.scn"],
        "a module for TIFF": ["-q", "-o", "out/p.tif", "good.scn"],
        "a standard include": ["--check", "standard.scn"],
        "--format into a file": ["--format", "-o", "out/formatted.scn", "good.scn"],
    }
    os.symlink("old.png", "link.png")
    os.symlink("out/made.png", "dangling.png")
    for name, arguments in runs.items():
        outcomes = []
        for options in [], ["--no-confinement"]:
            write("old.png", b"old")
            done = rtlang(*options, *arguments)
            target = arguments[arguments.index("-o") + 1] if "-o" in arguments else "-"
            written = read(target) if os.path.isfile(target) else b""
            outcomes.append((done.returncode, done.stdout, done.stderr, written))
        tap.equal(outcomes[0], outcomes[1], "the same with and without: " + name)


def test_untrusted():
    def refused(name, code, message, *arguments):
        done = rtlang("-q", *arguments)
        tap.ok(done.returncode == code and message in done.stderr.decode(), "--untrusted: " + name, done)

    tap.equal(rtlang("-q", "--untrusted", "-o", "p.png", "good.scn").returncode, 0, "--untrusted: a scene is drawn")
    refused("no other format", 2, "`--untrusted` writes pictures in PNG only", "--untrusted", "-o", "p.jpg", "good.scn")
    refused("no other folders", 2, "`--untrusted` reads the scene's folder only: leave out `--include-path` and "
            "`--allow-read`", "--untrusted", "-I", "inc", "good.scn")
    write("jpeg.scn", GOOD.replace(b"png \"map.png\"", b"jpeg \"map.jpg\""))
    write("map.jpg", b"\xff\xd8\xff\xe0")
    refused("no picture of another format", 3, "jpeg.scn:4:42: error[E0513]: `--untrusted` reads pictures in PNG only",
            "--untrusted", "-o", "p.png", "jpeg.scn")
    refused("no include files of the installation", 3, "error[E0501]", "--untrusted", "--check", "standard.scn")
    write("forever.scn", b"#while (1) #declare I = 1; #end\n")
    refused("few steps", 4, "forever.scn:1:1: error[E0605]: more than 3000000 loop turns", "--untrusted", "--check",
            "forever.scn")


def test_time():
    write("slow.scn", b"#while (1) #declare I = sin(I0); #end\n".replace(b"I0", b"1"))
    write("trace.scn", GOOD.replace(b"1 }\nsphere", b"1 area_light 9*x, 9*y, 500, 500 }\nsphere"))
    for name, arguments in {"evaluation": ["--check", "--max-steps=1000000000000", "slow.scn"],
                            "tracing": ["-W2000", "-H2000", "-o", "old.png", "trace.scn"],
                            "sampling": ["-W200", "-H200", "--samples=100000", "-o", "old.png", "good.scn"]}.items():
        write("old.png", b"old")
        done = rtlang("-q", "--max-time=0.5", *arguments)
        tap.equal((done.returncode, done.stderr, read("old.png")),
                  (4, LATE % b"nothing was written", b"old"), "--max-time ends " + name)
    done = rtlang("-q", "--max-time=1", "-W9", "-H7", "--max-steps=1000000000000", "good.scn", "slow.scn", "good.scn")
    tap.equal((done.returncode, done.stderr, os.path.exists("good.png"), os.path.exists("slow.png")),
              (4, LATE.replace(b"0.5", b"1") % b"not all pictures were written", True, False),
              "--max-time ends several scenes, and says once that they are not all drawn")
    os.remove("good.png")
    done = rtlang("-q", "--max-time=0.5", "-W100", "-H100", "--frames=1..100000", "-o", "out/late.png", "good.scn")
    tap.equal((done.returncode, done.stderr), (4, LATE % b"not all pictures were written"), "--max-time ends frames")


def main():
    with tempfile.TemporaryDirectory() as folder:
        for name in "elsewhere", "work", "work/out", "work/inc", "work/scenes":
            os.mkdir(os.path.join(folder, name))
        os.chdir(os.path.join(folder, "work"))
        write("../elsewhere/secret", b"secret")
        write("part.inc", b"#declare F = finish { phong 0.5 }\n")
        write("inc/part.inc", b"#declare F = finish { phong 0.5 }\n")
        write("good.scn", GOOD)
        write("scenes/far.scn", GOOD.replace(b"image_map { png \"map.png\" }", b"rgb 1"))
        write("standard.scn", b'#include "colors.inc"\nsphere { 0, 1 pigment { Red } }\n')
        write("map.scn", b"camera { location -5*z look_at 0 }\nsphere { 0, 1 }\n")
        subprocess.run([RTLANG, "-q", "-W9", "-H7", "-o", "map.png", "map.scn"], stderr=subprocess.PIPE, check=True)
        write("ppm.scn", b"camera { location -5*z look_at 0 }\nplane { z, 0 pigment { image_map { ppm \"map.ppm\" } } "
              b"finish { ambient 1 diffuse 0 } }\n")
        line = rtlang("--version").stdout.decode().splitlines()[1]
        tap.ok(line.startswith("confinement: "), "--version says what there is: " + line)
        if "none" not in line:
            test_intruder("no Landlock" not in line, "no seccomp" not in line)
        test_swapped()
        test_several()
        if "none" not in line:
            test_several_intruders("no Landlock" not in line, "no seccomp" not in line)
        test_runs()
        test_formats()
        test_slow_reader()
        test_untrusted()
        test_time()
        os.chdir("/")
    tap.done()


main()
