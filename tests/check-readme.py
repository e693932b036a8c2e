#!/usr/bin/env python3
"""README.md as a new user takes it: its scene saved in an empty folder, then each of its commands but those that install.

What takes long is made short (films of two frames, a study of few seconds, a page that ends by itself), and where there is
no ffmpeg its film is thrown away; what needs POV-Ray or numpy is skipped without it. What a `console` block shows must be what is printed, but for seconds. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the folder is distributed as it is
TOP = os.path.abspath(os.environ.get("top_srcdir", "."))
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
from tap import Tap  # noqa: E402

BIN = os.path.dirname(os.path.abspath(os.environ["RTLANG"]))
SHORT = [(r"1\.\.100\b", "1..2"), (r"--study\b", "--study --budget=5"), (r"--watch\b", "--watch --max-time=1")]
ELSEWHERE = ["rtcheck --stability"]  # tests/system/check_stability.py runs it
if not shutil.which("ffmpeg"):
    SHORT.append((r"\| ffmpeg .*", ">/dev/null"))
NEEDS = {"rtcheck": "povray"}
tap = Tap()


def call(command, folder):
    environment = {**os.environ, "PATH": BIN + ":" + os.environ["PATH"], "PYTHONPATH": os.path.join(TOP, "python"),
                   "HOME": folder, "PYTHONDONTWRITEBYTECODE": "1"}
    if not os.path.samefile(BIN, TOP):  # built in the checkout, the package finds it
        environment["RTLANG_LIBRARY"] = os.path.join(BIN, ".libs", "librtlang.so")
    done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=300)
    return done.returncode, done.stdout.decode("utf-8", "replace")


def lacks(command):
    for word, program in NEEDS.items():
        if word in command and not shutil.which((os.environ.get("POVRAY") or program) if program == "povray" else program):
            return f"{program} is not installed"
    if "--watch" in command and not glob.glob(os.path.join(BIN, ".libs", "rtlang_http.*")):
        return "built without --watch"
    return None


def check_command(command, folder):
    lacking = "it takes minutes: make check-long" if any(command.startswith(each) for each in ELSEWHERE) else lacks(command)
    if lacking:
        tap.skip(command, lacking)
        return
    for long, short in SHORT:
        command = re.sub(long, short, command)
    code, text = call(command, folder)
    tap.ok(code == 0, command, f"exit code {code}\n{text}")


def main():
    with open(os.path.join(TOP, "README.md"), encoding="utf-8") as file:
        page = file.read()
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "scene.scn"), "w", encoding="ascii") as out:
            out.write(re.search(r"^```scn\n(.*?)^```$", page, re.MULTILINE | re.DOTALL).group(1))
        for block in re.findall(r"^```console\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
            command, _, shown = block.partition("\n")
            _, text = call(command[2:], folder)
            tap.equal(re.sub(r"(seconds:) .*", r"\1 ...", text), shown, command)
        for command in re.findall(r"^    ((?:rtlang|rtcheck) .*?)(?: +# .*)?$", page, re.MULTILINE):
            check_command(command, folder)
        tap.ok(os.path.exists(os.path.join(folder, "scene.png")), "there is a picture")
        with open(os.path.join(folder, "spheres.py"), "w", encoding="ascii") as out:
            out.write(re.search(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL).group(1))
        python = "/usr/bin/python3" if os.access("/usr/bin/python3", os.X_OK) else sys.executable
        if call(f"{python} -c 'import numpy'", folder)[0]:
            tap.skip("Python", "no numpy here")
        else:
            code, text = call(f"{python} spheres.py", folder)
            tap.ok(code == 0 and os.path.exists(os.path.join(folder, "spheres.png")), "Python", text)
    tap.done()


if __name__ == "__main__":
    main()
