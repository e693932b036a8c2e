#!/usr/bin/env python3
"""Makes a wheel of the package, with the library and its data in it: make wheel.

    make_wheel.py VERSION FOLDER [MAKE]

Installs into a staging folder and zips what a wheel holds (PEP 427): the package, below _native the library, its
modules and the include files at the distances that an installation has, and the libraries that these need and that a
system may lack. It works wherever it is unpacked; no compiler and no network are needed. The same build gives the same
bytes. SPDX-License-Identifier: MIT
"""
import base64
import glob
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
NEEDED = ("libpng16.so", "libz.so", "libjpeg.so")  # what else they need is libc's and libm's
METADATA = """Metadata-Version: 2.1
Name: rtlang
Version: {version}
Summary: Ray tracing of many spheres from numpy arrays, with the error known
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy>=1.20
"""


def installed(stage, make):
    """(path in _native, path) of the files of an installation that the package uses."""
    subprocess.run([make, "-s", "install", f"DESTDIR={stage}"], check=True, stdout=subprocess.DEVNULL)
    found = glob.glob(os.path.join(glob.escape(stage), "**", "rtlang.pc"), recursive=True)[0]
    libraries = os.path.dirname(os.path.dirname(found))
    top = os.path.commonpath([libraries, glob.glob(os.path.join(glob.escape(stage), "**", "colors.inc"),
                                                   recursive=True)[0]])
    kept = {}
    for folder, _, names in sorted(os.walk(top)):
        for name in sorted(names):
            path = os.path.join(folder, name)
            is_library = re.fullmatch(r"librtlang\.so\.\d+", name) or name in ("rtlang_jpeg.so",)
            if is_library or os.path.basename(folder) == "rtlang" and name.endswith(".inc"):
                kept[os.path.relpath(path, top)] = os.path.realpath(path)
    return kept


def needed(libraries):
    """The libraries among NEEDED that these load."""
    found = {}
    for library in libraries:
        said = subprocess.run(["ldd", library], check=True, stdout=subprocess.PIPE, text=True).stdout
        for name, path in re.findall(r"^\s*(\S+) => (/\S+)", said, re.MULTILINE):
            if name.startswith(NEEDED):
                found[name] = os.path.realpath(path)
    return found


def stripped(path, folder):
    """The file without what only debuggers read, where there is strip."""
    out = os.path.join(folder, os.path.basename(path))
    try:
        subprocess.run(["strip", "--strip-unneeded", "-o", out, path], check=True)
        return out
    except (OSError, subprocess.CalledProcessError):
        return path


def main():
    version, target, make = sys.argv[1], sys.argv[2], (sys.argv[3:] or ["make"])[0]
    tag = "py3-none-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")
    info, record = f"rtlang-{version}.dist-info", []
    wheel = os.path.join(target, f"rtlang-{version}-{tag}.whl")
    with tempfile.TemporaryDirectory() as work, zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        def add(name, data, mode=0o644):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr, entry.compress_type = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(data)}")

        def add_file(name, path, mode=0o644):
            with open(path, "rb") as file:
                add(name, file.read(), mode)

        package = os.path.join(HERE, "rtlang")
        for path in sorted(glob.glob(os.path.join(package, "*.py")) + [os.path.join(package, "py.typed")]):
            add_file("rtlang/" + os.path.basename(path), path)
        files = installed(os.path.join(work, "stage"), make)
        libraries = [path for path in files.values() if ".so" in path]
        for name, path in sorted(files.items()):
            add_file("rtlang/_native/" + name, stripped(path, work) if path in libraries else path, 0o755)
        for name, path in sorted(needed(libraries).items()):
            add_file("rtlang/_native/needed/" + name, path, 0o755)
        add(f"{info}/METADATA", METADATA.format(version=version).encode())
        about = f"Wheel-Version: 1.0\nGenerator: make_wheel\nRoot-Is-Purelib: false\nTag: {tag}\n"
        add(f"{info}/WHEEL", about.encode())
        add(f"{info}/RECORD", ("\n".join(record) + f"\n{info}/RECORD,,\n").encode())
    print(wheel)


if __name__ == "__main__":
    main()
