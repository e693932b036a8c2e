#!/usr/bin/env python3
"""Checks every #include against the table of modules in docs/architecture.md.

The table is read out of the document itself, so that the document cannot be wrong. A module may have rooms, which are
modules of their own: eval/values lies in src/eval/values. What the header of a room declares, a file of that room
defines, so that no call goes upwards by a declaration further down. Prints TAP, one line a module.
SPDX-License-Identifier: MIT
"""
import os
import re
import sys

TOP = os.environ.get("top_srcdir", ".")
MODULE_FOLDERS = {"grammar": "grammar"}  # all others: src/NAME


def read_table(path):
    """Module -> set of modules it may include, from the rows between the marks. Rows of one module add up."""
    text = open(path, encoding="utf-8").read()
    body = text.split("<!-- layers:begin -->")[1].split("<!-- layers:end -->")[0]
    table = {}
    for line in body.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == 2 and cells[0] and not re.fullmatch(r"-+|module", cells[0]):
            for module in cells[0].split(","):
                table.setdefault(module.strip(), set()).update(re.findall(r"[a-z/]+", cells[1]))
    return table


def folder_of(module):
    return os.path.join(TOP, MODULE_FOLDERS.get(module, "src/" + module))


def owner_of(path, modules):
    """The innermost module of a path below the include root; what lies in no module belongs to its first folder."""
    folder = os.path.dirname(path)
    while folder not in modules and "/" in folder:
        folder = os.path.dirname(folder)
    return folder or None


def files_of(module, modules, endings):
    """The files of a module, without those of its rooms."""
    for root, folders, names in os.walk(folder_of(module)):
        folders[:] = [name for name in folders
                      if os.path.relpath(os.path.join(root, name), os.path.join(TOP, "src")) not in modules]
        for name in sorted(names):
            if name.endswith(endings):
                yield os.path.join(root, name)


def includes_of(module, modules):
    for path in files_of(module, modules, (".c", ".h", ".inc", ".cpp", ".y", ".l", ".def")):
        for number, line in enumerate(open(path, encoding="utf-8"), 1):
            match = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
            if match:
                yield path, number, match.group(1)


def names_of(module, modules, endings, pattern):
    """Names of functions and tables at the left margin, with the files that they stand in."""
    found = {}
    for path in files_of(module, modules, endings):
        for match in re.finditer(pattern, open(path, encoding="utf-8").read(), re.M):
            found.setdefault(match.group(1), path)
    return found


def declared_elsewhere(module, modules):
    """What a header of a room declares and no file of it defines."""
    head = r"^(?!static|typedef|return|#)[A-Za-z][\w \*]*?\b"
    declared = names_of(module, modules, (".h",), head + r"(\w+)\([^{}]*?\)[^{}()]*(?:\([\d, ]*\))?;")
    declared |= names_of(module, modules, (".h",), r"^extern const \w+ (\w+);")
    defined = names_of(module, modules, (".c",), head + r"(\w+)\((?:[^{};]|\n)*?\)\s*\{")
    defined |= names_of(module, modules, (".c",), r"^const \w+ (\w+) =")
    for name, path in sorted(declared.items()):
        if name not in defined:
            yield f"{path}: {name} is declared in {module} and defined elsewhere"


def faults_of(module, allowed, modules):
    for path, number, target in includes_of(module, modules):
        owner = owner_of(target, modules)
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
    if "/" in module:
        yield from declared_elsewhere(module, modules)


def folders_with_files():
    """Folders below the include root that hold files of the program."""
    for root, _, names in os.walk(os.path.join(TOP, "src")):
        if any(name.endswith((".c", ".h", ".cpp")) for name in names):
            yield os.path.relpath(root, os.path.join(TOP, "src"))


def main():
    table = read_table(os.path.join(TOP, "docs/architecture.md"))
    folders = set(folders_with_files()) | {"grammar"}
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
