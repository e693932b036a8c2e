#!/usr/bin/env python3
# Text: what the module reads that wraps FreeType, what is no font, and that no other run loads it. Prints TAP.
#
# Wants RTLANG.
#
# SPDX-License-Identifier: MIT
import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from tap import Tap

RTLANG = os.path.abspath(os.environ["RTLANG"])
MODULE = os.path.join(os.path.dirname(RTLANG), ".libs", "rtlang_font.so")
FONTS = ["/usr/share/povray/include/timrom.ttf", "/usr/share/povray-3.7/include/timrom.ttf",
         "/usr/share/fonts/truetype/povray/timrom.ttf"]
tap = Tap()


def run(folder, text, *options, **environment):
    path = os.path.join(folder, "s.scn")
    with open(path, "w", encoding="utf-8") as file:
        file.write("#version 3.7; global_settings { assumed_gamma 1 }\n" + text)
    return subprocess.run([RTLANG, "s.scn", *options], capture_output=True, text=True, timeout=120,
                          cwd=folder, env=os.environ | environment, check=False)


def test_no_font(folder):
    files = {"junk.ttf": b"This is no font.", "empty.ttf": b"", "short.ttf": b"\0\1\0\0\0\5\0\20\0\2\0\0glyf",
             "table.ttf": b"\0\1\0\0\xff\xff" + bytes(range(256)) * 20}
    for name, content in files.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)
        done = run(folder, f'text {{ ttf "{name}" "a" 1, 0 }}\n', "--check")
        tap.ok(done.returncode == 3 and "error[E0515]" in done.stderr, f"{name} is no font", done.stderr)


def test_cut_font(folder, font):
    with open(font, "rb") as file:
        whole = file.read()
    codes = set()
    for i in range(60):
        broken = bytearray(whole[:len(whole) * (i + 1) // 61] if i % 2 else whole)
        for k in range(40 if i % 2 == 0 else 0):
            broken[(i * 7919 + k * 104729) % len(broken)] ^= 1 << (i + k) % 8
        with open(os.path.join(folder, "cut.ttf"), "wb") as file:
            file.write(broken)
        codes.add(run(folder, 'text { ttf "cut.ttf" "Rays & g@" 1, 0 }\n', "--check").returncode)
    tap.ok(codes <= {0, 3}, "damaged fonts are read or refused", str(codes))


def test_loading(folder):
    plain = run(folder, "sphere { 0, 1 }\n", "--check", LD_DEBUG="libs")
    tap.ok("freetype" not in plain.stderr and "rtlang_font" not in plain.stderr, "a scene without text loads no FreeType")
    text = run(folder, 'text { ttf "junk.ttf" "a" 1, 0 }\n', "--check", LD_DEBUG="libs")
    tap.ok("rtlang_font" in text.stderr, "one with text does")


def test_letters(folder, font):
    text = f'text {{ ttf "{os.path.basename(font)}" "A b" 1, 0 }}\n'
    done = run(folder, text, "--dump=scene", "-I", os.path.dirname(font),
               "--allow-read", os.path.dirname(os.path.realpath(font)))
    tap.equal(len(re.findall(r"^prism \{", done.stdout, re.M)), 2, "two letters are prisms, a blank is nothing")


def main():
    if not os.path.exists(MODULE):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "junk.ttf"), "wb") as file:
                file.write(b"This is no font.")
            done = run(folder, 'text { ttf "junk.ttf" "a" 1, 0 }\n', "--check")
            tap.ok(done.returncode == 3 and "error[E0516]" in done.stderr, "text needs FreeType, and says so", done.stderr)
    else:
        with tempfile.TemporaryDirectory() as folder:
            test_no_font(folder)
            test_loading(folder)
            font = next((path for path in FONTS if os.path.exists(path)), None)
            if font is None:
                tap.skip("letters", "no timrom.ttf here")
            else:
                test_cut_font(folder, font)
                test_letters(folder, font)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
