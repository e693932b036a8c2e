#!/usr/bin/env python3
"""Gives generated programs to rtlang and to POV-Ray and compares what they print with #debug.

Usage: check_programs.py [COUNT [SEED]]   Prints TAP, a line for each batch, and of each difference the seed and the program.
COUNT programs are valid, many in a run (generate_programs.py); COUNT others are odd, torn or wrong, each in a run of its
own, and what one of the two takes the other must take, too (generate_odd_programs.py), but for the DECISIONS below.
`generate_programs.py SEED` and `generate_odd_programs.py SEED` print a program again. Skips where there is no POV-Ray.
SPDX-License-Identifier: MIT
"""
import collections
import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import check_debug  # noqa: E402
import generate_odd_programs  # noqa: E402
import generate_programs  # noqa: E402
import pictures  # noqa: E402

COUNT, ODD, SEED = 100, 240, 1
BATCH = 20  # programs that share a run: a run of POV-Ray takes most of a second, whatever it does
PREFACE = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location -5*z look_at 0 }\nsphere { 0, 1 }\n"

ZERO = re.compile(r"-(0\.0+)\b")
ZERO_DOCUMENTED = "a zero may have the other sign"  # of rotations

# What POV-Ray takes and rtlang refuses: its first error, what the program holds, and the words of docs/language.md for it.
DECISIONS = [
    (r"E0\d\d\d", r"#include \"torn\d+\.inc\"", "half of a statement or directive in an included file"),
    (r"E0(106|107|205)", r"#macro T\d+\(P?\) [^\n]*#\w+[^\n]*#end", "a directive that a macro begins and does not end"),
    (r"E0208", r"", "in different texts (E0208)"),
    (r"E0(213|221)", r"#\w+", "a directive without a value in the place of one (E0213, E0221)"),
    (r"E0301", r"#ifn?def", "an index below 0 in `#ifdef` (E0301)"),
    (r"E0205 .* of a (function|spline)", r"#version 3\.[01]", "a copy of a function or spline without `;`"),
    (r"E0106", r"#default", "`#default` with a directive before its brace"),
    (r"E0(110|111)", r"", "(E0110)"),
    (r"E0106 .*after `#fopen`, found `#", r"#fopen\s*#", "a directive that gives the name behind `#fopen` (E0106)"),
    (r"E0106 unexpected `$", r"#macro [^\n]*}[^\n]*#end", "a second `;` behind the value in a macro's text"),
    (r"E0106 .*(in the head of another|without the directive that it belongs to)|E0109", r"#(for|ifdef|ifndef)\b",
     "the head of a directive in which another ends that began before it, or begins and does not end (E0106)"),
    (r"E0260 .*twice", r"function", "a parameter may stand twice in the list"),
    (r"E0215", r"#read|#macro", "must be of the kind of the others, and so must what a parameter becomes that stands for"),
    (r"E0204 .*has no component `T\d+`", r"\.\s*T\d+\(", "a macro that gives the name of a component (E0204)"),
    (r"E0344", r"matrix[^>]*#", "a directive that gives several of the numbers of a `matrix` (E0344)"),
    (r"E0106 unexpected `$", r"#macro[^\n]*;\s*#end", "a `#declare` behind the value in a macro's text (E0106)"),
    (r"E0212", r"#version\s+(-|\+?(0|1?\.|1))", "a `#version` below 1.5 (E0212)"),
    (r"E0223", r"array", "(E0223)"),
    (r"E0106", r"defined\s*\(\s*[a-z]\w*\s*\)", "`defined` of a reserved word (E0106)"),
    (r"E0204", r"[*/]\s*\w+\s*\.\s*[tw]\w*|[*/]\s*\w+\s*\.\s*(filter|transmit)",
     "a component that a vector does not have (E0204) at the end of a product with a colour"),
]
# What rtlang takes and POV-Ray refuses: its message, what the program holds, and the words of docs/language.md.
TAKEN = [
    (r"uninitialized array", r"\[[^\]\n]*(#(local|declare)|\w\()", "even where something is declared within its index"),
]
# Where both take a program and print other values; the words of docs/language.md.
LEFT_BEHIND = "keeps what the operand before it had as components 4 and 5"
NAMED_WITHIN = "a directive within its own value declares keeps the directive's value"
UNREAD = "A new name for which a file that ends with a comma has no value is not declared"
# Programs in which they show.
KNOWN = [
    ('#debug concat(vstr(5, <1, 2, 3, 4, 5>*2*z, " ", 0, 6), "\\n")', LEFT_BEHIND),
    ('#declare Z = (3 #local Z = 7; + 1); #debug concat(str(Z, 0, 6), "\\n")', NAMED_WITHIN),
    ('#debug str(defined(sphere), 0, 6)', "`defined` of a reserved word (E0106)"),
    ('#declare C = rgb 1; #debug str((C*x.t).red, 0, 6)',
     "a component that a vector does not have (E0204) at the end of a product with a colour"),
    ('#declare A = array[3]; #declare A[#local Z = 1; 1] = 3;', TAKEN[0][2]),
    ('#macro N() #end #declare A = N() 3; #debug str(A, 0, 6)', "a directive without a value in the place of one (E0213, E0221)"),
]
DECIDED_MOST = 0.03   # of all odd programs
AGREED_LEAST = 0.25   # that both take
CRASHED_MOST = 0.02   # in which POV-Ray ends by a signal, or never
SECONDS = 20          # a program whose loop never ends for POV-Ray
SHOWN = 5             # differences that are made small


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


def decision(text, fault):
    """The number of the decision that a refusal is covered by, or None."""
    first = re.search(r"E0\d\d\d [^;]*", fault)
    for number, (code, holds, _) in enumerate(DECISIONS):
        if first and re.match(code, first.group()) and re.search(holds, text):
            return number
    return None


def verdict(statements, files):
    """(what came out, words for it): both take it (""), both refuse it, or what is wrong."""
    text = PREFACE + "\n".join(statements) + "\n"
    with tempfile.TemporaryDirectory() as folder:
        for name, part in {**files, "program.scn": text}.items():
            write(os.path.join(folder, name), part)
        ours, wrong_too = check_debug.of_rtlang("program.scn", folder)
        try:
            theirs, wrong = check_debug.of_povray("program.scn", folder, SECONDS)
        except subprocess.TimeoutExpired:
            theirs, wrong = [], "POV-Ray ended with -"
    if wrong_too and re.match(r"rtlang ended with -", wrong_too):
        return "a signal", wrong_too
    if wrong and re.match(r"POV-Ray ended with -", wrong):
        return "no verdict", ""
    if wrong and wrong_too:
        return "both refuse", ""
    if wrong_too:
        number = decision(text + "".join(files.values()), wrong_too)
        return ("refused", wrong_too) if number is None else ("decided", DECISIONS[number][2])
    if wrong:
        words = [words for said, holds, words in TAKEN
                 if re.search(said, " ".join(wrong.split())) and re.search(holds, text + "".join(files.values()))]
        return ("decided", words[0]) if words else ("taken", wrong)
    if re.search("rotate", text):
        theirs, ours = ([ZERO.sub(r"\1", line) for line in lines] for lines in (theirs, ours))
    pair = next(((a, b) for a, b in zip(theirs + [None], ours + [None]) if a != b), None)
    words = pair and difference(text + "".join(files.values()), files, *pair)
    if words:
        return "decided", words
    return ("differs", f"POV-Ray: {pair[0]!r}   rtlang: {pair[1]!r}") if pair else ("", "")


def difference(text, files, theirs, ours):
    """The words for a difference of two lines that is documented, or None."""
    if any(part.rstrip().endswith(",") for part in files.values()) and \
            re.search(r"#read \(\w+,.*\b(\w+)\b.*#ifdef \(\1\)", text, re.S):
        return UNREAD
    if None in (theirs, ours):
        return None
    mine, other = ours.split(), theirs.split()
    is_behind = len(mine) == len(other) >= 4 and mine[:-2] == other[:-2]
    if is_behind and re.search(r"[*/][^;\"\n]*[*/]|[+-][^;\"\n]*[+-]", text):
        return LEFT_BEHIND
    if re.search(r"#(?:declare|local) (\w+) = [^;]*(?:#(?:declare|local)|#for \() ?\1\b", text):
        return NAMED_WITHIN
    return None


def shrunk(statements, files, what):
    """Statements without which it still comes out so are dropped."""
    at = len(statements)
    while at > 0:
        at -= 1
        fewer = statements[:at] + statements[at + 1:]
        if verdict(fewer, files)[0] == what:
            statements = fewer
    return statements


def odd(seed):
    return verdict(*generate_odd_programs.generate(seed))


def check_odd(seeds, pool, number):
    """Prints the lines of the odd programs, of which the first has that number; how many failed."""
    counts, used, failed, shown = collections.Counter(), collections.Counter(), 0, 0
    answers = pool.map(odd, seeds)
    for batch in (seeds[i:i + 5 * BATCH] for i in range(0, len(seeds), 5 * BATCH)):
        faults = []
        for seed, (what, words) in zip(batch, answers):
            counts[what] += 1
            if what == "decided":
                used[words] += 1
            elif what in ("a signal", "refused", "taken", "differs"):
                faults.append((seed, what, words))
        failed += bool(faults)
        print(f"{'not ok' if faults else 'ok'} {number} - odd programs {batch[0]} to {batch[-1]}", flush=True)
        number += 1
        for seed, what, words in faults:
            print(f"# generate_odd_programs.py {seed}: {what}: " + str(words).replace("\n", "\n#   "))
            shown += 1
            if shown <= SHOWN:
                statements, files = generate_odd_programs.generate(seed)
                for line in "\n".join(shrunk(statements, files, what)).splitlines():
                    print("#   " + line)
    total = len(seeds)
    fine = (counts[""] >= AGREED_LEAST * total and counts["decided"] <= DECIDED_MOST * total and
            counts["no verdict"] <= CRASHED_MOST * total)
    print(f"{'ok' if fine else 'not ok'} {number} - {counts['']} of {total} taken by both, {counts['both refuse']} refused, "
          f"{counts['decided']} as decided, {counts['no verdict']} in which POV-Ray ends by a signal or never")
    for words, count in sorted(used.items()):
        print(f"# decided {count} times: {words}")
    return failed + (not fine)


def undocumented():
    """Words of DECISIONS that docs/language.md does not have."""
    with open(os.path.join(os.environ.get("top_srcdir", "."), "docs/language.md"), encoding="utf-8") as document:
        text = " ".join(document.read().split())
    return [words for words in [ZERO_DOCUMENTED, LEFT_BEHIND, NAMED_WITHIN, UNREAD] +
            [words for _, _, words in DECISIONS + TAKEN] if words not in text]


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
    odd_seeds = list(range(seed * 1000000, seed * 1000000 + (count if sys.argv[1:] else ODD)))
    batches = [seeds[i:i + BATCH] for i in range(0, count, BATCH)]
    failed = 0
    print(f"1..{len(batches) + -(-len(odd_seeds) // (5 * BATCH)) + 4}\n# seed {seed}")
    with concurrent.futures.ThreadPoolExecutor(pictures.POVRAY_AT_ONCE) as pool:
        for number, (batch, (faults, lines)) in enumerate(zip(batches, pool.map(compare, batches)), 1):
            failed += bool(faults)
            print(f"{'not ok' if faults else 'ok'} {number} - programs {batch[0]} to {batch[-1]}, {lines} lines", flush=True)
            for which, fault in faults:
                print(f"# generate_programs.py {which}: " + fault.replace("\n", "\n#   "))
        for number, missing, words in ((1, coverage(seeds) if count >= COUNT else [], "every function and constant occurs"),
                                       (2, undocumented(), "what is refused is in docs/language.md"),
                                       (3, [text for text, words in KNOWN if verdict([text], {}) != ("decided", words)],
                                        "what is documented shows")):
            failed += bool(missing)
            print(f"{'not ok' if missing else 'ok'} {len(batches) + number} - {words} {', '.join(missing)}", flush=True)
        failed += check_odd(odd_seeds, pool, len(batches) + 4)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
