#!/usr/bin/env python3
"""rtcheck --stability: what it promises holds, the textbook's formulas fail where they should, and its JSON, its page and its text are whole.

CHECK_LONG=1 measures a million cases a family. Prints TAP. SPDX-License-Identifier: MIT
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from tap import Tap

TOP = os.environ.get("top_srcdir", ".")
CASES = "1000000" if os.environ.get("CHECK_LONG") else "500"


def run(*options):
    done = subprocess.run([os.environ["RTCHECK"], "--stability", "--cases", CASES, *options], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, timeout=36000)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def check_measures(tap, found):
    families = {row["family"]: row for row in found["families"]}
    worst = max(families.values(), key=lambda row: row["rtlang"]["backward_error_u"])
    tap.ok(all(row["rtlang"]["wrong"] == 0 for row in families.values()) and len(families) > 15, "no class is wrong in any family")
    tap.ok(worst["rtlang"]["backward_error_u"] <= 1.0, f"backward errors stay below 1 u: {worst['rtlang']['backward_error_u']}")
    tap.ok(families["distance 1e12 radii"]["textbook"]["wrong"] > int(CASES) // 10, "the textbook's classes are wrong far away")
    tap.ok(families["distance 1e6 radii"]["textbook"]["backward_error_u"] > 1e4, "and its errors great")
    tap.ok(found["malformed"]["rtlang"] == 0 and found["malformed"]["textbook"] > 0, "no hit comes from what is no number")
    tap.ok(all(sum(row["rtlang: id and side"].values()) == 0 for row in found["secondary"]), "no false shadow, wrong exit or missed contact")
    tap.ok(any(row["t > 0.001"]["missed_contacts"] for row in found["secondary"]), "a fixed tolerance misses contacts")
    tap.ok(all(abs(one - theory) <= 0.1 * theory + 2 for row in found["mirrors"] for one, theory in zip(row["bounces"], row["theory"])),
           "paths between mirrors are lost when theory says")
    tap.ok(all(row["rtlang"] == 0 for row in found["shells"]) and any(row["textbook"] for row in found["shells"]),
           "shells are in their order, and by the textbook they are not")
    tap.ok(0 < found["total_reflection"]["greatest_wrong_u"] <= 4.3 and found["total_reflection"]["cosine_error_u"] <= 4.8,
           "total reflection is decided wrongly only within 4.3 u of its threshold")


def check_pictures(tap, found):
    twos = [row for row in found["pictures"] if row["what"].startswith("times 2^")]
    tap.ok(len(twos) >= 32 and all(row["same_bits"] for row in twos), f"{len(twos)} pictures are the same bits times 2^k")
    still = [row for row in found["pictures"] if row["what"] == "as it is"]
    tap.ok(all(row["made"] and row["off"] == 0 for row in still), f"{len(still)} stiff scenes agree with quadruple precision")
    given = [row for row in found["pictures"] if row["scene"].endswith("02_camera.scn")]
    tap.ok(len(given) == 15 and all(row["made"] for row in given), "a given scene is put elsewhere in 15 ways")
    limits = found["limits"]
    tap.ok(len(limits) == 18 and all(row["rtlang"] <= 2 for row in limits),
           "where POV-Ray's range ends rtlang's pictures of its own scene and the given one stay", limits)
    if os.environ.get("POVRAY") or shutil.which("povray"):
        tap.ok(limits[0]["povray"] <= 2 and limits[9]["povray"] <= 2 and all(any(row["povray"] is None or row["povray"] > 50 for row in rows)
                                                for rows in (limits[1:6], limits[10:15])), "and POV-Ray's does not", limits)
        moved = [row for row in limits if "1e6 along" in row["what"]]
        tap.ok(len(moved) == 6 and all(row["rtlang"] == 0 and row["povray"] is not None and row["povray"] <= 20 for row in moved),
               "shifted by 1e6 along each axis, within POV-Ray's range, no pixel of rtlang's is off", moved)


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        status, out, err = run("--json", "--report", folder, f"{TOP}/examples/02_camera.scn")
        if status == 2 and "--disable-study" in err:
            tap.skip("stability", "built with --disable-study")
            return tap.done()
        tap.ok(status == 0, f"everything that is promised holds {err}")
        found = json.loads(out)
        check_measures(tap, found)
        check_pictures(tap, found)
        with open(f"{folder}/index.html", encoding="utf-8") as file:
            page = file.read()
        tap.ok("Numerical stability" in page and page.count("<path fill") == 4 and page.count("data:image/png") >= 7 * 3 + 2 * 6 and "No picture: quad" not in page
               and "Shells within one another" in page, "the page has its tables, its plot and its pictures")
        with open(f"{folder}/stability.json", encoding="utf-8") as file:
            tap.ok(json.load(file) == found, "the report has the same numbers as JSON")
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
