# Tests that watch rtlang while it runs: killed, interrupted, at a terminal, and how much memory it takes.
#
# SPDX-License-Identifier: MIT
import os
import re
import resource
import signal
import subprocess
import sys
import time

from terminal import terminal_output

# Far more than a second of work for one thread of any machine.
SLOW = b"""#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 30 }
camera { location -6*z look_at 0 }
light_source { <5, 5, -10>, 1 }
#declare S = seed(1);
#for (I, 1, 400)
  sphere { <rand(S)*6 - 3, rand(S)*6 - 3, rand(S)*6 - 3>, 0.3 pigment { rgb 1 } finish { reflection 0.9 } }
#end
"""
SLOW_OPTIONS = ["-t", "1", "-W", "8000", "-H", "6000", "-o", "old.png", "slow.scn"]
QUICK = b"camera { location -5*z look_at 0 }\nlight_source { <5, 5, -5>, 1 }\nsphere { 0, 1 pigment { rgb 1 } }\n"
OLD_PICTURE = b"an old picture"
ENDLESS_RAY = b"""global_settings { max_trace_level 40 adc_bailout 0 }
camera { location -9*z look_at 0 angle 20 }
light_source { -10*z, rgb 1 }
#for (I, 0, 29)
    sphere { <mod(I, 5) - 2, mod(int(I/5), 3) - 1, int(I/15)>/2, 0.5
        pigment { rgbt 0.9 } finish { reflection 0.9 } interior { ior 1.5 } }
#end
"""
BAR = rb"\r\[#* *\] +\d+ %  \d+ s left"
PEAK_BYTES = 400 * 1000 * 1000
GENERATOR = os.path.join(os.environ["top_srcdir"], "bench", "generate.py")


def read(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def budget_of(program, scene, *options):
    """What --budget prints, by name."""
    text = subprocess.run([program, "--budget", *options, scene], stdout=subprocess.PIPE, check=True).stdout.decode()
    return {line[:16].strip().removesuffix(", bytes"): int(line[16:]) for line in text.splitlines()}


def tests(tap, program):
    """The tests, for one program."""

    def start_slow(*options, **how):
        write("old.png", OLD_PICTURE)
        write("slow.scn", SLOW)
        return subprocess.Popen([program, *options, *SLOW_OPTIONS], stdin=subprocess.DEVNULL, **how)

    def check_untouched(before, name):
        tap.equal((read("old.png"), set(os.listdir()) - before), (OLD_PICTURE, set()), name)

    def test_kill():
        before = {"slow.scn", "old.png"}
        process = start_slow("-q")
        time.sleep(0.5)
        process.kill()
        tap.equal(process.wait(), -signal.SIGKILL, "killed while it traces")
        check_untouched(before, "a kill leaves the old picture and nothing else")

    def test_kill_at_any_time():
        write("quick.scn", QUICK)
        command = [program, "-q", "-W", "2000", "-H", "1500", "-o"]
        start = time.monotonic()
        subprocess.run([*command, "whole.png", "quick.scn"], check=True)
        seconds = time.monotonic() - start
        allowed = {OLD_PICTURE, read("whole.png")}
        broken = []
        for step in range(1, 13):
            write("old.png", OLD_PICTURE)
            process = subprocess.Popen([*command, "old.png", "quick.scn"])
            time.sleep(seconds * step / 12)
            process.kill()
            process.wait()
            if read("old.png") not in allowed:
                broken.append(step)
        tap.equal(broken, [], "killed at twelve moments: the picture is the old one or the whole new one")

    def test_interrupt():
        before = {"slow.scn", "old.png"}
        process = start_slow(stderr=subprocess.PIPE)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        message = process.communicate(timeout=60)[1]
        tap.equal((process.returncode, message), (130, b"rtlang: interrupted; nothing was written\n"), "interrupted")
        check_untouched(before, "an interrupt leaves the old picture and nothing else")

    def test_interrupt_in_json():
        """Each line of standard error is one object, so an interrupt is told by the status alone."""
        write("endless.scn", b"#while (1) #end\n")
        process = subprocess.Popen([program, "--diagnostics=json", "--check", "--max-steps=1000000000000", "endless.scn"],
                                   stderr=subprocess.PIPE)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        message = process.communicate(timeout=60)[1]
        tap.equal((process.returncode, message), (130, b""), "interrupted, with messages in JSON")

    def test_signals():
        write("endless.scn", b"#while (1) #end\n")
        write("long.scn", b"sphere { 0, 1 }\n" * 4000000)
        write("block.scn", b"union {\n" + b"sphere { 0, 1 }\n" * 2000000 + b"}\n")
        os.mkfifo("waits.scn")
        write("lit.scn", QUICK + b"light_source { <1, 20, -3>, 1 area_light x*3, z*3, 1024, 1024 }\n" * 200)
        cases = [["--check", "--max-steps=1000000000000", "endless.scn"], ["--check", "--no-literals", "long.scn"],
                 ["--check", "block.scn"], ["--dump=ast", "long.scn"], ["--check", "-"], ["--check", "waits.scn"],
                 ["--format", "long.scn"], ["-q", "-o", "lit.png", "lit.scn"]]
        for arguments in cases:
            for number, code in (signal.SIGINT, 130), (signal.SIGTERM, 143):
                process = subprocess.Popen([program, *arguments], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                           stderr=subprocess.PIPE)
                time.sleep(0.3)
                process.send_signal(number)
                process.wait(timeout=60)
                message = process.stderr.read()
                process.stdin.close()
                process.stderr.close()
                tap.equal((process.returncode, message), (code, b"rtlang: interrupted; nothing was written\n"),
                          "%s while it works on %s" % (number.name, " ".join(arguments)))

    def test_endless_ray():
        """Rays whose trees would take years: 2^40 of them."""
        write("endless_ray.scn", ENDLESS_RAY)
        for options in [], ["--samples=4"], ["--adaptive", "--samples=4"], ["--precision=quad"], ["--alpha"], ["--antialias=2"]:
            process = subprocess.Popen([program, "-W4", "-H4", "-o", "old.png", *options, "endless_ray.scn"],
                                       stderr=subprocess.PIPE)
            time.sleep(0.3)
            process.send_signal(signal.SIGTERM)
            message = process.communicate(timeout=60)[1]
            tap.equal((process.returncode, message), (143, b"rtlang: interrupted; nothing was written\n"),
                      "interrupted within one ray's tree " + " ".join(options))

    def test_progress():
        start = time.monotonic()
        text = terminal_output(lambda slave: start_slow(stderr=slave), 60, BAR)
        tap.ok(re.search(BAR, text), "a bar at a terminal", text)
        tap.ok(time.monotonic() - start >= 1, "not in the first second")
        text = terminal_output(lambda slave: start_slow("-q", stderr=slave), 2, BAR)
        tap.ok(b"%" not in text, "no bar with --quiet")
        process = start_slow(stderr=subprocess.PIPE)
        time.sleep(2)
        process.send_signal(signal.SIGINT)
        tap.equal(process.communicate(timeout=60)[1], b"rtlang: interrupted; nothing was written\n", "no bar in a pipe")

    def test_million_spheres():  # in a million colours
        with open("million.scn", "wb") as scene:
            subprocess.run([sys.executable, GENERATOR, "1000000"], stdout=scene, check=True)
        tap.ok(os.path.getsize("million.scn") > 150e6, "a million spheres in more than 150 MB of text")
        process = subprocess.Popen([program, "-q", "-W", "64", "-H", "48", "-o", "million.png", "million.scn"])
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        tap.equal(process.returncode, 0, "a million spheres are drawn")
        peak = usage.ru_maxrss * 1024
        tap.ok(peak <= PEAK_BYTES, "in at most 400 MB of memory", "peak %d bytes" % peak)
        budget = budget_of(program, "million.scn", "-W64", "-H48")
        tap.ok(budget["picture"] == 64 * 48 * 12 and peak < budget["all, at most"], "and in no more than its --budget",
               "peak %d bytes, %s" % (peak, budget))

    def test_budget():
        with open("some.scn", "wb") as scene:
            subprocess.run([sys.executable, GENERATOR, "10000"], stdout=scene, check=True)
        needs = budget_of(program, "some.scn")["all, at most"]
        command = [program, "-q", "-o", "some.png", "some.scn"]
        tap.equal(subprocess.run([*command, f"--max-memory={needs}"], check=False).returncode, 0, "a budget suffices")
        short = subprocess.run([*command, f"--max-memory={needs - 1}"], stderr=subprocess.PIPE, check=False)
        tap.ok(short.returncode == 4 and b"E0607" in short.stderr, "and less does not", short.stderr)

    def limited(which, most, *arguments):
        return subprocess.run([program, "-q", *arguments], stderr=subprocess.PIPE, check=False,
                              preexec_fn=lambda: resource.setrlimit(which, (most, most)))

    def test_limits_of_the_shell():
        write("limited.scn", QUICK)
        write("kept.png", OLD_PICTURE)
        before = set(os.listdir())
        done = limited(resource.RLIMIT_FSIZE, 1024, "-W800", "-H600", "-o", "kept.png", "limited.scn")
        tap.equal((done.returncode, done.stderr, read("kept.png"), set(os.listdir()) - before),
                  (3, b"rtlang: error[E0505]: cannot write `kept.png`: File too large\n", OLD_PICTURE, set()),
                  "ulimit -f: a message, the old picture, and nothing left over")
        if limited(resource.RLIMIT_AS, 400 << 20, "--version").returncode != 0:
            tap.skip("ulimit -v", "a sanitizer wants more")
            return
        done = limited(resource.RLIMIT_AS, 400 << 20, "-W8", "-H8", "-o", "limited.tif", "limited.scn")
        said = done.stderr.decode()
        if "E0507" in said:
            tap.skip("ulimit -v and a format of OpenImageIO's", "built without OpenImageIO")
        else:
            tap.ok(done.returncode == 4 and "E0602" in said, "ulimit -v and a format of OpenImageIO's", said)
        write("grows.scn", b"#declare N = 1000;\n#while (1) #declare A = array[N]; #for (I, 0, N-1) #declare A[I]=I; #end\n"
                           b"#declare N = N*2; #end\n")
        done = limited(resource.RLIMIT_AS, 400 << 20, "--check", "grows.scn")
        tap.ok(done.returncode == 4 and b"E0607" in done.stderr, "ulimit -v is the limit of memory", done.stderr)

    return [test_kill, test_kill_at_any_time, test_interrupt, test_interrupt_in_json, test_signals, test_endless_ray,
            test_progress, test_million_spheres, test_budget, test_limits_of_the_shell]
