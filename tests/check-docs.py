#!/usr/bin/env python3
"""Checks that what the documents say is so.

Options of the manual pages against --help; relative links; every fenced block marked `scn` through rtlang --check; the parts
that are made from tables in C against the programs that print them (with UPDATE_DOCS=1 they are written anew).
Prints TAP. SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")


def read(name):
    with open(os.path.join(TOP, name), encoding="utf-8") as text:
        return text.read()


def output_of(*arguments):
    return subprocess.run(arguments, stdout=subprocess.PIPE, check=True, text=True, encoding="utf-8").stdout


def check_options(program, page):
    """Pairs of short and long option, which must be the same in --help and on the page."""
    helped = set(re.findall(r"^  (?:-(\w), |    )--([\w-]+)", output_of(program, "--help"), re.MULTILINE))
    told = set()
    for line in re.findall(r"^\.It (Fl .*)$", read(page), re.MULTILINE):
        short, long = re.search(r"Fl (\w)\b", line), re.search(r"Fl \\-([\w-]+)", line)
        told.add((short.group(1) if short else "", long.group(1)))
    for short, long in sorted(helped - told):
        yield f"--{long} is in --help only, or with another letter than `{short}`"
    for short, long in sorted(told - helped):
        yield f"--{long} is on the page only, or with another letter than `{short}`"


COLUMNS = 120


def check_width(name):
    """Of all but what programs print."""
    is_printed = False
    for number, line in enumerate(read(name).splitlines(), 1):
        is_printed = line == "```console" or (is_printed and line != "```")
        if len(line) > COLUMNS and not is_printed:
            yield f"line {number} has {len(line)} columns, more than {COLUMNS}"


def check_promises(name):
    """Each promise names tests, and these are there."""
    promises = re.findall(r"^- \*\*(.*?)\*\*(.*?)(?=^- |^$)", read(name), re.MULTILINE | re.DOTALL)
    for promise, how in promises:
        tests = re.findall(r"`(tests/[^`]*)`", how)
        for test in tests:
            if not os.path.exists(os.path.join(TOP, test)):
                yield f"no {test}"
        if not tests:
            yield f"no test for `{promise}`"
    if not promises:
        yield "no promises"


def check_links(name):
    text = re.sub(r"```.*?```", "", read(name), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text):
        if "://" not in target and not os.path.exists(os.path.join(TOP, os.path.dirname(name), target)):
            yield f"no {target}"
    for anchor in re.findall(r"\]\(#([^)]*)\)", text):
        titles = [re.sub(r"[^\w\- ]", "", title).strip().lower().replace(" ", "-")
                  for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE)]
        if anchor not in titles:
            yield f"no title for #{anchor}"


def check_scenes(name):
    text = read(name)
    for match in re.finditer(r"^```scn\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        line = text.count("\n", 0, match.start()) + 2
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "block.scn")
            with open(path, "w", encoding="utf-8") as scene:
                scene.write(match.group(1))
            done = subprocess.run([os.environ["RTLANG"], "--check", path], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode:
            yield f"the block at line {line}: " + done.stdout.replace(folder, "").strip().replace("\n", " | ")


def printed(variable):
    return output_of(os.environ.get(variable) or "tests/unit/" + variable.lower()).strip() + "\n"


def povray_options():
    return "```text\n" + output_of(os.environ["RTLANG"], "--help=povray") + "```\n"


def povray_page():
    """The same for the manual page, where a backslash is `\\e` and a dash `\\-`; no line begins with a dot."""
    shown = output_of(os.environ["RTLANG"], "--help=povray").replace("\\", "\\e").replace("-", "\\-")
    return f'.Bd -literal\n{shown}.Ed\n.\\" '


def check_generated(document, mark, want):
    begin, end = f"<!-- {mark}:begin -->\n", f"<!-- {mark}:end -->"
    text = read(document)
    head, rest = text.split(begin)
    found, tail = rest.split(end)
    if found == want:
        return
    if os.environ.get("UPDATE_DOCS"):
        with open(os.path.join(TOP, document), "w", encoding="utf-8") as out:
            out.write(head + begin + want + end + tail)
        return
    lines = zip(found.splitlines() + [""], want.splitlines() + [""])
    told = next((f"{a!r} should be {b!r}" for a, b in lines if a != b), "there are lines too many or too few")
    yield told + "; `make update-docs` writes it anew"


def checks():
    yield "rtlang.1 has rtlang's options", check_options(os.environ["RTLANG"], "docs/rtlang.1")
    yield "rtcheck.1 has rtcheck's options", check_options(os.environ["RTCHECK"], "docs/rtcheck.1")
    yield "SECURITY.md: each promise names tests that are there", check_promises("SECURITY.md")
    pages = ["README.md", "CONTRIBUTING.md", "SECURITY.md"] + sorted(glob.glob("docs/*.md", root_dir=TOP))
    for name in pages + ["CHANGELOG.md"] + sorted(glob.glob("docs/*.1", root_dir=TOP)):
        yield f"{name}: no line is too long to read", check_width(name)
    for name in pages + (["examples/README.md"] if os.path.exists(os.path.join(TOP, "examples/README.md")) else []):
        yield f"{name}: links lead somewhere", check_links(name)
    for name in pages:
        if "```scn\n" in read(name):
            yield f"{name}: rtlang accepts its scenes", check_scenes(name)
    yield "docs/language.md: the tables are the schema's", check_generated("docs/language.md", "schema", printed("PRINT_SCHEMA"))
    yield ("docs/diagnostics.md: the codes are those of the table",
           check_generated("docs/diagnostics.md", "codes", printed("PRINT_DIAGNOSTICS")))
    yield ("docs/povray.md: the options are those of the table",
           check_generated("docs/povray.md", "options", povray_options()))
    yield "rtlang.1: POV-Ray's options are those of the table", check_generated("docs/rtlang.1", "povray", povray_page())


def main():
    number, failed = 0, 0
    for number, (what, faults) in enumerate(checks(), 1):
        faults = list(faults)
        failed += bool(faults)
        print(f"{'not ok' if faults else 'ok'} {number} - {what}")
        for fault in faults:
            print("# " + fault)
    print(f"1..{number}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
