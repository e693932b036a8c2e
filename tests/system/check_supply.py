#!/usr/bin/env python3
"""How the program is built: what makes faults of memory hard to use is there, nothing built knows the folder that it was
built in, so that two builds are the same bytes, and the list of parts is one and names what is loaded.

Prints TAP. Wants RTLANG. SPDX-License-Identifier: MIT
"""
import json
import os
import re
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from tap import Tap  # noqa: E402

RTLANG = os.path.abspath(os.environ["RTLANG"])
BUILD = os.path.dirname(RTLANG)
tap = Tap()


def makefile_variable(name):
    with open(os.path.join(BUILD, "Makefile"), encoding="utf-8") as file:
        return re.search(rf"^{name} = *(.*)$", file.read(), re.M)[1]


def readelf(option, path):
    return subprocess.run(["readelf", option, path], capture_output=True, text=True, check=True, timeout=60).stdout


def test_hardening(files):
    if "-z,relro" not in makefile_variable("RTLANG_LDFLAGS"):
        tap.skip("hardening", "configured with --disable-hardening, or for sanitizers")
        return
    flags = makefile_variable("RTLANG_CFLAGS")
    for path in files:
        name = os.path.basename(path)
        dynamic, segments, symbols = readelf("-d", path), readelf("-lW", path), readelf("-sW", path)
        tap.ok("GNU_RELRO" in segments and re.search("BIND_NOW|FLAGS_1.*NOW", dynamic),
               f"{name}: addresses of functions are read-only when it runs", dynamic)
        stack = re.search(r"GNU_STACK .*? (\S+) +0x", segments)
        tap.ok(stack and "E" not in stack[1], f"{name}: no code on the stack", segments)
        if "-fstack-protector-strong" in flags:
            tap.ok("__stack_chk_fail" in symbols, f"{name}: stacks are guarded")
    if "-D_FORTIFY_SOURCE=2" in flags:
        tap.ok("_chk@" in readelf("-sW", RTLANG).replace("__stack_chk_fail@", ""), "functions of the C library are checked")


def test_reproducible(files):
    """Debug information, too: the number of a build is made of it."""
    if "-ffile-prefix-map" not in makefile_variable("RTLANG_CFLAGS"):
        tap.skip("no folder of the build", "the compiler does not know -ffile-prefix-map")
        return
    for path in files:
        with open(path, "rb") as file:
            found = file.read().find(BUILD.encode() + b"/")
        tap.ok(found < 0, f"{os.path.basename(path)} does not know the folder that it was built in", found)


def test_parts():
    with open(os.path.join(BUILD, "rtlang.cdx.json"), encoding="utf-8") as file:
        listed = json.load(file)
    version = subprocess.run([RTLANG, "--version"], capture_output=True, text=True, check=True, timeout=60).stdout.split()[1]
    own = listed["metadata"]["component"]
    tap.equal((listed["bomFormat"], own["name"], own["version"]), ("CycloneDX", "rtlang", version), "whose parts they are")
    parts = {part["name"]: part["version"] for part in listed["components"]}
    wanted = {"libpng": "libpng", "zlib": "zlib", "libjpeg": "libjpeg"}
    if os.path.exists(os.path.join(BUILD, "rtlang_oiio.la")):
        wanted["OpenImageIO"] = "OpenImageIO"
    if os.path.exists(os.path.join(BUILD, "rtlang_http.la")):
        wanted["libmicrohttpd"] = "libmicrohttpd"
    if os.path.exists(os.path.join(BUILD, "rtlang_font.la")):
        wanted["FreeType"] = "FreeType"
    tap.equal(set(parts), set(wanted), "the parts are the libraries that it links and loads")
    tap.ok(all(re.fullmatch(r"[0-9][\w.+-]*", number) for number in parts.values()), "with their versions", parts)
    references = {own["bom-ref"]} | {part["bom-ref"] for part in listed["components"]}
    named = {name for entry in listed["dependencies"] for name in [entry["ref"], *entry["dependsOn"]]}
    tap.ok(named == references, "each of which something depends on", f"{named} {references}")
    linked = re.findall(r"\(NEEDED\).*\[lib(\w+)", readelf("-d", os.path.join(BUILD, "rtlang")))
    unknown = set(linked) - {"png16", "z", "m", "c", "pthread", "dl"}
    tap.equal(unknown, set(), "and no library is linked that is not listed")


def main():
    if not shutil.which("readelf"):
        tap.skip("how it is built", "no readelf here")
    else:
        names = ["rtlang", "rtcheck", ".libs/librtlang.so", ".libs/rtlang_jpeg.so", ".libs/rtlang_oiio.so",
                 ".libs/rtlang_http.so", ".libs/rtlang_font.so"]
        files = [os.path.join(BUILD, name) for name in names if os.path.exists(os.path.join(BUILD, name))]
        test_hardening(files)
        test_reproducible(files)
        test_parts()
    tap.done()


main()
