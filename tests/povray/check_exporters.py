#!/usr/bin/env python3
"""Molecules written by Open Babel and PyMOL on this machine, given unchanged to rtlang and to POV-Ray.

Either the pictures agree, or rtlang refuses the file with a located message that names what it lacks; the line says which.
Prints TAP. SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402

# Codes that say: this is of the language, but rtlang has it not.
LACKS = re.compile(r"^[^\s:]+:\d+:\d+: error\[(E0109|E0210|E0251|E0252)\]: (.*)$", re.MULTILINE)
PHENOL, ETHANE = "c1ccccc1O", "CC"
# PyMOL's launcher takes the first python3 it finds, and only Debian's own has its modules.
SYSTEM_FIRST = dict(os.environ, PATH="/usr/bin:/bin:" + os.environ.get("PATH", ""))


def call(arguments, folder):
    subprocess.run(arguments, cwd=folder, env=SYSTEM_FIRST, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                   stderr=subprocess.STDOUT, timeout=120, check=True)


def from_openbabel(smiles, model):
    def make(folder):
        call(["obabel", "-:" + smiles, "--gen3d", "-opov", "-xm", model, "-O", "molecule.pov"], folder)
    return make


def from_openbabel_atoms(smiles):
    """The same file, cut before the first block that a directive tears apart, with its atoms placed one by one."""
    def make(folder):
        from_openbabel(smiles, "SPF")(folder)
        path = os.path.join(folder, "molecule.pov")
        head = open(path, encoding="utf-8").read().split("//Povray-description of bonds")[0]
        atoms = re.findall(r"#declare (mol_0_atom\d+) =", head)
        with open(path, "w", encoding="utf-8") as out:
            out.write(head + "".join(f"object {{ {atom} }}\n" for atom in atoms))
    return make


def from_pymol(commands):
    def make(folder):
        with open(os.path.join(folder, "make.pml"), "w", encoding="utf-8") as script:
            script.write("\n".join([*commands, "save molecule.pov", ""]))
        call(["pymol", "-cq", "make.pml"], folder)
    return make


# name, the program that it needs, how it is made, whether rtlang must draw it
CASES = [
    ("Open Babel, phenol, space-filling", "obabel", from_openbabel(PHENOL, "SPF"), False),
    ("Open Babel, ethane, ball and stick", "obabel", from_openbabel(ETHANE, "BAS"), False),
    ("Open Babel, phenol, its atoms placed one by one", "obabel", from_openbabel_atoms(PHENOL), True),
    ("PyMOL, benzene, spheres", "pymol", from_pymol(["fragment benzene", "hide everything", "show spheres"]), True),
    ("PyMOL, peptide of five residues, spheres", "pymol",
     from_pymol(["fab AWGKF", "hide everything", "show spheres", "orient"]), True),
    ("PyMOL, benzene, half transparent spheres", "pymol",
     from_pymol(["fragment benzene", "hide everything", "show spheres", "set sphere_transparency, 0.5"]), False),
    ("PyMOL, benzene, sticks", "pymol", from_pymol(["fragment benzene", "hide everything", "show sticks"]), False),
]


def check(make, must_draw, folders):
    """(passed, what happened, more lines)."""
    with tempfile.TemporaryDirectory() as folder:
        make(folder)
        scene = os.path.join(folder, "molecule.pov")
        try:
            met, words = pictures.verdict(*pictures.compare_programs(scene, folder, folders))
            return met, "drawn, " + words, []
        except pictures.RunFailed as failure:
            lacking = LACKS.search(failure.text.replace(folder + "/", ""))
            if failure.status == 1 and lacking and not must_draw:
                return True, f"refused, {lacking.group(0).split(': error')[0]}: {lacking.group(2)}", []
            return False, str(failure), failure.text.splitlines()


def main():
    print(f"1..{len(CASES)}")
    folders = pictures.include_folders() + glob.glob("/usr/share/openbabel/*/")
    failed = 0
    for number, (name, program, make, must_draw) in enumerate(CASES, 1):
        missing = program if not shutil.which(program) else None if pictures.povray() else "povray"
        if missing:
            print(f"ok {number} - {name} # SKIP no {missing} here")
            continue
        passed, words, more = check(make, must_draw, folders)
        failed += not passed
        # A bare `#` would begin a directive of TAP.
        print(f"{'ok' if passed else 'not ok'} {number} - {name}: {words}".replace("#", "\\#"))
        for line in more:
            print("# " + line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
