#!/usr/bin/env python3
"""Pictures that ranks share over MPI: the bytes of one process, for any number of ranks, which tell who fails.

Without words all of it, in short, and with CHECK_LONG=1 at length; `kills N` kills a rank of N runs, at a random moment
each. Prints TAP. SPDX-License-Identifier: MIT
"""
import contextlib
import os
import random
import shutil
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tap  # noqa: E402
from check_share import APART, PROGRAM, SIZE, WHOLE, Place, reference  # noqa: E402

LONG = "CHECK_LONG" in os.environ
COUNTS = (1, 2, 3, 5, 8, 16) if LONG else (3,)
ENVIRONMENT = {"OMPI_MCA_btl": "self,vader,tcp", "OMPI_MCA_btl_base_warn_component_unused": "0",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_plm": "isolated",
               # Of a build with a sanitizer: MPI itself gives little back.
               "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"}


def ranks(count):
    return ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(count)]


def has_module():
    """Why there are no ranks, or an empty text."""
    if not shutil.which("mpirun"):
        return "no mpirun"
    place = Place()
    code, text = place.run(*SIZE, "--mpi", "-o", "x.png", "old.scn", before=ranks(1))
    place.close()
    # mpirun may say more before and after.
    reasons = [line for line in text.splitlines() if "built without it" in line or "no rtlang_mpi.so" in line]
    return reasons[0] if code != 0 and reasons else ""


def check_pictures(test, place):
    ways = APART + WHOLE if LONG else APART[1:3] + APART[6:7] + APART[9:] + WHOLE[:3]
    for scene, options, ending in ways:
        expected, _ = reference(place, scene, options, ending)
        for count in COUNTS:
            name = "ranks" + ending
            code, text = place.run(*SIZE, *options, "--mpi", "-t", str(random.choice([1, 1, 2])), "-o", name,
                                   scene + ".scn", before=ranks(count))
            test.ok(code == 0 and place.bytes(name) == expected,
                    "%s, %s: %d ranks" % (scene, " ".join(options) or "one ray", count), "exit %d\n%s" % (code, text))
            if place.bytes(name):
                os.unlink(os.path.join(place.path, name))


def check_read_one(test, place):
    """Of files that rank 0 alone finds: the others run in an empty folder."""
    with open(os.path.join(place.path, "more.inc"), "w", encoding="utf-8") as file:
        file.write("sphere { <0, 2, 0>, 0.5 pigment { marble scale 0.2 } normal { bumps 0.4 } }\n"
                   "difference { box { -0.4, 0.4 } sphere { 0, 0.5 } translate <-2, 1.5, 0> pigment { rgb x } }\n")
    with open(os.path.join(place.path, "rich.scn"), encoding="utf-8") as file:
        text = file.read()
    with open(os.path.join(place.path, "sent.scn"), "w", encoding="utf-8") as file:
        file.write(text + '#include "more.inc"\n#declare A = W0;\nsphere { <A, 1.5, 0>, 0.4 pigment { rgb y } }\n')
    empty = os.path.join(place.path, "empty")
    os.mkdir(empty)
    for options in ([], ["--samples=16"], ["--target-error=0.02"]):
        words = [*SIZE, "-D", "W0=2", *options]
        place.run(*words, "-o", "one.png", "sent.scn")
        command = ["mpirun", "--allow-run-as-root", "--oversubscribe"]
        for rank in range(3):
            command += [":"] * (rank > 0) + ["-n", "1", "--wdir", empty if rank else place.path, PROGRAM, *words, "--mpi",
                                             "--mpi-read=one", "-o", "sent.png", "sent.scn"]
        done = subprocess.run(command, cwd=place.path, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, timeout=120, check=False)
        test.ok(done.returncode == 0 and place.bytes("sent.png") == place.bytes("one.png") and not os.listdir(empty),
                "a scene that rank 0 alone has, %s" % (" ".join(options) or "one ray"), done.stderr.decode(errors="replace"))
    with open(os.path.join(place.path, "shown.scn"), "w", encoding="utf-8") as file:
        file.write('sphere { z * 3, 1 pigment { image_map { png "one.png" } } }\n')
    for words, code, expected in ((["shown.scn"], 2, "error[E0714]: a scene that shows `one.png` cannot be sent"),
                                  (["no.scn"], 3, "error[E0501]"),
                                  (["--frames=1..2", "rich.scn"], 2, "`--mpi-read=one` is for one picture")):
        found, text = place.run(*SIZE, "--mpi", "--mpi-read=one", *words, before=ranks(2))
        test.ok(found == code and expected in text, "--mpi-read=one: %s" % words[-1], "exit %d\n%s" % (found, text))


def check_error_map(test, place):
    words = [*SIZE, "--samples=16", "-o", "m.png", "rich.scn"]
    place.run(*words, "--error-map=one_map.png")
    code, text = place.run(*words, "--error-map=ranks_map.png", "--mpi", before=ranks(3))
    test.ok(code == 0 and place.bytes("one_map.png") == place.bytes("ranks_map.png"), "the map of errors", text)


def check_frames(test, place):
    words = [*SIZE, "--samples=2", "--frames=1..5", "rich.scn", "-o"]
    place.run(*words, "f.png")
    code, text = place.run(*words, "g.png", "--mpi", before=ranks(3))
    test.ok(code == 0 and all(place.bytes("f%d.png" % i) == place.bytes("g%d.png" % i) for i in range(1, 6)),
            "frames, dealt over three ranks", "exit %d\n%s" % (code, text))


def of_ranks(test, place, name, code, expected, *runs):
    """Ranks with words of their own: mpirun's form with colons."""
    words = ["mpirun", "--allow-run-as-root", "--oversubscribe"]
    for i, run in enumerate(runs):
        words += [":"] * (i > 0) + ["-n", "1", PROGRAM, *SIZE, "--mpi", *run]
    done = subprocess.run(words, cwd=place.path, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=120, check=False)
    text = done.stdout.decode(errors="replace")
    test.ok(done.returncode == code and expected in text, name, "exit %d\n%s" % (done.returncode, text))


def check_faults(test, place):
    of_ranks(test, place, "a rank with another scene", 2,
             "error[E0712]: rank 1 of 3 would draw another picture: the scene's text is another one\n",
             ["old.scn"], ["lens.scn"], ["old.scn"])
    of_ranks(test, place, "a rank with other options", 2,
             "error[E0712]: rank 2 of 3 would draw another picture: the options are others\n",
             ["old.scn"], ["old.scn"], ["old.scn", "--samples=4"])
    of_ranks(test, place, "a rank without the scene says so", 3, "rank 1: rtlang: error[E0501]: scene file `no.scn` not found",
             ["old.scn"], ["no.scn"])
    of_ranks(test, place, "and rank 0 says which", 3, "error[E0522]: rank 1 of 2 cannot draw the scene\n",
             ["old.scn"], ["no.scn"])
    code, text = place.run(*SIZE, "--mpi", "no.scn", before=ranks(3))
    test.ok(code == 3 and text.count("E0501") == 1, "what all ranks would say is said once", "exit %d\n%s" % (code, text))
    for words, expected in ((["--mpi", "--untrusted"], "`--mpi` is not for scenes of strangers"),
                            (["--mpi", "--part=1/2"], "`--mpi` is for drawing pictures, without `--part`"),
                            (["--mpi", "--method=forward"], "photons of `--method` cannot be shared or kept")):
        code, text = place.run(*words, "old.scn")
        test.ok(code == 2 and expected in text, "%s: refused" % " ".join(words), "exit %d\n%s" % (code, text))


def children_of(process):
    """The ranks of an mpirun."""
    found = []
    for entry in os.listdir("/proc"):
        try:
            with open("/proc/%s/stat" % entry, encoding="ascii", errors="replace") as file:
                fields = file.read().rsplit(")", 1)[1].split()
            if int(fields[1]) == process.pid:
                found.append(int(entry))
        except (OSError, ValueError, IndexError):
            pass
    return sorted(found)


def check_kills(test, place, count):
    """Runs of which a rank is killed at a random moment, and which are continued by another number of ranks."""
    scene, options, ending = "rich", ["--samples=24"], ".png"
    expected, seconds = reference(place, scene, options, ending)
    wrong, killed, named, texts = 0, 0, 0, ""
    for turn in range(count):
        if turn and turn % 10 == 0:
            print("# %d runs, %d killed, %d wrong" % (turn, killed, wrong), flush=True)
        for name in os.listdir(place.path):
            if name.startswith("killed"):
                os.unlink(os.path.join(place.path, name))
        words = [*SIZE, *options, "--mpi", "--checkpoint=0", "--resume", "-t", "1", "-o", "killed" + ending, scene + ".scn"]
        process = subprocess.Popen([*ranks(3), PROGRAM, *words], cwd=place.path, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(0.3 + random.uniform(0.0, 2.0) * seconds)
        victims = children_of(process)
        if victims:
            with contextlib.suppress(ProcessLookupError):  # it has ended by itself
                os.kill(random.choice(victims), signal.SIGKILL)
        text = process.communicate()[1].decode(errors="replace")
        killed += process.returncode != 0
        named += "rank" in text
        code, more = place.run(*words, before=ranks(random.choice([1, 2, 4])))
        if code or place.bytes("killed" + ending) != expected:
            wrong, texts = wrong + 1, texts + text + more
    test.ok(wrong == 0, "%d times a rank was killed, and others continued: the same pictures" % killed, texts)
    test.ok(named == killed, "a rank that dies ends the run with a message that names it", texts)


def run_checks(name, *checks):
    """Each check in one place, or a line that says why none can be made."""
    test = tap.Tap()
    os.environ.update(ENVIRONMENT)
    random.seed(int(os.environ.get("SEED", "1")))
    why = has_module()
    if why:
        test.skip(name, why)
    else:
        place = Place()
        for check in checks:
            check(test, place)
        place.close()
    test.done()


def main():
    if len(sys.argv) > 2 and sys.argv[1] == "kills":
        run_checks("ranks of MPI", lambda test, place: check_kills(test, place, int(sys.argv[2])))
    else:
        run_checks("ranks of MPI", check_pictures, check_read_one, check_error_map, check_frames, check_faults,
                   lambda test, place: check_kills(test, place, 100 if LONG else 2))


if __name__ == "__main__":
    main()
