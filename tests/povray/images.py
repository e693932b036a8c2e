"""The image files that scenes of tests/povray lay over surfaces, made when they are needed.

PNG, PPM, PGM and TGA are written here byte by byte, in every form that matters; JPEG, TIFF, OpenEXR and Radiance by rtlang
itself. The pixels are numbers that look like chance, so that a pixel in a wrong place is seen.
SPDX-License-Identifier: MIT
"""
import os
import struct
import subprocess
import zlib

SCENE = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location -3*z look_at 0 angle 40 } background { rgb <0.1, 0.3, 0.8> } light_source { <-4, 5, -6>, 1 }
#for (I, 0, 8) sphere { <I/4 - 1, mod(I*3, 8)/4 - 1, 0>, 0.4 pigment { rgb <I/8, 1 - I/8, mod(I, 3)/2> } } #end
"""
BY_RTLANG = (("photo.jpg", ()), ("photo.tif", ()), ("photo.exr", ()), ("photo.hdr", ()))


def code(x, y, channel, below):
    """A number below a bound."""
    mixed = (x * 7919 + y * 104729 + channel * 1299709 + 12345) * 2654435761 & 0xffffffff
    return (mixed >> 7) % below


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def pack_row(values, bits):
    """One row of samples of 1 to 16 bits."""
    text = "".join(format(value, f"0{bits}b") for value in values)
    text += "0" * (-len(text) % 8)
    return b"\0" + int(text, 2).to_bytes(len(text) // 8, "big")


def write_rows(path, size, colour, bits, rows, chunks=()):
    """`colour` is PNG's type: 0 grey, 2 rgb, 3 palette, 4 grey and alpha, 6 rgb and alpha."""
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", *size, bits, colour, 0, 0, 0)))
        for kind, data in chunks:
            out.write(chunk(kind, data))
        out.write(chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def png(path, size, colour, bits, chunks=(), channels=None, below=None):
    width, height = size
    channels = channels or {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    rows = b"".join(pack_row([code(x, y, c, below or 1 << bits) for x in range(width) for c in range(channels)], bits)
                    for y in range(height))
    write_rows(path, size, colour, bits, rows, chunks)


def premultiplied(path, size):
    """rgb with alpha where no colour is above alpha; some pixels are wholly transparent."""
    width, height = size
    rows = b""
    for y in range(height):
        row = []
        for x in range(width):
            alpha = 0 if code(x, y, 9, 7) == 0 else 40 + code(x, y, 3, 216)
            row += [code(x, y, c, alpha + 1) for c in range(3)] + [alpha]
        rows += pack_row(row, 8)
    write_rows(path, size, 6, 8, rows)


def earth(path):
    """A smooth map of a planet with land, sea and a grid, 72 by 36."""
    rows = b""
    for y in range(36):
        row = []
        for x in range(72):
            land = code(x // 6, y // 6, 0, 5) < 2
            grid = x % 6 == 0 or y % 6 == 0
            shade = code(x, y, 1, 40)
            row += [200, 200, 210] if grid else [60 + shade, 110 + shade, 40] if land else [10, 40 + shade // 2, 120 + shade]
        rows += pack_row(row, 8)
    write_rows(path, (72, 36), 2, 8, rows)


def samples(size, channels, below=256):
    return [code(x, y, c, below) for y in range(size[1]) for x in range(size[0]) for c in range(channels)]


def write_others(folder):
    size = (11, 7)
    with open(f"{folder}/plain.ppm", "wb") as out:
        out.write(b"P6\n# made for a test\n11 7\n255\n" + bytes(samples(size, 3)))
    with open(f"{folder}/plain.pgm", "wb") as out:
        out.write(b"P5\n11 7\n65535\n" + struct.pack(">77H", *samples(size, 1, 65536)))
    for name, channels in (("plain.tga", 3), ("alpha.tga", 4)):
        with open(f"{folder}/{name}", "wb") as out:
            out.write(struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 11, 7, 8 * channels, 8 if channels == 4 else 0))
            out.write(bytes(samples(size, channels)))


def write_png(folder):
    palette = bytes(samples((9, 1), 3))
    srgb, linear, odd = (b"sRGB", b"\0"), (b"gAMA", struct.pack(">I", 100000)), (b"gAMA", struct.pack(">I", 55556))
    png(f"{folder}/noise.png", (11, 7), 2, 8)
    png(f"{folder}/noise16.png", (11, 7), 2, 16, (linear,))
    png(f"{folder}/noise_srgb.png", (11, 7), 2, 8, (odd, srgb))
    png(f"{folder}/noise_odd.png", (11, 7), 2, 8, (odd,))
    png(f"{folder}/alpha.png", (11, 7), 6, 8)
    png(f"{folder}/alpha16.png", (11, 7), 6, 16, (linear,))
    png(f"{folder}/palette.png", (11, 7), 3, 8, ((b"PLTE", palette),), below=9)
    png(f"{folder}/palette4.png", (11, 7), 3, 4, ((b"PLTE", palette), (b"tRNS", bytes((0, 60, 120, 180, 240)))), below=9)
    png(f"{folder}/key.png", (11, 7), 2, 8, ((b"tRNS", struct.pack(">3H", *samples((1, 1), 3))),))
    for bits in (1, 2, 4, 8, 16):
        png(f"{folder}/grey{bits}.png", (16, 16), 0, bits)
    png(f"{folder}/grey_alpha.png", (11, 7), 4, 8)
    premultiplied(f"{folder}/premultiplied.png", (11, 7))
    earth(f"{folder}/earth.png")


def write_df3(folder):
    """Cubes of values of 8, 16 and 32 bits, of sizes that differ."""
    for bits in 8, 16, 32:
        values = [value << bits - 16 if bits > 16 else value >> 16 - bits for value in samples((7, 11 * 6), 1)]
        with open(f"{folder}/cube{bits}.df3", "wb") as file:
            file.write(struct.pack(">3H", 7, 11, 6) + struct.pack(f">{len(values)}{' BH I'[bits // 8]}", *values))


def make(folder, rtlang):
    """Fills the folder. What rtlang cannot write without OpenImageIO is left out."""
    write_png(folder)
    write_df3(folder)
    write_others(folder)
    for name, options in BY_RTLANG:
        subprocess.run([rtlang, "-", "-o", os.path.join(folder, name), "-W", "32", "-H", "24", "-q", *options],
                       input=SCENE, text=True, stderr=subprocess.DEVNULL, check=False)
