#!/usr/bin/env python3
"""The forms and kinds of messages: JSON read by a JSON reader, --explain, and which warnings are told. Prints TAP.

SPDX-License-Identifier: MIT
"""
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

from tap import Tap

PROGRAM = os.path.abspath(os.environ["RTLANG"])
PLACE = ["file", "begin", "end", "line", "column", "end_line", "end_column"]
MEMBERS = {"type", "code", "severity", "message", "notes", "stack", "suggestion", *PLACE}
SCENE = """// \u00e4\u00f6 \u20ac
#macro Atom(A)
  sphere { 0, A raduis 2 }
#end
#include "part.inc"
#debug "a \\"quote\\" and \\\\\\n"
/* \u00e4 */ #declare Colour = <1, 0,
  0>
object { Collour }
sphere { 0, 0 }
"""
PART = "Atom(1)\n"


def run(*options, scene=SCENE, name="s.scn"):
    with tempfile.TemporaryDirectory() as folder:
        for file, text in ((name, scene), ("part.inc", PART)):
            with open(os.path.join(folder, file), "wb") as out:
                out.write(text if isinstance(text, bytes) else text.encode())
        done = subprocess.run([PROGRAM, *options, name], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=60, check=False)
    return done.returncode, done.stderr


def objects(*options, **scene):
    status, said = run("--diagnostics=json", *options, **scene)
    return status, [json.loads(line) for line in said.decode("utf-8").split("\n") if line]


def codes(*options, **scene):
    status, said = objects("--check", *options, **scene)
    return status, [(one["code"], one["severity"]) for one in said if one["type"] == "diagnostic"]


def text_at(place):
    text = {"s.scn": SCENE, "part.inc": PART}[place["file"]].encode()
    return text[place["begin"]:place["end"]].decode()


def place_is_true(place):
    """Lines and columns, which count characters, are those of the bytes."""
    if place["file"] is None or place["begin"] is None:
        return all(place[member] is None for member in PLACE[1:])
    text = {"s.scn": SCENE, "part.inc": PART}[place["file"]].encode()
    for byte, line, column in (("begin", "line", "column"), ("end", "end_line", "end_column")):
        before = text[:place[byte]].decode()
        if (before.count("\n") + 1, len(before) - before.rfind("\n")) != (place[line], place[column]):
            return False
    return True


def check_json(tap):
    status, said = objects("--check")
    tap.ok(status == 1, "exit code as in text")
    found = {one.get("code"): one for one in said}
    told = [one for one in said if one["type"] == "diagnostic"]
    tap.ok([one["text"] for one in said if one["type"] == "message" and one["stream"] == "debug"] ==
           ['a "quote" and \\'], "what the scene says is an object too")
    tap.ok(all(set(one) == MEMBERS for one in told), "every message has every member")
    places = told + [note for one in told for note in one["notes"] + one["stack"]]
    tap.ok(len(places) >= 6 and all(map(place_is_true, places)), "bytes, lines and columns agree",
           [place for place in places if not place_is_true(place)])
    unknown, undeclared, missing = found["E0250"], found["E0201"], found["E0205"]
    tap.ok(text_at(unknown) == "raduis" and unknown["severity"] == "error", "the range of a word")
    tap.ok([(frame["kind"], frame["name"], text_at(frame)) for frame in unknown["stack"]] ==
           [("macro", "Atom", "Atom(1)"), ("include", "part.inc", '#include "part.inc"')], "the stack, innermost first")
    suggestion = undeclared["suggestion"]
    tap.ok(suggestion["replacement"] == "Colour" and text_at(suggestion) == "Collour" and
           suggestion["message"] == "did you mean `Colour`?", "a suggestion can be put in by a program")
    suggestion = missing["suggestion"]
    tap.ok(suggestion["replacement"] == ";" and suggestion["begin"] == suggestion["end"] == missing["end"],
           "so can one that replaces nothing")
    whole = codes("-Wall", scene="sphere { 0, 1 }\n")
    tap.ok(("W0401", "warning") in whole[1], "a message about the whole scene")
    status, said = run("--diagnostics=json", "-o", "p.png", scene="camera { }\n")
    tap.ok(status == 0 and all(json.loads(line) for line in said.splitlines()), "no summary and no progress between")
    status, said = objects("--check", scene=b"sphere { 0, 1 } // \xff\xfe\n\x01$ /*", name="\u00e4\u2028\"\\.scn")
    tap.ok(status == 1 and said[0]["file"] == "\u00e4\u2028\"\\.scn", "names and bytes of any kind")
    status, said = objects("--bogus")
    tap.ok(status == 2 and said[0]["code"] == "E0703" and said[0]["file"] is None, "faults of the command line")
    status, said = run("--diagnostics=xml")
    tap.ok(status == 2 and b"wants text or json" in said, "no other form")


def check_warnings(tap):
    few = "camera { } light_source { 9, 1 } sphere { 0, 1 } "
    zero = "sphere { 0, 0 } "
    table = [
        ("as they come", (), zero, 0, {"W0348", "W0401", "W0402", "W0403"}),
        ("one off", ("-Wno-W0401",), zero, 0, {"W0348", "W0402", "W0403"}),
        ("off and on", ("-Wno-W0401", "-WW0401"), zero, 0, {"W0348", "W0401", "W0402", "W0403"}),
        ("in small letters, in the long form", ("--warnings=no-w0401",), zero, 0, {"W0348", "W0402", "W0403"}),
    ]
    for name, options, scene, want_status, want in table:
        status, found = codes(*options, scene=scene)
        tap.ok(status == want_status and {code for code, _ in found} <= want, f"{name}: {found}")
    status, found = codes("-Werror", scene=few + zero)
    tap.ok(status == 1 and found == [("W0348", "error")], "-Werror makes errors of warnings")
    status, found = codes("-Werror", "-Wno-error", scene=few + zero)
    tap.ok(status == 0 and found == [("W0348", "warning")], "-Wno-error takes it back")
    status, found = codes("-Werror=W0401", scene=zero)
    tap.ok(status == 1 and ("W0401", "error") in found and ("W0348", "warning") in found, "-Werror=CODE for one")
    status, found = codes("-Werror", "-Wno-W0348", scene=few + zero)
    tap.ok(status == 0 and not found, "what is off is no error")
    for wrong in ("-Wfoo", "--warnings=", "-WE0201", "-Wno-", "-Werror="):
        status, said = run(wrong)
        tap.ok(status == 2 and b"E0703" in said, f"{wrong} is refused")
    status, said = run("-W64", "--check", scene=few)
    tap.ok(status == 0 and not said, "-W64 is still a width")


def lacks_files(path):
    """Whether a scene wants a font or an include file of POV-Ray's that is not on this machine."""
    with open(path, encoding="utf-8") as scene:
        text = scene.read()
    ours = (os.path.dirname(path), f"{os.environ['top_srcdir']}/share/rtlang")
    is_named = ".ttf" in text or any(not any(os.path.exists(f"{folder}/{name}") for folder in ours)
                                     for name in re.findall(r'#include "([^"]*)"', text))
    return is_named and not glob.glob("/usr/share/povray*/include/functions.inc")


def check_clean_scenes(tap):
    """Nothing is suspicious in scenes that are fine."""
    top = os.environ["top_srcdir"]
    for path in sorted(glob.glob(f"{top}/examples/*.scn") + glob.glob(f"{top}/tests/povray/*.scn")):
        if lacks_files(path):
            tap.skip(os.path.basename(path), "POV-Ray's include files are not installed")
            continue
        done = subprocess.run([PROGRAM, "-q", "-Wall", f"-I{top}/share/rtlang", "--check", os.path.basename(path)],
                              cwd=os.path.dirname(path), stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              check=False)
        tap.ok(done.returncode == 0 and not re.search(r"W020[5-9]", done.stderr),
               f"nothing suspicious in {os.path.basename(path)}", done.stderr)


def check_counts(tap):
    status, said = run("--check", "-Wno-W0402", "-Wno-W0403", "-Wno-W0401", scene="sphere { 0, 0 }\n" * 1000)
    told = said.decode()
    tap.ok(status == 0 and told.count("warning[W0348]") == 5, "five warnings that say the same")
    tap.ok(told.endswith("rtlang: note[W0348]: 995 more of this warning are not shown: nothing to draw\n"),
           "and a note that counts the rest")
    status, said = run("--check", scene="".join(f'#warning "{i}"\n' for i in range(150)) + "camera { }\n")
    told = said.decode()
    tap.ok(told.count("warning[W0201]") == 100 and "note[W0201]: 50 more of this warning" in told,
           "a hundred that say different things")
    status, said = run("--check", scene="".join(f"object {{ N{i} }}\n" for i in range(20)))
    tap.ok(said.count(b"error[E0201]") == 20 and b"stopped" not in said, "twenty errors are told")
    status, said = run("--check", scene="".join(f"object {{ N{i} }}\n" for i in range(21)))
    tap.ok(said.count(b"error[E0201]") == 20 and said.endswith(b"note: stopped after 20 errors; there may be more\n"),
           "and no more")


def check_explain(tap):
    def explain(*words):
        done = subprocess.run([PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
        return done.returncode, done.stdout.decode(), done.stderr.decode()
    status, told, _ = explain("--explain", "E0250")
    tap.ok(status == 0 and told.startswith("E0250: unknown property (error, exit code 1)\n"), "--explain CODE")
    tap.ok("wrong: sphere { 0, 1 raduis 2 }" in told and all(len(line) <= 80 for line in told.splitlines()),
           "an example and a paragraph")
    tap.ok(explain("--explain=e0250") == (status, told, ""), "--explain=CODE, in small letters")
    for words in (("--explain",), ("--explain=E02",), ("--explain", "E0250", "E0251"), ("--explain", "E0999"),
                  ("--explain", "scene.scn", "E0250")):
        status, told, said = explain(*words)
        tap.ok(status == 2 and not told and "E0703" in said, " ".join(words) + " is refused")


def check_explain_scene(tap):
    def explain(text, *words):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "scene.scn"), "w", encoding="utf-8") as file:
                file.write(text)
            with open(os.path.join(folder, "broken.png"), "w", encoding="ascii") as file:
                file.write("no picture")
            done = subprocess.run([PROGRAM, "-W40", "-H30", "-t1", *words, "--explain", "scene.scn"], cwd=folder, check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        return done.returncode, done.stdout.decode()

    def part(told, heading):
        rest = told.split(heading, 1)[1].split("\n\n", 1)[0]
        return {line[:24].strip(): line[24:].strip() for line in rest.splitlines() if line.startswith("  ")}
    scene = "camera { location -5*z look_at 0 } %s sphere { 0, 1 pigment { rgb 1 } finish { %s } } %s\n"
    status, told = explain(scene % ("light_source { <5, 5, -5>, 1 shadowless }", "", ""))
    left = part(told, "left out, and why")
    tap.ok(status == 0 and left["shadow rays"] == "no light casts shadows" and "planes" in left and
           left["tree of spheres"] == "1 sphere, tested one after the other",
           "--explain SCENE tells what is left out", told)
    tap.ok("1200 rays" in part(told, "there, and what it costs")["camera rays"], "and what is there", told)
    status, told = explain(scene % ("", "", "box { 2, 3 } difference { box { 4, 5 } sphere { 4, 1 } }"))
    tap.ok(status == 0 and "s  4 shapes, 0 lights" in told, "each shape is counted once", told)
    status, told = explain(scene % ("light_source { <5, 5, -5>, 1 }", "reflection 0.5 phong 1", "plane { y, -1 }"))
    there, left = part(told, "there, and what it costs"), part(told, "left out, and why")
    tap.ok(status == 0 and {"shadow rays", "mirrored rays", "highlights", "planes"} <= set(there), "another scene", told)
    shadow = re.fullmatch(r"(\d+) rays; costs [0-9.]+ s and (\d+) rays in all", there["shadow rays"])
    tap.ok(shadow and shadow[1] == shadow[2], "without shadows all of their rays are gone", told)
    tap.ok(not set(there) & set(left), "nothing is both", told)
    declared = "#declare A = 1; #declare B = texture { pigment { image_map { png \"broken.png\" } } } #macro M(C) C #end #declare D = M(A);"
    status, told = explain(declared + scene % ("", "", ""))
    tap.ok(status == 0 and part(told, "left out, and why")["declared names"].startswith("2 of 4 are never used"),
           "names that nothing asks for", told)
    tap.ok("declared names" not in explain(scene % ("", "", ""))[1], "where there are none, nothing is said of them")
    tap.ok(explain(declared + scene % ("", "", "sphere { 3, 1 texture { B } }"))[0] != 0, "a broken picture that is used is a fault")
    tap.ok(explain("sphere { 0, -1 }")[0] == 1, "a faulty scene is not explained")


def main():
    tap = Tap()
    check_json(tap)
    check_warnings(tap)
    check_clean_scenes(tap)
    check_counts(tap)
    check_explain(tap)
    check_explain_scene(tap)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
