#!/usr/bin/env python3
"""ASE's own tests of its writer for POV-Ray, from Debian's python3-ase, with rtlang as `povray`.

They are called one by one, with their fixtures given, since pytest need not be there: of it they use `warns` alone. Pictures that they
leave are looked at, too. Prints TAP. SPDX-License-Identifier: MIT
"""
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "system"))
import tap  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])
PYTHON = "/usr/bin/python3" # for which Debian's packages are
SUITE = "/usr/lib/python3/dist-packages/ase/test/fio/test_povray.py"
NAMES = ["test_povray_io", "test_povray_highorder", "test_deprecated"]
PICTURES = {"test_povray_io": "H2.png", "test_povray_highorder": "atoms.png"} # the third draws none
CALL = """import contextlib, importlib.util, inspect, shutil, sys, types, warnings
@contextlib.contextmanager
def warns(kind):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        yield
    assert any(issubclass(one.category, kind) for one in found), "no " + kind.__name__
sys.modules["pytest"] = types.SimpleNamespace(warns=warns)
spec = importlib.util.spec_from_file_location("suite", sys.argv[1])
suite = importlib.util.module_from_spec(spec)
spec.loader.exec_module(suite)
fixtures = {"testdir": ".", "povray_executable": shutil.which("povray")}
test = getattr(suite, sys.argv[2])
test(**{name: fixtures[name] for name in inspect.signature(test).parameters})
"""


def main():
    report = tap.Tap()
    if not os.path.exists(SUITE):
        report.skip("ASE's tests", "no python3-ase")
        report.done()
    with open(SUITE, encoding="utf-8") as file:
        found = [line.split("(")[0][4:] for line in file if line.startswith("def test_")]
    report.equal(found, NAMES, "the tests are those that are known")
    for name in found:
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "bin"))
            os.symlink(PROGRAM, os.path.join(folder, "bin", "povray"))
            environment = dict(os.environ, PATH=os.path.join(folder, "bin") + ":" + os.environ["PATH"])
            environment.pop("PYTHONPATH", None)
            done = subprocess.run([PYTHON, "-B", "-c", CALL, SUITE, name], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120, check=False, text=True)
            report.ok(done.returncode == 0, f"ASE: {name}", done.stdout)
            if name not in PICTURES:
                continue
            picture = os.path.join(folder, PICTURES[name])
            is_ours = os.path.isfile(picture) and b"Software\0rtlang" in open(picture, "rb").read(2000)
            report.ok(is_ours, f"ASE: {name}: rtlang drew the picture", os.listdir(folder))
    report.done()


main()
