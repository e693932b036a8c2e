#!/usr/bin/env python3
"""POV-Ray's command line given to rtlang: what is followed, what is refused and where, exit status and streams.

tests/povray/check_place.py has POV-Ray do the same; here is what needs no POV-Ray. Prints TAP.
SPDX-License-Identifier: MIT
"""
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from picture_bytes import png_without_texts  # noqa: E402
from tap import Tap  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])
tap = Tap()
SCENE = """#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1, -4> look_at 0 }
light_source { <-5, 8, -6>, rgb 1 }
sphere { 0, 1 pigment { rgb <0.8, 0.2, 0.1> } finish { phong 0.6 } }
#debug concat("clock ", str(clock, 0, 3), ", frame ", str(frame_number, 0, 0), " of ", str(final_frame, 0, 0), "\\n")
"""

# What the manual of POV-Ray 3.7 names (Debian's povray-doc, chapter 3.2): keys, and switches without their values.
KEYS = """
All_Console All_File Antialias Antialias_Depth Antialias_Gamma Antialias_Threshold Append_File BSP_BaseAccessCost
BSP_ChildAccessCost BSP_IsectCost BSP_MaxDepth BSP_MissChance Bits_Per_Color Bounding Bounding_Method Bounding_Threshold
Clock Continue_Trace Create_Ini Cyclic_Animation Debug_Console Debug_File Declare Display Display_Gamma Dither
Dither_Method Draw_Vistas End_Column End_Row Fatal_Console Fatal_Error_Command Fatal_Error_Return Fatal_File
Field_Render File_Gamma Final_Clock Final_Frame Frame_Step Height Include_Header Initial_Clock Initial_Frame
Input_File_Name Jitter Jitter_Amount Library_Path Light_Buffer Max_Image_Buffer_Memory Odd_Field Output_Alpha
Output_File_Name Output_File_Type Output_to_File Palette Pause_When_Done Post_Frame_Command Post_Frame_Return
Post_Scene_Command Post_Scene_Return Pre_Frame_Command Pre_Frame_Return Pre_Scene_Command Pre_Scene_Return
Preview_End_Size Preview_Start_Size Quality Radiosity_File_Name Radiosity_From_File Radiosity_To_File
Radiosity_Vain_Pretrace Remove_Bounds Render_Block_Size Render_Block_Step Render_Console Render_File Render_Pattern
Sampling_Method Split_Unions Start_Column Start_Row Statistic_Console Statistic_File Subset_End_Frame Subset_Start_Frame
Test_Abort Test_Abort_Count User_Abort_Command User_Abort_Return Verbose Version Video_Mode Vista_Buffer Warning_Console
Warning_File Warning_Level Width Work_Threads
"""
SWITCHES = """
A AG AM BM BS C D EC EF EP ER F GA GD GF GI GP GR GS GW H HI HR I J K KC KF KFF KFI KI L MB MI MV O P Q R RF RFI RFO RP
RS RVP SC SF SP SR STP SU TH UA UD UF UL UO UR UV V W WT X
"""


def run(folder, *arguments, program=None, files=None, **environment):
    """Runs rtlang in a folder that then holds the scene and `files`; no povray.ini counts but one that is named."""
    for name, text in dict({"s.pov": SCENE, "none.ini": ""}, **(files or {})).items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    variables = dict(dict(os.environ, HOME=folder, POVINI=os.path.join(folder, "none.ini")), **environment)
    return subprocess.run([program or PROGRAM, *arguments], cwd=folder, env=variables, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60, check=False)


def check_messages():
    """The whole text of each message, and POV-Ray's exit status."""
    unknown = "     = help: rtlang --help=povray lists them\n"
    named = {"self.ini": "s.pov ; the scene\n  self.ini\n",
             "a.ini": "b.ini\n", "b.ini": "+W8\n a.ini",
             "key.ini": "Width = 8\nHeigth=6\n",
             "value.ini": "[big]\nWidth=900\n[small]\n Width = \"wide\" ; not a number\n",
             "scene.ini": "+W8 +H6\nInput_File_Name = nowhere.pov\n",
             "binary.ini": "s.pov\0+W8",
             "refused.ini": "; comment\nPost_Frame_Command=rm %o\n"}
    for what, words, said in [
            ("a scene that is not there", ["scene.ini"],
             "scene.ini:2:19: error[E0501]: scene file `nowhere.pov` not found\n"
             "   2 | Input_File_Name = nowhere.pov\n     |                   ^~~~~~~~~~~\n"),
            ("the same on the command line", ["+W8", "+Inowhere.pov"],
             "command line:1:7: error[E0501]: scene file `nowhere.pov` not found\n"
             "   1 | +W8 +Inowhere.pov\n     |       ^~~~~~~~~~~\n"),
            ("a switch", ["+Is.pov", "+Zfoo"],
             "command line:1:9: error[E0704]: POV-Ray has no switch `+Zfoo`\n"
             "   1 | +Is.pov +Zfoo\n     |         ^~~~~\n" + unknown),
            ("letters behind a switch that takes none", ["+Is.pov", "-Px"],
             "command line:1:9: error[E0704]: POV-Ray has no switch `-Px`\n"
             "   1 | +Is.pov -Px\n     |         ^~~\n" + unknown),
            ("a key", ["s.pov", "Heigth=6"],
             "command line:1:7: error[E0704]: POV-Ray has no option `Heigth`\n"
             "   1 | s.pov Heigth=6\n     |       ^~~~~~\n     = help: did you mean `Height`?\n"),
            ("a key in a file", ["key.ini"],
             "key.ini:2:1: error[E0704]: POV-Ray has no option `Heigth`\n"
             "   2 | Heigth=6\n     | ^~~~~~\n     = help: did you mean `Height`?\n"),
            ("a number that is none", ["s.pov", "+Wabc"],
             "command line:1:9: error[E0705]: `Width` wants a whole number from 1 to 65535, found `abc`\n"
             "   1 | s.pov +Wabc\n     |         ^~~\n"),
            ("no number", ["s.pov", "+W"],
             "command line:1:9: error[E0705]: `Width` wants a whole number from 1 to 65535, found ``\n"
             "   1 | s.pov +W\n     |         ^\n"),
            ("a value in a section", ["value.ini[Small]"],
             "value.ini:4:11: error[E0705]: `Width` wants a whole number from 1 to 65535, found `wide`\n"
             "   4 |  Width = \"wide\" ; not a number\n     |           ^~~~\n"),
            ("a quality that is not drawn", ["s.pov", "+Q3"],
             "command line:1:9: error[E0705]: `Quality` wants a whole number from 8 to 11, found `3`\n"
             "   1 | s.pov +Q3\n     |         ^\n"
             "     = help: rtlang always draws shadows, textures, reflection and refraction\n"),
            ("a format", ["s.pov", "+FX"],
             "command line:1:9: error[E0705]: `Output_File_Type` wants a letter of a picture format: N, T, C, P, J, B, "
             "E or H, found `X`\n   1 | s.pov +FX\n     |         ^\n"),
            ("bits", ["s.pov", "+FN10"],
             "command line:1:10: error[E0705]: `Bits_Per_Color` wants 8 or 16 bits, found `10`\n"
             "   1 | s.pov +FN10\n     |          ^~\n"),
            ("a gamma", ["s.pov", "File_Gamma=bright"],
             "command line:1:18: error[E0705]: `File_Gamma` wants sRGB or a number above 0, found `bright`\n"
             "   1 | s.pov File_Gamma=bright\n     |                  ^~~~~~\n"),
            ("a declaration", ["s.pov", "Declare=A"],
             "command line:1:15: error[E0705]: `Declare` wants NAME=NUMBER without blanks, found `A`\n"
             "   1 | s.pov Declare=A\n     |               ^\n"),
            ("a name that is lacking", ["s.pov", "+O"],
             "command line:1:9: error[E0705]: `Output_File_Name` wants a name, found ``\n"
             "   1 | s.pov +O\n     |         ^\n"),
            ("what cannot be followed", ["s.pov", "+UF"],
             "command line:1:7: error[E0706]: `Field_Render` cannot be followed: rtlang draws whole frames, not "
             "fields of every other row\n   1 | s.pov +UF\n     |       ^~~\n"),
            ("what cannot be turned off", ["s.pov", "-UR"],
             "command line:1:7: error[E0706]: `Remove_Bounds` cannot be followed: rtlang has no bounds that could "
             "cut an object\n   1 | s.pov -UR\n     |       ^~~\n"),
            ("a grey picture", ["s.pov", "+FN16g"],
             "command line:1:10: error[E0706]: `Grayscale_Output` cannot be followed: rtlang writes pictures in "
             "colour\n   1 | s.pov +FN16g\n     |          ^~~\n"),
            ("a command", ["refused.ini"],
             "refused.ini:2:1: error[E0706]: `Post_Frame_Command` cannot be followed: rtlang runs no programs\n"
             "   2 | Post_Frame_Command=rm %o\n     | ^~~~~~~~~~~~~~~~~~\n"),
            ("a file that names itself", ["self.ini"],
             "self.ini:2:3: error[E0707]: `self.ini` is being read already: it names itself\n"
             "   2 |   self.ini\n     |   ^~~~~~~~\n"),
            ("files that name each other", ["a.ini"],
             "b.ini:2:2: error[E0707]: `a.ini` is being read already: it names itself\n"
             "   2 |  a.ini\n     |  ^~~~~\n"),
            ("a file that is missing", ["s.pov", "nothere.ini"],
             "command line:1:7: error[E0501]: `nothere.ini` not found\n"
             "   1 | s.pov nothere.ini\n     |       ^~~~~~~~~~~\n"),
            ("a file that is no text", ["binary.ini"],
             "command line:1:1: error[E0502]: cannot read `binary.ini`: Invalid argument\n"
             "   1 | binary.ini\n     | ^~~~~~~~~~\n"),
            ("a folder for a file", ["s.pov", "Include_Ini=/"],
             "command line:1:19: error[E0501]: `/.ini` not found\n"
             "   1 | s.pov Include_Ini=/\n     |                   ^\n"
             "     = help: a scene is named with its ending, or by +I\n"),
            ("no scene", ["+W8"],
             "rtlang: error[E0708]: no scene is named\n     = help: a word that ends with .pov, or +I, names one\n"),
            ("alpha where there is none", ["s.pov", "+UA", "+FJ"],
             "rtlang: error[E0708]: `Output_Alpha` wants a picture in PNG, Targa or OpenEXR\n"
             "     = help: +FN, +FT or +FE says so\n"),
            ("a part that is none", ["s.pov", "+W32", "+SC40"],
             "rtlang: error[E0708]: no pixel lies in the rows and columns that are asked for\n"
             "     = help: they are counted from 1; a number below 1 is a share of the picture\n"),
            ("an option of rtlang's own", ["s.pov", "--tiles=3"],
             "rtlang: error[E0703]: unknown option `--tiles=3`\n")]:
        with tempfile.TemporaryDirectory() as folder:
            done = run(folder, "--povray", *words, files=named)
            tap.equal((done.returncode, done.stderr.decode()), (1, said), "wrong: " + what)
            tap.equal([name for name in os.listdir(folder) if name.endswith(".png")], [], "no picture: " + what)


def check_warnings():
    with tempfile.TemporaryDirectory() as folder:
        done = run(folder, "s.pov", "x.ini[none]", "+W8", "+H6", "-GD", "-GR", "-GS", files={"x.ini": "[some]\n"})
        tap.equal((done.returncode, done.stderr.decode()),
                  (0, "command line:1:7: warning[W0702]: `x.ini` has no section `none`\n"
                      "   1 | s.pov x.ini[none] +W8 +H6 -GD -GR -GS\n     |       ^~~~~~~~~~~\n"),
                  "a section that is not there")
        done = run(folder, "s.pov", "+H6", "-GD", "-GR", "-GS", POVINI="",
                   files={"povray.ini": "Width=9\nLibrary_Path=/\n"})
        tap.equal((done.returncode, done.stderr.decode(), size(folder, "s.png")),
                  (0, "./povray.ini:2:14: warning[W0701]: `Library_Path` is not followed in a povray.ini of the "
                      "current folder, which could let a scene beside it read what it should not\n"
                      "   2 | Library_Path=/\n     |              ^\n"
                      "     = help: +L and an .ini file that is named add folders\n", (9, 6)), "./povray.ini")


def size(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return struct.unpack(">II", file.read(24)[16:])


def read(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return file.read()


def check_streams():
    own = {"s2.pov": SCENE + '#warning "careful"\n'}
    drawn = re.compile(r"s2\.pov: 8 by 6 to s2\.png\n")
    with tempfile.TemporaryDirectory() as folder:
        done = run(folder, "+Is2.pov", "+W8", "+H6", "+GAall.txt", "+GDd.txt", "Warning_File=yes", "-GW", files=own)
        said = done.stderr.decode()
        tap.ok(done.returncode == 0 and drawn.match(said) and "clock 0.000" in said and "careful" not in said and
               "s2.png: 8x6" in said and not done.stdout, "streams: on the console", said)
        tap.equal(read(folder, "d.txt"), "clock 0.000, frame 0 of 0\n", "streams: Debug_File")
        told = read(folder, "warning.out")
        tap.ok("careful" in told and "clock" not in told, "streams: Warning_File=yes", told)
        told = read(folder, "all.txt")
        tap.ok(all(word in told for word in ("8 by 6", "clock", "careful", "8x6")), "streams: All_File", told)
        done = run(folder, "+Is2.pov", "+W8", "+H6", "-GA", "Append_File=on", "+GDd.txt", "-GD", files=own)
        tap.equal((done.returncode, done.stderr, read(folder, "d.txt")),
                  (0, b"", 2 * "clock 0.000, frame 0 of 0\n"), "streams: none on the console, appended")
        done = run(folder, "+Is2.pov", "+W8", "+H6", "+WL0", "-GR", "-GS", "-GD", files=own)
        tap.equal(done.stderr, b"", "streams: Warning_Level")
        done = run(folder, "+Inone.pov", "-GA")
        tap.equal((done.returncode, done.stderr), (1, b""), "streams: an error that nobody wants to read")
        done = run(folder, "+Is2.pov", "+W8", "+H6", "+GDnowhere/d.txt", files=own)
        tap.equal((done.returncode, done.stderr.decode()),
                  (1, "rtlang: error[E0505]: cannot write `nowhere/d.txt`: No such file or directory\n"),
                  "streams: a file that cannot be written")


def check_meant():
    """When a command line is POV-Ray's, and when it is rtlang's own."""
    with tempfile.TemporaryDirectory() as folder:
        link = os.path.join(folder, "povray")
        os.symlink(PROGRAM, link)
        for what, arguments, program, expected in [
                ("called povray", ["s.pov", "-W7", "-H5"], link, (7, 5)),
                ("--povray", ["-H5", "-W7", "--povray", "s.pov"], None, (7, 5)),
                ("a word with +", ["-D", "+Is.pov", "-W7", "-H5"], None, (7, 5)),
                ("an .ini file", ["-W7", "a.INI"], None, (7, 4)),
                ("a key", ["s.pov", "width=7", "-H5"], None, (7, 5)),
                ("rtlang's own -D", ["-D", "Width=9", "-W", "12", "-H", "5", "-o", "s.png", "s.pov"], None, (12, 5)),
                ("rtlang's own options within", ["+Is.pov", "+W7", "+H5", "--samples=4", "--quiet"], None, (7, 5))]:
            done = run(folder, *arguments, program=program, files={"a.INI": "s.pov\n+H4"})
            fine = done.returncode == 0 and os.path.exists(os.path.join(folder, "s.png"))
            tap.equal(fine and size(folder, "s.png"), expected, "meant: " + what)
            if fine:
                os.unlink(os.path.join(folder, "s.png"))
        done = run(folder, "-h", program=link)
        tap.ok(done.returncode == 0 and done.stdout.startswith(b"Usage: povray ["), "help: povray -h", done.stderr)
        done = run(folder, "--help=povray")
        tap.ok(done.returncode == 0 and done.stdout.startswith(b"Usage: povray ["), "help: rtlang --help=povray")
        done = run(folder, "--help=me")
        tap.equal((done.returncode, done.stderr.decode()),
                  (2, "rtlang: error[E0703]: option `--help` wants povray or nothing, found `me`\n"
                      "     = help: rtlang --help lists the options\n"), "help: of something else")


def check_manual():
    """No key and no switch of the manual is unknown; each has its line in the help."""
    with tempfile.TemporaryDirectory() as folder:
        shown = run(folder, "--help=povray").stdout.decode()
        for name in KEYS.split():
            said = run(folder, "s.pov", "+W8", "+H6", f"{name}=1").stderr.decode()
            tap.ok("E0704" not in said and re.search(rf"^  {name} ", shown, re.MULTILINE), f"the manual's {name}", said)
        for name in SWITCHES.split():
            said = run(folder, "+Is.pov", "+W8", "+H6", "+" + name).stderr.decode()
            tap.ok("E0704" not in said and re.search(rf"^  \w+ +\+-?(?:\w+ \+)?{name}(?:x|\[|\s)", shown, re.MULTILINE),
                   f"the manual's +{name}", said)


def check_files():
    """Sections, comments, quotes, files within files, the header, libraries, and the file that says it all again."""
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, "lib dir"))
        files = {"a.ini": "# all of it\n; here\n +W20\t+H10 ; size\nInput_File_Name = \"s two.pov\"\nDeclare=Red=0.5\n"
                          "[ Really Small ]\nWIDTH=7.9\n[other]\nHeight=3\n[really small]\n+H5 nested.ini\n",
                 "nested.ini": "Library_Path='lib dir'\n+HI'head.inc' Antialias=On\n",
                 "head.inc": "#declare Green = 0.25;\n", "lib dir/deep.inc": "#declare Blue = 0.75;\n",
                 "s two.pov": SCENE + '#include "deep.inc"\n#debug concat(str(Red, 0, 2), str(Green, 0, 2), '
                                      'str(Blue, 0, 2), "\\n")\n'}
        done = run(folder, "a.ini[REALLY SMALL]", "+GIagain.ini", "-GS", "-GR", files=files)
        tap.equal((done.returncode, done.stderr.decode()[-13:]), (0, "0.500.250.75\n"), "files: what they say")
        tap.equal("s two.png" in os.listdir(folder) and size(folder, "s two.png"), (7, 5), "files: size")
        with open(os.path.join(folder, "s two.png"), "rb") as file:
            first = file.read()
        os.unlink(os.path.join(folder, "s two.png"))
        done = run(folder, "again.ini", files=files)
        with open(os.path.join(folder, "s two.png"), "rb") as file:
            tap.ok(done.returncode == 0 and file.read() == first, "files: Create_Ini says the same again", done.stderr)
        with open(os.path.join(folder, "again.ini"), encoding="ascii") as file:
            told = file.read()
        done = run(folder, "again.ini", "+GIonce.ini", files=files)
        with open(os.path.join(folder, "once.ini"), encoding="ascii") as file:
            tap.equal(file.read(), told.replace("again.ini", "once.ini"), "files: and so does its own")


def check_frames():
    with tempfile.TemporaryDirectory() as folder:
        moving = {"s.pov": SCENE + "sphere { <2 * clock, 0, 0>, 0.5 }\n"}
        done = run(folder, "--frames=8..10", "--clock-from=0.5", "--clock-to=1", "-W", "16", "-H", "12", "-q", "s.pov",
                   files=moving)
        tap.equal((done.returncode, done.stderr.decode()),
                  (0, "".join("clock %s, frame %d of 10\n" % pair for pair in
                              (("0.500", 8), ("0.750", 9), ("1.000", 10)))), "frames: rtlang's own options")
        for frame, clock in ((8, "0.5"), (9, "0.75"), (10, "1")):
            run(folder, "-K", clock, "-W", "16", "-H", "12", "-q", "s.pov", files=moving)
            with open(os.path.join(folder, "s.png"), "rb") as one, \
                    open(os.path.join(folder, "s%02d.png" % frame), "rb") as of_many:
                tap.ok(png_without_texts(one.read()) == png_without_texts(of_many.read()), "frames: %d is the picture of its clock" % frame)
        done = run(folder, "+Is.pov", "+KFF3", "+W4", "+H3", "+FP", "+O-", "-GA", files=moving)
        tap.equal((done.returncode, done.stdout.count(b"P6\n4 3\n255\n"), len(done.stdout)), (0, 3, 3 * (11 + 36)),
                  "frames: into a pipe")
        done = run(folder, "--frames=3..1", "s.pov")
        tap.equal((done.returncode, done.stderr.decode()),
                  (2, "rtlang: error[E0703]: option `--frames` wants the first and the last frame, as 1..100, found "
                      "`3..1`\n"
                      "     = help: rtlang --help lists the options\n"), "frames: backwards")
        wrong = {"s.pov": SCENE + "#if (clock > 0) sphere { 0 } #end\n"}
        done = run(folder, "+Is.pov", "+KFF3", "+W4", "+H3", "+Obad", "-GS", "-GR", "-GD", files=wrong)
        tap.ok(done.returncode == 1 and done.stderr.count(b"error[") == 1 and
               "bad1.png" in os.listdir(folder) and "bad3.png" not in os.listdir(folder),
               "frames: the first that is wrong ends it", done.stderr)


def check_scenes():
    with tempfile.TemporaryDirectory() as folder:
        files = {"a.scn": SCENE, "wrong.scn": "sphere { 0 }", "b.scn": SCENE}
        done = run(folder, "-W", "8", "-H", "6", "a.scn", "wrong.scn", "missing.scn", "b.scn", files=files)
        said = done.stderr.decode()
        tap.ok(done.returncode == 3 and "a.png: 8x6" in said and "b.png: 8x6" in said and "wrong.scn:1:" in said and
               "`missing.scn` not found" in said and said.index("a.png") < said.index("wrong.scn"),
               "scenes: each is drawn, and the worst counts", said)
        done = run(folder, "-o", "x.png", "a.scn", "b.scn", files=files)
        tap.equal((done.returncode, done.stderr.decode()),
                  (2, "rtlang: error[E0703]: one file for the pictures of more than one scene: `a.scn` and `b.scn`\n"
                      "     = help: rtlang --help lists the options\n"), "scenes: one file for two pictures")


def check_interrupt():
    with tempfile.TemporaryDirectory() as folder:
        run(folder, "--check", "s.pov")
        with open(os.path.join(folder, "slow.pov"), "w", encoding="ascii") as file:
            file.write(SCENE + "#declare I = 0; #while (I < 1e9) #declare I = I + 1; #end\n")
        process = subprocess.Popen([PROGRAM, "+Islow.pov", "--max-steps=2000000000"], cwd=folder,
                                   stderr=subprocess.PIPE)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
        tap.ok(process.returncode == 2 and said.endswith(b"rtlang: interrupted; nothing was written\n"),
               "an interrupt ends it with status 2", said)


def main():
    for check in (check_messages, check_warnings, check_streams, check_meant, check_manual, check_files, check_frames,
                  check_scenes, check_interrupt):
        check()
    tap.done()


if __name__ == "__main__":
    main()
