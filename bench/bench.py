#!/usr/bin/env python3
"""Speed beside the peers: the same scenes given to rtlang, POV-Ray and Tachyon in turn, in one run, so that only ratios count.

Whole processes from the scene file to the picture, wall time and peak memory, and the phases as each program prints them;
medians of several turns. Prints Markdown tables, writes JSON to --json FILE, and with --docs FILE puts the tables between
that file's `<!-- bench -->` marks. With --update it measures nothing but the few scenes of the README's table and puts that
there: processor seconds of one thread, the whole process, the least of three turns, which other work on the machine
disturbs little. A peer that is not installed is left out with a word. Never part of `make check`: the machines are shared.
SPDX-License-Identifier: MIT
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SMALL, LARGE = (800, 600), (1920, 1080)
TURNS = {1000000: 3, 10000000: 1}  # fewer where a turn takes long
README = os.path.join(os.path.dirname(HERE), "README.md")
README_SIZE, README_TURNS = (640, 480), 3
README_SCENES = [  # what of generate.py, or a file that only rtlang and POV-Ray read
    ("20 000 atoms", ("molecule", 20000)),
    ("a million particles", ("cube", 1000000)),
    ("[a crystal, by ASE](examples/gallery/crystal.pov)", "examples/gallery/crystal.pov"),
    ("[a protein in soft light](examples/gallery/protein.scn)", "examples/gallery/protein.scn"),
    ("[a cup cut from shapes](examples/gallery/cup.scn)", "examples/gallery/cup.scn"),
    ("POV-Ray's `advanced/woodbox`", "/usr/share/doc/povray/examples/advanced/woodbox.pov"),
]
PEERS = {"povray": "POV-Ray", "tachyon": "Tachyon"}
MARKS = "<!-- bench -->\n", "<!-- /bench -->\n"


# ---- how each program is called, and what it prints of its phases

def rtlang_command(scene, picture, size, threads):
    return [os.path.abspath(os.environ.get("RTLANG", "./rtlang")), f"-W{size[0]}", f"-H{size[1]}", f"-t{threads}", "-o", picture, scene]


def rtlang_phases(text):
    found = dict(re.findall(r"(parse|prepare|trace|write) ([0-9.]+)", text.split("seconds:")[-1]))
    return {"parse": float(found["parse"]), "build": float(found["prepare"]), "trace": float(found["trace"])}


def povray_command(scene, picture, size, threads):
    return [os.environ.get("POVRAY") or "povray", "+I" + scene, "+O" + picture, f"+W{size[0]}", f"+H{size[1]}", f"+WT{threads}",
            "-D", "-A", "+FN8"]


def povray_phases(text):
    found = dict(re.findall(r"(Parse|Bounding|Trace) Time: .*\(([0-9.]+) seconds\)", text))
    return {"parse": float(found["Parse"]), "build": float(found["Bounding"]), "trace": float(found["Trace"])}


def tachyon_command(scene, picture, size, threads):
    return ["tachyon", scene, "-shade_phong", "-numthreads", str(threads), "-res", str(size[0]), str(size[1]), "-format", "PNG",
            "-o", picture]


def tachyon_phases(text):
    found = dict(re.findall(r"(Parsing|Preprocessing|Tracing) Time: +([0-9.]+) seconds", text))
    return {"parse": float(found["Parsing"]), "build": float(found["Preprocessing"]), "trace": float(found["Tracing"])}


PROGRAMS = {"rtlang": (rtlang_command, rtlang_phases, "povray"), "povray": (povray_command, povray_phases, "povray"),
            "tachyon": (tachyon_command, tachyon_phases, "tachyon")}


def installed():
    names = ["rtlang"]
    for peer in PEERS:
        if shutil.which((os.environ.get("POVRAY") or peer) if peer == "povray" else peer):
            names.append(peer)
        else:
            print(f"{peer} is not installed (apt-get install {peer}): left out", file=sys.stderr)
    return names


# ---- one process, and turns of many

def run_once(name, scene, folder, size, threads):
    """Wall and processor seconds, peak megabytes and phases of one process; it runs where its scene is."""
    command, phases, _ = PROGRAMS[name]
    words = command(scene, os.path.join(folder, name + ".png"), size, threads)
    log = os.path.join(folder, "log")
    with open(log, "w+b") as file:
        start = time.perf_counter()
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, cwd=os.path.dirname(scene))
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    with open(log, encoding="latin-1") as file:
        text = file.read()
    if process.returncode:
        sys.exit(f"bench: {' '.join(words)} ended with {process.returncode}:\n{text[-400:]}")
    return {"seconds": seconds, "processor": usage.ru_utime + usage.ru_stime, "megabytes": usage.ru_maxrss / 1000, **phases(text)}


def write_scene(folder, kind, count, language):
    path = os.path.join(folder, f"{kind}{count}." + {"povray": "pov", "tachyon": "dat"}[language])
    with open(path, "w", encoding="ascii") as file:
        subprocess.run([sys.executable, os.path.join(HERE, "generate.py"), kind, str(count), language], stdout=file, check=True)
    return path


def measure(kind, count, names, turns, folder, size=SMALL, threads=2):
    """Name -> what was measured -> its median, of each program in turn on the same scene. The first turn warms up."""
    names = [name for name in names if kind != "loop" or name != "tachyon"]
    scenes = {language: write_scene(folder, kind, count, language) for language in {PROGRAMS[name][2] for name in names}}
    taken = {name: [] for name in names}
    for turn in range(min(turns, TURNS.get(count, turns)) + 1):
        for name in names:
            sample = run_once(name, scenes[PROGRAMS[name][2]], folder, size, threads)
            if turn > 0:
                taken[name].append(sample)
    for path in scenes.values():
        os.remove(path)
    return {name: {what: statistics.median(sample[what] for sample in samples) for what in samples[0]}
            for name, samples in taken.items()}


# ---- tables

def table(header, rows):
    return "".join("| " + " | ".join(row) + " |\n" for row in [header, ["---"] * len(header), *rows]) + "\n"


def ratio(found, peer, what="seconds", least=0.002):
    """How many times longer the peer takes; nothing where our own time is below what the programs' clocks tell."""
    if peer not in found:
        return "-"
    return f"{found[peer][what] / found['rtlang'][what]:.1f}" if found["rtlang"][what] >= least else "-"


def of_program(found, name, what, form):
    return form.format(found[name][what]) if name in found else "-"


def end_to_end(options, names, folder, results):
    scenes = [("cube", count) for count in options.counts] + [("flake", 7381), ("molecule", 20000), ("sticks", 20000), ("nested", 10)]
    rows = []
    for kind, count in scenes:
        found = results[f"{kind} {count}"] = measure(kind, count, names if count < 10**7 else ["rtlang"], options.turns, folder)
        rows.append([f"{kind} {count}", *(of_program(found, name, "seconds", "{:.3f}") for name in PROGRAMS),
                     *(ratio(found, peer) for peer in PEERS),
                     *(of_program(found, name, "megabytes", "{:.0f}") for name in PROGRAMS)])
    header = ["800x600, 2 threads", "rtlang s", "POV-Ray s", "Tachyon s", "/ POV-Ray", "/ Tachyon",
              "rtlang MB", "POV-Ray MB", "Tachyon MB"]
    return table(header, rows)


def phases(options, names, folder, results):
    rows = []
    for count in (count for count in options.counts if count < 10**7):
        found = results[f"phases {count}"] = measure("cube", count, names, options.turns, folder, LARGE, 1)
        for what in ("parse", "build", "trace"):
            rows.append([f"{what}, cube {count}", *(of_program(found, name, what, "{:.4f}") for name in PROGRAMS),
                         *(ratio(found, peer, what) for peer in PEERS)])
    for count in (100000,):
        found = results[f"loop {count}"] = measure("loop", count, names, options.turns, folder, SMALL, 1)
        rows.append([f"parse, loop of {count}", *(of_program(found, name, "parse", "{:.4f}") for name in PROGRAMS),
                     *(ratio(found, peer, "parse") for peer in PEERS)])
    return table(["phase, 1920x1080, 1 thread", "rtlang s", "POV-Ray s", "Tachyon s", "/ POV-Ray", "/ Tachyon"], rows)


def threads(options, folder, results):
    rows = []
    for count in (count for count in options.counts if 1000 <= count < 10**7):
        one = measure("cube", count, ["rtlang"], options.turns, folder, LARGE, 1)["rtlang"]
        two = measure("cube", count, ["rtlang"], options.turns, folder, LARGE, 2)["rtlang"]
        results[f"threads {count}"] = {"one": one, "two": two}
        rows.append([f"cube {count}", *(f"{one[what] / two[what]:.2f}" if two[what] >= 0.002 else "-" for what in ("trace", "build"))])
    return table(["1 thread / 2 threads", "trace", "build"], rows)


def readme(names, folder):
    """The least processor seconds of each program, one ray through the middle of each pixel."""
    rows = []
    for words, scene in README_SCENES:
        paths = {"povray": os.path.join(os.path.dirname(HERE), scene)} if isinstance(scene, str) else \
            {language: write_scene(folder, *scene, language) for language in ("povray", "tachyon")}
        if not os.path.exists(paths["povray"]):
            print(f"{paths['povray']} is not there (apt-get install povray-examples): left out", file=sys.stderr)
            continue
        own = [name for name in names if PROGRAMS[name][2] in paths]
        taken = {name: [] for name in own}
        for _ in range(README_TURNS):
            for name in own:
                taken[name].append(run_once(name, paths[PROGRAMS[name][2]], folder, README_SIZE, 1)["processor"])
        found = {name: {"seconds": min(taken[name])} for name in own}
        rows.append([words, of_program(found, "rtlang", "seconds", "{:.2f}")])
        for peer in PEERS:
            rows[-1].append(f"{found[peer]['seconds']:.2f} ({ratio(found, peer)})" if peer in found else "-")
        print(" | ".join(rows[-1]), flush=True)
    return table(["processor seconds", "rtlang", "POV-Ray (times as long)", "Tachyon (times as long)"], rows)


def put_into(path, text):
    with open(path, encoding="utf-8") as file:
        whole = file.read()
    head, _, rest = whole.partition(MARKS[0])
    _, _, tail = rest.partition(MARKS[1])
    with open(path, "w", encoding="utf-8") as file:
        file.write(head + MARKS[0] + text + MARKS[1] + tail)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--json", default="bench.json")
    parser.add_argument("--docs")
    parser.add_argument("--update", action="store_true", help="the README's table, and nothing else")
    parser.add_argument("counts", type=int, nargs="*", default=[1, 1000, 100000, 1000000])
    options = parser.parse_args()
    results, names, text = {}, installed(), ""
    with tempfile.TemporaryDirectory(prefix="rtlang-bench-") as folder:
        if options.update:
            put_into(README, readme(names, folder).rstrip("\n") + "\n")
            return
        for part in (lambda: end_to_end(options, names, folder, results), lambda: phases(options, names, folder, results),
                     lambda: threads(options, folder, results)):
            rows = part()
            print(rows, end="", flush=True)
            text += rows
    with open(options.json, "w", encoding="ascii") as file:
        json.dump(results, file, indent=2)
    if options.docs:
        put_into(options.docs, text.rstrip("\n") + "\n")


if __name__ == "__main__":
    main()
