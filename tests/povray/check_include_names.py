#!/usr/bin/env python3
"""Each name that POV-Ray's standard include files declare is used once: it works, or one located fault says what rtlang lacks.

Numbers, vectors, colours and strings are printed by both programs and compared. Of other names the kind is found by trying
uses until POV-Ray's kinds are through. Takes a minute or two, so `make check-long` runs it. Prints TAP, a line a file.
SPDX-License-Identifier: MIT
"""
import collections
import concurrent.futures
import glob
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import check_includes  # noqa: E402
import check_lang  # noqa: E402
import pictures  # noqa: E402

RTLANG = os.path.abspath(os.environ.get("RTLANG", "./rtlang"))
UNSUPPORTED = {"E0210", "E0251", "E0252", "E0269"}
VALUES = {
    "number": '#debug concat("{0} ", str({0}, 0, 6), "\\n")',
    "vector": '#debug concat("{0} ", vstr(5, {0}, ",", 0, 6), "\\n")',
    "string": '#debug concat("{0} ", {0}, "\\n")',
}
OTHERS = {
    "texture": "sphere {{ 0, 1 texture {{ {0} }} }}", "pigment": "sphere {{ 0, 1 pigment {{ {0} }} }}",
    "normal": "sphere {{ 0, 1 pigment {{ rgb 1 }} normal {{ {0} }} }}", "finish": "sphere {{ 0, 1 finish {{ {0} }} }}",
    "object": "object {{ {0} }}", "interior": "sphere {{ 0, 1 interior {{ {0} }} }}",
    "material": "sphere {{ 0, 1 material {{ {0} }} }}", "transform": "sphere {{ 0, 1 transform {{ {0} }} }}",
    "color_map": "sphere {{ 0, 1 pigment {{ gradient x color_map {{ {0} }} }} }}",
    "texture_map": "sphere {{ 0, 1 texture {{ gradient x texture_map {{ {0} }} }} }}",
    "pigment_map": "sphere {{ 0, 1 pigment {{ gradient x pigment_map {{ {0} }} }} }}",
    "normal_map": "sphere {{ 0, 1 normal {{ gradient x normal_map {{ {0} }} }} }}", "sky_sphere": "sky_sphere {{ {0} }}",
    "fog": "fog {{ {0} }}", "camera": "camera {{ {0} }}", "light": "light_source {{ {0} }}", "media": "media {{ {0} }}",
    "array": "#debug str(dimensions({0}), 0, 0)", "function": "#debug str({0}({1}), 0, 6)",
    "internal": "#debug str({0}({1}, 4), 0, 6)",  # a function whose number of parameters is not told
}
TOLD_BY_WORD = {"media", "array", "function", "internal"}  # not tried for a name whose value begins with another word
DIRECTIVE = re.compile(r"#\s*(?:(?P<macro>macro)\b|(?P<end>end)\b|(?P<opens>if|ifdef|ifndef|while|for|switch)\b|"
                       r"declare\s+(?P<name>[A-Za-z_]\w*)\s*=\s*(?P<word>\w+)?"
                       r"(?:\s*\((?P<parameters>[\w\s,]*)\))?)")


def declared(path):
    """{name: (first word of its value, numbers for the parameters after it)} of a file, without what macros declare."""
    with open(path, encoding="latin-1") as file:
        text = re.sub(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', lambda found: found[0] if found[0][0] == '"' else " ",
                      file.read(), flags=re.DOTALL)
    names, open_directives = {}, []
    for found in DIRECTIVE.finditer(text):
        if found["macro"] or found["opens"]:
            open_directives.append(bool(found["macro"]))
        elif found["end"]:
            open_directives.pop()
        elif not any(open_directives):
            count = len(re.findall(r"\w+", found["parameters"] or "x, y, z"))
            names[found["name"]] = found["word"], ", ".join(str(i + 1) for i in range(count))
    return names


def program(file, uses):
    lines = [f'#include "{name}"' for name in [*check_includes.BEFORE.get(file, []), file]]
    return "\n".join(lines + uses) + "\n"


def run(text, folders):
    """(exit code, messages, lines of #debug)."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "t.scn"), "w", encoding="latin-1") as out:
            out.write(check_lang.PREFACE + text)
        done = subprocess.run([RTLANG, "--check", "-q", *(f"-I{path}" for path in folders), "t.scn"], cwd=folder,
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=120,
                              check=False)
    return done.returncode, done.stderr.decode("latin-1")


def use(file, name, first_word, folders):
    """(kind, what happened): the first use that is taken; "refused" when one says what rtlang lacks, "?" when none is."""
    every, (word, numbers) = {**VALUES, **OTHERS}, first_word
    order = ["function", "internal"] if word == "function" else [word] * (word in every)
    order += [kind for kind in every if kind not in {word, *TOLD_BY_WORD}]
    first = None
    for kind in order:
        code, said = run(program(file, [every[kind].format(name, numbers)]), folders)
        faults = re.findall(r"^(\S+:\d+:\d+): error\[(\w+)\]: (.*)$", said, re.MULTILINE)
        if code == 0:
            return kind, ""
        if code not in (1, 2, 3, 4) or not faults:
            return "?", f"exit code {code}: {said[-200:]}"
        if len(faults) == 1 and faults[0][1] in UNSUPPORTED:
            return "refused", re.search(r"`[^`]*`", faults[0][2])[0]
        first = first or f"{faults[0][1]} {faults[0][2]}"
    return "?", first


def compare_values(file, names, folders):
    """Lines that differ between the two programs."""
    uses = [VALUES[kind].format(name) for name, (kind, _) in names.items() if kind in VALUES]
    text = program(file, ['#debug "== values\\n"', *uses])
    theirs, code, errors = check_lang.run_povray(text, {}, [])
    _, said = run(text, folders)
    if code:
        return ["POV-Ray: " + errors[-300:].replace("\n", " ")]
    wanted = theirs.split("== values\n")[-1].rstrip("\n").split("\n")
    told = set(said.split("\n"))
    return [line for line in wanted if line not in told]


def check_file(path, folders, pool):
    """(fine, words, what is wrong)."""
    file, names = os.path.basename(path), declared(path)
    used = dict(zip(names, pool.map(lambda name: use(file, name, names[name], folders), names)))
    wrong = [f"{name}: {words}" for name, (kind, words) in used.items() if kind == "?"]
    wrong += compare_values(file, used, folders)
    lacks = collections.Counter(words for kind, words in used.values() if kind == "refused")
    words = f"{file}: {len(used)} names, {sum(lacks.values())} of them refused"
    return not wrong, words + "".join(f", {count} for {what}" for what, count in lacks.most_common(3)), wrong


def main():
    files = sorted(glob.glob("/usr/share/povray-3*/include/*.inc"))
    if pictures.povray() is None or not files:
        print("1..0 # SKIP povray and povray-includes are not installed")
        return 0
    print(f"1..{len(files)}")
    failed, folders = 0, pictures.include_folders()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for number, path in enumerate(files, 1):
            fine, words, wrong = check_file(path, folders, pool)
            failed += not fine
            print(f"{'ok' if fine else 'not ok'} {number} - {words}".replace("#", "\\#"), flush=True)
            for line in wrong[:20]:
                print("# " + line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
