#!/usr/bin/env python3
"""Gives generated programs to rtlang and to POV-Ray and compares what they print with #debug.

Usage: check_programs.py [COUNT [SEED]]   Prints TAP, a line for each batch, and of each difference the seed and the program.
`generate_programs.py SEED` prints a program again. Skips where there is no POV-Ray. SPDX-License-Identifier: MIT
"""
import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import check_debug  # noqa: E402
import generate_programs  # noqa: E402
import pictures  # noqa: E402

COUNT, SEED = 100, 1
BATCH = 20  # programs that share a run: a run of POV-Ray takes most of a second, whatever it does
PREFACE = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location -5*z look_at 0 }\nsphere { 0, 1 }\n"


def write(path, text):
    with open(path, "w", encoding="latin-1", newline="") as file:
        file.write(text)


def run(seeds, folder):
    """The two programs' lines for each seed, and what went wrong in either run: [(theirs, ours)], faults."""
    text = PREFACE
    for number, seed in enumerate(seeds):
        program, files = generate_programs.generate(seed, number)
        text += f'#debug "== {seed}\\n"\n{program}'
        for name, part in files.items():
            write(os.path.join(folder, name), part)
    write(os.path.join(folder, "programs.scn"), text)
    (theirs, wrong), (ours, wrong_too) = (of("programs.scn", folder)
                                          for of in (check_debug.of_povray, check_debug.of_rtlang))
    by_seed = [{name: lines for name, lines in check_debug.groups(all_lines)} for all_lines in (theirs, ours)]
    return [tuple(found.get(str(seed), []) for found in by_seed) for seed in seeds], [wrong, wrong_too]


def first_error(folder):
    done = subprocess.run([os.environ["RTLANG"], "--check", "-q", "programs.scn"], cwd=folder, stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
    found = re.search(rb"^\S+:\d+:\d+: error.*(\n.*){0,2}", done.stderr, re.MULTILINE)
    return found.group().decode("latin-1") if found else ""


def compare(seeds):
    """[(seed, what differs)], and how many lines were printed."""
    with tempfile.TemporaryDirectory() as folder:
        pairs, wrong = run(seeds, folder)
        if any(wrong) and len(seeds) > 1:
            # A fault ends a run of POV-Ray, so each of them on its own.
            singles = [compare([seed]) for seed in seeds]
            return [fault for faults, _ in singles for fault in faults], sum(lines for _, lines in singles)
        if any(wrong):
            return [(seeds[0], " ".join(filter(None, [*wrong, first_error(folder)])))], 0
    faults = []
    for seed, (theirs, ours) in zip(seeds, pairs):
        pair = next(((a, b) for a, b in zip(theirs + [None], ours + [None]) if a != b), None)
        if pair or len(theirs) != len(ours) or not theirs:
            faults.append((seed, f"POV-Ray: {pair and pair[0]!r}   rtlang: {pair and pair[1]!r}"))
    return faults, sum(len(theirs) for theirs, _ in pairs)


def coverage(seeds):
    """Words of the language's functions and constants that none of the programs has."""
    with open(os.path.join(os.environ.get("top_srcdir", "."), "src/ast/words.def"), encoding="utf-8") as table:
        words = re.findall(r"^WORD\((\w+), (?:BUILTIN|CONSTANT)\)", table.read(), re.MULTILINE)
    found = set()
    for seed in seeds:
        text, files = generate_programs.generate(seed)
        found.update(re.findall(r"\w+", text + "".join(files.values())))
    return [word for word in words if word not in found | generate_programs.LEFT_OUT]


def main():
    if not pictures.povray():
        print("1..0 # SKIP povray is not installed")
        return 0
    count, seed = (int(argument) for argument in (sys.argv[1:] + [COUNT, SEED][len(sys.argv) - 1:])[:2])
    seeds = list(range(seed * 1000000, seed * 1000000 + count))
    batches = [seeds[i:i + BATCH] for i in range(0, count, BATCH)]
    failed = 0
    print(f"1..{len(batches) + 1}\n# seed {seed}")
    with concurrent.futures.ThreadPoolExecutor(2 * (os.cpu_count() or 1)) as pool:
        for number, (batch, (faults, lines)) in enumerate(zip(batches, pool.map(compare, batches)), 1):
            failed += bool(faults)
            print(f"{'not ok' if faults else 'ok'} {number} - programs {batch[0]} to {batch[-1]}, {lines} lines", flush=True)
            for which, fault in faults:
                print(f"# generate_programs.py {which}: " + fault.replace("\n", "\n#   "))
    missing = coverage(seeds) if count >= COUNT else []
    failed += bool(missing)
    print(f"{'not ok' if missing else 'ok'} {len(batches) + 1} - every function and constant occurs {' '.join(missing)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
