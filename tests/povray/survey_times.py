"""How long scenes take in rtlang and in POV-Ray: processor seconds of whole runs, in turns, of which the least counts.

Both draw with one thread, without anti-aliasing, to PNG. A machine that others use, too, makes every run longer, so that
only ratios of one run mean anything. SPDX-License-Identifier: MIT
"""
import math
import os
import resource
import statistics
import subprocess

import pictures

PROGRAMS = ("rtlang", "povray")
TRIES = 5  # POV-Ray gives up before it began on a machine that is busy


def seconds_of(command, folder, limit):
    """Processor seconds of a run, or None when it failed or took more than the limit."""
    for _ in range(TRIES):
        with subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))) as process:
            messages = process.stderr.read()
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode == 0:
            return used.ru_utime + used.ru_stime
        if b"Timed out waiting for worker thread startup" not in messages:
            break
    return None


def commands(scene, width, height, folders):
    """The command of each program."""
    name = os.path.basename(scene)
    return {
        "rtlang": [os.environ["RTLANG"], "-q", "-t1", "--allow-write=.", f"-W{width}", f"-H{height}", "-o", "survey_rtlang.png",
                   *(f"-I{place}" for place in folders), name],
        "povray": [pictures.povray(), f'+I"./{name}"', "+Osurvey_povray.png", f"+W{width}", f"+H{height}", "-A", "-D", "-P",
                   "+WT1", *(f"+L{place}" for place in folders)],
    }


def measure(scene, size, turns, limit, folders):
    """{program: [seconds of each turn]} of one scene, the programs in turns; None in place of what failed."""
    width, height = size
    runs = commands(scene, width, height, folders)
    times = {program: [] for program in PROGRAMS}
    for _ in range(turns):
        for program in PROGRAMS:
            if None not in times["rtlang"] + times["povray"]:
                times[program].append(seconds_of(runs[program], os.path.dirname(scene), math.ceil(limit)))
    return times


def ratio(times):
    """rtlang's least seconds over POV-Ray's, or None where a program failed."""
    if None in times["rtlang"] + times["povray"]:
        return None
    return min(times["rtlang"]) / min(times["povray"])


def print_times(records):
    """A line a scene, the slowest beside POV-Ray first, and what all of them are together."""
    timed = [record for record in records if "times" in record]
    judged = [(ratio(record["times"]), record) for record in timed if ratio(record["times"]) is not None]
    print(f"\n{len(timed)} scenes timed, {len(timed) - len(judged)} of them not finished by both")
    print("rtlang / POV-Ray, and the least processor seconds of each")
    for value, record in sorted(judged, key=lambda entry: (-entry[0], entry[1]["scene"])):
        print(f"{value:8.3f} {min(record['times']['rtlang']):9.3f} {min(record['times']['povray']):9.3f}  {record['scene']}")
    for record in timed:
        if ratio(record["times"]) is None:
            last = "rtlang" if None in record["times"]["rtlang"] else "povray"
            print(f"       -  {last} failed, or was stopped at the limit: {record['scene']}")
    if judged:
        ratios = [value for value, _ in judged]
        print(f"{sum(value > 1.0 for value in ratios)} of {len(ratios)} slower than POV-Ray; geometric mean "
              f"{math.exp(statistics.fmean(map(math.log, ratios))):.3f}, median {statistics.median(ratios):.3f}")
