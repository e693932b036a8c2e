#!/usr/bin/env python3
"""The program as its users meet it: command line, bad input, files, threads, memory, interruption.

Messages are compared in full with tests/system/expected/NAME.txt; UPDATE_EXPECTED=1 rewrites those. Runs in a folder of its
own. Environment: RTLANG, top_srcdir. Prints TAP.
SPDX-License-Identifier: MIT
"""
import hashlib
import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time

TOP = os.path.abspath(os.environ.get("top_srcdir", "."))
RTLANG = os.path.abspath(os.environ.get("RTLANG", "./rtlang"))
EXPECTED = os.path.join(TOP, "tests/system/expected")
BALL = "camera { location <0, 0, -4> look_at 0 }\nlight_source { <-5, 8, -9>, rgb 1 }\nsphere { 0, 1 pigment { rgb 1 } }\n"
HEAD = "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
counted = {"run": 0, "failed": 0}


def report(fine, name, more=""):
    counted["run"] += 1
    counted["failed"] += not fine
    print(f"{'' if fine else 'not '}ok {counted['run']} - {name}")
    for line in more.splitlines() if not fine else []:
        print("#   " + line)
    sys.stdout.flush()


def write(name, text):
    with open(name, "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())


def read(name):
    with open(name, "rb") as file:
        return file.read()


def run(*arguments, **options):
    return subprocess.run([RTLANG, *arguments], stdin=subprocess.DEVNULL, capture_output=True, timeout=120, check=False,
                          **options)


# ---- faults: scene text (or None), arguments, exit code; the message is in expected/NAME.txt

FAULTS = {
    "unclosed_brace": ("sphere { <0,0,0>, 1\n  pigment { rgb 1 }\n", [], 1),
    "unclosed_if": ("#if (1)\nsphere { 0, 1 }\n", [], 1),
    "unknown_word": ("sphere { 0, 1 pigmnt { rgb 1 } }\nspere { 0, 1 }\nsphere { 0, 1 finish { difuse 1 } }\n", [], 1),
    "wrong_type": ('sphere { "a", 1 }\nsphere { 0, <1, 2, 3> }\ncamera { location "here" }\n', [], 1),
    "missing_camera": (HEAD + "light_source { y, rgb 1 }\nsphere { 5*z, 1 }\n", ["-q"], 0),
    "empty_file": ("", ["-q"], 0),
    "binary_file": (b"\x7fELF\x02\x01\x01\x00" + bytes(range(256)), [], 1),
    "missing_include": ('#include "nowhere.inc"\nsphere { Where, 1 }\n', [], 3),
    "include_loop": ('#include "include_loop.scn"\n', [], 4),
    "endless_macro": ("#macro Deeper(N)\n  Deeper(N + 1)\n#end\nDeeper(0)\n", [], 4),
    "endless_loop": ("#while (1)\n#end\n", [], 4),
    "not_supported": ("torus { 1, 0.2 }\nsphere { 0, 1 pigment { checker } }\n", [], 1),
    "not_finite": ("#declare A = 1e308 * 10;\nsphere { <A, 0, 0>, 1 }\n", [], 1),
    "many_faults": ("\n".join(f"sphere {{ Name_{i}, 1 }}" for i in range(30)) + "\n", [], 1),
    "error_directive": ('#error "stop here"\n', [], 1),
    "messages": ('#debug "one\\n"\n#warning "two"\n#debug "three\\n"\n' + HEAD.split("\n")[1] + "\n" + BALL, ["-q"], 0),
    "no_such_file": (None, ["no_such_file.scn"], 3),
    "a_directory": (None, ["."], 3),
    "unreadable": (None, ["/proc/self/mem"], 3),
    "no_scene": (None, [], 2),
    "two_scenes": (None, ["a.scn", "b.scn"], 2),
    "unknown_option": (None, ["--colour", "a.scn"], 2),
    "missing_argument": (None, ["ball.scn", "--width"], 2),
    "bad_width": (None, ["-W", "0", "ball.scn"], 2),
    "bad_depth": (None, ["--depth=12", "ball.scn"], 2),
    "bad_declare": (None, ["-D", "sphere=1", "ball.scn"], 2),
    "output_folder_missing": (None, ["-o", "nowhere/x.png", "ball.scn"], 3),
    "output_unknown_format": (None, ["-o", "x.foo", "ball.scn"], 2),
    "output_depth": (None, ["-o", "x.jpg", "--depth=16", "ball.scn"], 2),
}


def same_message(name, got):
    path = os.path.join(EXPECTED, name + ".txt")
    # What OpenImageIO says of a format is its own, and absent without it.
    got = re.sub(r"(no picture format).*", r"\1", got)
    # Shipped include files are looked for where the program is; that folder is not always there.
    got = re.sub(r", `[^`]*share/rtlang`", "", got)
    if os.environ.get("UPDATE_EXPECTED"):
        os.makedirs(EXPECTED, exist_ok=True)
        write(path, got)
    expected = read(path).decode() if os.path.exists(path) else "(no such file)"
    return got == expected, f"expected:\n{expected}got:\n{got}"


def test_faults():
    for name, (text, arguments, code) in FAULTS.items():
        if text is not None:
            write(name + ".scn", text)
            arguments = arguments + [name + ".scn"]
        done = run(*arguments)
        same, more = same_message(name, done.stderr.decode(errors="replace"))
        report(same and done.returncode == code, f"{name}: message and exit code {code}",
               more + f"exit code {done.returncode}\n")
        if code:
            report(not os.path.exists(name + ".png"), f"{name}: no picture is written")


# ---- what happens to an existing picture

def test_old_picture_stays():
    write("old.png", "old")
    write("fault.scn", "sphere { 0, -1 }\n")
    done = run("-o", "old.png", "fault.scn")
    report(done.returncode == 1 and read("old.png") == b"old", "a fault in the scene leaves the old picture")
    for number, name in ((signal.SIGKILL, "SIGKILL"), (signal.SIGINT, "SIGINT")):
        before = set(os.listdir("."))
        process = subprocess.Popen([RTLANG, "-q", "-W", "8000", "-H", "8000", "-o", "old.png", "slow.scn"],
                                   stderr=subprocess.PIPE)
        time.sleep(0.7)
        process.send_signal(number)
        message = process.communicate(timeout=30)[1].decode()
        report(read("old.png") == b"old", f"{name} in the middle leaves the old picture")
        report(set(os.listdir(".")) == before, f"{name} in the middle leaves no other file")
        if number == signal.SIGINT:
            report(process.returncode == 130 and message == "rtlang: interrupted; nothing was written\n",
                   "SIGINT: exit code 130 and a word")
    with open("/dev/full", "wb") as full:
        done = subprocess.run([RTLANG, "-q", "-o", "-", "ball.scn"], stdout=full, stderr=subprocess.PIPE, check=False)
    report(done.returncode == 3 and b"E0505" in done.stderr, "a full disk on standard output is told")
    run("-q", "-o", "old.png", "ball.scn")
    report(read("old.png")[:4] == b"\x89PNG", "a run that succeeds replaces it")


# ---- outputs

def test_outputs():
    os.makedirs("folder", exist_ok=True)
    write("folder/deep.name.scn", HEAD + BALL)
    done = run("folder/deep.name.scn")
    report(done.returncode == 0 and os.path.exists("deep.name.png"), "default output: the scene's name, in the current folder")
    pattern = (rb"deep\.name\.png: 320x240, 1 object, 1 light; rays: 76800 camera, \d+ shadow, 0 reflected, 0 transmitted; "
               rb"seconds: parse \d+\.\d+, prepare \d+\.\d+, trace \d+\.\d+, write \d+\.\d+\n")
    report(re.fullmatch(pattern, done.stderr), "the summary is one line", done.stderr.decode())
    done = run("-q", "-o", "-", "ball.scn")
    run("-q", "-o", "ball.png", "ball.scn")
    report(done.stdout == read("ball.png") and done.stderr == b"", "-o - writes the same bytes to standard output, -q is quiet")
    run("-q", "-W", "31", "-H", "17", "-o", "small.png", "ball.scn")
    report(read("small.png")[16:24] == bytes([0, 0, 0, 31, 0, 0, 0, 17]), "-W and -H set the size")
    for depth in ("8", "16"):
        run("-q", f"--depth={depth}", "-o", "depth.png", "ball.scn")
        report(read("depth.png")[24] == int(depth), f"--depth={depth}")
    for gamma, chunk in (("srgb", b"sRGB"), ("1", b"gAMA\x00\x01\x86\xa0"), ("2.2", b"gAMA\x00\x00\xb1\x8f")):
        run("-q", f"--file-gamma={gamma}", "-o", "gamma.png", "ball.scn")
        report(chunk in read("gamma.png"), f"--file-gamma={gamma}")
    os.remove("ball.png")
    done = run("--check", "ball.scn")
    report(done.returncode == 0 and not os.path.exists("ball.png"), "--check writes nothing")
    done = run("-q", "-o", "ball.exr", "ball.scn")
    if done.returncode == 3 and b"E0507" in done.stderr:
        report(True, "EXR # SKIP built without OpenImageIO")
    else:
        report(done.returncode == 0 and read("ball.exr")[:4] == b"\x76\x2f\x31\x01", "an EXR, by the module",
               done.stderr.decode())


def test_same_bytes():
    for scene in ("10_sphere_flake", "05_glass_and_filters"):
        sums = set()
        for threads in ("1", "2", "7"):
            run("-q", "-t", threads, "-o", "threads.png", f"{TOP}/examples/{scene}.scn")
            sums.add(hashlib.sha256(read("threads.png")).hexdigest())
        report(len(sums) == 1, f"{scene}: the same bytes with 1, 2 and 7 threads")


# ---- names, paths, stages

def test_names_and_paths():
    os.makedirs("one", exist_ok=True)
    os.makedirs("two", exist_ok=True)
    write("one/who.inc", '#debug "one\\n"\n')
    write("two/who.inc", '#debug "two\\n"\n')
    write("names.scn", HEAD + '#include "who.inc"\n#debug concat(str(N, 0, 2), "\\n")\n')
    done = run("--check", "-D", "N=1.5", "-I", "two", "-Ione", "names.scn")
    report(done.stderr.startswith(b"two\n1.50\n"), "-D declares, -I is searched in order", done.stderr.decode())
    done = run("--check", "-DN=-2", "-D", "N=7", "-I", "one", "names.scn")
    report(done.stderr.startswith(b"one\n-2.00\n"), "of two -D of a name the first holds", done.stderr.decode())
    write("size.scn", HEAD + '#debug concat(str(image_width, 0, 0), "x", str(image_height, 0, 0), "\\n")\n')
    done = run("--check", "-W", "33", "-H", "44", "size.scn")
    report(done.stderr.startswith(b"33x44\n"), "image_width and image_height")


def test_stages():
    done = run("--dump=tokens", "ball.scn")
    report(done.returncode == 0 and done.stdout.count(b"\n") > 30, "--dump=tokens: a line a token")
    for stage in ("ast", "scene"):
        first = run(f"--dump={stage}", "ball.scn").stdout
        write("again.scn", first)
        second = run(f"--dump={stage}", "again.scn").stdout
        report(len(first) > 50 and first == second, f"--dump={stage} is a scene that gives the same dump")
    done = run("--version")
    report(done.returncode == 0 and re.fullmatch(rb"rtlang \d+\.\d+\.\d+\n", done.stdout), "--version")
    done = run("--help")
    report(done.returncode == 0 and b"--include-path" in done.stdout and done.stderr == b"", "--help")


# ---- a terminal, and a large scene

def run_on_terminal(arguments):
    """What the program writes to a terminal as standard error."""
    master, slave = pty.openpty()
    process = subprocess.Popen([RTLANG, *arguments], stderr=slave, stdout=subprocess.DEVNULL)
    os.close(slave)
    text = b""
    while True:
        try:
            piece = os.read(master, 4096)
        except OSError:
            break
        if not piece:
            break
        text += piece
    process.wait(timeout=60)
    os.close(master)
    return text


def test_progress():
    arguments = ["-W", "3000", "-H", "3000", "-t", "1", "-o", "slow.png", "slow.scn"]
    text = run_on_terminal(arguments)
    report(b"s left" in text and b"[#" in text, "a progress bar with the time left, on a terminal")
    report(b"s left" not in run_on_terminal(["-q", *arguments]), "none with -q")
    report(b"s left" not in run(*arguments).stderr, "none in a pipe")
    report(b"s left" not in run_on_terminal(["-o", "x.png", "ball.scn"]), "none in a short run")


def write_million(name):
    with open(name, "w", encoding="ascii") as file:
        file.write(HEAD + "camera { location <0, 0, -30> look_at 0 }\nlight_source { <-20, 30, -40>, rgb 1 }\n")
        state = 1
        for start in range(0, 1000000, 1000):
            lines = []
            for _ in range(start, start + 1000):
                state = (state * 6364136223846793005 + 1442695040888963407) & (1 << 64) - 1
                x, y, z = (state >> 11) % 20011, (state >> 24) % 20011, (state >> 37) % 20011
                lines.append(f"sphere {{ <{x / 1000 - 10:.6f}, {y / 1000 - 10:.6f}, {z / 1000 - 10:.6f}>, 0.0{state % 9 + 1}000 "
                             f"pigment {{ color rgb <0.{x % 10}, 0.{y % 10}, 0.{z % 10}> }} "
                             "finish { ambient 0.10 diffuse 0.70 phong 0.30 } }\n")
            file.write("".join(lines))


def test_million():
    write_million("million.scn")
    size = os.path.getsize("million.scn")
    process = subprocess.Popen([RTLANG, "-q", "-o", "million.png", "million.scn"])
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    megabytes = usage.ru_maxrss / 1000
    report(process.returncode == 0 and megabytes < 400 and size > 120e6,
           f"a million spheres, {size / 1e6:.0f} MB of text: peak memory {megabytes:.0f} MB is under 400 MB")
    os.remove("million.scn")


def main():
    with tempfile.TemporaryDirectory(prefix="rtlang-system-") as folder:
        os.chdir(folder)
        write("ball.scn", HEAD + BALL)
        write("slow.scn", HEAD + BALL + "sphere { <1.2, 0, 0>, 0.5 finish { reflection 0.9 } }\n" +
              "plane { y, -1 finish { reflection 0.5 } pigment { rgb 1 } }\n")
        for test in (test_faults, test_old_picture_stays, test_outputs, test_same_bytes, test_names_and_paths, test_stages,
                     test_progress, test_million):
            test()
        os.chdir(TOP)
    print(f"1..{counted['run']}")
    return 1 if counted["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
