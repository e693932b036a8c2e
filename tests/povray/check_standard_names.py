#!/usr/bin/env python3
"""src/eval/run/standard_names.def lists what POV-Ray's include files declare: it is what the installed ones say.

Only the names are read, outside of macros. `--update` writes the list again. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import sys
import textwrap

LIST = os.path.join(os.environ.get("top_srcdir", "."), "src/eval/run/standard_names.def")
HEAD = """\
// What the include files that come with POV-Ray 3.7 declare: STANDARD(file, "NAME NAME ... "), each name once. A name
// that is not declared may be one of them when the files are not at hand.
// Made by tests/povray/check_standard_names.py --update.
//
// SPDX-License-Identifier: MIT
"""
DIRECTIVE = re.compile(r"#\s*(?:(?P<macro>macro)\s+(?P<called>\w+)|(?P<end>end)\b|"
                       r"(?P<opens>if|ifdef|ifndef|while|for|switch)\b|declare\s+(?P<name>[A-Za-z_]\w*)\s*=)")


def declared(path):
    with open(path, encoding="latin-1") as file:
        text = re.sub(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', " ", file.read(), flags=re.DOTALL)
    names, within = [], []
    for found in DIRECTIVE.finditer(text):
        if not any(within) and (found["name"] or found["called"]):
            names.append(found["name"] or found["called"])
        if found["macro"] or found["opens"]:
            within.append(bool(found["macro"]))
        elif found["end"] and within:
            within.pop()
    return [name for name in names if len(name) > 1 and not name.upper().endswith("_TEMP")]


def listing(files):
    """Files for scenes of before 3.7 come last: a name that a newer one declares as well is that one's."""
    seen, out = set(), [HEAD]
    for path in sorted(files, key=lambda path: ("old" in os.path.basename(path), os.path.basename(path))):
        names = sorted(set(declared(path)) - seen)
        seen.update(names)
        lines = textwrap.wrap(" ".join(names), 105, break_long_words=False, break_on_hyphens=False)
        out.append('STANDARD("%s",\n' % os.path.basename(path))
        out += ['         "%s "%s\n' % (line, ")" if line is lines[-1] else "") for line in lines] or ['         "")\n']
    return "".join(out)


def main():
    files = glob.glob("/usr/share/povray-3.7/include/*.inc")
    if not files:
        print("1..0 # SKIP POV-Ray's include files are not installed")
        return 0
    wanted = listing(files)
    if sys.argv[1:] == ["--update"]:
        with open(LIST, "w", encoding="ascii") as file:
            file.write(wanted)
        return 0
    with open(LIST, encoding="ascii") as file:
        fine = file.read() == wanted
    print("1..1\n%sok 1 - the list of names is that of the include files" % ("" if fine else "not "))
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
