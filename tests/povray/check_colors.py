#!/usr/bin/env python3
"""share/rtlang/colors.inc against the colors.inc of an installed POV-Ray: the same names, values, macros and effect.

The names are read out of the installed file when the test runs; what they mean is printed by #debug. POV-Ray reads both
files, and rtlang too, which must print what POV-Ray prints. Prints TAP; skips what needs a program that is not there.
SPDX-License-Identifier: MIT
"""
import os
import re
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures  # noqa: E402

TOP = os.environ.get("top_srcdir", ".")
OURS = os.path.abspath(os.path.join(TOP, "share/rtlang"))
FILE, GUARD = "colors.inc", "Colors_Inc_Temp"
ITEMS = ("red", "green", "blue", "filter", "transmit")
MACRO_BAR = 2e-6  # formulas of ours, not POV-Ray's, on components of single precision; hues go to 360: relative

HUES = ("-450", "-90", "0", "30", "60", "119.5", "180", "240", "299", "359", "1000")
COLOURS = ("<0.25,0.75,0.5>", "<0.75,0.25,0.75>", "<0.75,0.75,0.25>", "<0.25,0.75,0.75>", "<0.75,0.25,0.5>",
           "<0.25,0.5,0.75>", "0", "1", "0.5", "<1.5,0.25,0.375>", "<1.5,-0.25,0.375>", "<-0.5,-0.125,-0.25>",
           "rgbft <0.25,0.75,0.5,0.1,0.2>", "Red", "Clear", "Coral")
HUED = ("<30,0.5,0.4>", "<200,0.7,0.8>", "<-20,1.4,0.5>", "<90,0.4,1.2>", "<400,0.4,-0.2>",
        "rgbft <200,0.7,0.8,0.1,0.2>", "0.5")
HUE_OF = ("<0.75,0.25,0.5>,0.75,0.5", "<0.75,0.25,0.75>,0.75,0.5", "<0.25,0.5,0.75>,0.9,0.5", "<0.25,0.5,0.75>,0.75,-1")


def words(folder, directive, name=FILE):
    """What a file declares, or its macros."""
    with open(os.path.join(folder, name), encoding="latin-1") as file:
        return sorted(set(re.findall(rf"^\s*#\s*{directive}\s+(\w+)", file.read(), re.M)))


def show(value, items):
    return "".join(f'#debug concat(str({value}.{item}, 0, 17), "\\n")\n' for item in items)


def keep_and_show(call, items):
    """An argument may be a colour keyword, which is why it goes by a name."""
    macro, argument = call.split("(", 1)
    return f"#declare Argument = color {argument[:-1]};\n#declare Result = {macro}(Argument);\n" + show("Result", items)


def name_program(names):
    return "".join(f'#debug "{name}\\n"\n' + show(name, ITEMS) for name in names if name != GUARD)


def macro_program():
    calls = [f"{macro}({value})" for macro in ("CRGB2HSL", "CRGB2HSV") for value in COLOURS]
    calls += [f"{macro}({value})" for macro in ("CHSL2RGB", "CHSV2RGB") for value in HUED]
    return ("".join(f"#declare Result = CH2RGB({hue});\n" + show("Result", ITEMS[:3]) for hue in HUES) +
            "".join(f'#debug concat(str(CRGB2H({three}), 0, 17), "\\n")\n' for three in HUE_OF) +
            "".join(keep_and_show(call, ITEMS) for call in calls))


INCLUDE = '#include "colors.inc"\n'
VERSION = '#debug concat("version ", str(version, 0, 3), "\\n")\n'


def effects(name, guard):
    """Programs that show what including a file does beside declaring names."""
    include = f'#include "{name}"\n'
    return {
        "version without #version": include + VERSION,
        "version after #version 3.6": "#version 3.6;\n" + include + VERSION,
        "what it keeps of the version": "#version 3.6;\n" + include + f'#debug concat(str({guard}, 0, 3), "\\n")\n',
        "its note for View_POV_Include_Stack": "#declare View_POV_Include_Stack = 1;\n" + include,
    }


TWICE = {"included twice": INCLUDE + "#declare Red = Blue;\n" + INCLUDE + show("Red", ITEMS)}


def bring(include, folder, name=FILE):
    """Puts the file beside the scene: folders on the command line come after those of POV-Ray's own settings."""
    shutil.copy(os.path.join(include, name), folder)


def povray_prints(program, folder, include, name=FILE):
    bring(include, folder, name)
    with open(os.path.join(folder, "t.scn"), "w", encoding="ascii") as file:
        file.write(program + "sphere { 0, 1 }\n")
    pictures.run("povray", [pictures.povray(), "+It.scn", "-D", "-F", "+W1", "+H1", "+GDdebug.txt"], folder)
    with open(os.path.join(folder, "debug.txt"), encoding="latin-1") as file:
        return file.read()


def rtlang_prints(program, folder, include, name=FILE):
    bring(include, folder, name)
    with open(os.path.join(folder, "t.scn"), "w", encoding="ascii") as file:
        file.write("camera { }\nlight_source { y, 1 }\n" + program + "sphere { 0, 1 }\n")
    pictures.run("rtlang", [os.path.abspath(os.environ["RTLANG"]), "+It.scn", "-D", "-F", "+W1", "+H1", "+GDdebug.txt"],
                 folder)
    with open(os.path.join(folder, "debug.txt"), encoding="utf-8") as file:
        return file.read()


def close(one, other):
    """Whether two columns of numbers agree within MACRO_BAR."""
    a, b = [[float(word) for word in text.split()] for text in (one, other)]
    return len(a) == len(b) > 0 and all(abs(x - y) <= MACRO_BAR * max(1, abs(x)) for x, y in zip(a, b))


def same_words(one, other):
    return one.split() == other.split()


def gamma_pixels(folder, include, name=FILE):
    """The stored codes of a scene whose only #version is in the include."""
    with open(os.path.join(folder, "g.scn"), "w", encoding="ascii") as file:
        file.write(f'#include "{name}"\n' + "background { rgb <0.2, 0.5, 0.02> }\n")
    bring(include, folder, name)
    pictures.run("povray", [pictures.povray(), "+Ig.scn", "+Og.png", "-D", "-A", "+W2", "+H2", "+FN16"], folder)
    return pictures.read_png(os.path.join(folder, "g.png"))[2]


def cases(theirs):
    """Yields (name, passed, what to show when it did not)."""
    for directive in ("declare", "macro"):
        a, b = words(OURS, directive), words(theirs, directive)
        yield f"the same names by #{directive}", a == b, f"differ: {sorted(set(a) ^ set(b))}"
    start = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n" + INCLUDE
    programs = [("values", start + name_program(words(theirs, "declare")), same_words),
                ("macros", start + macro_program(), close)]
    programs += [(name, program, same_words) for name, program in {**effects(FILE, GUARD), **TWICE}.items()]
    with tempfile.TemporaryDirectory() as folder:
        for name, program, agree in programs:
            want = povray_prints(program, folder, theirs)
            readers = [("POV-Ray, our file", povray_prints, OURS)]
            if os.environ.get("RTLANG"):
                readers += [("rtlang, our file", rtlang_prints, OURS),
                            ("rtlang, POV-Ray's file", rtlang_prints, theirs)]
            for reader, prints, include in readers:
                got = prints(program, folder, include)
                yield f"{name}: {reader}", agree(got, want), f"expected:\n{want}\ngot:\n{got}"
        got, want = gamma_pixels(folder, OURS), gamma_pixels(folder, theirs)
        yield "the gamma of a scene without #version", got == want, f"{got} for {want}"


def main():
    folders = pictures.include_folders()
    if not pictures.povray() or not folders:
        print("1..0 # SKIP povray and povray-includes are not installed")
        return 0
    number = failed = 0
    for name, passed, words_of_it in cases(folders[0]):
        number += 1
        failed += not passed
        print(f"{'ok' if passed else 'not ok'} {number} - {name}", flush=True)
        if not passed:
            print("".join(f"# {line}\n" for line in words_of_it.splitlines()), end="")
    print(f"1..{number}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
