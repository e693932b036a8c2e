# What a test must know of a picture file, read from its bytes without any library of pictures.
#
# SPDX-License-Identifier: MIT
import struct
import zlib


def png_chunks(data):
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("not a PNG: %r" % data[:80])
    at = 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        yield kind, data[at + 8:at + 8 + length]
        at += 12 + length


def png_without_texts(data):
    """A PNG's bytes without what it says of its scene and options."""
    at, kept = 8, data[:8]
    while at < len(data):
        end = at + 12 + int.from_bytes(data[at:at + 4], "big")
        kept += data[at:end] if data[at + 4:at + 8] != b"tEXt" else b""
        at = end
    return kept


def png_header(data):
    """Width, height, bits of a value."""
    return struct.unpack(">IIB", dict(png_chunks(data))[b"IHDR"][:9])


def png_first_pixel(data):
    """Red, green, blue. The first pixel is the same under each of PNG's filters that look left or up."""
    bits = png_header(data)[2]
    values = zlib.decompress(b"".join(body for kind, body in png_chunks(data) if kind == b"IDAT"))
    return struct.unpack_from(">3B" if bits == 8 else ">3H", values, 1)


def exr_channel_types(data):
    """Name -> type of each channel of an OpenEXR file (OpenEXR File Layout, "chlist")."""
    kinds = ["uint", "half", "float"]
    at = data.index(b"channels\0chlist\0") + 20
    channels = {}
    while data[at]:
        end = data.index(b"\0", at)
        channels[data[at:end].decode()] = kinds[struct.unpack_from("<I", data, end + 1)[0]]
        at = end + 17
    return channels
