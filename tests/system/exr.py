# An OpenEXR file of one part in lines, read from its bytes: what it says of itself, and its channels.
#
# After "OpenEXR File Layout" and the description of ZIP compression there. Knows the compression that rtlang's files have.
#
# SPDX-License-Identifier: MIT
import struct
import zlib

KINDS = {0: "I", 2: "f"}  # of 4 bytes each


def read_name(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_attributes(data):
    """({name: (type, bytes)}, where the table of blocks begins)."""
    if struct.unpack_from("<II", data) != (20000630, 2):
        raise ValueError("not a plain OpenEXR file in lines")
    at, found = 8, {}
    while data[at]:
        name, at = read_name(data, at)
        kind, at = read_name(data, at)
        size, = struct.unpack_from("<I", data, at)
        found[name] = kind, data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def unzipped(packed, size):
    """Each byte is kept as its distance from the one before, even bytes before odd ones."""
    if len(packed) == size:
        return packed
    steps = bytearray(zlib.decompress(packed))
    for i in range(1, len(steps)):
        steps[i] = (steps[i - 1] + steps[i] - 128) & 255
    half, plain = (len(steps) + 1) // 2, bytearray(len(steps))
    plain[0::2], plain[1::2] = steps[:half], steps[half:]
    return bytes(plain)


def read_exr(name):
    """({attribute of text: its text}, {channel: its values, floats or whole numbers, from the top row})."""
    with open(name, "rb") as file:
        data = file.read()
    attributes, table = read_attributes(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"][1])
    listed, at, names = attributes["channels"][1], 0, []
    while listed[at]:
        channel, at = read_name(listed, at)
        kind, = struct.unpack_from("<I", listed, at)
        if kind not in KINDS:
            raise ValueError(f"{channel} is neither of floats nor of whole numbers")
        names.append((channel, KINDS[kind]))
        at += 16
    width, lines = right - left + 1, {0: 1, 3: 16}[attributes["compression"][1][0]]
    channels = {channel: [] for channel, _ in names}
    for i in range((bottom - top) // lines + 1):
        start, = struct.unpack_from("<Q", data, table + 8 * i)
        y, size = struct.unpack_from("<iI", data, start)
        count = min(lines, bottom + 1 - y)
        block = unzipped(data[start + 8:start + 8 + size], 4 * width * len(names) * count)
        for line in range(count):
            for number, (channel, kind) in enumerate(names):
                at = 4 * width * (line * len(names) + number)
                channels[channel] += struct.unpack_from(f"<{width}{kind}", block, at)
    texts = {key: value.decode() for key, (kind, value) in attributes.items() if kind == "string"}
    return texts, channels
