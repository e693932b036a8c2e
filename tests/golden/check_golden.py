#!/usr/bin/env python3
"""Each example's stages against what is committed here, and against themselves.

The AST's dump must parse to the same dump; the scene's dump must equal NN.scene, evaluate to the same dump again and make the
same picture; a small 16-bit picture must equal NN.png; any number of threads must make the same bytes. With UPDATE_GOLDEN=1
(`make update-golden`) the committed files are written anew. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
HERE = os.path.join(TOP, "tests/golden")
sys.path.insert(0, os.path.join(TOP, "tests/system"))
sys.path.insert(0, os.path.join(TOP, "tests/povray"))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402
from picture_bytes import png_without_texts  # noqa: E402

WIDTH, HEIGHT = 80, 60
UPDATE = os.environ.get("UPDATE_GOLDEN", "") not in ("", "0")
# The C library's sin and pow may round differently elsewhere; more is a change.
CODE_BAR = 1


def dump(stage, scene, folders):
    done = subprocess.run([os.environ["RTLANG"], "-q", f"-W{WIDTH}", f"-H{HEIGHT}", f"--dump={stage}",
                           *(f"-I{folder}" for folder in folders), scene],
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode:
        raise pictures.RunFailed("rtlang", done.returncode, done.stderr.decode("utf-8", "replace"))
    return done.stdout


def write(path, data):
    with open(path, "wb") as out:
        out.write(data)


def read(path):
    try:
        with open(path, "rb") as data:
            return data.read()
    except FileNotFoundError:
        return b""


def first_difference(one, other):
    """What to tell of two texts: "" when they are equal."""
    if one == other:
        return ""
    a, b = one.decode().splitlines(), other.decode().splitlines()
    line = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
    return f"line {line + 1}: {''.join(a[line:line + 1])!r} instead of {''.join(b[line:line + 1])!r}"


def check_ast(scene, folder, folders):
    once = dump("ast", scene, folders)
    again = os.path.join(folder, "ast.scn")
    write(again, once)
    yield "the AST's dump parses to itself", first_difference(dump("ast", again, folders), once)


def check_scene(scene, golden, folder, folders):
    once = dump("scene", scene, folders)
    if UPDATE:
        write(golden, once)
    yield "the scene's dump is the golden one", first_difference(once, read(golden))
    again = os.path.join(folder, "again.scn")
    write(again, once)
    yield "the scene's dump evaluates to itself", first_difference(dump("scene", again, folders), once)


def render(scene, folder, folders, threads):
    picture = os.path.join(folder, "picture.png")
    pictures.render_rtlang(scene, picture, folders, WIDTH, HEIGHT, [f"-t{threads}"])
    return read(picture)


def apart(data, golden, folder, bar=CODE_BAR):
    if not os.path.exists(golden):
        return "there is no golden picture"
    picture = os.path.join(folder, "golden.png")
    write(picture, data)
    one, other = pictures.read_png(picture), pictures.read_png(golden)
    if one[:2] != other[:2]:
        return "the pictures differ in size"
    greatest = max(abs(a - b) for a, b in zip(one[2], other[2]))
    return f"max {greatest}/65535" if greatest > bar else ""


def check_picture(scene, golden, folder, folders):
    single = render(scene, folder, folders, 1)
    if UPDATE:
        write(golden, single)
    yield "the picture is the golden one", apart(single, golden, folder)
    yield "three threads make the same bytes", "" if render(scene, folder, folders, 3) == single else "they differ"
    # check_scene has left the dump here.
    dumped = os.path.join(folder, "again.scn")
    again = png_without_texts(render(dumped, folder, folders, 1))
    yield "the scene's dump makes the same bytes", "" if again == png_without_texts(single) else "they differ"


def check_example(scene, folder):
    """(what is checked, what is wrong or "") of one example."""
    golden = os.path.join(HERE, os.path.basename(scene)[:2])
    folders = pictures.include_folders()
    yield from check_ast(scene, folder, folders)
    yield from check_scene(scene, golden + ".scene", folder, folders)
    yield from check_picture(scene, golden + ".png", folder, folders)


def check_all(scenes, check, name_length=None):
    """A line for each thing that check(scene, folder) gives of each scene, by the beginning of its name; the exit status."""
    number, failed = 0, 0
    for scene in scenes:
        with tempfile.TemporaryDirectory() as folder:
            try:
                results = list(check(scene, folder))
            except pictures.RunFailed as failure:
                results = [("rtlang accepts it", f"{failure}: {failure.text.splitlines()[:1]}")]
        for what, fault in results:
            number += 1
            failed += bool(fault)
            name = f"{os.path.basename(scene)[:name_length]}: {what}"
            print(f"not ok {number} - {name}: {fault}" if fault else f"ok {number} - {name}")
    print(f"1..{number}")
    return 1 if failed or not number else 0


def main():
    return check_all(sorted(glob.glob(os.path.join(TOP, "examples", "[0-9][0-9]_*.scn"))), check_example, 2)


if __name__ == "__main__":
    sys.exit(main())
