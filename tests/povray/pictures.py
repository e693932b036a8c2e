"""Renders one scene file with rtlang and with POV-Ray and compares the pictures. Needs nothing but python3.

Both write 16-bit PNG with a file gamma of 1, without anti-aliasing: stored codes are linear light, or, in a scene that says
nothing of gamma, the scene's own values, which both programs then store as they are.
SPDX-License-Identifier: MIT
"""
import glob
import os
import shutil
import struct
import subprocess
import zlib

POVRAY_AT_ONCE = 8  # runs of POV-Ray, which sleeps for most of a second before and after a small picture
CODE_BAR = 2        # of 65535: rounding of both, and what single precision of colours makes of it
TIE_SHARE = 1e-4    # pixels whose ray meets a silhouette within rounding may fall to either side
WIDTH, HEIGHT = 320, 240


class RunFailed(Exception):
    """A program did not make its picture; holds its exit code and what it said."""

    def __init__(self, program, status, text):
        super().__init__(f"{program} ended with {status}")
        self.status = status
        self.text = text


def unfilter(kind, row, above, step):
    """Undoes one row's PNG filter in place (PNG specification, section 9.2)."""
    for i in range(len(row)):
        left = row[i - step] if i >= step else 0
        up = above[i]
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = up
        elif kind == 3:
            guess = (left + up) // 2
        else:
            corner = above[i - step] if i >= step else 0
            far_left, far_up = abs(up - corner), abs(left - corner)
            far_corner = abs(left + up - 2 * corner)
            guess = left if far_left <= far_up and far_left <= far_corner else up if far_up <= far_corner else corner
        row[i] = (row[i] + guess) & 255


def read_png(path, channels=3, depths=(8, 16)):
    """(width, height, values): those of a PNG without interlacing, from the top row; channels: 1 grey, 3 RGB, 4 RGB and alpha."""
    data = open(path, "rb").read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{path} is no PNG file")
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", data[at + 8:at + 8 + length])
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    if colour != {1: 0, 3: 2, 4: 6}[channels] or interlace or depth not in depths:
        raise ValueError(f"{path}: colour type {colour}, depth {depth}, interlace {interlace}")
    raw = zlib.decompress(packed)
    step = channels * depth // 8
    size = width * step
    above, values = bytearray(size), []
    for y in range(height):
        start = y * (size + 1)
        row = bytearray(raw[start + 1:start + 1 + size])
        if raw[start]:
            unfilter(raw[start], row, above, step)
        values.extend(row if depth == 8 else struct.unpack(f">{channels * width}H", row))
        above = row
    return width, height, values


def povray():
    """The program, or None."""
    return os.environ.get("POVRAY") or shutil.which("povray")


def include_folders():
    """Where POV-Ray's own include files are."""
    places = glob.glob("/usr/share/povray-3.*/include") + glob.glob("/usr/local/share/povray-3.*/include")
    return [place for place in places if os.path.exists(os.path.join(place, "colors.inc"))]


def call(arguments, **how):
    """subprocess.run, once more when POV-Ray gave up before it began, as it does on a machine that is busy."""
    for _ in range(5):
        done = subprocess.run(arguments, stdin=subprocess.DEVNULL, check=False, **how)
        if done.returncode == 0 or b"Timed out waiting for worker thread startup" not in (done.stderr or done.stdout):
            break
    return done


def run(program, arguments, folder=None):
    done = call(arguments, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
    if done.returncode:
        raise RunFailed(program, done.returncode, done.stdout.decode("utf-8", "replace"))


def render_rtlang(scene, picture, folders, width=WIDTH, height=HEIGHT, more=(), folder=None):
    paths = [f"-I{folder}" for folder in folders]
    written = [f"--allow-write={folder}"] if folder else []
    run("rtlang", [os.environ["RTLANG"], "-q", *written, f"-W{width}", f"-H{height}", "--depth=16", "--file-gamma=1",
                   "-o", picture, *more, *paths, scene], folder)


def render_povray(scene, picture, folders, width=WIDTH, height=HEIGHT, folder=None, more=()):
    paths = [f"+L{folder}" for folder in folders]
    run("povray", [povray(), f"+I{scene}", f"+O{picture}", f"+W{width}", f"+H{height}", "+FN16",
                   "File_Gamma=1.0", "-A", "-D", "-P", "+Q9", *more, *paths], folder)


def compare(one, other):
    """(greatest difference of any value, pixels beyond the bar, pixels) of two pictures, in codes."""
    width, height, a = read_png(one)
    if (width, height) != read_png(other)[:2]:
        raise ValueError("the pictures differ in size")
    b = read_png(other)[2]
    greatest, beyond = 0, 0
    for i in range(0, len(a), 3):
        if a[i:i + 3] != b[i:i + 3]:
            apart = max(abs(a[i + k] - b[i + k]) for k in range(3))
            greatest = max(greatest, apart)
            beyond += apart > CODE_BAR
    return greatest, beyond, width * height


def compare_programs(scene, folder, folders, width=WIDTH, height=HEIGHT):
    """Renders the scene with both into `folder` and compares. Raises RunFailed when one of them fails."""
    ours, theirs = os.path.join(folder, "rtlang.png"), os.path.join(folder, "povray.png")
    render_rtlang(scene, ours, folders, width, height)
    render_povray(scene, theirs, folders, width, height)
    return compare(ours, theirs)


def verdict(greatest, beyond, pixels):
    """(whether the bar is met, the words for it)."""
    return beyond <= TIE_SHARE * pixels, f"max {greatest}/65535, {beyond} of {pixels} pixels beyond {CODE_BAR}/65535"
