#!/usr/bin/env python3
"""rtlang --format: the rules, the command line, and every text at hand.

Those are the examples, the tests, POV-Ray's own files, random tokens and random layouts.
Of each text: nothing but white space changes, the tokens stay the same, the layout of the layout is the same text byte for
byte, and what can be evaluated evaluates to the same scene. The examples are in the layout. Prints TAP.

Usage: check_format.py [FILE...]   With files: those instead. FORMAT_SEED=N: other random texts.
SPDX-License-Identifier: MIT
"""
import concurrent.futures
import glob
import gzip
import os
import random
import re
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
RTLANG = os.path.abspath(os.environ.get("RTLANG", "rtlang"))
POVRAY_FOLDERS = {"povray-includes": "/usr/share/povray-3.7/include", "povray-examples": "/usr/share/doc/povray/examples"}
SEED = int(os.environ.get("FORMAT_SEED", "1"))
BLANKS = b" \t\r\n\f\v\x1a"


def rtlang(*arguments):
    return subprocess.run([RTLANG, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=120, check=False)


def tokens(path):
    """The tokens without their places."""
    done = rtlang("--dump=tokens", path)
    return [line.split(b" ", 1)[1] for line in done.stdout.split(b"\n") if re.match(rb"\d+:\d+ ", line)]


def scene(path, folder):
    done = rtlang("--dump=scene", "-q", "-I" + folder, path)
    return done.stdout if done.returncode == 0 else None


def bare(text):
    """All that is not white space. A byte order mark goes, too, and a `#` that is a directive without a word."""
    if text.startswith(b"\xef\xbb\xbf"):
        text = text[3:]
    return text.translate(None, BLANKS)


def fault_of(text, folder, name="text.scn"):
    """What is wrong with the layout of a text; "" if nothing is, None if its tokens cannot be read."""
    with tempfile.TemporaryDirectory() as work:
        source, once = os.path.join(work, name), os.path.join(work, "once-" + name)
        with open(source, "wb") as out:
            out.write(text)
        done = rtlang("--format", "-o", once, source)
        if done.returncode:
            return None if done.returncode == 1 and b"error[E01" in done.stderr else "exit %d" % done.returncode
        with open(once, "rb") as laid_out:
            first = laid_out.read()
        again = rtlang("--format", once)
        if again.returncode or again.stdout != first:
            return "its layout is laid out in another way"
        if bare(first) != bare(text):
            return "more than white space changed"
        if tokens(source) != tokens(once):
            return "the tokens changed"
        if rtlang("--format", "--check", once).returncode:
            return "--check refuses it"
        if re.search(rb"[ \t]\n|\n\n\n|\n\n\Z|\A\n", re.sub(rb'/\*.*?\*/|"(?:[^"\\]|\\.)*"', b"x", first, flags=re.DOTALL)):
            return "blanks at the end of a line, or empty lines"
        before = scene(source, folder)
        if before is not None and scene(once, folder) != before:
            return "the scene changed"
    return ""


def read(path):
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        return file.read()


def files(paths):
    for path in paths:
        yield os.path.relpath(path, TOP) if path.startswith(TOP) else path, read(path), os.path.dirname(path)


def cases():
    """The programs of tests/lang."""
    for path in sorted(glob.glob(f"{TOP}/tests/lang/*.test")):
        for part in re.split(rb"^== ", read(path), flags=re.MULTILINE)[1:]:
            name, _, rest = part.partition(b"\n")
            yield (f"{os.path.basename(path)}: {name.decode('latin-1')}",
                   re.split(rb"^-- ", rest, flags=re.MULTILINE)[0], TOP)


def find_files(folder, endings):
    found = []
    for root, _, names in os.walk(folder):
        found += [os.path.join(root, name) for name in names if name.endswith(endings)]
    return sorted(found)


PIECES = """{ } ( ) [ ] < > , ; . = + - * / & | ? : ! <= >= != 1 .5 2. 1e3 18 A Bc x "s" "a\\"b" sphere texture rgb array
function sin vdot albedo #if #ifdef #ifndef #else #elseif #end #switch #case #range #while #for #macro #declare #local
#include #default #break #debug #fopen read declare sphere{ #if(1) (1) {1} A( M(1) M(){ <1,2> // /*a*/ //b
""".split() + ["\n", "\n\n\n", "// c\n", "// c\r\n", "/* d\n   /* e */ */", "/* f */", "# if",
               "#switch (1) #case (2)", "#end #end", "}}", "\t", "\f", "é // ü\n", "\r\n"]


def soup(seed):
    """Random tokens, comments and line ends, which need not be a program."""
    dice = random.Random(seed)
    parts = [dice.choice(PIECES) for _ in range(dice.randrange(1, 60))]
    return "".join(part + dice.choice(["", " ", " ", "\n"]) for part in parts).encode()


TOKEN = re.compile(rb'"(?:[^"\\]|\\.)*"|//[^\n]*\n?|/\*.*?\*/|#\s*\w+|\w+|[<>!]=|[\d.]+|\S', re.DOTALL)


def shuffled(text, seed):
    """The same tokens with other white space between them; None if the text is beyond the simple scanner here."""
    dice = random.Random(seed)
    if re.search(rb"/\*(?:(?!\*/).)*/\*", text, re.DOTALL) or b"include" in text:
        return None
    gaps = [b" ", b" ", b"\n", b"\n\n\n", b"\t", b"\r\n"]
    return b"".join(match.group() + dice.choice(gaps) for match in TOKEN.finditer(text))


def groups():
    examples = sorted(glob.glob(f"{TOP}/examples/*.scn"))
    ours = examples + sorted(glob.glob(f"{TOP}/tests/povray/*.scn")) + sorted(glob.glob(f"{TOP}/share/rtlang/*.inc"))
    yield "examples, scenes of the tests, shipped include files", files(ours)
    yield "programs of tests/lang", cases()
    for package, folder in POVRAY_FOLDERS.items():
        paths = find_files(folder, (".pov", ".inc", ".pov.gz", ".inc.gz", ".map"))
        yield package, files(paths) if paths else None
    yield "random tokens", ((f"seed {SEED * 10000 + i}", soup(SEED * 10000 + i), TOP) for i in range(600))
    yield "random white space", (
        (f"{os.path.basename(path)}, seed {seed}", shuffled(read(path), seed), TOP)
        for path in ours for seed in range(SEED * 10, SEED * 10 + 3) if shuffled(read(path), seed) is not None)


def command_line():
    """(what is checked, whether it holds)"""
    expected = read(f"{TOP}/tests/format/layout.expected")
    done = rtlang("--format", f"{TOP}/tests/format/layout.scn")
    yield "the rules give layout.expected", done.returncode == 0 and done.stdout == expected
    with tempfile.TemporaryDirectory() as folder:
        good, bad, out = (os.path.join(folder, name) for name in ("good.scn", "bad.scn", "out.scn"))
        for path, text in ((good, b"sphere{0,1}"), (bad, b"sphere { 0, 1 $ }"), (out, b"old")):
            with open(path, "wb") as file:
                file.write(text)
        done = rtlang("--format", "-o", out, bad)
        yield "a faulty text: message, exit 1, nothing written", (
            done.returncode == 1 and b"bad.scn:1:15: error[E0101]" in done.stderr and read(out) == b"old")
        done = rtlang("--format", bad)
        yield "a faulty text: nothing printed", done.returncode == 1 and done.stdout == b""
        done = rtlang("--format", "--check", good)
        yield "--check tells where a text is not in the layout", (
            done.returncode == 1 and b"good.scn:1:7: error[E0120]" in done.stderr and done.stdout == b"")
        yield "-o on the text itself lays it out in place", (
            rtlang("--format", "-o", good, good).returncode == 0 and read(good) == b"sphere { 0, 1 }\n")
        yield "--check accepts the layout, in either order", (
            rtlang("--check", "--format", good).returncode == 0 == rtlang("--format", "--check", good).returncode)
        done = rtlang("--format", os.path.join(folder, "nowhere.scn"))
        yield "no such file: exit 3", done.returncode == 3 and done.stdout == b""
        with open("/dev/full", "wb") as full:
            code = subprocess.run([RTLANG, "--format", good], stdout=full, stderr=subprocess.PIPE, check=False).returncode
        yield "a full disk: exit 3", code == 3
        with open(out, "wb") as file:
            file.write(b"#/**/ /* a */debug \"x\"\r\n# // b\r\n\r\ndebug \"y\"  // c \r\n/*\r\n*/ #")
        done = rtlang("--format", out)
        yield "comments between `#` and its word stand before it; CRLF becomes LF", (
            done.stdout == b'/**/ /* a */ #debug "x"\n// b\n\n#debug "y" // c\n/*\n*/\n')
        with open(out, "wb") as file:
            file.write(b"sphere { " * 20000 + b"}" * 20000)
        done = rtlang("--format", out)
        yield "the layout does not grow with the square of the depth", (
            done.returncode == 0 and len(done.stdout) < 20000 * 250)


def check(group):
    """(number of texts, number of those with a layout, [fault])"""
    texts = list(group)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        found = list(pool.map(lambda text: fault_of(text[1], text[2]), texts))
    faults = [f"{name}: {fault}" for (name, _, _), fault in zip(texts, found) if fault]
    return len(texts), sum(fault is not None for fault in found), faults


def main():
    todo = list(groups()) if not sys.argv[1:] else [("files", files(sys.argv[1:]))]
    failed = 0
    first = list(command_line())
    print(f"1..{len(first) + len(todo) + 1}")
    for number, (name, holds) in enumerate(first, 1):
        failed += not holds
        print(f"{'ok' if holds else 'not ok'} {number} - {name}")
    for number, (name, group) in enumerate(todo, len(first) + 1):
        if group is None:
            print(f"ok {number} - {name} # SKIP {name} is not installed")
            continue
        count, read_count, faults = check(group)
        failed += bool(faults) or not read_count
        state = "ok" if read_count and not faults else "not ok"
        print(f"{state} {number} - {name}: {read_count} of {count} texts have a layout, which changes nothing", flush=True)
        for fault in faults[:20]:
            print("# " + fault)
    examples = sorted(glob.glob(f"{TOP}/examples/*.scn"))
    other = [path for path in examples if rtlang("--format", "--check", path).returncode]
    failed += bool(other) or not examples
    print(f"{'not ok' if other or not examples else 'ok'} {len(first) + len(todo) + 1} - the examples are in the layout {' '.join(other)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
