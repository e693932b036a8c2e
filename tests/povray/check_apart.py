#!/usr/bin/env python3
"""The scenes of tests/povray/apart, each of which shows one way in which rtlang differs from POV-Ray, and how much.

The first line of a scene says what it shows. docs/language.md has a table of them between the marks `apart:begin` and
`apart:end`; `check_apart.py --update` measures and writes it. Without --update no figure may be greater than the table's, each
scene has its line there, and a scene that meets the bar is told, for it belongs into tests/povray. There every other
scene must meet the bar (check_pictures.py), so that what differs stands in the table. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import json
import math
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import documents  # noqa: E402
import pictures  # noqa: E402

TOP = os.environ.get("top_srcdir", ".")
DOCUMENT = os.path.join(TOP, "docs", "language.md")
MARK = "apart"
WIDTH, HEIGHT = 160, 120
MISSING_TOOL = 3  # rtcheck's exit code when it cannot run POV-Ray or cannot read pictures
HEAD = (f"| scene | what differs | greatest difference | root mean square | of {WIDTH} x {HEIGHT} pixels beyond 2/65535 |\n"
        "|---|---|---|---|---|\n")
ROW = re.compile(r"^\| `(\w+)` \| (.+) \| ([\d.]+) \| ([\d.]+) \| (\d+) \|$", re.MULTILINE)


def title(scene):
    """The scene's first line without its slashes and its full stop."""
    with open(scene, encoding="ascii") as text:
        return text.readline().lstrip("/ ").rstrip(".\n")


def name_of(scene):
    return os.path.basename(scene)[:-len(".scn")]


def rounded_up(value):
    """To two digits, upward, so that what is shown is not exceeded by what was measured."""
    if value <= 0.0:
        return "0"
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    digits = max(0, -math.floor(math.log10(step)))
    return f"{math.ceil(value / step - 1e-9) * step:.{digits}f}"


def measure(scenes, povray):
    """Scene's name -> (greatest difference, root mean square, pixels beyond the bar), the values from 0 to 1."""
    done = subprocess.run([os.environ["RTCHECK"], f"-W{WIDTH}", f"-H{HEIGHT}", "--json", f"--povray={povray}",
                           f"--threshold={pictures.CODE_BAR}/65535", *scenes], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=1200, check=False)
    if done.returncode == MISSING_TOOL:
        return None, done.stderr
    found = {}
    for line in done.stdout.splitlines():
        answer = json.loads(line) if line.startswith("{") else {}
        if "max" in answer:
            found[name_of(answer["scene"])] = (answer["max"] / 65535, answer["rmse"] / 65535, answer["beyond"])
    return found, done.stderr


def table(scenes, found):
    rows = [f"| `{name_of(scene)}` | {title(scene)} | " + " | ".join(
        [rounded_up(found[name_of(scene)][0]), rounded_up(found[name_of(scene)][1]), str(found[name_of(scene)][2])]) + " |\n"
            for scene in scenes]
    return HEAD + "".join(rows)


def judge(scene, found, rows):
    """(passed, words) of one scene: beyond the bar, and not beyond what the table says."""
    name, measured = name_of(scene), found.get(name_of(scene))
    if measured is None:
        return False, f"{name}: not rendered"
    words = f"{name}: max {measured[0]:.6f}, root mean square {measured[1]:.6f}, {measured[2]} pixels beyond the bar"
    if measured[2] <= pictures.TIE_SHARE * WIDTH * HEIGHT:
        return False, words + ": it meets the bar and belongs into tests/povray"
    if name not in rows:
        return False, words + ": not in the table of docs/language.md"
    what, shown = rows[name][0], tuple(map(float, rows[name][1:]))
    return (what == title(scene) and all(value <= limit for value, limit in zip(measured, shown)),
            f"{words}; the table says {what}: {shown}")


def main():
    scenes, povray = sorted(glob.glob(f"{TOP}/tests/povray/apart/*.scn")), pictures.povray()
    if not povray:
        print("1..0 # SKIP povray is not installed")
        return 0
    found, messages = measure(scenes, povray)
    if found is None:
        print("1..0 # SKIP " + messages.strip().splitlines()[0])
        return 0
    if "--update" in sys.argv:
        documents.write(DOCUMENT, MARK, table(scenes, found))
    said = documents.read(DOCUMENT, MARK)
    rows = {row[0]: row[1:] for row in ROW.findall(said)}
    results = [judge(scene, found, rows) for scene in scenes]
    gone = sorted(set(rows) - {name_of(scene) for scene in scenes})
    results.append((not gone, f"no line of the table is without its scene: {gone}"))
    results.append((len(rows) == len(said.strip().splitlines()) - len(HEAD.splitlines()) and said.startswith(HEAD),
                    "each line of the table can be read"))
    print(f"1..{len(results)}")
    for number, (passed, words) in enumerate(results, 1):
        print(f"{'ok' if passed else 'not ok'} {number} - {words}")
    for line in messages.splitlines():
        print("# " + line)
    return 0 if all(passed for passed, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main())
