#!/usr/bin/env python3
"""Animations: each frame has the pixels of a single run, and the scene is read once where only camera and lights move.

The expected pictures are those of single runs with the same clock and names. Prints TAP. SPDX-License-Identifier: MIT
"""
import json
import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tap  # noqa: E402
from picture_bytes import png_without_texts  # noqa: E402
from terminal import terminal_output  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])
FRAMES = 4
HEAD = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
CAMERA = "camera { location <3 * sin(clock * 3), 2, -6> look_at 0 }\n"
STILL = "camera { location <0, 2, -6> look_at 0 }\n"
LIGHT = "light_source { <5, 5, -5> rgb 1 }\n"
BALLS = "".join(f"sphere {{ <{i % 5 - 2}, {i // 5 - 2}, 0>, 0.4 pigment {{ rgb <{i / 25}, 0.5, 0.2> }} }}\n" for i in range(25))
ALL_KINDS = """sphere { <TIME, 1, -2>, 0.3 pigment { rgb <1, 0, 0> } }
plane { y, TIME - 3 pigment { checker rgb 1 rgb 0 } }
box { <TIME, -1, -2>, <TIME + 0.5, -0.5, -1> pigment { rgb <0, 1, 0> } }
sphere { 0, 0.3 scale <1, 2, 1> translate <-2, TIME, -1> pigment { rgb <0, 0, 1> } }
difference { box { -0.3, 0.3 } sphere { 0, 0.35 } rotate y * 90 * TIME translate <1.5, 0, -2> pigment { rgb <1, 1, 0> } }
union { sphere { 0, 0.2 pigment { rgbt <1, 1, 1, 0.7> } } sphere { x / 2, 0.2 pigment { rgb 1 } } interior { ior 1.3 } translate -2 * z - TIME * x }
sphere { <0, TIME, -3>, 0.4 pigment { rgbt <0.9, 1, 1, 0.9> } interior { ior 1.5 } }
torus { 0.4, 0.1 translate <TIME, -1.5, -2> pigment { rgb <1, 0, 1> } }
"""
FILES = {
    "balls.inc": BALLS, "names.inc": "#declare Far = 6;\n#declare Unused = sphere { 0, 1 }\n",
    "moving.inc": "sphere { <clock, 0, 0>, 1 pigment { rgb 1 } }\n", "numbers.txt": "1, 2, 3\n",
    "view.inc": CAMERA + LIGHT, "where.inc": "#declare Where = clock;\n",
}
# name -> (text, how often the scene is read, how often its tree is built)
ONCE, EACH, TAIL = (1, 1), (FRAMES, FRAMES), (1, FRAMES)
CASES = {
    "the camera moves": (HEAD + CAMERA + LIGHT + BALLS, ONCE),
    "the camera stands at the end": (HEAD + LIGHT + BALLS + CAMERA, ONCE),
    "a light moves": (HEAD + STILL + LIGHT + BALLS + "light_source { <5 * clock, 5, -5> rgb <1, 0, 0> }\n" + BALLS, ONCE),
    "the background changes": (HEAD + STILL + LIGHT + "background { rgb clock }\n" + BALLS, ONCE),
    "nothing moves": (HEAD + STILL + LIGHT + BALLS, ONCE),
    "shapes from a file": (HEAD + CAMERA + '#include "balls.inc"\n' + LIGHT, ONCE),
    "a number from a file": (HEAD + '#include "names.inc"\ncamera { location <clock, 2, -Far> look_at 0 }\n' + LIGHT + BALLS, ONCE),
    "by names of names": (HEAD + "#declare A = clock;\n#declare B = A * 2;\n" + BALLS +
                          "camera { location <B, 2, -6> look_at 0 }\n" + LIGHT, ONCE),
    "a name is written again later": (HEAD + "#declare B = clock;\ncamera { location <B, 2, -6> look_at 0 }\n#declare B = 0.5;\n" +
                                      LIGHT + "sphere { 0, B pigment { rgb 1 } }\n", EACH),
    "a loop of shapes": (HEAD + CAMERA + LIGHT + "#declare I = 0;\n#while (I < 20)\nsphere { <I / 5 - 2, 0, 0>, 0.3 pigment { rgb I / 20 } }\n"
                         "#declare I = I + 1;\n#end\n", ONCE),
    "the camera uses the loop's number": (HEAD + "#declare I = 0;\n#while (I < 5)\nsphere { I, 0.5 }\n#declare I = I + 1;\n#end\n"
                                          "camera { location <clock, 2, -I> look_at 0 }\n" + LIGHT, EACH),
    "a macro of shapes": (HEAD + CAMERA + LIGHT + "#macro Ball(P)\n#local R = 0.4;\nsphere { P, R pigment { rgb 1 } }\n#end\n" +
                          "".join(f"Ball(<{i - 2}, 0, 0>)\n" for i in range(5)), ONCE),
    "a macro that writes a name": (HEAD + "#declare N = 0;\n#macro Ball()\nsphere { N, 0.3 pigment { rgb 1 } }\n#declare N = N + 0.5;\n#end\n"
                                   "Ball()\nBall()\ncamera { location <clock, N, -6> look_at 0 }\n" + LIGHT, EACH),
    "macros that call one another": (HEAD + "#declare N = 0;\n#macro Set(V)\n#declare N = V;\n#end\n#macro Do(V)\n#if (V > 5)\nDo(V - 5)\n#else\n"
                                     "Set(V)\n#end\n#end\nDo(clock)\nsphere { N, 1 pigment { rgb 1 } }\n" + STILL + LIGHT, EACH),
    "a macro changes what it is given": (HEAD + "#macro Set(A)\n#declare A = clock;\n#end\n#declare Q = 1;\nSet(Q)\nsphere { Q, 1 pigment { rgb 1 } }\n" +
                                         STILL + LIGHT, EACH),
    "a shape moves": (HEAD + STILL + LIGHT + BALLS + "sphere { <clock, 0, -2>, 0.5 pigment { rgb 1 } }\n", TAIL),
    "a shape moves before all others": (HEAD + STILL + LIGHT + "sphere { <clock, 0, -2>, 0.5 pigment { rgb 1 } }\n" + BALLS, EACH),
    "a shape moves between others": (HEAD + STILL + LIGHT + BALLS + "sphere { <clock, 0, -2>, 0.5 pigment { rgb 1 } }\n" + BALLS, TAIL),
    "shapes of all kinds move": (HEAD + CAMERA + LIGHT + BALLS + ALL_KINDS.replace("TIME", "0") + ALL_KINDS.replace("TIME", "clock"), TAIL),
    "what moves changes its colour and number": (HEAD + STILL + LIGHT + BALLS + "#for (I, 0, clock * 9)\nsphere { <I / 4 - 1, 2 * clock, -2>, 0.2 "
                                                "pigment { rgb <clock, I / 9, 1> } }\n#end\n", TAIL),
    "a shape comes before others": (HEAD + CAMERA + LIGHT + "#if (clock > 0.5) sphere { <0, 0, -2>, 0.5 pigment { rgb 1 } } #end\n" + BALLS, (3, 3)),
    "a shape comes between others that move": (HEAD + CAMERA + LIGHT + "#if (clock > 0.5) sphere { <0, 0, -2>, 0.5 pigment { rgb 1 } } #end\n" + BALLS +
                                               "sphere { <clock, 0, -2>, 0.5 pigment { rgb 1 } }\n", (3, 4)),
    "a shape moves in a file": (HEAD + STILL + LIGHT + BALLS + '#include "moving.inc"\n', TAIL),
    "a picture on what moves": (HEAD + STILL + LIGHT + BALLS + "box { <-1, -1, 0>, <1, 1, 0.1> pigment { image_map { png \"small.png\" } "
                                "translate -0.5 scale 2 } translate <clock, 0, -2> }\n", TAIL),
    "a name from a file moves a shape": (HEAD + '#include "where.inc"\n' + STILL + LIGHT + BALLS + "sphere { Where, 1 pigment { rgb 1 } }\n", TAIL),
    "a shape comes": (HEAD + CAMERA + LIGHT + BALLS + "#if (clock > 0.5) sphere { <0, 0, -2>, 0.5 pigment { rgb 1 } } #end\n", (3, 3)),
    "a shape knows the frame": (HEAD + STILL + LIGHT + "sphere { frame_number / 4, 1 pigment { rgb 1 } }\n", EACH),
    "the default changes": (HEAD + "#default { finish { ambient clock } }\n" + STILL + LIGHT + BALLS, EACH),
    "settings change": ("#version 3.7;\nglobal_settings { assumed_gamma 1 + clock }\n" + STILL + LIGHT +
                        "sphere { 0, 1 pigment { srgb 0.5 } }\n", EACH),
    "fog moves": (HEAD + CAMERA + LIGHT + BALLS + "fog { distance 5 + clock rgb 0.5 }\n", EACH),
    "chance in both": (HEAD + "#declare S = seed(1);\n#for (I, 1, 5)\nsphere { rand(S) * 2, 0.4 pigment { rgb 1 } }\n#end\n"
                       "camera { location <rand(S) + clock, 2, -6> look_at 0 }\n" + LIGHT, EACH),
    "chance in shapes": (HEAD + CAMERA + LIGHT + "#declare S = seed(1);\n#for (I, 1, 5)\nsphere { rand(S) * 2, 0.4 pigment { rgb 1 } }\n#end\n", ONCE),
    "numbers from a file": (HEAD + CAMERA + LIGHT + '#fopen F "numbers.txt" read\n#read (F, A)\nsphere { A, 1 pigment { rgb 1 } }\n#fclose F\n', EACH),
    "camera and lights in a file": (HEAD + '#include "view.inc"\n' + BALLS, ONCE),
    "a light in a union": (HEAD + CAMERA + "union { light_source { <5, 5, -5> rgb 1 } sphere { 0, 1 pigment { rgb 1 } } }\n", EACH),
    "comments and strings": (HEAD + CAMERA + LIGHT + '// sphere { clock\n/* clock */\n#declare T = "clock";\n' + BALLS, ONCE),
}


def content(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def run(folder, *words):
    done = subprocess.run([PROGRAM, "-W", "40", "-H", "30", *words], cwd=folder, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, check=False)
    return done.returncode, done.stdout, done.stderr.decode()


def single(folder, frame, *options):
    clock = (frame - 1) / (FRAMES - 1)
    names = {"clock_delta": 1 / (FRAMES - 1), "initial_clock": 0, "final_clock": 1, "initial_frame": 1, "final_frame": FRAMES,
             "frame_number": frame}
    words = [f"-D{name}={value!r}" for name, value in names.items()]
    run(folder, "-q", f"--clock={clock!r}", *words, *options, "-o", "single.png", "s.scn")
    return png_without_texts(content(folder, "single.png"))


def put(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def check_case(report, folder, name, text, times, *options):
    put(folder, "s.scn", text)
    status, _, told = run(folder, f"--frames=1..{FRAMES}", *options, "-o", "f.png", "s.scn")
    differ = [i for i in range(1, FRAMES + 1)
              if status or png_without_texts(content(folder, f"f{i}.png")) != single(folder, i, *options)]
    report.ok(status == 0 and not differ, f"{name}: the frames have the pixels of single runs", f"{status} {differ}\n{told}")
    found = re.search(r"^animation: (\d+) frames drawn; the scene read (\d+) times?, its tree built (\d+) times?$", told, re.M)
    report.equal(found and tuple(map(int, found.groups())), (FRAMES, *times), f"{name}: read and built so often")


def check_said(report, folder):
    """What names the clock is said by each frame, the rest once, where the scene is read once."""
    lines = '#debug "always\\n"\n#debug concat("clock ", str(clock, 0, 2), "\\n")\n'
    put(folder, "s.scn", HEAD + lines + CAMERA + LIGHT + BALLS)
    words = ["--frames=1..4", "-o", "said.png", "s.scn"]
    expected = ["always", *(f"clock {frame / 3:.2f}" for frame in range(4))]
    status, _, told = run(folder, *words)
    report.ok(status == 0 and "the scene read 1 time," in told, "a scene that says its clock is read once", told)
    report.equal([line for line in told.splitlines() if line.startswith(("always", "clock"))], expected, "each frame says its clock")
    status, _, told = run(folder, "--diagnostics=json", *words)
    said = [json.loads(line) for line in told.splitlines() if line.startswith("{")]
    report.equal([line["text"] for line in said if line["type"] == "message"], expected,
                 "and so in JSON")


def check_continue(report, folder):
    put(folder, "s.scn", HEAD + CAMERA + LIGHT + BALLS)
    run(folder, "-q", "--frames=1..4", "-o", "g.png", "s.scn")
    whole = [content(folder, f"g{i}.png") for i in range(1, 5)]
    os.remove(os.path.join(folder, "g2.png"))
    os.remove(os.path.join(folder, "g3.png"))
    status, _, told = run(folder, "--frames=1..4", "--continue", "-o", "g.png", "s.scn")
    report.ok(status == 0 and "animation: 2 frames drawn, 2 there already; the scene read 1 time, its tree built 1 time\n" in told,
              "--continue draws what is missing", told)
    report.equal([content(folder, f"g{i}.png") for i in range(1, 5)], whole, "which are the same files")


def check_stream(report, folder):
    status, out, _ = run(folder, "-q", "--frames=1..3", "-o", "-.ppm", "s.scn")
    size = len(b"P6\n40 30\n255\n") + 40 * 30 * 3
    report.ok(status == 0 and len(out) == 3 * size and all(out[i * size:].startswith(b"P6\n40 30\n255\n") for i in range(3)),
              "standard output is PPM after PPM", len(out))


def ppm_codes(data):
    """Red, green and blue of each pixel of a PPM whose header has comments."""
    lines = data.split(b"\n")
    head = 1 + sum(line.startswith(b"#") for line in lines[1:30]) + 2
    body = data[sum(len(line) + 1 for line in lines[:head]):]
    return list(zip(body[0::3], body[1::3], body[2::3]))


def film_codes(planes, pixels):
    """The same of a frame of Y4M, by the inverse of BT.601."""
    found = []
    for y, cb, cr in zip(planes[:pixels], planes[pixels:2 * pixels], planes[2 * pixels:]):
        light, blue, red = (y - 16) / 219, (cb - 128) / 224, (cr - 128) / 224
        found.append(tuple(255 * value for value in (light + 1.402 * red, light - 0.344136 * blue - 0.714136 * red,
                                                     light + 1.772 * blue)))
    return found


def farthest(one, other):
    return max(abs(a - b) for left, right in zip(one, other) for a, b in zip(left, right))


def check_film(report, folder):
    put(folder, "s.scn", HEAD + CAMERA + LIGHT + "background { rgb <0.05, 0.3, 0.9> }\n" + BALLS)
    run(folder, "-q", "--frames=1..3", "-o", "p.ppm", "s.scn")
    status, out, _ = run(folder, "-q", "--frames=1..3", "-o", "-.y4m", "s.scn")
    head, pixels = b"YUV4MPEG2 W40 H30 F25:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n", 40 * 30
    step = len(b"FRAME\n") + 3 * pixels
    frames = [out[len(head) + i * step:len(head) + (i + 1) * step] for i in range(3)]
    is_film = status == 0 and out.startswith(head) and len(out) == len(head) + 3 * step
    report.ok(is_film and all(frame.startswith(b"FRAME\n") for frame in frames),
              "-.y4m is one film of three frames", out[:200])
    apart = [farthest(film_codes(frame[6:], pixels), ppm_codes(content(folder, f"p{i}.ppm"))) for i, frame in enumerate(frames, 1)]
    # A code of luma or colour is rounded by half of one: at most 0.5 * 255 * (1 / 219 + 1.772 / 224) of red, green or blue.
    report.ok(max(apart) < 1.6, "whose colours are those of the pictures", apart)
    report.ok(frames[0] != frames[1], "and which moves")
    for words, told in ((["--frames=1..3", "-o", "f.y4m"], "E0703]: frames in Y4M go to standard output, as one film: `-o -.y4m`"),
                        (["--depth=16", "-o", "f.y4m"], "E0702]: `f.y4m` cannot have the wanted depth"),
                        (["--alpha", "-o", "-.y4m"], "E0703]: `--alpha` wants a picture in PNG, Targa or EXR")):
        status, out, said = run(folder, *words, "s.scn")
        report.ok(status == 2 and not out and told in said, f"{' '.join(words)} is refused", f"{status} {said}")


def check_bar(report, folder):
    """Each frame takes less than the second after which there is a bar."""
    put(folder, "s.scn", HEAD + CAMERA + LIGHT + BALLS)
    words = [PROGRAM, "-W", "80", "-H", "60", "--frames=1..4", "--time-limit=0.8", "-o", "bar.png", "s.scn"]
    told = terminal_output(lambda slave: subprocess.Popen(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                                          stderr=slave), 60, rb"animation: 4")
    shares = [int(share) for share in re.findall(rb"\] +(\d+) %", told)]
    # A prediction may fall by a little; a bar of each frame's own would fall from its end to its beginning.
    report.ok(len(shares) > 3 and shares[0] >= 20 and all(b >= a - 10 for a, b in zip(shares, shares[1:])), "one bar for all frames", shares)


def main():
    report = tap.Tap()
    with tempfile.TemporaryDirectory() as folder:
        for name, text in FILES.items():
            put(folder, name, text)
        put(folder, "s.scn", HEAD + STILL + LIGHT + BALLS)
        run(folder, "-q", "-W", "8", "-H", "8", "-o", "small.png", "s.scn") # PNG is read without OpenImageIO
        for name, (text, times) in CASES.items():
            check_case(report, folder, name, text, times)
        moving = HEAD + CAMERA + LIGHT + BALLS
        for options in (["--samples=4"], ["--antialias=1"], ["--threads=3"], ["--samples=8", "--adaptive"], ["--no-literals"],
                        ["--sky-light=0.5"]):
            check_case(report, folder, " ".join(options), moving, ONCE, *options)
            tail = HEAD + CAMERA + LIGHT + BALLS + ALL_KINDS.replace("TIME", "clock")
            check_case(report, folder, " ".join(options) + ", shapes move", tail, TAIL, *options)
        check_said(report, folder)
        check_continue(report, folder)
        check_stream(report, folder)
        check_film(report, folder)
        check_bar(report, folder)
    report.done()


main()
