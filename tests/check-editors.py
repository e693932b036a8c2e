#!/usr/bin/env python3
"""Files for shells and editors are those that the tables of options and words make; with UPDATE_DOCS=1 they are written anew.

share/completions has rtlang's options for bash and zsh, from --help and from what each option says that it wants; share/rtlang
has the language's words for Vim, and share/vscode for Visual Studio Code, from the schema and src/ast/words.def. Bash and Vim are
asked what they make of them where they are installed. Prints TAP. SPDX-License-Identifier: MIT
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
import tap  # noqa: E402

PROGRAM = os.path.abspath(os.environ.get("RTLANG", "./rtlang"))
SCHEMA = os.path.abspath(os.environ.get("PRINT_SCHEMA", "tests/unit/print_schema"))
COLUMNS = 110


def output_of(*words):
    return subprocess.run(words, stdout=subprocess.PIPE, check=True, text=True, encoding="utf-8").stdout


# ---- tables

def choices(name, argument):
    """The words that an option takes, where it takes only some: as its argument is written, or as its complaint says."""
    if argument and "|" in argument and argument == argument.lower():
        return argument.split("|")
    if argument and argument.startswith("["):
        return [argument.strip("[]")] if argument == argument.lower() else []
    said = subprocess.run([PROGRAM, f"--{name}=?"], stderr=subprocess.PIPE, text=True, check=False).stderr
    wants = re.search(r"wants ((?:[a-z][\w-]*, )*[a-z][\w-]* or [a-z][\w-]*), found", said)
    return re.split(", | or ", wants.group(1)) if wants else []


def options():
    """(letter, name, argument, what it takes, help) of each."""
    found = []
    for letter, name, argument, told in re.findall(r"^  (?:-(\w), |    )--([\w-]+)(\[?=[^\s]+)?\s+(.*(?:\n {29}.*)*)$",
                                                   output_of(PROGRAM, "--help"), re.M):
        told = re.sub(r"\n +", " ", told)
        argument = argument.replace("=", "") if argument else ""
        kind = "file" if argument in ("FILE", "PICTURE") else "folder" if argument == "FOLDER" else ""
        found.append((letter, name, argument, kind or (choices(name, argument) if argument else ""), told))
    return found


def povray_words():
    """POV-Ray's keys, and its switches with the sign +, a value still to come."""
    shown = output_of(PROGRAM, "--help=povray")
    switches = re.findall(r"^  [A-Z]\w+ +\+-?([A-Z]+)", shown, re.M)
    return [key + "=" for key in re.findall(r"^  ([A-Z]\w+) ", shown, re.M)] + ["+" + switch for switch in switches]


def words():
    """The words of the language by their class, and the schema's."""
    with open(os.path.join(TOP, "src/ast/words.def"), encoding="utf-8") as file:
        found = {}
        for word, kind in re.findall(r"^WORD\((\w+), (\w+)\)", file.read(), re.M):
            found.setdefault(kind, []).append(word)
    printed = output_of(SCHEMA)
    schema = {"albedo", *re.findall(r"^### (\w+)$", printed, re.M), *re.findall(r"^\| `(\w+)`", printed, re.M)}
    plain = [word for word in found["PLAIN"] + found["TEXTURE"] if word in schema]
    return {"directive": sorted({*found["DIRECTIVE"], "version"}), "function": sorted(found["BUILTIN"]),
            "constant": sorted(found["CONSTANT"] + found["ARRAY"] + found["FUNCTION"]), "colour": sorted(found["COLOUR"]),
            "word": sorted(plain)}


# ---- the files

def filled(before, items, columns=COLUMNS):
    """Lines of `before` and as many items as fit."""
    lines, line = [], before
    for item in items:
        if len(line) + 1 + len(item) > columns:
            lines.append(line)
            line = before
        line += " " + item
    return "\n".join(lines + [line])


def bash(table, povray):
    cases = []
    for letter, name, _, kind, _ in table:
        names = f"--{name}" + (f"|-{letter}" if letter else "")
        if kind == "file":
            cases.append(f"    {names}) COMPREPLY=($(compgen -f -- \"$cur\")); return ;;")
        elif kind == "folder":
            cases.append(f"    {names}) COMPREPLY=($(compgen -d -- \"$cur\")); return ;;")
        elif kind:
            cases.append(f"    {names}) COMPREPLY=($(compgen -W \"{' '.join(kind)}\" -- \"$cur\")); return ;;")
    names = [f"--{name}" + ("=" if argument and not argument.startswith("[") else "") for _, name, argument, _, _ in table]
    return "\n".join([
        "# Bash completion of rtlang, and of POV-Ray's in its place. Made from the table of options: tests/check-editors.py.",
        "# SPDX-License-Identifier: MIT", "_rtlang()", "{",
        "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}",
        "    # Bash takes `--name=value` apart at the sign.",
        "    if [ \"$cur\" = = ]; then cur=; elif [ \"$prev\" = = ]; then prev=${COMP_WORDS[COMP_CWORD-2]}; fi",
        "    case $prev in", *cases, "    esac", "    case $cur in", "    -*) COMPREPLY=($(compgen -W \"",
        filled("       ", names), "        \" -- \"$cur\"))", "        [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2>/dev/null ;;",
        "    [A-Z+]*) COMPREPLY=($(compgen -f -- \"$cur\") $(compgen -W \"", filled("       ", povray),
        "        \" -- \"$cur\"))", "        compopt -o nospace 2>/dev/null ;;", "    *) COMPREPLY=($(compgen -f -- \"$cur\")) ;;", "    esac", "}",
        "complete -o filenames -F _rtlang rtlang", ""])


def zsh(table, povray):
    def quoted(text):
        return text.replace("'", "'\\''").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:")

    lines = ["#compdef rtlang", "# Zsh completion of rtlang. Made from the table of options: tests/check-editors.py.",
             "# SPDX-License-Identifier: MIT", "_rtlang_words()", "{", "  local words=(", filled("   ", povray), "  )",
             "  _alternative 'files:scene:_files -g \"*.(scn|pov|ini)\"' 'povray:POV-Ray option:compadd -S \"\" -a words'", "}",
             "_arguments -s \\"]
    for letter, name, argument, kind, told in table:
        action = {"file": "_files", "folder": "_files -/"}.get(kind if isinstance(kind, str) else "",
                                                              f"({' '.join(kind)})" if kind else "")
        takes = f":{quoted(argument.strip('[]')) or name}:{action}" if argument else ""
        told = quoted(told)
        sign = "" if not argument else "=-" if argument.startswith("[") else "="
        lines.append(f"  '*--{name}{sign}[{told}]{takes}' \\")
        if letter:
            lines.append(f"  '*-{letter}{'+' if argument else ''}[{told}]{takes}' \\")
    return "\n".join(lines + ["  '*:scene:_rtlang_words'", ""])


def vim(table):
    with open(os.path.join(TOP, "share/rtlang/rtlang.vim"), encoding="utf-8") as file:
        lines = file.read().split("\n")
    groups = (("function", "rtlangFunction"), ("constant", "rtlangConstant"), ("colour", "rtlangColour"), ("word", "rtlangWord"))
    kept = [line for line in lines if not line.startswith("syn keyword rtlang") or "rtlangTodo" in line]
    at = next(i for i, line in enumerate(kept) if line.startswith("syn match rtlangDirective"))
    kept[at] = f"syn match rtlangDirective \"#\\s*\\({'|'.join(table['directive'])}\\)\\>\"".replace("|", "\\|")
    at = next(i for i, line in enumerate(kept) if line.startswith("hi def link")) - 1
    made = "\n".join(filled(f"syn keyword {group}", table[kind]) for kind, group in groups)
    return "\n".join(kept[:at] + made.split("\n") + kept[at:])


def vscode(table):
    def rule(kind, name):
        return {"match": r"\b(?:" + "|".join(table[kind]) + r")\b", "name": name}

    comment = {"begin": r"/\*", "end": r"\*/", "name": "comment.block.rtlang", "patterns": [{"include": "#comment"}]}
    grammar = {
        "scopeName": "source.rtlang", "name": "rtlang", "fileTypes": ["scn", "pov", "inc"],
        "patterns": [
            {"match": "//.*$", "name": "comment.line.double-slash.rtlang"}, {"include": "#comment"},
            {"begin": "\"", "end": "\"", "name": "string.quoted.double.rtlang",
             "patterns": [{"match": r"\\(?:[ntabfvr\\\"']|u[0-9A-Fa-f]{4})", "name": "constant.character.escape.rtlang"}]},
            {"match": r"#\s*(?:" + "|".join(table["directive"]) + r")\b", "name": "keyword.control.directive.rtlang"},
            {"match": r"\b[0-9]+\.?[0-9]*(?:[eE][-+]?[0-9]+)?|\.[0-9]+(?:[eE][-+]?[0-9]+)?", "name": "constant.numeric.rtlang"},
            rule("function", "support.function.rtlang"), rule("constant", "constant.language.rtlang"),
            rule("colour", "support.type.colour.rtlang"), rule("word", "keyword.other.rtlang"),
        ],
        "repository": {"comment": comment},
    }
    package = {
        "name": "rtlang", "displayName": "rtlang", "description": "Scenes of rtlang and POV-Ray", "version": "0.1.0",
        "publisher": "rtlang", "license": "MIT", "engines": {"vscode": "^1.60.0"}, "categories": ["Programming Languages"],
        "contributes": {
            "languages": [{"id": "rtlang", "aliases": ["rtlang"], "extensions": [".scn", ".pov", ".inc"],
                           "configuration": "./language-configuration.json"}],
            "grammars": [{"language": "rtlang", "scopeName": "source.rtlang", "path": "./rtlang.tmLanguage.json"}],
        },
    }
    pairs = [["{", "}"], ["<", ">"], ["(", ")"], ["[", "]"]]
    configuration = {"comments": {"lineComment": "//", "blockComment": ["/*", "*/"]}, "brackets": pairs,
                     "autoClosingPairs": [*pairs, ["\"", "\""]], "surroundingPairs": [*pairs, ["\"", "\""]]}
    return {"package.json": package, "rtlang.tmLanguage.json": grammar, "language-configuration.json": configuration}


def files():
    table, language = options(), words()
    made = {"share/completions/rtlang": bash(table, povray_words()), "share/completions/_rtlang": zsh(table, povray_words()),
            "share/rtlang/rtlang.vim": vim(language)}
    for name, content in vscode(language).items():
        made[f"share/vscode/{name}"] = json.dumps(content, indent=2) + "\n"
    return made


# ---- what shells and editors make of them

def complete(folder, *line):
    """What bash offers for the last word."""
    script = os.path.abspath(os.path.join(TOP, "share/completions/rtlang"))
    text = f"source {script}; COMP_WORDS=({' '.join(line)}); COMP_CWORD={len(line) - 1}; _rtlang; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    done = subprocess.run(["bash", "--norc", "-c", text], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, text=True)
    return done.stdout.split(), done.stderr


def check_bash(report):
    with tempfile.TemporaryDirectory() as folder:
        for name in ("ball.scn", "other.pov"):
            with open(os.path.join(folder, name), "w", encoding="utf-8"):
                pass
        os.mkdir(os.path.join(folder, "lib"))
        for line, expected in ((("rtlang", "--len"), ["--lenient"]), (("rtlang", "--wid"), ["--width="]), (("rtlang", "ba"), ["ball.scn"]),
                               (("rtlang", "--sampler", "=", "ha"), ["halton"]), (("rtlang", "--depth", "="), ["8", "16", "float"]),
                               (("rtlang", "-I", ""), ["lib"]), (("rtlang", "--dump", "=", "a"), ["ast"]),
                               (("rtlang", "Antialias_D"), ["Antialias_Depth="]), (("rtlang", "+KF"), ["+KFI", "+KFF", "+KF"])):
            found = complete(folder, *(word or "''" for word in line))
            report.equal(found, (expected, ""), f"bash completes {' '.join(line)}")


SAMPLE = "#declare A = sin(1) + pi;\nsphere { <1, 2, 3>, 0.5 pigment { rgb 1 } finish { specular \"x\" } } // note\n"
EXPECTED = [(1, 2, "rtlangDirective"), (1, 14, "rtlangFunction"), (1, 18, "rtlangNumber"), (1, 23, "rtlangConstant"), (2, 1, "rtlangWord"),
            (2, 26, "rtlangWord"), (2, 36, "rtlangColour"), (2, 52, "rtlangWord"), (2, 61, "rtlangString"), (2, 71, "rtlangComment")]


def check_grammar(report):
    """Each word of the sample is found by the rule that its kind has."""
    with open(os.path.join(TOP, "share/vscode/rtlang.tmLanguage.json"), encoding="utf-8") as file:
        rules = [(re.compile(rule["match"]), rule["name"]) for rule in json.load(file)["patterns"] if "match" in rule]
    found = []
    for word in ("#declare", "sin", "pi", "sphere", "rgb", "specular", "0.5e-3", "// note", "Mine"):
        names = [name for pattern, name in rules if pattern.fullmatch(word)]
        found.append(names[0].split(".")[0] + "." + names[0].split(".")[1] if names else "")
    report.equal(found, ["keyword.control", "support.function", "constant.language", "keyword.other", "support.type", "keyword.other",
                         "constant.numeric", "comment.line", ""], "the grammar for Visual Studio Code gives words their kinds")


def check_vim(report):
    with tempfile.TemporaryDirectory() as folder:
        scene, out = os.path.join(folder, "s.scn"), os.path.join(folder, "out")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SAMPLE)
        asked = "[" + ",".join(f"synIDattr(synID({line},{column},1),'name')" for line, column, _ in EXPECTED) + "]"
        subprocess.run(["vim", "-N", "-u", "NONE", "-es", scene, "-c", "syntax on", "-c", "syntax clear", "-c",
                        "unlet! b:current_syntax", "-c", f"source {os.path.abspath(os.path.join(TOP, 'share/rtlang/rtlang.vim'))}", "-c", f"call writefile({asked}, '{out}')",
                        "-c", "qa!"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60, check=False)
        found = []
        if os.path.exists(out):
            with open(out, encoding="utf-8") as file:
                found = file.read().split("\n")[:-1]
        report.equal(found, [group for _, _, group in EXPECTED], "Vim gives words their groups")


def main():
    report = tap.Tap()
    for name, content in files().items():
        path = os.path.join(TOP, name)
        if os.environ.get("UPDATE_DOCS"):
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write(content)
        found = ""
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                found = file.read()
        report.ok(found == content, f"{name} is what the tables make", "make update-docs writes it")
    check_bash(report) if shutil.which("bash") else report.skip("bash", "no bash")
    check_grammar(report)
    check_vim(report) if shutil.which("vim") else report.skip("vim", "no vim")
    report.done()


main()
