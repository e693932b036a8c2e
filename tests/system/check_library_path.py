#!/usr/bin/env python3
"""Which folders are searched without being named, in which order, and that a scene reads nothing beyond them.

The lines of povray.ini are also given to POV-Ray where it is installed, which must find the same files by them. Prints
TAP. SPDX-License-Identifier: MIT
"""
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
from tap import Tap  # noqa: E402

tap = Tap()
RTLANG = os.path.abspath(os.environ["RTLANG"])
POVRAY = os.environ.get("POVRAY") or shutil.which("povray")
BODY = "sphere { 0, 1 pigment { rgb 1 } }\n"
# Texts of povray.ini, with the folder's name for `%`, and whether its files are found by them.
INI = [
    ("a line Library_Path", "Library_Path=%\n", True),
    ("blanks and a comment", "  library_path = %  ; more\n", True),
    ("quotes", 'Library_Path="%"\n', True),
    ("quotes of the other kind", "Library_Path='%'\n", True),
    ("a semicolon before it", ";Library_Path=%\n", False),
    ("a switch", "+L%\n", True),
    ("a small switch between others", '-D +l"%" +W4 +H4\n', True),
    ("a line without a newline", "Width=4\nLibrary_Path=%", True),
    ("lines that end as on Windows", "Width=4\r\nLibrary_Path=%\r\n", True),
    ("the second of two folders", "Library_Path=/usr\nLibrary_Path=%\n", True),
    ("after a label", "Width=4\n[low]\nLibrary_Path=%\n", False),
    ("another word", "Library_Paths=%\n", None),  # POV-Ray does not start with it
    ("nothing", "", False),
]


def write(path, text):
    with open(path, "w", encoding="ascii") as file:
        file.write(text)


def run(program, *arguments, **environment):
    return subprocess.run([program, *arguments], env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120, check=False)


def reads(scene, *arguments, **environment):
    """(exit code, what is said) of a scene that is only read."""
    write("scene.scn", scene + BODY)
    done = run(RTLANG, "-q", "--check", *arguments, "scene.scn", **environment)
    return done.returncode, done.stdout.decode("utf-8", "replace")


def is_found(scene, name, *arguments, **environment):
    """Whether #debug of the file of that name is heard."""
    return f"{name} is read" in reads(scene, *arguments, **environment)[1]


def test_ini(folder):
    include = '#if (file_exists("mine.inc")) #include "mine.inc" #end\n'
    for name, text, wanted in INI:
        write("our.ini", text.replace("%", folder))
        found = is_found(include, "mine", POVINI=os.path.abspath("our.ini"))
        tap.equal(found, bool(wanted), "povray.ini: " + name)
        if not POVRAY or wanted is None:
            continue
        done = run(POVRAY, "+Iscene.scn", "-F", "-D", "+W4", "+H4", POVINI=os.path.abspath("our.ini"))
        tap.equal((done.returncode, b"mine is read" in done.stdout), (0, wanted), "POV-Ray does the same: " + name)
    if not POVRAY:
        tap.skip("POV-Ray does the same", "no povray here")


def test_places(folder):
    include, empty = '#include "mine.inc"\n', os.path.abspath("empty.ini")
    write(empty, "")
    os.makedirs("home/.povray/3.7")
    write("home/.povray/3.7/povray.ini", f"Library_Path={folder}\n")
    home = {"HOME": os.path.abspath("home"), "POVINI": ""}
    tap.ok(is_found(include, "mine", **home), "the povray.ini in the home folder")
    tap.ok(not is_found(include, "mine", "--no-povray-includes", **home), "not with --no-povray-includes")
    tap.ok(not is_found(include, "mine", **{**home, "POVINI": empty}), "$POVINI is read instead of it")
    tap.ok(not is_found(include, "mine", **{**home, "POVINI": "nowhere.ini"}), "also when it is not there")
    write("povray.ini", f"Library_Path={folder}\n")
    status, said = reads(include, POVINI="", HOME=os.path.abspath("nowhere"))
    tap.ok(status == 3 and "E0501" in said and folder not in said, "one that came with the scene is not", said)
    status, said = reads(f'#include "{folder}/mine.inc"\n', POVINI="", HOME=os.path.abspath("nowhere"))
    tap.ok(status == 3 and "E0508" in said, "nor does it allow anything", said)


def test_order(folder):
    write("our.ini", f"Library_Path={folder}\n")
    mine = {"POVINI": os.path.abspath("our.ini")}
    include = '#include "colors.inc"\n'
    os.mkdir("given")
    tap.ok(not is_found(include, "theirs", **mine), "rtlang's own file comes before that of the library path")
    write("given/colors.inc", '#debug "given is read\\n"\n')
    tap.ok(is_found(include, "given", "-I", "given", **mine), "a folder of -I before both")
    write("colors.inc", '#debug "here is read\\n"\n')
    tap.ok(is_found(include, "here", "-I", "given", **mine), "the current folder before all")


def test_reading(folder, outside):
    write("our.ini", f"Library_Path={folder}\n")
    mine = {"POVINI": os.path.abspath("our.ini")}
    tap.ok(is_found(f'#include "{folder}/mine.inc"\n', "mine", **mine), "a whole path into the library path")
    for name, path in (("beside the library path", f"{outside}/secret.inc"), ("a link out of it", "link.inc"),
                       ("up out of it", f"{folder}/../outside/secret.inc"), ("a system's file", "/etc/passwd")):
        status, said = reads(f'#include "{path}"\n', **mine)
        fine = status == 3 and "error[E0508]" in said and "secret is read" not in said
        tap.ok(fine, "may not be read: " + name, said)


def main():
    with tempfile.TemporaryDirectory() as made:
        top = os.path.realpath(made)
        folder, outside = os.path.join(top, "library"), os.path.join(top, "outside")
        for path in (folder, outside, os.path.join(top, "scene")):
            os.mkdir(path)
        write(os.path.join(folder, "mine.inc"), '#debug "mine is read\\n"\n')
        write(os.path.join(folder, "colors.inc"), '#debug "theirs is read\\n"\n')
        write(os.path.join(outside, "secret.inc"), '#debug "secret is read\\n"\n')
        os.symlink(os.path.join(outside, "secret.inc"), os.path.join(folder, "link.inc"))
        os.chdir(os.path.join(top, "scene"))
        test_ini(folder)
        test_places(folder)
        test_order(folder)
        test_reading(folder, outside)
        os.chdir("/")
    tap.done()


if __name__ == "__main__":
    main()
