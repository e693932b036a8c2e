#!/usr/bin/env python3
"""Checks every #include against the table of modules in docs/architecture.md.

The table is read out of the document itself, so that the document cannot be wrong. Prints TAP, one line a module.
SPDX-License-Identifier: MIT
"""
import os
import re
import sys

TOP = os.environ.get("top_srcdir", ".")
MODULE_FOLDERS = {"grammar": "grammar"}  # all others: src/NAME


def read_table(path):
    """Module -> set of modules it may include, from the rows between the marks."""
    text = open(path, encoding="utf-8").read()
    body = text.split("<!-- layers:begin -->")[1].split("<!-- layers:end -->")[0]
    table = {}
    for line in body.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == 2 and cells[0] and not re.fullmatch(r"-+|module", cells[0]):
            for module in cells[0].split(","):
                table[module.strip()] = set(re.findall(r"[a-z]+", cells[1]))
    return table


def includes_of(folder):
    for root, _, names in os.walk(folder):
        for name in sorted(names):
            if not name.endswith((".c", ".h", ".cpp", ".y", ".l", ".def")):
                continue
            path = os.path.join(root, name)
            for number, line in enumerate(open(path, encoding="utf-8"), 1):
                match = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
                if match:
                    yield path, number, match.group(1)


def faults_of(module, allowed, modules):
    folder = os.path.join(TOP, MODULE_FOLDERS.get(module, "src/" + module))
    for path, number, target in includes_of(folder):
        owner = target.split("/")[0] if "/" in target else None
        if owner is None:
            # Only the two generated files of grammar may name a header without its module.
            if not (module == "grammar" and target == "parser.h"):
                yield f"{path}:{number}: {target} does not name its module"
        elif owner != module and owner not in allowed:
            yield f"{path}:{number}: {module} may not include {owner} ({target})"
        elif owner == "grammar" and module != "grammar" and target != "grammar/grammar.h":
            yield f"{path}:{number}: only grammar/grammar.h may be included from outside"
        elif owner != module and owner not in modules and owner != "rtlang":
            yield f"{path}:{number}: {owner} is not a module"


def main():
    table = read_table(os.path.join(TOP, "docs/architecture.md"))
    folders = set(os.listdir(os.path.join(TOP, "src"))) | {"grammar"}
    failed = 0
    print(f"1..{len(table) + 1}")
    for number, (module, allowed) in enumerate(sorted(table.items()), 1):
        faults = list(faults_of(module, allowed, table))
        failed += bool(faults)
        print(f"{'not ' if faults else ''}ok {number} - includes of {module}")
        for fault in faults:
            print("# " + fault)
    missing = folders - set(table)
    failed += bool(missing)
    print(f"{'not ' if missing else ''}ok {len(table) + 1} - every folder is in the table {' '.join(sorted(missing))}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
