#!/usr/bin/env python3
"""An installation that was moved works without environment variables: from its programs, a C client, and Python.

`make install` into a staging folder, a copy of it in another place, the first one removed. Then a scene with colors.inc
is drawn into an EXR file by rtlang, by a client that pkg-config compiled, and by a process that loads the library; each
must take the include file and the module of OpenImageIO from the new place. Where they are missing the messages say
where they were looked for. Built without OpenImageIO, PNG is written. Prints TAP. SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
from tap import Tap  # noqa: E402

tap = Tap()
SCENE = """#version 3.7;
global_settings { assumed_gamma 1 }
#include "colors.inc"
#include "transforms.inc"
camera { location -5*z look_at 0 }
light_source { <3, 4, -5>, rgb 1 }
sphere { x, 1 pigment { SkyBlue } Reorient_Trans(x, y) }
"""
CLIENT = r"""#include <rtlang/rtlang.h>
#include <stdio.h>
static void tell(void *client, const rt_diagnostic *diagnostic)
{
    (void)client;
    fputs(diagnostic->text, stderr);
}
int main(int argc, char **argv)
{
    rt_callbacks callbacks = {NULL, tell, NULL, NULL};
    rt_session *session = rt_session_new(&callbacks);
    rt_output output = {0};
    int status = argc < 3 || session == NULL || rt_set_size(session, 16, 12) || rt_load_file(session, argv[1]) ||
                 rt_render(session, 1) || rt_write(session, argv[2], &output);
    rt_session_free(session);
    return status;
}
"""
# The process goes elsewhere between loading the library by a relative name and asking it for something.
PYTHON = r"""import ctypes, os, sys
os.chdir(sys.argv[1])
rt = ctypes.CDLL("./" + sys.argv[2])
os.chdir(sys.argv[3])
rt.rt_session_new.restype = ctypes.c_void_p
session = ctypes.c_void_p(rt.rt_session_new(None))
output = (ctypes.c_char * 256)()
sys.exit(rt.rt_set_size(session, 16, 12) or rt.rt_load_file(session, b"scene.scn") or rt.rt_render(session, 1)
         or rt.rt_write(session, sys.argv[4].encode(), output))
"""


def run(*arguments, folder, **more):
    """POV-Ray's files must not serve instead of ours, nor what the caller's environment says of places."""
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(("MAKE", "MFLAGS", "LD_LIBRARY", "PKG_CONFIG", "DESTDIR", "RTLANG"))}
    environment.update({"POVINI": os.path.join(folder, "povray.ini"), "HOME": folder, **more})
    return subprocess.run(arguments, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=120, check=False)


def said(done):
    return f"status {done.returncode}\n" + done.stdout.decode("utf-8", "replace")[-3000:]


def find(top, name):
    """The file of an installation, wherever its folders are called; completions of shells have a program's name, too."""
    found = [path for path in glob.glob(f"{glob.escape(top)}/**/{name}", recursive=True)
             if os.path.isfile(path) and "completion" not in path]
    return found[0] if found else ""


def install(folder):
    """(the installation where it was moved to, what make said)."""
    stage, moved = os.path.join(folder, "stage"), os.path.join(folder, "another place")
    done = run(os.environ.get("MAKE", "make"), "-s", "install", f"DESTDIR={stage}", "POVRAY_LINK=povray",
               folder=os.getcwd(), HOME=folder)
    if done.returncode == 0:
        top = os.path.dirname(os.path.dirname(find(stage, "rtcheck")))
        staged = run(find(stage, "rtlang"), "-q", "--check", "scene.scn", folder=folder)
        tap.ok(staged.returncode == 0, "installed below DESTDIR it finds its include files", said(staged))
        shutil.copytree(top, moved, symlinks=True)
        shutil.rmtree(stage)
    return moved, said(done)


def check_drawn(name, folder, moved, *command):
    """Runs what draws the scene into the file that is named last, and looks where it took its files from."""
    module = find(moved, "rtlang_oiio.so")
    picture, begins = (name + ".tif", b"II*\0") if module else (name + ".png", b"\x89PNG")
    done = run(*command, picture, folder=folder, LD_DEBUG="files")
    loaded = re.findall(r"calling init: (.*/rtlang_oiio\.so)", done.stdout.decode("utf-8", "replace"))
    tap.ok(done.returncode == 0 and loaded == [module] * bool(module),
           name + ": draws, with the moved module", f"module {loaded}, not {module}\n" + said(done))
    if done.returncode == 0:
        with open(os.path.join(folder, picture), "rb") as file:
            tap.equal(file.read(4), begins, f"{name}: into {picture}")


def check_client(folder, moved):
    """pkg-config's file goes along with the installation."""
    where = os.path.dirname(find(moved, "rtlang.pc"))
    config = run("pkg-config", "--cflags", "--libs", "rtlang", folder=folder, PKG_CONFIG_PATH=where)
    library = run("pkg-config", "--variable=libdir", "rtlang", folder=folder, PKG_CONFIG_PATH=where)
    if not tap.ok(config.returncode == 0 and library.returncode == 0, "pkg-config", said(config)):
        return
    flags, libdir = shlex.split(config.stdout.decode()), os.path.realpath(shlex.split(library.stdout.decode())[0])
    tap.equal(libdir, os.path.dirname(find(moved, "librtlang.so")), "pkg-config tells the new place")
    made = run(*shlex.split(os.environ.get("CC", "cc")), "client.c", "-o", "client", *flags, f"-Wl,-rpath,{libdir}",
               folder=folder)
    if tap.ok(made.returncode == 0, "a client in C", said(made)):
        check_drawn("client", folder, moved, "./client", "scene.scn")
    example = os.path.abspath(os.path.join(os.environ.get("top_srcdir", "."), "examples", "particles.c"))
    made = run(*shlex.split(os.environ.get("CC", "cc")), "-std=c99", "-Wall", "-Wextra", "-Werror", example, "-o",
               "particles", *flags, "-lm", f"-Wl,-rpath,{libdir}", folder=folder)
    done = run("./particles", folder=folder) if made.returncode == 0 else made
    sizes = [os.path.getsize(os.path.join(folder, name)) for name in ("front.png", "back.png")
             if os.path.exists(os.path.join(folder, name))]
    tap.ok(done.returncode == 0 and len(sizes) == 2 and min(sizes) > 5000,
           "examples/particles.c draws both its pictures", said(done))


def check_includes(folder, moved):
    """Both programs and POV-Ray take rtlang's own file; the note of a missing one tells where it was looked for."""
    with open(os.path.join(folder, "nowhere.scn"), "w", encoding="ascii") as file:
        file.write('#include "nowhere.inc"\nsphere { 0, 1 }\n')
    own = os.path.dirname(find(moved, "colors.inc"))
    done = run(find(moved, "rtlang"), "--check", "--no-povray-includes", "nowhere.scn", folder=folder)
    tap.ok(f"searched in the current folder, `{own}`\n" in done.stdout.decode(), "where include files are looked for",
           said(done))
    if not shutil.which("povray"):
        tap.skip("rtcheck has POV-Ray read rtlang's include files", "no povray here")
        return
    done = run(find(moved, "rtcheck"), "-W32", "-H24", "scene.scn", folder=folder)
    tap.ok(done.returncode == 0 and b"ok" in done.stdout, "rtcheck has POV-Ray read rtlang's include files", said(done))


def check_missing(folder, moved):
    """What is said when the files are not there."""
    module, data = find(moved, "rtlang_oiio.so"), os.path.dirname(find(moved, "colors.inc"))
    program = find(moved, "rtlang")
    if module:
        os.rename(module, module + ".away")
    done = run(program, "-q", "-o", "missing.tif", "scene.scn", folder=folder)
    words = f"no rtlang_oiio.so in {os.path.dirname(module)}" if module else "this rtlang was built without it"
    tap.ok(done.returncode == 3 and words in done.stdout.decode(), "where the module is looked for", said(done))
    os.rename(data, data + ".away")
    done = run(program, "-q", "--no-povray-includes", "--check", "scene.scn", folder=folder)
    tap.ok(done.returncode == 3 and f"searched in the current folder, `{data}`" in done.stdout.decode(),
           "where the folder of include files should be", said(done))


def main():
    # Names with a blank in them, and no links on the way: what is found is printed as it is.
    with tempfile.TemporaryDirectory() as made:
        folder = os.path.realpath(made)
        for name, text in (("scene.scn", SCENE), ("client.c", CLIENT), ("client.py", PYTHON),
                           ("povray.ini", "; nothing\n")):
            with open(os.path.join(folder, name), "w", encoding="ascii") as file:
                file.write(text)
        moved, words = install(folder)
        if not tap.ok(os.path.exists(moved), "make install", words):
            tap.done()
        program = find(moved, "rtlang")
        check_drawn("program", folder, moved, program, "-q", "-W16", "-H12", "scene.scn", "-o")
        link = os.path.join(os.path.dirname(program), "povray")
        done = run(link, "+Iscene.scn", "+W16", "+H12", "+Olink.png", folder=folder)
        tap.ok(os.path.islink(link) and done.returncode == 0 and os.path.exists(os.path.join(folder, "link.png")),
               "the link povray takes POV-Ray's options", said(done))
        os.symlink(program, os.path.join(folder, "link"))
        check_drawn("link", folder, moved, "./link", "-q", "-W16", "-H12", "scene.scn", "-o")
        if shutil.which("pkg-config"):
            check_client(folder, moved)
        else:
            tap.skip("a client in C", "no pkg-config here")
        library = find(moved, "librtlang.so")
        check_drawn("python", folder, moved, sys.executable, "client.py", os.path.dirname(library),
                    os.path.basename(library), folder)
        check_includes(folder, moved)
        check_missing(folder, moved)
    tap.done()


if __name__ == "__main__":
    main()
