#!/usr/bin/env python3
"""What ranks of MPI gain and cost, as docs/scale.md has it. Wants RTLANG, the program, and mpirun; on a machine that does
nothing else, with as many processors as ranks:

    ranks.py efficiency [TURNS]      1 and 2 ranks of one thread: frames, tiles of a picture of 2 s, and --mpi with one rank
                                     beside none
    ranks.py scene [SPHERES] [TURNS] 1, 2 and 4 ranks that share a scene (--mpi=scene), beside one process
    ranks.py tachyon TACHYON [SPHERES] [TURNS]
                                     beside Tachyon with MPI, whose program is named
    ranks.py build-tachyon FOLDER    makes one of Debian's source package, there

Each figure is the median of TURNS runs, taken in turn, of wall seconds; beside it processor seconds, which a busy machine
changes less. SPDX-License-Identifier: MIT
"""
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

RTLANG = os.path.abspath(os.environ.get("RTLANG", "rtlang"))
HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLE = os.path.join(os.path.dirname(HERE), "examples", "10_sphere_flake.scn")
MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n"]
# Of OpenMPI in one machine: no network that is looked for, no remote shells.
SETTINGS = {"OMPI_MCA_btl": "self,vader", "OMPI_MCA_plm": "isolated", "OMPI_MCA_btl_base_warn_component_unused": "0",
            "OMPI_MCA_hwloc_base_binding_policy": "none"}
SOURCES = "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian bookworm main\n"


def ranks(count, *words):
    return [*MPIRUN, str(count), *words]


def timed(words, folder):
    """Wall and processor seconds of a command, with all that it started."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit(" ".join(words) + "\n" + done.stdout.decode(errors="replace"))
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def medians(commands, turns, folder):
    """By name; the commands take turns, so that what disturbs one disturbs all."""
    found = {name: [] for name in commands}
    for turn in range(turns):
        for name in list(commands)[:: 1 if turn % 2 else -1]:
            found[name].append(timed(commands[name], folder))
    return {name: tuple(statistics.median(column) for column in zip(*runs)) for name, runs in found.items()}


def table(rows):
    for name, (wall, processor) in rows.items():
        print(f"{name:44} {wall:8.3f} s  {processor:8.3f} s of processors")


def efficiency(turns):
    with tempfile.TemporaryDirectory() as folder:
        tiles = ["-q", "-t", "1", "-W", "1600", "-H", "1200", "--antialias=2", "--antialias-threshold=0.1", "-o"]
        frames = ["-q", "-t", "1", "-W", "320", "-H", "240", "--samples=4", "--frames=1..32", "-o"]
        found = medians({
            "tiles, no MPI": [RTLANG, *tiles, "a.png", EXAMPLE],
            "tiles, 1 rank": ranks(1, RTLANG, *tiles, "b.png", "--mpi", EXAMPLE),
            "tiles, 2 ranks": ranks(2, RTLANG, *tiles, "c.png", "--mpi", EXAMPLE),
            "frames, 1 rank": ranks(1, RTLANG, *frames, "f.png", "--mpi", EXAMPLE),
            "frames, 2 ranks": ranks(2, RTLANG, *frames, "g.png", "--mpi", EXAMPLE),
            "no picture, 1 rank": ranks(1, RTLANG, "-q", "-t", "1", "-W", "8", "-H", "8", "-o", "h.png", "--mpi", EXAMPLE),
            "no picture, 2 ranks": ranks(2, RTLANG, "-q", "-t", "1", "-W", "8", "-H", "8", "-o", "i.png", "--mpi", EXAMPLE),
        }, turns, folder)
        table(found)
        begin = {1: found["no picture, 1 rank"], 2: found["no picture, 2 ranks"]}

        def without(name, count):
            return [found[name][i] - begin[count][i] for i in range(2)]
        one, two = without("tiles, 1 rank", 1), without("tiles, 2 ranks", 2)
        print("without the beginning and end of MPI:")
        print(f"tiles: 2 ranks {one[0] / two[0]:.2f} times as fast as 1 (bar 1.7), by processor time {2 * one[1] / two[1]:.2f}")
        one, two = without("frames, 1 rank", 1), without("frames, 2 ranks", 2)
        print(f"frames: 2 ranks {one[0] / two[0]:.2f} times as fast as 1 (bar 1.8), by processor time {2 * one[1] / two[1]:.2f}")
        one, none = without("tiles, 1 rank", 1), found["tiles, no MPI"]
        print(f"--mpi with one rank: {100 * (one[0] / none[0] - 1):+.1f} % (bar 2), by processor time {100 * (one[1] / none[1] - 1):+.1f} %")


def write_scene(folder, count, language):
    path = os.path.join(folder, "scene." + language)
    with open(path, "wb") as file:
        subprocess.run([sys.executable, os.path.join(HERE, "generate.py"), str(count), language], stdout=file, check=True)
    return path


def scene(count, turns):
    with tempfile.TemporaryDirectory() as folder:
        path = write_scene(folder, count, "povray")
        words = ["-q", "-t", "1", "-W", "800", "-H", "600", path, "-o"]
        commands = {"one process": [RTLANG, *words, "a.png"]}
        for n in (1, 2, 4):
            commands[f"{n} ranks, --mpi=scene"] = ranks(n, RTLANG, *words, f"{n}.png", "--mpi=scene")
        table(medians(commands, turns, folder))


def tachyon(program, count, turns):
    with tempfile.TemporaryDirectory() as folder:
        ours, theirs = write_scene(folder, count, "povray"), write_scene(folder, count, "tachyon")
        commands = {}
        for n in (1, 2):
            commands[f"rtlang --mpi, {n} ranks"] = ranks(n, RTLANG, "-q", "-t", "1", "-W", "800", "-H", "600", "--mpi", "-o", "a.tga", ours)
            commands[f"Tachyon, {n} ranks"] = ranks(n, os.path.abspath(program), theirs, "-shade_phong", "-res", "800", "600",
                                                    "-format", "TARGA", "-o", "b.tga")
        table(medians(commands, turns, folder))


def build_tachyon(folder):
    os.makedirs(os.path.join(folder, "lists", "partial"), exist_ok=True)
    folder = os.path.abspath(folder)
    with open(os.path.join(folder, "sources.list"), "w", encoding="utf-8") as file:
        file.write(SOURCES)
    apt = ["apt-get", "-o", f"Dir::Etc::SourceList={folder}/sources.list", "-o", "Dir::Etc::SourceParts=/dev/null", "-o",
           f"Dir::State::Lists={folder}/lists", "-o", "APT::Sandbox::User=root"]
    subprocess.run([*apt, "update"], cwd=folder, check=True)
    subprocess.run([*apt, "source", "--download-only", "tachyon"], cwd=folder, check=False)  # Debian's own changes are not needed
    subprocess.run("tar xf tachyon_*.orig.tar.*", shell=True, cwd=folder, check=True)
    unix = subprocess.run("ls -d tachyon*/unix", shell=True, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout.split()[0]
    subprocess.run(["make", "linux-mpi"], cwd=os.path.join(folder, unix), check=True, stdout=subprocess.DEVNULL)
    print(os.path.join(folder, os.path.dirname(unix), "compile", "linux-mpi", "tachyon"))


def main():
    os.environ.update(SETTINGS)
    words = dict(enumerate(sys.argv[1:]))
    what = words.get(0)
    if what == "efficiency":
        efficiency(int(words.get(1, 5)))
    elif what == "scene":
        scene(int(words.get(1, 1000000)), int(words.get(2, 3)))
    elif what == "tachyon" and 1 in words:
        tachyon(words[1], int(words.get(2, 100000)), int(words.get(3, 5)))
    elif what == "build-tachyon" and 1 in words:
        build_tachyon(words[1])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
