#!/usr/bin/env python3
"""Programs that run `povray`, with rtlang under that name: what they get is what they get from POV-Ray.

ASE, PyMOL, Jmol and Open Babel are run where they are installed, the others by the words that they pass. Each case runs twice, once
with rtlang and once with POV-Ray under the name `povray`, first in PATH. POV-Ray is kept from jitter, which moves samples at
random, by a povray.ini and one more word. With --update all is drawn larger, and the table of docs/povray.md is written.
Prints TAP. SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_place  # noqa: E402
import documents  # noqa: E402
import pictures  # noqa: E402

SCENE = """#version 3.6;
global_settings { assumed_gamma 1.0 }
camera { location <0.2, 1.1, -9> look_at 0 right 4/3 * x }
light_source { <-5, 8, -16>, rgb 1 }
background { rgb <1, 1, 0.9> }
#declare I = 0;
#while (I < 60)
  sphere { <2.6 * sin(I * 2.4), 0.04 * (I - 30), 2.6 * cos(I * 2.4)>, 0.7
    pigment { rgb <0.3 + 0.01 * I, 0.5, 0.9 - 0.01 * I> } finish { ambient 0.1 diffuse 0.7 phong 0.4 } }
  #declare I = I + 1;
#end
"""
INI = {"makehuman.ini": "Input_File_Name=\"scene.pov\"\nOutput_File_Name=\"human.png\"\nWidth=160\nHeight=120\n"
                        "Output_File_Type=N\nBits_Per_Color=8\nQuality=9\nAntialias=On\nSampling_Method=2\n"
                        "Antialias_Depth=3\nAntialias_Threshold=0.1\nJitter=Off\nDisplay=Off\nPause_When_Done=Off\n"
                        "Verbose=On\nOutput_to_File=On\n"}
CODE_BAR = 1
WRITES = "--update" in sys.argv
DOCUMENT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "povray.md")
# `povray`: the program under that name, from a folder of its own, and what it took of the processor into a file.
WRAPPER = """#!/bin/bash
TIMEFORMAT='%3U %3S'
{ time "$0.d/povray" "$@" 2>&3; } 3>&2 2>>"$0.times"
"""
# name, the words, their picture
RECORDED = [
    ("vapory", ["scene.pov", "+H120", "+W160", "-D", "Output_File_Type=P", "+O-"], "standard output"),
    ("vapory, anti-aliased", ["scene.pov", "+H120", "+W160", "+A0.01", "-D", "Output_File_Type=P", "+O-"],
     "standard output"),
    ("VMD", ["+H120", "+W160", "-Iscene.pov", "-Oscene.pov.tga", "+D", "+X", "+A", "+FT"], "scene.pov.tga"),
    ("OVITO", ["scene.pov", "+W160", "+H120", "Pause_When_Done=off", "Output_to_File=on", "-V", "Output_File_Type=N",
               "Output_File_Name=ovito.png", "Display=off", "+Q9", "+A0.3", "+AM1", "+R3", "+J"], "ovito.png"),
    ("MakeHuman", ["makehuman.ini"], "human.png"),
    ("Avogadro", ["+Iscene.pov", "+W160", "+H120", "+V", "+FN", "+UA", "-D"], "scene.png"),
    ("Neper", ["Input_File_Name=scene.pov", "Output_File_Name=neper.png", "+W160", "+H120", "-D", "+A0.2", "-J"],
     "neper.png"),
    ("DRAWxtl", ["+Iscene.pov", "+Odrawxtl.tga", "+W160", "+H120", "+FT", "-P", "-D"], "drawxtl.tga"),
]
ASE = """from ase.build import bulk
from ase.io import write
made = write("atoms.pov", bulk("NaCl", "rocksalt", a=5.64, cubic=True) * (2, 2, 2), rotation="20x,30y",
             povray_settings=dict(canvas_width=160, area_light=None, point_lights=[[(2.0, 3.0, 40.0), "White"]]))
print(made.render())
"""
PYMOL = """fragment benzene
hide everything
show spheres
viewport 160, 120
set antialias, 0
ray 160, 120, renderer=1
png pymol.png
"""


ETHANOL = """9
ethanol
C -0.748 0.015 0.024
C 0.558 0.420 -0.278
O 1.293 -0.202 -0.901
H -1.263 0.754 0.600
H -0.699 -0.934 0.609
H -1.197 -0.130 -0.931
H 1.117 0.500 0.642
H 0.500 1.380 -0.760
H 2.150 0.100 -1.000
"""
# Jmol writes an .ini file beside the scene, by which POV-Ray waits for a key when it is done; -P keeps it from that.
JMOL = ("java -Djava.awt.headless=true -Xmx512m -cp /usr/share/java/JmolData.jar org.openscience.jmol.app.JmolData "
        "-o -x -g160x120 -s jmol.spt >jmol.log && povray molecule.pov.ini -P")
OPEN_BABEL = "obabel -:c1ccccc1O --gen3d -opov -xm SPF -O babel.pov && povray +Ibabel.pov +W160 +H120 -D +A0.2"


def sized(text):
    """Pictures are small but for the table, which tells of times."""
    return text.replace("160", "800").replace("120", "600") if WRITES else text


def put_povray(place, program):
    """Puts the wrapper into a new folder `place`."""
    os.makedirs(os.path.join(place, "povray.d"))
    os.symlink(program, os.path.join(place, "povray.d", "povray"))
    with open(os.path.join(place, "povray"), "w", encoding="ascii") as file:
        file.write(WRAPPER)
    os.chmod(os.path.join(place, "povray"), 0o755)


def seconds_of(place):
    """Of the processor, of all runs of the wrapper since the last time."""
    path = os.path.join(place, "povray.times")
    with open(path, encoding="ascii") as file:
        found = file.read().split()
    os.remove(path)
    return sum(map(float, found))


def run(words, folder, place):
    """Runs a caller; `place` is the folder that stands first in PATH."""
    path = os.pathsep.join(filter(None, [place, "/usr/bin", "/bin", os.environ.get("PATH", "")]))
    # Some callers want POV-Ray's window. Where there is no terminal either, the library that opens it ends the program.
    environment = dict(os.environ, PATH=path, HOME=folder, POVINI=os.path.join(folder, "usual.ini"),
                       SDL_VIDEODRIVER="dummy")
    done = subprocess.run(words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=120, check=False)
    with open(os.path.join(folder, "standard output"), "wb") as file:
        file.write(done.stdout)
    return done


def fill(folder):
    usual = "Jitter=Off\n" + "".join(f"Library_Path={place}\n" for place in
                                     pictures.include_folders() + glob.glob("/usr/share/openbabel/*"))
    files = {"scene.pov": SCENE, "usual.ini": usual, "make_ase.py": ASE, "pymol.pml": PYMOL, "ethanol.xyz": ETHANOL,
             "jmol.spt": 'load ethanol.xyz;\nwrite POVRAY "molecule.pov";\n', **INI}
    for name, text in files.items():
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(sized(text))


def both(words, picture, places):
    """[(status, codes of the picture or None, seconds, what was said)] of rtlang and of POV-Ray."""
    results = []
    for place in places:
        with tempfile.TemporaryDirectory() as folder:
            fill(folder)
            done = run([sized(word) for word in words] + ["-J"] * (words[0] == "povray" and place == places[1]), folder,
                       place)
            there = os.path.exists(os.path.join(folder, picture))
            codes = check_place.contents(folder, picture) if there else None
            results.append((done.returncode, codes, seconds_of(place), done.stderr.decode("utf-8", "replace")[-500:]))
    return results


def verdict(results):
    """(passed, words, cells of the table)."""
    (status, own, seconds, said), (other_status, other, other_seconds, _) = results
    if status != other_status or not own or not other or len(own) != 5 or own[:4] != other[:4]:
        return False, f"status {status} and {other_status}, {own and own[:4]} and {other and other[:4]}: {said}", ()
    step = own[3]
    apart = [max(abs(a - b) for a, b in zip(own[4][i:i + step], other[4][i:i + step]))
             for i in range(0, len(own[4]), step)]
    beyond = sum(far > CODE_BAR for far in apart)
    words = (f"{own[1]} by {own[2]}, {beyond} of {len(apart)} pixels differ by more than {CODE_BAR} code; "
             f"{seconds:.2f} s, POV-Ray {other_seconds:.2f} s")
    times = f"{other_seconds / max(seconds, 0.001):.0f}"
    cells = (f"{own[1]} x {own[2]}", f"{beyond}", f"{seconds:.3f}", f"{other_seconds:.2f}", times)
    return beyond <= pictures.TIE_SHARE * len(apart), words, cells


def lacks(program):
    if not pictures.povray():
        return "povray"
    if program == "python3-ase":
        return None if os.path.isdir("/usr/lib/python3/dist-packages/ase") else program
    return None if program == "none" or shutil.which(program) else program


def cases():
    for name, words, picture in RECORDED:
        yield name + ": its words", "none", ["povray", *words], picture
    yield ("ASE: render()", "python3-ase", ["/usr/bin/python3", "make_ase.py"], "atoms.png")
    yield ("Jmol: write POVRAY", "jmol", ["sh", "-c", JMOL], "molecule.pov.png")
    yield ("Open Babel: its scene", "obabel", ["sh", "-c", OPEN_BABEL], "babel.png")
    yield ("PyMOL: ray renderer=1", "pymol", ["pymol", "-cq", "pymol.pml"], "pymol.png")


def write_table(rows):
    head = ("| caller | picture | pixels apart | rtlang, s | POV-Ray, s | ratio |\n|---|---|---|---|---|---|\n")
    documents.write(DOCUMENT, "callers", head + "".join("| " + " | ".join(row) + " |\n" for row in rows))


def main():
    number = failed = 0
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        places = [os.path.join(folder, name) for name in ("rtlang", "povray")]
        for place, program in zip(places, (check_place.PROGRAM, pictures.povray() or "none")):
            put_povray(place, program)
        for number, (name, program, words, picture) in enumerate(cases(), 1):
            if lacks(program):
                print(f"ok {number} - {name} # SKIP {lacks(program)} is not installed", flush=True)
                continue
            passed, told, cells = verdict(both(words, picture, places))
            rows.append((name, *cells))
            failed += not passed
            print(f"{'ok' if passed else 'not ok'} {number} - {name}: {re.sub('#', '', told)}", flush=True)
    print(f"1..{number}")
    if WRITES and not failed:
        write_table(rows)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
