#!/usr/bin/env python3
# The image files of a scene when they are not as they should be: missing, cut off, of another type, huge by their header,
# beyond the folders that may be read, changed at random. Each gives a message with its place and the right exit code,
# prints nothing of any library's and takes no memory that it may not take. What nothing seen uses is not even opened, and
# what many things use is read once. Prints TAP.
#
# Wants RTLANG (the program), top_srcdir. IMAGE_FUZZ: how many changed files of each type are tried.
#
# SPDX-License-Identifier: MIT
import base64
import os
import random
import resource
import struct
import subprocess
import sys
import tempfile
import zlib

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.environ.get("top_srcdir", "."), "tests", "povray"))
import images
from tap import Tap

RTLANG = os.path.abspath(os.environ["RTLANG"])
FUZZ = int(os.environ.get("IMAGE_FUZZ", "12"))
HEAD = "camera { location -3*z } light_source { <-3, 4, -5>, 1 }\n"
MEGA = 1 << 20
OPENIMAGEIO_IS_MISSING = "built without OpenImageIO"
tap = Tap()


def rtlang(scene, *options, env=None):
    """(exit code, standard error, greatest memory in bytes) of a run over the scene's text."""
    with open("scene.scn", "w") as out:
        out.write(HEAD + scene)
    read, write = os.pipe()
    child = subprocess.Popen([RTLANG, "-q", "-W", "16", "-H", "12", "-t", "1", "-o", "out.png", *options, "scene.scn"],
                             stdin=subprocess.DEVNULL, stderr=write, env={**os.environ, **(env or {})})
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        said = pipe.read().decode("utf-8", "replace")
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return child.returncode, said, usage.ru_maxrss * 1024


def seen(pigment):
    return "sphere { 0, 1 pigment { image_map { %s } } }" % pigment


def expect(name, scene, code, words, *options):
    """One fault: its exit code, its code, its words, and that nothing else is said."""
    status, said, _ = rtlang(scene, *options)
    if "E0507" in said and "E0507" not in words:
        tap.skip(name, OPENIMAGEIO_IS_MISSING)
        return
    lines = said.splitlines()
    located = bool(lines) and lines[0].startswith("scene.scn:2:")
    ours = all(line.startswith(("scene.scn:", " ")) for line in lines)
    tap.ok(status == code and located and ours and all(word in said for word in words), name, "%s\n%s" % (status, said))


def head_of_png(width, height):
    return b"\x89PNG\r\n\x1a\n" + images.chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) + \
        images.chunk(b"IDAT", zlib.compress(bytes(1000)))


def write(path, data):
    with open(path, "wb") as out:
        out.write(data)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def have(name):
    return os.path.exists(name)


def test_faults():
    write("cut.png", read("noise.png")[:150])
    write("text.png", b"no picture\n")
    write("empty.png", b"")
    os.mkdir("folder.png")
    os.mkfifo("pipe.png")
    os.symlink("/etc/passwd", "link.png")
    write("bits.pgm", b"P4\n8 1\n\0")
    for name, what, code, words in [
            ("missing", 'png "nowhere.png"', 3, ["E0501", "`nowhere.png` not found"]),
            ("cut off", 'png "cut.png"', 3, ["E0511", "`cut.png` cannot be read as a png file"]),
            ("no picture", 'png "text.png"', 3, ["E0511"]),
            ("empty", 'png "empty.png"', 3, ["E0511"]),
            ("a folder", 'png "folder.png"', 3, ["E0502"]),
            ("a pipe", 'png "pipe.png"', 3, ["E0502", "not a regular file"]),
            ("outside", 'png "/etc/passwd"', 3, ["E0508"]),
            ("a link to the outside", 'png "link.png"', 3, ["E0508"]),
            ("PNG as JPEG", 'jpeg "noise.png"', 3, ["E0511", "as files of type jpeg do"]),
            ("PPM as PGM", 'pgm "plain.ppm"', 3, ["E0511"]),
            ("Targa as PNG", 'png "plain.tga"', 3, ["E0511"]),
            ("a bitmap as PGM", 'pgm "bits.pgm"', 3, ["E0511"]),
            ("PNG as Targa", 'tga "noise.png"', 3, ["E0511"]),
            ("no palette", 'png "noise.png" filter 0, 1', 1, ["E0512", "has no palette", "`all`"]),
            ("beyond the palette", 'png "palette.png" once transmit 9, 1', 1, ["E0512", "places from 0 to 8, not 9"])]:
        expect(name, seen(what), code, words)
    images.png("key1.png", (3, 2), 0, 4, ((b"tRNS", b"\0\3"),))
    expect("a transparent grey", seen('png "key1.png"'), 3, ["E0511", "transparent grey"])


def test_cut_others():
    for name, kind in [("photo.jpg", "jpeg"), ("photo.tif", "tiff"), ("photo.exr", "exr"), ("photo.hdr", "hdr"),
                       ("plain.tga", "tga"), ("plain.ppm", "ppm"), ("plain.pgm", "pgm")]:
        if not have(name):
            tap.skip("cut off: " + name, OPENIMAGEIO_IS_MISSING)
            continue
        whole = read(name)
        for part in (0.02, 0.5):
            write("cut." + kind, whole[:max(3, int(part * len(whole)))])
            status, said, _ = rtlang(seen('%s "cut.%s"' % (kind, kind)))
            fine = status == 3 and "scene.scn:2:" in said.splitlines()[0]
            ours = all(line.startswith(("scene.scn:", " ")) for line in said.splitlines())
            tap.ok(fine and ours or "E0507" in said, "cut off at %g: %s" % (part, name), "%s\n%s" % (status, said))


# 8 x 8 pixels of four inks, made by libjpeg.
INKS_JPEG = (
    "/9j/7gAOQWRvYmUAZAAAAAAA/9sAQwAIBgYHBgUIBwcHCQkICgwUDQwLCwwZEhMPFB0aHx4dGhwcICQuJyAiLCMcHCg3KSwwMTQ0"
    "NB8nOT04MjwuMzQy/8AAFAgACAAIBEMRAE0RAFkRAEsRAP/EABQAAQAAAAAAAAAAAAAAAAAAAAD/xAAUEAEAAAAAAAAAAAAAAAAA"
    "AAAA/9oADgRDAE0AWQBLAAA/AAD/2Q==")


def test_jpeg():
    """Like POV-Ray: four inks are refused, damage within the picture is filled in; neither in silence."""
    write("inks.jpg", base64.b64decode(INKS_JPEG))
    expect("inks", seen('jpeg "inks.jpg"'), 3, ["E0511", "it holds four inks (CMYK); save it as red, green and blue"])
    if not have("photo.jpg"):
        tap.skip("a damaged JPEG", OPENIMAGEIO_IS_MISSING)
        return
    whole = read("photo.jpg")
    middle = len(whole) * 2 // 3
    write("damaged.jpg", whole[:middle] + b"\xff\xd0" + whole[middle:])
    expect("a damaged JPEG", seen('jpeg "damaged.jpg"'), 0, ["W0502", "`damaged.jpg` is damaged: parts of it are filled in"])
    _, said, _ = rtlang(seen('jpeg "photo.jpg"'), env={"LD_DEBUG": "files"})
    tap.ok("calling init" in said and "rtlang_oiio" not in said, "JPEG is read without OpenImageIO", said[-2000:])


def test_cubes():
    """Cubes of values: what their length says must be what their sizes say."""
    cube = read("cube8.df3")
    pigment = 'sphere { 0, 1 pigment { density_file df3 "%s" } }'
    write("head.df3", cube[:5])
    write("short.df3", cube[:-1])
    write("long.df3", cube + cube[6:] + cube[6:])
    write("none.df3", b"\0\0" + cube[2:])
    write("deep.df3", b"\xff" * 6 + cube[6:])
    with open("sparse.df3", "wb") as out:
        out.write(struct.pack(">3H", 1000, 1000, 1000))
        out.truncate(6 + 10**9)
    for name, code, words in [
            ("head.df3", 3, ["E0511", "`head.df3` cannot be read as a df3 file: the file ends too soon"]),
            ("short.df3", 3, ["E0511", "it has 467 bytes, and not 6 and then 1, 2 or 4 for each of 7 x 11 x 6 values"]),
            ("long.df3", 3, ["E0511", "for each of 7 x 11 x 6 values"]),
            ("none.df3", 3, ["E0511", "for each of 0 x 11 x 6 values"]),
            ("deep.df3", 3, ["E0511", "for each of 65535 x 65535 x 65535 values"]),
            ("noise.png", 3, ["E0511", "as files of type df3 do"]),
            ("nowhere.df3", 3, ["E0501", "`nowhere.df3` not found"]),
            ("sparse.df3", 4, ["E0608", "--max-memory"])]:
        expect("a cube of values, " + name, pigment % name, code, words, "--max-memory=300M")
    expect("cubes are no pictures", pigment % "cube8.df3", 3, ["E0513"], "--untrusted")


def test_huge():
    write("huge.png", head_of_png(100000, 100000))
    write("wide.png", head_of_png(100000000, 2)) # rows, of which libpng keeps two
    write("huge.ppm", b"P6\n100000 100000\n255\n" + bytes(100))
    write("huge.tga", struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 65535, 65535, 32, 8) + bytes(100))
    for name, kind in (("huge.png", "png"), ("wide.png", "png"), ("huge.ppm", "ppm"), ("huge.tga", "tga")):
        status, said, memory = rtlang(seen('%s "%s"' % (kind, name)), "--max-memory=300M")
        if "E0507" in said:
            tap.skip("huge by its header: " + name, OPENIMAGEIO_IS_MISSING)
            continue
        right = status == 4 and "E0608" in said and "scene.scn:2:" in said and "--max-memory" in said
        tap.ok(right and memory < 300 * MEGA, "huge by its header: " + name, "%s %s\n%s" % (status, memory, said))
    # One that fits the machine but not the limit, and with the rest of the scene not either.
    images.png("large.png", (512, 512), 2, 8)
    status, said, _ = rtlang(seen('png "large.png"'), "--max-memory=700K")
    tap.ok(status == 4 and "E0608" in said, "larger than the limit", "%s\n%s" % (status, said))
    # 786 432 bytes as it is kept; records and tree are some kilobytes, and a picture of 8 x 8 is next to nothing.
    status, said, _ = rtlang(seen('png "large.png"'), "--max-memory=1200K", "-W8", "-H8")
    tap.ok(status == 0, "within the limit, which counts it once", "%s\n%s" % (status, said))


def test_paid_for():
    """Nothing is loaded that is not used, and nothing twice."""
    write("broken.png", b"no picture")
    status, said, _ = rtlang('#declare P = pigment { image_map { png "broken.png" } }\nsphere { 0, 1 }')
    tap.equal((status, said), (0, ""), "a picture that is never seen is not read")
    traced = {"LD_DEBUG": "files"}
    write("broken.jpg", b"\xff\xd8\xff")
    _, said, _ = rtlang('#declare P = pigment { image_map { jpeg "broken.jpg" } }\n' + seen('png "noise.png"'), env=traced)
    tap.ok("calling init" in said and "rtlang_oiio" not in said and "jpeg" not in said,
           "PNG and what is never seen load no module", said[-2000:])
    _, said, _ = rtlang(seen('ppm "plain.png"').replace("plain.png", "noise.png"), env=traced)
    tap.ok("rtlang_oiio" not in said, "nor does a file that begins otherwise than its type does", said[-2000:])
    many = "#for (I, 1, 300) sphere { I*5*z, 1 pigment { image_map { png \"large.png\" filter all I/1000 } scale I } } #end"
    status, said, memory = rtlang(many)
    _, _, base = rtlang("sphere { 0, 1 }")
    tap.ok(status == 0 and memory - base < 24 * MEGA, "300 maps of one picture read it once", "%s %s %s" % (said, memory, base))


def changed(data, chance):
    """A copy with a few bytes changed, cut out or put in."""
    data = bytearray(data)
    for _ in range(chance.randint(1, 6)):
        at = chance.randrange(min(len(data), 400) if chance.random() < 0.6 else len(data))
        kind = chance.randrange(4)
        if kind == 0:
            data[at] = chance.choice((0, 1, 127, 128, 255, chance.randrange(256)))
        elif kind == 1:
            data[at] ^= 1 << chance.randrange(8)
        elif kind == 2 and len(data) > 64:
            del data[at:at + chance.randint(1, 8)]
        else:
            data[at:at] = bytes(chance.randrange(256) for _ in range(chance.randint(1, 4)))
    return bytes(data)


def test_changed():
    kinds = {"png": ["noise.png", "alpha16.png", "palette4.png", "grey2.png"], "jpeg": ["photo.jpg"], "tiff": ["photo.tif"],
             "exr": ["photo.exr"], "hdr": ["photo.hdr"], "tga": ["alpha.tga"], "ppm": ["plain.ppm"]}
    for kind, names in kinds.items():
        chance, wrong = random.Random(kind), []
        for i in range(FUZZ):
            name = names[i % len(names)]
            if not have(name):
                break
            write("changed." + kind, changed(read(name), chance))
            status, said, memory = rtlang(seen('%s "changed.%s" interpolate 2' % (kind, kind)), "--max-memory=64M")
            ours = all(line.startswith(("scene.scn:", " ")) for line in said.splitlines())
            if status not in (0, 1, 3, 4) or not ours:
                wrong.append("%d: %s\n%s" % (i, status, said[-3000:]))
        tap.ok(not wrong, "%d files of type %s, changed at random" % (FUZZ, kind), "\n".join(wrong))


def main():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        images.make(folder, RTLANG)
        test_faults()
        test_cut_others()
        test_cubes()
        test_jpeg()
        test_huge()
        test_paid_for()
        test_changed()
        os.chdir("/")
    tap.done()


main()
