#!/usr/bin/env python3
"""How long `rtlang --watch` takes from a save to the first picture, as a client of its page sees it.

Usage: watch.py [-n SAVES] [SCENE]...; by default 50 saves of each scene of examples/. A copy of the scene is written,
with another comment at its end each time; the clock runs from before the file is opened until the picture's bytes have been
read. Saves come at random moments, so that the program's looks at the file (twenty a second) are no help. Printed are
the median, the time that nine of ten saves keep, the longest, and what of the median is not the waiting for a look.
SPDX-License-Identifier: MIT
"""
import argparse
import glob
import http.client
import json
import os
import random
import statistics
import subprocess
import tempfile
import time
import urllib.parse

RTLANG = os.path.abspath(os.environ.get("RTLANG", "rtlang"))
EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "*.scn")


class Page:
    def __init__(self, address):
        parts = urllib.parse.urlsplit(address)
        self.connection, self.root = http.client.HTTPConnection(parts.netloc, timeout=120), parts.path

    def ask(self, what):
        self.connection.request("GET", self.root + what)
        return self.connection.getresponse().read()

    def until(self, holds, change=0):
        while True:
            state = json.loads(self.ask(f"state?after={change}"))
            if holds(state):
                return state
            if state["state"] == "fault":
                raise SystemExit(state["messages"])
            change = state["change"]


def measure(scene, saves, chance):
    """Seconds of each save, and of each from when it was seen."""
    with open(scene, encoding="utf-8") as file:
        text = file.read()
    with tempfile.TemporaryDirectory(prefix="rtlang-bench-") as folder:
        path = os.path.join(folder, os.path.basename(scene))
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        command = [RTLANG, "--watch", "-I", os.path.dirname(os.path.abspath(scene)), "--time-limit=1", path]
        program = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        try:
            page = Page(program.stdout.readline().strip())
            state = page.until(lambda now: now["state"] == "done")
            whole, seen = [], []
            for i in range(saves):
                time.sleep(chance.uniform(0.05, 0.1))
                begun, save = time.perf_counter(), state["save"]
                with open(path, "w", encoding="utf-8") as out:
                    out.write(f"{text}\n// {i}\n")
                state = page.until(lambda now, last=save: now["picture_save"] > last, state["change"])
                page.ask("picture")
                whole.append(time.perf_counter() - begun)
                seen.append(state["first_seconds"])
        finally:
            program.terminate()
            program.wait()
    return whole, seen


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-n", type=int, default=50)
    parser.add_argument("scenes", nargs="*", default=sorted(glob.glob(EXAMPLES)))
    options = parser.parse_args()
    chance = random.Random(1)
    print(f"| save to first picture, ms, {options.n} saves | median | nine of ten | longest | median once it was seen |")
    print("|---|---|---|---|---|")
    for scene in options.scenes:
        whole, seen = (sorted(1000 * value for value in values) for values in measure(scene, options.n, chance))
        print(f"| {os.path.splitext(os.path.basename(scene))[0].replace('_', ' ')} | {statistics.median(whole):.0f} | "
              f"{whole[int(0.9 * len(whole))]:.0f} | {whole[-1]:.0f} | {statistics.median(seen):.0f} |", flush=True)


if __name__ == "__main__":
    main()
