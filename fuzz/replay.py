#!/usr/bin/env python3
"""Gives every fuzz target its corpus, and those of text what the tests hold, without a fuzzer. Prints TAP.

Findings lie in fuzz/corpus: a target that fell over one must not do so again. Seeds are made of the examples and of the
cases of tests/lang, a tenth of them, by turns with FUZZ_TURN.
SPDX-License-Identifier: MIT
"""
import glob
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
TOP = os.path.abspath(os.environ["top_srcdir"])
sys.path[:0] = [os.path.join(TOP, "fuzz"), os.path.join(TOP, "tests", "system")]
import make_seeds
from tap import Tap

PROGRAMS = os.path.abspath("fuzz")
SHARE = 10


def main():
    tap = Tap()
    turn = int(os.environ.get("FUZZ_TURN", "0"))
    with tempfile.TemporaryDirectory() as folder:
        make_seeds.write_seeds(TOP, folder)
        for target, corpus in make_seeds.TARGETS.items():
            seeds = sorted(glob.glob(os.path.join(folder, corpus, "*")))
            found = sorted(glob.glob(os.path.join(TOP, "fuzz", "corpus", corpus, "*")))
            for what, files, changes in ("findings", found, 0), ("seeds", seeds[turn::SHARE], 2):
                if files:
                    # An empty folder: what scenes include is not there.
                    done = subprocess.run([os.path.join(PROGRAMS, "replay_" + target), *files], cwd=folder,
                                          env={**os.environ, "FUZZ_MUTATIONS": str(changes), "TMPDIR": folder},
                                          stdin=subprocess.DEVNULL, capture_output=True, check=False)
                    names = [line for line in done.stdout.decode("utf-8", "replace").splitlines() if " - " in line]
                    after = names[-1] if names else "none"
                    tap.ok(done.returncode == 0 and len(names) == len(files), "%s: %d %s" % (target, len(files), what),
                           "exit %d; the last that held: %s\n%s" % (done.returncode, after,
                                                                   done.stderr.decode("utf-8", "replace")[-2000:]))
    tap.done()


main()
