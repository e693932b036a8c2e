#!/usr/bin/env python3
"""docs/tour.md: each command prints what stands there.

Blocks of scenes go to the files that their first lines name; then the lines that begin with `$` run in that folder, one block
after the other, and what they print must be the rest of the block (with UPDATE_DOCS=1 it is written anew). Prints TAP.
SPDX-License-Identifier: MIT
"""
import os
import re
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
PAGE = os.path.join(TOP, "docs/tour.md")
BLOCK = re.compile(r"^```(scn|console)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def run(text, folder):
    """The commands of a block, each with what it prints."""
    shown = ""
    for command in re.findall(r"^\$ (.*)$", text, re.MULTILINE):
        program = os.path.abspath(os.environ["RTLANG"])
        done = subprocess.run(["sh", "-c", f'rtlang() {{ "{program}" "$@"; }}\n{command}'], cwd=folder,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        shown += f"$ {command}\n" + done.stdout.decode("utf-8", "replace")
    return shown


def main():
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    number, failed = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        def one(match):
            nonlocal number, failed
            kind, text = match.groups()
            if kind == "scn":
                with open(os.path.join(folder, re.match(r"// (\S+)", text).group(1)), "w", encoding="ascii") as out:
                    out.write(text)
                return match.group(0)
            number += 1
            shown = run(text, folder)
            fine = shown == text or bool(os.environ.get("UPDATE_DOCS"))
            failed += not fine
            print(f"{'ok' if fine else 'not ok'} {number} - {text.splitlines()[0]}")
            if not fine:
                print("# it prints now:\n# " + shown.replace("\n", "\n# "))
            return f"```{kind}\n{shown}```"
        page = BLOCK.sub(one, page)
    if os.environ.get("UPDATE_DOCS"):
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(page)
    print(f"1..{number}")
    return 1 if failed or not number else 0


if __name__ == "__main__":
    sys.exit(main())
