#!/usr/bin/env python3
# The program as its users meet it: messages and exit codes of bad input, what is on the disk after a failure, a kill or
# an interrupt, every option, memory, progress. Prints TAP.
#
# Wants RTLANG (the program) and top_srcdir. `run_system.py --update` writes expected/*.txt anew from what the program
# says; read the difference before committing it.
#
# SPDX-License-Identifier: MIT
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import faults
import processes
from picture_bytes import png_header, png_first_pixel, png_without_texts, exr_channel_types
from tap import Tap

RTLANG = os.path.abspath(os.environ["RTLANG"])
HERE = os.path.dirname(os.path.abspath(__file__))
OLD_PICTURE = b"an old picture"
tap = Tap()


def rtlang(*arguments, **how):
    """Runs the program in the current folder; its exit code is negative after a signal."""
    how = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "timeout": 300, **how}
    return subprocess.run([RTLANG, *arguments], **how)


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def picture(scene, *arguments):
    """The bytes of the picture of a scene's text, but for what it says of scene and options."""
    write("picture.scn", scene)
    result = rtlang("-q", "-W", "64", "-H", "48", *arguments, "-o", "picture.png", "picture.scn")
    return png_without_texts(read("picture.png")) if result.returncode == 0 else result.stderr


# ---- messages

def check_message(name, result):
    path = os.path.join(HERE, "expected", name + ".txt")
    message = result.stderr
    if name in faults.WANT_OPENIMAGEIO and b"E0507" in message:
        tap.skip("message: " + name, "built without OpenImageIO")
        return
    # What OpenImageIO says of a format is its own; the folders of include files depend on the machine.
    message = re.sub(rb"(no picture format):.*", rb"\1", message)
    message = re.sub(rb", `[^`]*(?:share/rtlang|/povray[^`]*|/openbabel/[^`]*)`", b"", message)
    message = re.sub(rb"(shapes needs) [0-9.]+ MiB", rb"\1 some MiB", message)  # depends on the sizes of records
    found = b"exit %d\n" % result.returncode + message
    if "--update" in sys.argv:
        write(path, found)
    tap.equal(found, read(path) if os.path.exists(path) else b"", "message: " + name)


def unprivileged():
    """How to run as somebody to whom permissions apply; None where that cannot be."""
    if os.geteuid() != 0:
        return {}
    how = {"user": 65534, "group": 65534, "extra_groups": []}
    try:
        return how if rtlang("--version", **how).returncode == 0 else None
    except (OSError, subprocess.SubprocessError):
        return None


def make_closed_files():
    """What an unprivileged user may not read or write, in a folder where they may write."""
    write("secret.scn", faults.GOOD)
    write("secret.inc", b"")
    write("include_secret.scn", b'#include "secret.inc"\n')
    write("read_only.png", OLD_PICTURE)
    os.mkdir("closed")
    for path, mode in [("secret.scn", 0), ("secret.inc", 0), ("read_only.png", 0o444), ("closed", 0o555), (".", 0o777)]:
        os.chmod(path, mode)


def test_messages():
    for name, data in faults.FILES.items():
        write(name, data)
    os.mkdir("folder.png")
    os.symlink("/dev/full", "full.png")
    os.symlink("/etc/passwd", "link.txt")
    os.symlink("/etc/no such file", "dangling.txt")
    os.mkfifo("pipe.inc")
    write("../outside.txt", b"1")
    write("old.png", OLD_PICTURE)
    for name, scene in faults.SCENES.items():
        write(name + ".scn", scene)
        before = set(os.listdir())
        check_message(name, rtlang("-q", "-o", "old.png", name + ".scn"))
        if name in faults.DRAWN:
            tap.equal(png_header(read("old.png"))[:2], (320, 240), name + ": a picture all the same")
            write("old.png", OLD_PICTURE)
        else:
            tap.equal((read("old.png"), set(os.listdir()) - before), (OLD_PICTURE, set()),
                      name + ": old picture untouched")
    before = set(os.listdir())
    for name, arguments in faults.COMMANDS.items():
        check_message(name, rtlang("-q", *arguments))
    for name, arguments in faults.COMMANDS_FULL.items():
        with open("/dev/full", "wb") as full:
            check_message(name, rtlang("-q", *arguments, stdout=full))
    tap.equal(set(os.listdir()) - before, set(), "commands that fail leave no files")


def test_expected():
    cases = {*faults.SCENES, *faults.COMMANDS, *faults.COMMANDS_FULL, *faults.COMMANDS_UNPRIVILEGED}
    expected = {name[:-4] for name in os.listdir(os.path.join(HERE, "expected"))}
    tap.equal(expected, cases, "a case for each expected message")


def test_permissions():
    how = unprivileged()
    make_closed_files()
    for name, arguments in faults.COMMANDS_UNPRIVILEGED.items():
        if how is None:
            tap.skip("message: " + name, "permissions do not apply to this user")
        else:
            check_message(name, rtlang("-q", *arguments, **how))
    tap.equal(read("read_only.png"), OLD_PICTURE, "a read-only picture is left as it was")


# ---- options

def test_output():
    os.mkdir("scenes")
    write("scenes/one.two.scn", faults.GOOD)
    result = rtlang("-q", "scenes/one.two.scn")
    tap.ok(result.returncode == 0 and os.path.exists("one.two.png"),
           "default output: the name with .png, in the current folder")
    tap.equal((result.stdout, result.stderr), (b"", b""), "--quiet says nothing")
    default = read("one.two.png")
    tap.equal(rtlang("-q", "-o", "-", "scenes/one.two.scn").stdout, default, "-o - writes the bytes of the file")
    write("old.png", OLD_PICTURE)
    os.symlink("old.png", "link.png")
    rtlang("-q", "-o", "link.png", "scenes/one.two.scn")
    tap.equal((os.readlink("link.png"), read("old.png")), ("old.png", default),
              "an old picture behind a link is replaced")


def test_threads():
    write("good.scn", faults.GOOD)
    examples = os.path.join(os.environ["top_srcdir"], "examples")
    scenes = [os.path.join(examples, name) for name in ("05_glass_and_filters.scn", "10_sphere_flake.scn")]
    for scene in ["good.scn", *scenes]:
        pictures = [rtlang("-q", "-t", threads, "-o", "-", scene).stdout for threads in ("1", "2", "7")]
        tap.ok(pictures[0][:4] == b"\x89PNG" and len(set(pictures)) == 1,
               os.path.basename(scene) + ": the same bytes from 1, 2 and 7 threads")
        sets = [rtlang("-q", "--isa", name, "-o", "-", scene) for name in ("plain", "v2", "v3", "v4")]
        there = [run.stdout for run in sets if run.returncode == 0]
        tap.ok(there and all(picture == pictures[0] for picture in there),
               os.path.basename(scene) + f": the same bytes from {len(there)} instruction sets")


def test_size_and_values():
    grey = b"#version 3.7; global_settings { assumed_gamma 1 } background { rgb 0.5 }\n"
    write("grey.scn", grey)
    tap.equal(png_header(rtlang("-o", "-", "grey.scn").stdout), (320, 240, 8), "size and depth by default")
    tap.equal(png_header(rtlang("-W", "7", "-H", "5", "-o", "-", "grey.scn").stdout)[:2], (7, 5), "-W, -H")
    tap.equal(png_header(rtlang("--width=9", "--height=3", "-o", "-", "grey.scn").stdout)[:2], (9, 3),
              "--width, --height")
    # Half of the light: 1/2 by the sRGB curve, by no curve, by the power 1/2.2; times 255 and 65535.
    for gamma, depth, value in [("srgb", 8, 188), ("1", 8, 128), ("2.2", 8, 186),
                                ("srgb", 16, 48192), ("1", 16, 32768), ("2.2", 16, 47824)]:
        found = rtlang("--file-gamma", gamma, "--depth", str(depth), "-o", "-", "grey.scn").stdout
        tap.equal((png_header(found)[2], png_first_pixel(found)), (depth, (value,) * 3),
                  "--file-gamma %s --depth %d" % (gamma, depth))
    tap.equal(png_without_texts(rtlang("-o", "-", "grey.scn").stdout),
              png_without_texts(rtlang("--file-gamma=srgb", "--depth=8", "-o", "-", "grey.scn").stdout),
              "sRGB in 8 bits is the default")
    result = rtlang("-q", "-o", "grey.exr", "grey.scn")
    if b"E0507" in result.stderr:
        tap.skip("EXR holds floats by default", "built without OpenImageIO")
    else:
        tap.equal(exr_channel_types(read("grey.exr")), {"R": "float", "G": "float", "B": "float"},
                  "EXR holds floats by default")


def test_names_and_folders():
    write("size.scn", b'#debug concat(str(image_width, 0, 0), "x", str(image_height, 0, 0), "\\n")\n' + faults.GOOD)
    tap.equal(rtlang("--check", "-W", "33", "-H", "44", "size.scn").stderr, b"33x44\n", "image_width and image_height")
    literal = picture(faults.GOOD.replace(b"0, 1 ", b"0, 1.5 "))
    named = faults.GOOD.replace(b"0, 1 ", b"0, Size + Shift ")
    tap.equal(picture(named, "-D", "Size=2", "--declare=Shift=-0.5"), literal, "-D and --declare declare numbers")
    tap.equal(picture(named, "-D", "Size=2", "-DShift=-0.5", "-D", "Size=9"), literal,
              "of two -D of a name the first holds")
    for folder in "first", "second":
        os.mkdir(folder)
        write(folder + "/both.inc", b'#debug "both from ' + folder.encode() + b'\\n"\n')
        write(folder + "/%s.inc" % folder, b'#debug "' + folder.encode() + b'\\n"\n')
    write("includes.scn", b'#include "both.inc"\n#include "first.inc"\n#include "second.inc"\n' + faults.GOOD)
    for order in ["first", "second"], ["second", "first"]:
        result = rtlang("--check", "-I", order[0], "--include-path=" + order[1], "includes.scn")
        tap.equal((result.returncode, result.stderr), (0, b"both from %s\nfirst\nsecond\n" % order[0].encode()),
                  "-I and --include-path: first %s, then %s" % tuple(order))


def test_data_files():
    write("line_ends.scn", b"""#fopen File "data.txt" read
#while (defined(File)) #read (File, X, Y) #debug concat(str(X, 0, 0), " ", str(Y, 0, 0), "\\n") #end
""" + faults.GOOD)
    for name, end in ("LF", b"\n"), ("CRLF", b"\r\n"), ("CR", b"\r"):
        write("data.txt", b"1, 2," + end + b"3, -4" + end)
        tap.equal(rtlang("--check", "line_ends.scn").stderr, b"1 2\n3 -4\n", "a data file with ends of lines " + name)
    # Values that fall on the ends of the blocks in which a file is read.
    values = [str(i / 7) for i in range(60000)]
    for shift in range(0, 40, 3):
        write("data.txt", b" " * shift + ", /* x */\n".join(values).encode())
        write("sum.scn", b"""#fopen File "data.txt" read
#declare Sum = 0; #declare N = 0;
#while (defined(File)) #read (File, X) #declare Sum = Sum + X; #declare N = N + 1; #end
#debug concat(str(N, 0, 0), " ", str(Sum, 0, 3), "\\n")
""" + faults.GOOD)
        total = 0.0
        for value in values:
            total += float(value)
        tap.equal(rtlang("--check", "sum.scn").stderr.decode(), "60000 %.3f\n" % total,
                  "sixty thousand values after %d blanks" % shift)


def test_folders_that_may_be_read():
    for folder in "scenes", "scenes/below", "library", "data":
        os.mkdir(folder)
        write(folder + "/here.inc", b'#debug "%s\\n"\n' % folder.encode())
    write("cwd.inc", b'#debug "cwd\\n"\n')
    os.symlink("../data", "scenes/link")
    os.symlink("../../data/here.inc", "scenes/below/link.inc")
    os.symlink("library", "library_link")
    real = os.path.realpath("data")
    cases = [  # name in the scene, options, what is said or the folder that is to be allowed
        ("scenes/here.inc", [], "scenes"),
        ("scenes/below/../here.inc", [], "scenes"),
        ("scenes/below/here.inc", [], "scenes/below"),
        (os.path.realpath("scenes") + "/here.inc", [], "scenes"),
        ("cwd.inc", [], (".",)),
        ("cwd.inc", ["-I", "."], "cwd"),
        ("cwd.inc", ["--allow-read", "."], "cwd"),
        ("here.inc", ["-I", "library"], "library"),
        ("here.inc", ["-I", "library_link"], "library"),
        ("data/here.inc", [], ("data",)),
        ("scenes/../data/here.inc", [], ("scenes/../data",)),
        ("scenes/link/here.inc", [], ("scenes/link",)),
        ("scenes/below/link.inc", [], (real,)),
        ("scenes/link/here.inc", ["--allow-read=nowhere", "--allow-read=data"], "data"),
        ("scenes/below/link.inc", ["--allow-read=" + real], "data"),
        ("library/here.inc", ["-I", "lib", "--allow-read", "librar"], ("library",)),
        ("/dev/stdin", [], ("/dev",)),
    ]
    for name, options, wanted in cases:
        for use in '#include "%s"\n', '#fopen File "%s" read\n', '#declare A = file_exists("%s");\n':
            write("scenes/test.scn", (use % name).encode() + faults.GOOD)
            result = rtlang("--check", *options, "scenes/test.scn")
            said = result.stderr.decode()
            if isinstance(wanted, tuple):
                fine = result.returncode == 3 and "error[E0508]" in said and \
                    "`--allow-read %s`" % wanted[0] in said
            else:
                fine = result.returncode == 0 and said == (wanted + "\n" if "include" in use else "")
            tap.ok(fine, "%s with %s: %s" % (use.split()[0], name, " ".join(options)), said)


def test_clock():
    write("clock.scn", b"""#debug concat(str(clock, 0, 4), " ", str(clock_on, 0, 0), " ", input_file_name, "\\n")
""" + faults.GOOD)
    os.mkdir("folder")
    shutil.copy("clock.scn", "folder/clock.scn")
    for options, said in ([], "0.0000 0"), (["-K", "0.25"], "0.2500 1"), (["--clock=-2.5"], "-2.5000 1"), \
            (["-K0"], "0.0000 1"), (["-K", "1", "-K", "1e-3"], "0.0010 1"):
        tap.equal(rtlang("--check", *options, "folder/clock.scn").stderr.decode(), said + " clock.scn\n",
                  "clock: " + " ".join(options))


def test_standard_input():
    whole = picture(faults.GOOD)
    options = ["-q", "-W", "64", "-H", "48"]
    piped = rtlang(*options, "-o", "-", "-", stdin=None, input=faults.GOOD).stdout
    tap.equal(png_without_texts(piped), whole, "a scene from a pipe")
    write("good.scn", faults.GOOD)
    with open("good.scn", "rb") as file:
        result = rtlang(*options, "-", stdin=file)
    tap.equal((result.returncode, read("stdin.png")), (0, piped), "a scene from a file: stdin.png")
    write("here.inc", b'#debug concat(input_file_name, "\\n")\n')
    result = rtlang("--check", "-", stdin=None, input=b'#include "here.inc"\nsphere { 0, x }\n')
    tap.equal((result.returncode, result.stderr.split(b"\n")[:2]),
              (1, [b"<stdin>", b"<stdin>:2:13: error[E0202]: expected a number, found a vector of 3"]),
              "standard input: messages, and files of the current folder")
    tap.equal(rtlang("--dump=ast", "-", stdin=None, input=faults.GOOD).stdout,
              rtlang("--dump=ast", "good.scn").stdout, "a dump of standard input")


def test_old_permissions():
    write("good.scn", faults.GOOD)
    for mode in 0o600, 0o640, 0o666:
        write("old.png", OLD_PICTURE)
        os.chmod("old.png", mode)
        rtlang("-q", "-o", "old.png", "good.scn")
        tap.equal((os.stat("old.png").st_mode & 0o7777, read("old.png")[:4]), (mode, b"\x89PNG"),
                  "a picture of mode %o keeps it" % mode)


def test_actions():
    write("good.scn", faults.GOOD)
    before = set(os.listdir())
    result = rtlang("--check", "good.scn")
    tap.equal((result.returncode, result.stdout, result.stderr), (0, b"", b""), "--check of a good scene says nothing")
    write("wrong.scn", faults.SCENES["wrong_type"])
    tap.equal(rtlang("--check", "wrong.scn").returncode, 1, "--check of a wrong scene fails")
    tokens = rtlang("--dump=tokens", "good.scn").stdout
    tap.ok(tokens.startswith(b"1:1 word `camera`\n1:8 mark `{`\n"), "--dump=tokens", tokens)
    tap.equal(set(os.listdir()) - before, {"wrong.scn"}, "--check and --dump write no files")
    for stage in "ast", "scene":
        dump = rtlang("--dump=" + stage, "good.scn").stdout
        write("dump.scn", dump)
        tap.ok(dump and rtlang("--dump=" + stage, "dump.scn").stdout == dump, "--dump=%s of its own dump" % stage, dump)
        tap.equal(picture(dump), picture(faults.GOOD), "--dump=%s is a scene of the same picture" % stage)
    write("lights.scn", b"#declare R = seed(1);\n#for (I, 1, 200) light_source { 9*y, 1 area_light <rand(R), 1, rand(R)>, "
                        b"<1, rand(R), rand(R)>, 3, 3 circular orient rotate 360*<rand(R), rand(R), rand(R)> } #end\n"
                        b"difference { sphere { 0, 1 } union { } }\nunion { union { } inverse }\nmerge { }\n")
    dump = rtlang("--dump=scene", "lights.scn").stdout
    write("dump.scn", dump)
    tap.ok(dump.count(b"orient") == 200 and rtlang("--dump=scene", "dump.scn").stdout == dump,
           "--dump=scene of its own dump: lights that turn to what they light, empty unions", dump)
    version = rtlang("--version")
    tap.ok(version.returncode == 0 and re.fullmatch(rb"rtlang \d+\.\d+\.\d+\nconfinement: .+\n", version.stdout), "--version", version)
    usage = rtlang("--help")
    tap.equal((usage.returncode, usage.stderr), (0, b""), "--help")
    lines = usage.stdout.decode().split("\n")
    tap.equal([line for line in lines if len(line) > 80], [], "--help has lines of 80 columns at most")
    headings = [at for at, line in enumerate(lines) if re.fullmatch(r"[A-Z].*:", line)]
    first = [line for line in lines[headings[0]:headings[1]] if re.match(r"  .{4}--", line)]
    tap.ok(len(headings) >= 8 and len(first) == 5, "--help has groups, and first the five options that most runs need", first)
    options = "clock allow-read max-steps max-depth max-objects max-text max-memory max-messages output width height threads " \
        "include-path declare depth file-gamma check dump quiet version help"
    for option in options.split():
        tap.ok(b"--" + option.encode() in usage.stdout, "--help tells of --" + option)


def test_summary():
    write("good.scn", faults.GOOD)
    form = (r"%s: 32x24, 1 object, 1 light; rays: 768 camera, \d+ shadow, 0 reflected, 0 transmitted; "
            r"seconds: parse \d+\.\d{3}, prepare \d+\.\d{3}, trace \d+\.\d{3}, write \d+\.\d{3}\n")
    for output, name in ("good.png", r"good\.png"), ("-", "standard output"):
        found = rtlang("-W", "32", "-H", "24", "-o", output, "good.scn").stderr.decode()
        tap.ok(re.fullmatch(form % name, found), "one line of summary for -o " + output, found)
    # Seven of a kind, of which five are told, one of another, and one that is not of the range.
    lost = b"#for (I, 1, 7) sphere { <2e20, I, 0>, 1 } #end sphere { 0, 1e-200 } disc { 0, 0, 1 }\n"
    write("beyond.scn", b"camera { location <2e20, 0, -1e6> direction z } light_source { <2e20, 9, -9>, 1 }\n" + lost)
    found = rtlang("-W", "32", "-H", "24", "-o", "beyond.png", "beyond.scn").stderr.decode()
    tap.ok(re.search(r"write \d+\.\d{3}; \d+ warnings, 8 of them of the range of numbers\n$", found) and
           found.count("warning[W0440]") == 5 and "2 more of this warning are not shown" in found,
           "the summary counts what is beyond the range of numbers", found)


TESTS = [test_messages, test_expected, test_permissions, test_output, test_threads, test_size_and_values,
         test_names_and_folders, test_data_files, test_folders_that_may_be_read, test_clock, test_standard_input,
         test_old_permissions, test_actions, test_summary]


def main():
    os.environ["LC_ALL"] = "C"
    with tempfile.TemporaryDirectory(prefix="rtlang-system-") as top:
        os.chmod(top, 0o755)
        for test in TESTS + processes.tests(tap, RTLANG):
            folder = os.path.join(top, test.__name__)
            os.mkdir(folder)
            os.chdir(folder)
            test()
            os.chdir(top)
            shutil.rmtree(folder)
    tap.done()


if __name__ == "__main__":
    main()
