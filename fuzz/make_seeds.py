#!/usr/bin/env python3
"""Writes what fuzzers begin with: files of each kind, into FOLDER/KIND, from the tests and examples.

Usage: make_seeds.py TOP FOLDER. SPDX-License-Identifier: MIT
"""
import glob
import hashlib
import os
import random
import re
import struct
import sys
import zlib

# Each target, and the kind of its files.
TARGETS = {"grammar": "text", "scene": "text", "dump": "text", "world": "text", "programs": "programs", "tree": "tree",
           "calls": "calls", "picture": "picture", "reader": "reader", "ini": "ini", "partial": "partial"}


def lang_cases(top):
    """The programs of tests/lang."""
    for path in sorted(glob.glob(os.path.join(top, "tests", "lang", "*.test"))):
        with open(path, "rb") as file:
            cases = re.split(rb"^== .*\n", file.read(), flags=re.MULTILINE)[1:]
        for number, case in enumerate(cases):
            yield "%s-%03d" % (os.path.basename(path)[:-5], number), re.split(rb"^-- ", case, flags=re.MULTILINE)[0]


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(bits, kind, interlaced, extra=b""):
    """A PNG of 5 by 3 pixels whose samples count up."""
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind]
    passes = [(0, 0, 1, 1)]
    if interlaced:
        passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
    rows = b""
    for left, top, right, down in passes:
        width, height = -(-(5 - left) // right), -(-(3 - top) // down)
        if width > 0 and height > 0:
            length = (width * channels * bits + 7) // 8
            rows += b"".join(bytes([row % 5]) + bytes((7 * i + row) % 256 for i in range(length))
                             for row in range(height))
    palette = chunk(b"PLTE", bytes(range(3 * 2 ** min(bits, 4)))) if kind == 3 else b""
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 5, 3, bits, kind, 0, 0, interlaced)) + extra +
            palette + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def pictures(top):
    for kind, all_bits in {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}.items():
        for bits in all_bits:
            for interlaced in 0, 1:
                yield "%d-%d-%d.png" % (kind, bits, interlaced), png(bits, kind, interlaced)
    yield "gamma.png", png(8, 2, 0, chunk(b"gAMA", struct.pack(">I", 45455)))
    yield "key.png", png(8, 2, 0, chunk(b"tRNS", bytes(6)))
    for path in sorted(glob.glob(os.path.join(top, "tests", "**", "*.jp*g"), recursive=True)):
        with open(path, "rb") as file:
            yield os.path.basename(path), file.read()
    yield "plain.ppm", b"P6 2 1 255\nabcdef"


def option_files(top):
    yield "long.ini", (b"; a comment\nWidth=320\nHeight=200\n[part]\nStart_Column=0.25\nEnd_Column=0.75\n"
                       b"Antialias=On\nLibrary_Path=\"/usr\"\nDeclare=N=5\nInput_File_Name=x.pov\n")
    yield "short.ini", b"+W320 +H200 -D +A0.3 +FN8 +KFI1 +KFF9 -V +Ix.pov +Oy.png Output_File_Type=N\n"
    yield "words.ini", b"+W32\0+H20\0-GA\0+Ix.pov\0Clock=0.5\0"
    with open(os.path.join(top, "src", "cli", "povray_table.c"), "rb") as file:
        for number, key in enumerate(re.findall(rb"^    [A-Z_]+\(\"(\w+)\"", file.read(), re.MULTILINE)):
            yield "key-%03d.ini" % number, b"%s=On\n%s=1\n%s=0.5\n" % (key, key, key)


def sealed(data):
    """With the check that share/partial.c puts behind it."""
    return hashlib.blake2b(data, digest_size=32).digest()[:8]


def partials():
    fields = [b"1.0", b"scene", b"", b"pictures", b"--width=320", b"scene.scn", b"1/2"]
    head = b"rtlang partial result 1\n" + b"".join(struct.pack("<I", len(field)) + field for field in fields)
    records = b""
    for numbers, body in ((0, 0, 60), bytes(60)), ((0, 1, 5), b"bytes"), ((2, (1 << 30) + 1, 0), b""):
        begin = struct.pack("<III", *numbers)
        records += begin + sealed(begin + body) + body
    yield "part", head + sealed(head) + records
    yield "cut", (head + sealed(head) + records)[:-7]


def chosen(count, longest):
    """Bytes by chance, for what takes them as choices."""
    chance = random.Random(1)
    for number in range(count):
        yield "%03d" % number, chance.randbytes(chance.randrange(50, longest))


def tiff(bits, samples, planar):
    """An uncompressed TIFF of 3 by 2 pixels."""
    data = bytes((37 * i) % 256 for i in range(6 * samples * bits // 8))
    tags = [(256, 3), (257, 2), (258, bits), (259, 1), (262, 1 if samples == 1 else 2), (273, 8), (277, samples),
            (278, 2), (279, len(data)), (284, planar)]
    entries = b"".join(struct.pack("<HHII", tag, 4 if tag in (273, 279) else 3, 1, value) for tag, value in tags)
    return struct.pack("<2sHI", b"II", 42, 8 + len(data)) + data + struct.pack("<H", len(tags)) + entries + bytes(4)


def exr():
    """An uncompressed OpenEXR of 3 by 2 pixels in half floats."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data

    window = struct.pack("<4i", 0, 0, 2, 1)
    channels = b"".join(name + b"\0" + struct.pack("<IIII", 1, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    head = (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute(b"channels", b"chlist", channels) +
            attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", window) +
            attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0") +
            attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) +
            attribute(b"screenWindowCenter", b"v2f", bytes(8)) +
            attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0")
    rows = [struct.pack("<iI", y, 18) + struct.pack("<9e", *range(9)) for y in range(2)]
    first = len(head) + 16
    return head + struct.pack("<QQ", first, first + len(rows[0])) + b"".join(rows)


def readers():
    """A byte that says the format, and a file of it."""
    yield "tga", b"\0" + struct.pack("<BBB5xHHHHBB", 0, 0, 2, 0, 0, 3, 2, 24, 0) + bytes(range(18))
    yield "tga_packed", b"\0" + struct.pack("<BBB5xHHHHBB", 0, 0, 10, 0, 0, 3, 2, 24, 0) + b"\x82abc\x02abcdefghi"
    yield "ppm", b"\1P6 3 2 255\n" + bytes(range(18))
    yield "ppm_text", b"\1P3 2 1 15\n1 2 3 # a comment\n4 5 15\n"
    yield "pgm", b"\2P5 3 2 65535\n" + bytes(range(12))
    for bits, samples, planar in (8, 1, 1), (8, 3, 1), (16, 3, 1), (8, 4, 2):
        yield "tiff_%d_%d_%d" % (bits, samples, planar), b"\3" + tiff(bits, samples, planar)
    yield "exr", b"\4" + exr()
    yield "hdr", b"\5#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 3\n" + bytes(range(100, 124))


def write_seeds(top, folder):
    texts = list(lang_cases(top))
    for path in sorted(glob.glob(os.path.join(top, "examples", "*.scn"))):
        with open(path, "rb") as file:
            texts.append((os.path.basename(path), file.read()))
    for kind, files in {"text": texts, "picture": pictures(top), "ini": option_files(top),
                        "partial": partials(), "calls": chosen(200, 1500), "programs": chosen(100, 600),
                        "tree": chosen(60, 1000), "reader": readers()}.items():
        os.makedirs(os.path.join(folder, kind), exist_ok=True)
        for name, data in files:
            with open(os.path.join(folder, kind, name), "wb") as file:
                file.write(data)


if __name__ == "__main__":
    write_seeds(sys.argv[1], sys.argv[2])
