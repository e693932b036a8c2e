#!/usr/bin/env python3
"""Molecules written by Open Babel, PyMOL, Jmol and ASE on this machine, given unchanged to rtlang and to POV-Ray.

rtlang finds what they include by itself. OVITO is not run: a scene has the form of its files.

Each case stands in one table with what is expected of it: DRAWN, where the pictures agree and both programs count the
same objects and lights, or the first thing that rtlang says it lacks. A case that got better fails: tighten the table.
Prints TAP. SPDX-License-Identifier: MIT
"""
import concurrent.futures
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402
from picture_bytes import png_without_texts  # noqa: E402
import survey  # noqa: E402

PHENOL, ETHANE = "c1ccccc1O", "CC"
# PyMOL's launcher takes the first python3 it finds, and only Debian's own has its modules and ASE's.
SYSTEM_FIRST = dict(os.environ, PATH="/usr/bin:/bin:" + os.environ.get("PATH", ""))
JMOL = "/usr/share/java/JmolData.jar"  # Jmol without its windows
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
DRAWN = "drawn"
# In the form of OVITO's files: macros for each kind of particle, one of transforms.inc called inside the camera, a
# parallel light without shadows, colours with transmission.
OVITO = """#version 3.5;
#include "transforms.inc"
global_settings { assumed_gamma 2.2 max_trace_level 20 }
background { color rgb <0.9, 0.95, 1> }
camera {
  perspective
  location <0, 0, 0>
  direction <0, 0, 1>
  right <1.3333333, 0, 0>
  up <0, 1, 0>
  angle 40
  Matrix_Trans(<-0.8320503, 0.5547002, 0>, <0.1943058, 0.2914587, 0.9366291>, <0.5195524, 0.7793285, -0.3502971>,
               <-6, -9, 5>)
}
light_source {
  <0, 0, 0>
  color rgb <0.9, 0.9, 0.9>
  parallel
  shadowless
  point_at <1, 2, -3>
}
#macro SPRTCLE(pos, particleRadius, particleColor)
sphere { pos, particleRadius texture { pigment { color particleColor } } }
#end
#macro DPRTCLE(pos, particleRadius, particleColor)
disc { pos, <-0.52, -0.78, 0.35>, particleRadius texture { pigment { color particleColor } } }
#end
#macro CPRTCLE(pos, halfLength, particleColor)
box { pos - halfLength, pos + halfLength texture { pigment { color particleColor } } }
#end
#macro SQPRTCLE(corner, sideA, sideB, particleColor)
triangle { corner, corner + sideA, corner + sideA + sideB texture { pigment { color particleColor } } }
triangle { corner, corner + sideA + sideB, corner + sideB texture { pigment { color particleColor } } }
#end
#macro CYL(base, dir, cylRadius, cylColor)
cylinder { base, base + dir, cylRadius texture { pigment { color cylColor } } }
#end
#declare Turned = transform { Rotate_Around_Trans(<0, 0, 30>, <1, 1, 0>) }
union {
CYL(<-1.5, -1.5, 0>, <3, 0, 0>, 0.05, rgb <0.1, 0.1, 0.1>)
CYL(<-1.5, -1.5, 0>, <0, 3, 0>, 0.05, rgb <0.1, 0.1, 0.1>)
}
SPRTCLE(<0, 0, 0>, 0.8, rgbt <1, 0.4, 0.4, 0>)
SPRTCLE(<1.4, 0.3, 0.2>, 0.6, rgbt <0.4, 0.4, 1, 0.5>)
SPRTCLE(vtransform(<0.2, 1.4, 0.5>, transform { Turned }), 0.5, rgbt <0.4, 1, 0.4, 0>)
DPRTCLE(<-1.2, 0.9, 0.4>, 0.5, rgbt <1, 1, 0.2, 0>)
CPRTCLE(<0.4, -1.3, 0.2>, <0.4, 0.3, 0.4>, rgbt <0.6, 0.3, 0.8, 0.2>)
SQPRTCLE(<-2, -1.2, -0.3>, <0.9, 0, 0.3>, <0, 0.8, 0.2>, rgbt <0.2, 0.8, 0.9, 0>)
"""
# The size of the pictures; the larger one takes too long for every day.
WIDTH, HEIGHT = (640, 480) if "EXPORTERS_LONG" in os.environ else (320, 240)


def call(arguments, folder):
    subprocess.run(arguments, cwd=folder, env=SYSTEM_FIRST, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                   stderr=subprocess.STDOUT, timeout=120, check=True)


def write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as out:
        out.write(text)


def from_openbabel(smiles, model):
    def make(folder):
        call(["obabel", "-:" + smiles, "--gen3d", "-opov", "-xm", model, "-O", "molecule.pov"], folder)
    return make


def from_openbabel_atoms(smiles):
    """The same file, cut before the first block that a directive tears apart, with its atoms placed one by one."""
    def make(folder):
        from_openbabel(smiles, "SPF")(folder)
        head = open(os.path.join(folder, "molecule.pov"), encoding="utf-8").read()
        head = head.split("//Povray-description of bonds")[0]
        atoms = re.findall(r"#declare (mol_0_atom\d+) =", head)
        write(folder, "molecule.pov", head + "".join(f"object {{ {atom} }}\n" for atom in atoms))
    return make


def from_pymol(*commands):
    def make(folder):
        write(folder, "make.pml", "\n".join([*commands, "save molecule.pov", ""]))
        call(["pymol", "-cq", "make.pml"], folder)
    return make


def from_jmol(*commands):
    def make(folder):
        write(folder, "ethanol.xyz", ETHANOL)
        write(folder, "make.spt", "\n".join(["load ethanol.xyz;", *commands, 'write POVRAY "molecule.pov";', ""]))
        call(["java", "-Djava.awt.headless=true", "-Xmx512m", "-cp", JMOL, "org.openscience.jmol.app.JmolData",
              "-o", "-x", "-g320x240", "-s", "make.spt"], folder)
    return make


def from_ase(atoms, settings, more=""):
    def make(folder):
        write(folder, "make.py", f"""from ase.build import bulk, molecule
from ase.io import write
atoms = {atoms}
write("molecule.pov", atoms, {more} povray_settings=dict({settings}))
""")
        call(["/usr/bin/python3", "make.py"], folder)
    return make


def written(text):
    return lambda folder: write(folder, "molecule.pov", text)


def lacks(program):
    """What is missing for a case, or None."""
    if not pictures.povray():
        return "povray"
    if program == "none":
        return None
    if program == "jmol":
        return None if os.path.exists(JMOL) and shutil.which("java") else "jmol"
    if program == "python3-ase":
        there = glob.glob("/usr/lib/python3/dist-packages/ase") and os.path.exists("/usr/bin/python3")
        return None if there else "python3-ase"
    return None if shutil.which(program) else program


POINT_LIGHT = "area_light=None, point_lights=[[(2.0, 3.0, 40.0), 'White']]"
# name, the program that it needs, how it is made, what is expected
CASES = [
    ("Open Babel, phenol, space-filling", "obabel", from_openbabel(PHENOL, "SPF"), DRAWN),
    ("Open Babel, ethane, ball and stick", "obabel", from_openbabel(ETHANE, "BAS"), DRAWN),
    ("Open Babel, phenol, its atoms placed one by one", "obabel", from_openbabel_atoms(PHENOL), DRAWN),
    ("PyMOL, benzene, spheres", "pymol", from_pymol("fragment benzene", "hide everything", "show spheres"), DRAWN),
    ("PyMOL, peptide of five residues, spheres", "pymol",
     from_pymol("fab AWGKF", "hide everything", "show spheres", "orient"), DRAWN),
    ("PyMOL, benzene, half transparent spheres", "pymol",
     from_pymol("fragment benzene", "hide everything", "show spheres", "set sphere_transparency, 0.5"), DRAWN),
    ("PyMOL, benzene, sticks", "pymol",
     from_pymol("fragment benzene", "hide everything", "show sticks"), DRAWN),
    ("PyMOL, peptide of five residues, surface", "pymol",
     from_pymol("fab AWGKF", "hide everything", "show surface", "set surface_quality, -1", "orient"), DRAWN),
    ("PyMOL, a helix, cartoon", "pymol",
     from_pymol("fab AAAAKAAAAK, ss=1", "hide everything", "show cartoon", "spectrum count", "orient"), DRAWN),
    ("Jmol, ethanol, space-filling", "jmol", from_jmol("spacefill on; wireframe off;"), DRAWN),
    ("Jmol, ethanol, ball and stick", "jmol", from_jmol(), DRAWN),
    ("OVITO's form, particles of all kinds", "none", written(OVITO), DRAWN),
    ("ASE, benzene, a point light", "python3-ase",
     from_ase("molecule('C6H6')", POINT_LIGHT, "show_unit_cell=0, rotation='30x,20y',"), DRAWN),
    ("ASE, salt, perspective, transparent ions, a finish each", "python3-ase",
     from_ase("bulk('NaCl', 'rocksalt', a=5.64, cubic=True) * (2, 2, 2)", POINT_LIGHT +
              ", camera_type='perspective', textures=['ase3', 'glass', 'jmol', 'simple'] * 16,"
              " transmittances=[0.0, 0.3] * 32", "show_unit_cell=0,"), DRAWN),
    ("ASE, benzene, its own area light", "python3-ase",
     from_ase("molecule('C6H6')", "", "show_unit_cell=0,"), DRAWN),
    ("ASE, copper and its cell", "python3-ase", from_ase("bulk('Cu') * (3, 3, 3)", POINT_LIGHT, "show_unit_cell=2,"),
     DRAWN),
]


def refusal(scene):
    """`CODE construct` of rtlang's first fault in the scene, with its place; None when it is accepted."""
    done = subprocess.run([os.environ["RTLANG"], "--check", "-q", "--diagnostics=json", os.path.basename(scene)],
                          cwd=os.path.dirname(scene), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, timeout=300,
                          check=False)
    for line in done.stderr.decode("utf-8", "replace").splitlines():
        record = json.loads(line)
        if record.get("severity") == "error":
            return f"{record['code']} {survey.construct(record)}", f"{record['line']}:{record['column']}"
    return (None, None) if done.returncode == 0 else (f"exit code {done.returncode}", "")


def counts(scene, folders):
    """((objects, lights) as rtlang counts them, as POV-Ray does)."""
    folder = os.path.dirname(scene)
    small = {"cwd": folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "timeout": 300}
    ours = pictures.call([os.environ["RTLANG"], "-W4", "-H4", "-oours.png", scene], **small)
    theirs = pictures.call([pictures.povray(), f"+I{scene}", "-F", "+W4", "+H4", "-D",
                            *(f"+L{place}" for place in folders)], **small)
    ours.check_returncode()
    theirs.check_returncode()
    summary = re.search(r"(\d+) objects?, (\d+) lights?", ours.stderr.decode("utf-8", "replace"))
    told = {name: int(number) for name, number in
            re.findall(r"^(Finite Objects|Infinite Objects|Light Sources): +(\d+)",
                       theirs.stderr.decode("utf-8", "replace"), re.MULTILINE)}
    return ((int(summary.group(1)), int(summary.group(2))),
            (told["Finite Objects"] + told["Infinite Objects"], told["Light Sources"]))


def pixels(path):
    """A PNG's bytes without what it says of its scene and the files that it includes."""
    with open(path, "rb") as file:
        return png_without_texts(file.read())


def is_same_without_povray(scene, picture):
    """Whether rtlang's own include files give the same pixels, where the scene needs no others."""
    with open(scene, encoding="utf-8") as file:
        if "babel_povray" in file.read():
            return True
    other = picture + ".own.png"
    pictures.render_rtlang(scene, other, [], WIDTH, HEIGHT, ["--no-povray-includes"])
    return pixels(picture) == pixels(other)


def check(make, expected, folders):
    """(passed, what happened, more lines). The folders are for POV-Ray, which does not know where Open Babel's is."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            make(folder)
            scene = os.path.join(folder, "molecule.pov")
            blocker, place = refusal(scene)
            if blocker:
                return blocker == expected, f"refused at {place}: {blocker}; expected: {expected}", []
            picture, other = os.path.join(folder, "rtlang.png"), os.path.join(folder, "povray.png")
            pictures.render_rtlang(scene, picture, [], WIDTH, HEIGHT)
            pictures.render_povray(scene, other, folders, WIDTH, HEIGHT)
            met, words = pictures.verdict(*pictures.compare(picture, other))
            if not is_same_without_povray(scene, picture):
                return False, "another picture where POV-Ray is not installed", []
            ours, theirs = counts(scene, folders)
            told = f"drawn, {words}, {ours[0]} objects and {ours[1]} lights, POV-Ray {theirs[0]} and {theirs[1]}"
            return met and ours == theirs and expected == DRAWN, f"{told}; expected: {expected}", []
        except pictures.RunFailed as failure:
            return False, str(failure), failure.text.splitlines()
        except subprocess.CalledProcessError as failure:
            text = (failure.stdout or b"") + (failure.stderr or b"")
            return False, str(failure), text.decode("utf-8", "replace").splitlines()[-10:]


def main():
    print(f"1..{len(CASES)}")
    folders = glob.glob("/usr/share/openbabel/*/")
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda case: None if lacks(case[1]) else check(*case[2:], folders), CASES)
        for number, ((name, program, *_), result) in enumerate(zip(CASES, results), 1):
            if result is None:
                print(f"ok {number} - {name} # SKIP {lacks(program)} is not installed")
                continue
            passed, words, more = result
            failed += not passed
            # A bare `#` would begin a directive of TAP.
            print(f"{'ok' if passed else 'not ok'} {number} - {name}: {words}".replace("#", "\\#"), flush=True)
            for line in more:
                print("# " + line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
