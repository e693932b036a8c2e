#!/usr/bin/env python3
# Sampled pictures from the command line: the error told at the end and kept in the file, the map of it, goals, an interrupt
# and a time limit that leave their picture, a plateau and its cause, parts of a picture, lenses, photons. Prints TAP.
#
# Wants RTLANG (the program) and top_srcdir.
#
# SPDX-License-Identifier: MIT
import math
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.environ.get("top_srcdir", "."), "tests", "povray"))
from pictures import read_png
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from exr import read_exr
from tap import Tap
from terminal import terminal_output

RTLANG = os.path.abspath(os.environ["RTLANG"])
HEAD = "#version 3.7; global_settings { assumed_gamma 1 }\n"
BALLS = HEAD + """camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 }
light_source { <-8,12,-10> rgb 1 } background { rgb <0.1,0.2,0.4> }
#declare S = seed(7);
#for (I, 1, 200) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*8-4>, 0.1+0.25*rand(S)
pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.1 diffuse 0.8 } } #end
"""
SOFT = HEAD + """camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 }
light_source { <-3,6,-3> rgb 1 area_light <4,0,0>, <0,0,4>, 9, 9 jitter }
plane { y, -1 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.9 } }
sphere { <0,0.5,0>, 1 pigment { rgb <1,0.5,0.3> } finish { ambient 0.1 diffuse 0.7 } }
"""
# Two mirrors that face each other: what lies beyond the second is cut.
MIRRORS = HEAD + """global_settings { max_trace_level 2 } camera { location <0,0,-0.5> direction z }
light_source { <0,2,0> rgb 1 }
plane { z, 1 pigment { rgb 1 } finish { ambient 0.2 diffuse 0.2 reflection 0.8 } }
plane { -z, 1 pigment { rgb 1 } finish { ambient 0.2 diffuse 0.2 reflection 0.8 } }
"""
LENS = HEAD + """camera { location <0,2,-7> look_at 0 right x*image_width/image_height angle 50 aperture 1 blur_samples 37 variance 0
  focal_point 0 }
light_source { <-4,7,-6> rgb 1 } sphere { 0, 1 pigment { rgb 1 } finish { ambient 0 } } plane { y, -1 pigment { rgb 1 } }
"""
ERROR = re.compile(r"error: rmse (\S+), with 95 % confidence (\S+) to (\S+), at (\S+) (samples|photons) a pixel(.*)")
tap = Tap()


def write(name, text):
    with open(name, "w", encoding="ascii") as out:
        out.write(text)


def read(name):
    with open(name, "rb") as file:
        return file.read()


def rtlang(scene, *options, output="out.png", size=(64, 48)):
    """(exit code, what was said) of a run over the scene's text."""
    write("scene.scn", scene)
    command = [RTLANG, f"-W{size[0]}", f"-H{size[1]}", "-o", output, *options, "scene.scn"]
    run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False)
    return run.returncode, run.stderr


def notes(name):
    """Keyword -> text of a PNG file."""
    data, at, found = read(name), 8, {}
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"tEXt":
            keyword, _, text = data[at + 8:at + 8 + length].partition(b"\0")
            found[keyword.decode()] = text.decode()
        at += 12 + length
    return found


def grey_16(name):
    """The values of a grey PNG file of 16 bits, from 0 to 1."""
    return [code / 65535 for code in read_png(name, 1, (16,))[2]]


def notes_of(scene, *options):
    rtlang(scene, *options)
    return notes("out.png")


def linear(name):
    return [code / 65535 for code in read_png(name)[2]]


def rmse(one, other):
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(one, other)) / len(one))


LINEAR = ("--depth=16", "--file-gamma=1")


def test_error_told():
    status, said = rtlang(BALLS, "--samples=16", "--seed=5", "--error-map=map.png", *LINEAR)
    found = ERROR.search(said)
    if not tap.ok(status == 0 and found, "a sampled run tells its error", said):
        return
    told, low, high, samples = map(float, found.groups()[:4])
    tap.ok(low < told < high and samples == 16 and found[5] == "samples", "with an interval, at its samples", said)
    kept = notes("out.png")
    fine = all(math.isclose(float(kept["rtlang:" + name]), value, rel_tol=6e-3)
               for name, value in (("rmse", told), ("rmse-low", low), ("rmse-high", high), ("samples", 16), ("seed", 5)))
    tap.ok(fine and kept["rtlang:sampler"] == "sobol" and kept["rtlang:filter"] == "box", "the file keeps it", kept)
    by_pixel = grey_16("map.png")
    mean = math.sqrt(sum(value * value for value in by_pixel) / len(by_pixel))
    tap.ok(len(by_pixel) == 64 * 48 and math.isclose(mean, told, rel_tol=0.01), "the map's mean square is the picture's",
           f"{mean} {told}")
    picture = linear("out.png")
    rtlang(BALLS, "--samples=512", "--sampler=halton", "--seed=1", *LINEAR, output="reference.png")
    true = rmse(picture, linear("reference.png"))
    tap.ok(low / 1.2 < true < high * 1.2, "and it is what the picture is off by", f"{low} {true} {high}")
    tap.ok("error:" not in rtlang(BALLS, "--samples=16", "--no-estimate")[1], "not without the estimate")


def test_some_pixels():
    """A large picture's error is told from some of its pixels, unless that of each is asked for; the picture is the same."""
    size, options = (160, 120), ("--samples=16", "--seed=5", *LINEAR)
    some = ERROR.search(rtlang(BALLS, *options, size=size)[1])
    picture = linear("out.png")
    every = ERROR.search(rtlang(BALLS, *options, "--error-map=map.png", output="every.png", size=size)[1])
    tap.ok(picture == linear("every.png"), "the same picture, whichever pixels tell of its error")
    told, low, high = (float(some[i]) for i in (1, 2, 3))
    all_told, all_low, all_high = (float(every[i]) for i in (1, 2, 3))
    tap.ok(told != all_told and low < all_high and all_low < high, "some pixels of a large one tell what all of them do", f"{some[0]} {every[0]}")
    one = rtlang(BALLS, *options, "--threads=1", output="one.png", size=size)[1]
    tap.ok(ERROR.search(one)[0] == some[0], "the same for any number of threads", one)


def test_channel():
    """The same in EXR, where the error of each pixel is a channel of its own."""
    status, said = rtlang(BALLS, "--samples=16", "--seed=5", "--planes=error", "--error-map=map.exr", output="out.exr")
    if "E0507" in said:
        tap.skip("the channel of the error", "built without OpenImageIO")
        return
    found = ERROR.search(said)
    kept, channels = read_exr("out.exr")
    fine = all(math.isclose(float(kept["rtlang:" + name]), float(found[place]), rel_tol=6e-3)
               for place, name in enumerate(("rmse", "rmse-low", "rmse-high", "samples"), 1))
    tap.ok(status == 0 and fine and kept["rtlang:seed"] == "5" and kept["rtlang:sampler"] == "sobol", "EXR keeps it, too", kept)
    values = channels.get("error", [0.0])
    tap.ok(sorted(channels) == ["B", "G", "R", "error"] and len(values) == 64 * 48 and
           math.isclose(math.sqrt(sum(value * value for value in values) / len(values)), float(found[1]), rel_tol=6e-3),
           "and on demand a channel with the error of each pixel, whose mean square is the picture's", said)
    tap.ok(list(read_exr("map.exr")[1].values()) == [values], "which is the map")
    rtlang(BALLS, "--samples=16", "--seed=5", output="plain.exr")
    plain = read_exr("plain.exr")[1]
    tap.ok(sorted(plain) == ["B", "G", "R"] and all(plain[name] == channels[name] for name in plain),
           "beside the same picture, and not unless asked for")
    for name, output, options, why in (("in PNG", "out.png", ("--samples=16",), "`--planes` wants a picture in EXR"),
                                       ("of nothing", "out.exr", (), "only a sampled picture has the planes `error`")):
        status, said = rtlang(BALLS, "--planes=error", *options, output=output)
        tap.ok(status == 2 and "error[E0703]: " + why in said, "refused: a channel " + name, said)


def is_without_study():
    return "--disable-study" in rtlang(BALLS, "--precision=reference", size=(4, 3))[1]


def test_precisions():
    """The reference kernels sample as the others do, and tell what the others tell."""
    if is_without_study():
        tap.skip("the reference kernels", "built with --disable-study")
        return
    usual = ERROR.search(rtlang(BALLS, "--samples=8")[1])
    for precision in "reference", "float":
        found = ERROR.search(rtlang(BALLS, "--samples=8", f"--precision={precision}")[1])
        tap.ok(found and all(math.isclose(float(found[i]), float(usual[i]), rel_tol=0.01) for i in range(1, 5)),
               f"--precision={precision} tells the same error", f"{found} {usual}")
        name = {"reference": "double"}.get(precision, precision)
        tap.equal(notes("out.png").get("rtlang:precision"), name, "and the file says by which numbers")
    said = rtlang(LENS.replace("aperture 1", "aperture 0"), "--precision=quad", "--target-error=0.02", size=(32, 24))[1]
    found = ERROR.search(said)
    tap.ok(found and float(found[3]) <= 0.02 and "; the target is reached" in found[6], "they run to a goal", said)


def test_goals():
    status, said = rtlang(BALLS, "--target-error=0.01")
    found = ERROR.search(said)
    tap.ok(status == 0 and found and float(found[3]) <= 0.01 and "; the target is reached" in found[6],
           "a target is reached, by the interval's upper end", said)
    status, said = rtlang(BALLS, "--target-error=0.0001", "--samples=32")
    found = ERROR.search(said)
    tap.ok(status == 0 and found and float(found[4]) >= 32 and "; the target is not reached" in found[6],
           "or it is said that it is not", said)
    for wanted in 5.7, 9.9, 20.0:
        found = ERROR.search(rtlang(BALLS, "--adaptive", f"--samples={wanted}")[1])
        tap.ok(found and wanted <= float(found[4]) <= 1.01 * wanted, f"{wanted} adaptive samples a pixel are what is taken", found and found[4])
    start = time.monotonic()
    status, said = rtlang(BALLS, "--time-limit=1", "--target-error=1e-9", output="limited.png")
    taken = time.monotonic() - start
    found = ERROR.search(said)
    tap.ok(status == 0 and found and "; the time is over" in found[6] and os.path.exists("limited.png"),
           "a time limit ends a run with its picture and its error", f"{taken} s\n{said}")
    rtlang(BALLS, "--adaptive", f"--samples={found[4]}", "-t1", output="again.png")
    tap.ok(read("limited.png") == read("again.png"), "which is made again, byte for byte, by its number of samples",
           (notes("limited.png"), notes("again.png")))


def test_unmet():
    """What no sample met is counted, and named by one exact line; what may have been missed besides by another."""
    look = "camera { location 0 direction z right x*4/3 up y } light_source { <0,0,-9> rgb 0.001 } background { rgb 0.1 }\n"
    ball = "sphere { <%g,0.25,5>, 0.002 pigment { rgb 1 } finish { ambient 20 } }\n"
    area = math.pi * (0.002 / 5 * 48) ** 2 * 1.004  # the ball lies aside by 0.1 of the distance: a little wider
    for count, words in ((1, "1 shape of 0.0012 pixels was"), (3, "3 shapes of 0.0035 pixels in all were")):
        _, said = rtlang(HEAD + look + "".join(ball % (0.5 + 0.3 * i) for i in range(count)), "--samples=4")
        found = ERROR.search(said)
        tap.equal(found and found[6], f"; {words} met by no sample", f"{count} unmet: the line says it")
        kept = notes("out.png").get("rtlang:unmet-shapes")
        tap.equal(kept, f"{count}, {area * count:.2g} pixels", "and the file")
        off = area * 19.9 * math.sqrt(count / (64 * 48))
        tap.ok(found and float(found[2]) < off < float(found[3]) and float(found[1]) < 1.1 * off,
               "the interval holds what it would bring", f"{off} {said}")
    shiny = "sphere { <0,0,5>, 2 pigment { rgb 0 } finish { ambient 0 phong 9 phong_size 1e8 } }\n"
    _, said = rtlang(HEAD + look.replace("rgb 0.001", "rgb 50").replace("<0,0,-9>", "<-3,5,-6>") + shiny, "--samples=4")
    tap.ok(re.search(r"; 1 highlight of \S+ pixels was met by no sample$", said, re.M), "a highlight likewise", said)
    _, said = rtlang(HEAD + look + "plane { z, 9 pigment { gradient x } finish { ambient 1 } }", "--adaptive", "--samples=64")
    found = ERROR.search(said)
    missed = re.search(r"^missed: a detail of up to (\S+) pixels? may be in no sample, and would add up to (\S+)$", said, re.M)
    tap.ok(found and missed and float(missed[2]) > float(found[3]), "a detail may be in no sample", said)
    tap.ok("missed:" not in rtlang(BALLS, "--samples=16")[1], "which is not said where it would be less than the error")


def test_interrupt():
    write("scene.scn", SOFT)
    # One ray for each pixel is quick, all of them would take hours.
    command = [RTLANG, "-W64", "-H48", "-o", "cut.png", "--samples=1048576", *LINEAR, "scene.scn"]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    found = ERROR.search(said)
    tap.ok(process.returncode == 130 and found and "; interrupted" in found[6] and said.endswith("rtlang: interrupted\n"),
           "an interrupted run tells its error", said)
    tap.ok(os.path.exists("cut.png") and math.isclose(float(notes("cut.png")["rtlang:rmse"]), float(found[1]), rel_tol=6e-3),
           "and writes its picture with it", said)
    status, _ = rtlang(SOFT, "--samples=512", "--sampler=halton", "--seed=9", *LINEAR, output="reference.png")
    true = rmse(linear("cut.png"), linear("reference.png"))
    floor = 65535 ** -1 + 0.001
    tap.ok(status == 0 and true < 1.5 * float(found[3]) + floor, "which is no worse than that", f"{true} {found[0]}")


def test_restart():
    """A run that was ended, somehow and at any time, and is started again is as if it had never been ended."""
    scene, options = SOFT, ("-W64", "-H48", "--samples=300", *LINEAR)
    write("scene.scn", scene)
    whole = subprocess.run([RTLANG, *options, "-o", "whole.png", "scene.scn"], capture_output=True, text=True, check=False)
    for threads, (kind, delay) in enumerate(((signal.SIGINT, 0.15), (signal.SIGTERM, 0.3), (signal.SIGKILL, 0.3)), 1):
        command = [RTLANG, *options, f"-t{threads}", "-o", "again.png", "scene.scn"]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(delay)
        process.send_signal(kind)
        process.wait(timeout=60)
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        found = ERROR.search(run.stderr)
        tap.ok(run.returncode == 0 and read("whole.png") == read("again.png") and found and found[0] == ERROR.search(whole.stderr)[0],
               f"started again after {kind.name}: the same file and the same error", run.stderr)


def at_terminal(command):
    return lambda slave: subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=slave)


def test_plateau():
    said = rtlang(MIRRORS, "--samples=64")[1]
    tap.ok(re.search(r"bias: rays cut by max_trace_level would add about \S+ in the mean; more samples will not help", said),
           "a picture that is cut by max_trace_level says so", said)
    said = rtlang(MIRRORS.replace("max_trace_level 2", "max_trace_level 200 adc_bailout 0.5"), "--samples=64")[1]
    tap.ok(re.search(r"bias: rays cut by adc_bailout would add about \S+ in the mean; more samples will not help", said),
           "and one that is cut by adc_bailout", said)
    said = rtlang(BALLS, "--samples=64")[1]
    tap.ok("bias:" not in said, "others do not", said)
    write("scene.scn", MIRRORS)
    command = [RTLANG, "-W400", "-H300", "-o", "out.png", "--samples=1048576", "scene.scn"]
    wanted = rb"\d+ s left  error \S+ at \S+ rays a pixel; more will not help: max_trace_level cuts rays"
    text = terminal_output(at_terminal(command), 60, wanted)
    tap.ok(re.search(wanted, text), "the bar tells the error, what is left, and the plateau with its cause", text[-400:])
    write("scene.scn", BALLS)
    command = [RTLANG, "-W400", "-H300", "-o", "out.png", "--target-error=1e-5", "scene.scn"]
    wanted = rb"\d+ s left  error \S+ at \S+ rays a pixel"
    text = terminal_output(at_terminal(command), 60, wanted)
    tap.ok(re.search(wanted, text) and b"will not help" not in text, "and of others the first two", text[-400:])


def test_crop():
    """A picture of parts is the whole picture, whatever the number of threads."""
    parts = [(0, 0, 37, 20), (37, 0, 27, 20), (0, 20, 11, 28), (11, 20, 53, 28)]
    for name, scene, options in (("one ray a pixel", BALLS, ()), ("samples", BALLS, ("--samples=8",)),
                                 ("a filter and area lights", SOFT, ("--samples=7", "--filter=mitchell")),
                                 ("a set that is no sequence", SOFT, ("--samples=9", "--sampler=jittered")),
                                 ("a lens", LENS, ()), ("quad", LENS.replace("aperture 1", "aperture 0"), ("--precision=quad",))):
        if name == "quad" and is_without_study():
            tap.skip("parts of a picture: quad", "built with --disable-study")
            continue
        rtlang(scene, *options, *LINEAR, "-t2", output="whole.png")
        width, _, whole = read_png("whole.png")
        differs = []
        for number, (left, top, across, down) in enumerate(parts):
            rtlang(scene, *options, *LINEAR, f"-t{number + 1}", f"--crop={left},{top},{across},{down}", output="part.png")
            found_width, found_height, part = read_png("part.png")
            want = [code for y in range(top, top + down) for code in whole[3 * (y * width + left):3 * (y * width + left + across)]]
            if (found_width, found_height, list(part)) != (across, down, want):
                differs.append(number)
        tap.equal(differs, [], "parts of a picture are those of the whole: " + name)
    one = rtlang(BALLS, "--samples=16", "-t1", "--crop=8,8,40,30")[1]
    other = rtlang(BALLS, "--samples=16", "-t5", "--crop=8,8,40,30")[1]
    tap.equal(ERROR.search(one)[0], ERROR.search(other)[0], "a part's error does not depend on threads")
    # Independent halves: there the error of the whole is that of its parts, no more is taken from all pixels together.
    # Looks at balls that no sample met are aimed at the same places in a part.
    whole = float(notes_of(BALLS, "--samples=16", "--sampler=jittered")["rtlang:rmse"])
    squares = 0.0
    for left, top, across, down in parts:
        part = notes_of(BALLS, "--samples=16", "--sampler=jittered", f"--crop={left},{top},{across},{down}")
        squares += float(part["rtlang:rmse"]) ** 2 * across * down / (64 * 48)
    tap.ok(math.isclose(math.sqrt(squares), whole, rel_tol=1e-5), "errors of parts add up to that of the whole",
           f"{math.sqrt(squares)} {whole}")
    for crop in "60,0,5,5", "0,44,1,5", "64,0,1,1":
        status, said = rtlang(BALLS, "--crop=" + crop)
        tap.ok(status == 2 and "E0703" in said and "--crop" in said, f"a part of {crop} is not in 64 x 48", said)
    status, said = rtlang(BALLS, "--crop=1,2,3")
    tap.ok(status == 2 and "left, top, width and height" in said, "four numbers are wanted", said)


def test_lens():
    status, said = rtlang(LENS)
    found = ERROR.search(said)
    tap.ok(status == 0 and found and float(found[4]) == 37, "a lens takes the rays that the scene asks for", said)
    found = ERROR.search(rtlang(LENS, "--samples=20")[1])
    tap.ok(found and float(found[4]) == 20, "or those that --samples does", said)


def test_forward():
    lens = LENS.replace("aperture 1", "aperture 4")
    status, said = rtlang(lens, "--method=forward", "--photons=2e5")
    found = ERROR.search(said)
    tap.ok(status == 0 and found and found[5] == "photons" and "photons: 200000, of which" in said, "photons are told of", said)
    tap.ok(notes("out.png").get("rtlang:method") == "forward" and notes("out.png").get("rtlang:photons") == "200000",
           "and noted in the file", notes("out.png"))
    status, said = rtlang(lens + "fog { distance 5 rgb 1 }", "--method=forward-connect")
    tap.ok(status == 1 and "error[E0449]" in said and "fog" in said, "a scene that photons do not know is refused", said)
    status, said = rtlang(lens.replace("aperture 4", "aperture 0"), "--method=forward")
    tap.ok(status == 1 and "error[E0449]" in said and "aperture" in said, "and one whose lens no photon can hit", said)


def test_refusals():
    for name, options in (("a goal with a set", ("--sampler=grid", "--target-error=0.1")),
                          ("adaptive without a number", ("--adaptive",)),
                          ("half a sample", ("--samples=2.5",)),
                          ("a map of nothing", ("--error-map=map.png",))):
        status, said = rtlang(BALLS, *options)
        tap.ok(status == 2 and "error[E0703]" in said, "refused: " + name, said)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for test in (test_error_told, test_some_pixels, test_channel, test_precisions, test_goals, test_unmet, test_interrupt, test_restart, test_plateau, test_crop, test_lens, test_forward, test_refusals):
            test()
        os.chdir("/")
    tap.done()


if __name__ == "__main__":
    main()
