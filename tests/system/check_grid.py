#!/usr/bin/env python3
"""Every block with every word of the language and every form of value: a message or nothing, never a signal.

The words and blocks are the schema's own. Each is tried by itself, in an `object` or a group around it, and declared, and
is evaluated, validated and dumped.
Wants RUN_LANG, PRINT_SCHEMA. Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import re
import subprocess
import sys
import tempfile

from tap import Tap

VALUES = ["", "on", "1", "<1, 2, 3>", "x, y", "x, y, 2, 2", "rgb 1", "3, 5", "{ }", "{ rgb 1 }", "{ sphere { 0, 1 } }",
          "{ pigment { rgb x } }", "{ scale 2 no_shadow }", "{ [0 rgb 0] [1 rgb 1] }", "{ ior 1.5 }", "{ 0, 1 }", '"name"', "1e300"]
# How a block begins that does not begin with a word of its own.
BEGINNINGS = {
    "light_source": ["0, rgb 1", "0, rgb 1 looks_like { sphere { 0, 1 } }"], "sphere": ["0, 1"], "plane": ["y, -1"],
    "box": ["-1, 1"], "cylinder": ["0, y, 1"], "cone": ["0, 1, y, 0"], "disc": ["0, y, 1"], "triangle": ["0, x, y"],
    "smooth_triangle": ["0, -z, x, -z, y, -z"], "union": ["sphere { 0, 1 } box { -1, 1 }"],
    "merge": ["sphere { 0, 1 } box { -1, 1 }"], "intersection": ["sphere { 0, 1 } box { -1, 1 }"],
    "difference": ["sphere { 0, 1 } box { -1, 1 }"],
    "object": ["sphere { 0, 1 }", "light_source { 0, rgb 1 }", "light_source { 0, rgb 1 looks_like { sphere { 0, 1 } } }",
               "union { light_source { 0, rgb 1 } sphere { 0, 1 } }", "object { light_source { 0, rgb 1 } }"],
}
# Where a block stands that is no statement.
PLACES = {"texture": "sphere { 0, 1 %s }", "interior": "sphere { 0, 1 %s }", "material": "sphere { 0, 1 %s }",
          "clipped_by": "sphere { 0, 1 %s }", "bounded_by": "sphere { 0, 1 %s }", "transform": "sphere { 0, 1 %s }",
          "pigment": "sphere { 0, 1 %s }", "normal": "sphere { 0, 1 %s }", "finish": "sphere { 0, 1 %s }",
          "looks_like": "light_source { 0, rgb 1 %s }", "reflection": "sphere { 0, 1 finish { %s } }",
          "normal_map": "sphere { 0, 1 normal { gradient x %s } }", "slope_map": "sphere { 0, 1 normal { gradient x %s } }",
          "texture_map": "sphere { 0, 1 texture { gradient x %s } }",
          "image_map": "sphere { 0, 1 pigment { %s } }"}
MAPS = ("color_map", "pigment_map")
LIGHTS = "object { %s }", "union { %s sphere { 0, 1 } }", "#declare Kept = %s object { Kept }", "intersection { %s box { -2, 2 } }"


def schema():
    """The blocks, and all words."""
    text = subprocess.run([os.environ["PRINT_SCHEMA"]], stdout=subprocess.PIPE, text=True, check=True).stdout
    return re.findall(r"^### ([a-z_]+)$", text, re.M), sorted(set(re.findall(r"^\| `([a-z_]+)` \|", text, re.M)))


def blocks(kind, words):
    """Texts of a block of that kind, one for each of its words and values."""
    for beginning in BEGINNINGS.get(kind, [""]):
        for word in words:
            for value in VALUES:
                yield f"{kind} {{ {beginning} {word} {value} }}"


def scenes(kind, words):
    """Scenes that hold them, in every place that one can stand."""
    for block in blocks(kind, words):
        if kind in MAPS:
            yield "sphere { 0, 1 pigment { gradient x %s } }" % block
        elif kind in PLACES:
            yield PLACES[kind] % block
        else:
            yield block
            if kind in BEGINNINGS:
                for place in LIGHTS:
                    yield place % block


def run(statements):
    """A negative exit code is a signal's. What the cases say is not looked at."""
    with tempfile.NamedTemporaryFile("w", suffix=".test") as file:
        file.writelines(f"== {i}\n{text}\n-- validate\n-- scene\n-- faults\n" for i, text in enumerate(statements))
        file.flush()
        return subprocess.run([os.environ["RUN_LANG"], file.name], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              timeout=600, check=False).returncode


def culprit(statements):
    """The one that ends the program in a signal, or as few as do so together."""
    while len(statements) > 1:
        half = len(statements) // 2
        parts = [part for part in (statements[:half], statements[half:]) if run(part) < 0]
        if not parts:
            break
        statements = parts[0]
    return "\n".join(statements[:20])


def main():
    tap = Tap()
    kinds, words = schema()
    tap.ok(set(BEGINNINGS) | set(PLACES) <= set(kinds), "the blocks named here are the language's")
    for kind in kinds:
        statements = list(scenes(kind, words))
        code = run(statements)
        tap.ok(code >= 0, f"{kind}: {len(statements)} scenes", code < 0 and f"signal {-code}\n{culprit(statements)}")
    tap.done()


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    main()
