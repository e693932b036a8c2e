#!/usr/bin/env python3
"""The Python package: numpy arrays in and out.

Pictures from arrays beside those that the program draws of the scene's dump, byte for byte; arrays of any strides; what
is refused and in which words; Ctrl-C, exceptions and threads; a wheel that is unpacked elsewhere; and every block of
docs/python.md. Runs in a Python that has numpy, if there is one. Prints TAP. SPDX-License-Identifier: MIT
"""
import gc
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
import weakref
import zipfile
import zlib

sys.dont_write_bytecode = True  # the folders are distributed as they are
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from exr import read_exr  # noqa: E402
from picture_bytes import png_chunks, png_without_texts  # noqa: E402
from tap import Tap  # noqa: E402

try:
    import numpy as np
except ImportError:
    if sys.executable != "/usr/bin/python3" and os.access("/usr/bin/python3", os.X_OK):
        os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)
    Tap().skip("the Python package", "no numpy here")
    print("1..1")
    sys.exit(0)

TOP = os.path.abspath(os.environ.get("top_srcdir", "."))
BUILD = os.path.dirname(os.environ.get("RTLANG", os.path.abspath("./rtlang")))
os.environ["RTLANG_LIBRARY"] = os.path.join(BUILD, ".libs", "librtlang.so")
sys.path.insert(0, os.path.join(TOP, "python"))
if not os.path.exists(os.environ["RTLANG_LIBRARY"]):
    Tap().skip("the Python package", "built without the shared library")
    print("1..1")
    sys.exit(0)
import rtlang  # noqa: E402

tap = Tap()
SEED = int(os.environ.get("RTLANG_SEED") or time.time_ns() % 2**32)
rng = np.random.default_rng(SEED)
print(f"# RTLANG_SEED={SEED} repeats this run")


def cloud(count):
    return rng.uniform(-2, 2, (count, 3)), rng.uniform(0.05, 0.4, count), rng.uniform(0, 1, (count, 3))


def lit(**more):
    scene = rtlang.Scene(**more)
    scene.light((-4, 6, 7), (0.9, 0.8, 0.7))
    scene.camera((0.5, 1, 9), (0, 0, 0), angle=40)
    return scene


def drawn(*arguments, scene=None, **more):
    scene = scene or lit()
    scene.spheres(*arguments, **more)
    return scene.render(48, 36)


def equal(one, other):
    return one.pixels.tobytes() == other.pixels.tobytes()


# ---- pictures

def check_pictures(folder):
    same = 0
    for _ in range(8):
        centers, radii, colors = cloud(int(rng.integers(3, 200)))
        scene = lit()
        scene.text("plane { y, -3 pigment { checker rgb 1, rgb 0.2 } }")
        scene.spheres(centers, radii, colors, "phong 0.5 reflection 0.2")
        scene.bonds(centers, [(0, 1), (1, 2)], 0.1, center_colors=colors)
        scene.triangles(rng.uniform(-2, 2, (4, 3, 3)), (0.2, 0.6, 0.3))
        image = scene.render(64, 48)
        path = os.path.join(folder, "dump.scn")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene.dump())
        subprocess.run([os.environ.get("RTLANG", "./rtlang"), "-q", "-W64", "-H48", "-o", path + ".png", path],
                       check=True)
        with open(path + ".png", "rb") as file:
            same += png_without_texts(file.read()) == png_without_texts(image.png())
    tap.equal(same, 8, "from arrays, and from the dump by the program: the same files but for what they say of their origin")
    centers, radii, colors = cloud(50)
    image = lit().spheres(centers, radii, colors)._scene.render(48, 36)
    image.save(os.path.join(folder, "saved.png"))
    with open(os.path.join(folder, "saved.png"), "rb") as file:
        tap.ok(file.read() == image.png() == image._repr_png_(), "save, png and the notebook's form are the same bytes")
    tap.equal((image.to_array().dtype, image.to_array("uint16").shape, image.to_array("float32").tobytes()),
              (np.uint8, (36, 48, 3), image.pixels.tobytes()), "8, 16 and 32 bits")
    tap.ok(image.rmse is None and image.samples == 1 and image.end == "done", "one ray a pixel has no known error")


def check_strides():
    centers, radii, colors = (array.astype(np.float32) for array in cloud(40))
    plain = drawn(centers, radii, colors)
    table = np.zeros((40, 12), np.float32)
    table[:, 1:4], table[:, 5], table[:, 9:6:-1] = centers, radii, colors
    for name, arrays in {
            "float64": (centers.astype(np.float64), radii.astype(np.float64), colors.astype(np.float64)),
            "in Fortran's order": (np.asfortranarray(centers), radii, np.asfortranarray(colors)),
            "columns of a table, some backwards": (table[:, 1:4], table[:, 5], table[:, 9:6:-1]),
            "every other row": tuple(np.repeat(array, 2, axis=0)[::2] for array in (centers, radii, colors)),
            "lists": (centers.tolist(), radii.tolist(), colors.tolist()),
            "colors with an alpha of 1": (centers, radii, np.hstack((colors, np.ones((40, 1), np.float32)))),
    }.items():
        tap.ok(equal(drawn(*arrays), plain), f"arrays: {name}")
    backwards = drawn(centers[::-1], radii[::-1], colors[::-1])
    tap.ok(np.mean(backwards.pixels == plain.pixels) > 0.99, "arrays: backwards")
    tap.ok(equal(drawn([[0, 0, 0], [1, 1, 1]], 1), drawn(np.array([[0.0, 0, 0], [1, 1, 1]]), np.array([1.0, 1.0]))),
           "integers, and one radius for all")
    tap.ok(equal(drawn(centers[0], 0.3, colors[0]), drawn(centers[:1], [0.3], colors[:1])), "one sphere")


def check_again():
    centers, radii, colors = cloud(60)
    scene = lit()
    group = scene.spheres(centers, radii, colors)
    scene.render(48, 36)
    scene.camera((4, 2, 6), (0, 0, 0), angle=50)
    fresh = lit()
    fresh.camera((4, 2, 6), (0, 0, 0), angle=50)
    tap.ok(equal(scene.render(48, 36), drawn(centers, radii, colors, scene=fresh)), "another camera")
    for name, change in (("places", (cloud(60)[0], None, None)), ("radii", (None, radii / 2, None)),
                         ("colors", (None, None, colors[::-1])), ("colors again", (None, None, colors))):
        group.update(*change)
        centers, radii, colors = (old if new is None else new for old, new in zip((centers, radii, colors), change))
        fresh = lit()
        fresh.camera((4, 2, 6), (0, 0, 0), angle=50)
        tap.ok(equal(scene.render(48, 36), drawn(centers, radii, colors, scene=fresh)), f"other {name}")
    group.update(colors=(1, 0, 0), first=30)
    expected = colors.copy()
    expected[30:] = (1, 0, 0)
    fresh = lit()
    fresh.camera((4, 2, 6), (0, 0, 0), angle=50)
    tap.ok(equal(scene.render(48, 36), drawn(centers, radii, expected, scene=fresh)), "one color for half of them")
    part = scene.render(48, 36, crop=(10, 5, 20, 15))
    tap.ok(np.array_equal(part.pixels, scene.render(48, 36).pixels[5:20, 10:30]), "a crop is a part of the whole")


def check_samples():
    scene = lit()
    scene.spheres(*cloud(30))
    seen = []
    image = scene.render(64, 48, target_error=0.01, progress=seen.append)
    tap.ok(image.rmse <= 0.01 and image.interval[0] <= image.rmse <= image.interval[1] and image.end == "target",
           f"a wanted error: {image}")
    tap.ok(seen and all(0 <= done <= 1 for done in seen), "progress is told")
    tap.equal(scene.render(64, 48, samples=4).samples, 4.0, "samples")
    clear = scene.render(64, 48, alpha=True)
    tap.ok(clear.alpha.min() == 0 and clear.alpha.max() == 1 and clear.to_array().shape == (48, 64, 4), "alpha")
    again = scene.render(64, 48)
    tap.ok(again.alpha is None and not again.planes, "no alpha again")
    found = scene.render(64, 48, planes=("object", "depth", "normal")).planes
    is_seen = found["object"] > 0
    tap.ok(found["object"].dtype == np.uint32 and found["object"].max() <= 30 and
           found["normal"].shape == (48, 64, 3) and np.array_equal(is_seen, np.isfinite(found["depth"])) and np.array_equal(is_seen, clear.alpha > 0) and
           np.allclose(np.linalg.norm(found["normal"], axis=2), is_seen, atol=1e-6), "planes of what is seen")
    sampled = scene.render(64, 48, samples=4, planes=("samples", "error", "depth"))
    tap.ok((sampled.planes["samples"] == 4).all() and np.array_equal(sampled.planes["depth"], found["depth"]) and
           np.isclose(np.sqrt((sampled.planes["error"] ** 2).mean()), sampled.rmse, rtol=1e-3), "and of samples")
    for wrong in (["depht"], "depth"):
        refused(f"planes {wrong!r}", lambda: scene.render(64, 48, planes=wrong), rtlang.UsageError,  # noqa: B023
                f"error[E0709]: planes is a list of names of error, samples, depth, normal, object, albedo, not {wrong!r}")
    low, high = scene.box()
    tap.ok(np.all(low < high), "the box around the shapes")
    scene.camera(fit=True)
    filled = scene.render(64, 48, alpha=True).alpha
    tap.ok(filled.any(axis=0).sum() > 30 or filled.any(axis=1).sum() > 30, "fit fills the picture")
    edge = np.concatenate((filled[0], filled[-1], filled[:, 0], filled[:, -1]))
    tap.ok(not edge.any(), "and cuts nothing off")


# ---- light and lines that make shape seen

def check_looks(folder):
    centers, radii, colors = cloud(60)
    scene = lit()
    scene.spheres(centers, radii, colors)
    plain = scene.render(64, 48)
    scene.sky(0.4)
    scene.outline(2.5)
    scene.depth_cue(0.6)
    image, path = scene.render(64, 48, samples=3), os.path.join(folder, "looks.scn")
    with open(path, "w", encoding="utf-8") as file:
        file.write(scene.dump())
    subprocess.run([os.environ.get("RTLANG", "./rtlang"), "-q", "-W64", "-H48", "--sky-light=0.4", "--outline=2.5",
                    "--depth-cue=0.6", "--samples=3", "-o", path + ".png", path], check=True)
    with open(path + ".png", "rb") as file:
        with open(os.path.join(folder, "looks.png"), "wb") as own:
            own.write(image.png())
        tap.ok(np.array_equal(pixels_of(path + ".png"), pixels_of(own.name)), "sky, outline and depth cue as the program's")
    scene.sky(0)
    scene.outline(0)
    scene.depth_cue(0)
    tap.ok(equal(scene.render(64, 48), plain), "and without them again")
    for look, is_clear in (("publication", True), ("soft", False), ("deep", False)):
        scene = rtlang.Scene(look=look)
        scene.spheres(centers, radii, colors)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            image = scene.render(64, 48)
        again = scene.render(64, 48, samples=8)
        same = scene.render(64, 48)
        tap.ok(image.samples == 64 and again.samples == 8 and equal(image, same) and (image.alpha is not None) == is_clear
               and image.pixels.any(), f"look {look}: {image}")
    scene = rtlang.Scene(look="publication")
    scene.spheres(centers, radii, colors)
    image = scene.render(64, 48, target_error=0.02)
    tap.ok(image.alpha is None and (image.pixels[0, 0] == 1).all() and image.end == "target", "a look with a goal")
    scene.background((0.2, 0.3, 0.4))
    image = scene.render(64, 48)
    tap.ok(image.alpha is None and np.allclose(image.pixels[0, 0], (0.2, 0.3, 0.4)), "a look on another background")
    usage, wrong = rtlang.UsageError, rtlang.SceneError
    for name, call, kind, text in (
            ("a mistyped look", lambda: rtlang.Scene(look="publicaton"), usage,
             "error[E0709]: there is no look 'publicaton' (one of publication, soft, deep, or a rtlang.Look)"),
            ("a sky below 0", lambda: scene.sky(-1), wrong,
             "strength: error[E0460]: strength must be 0 or more, and finite, not -1"),
            ("a sky that is none", lambda: scene.sky(1, (1, np.nan, 0)), wrong,
             "color: error[E0460]: color must be 0 or more, and finite, not (1, nan, 0)"),
            ("lines too wide", lambda: scene.outline(17), wrong,
             "outline: error[E0460]: the width of outlines must be 0 to 16 pixels, not 17"),
            ("a cue of more than all", lambda: scene.depth_cue(1.5), wrong,
             "depth_cue: error[E0460]: the strength of a depth cue must be 0 to 1, not 1.5"),
            ("a cue that ends before it begins", lambda: scene.depth_cue(0.5, near=3, far=2), wrong,
             "depth_cue: error[E0460]: near and far must be 0 or more, and near less than far, not 3 and 2")):
        refused(name, call, kind, text)


# ---- what is refused

def refused(name, call, kind, text, index=None):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            call()
        tap.ok(False, name, "nothing was raised")
    except rtlang.Error as fault:
        tap.equal((type(fault), str(fault), fault.index), (kind, text, index), name)


def check_refused():
    centers, radii, colors = cloud(20)
    nan, usage, wrong = centers.copy(), rtlang.UsageError, rtlang.SceneError
    nan[17, 1] = np.nan
    huge = radii.copy()
    huge[3] = -0.5
    scene = lit()
    group = scene.spheres(centers, radii, colors)
    before = scene.render(48, 36)
    says = "error[E0709]: "
    for name, call, kind, text, index in (
            ("a NaN", lambda: scene.spheres(nan, 1), wrong,
             "spheres[17]: error[E0460]: number 1 of the center must be finite, not nan", 17),
            ("a negative radius", lambda: scene.spheres(centers, huge, name="atoms"), wrong,
             "atoms[3]: error[E0460]: the radius must be 0 or more, and finite, not -0.5", 3),
            ("two columns", lambda: scene.spheres(centers[:, :2], 1), usage,
             says + "centers must have the shape (n, 3) or (3,), not (20, 2)", None),
            ("text", lambda: scene.spheres(["a"], 1), usage,
             says + "centers must be numbers (float64, float32 or integers), not <U1", None),
            ("complex numbers", lambda: scene.spheres(centers * 1j, 1), usage,
             says + "centers must be numbers (float64, float32 or integers), not complex128", None),
            ("bytes of another machine", lambda: scene.spheres(centers.astype(">f8"), 1), usage,
             says + "centers must be numbers (float64, float32 or integers), not >f8", None),
            ("too few radii", lambda: scene.spheres(centers, radii[:5]), usage,
             says + "radii has 5 elements, and centers has 20", None),
            ("colors of one number", lambda: scene.spheres(centers, 1, radii), usage,
             says + "colors must have the shape (n, 3), (3,), (n, 4) or (4,), not (20,) (red, green, blue, and alpha "
             "or not; of values, rtlang.colormap makes colors)", None),
            ("a color at infinity", lambda: scene.spheres(centers, 1, np.full((20, 3), np.inf)), wrong,
             "spheres[0]: error[E0460]: number 0 of the color must be finite, not inf", 0),
            ("a mistyped finish", lambda: scene.spheres(centers, 1, finish="phogn 1"), wrong,
             "finish:2:1: error[E0250]: unknown property `phogn` in finish\n   2 | phogn 1\n     | ^~~~~\n"
             "     = help: did you mean `phong`?", None),
            ("a finish that is more", lambda: scene.spheres(centers, 1, finish="} interior { ior 1.5"), usage,
             "rtlang: error[E0709]: a finish is what stands in the braces of `finish { }`, and no more", None),
            ("pairs beyond the centers", lambda: scene.bonds(centers, [[0, 1], [2, 20]], 0.1), usage,
             "bonds[1]: error[E0709]: names centers (2, 20), and there are 20", 1),
            ("pairs that are no integers", lambda: scene.bonds(centers, [[0.0, 1.0]], 0.1), usage,
             says + "pairs must be integers of the shape (m, 2), not float64 of (1, 2)", None),
            ("a rod of no length", lambda: scene.rods(centers, centers, 0.1), wrong,
             "rods[0]: error[E0460]: the ends of a rod cannot be one point", 0),
            ("a light at infinity", lambda: scene.light((0, np.inf, 0)), wrong,
             "rtlang: error[E0460]: all numbers of a light must be finite", None),
            ("a light of two numbers", lambda: scene.light((0, 1)), usage,
             says + "position must have the shape (3,) or (), not (2,)", None),
            ("half a camera", lambda: scene.camera((0, 0, 1)), usage,
             says + "a camera needs location and look_at (camera(fit=True))", None),
            ("a size of 0", lambda: scene.render(0, 10), usage,
             says + "width and height are 1 to 65535 pixels, not 0 and 10", None),
            ("a crop beyond the picture", lambda: scene.render(16, 12, crop=(4, 4, 13, 2)), usage,
             says + "crop is (left, top, width, height) within 16 x 12 pixels, not (4, 4, 13, 2)", None),
            ("a crop of three numbers", lambda: scene.render(16, 12, crop=(4, 4, 2)), usage,
             says + "crop is (left, top, width, height) within 16 x 12 pixels, not (4, 4, 2)", None),
            ("an angle of 180", lambda: scene.camera((0, 0, 1), (0, 0, 0), angle=180), wrong,
             "camera: error[E0460]: the angle of a camera must be above 0 and less than 180, not 180", None),
            ("fewer samples than none", lambda: scene.render(16, 12, samples=-1), usage,
             says + "no sampling is like this: samples -1, target_error None, time_limit None, adaptive False, "
             "sampler None, filter None, seed 0, max_trace_level 0 (docs/sampling.md)", None),
            ("a size of a half", lambda: scene.render(1.5, 10), usage,
             says + "width and height are whole numbers of pixels, not 1.5 and 10", None),
            ("more spheres than the group has", lambda: group.update(np.zeros((21, 3))), usage,
             says + "spheres 0 to 21 are not all in a group of 20", None),
            ("a NaN in an update", lambda: group.update(nan[10:], first=10), wrong,
             "spheres[17]: error[E0460]: number 1 of the center must be finite, not nan", 17)):
        refused(name, call, kind, text, index)
    tap.ok(equal(scene.render(48, 36), before), "after all these the scene is as it was")
    limited = lit(objects=10)
    refused("more spheres than the limit", lambda: limited.spheres(centers, radii), rtlang.LimitError,
            "spheres[0]: error[E0490]: more than 10 shapes in the scene\n     = help: `--max-objects` allows more", 0)
    refused("less memory than needed", lambda: lit(memory=10**6).spheres(np.zeros((10**5, 3)), 1), rtlang.LimitError,
            "spheres[0]: error[E0607]: adding shapes takes more than 977 KiB of memory\n"
            "     = help: `--max-memory` allows more", 0)
    scene.close()
    scene.close()
    refused("a closed scene", lambda: scene.spheres(centers, 1), usage, says + "the scene is closed")
    refused("a closed scene's group", lambda: group.update(radii=1.0), usage, says + "the scene is closed")


def check_warned():
    scene = rtlang.Scene()
    scene.spheres(np.zeros((0, 3)), np.zeros(0), np.zeros((0, 3)))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        image = scene.text("#version 3.7; camera { location -5*z look_at 0 }") or scene.render(16, 12)
    tap.ok(not image.pixels.any() and [w.category for w in told] == [rtlang.SceneWarning] and
           "no objects" in str(told[0].message), "empty arrays: a black picture, and a warning", told)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scene.spheres([[0, 0, 0], [1, 0, 0]], [1, 0])
        scene.render(16, 12)
    tap.ok("a sphere of radius 0 is not drawn" in str(told[0].message) and "no lights" in str(told[1].message),
           "0 lights and a radius of 0 are warned of")
    tap.ok(os.path.samefile(told[0].filename, __file__), "warnings name the caller's line", told[0].filename)
    lost = lit()
    try:
        lost.text("sphere {", "mine")
    except rtlang.SceneError as fault:
        tap.equal((fault.place, fault.code), ("mine:1:9", "E0107"), "where a text is wrong")
    try:
        lost.render(16, 12)
        tap.ok(False, "after that the scene is lost")
    except rtlang.UsageError:
        tap.ok(True, "after that the scene is lost")


def check_memory():
    """What a scene is in a notebook; one that nobody holds any more is gone at once, without the collector."""
    gc.disable()
    scene = lit()
    group = scene.spheres([[0, 0, 0], [2, 0, -1]], 1)
    said = repr(scene)
    image = scene.render(16, 12, progress=lambda done: None)
    handle = weakref.ref(scene._session)  # pylint: disable=protected-access
    del scene, group
    tap.ok(said == "<rtlang.Scene of 1 part, from (-1, -1, -2) to (3, 1, 1)>", "what a scene says of itself", said)
    tap.ok(handle() is None and image.pixels.any(), "a scene that is dropped gives its memory back at once")
    gc.enable()


# ---- interrupts and threads

def slow():
    scene = lit()
    scene.spheres(*cloud(300), finish="reflection 0.5")
    return scene


def check_interrupts():
    scene = slow()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    image = scene.render(320, 240, time_limit=60)
    tap.ok(image.end == "interrupted" and image.pixels.any() and image.rmse > 0 and time.monotonic() - begun < 30,
           f"Ctrl-C keeps what is done: {image}")
    tap.ok(scene.render(32, 24).pixels.any(), "and the scene continues")

    def stop(_):
        raise RuntimeError("enough")
    try:
        scene.render(320, 240, samples=64, progress=stop)
        tap.ok(False, "what progress raises comes out")
    except RuntimeError as fault:
        tap.equal(str(fault), "enough", "what progress raises comes out")
    caught, done = [], threading.Event()

    def other():
        try:
            scene.spheres([[0, 0, 0]], 1)
        except rtlang.UsageError as fault:
            caught.append(str(fault))
        done.set()

    def start(_):
        if not done.is_set():
            threading.Thread(target=other).start()
            done.wait(20)
    scene.render(64, 48, samples=4, progress=start)
    tap.equal(caught, ["error[E0709]: rt_add_spheres: another thread is using this scene (one scene a thread)"],
              "a second thread is refused")
    images, before = [], slow()
    reference = before.render(64, 48)
    threads = [threading.Thread(target=lambda: images.append(drawn(*cloud(20)))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    tap.ok(len(images) == 4 and equal(before.render(64, 48), reference), "scenes of their own in four threads")


# ---- wheel and documents

def check_wheel(folder):
    made = subprocess.run([sys.executable, os.path.join(TOP, "python", "make_wheel.py"), "0.1.0", folder],
                          cwd=BUILD, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    wheels = [name for name in os.listdir(folder) if name.endswith(".whl")]
    if not tap.ok(made.returncode == 0 and len(wheels) == 1, "a wheel is made", made.stdout):
        return
    place = os.path.join(folder, "another place")
    with zipfile.ZipFile(os.path.join(folder, wheels[0])) as archive:
        archive.extractall(place)
    code = ("import rtlang; s = rtlang.Scene(); s.text('#include \"colors.inc\" sphere { 0, 1 pigment { SkyBlue } }');"
            "s.light((3, 4, 5)); s.camera(fit=True); i = s.render(16, 12); i.save('wheel.png'); i.save('wheel.exr');"
            "i.pixels.tofile('wheel.floats'); print(rtlang.__file__)")
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(("RTLANG", "PYTHON", "LD_"))}
    done = subprocess.run([sys.executable, "-B", "-W", "error", "-c", code], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False,
                          env={**environment, "PYTHONPATH": place, "HOME": folder})
    tap.ok(done.returncode == 0 and done.stdout.startswith(os.path.realpath(place)) and
           os.path.exists(os.path.join(folder, "wheel.png")), "unpacked elsewhere it draws, with its include files",
           done.stdout)
    if done.returncode == 0:
        channels, pixels = read_exr(os.path.join(folder, "wheel.exr"))[1], np.fromfile(os.path.join(folder, "wheel.floats"),
                                                                                        np.float32)
        tap.ok(all(np.array_equal(np.float32(channels[name]), pixels[i::3]) for i, name in enumerate("RGB")),
               "and saves EXR, in linear light")


def check_document(folder, document):
    """Blocks run one after the other in one namespace; each picture that they save stands in docs/images."""
    with open(os.path.join(TOP, document), encoding="utf-8") as file:
        text = file.read()
    space, here = {}, os.getcwd()
    os.chdir(folder)
    for match in re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        line = text.count("\n", 0, match.start()) + 2
        try:
            exec(compile("\n" * (line - 1) + match.group(1), document, "exec"), space)  # pylint: disable=W0122
            tap.ok(True, f"{document}: the block at line {line} runs")
        except ImportError as fault:
            tap.skip(f"{document}: the block at line {line}", str(fault))
        except BaseException as fault:  # pylint: disable=broad-except
            tap.ok(False, f"{document}: the block at line {line} runs", repr(fault))
    os.chdir(here)
    for name in re.findall(r"\]\(images/([\w.-]+)\)", text):
        made, kept = os.path.join(folder, name), os.path.join(TOP, "docs", "images", name)
        if os.environ.get("UPDATE_DOCS") and os.path.exists(made):
            os.makedirs(os.path.dirname(kept), exist_ok=True)
            shutil.copy(made, kept)
        is_made = os.path.exists(made) and os.path.exists(kept) and likeness(made, kept) > 0.99
        tap.ok(is_made or "matplotlib" not in sys.modules, f"{document}: {name} is made by its code")


def pixels_of(path):
    """The filtered bytes of a PNG file: equal ones are equal pictures, whatever zlib made of them."""
    with open(path, "rb") as file:
        chunks = list(png_chunks(file.read()))
    return np.frombuffer(zlib.decompress(b"".join(body for kind, body in chunks if kind == b"IDAT")), np.uint8)


def likeness(one, other):
    """The share of equal bytes: numpy's generators may change from version to version, pictures from build to build."""
    a, b = pixels_of(one), pixels_of(other)
    return float(np.mean(a == b)) if a.size == b.size else 0.0


def main():
    with tempfile.TemporaryDirectory() as made:
        folder = os.path.realpath(made)
        check_pictures(folder)
        check_strides()
        check_again()
        check_samples()
        check_looks(folder)
        check_refused()
        check_warned()
        check_memory()
        check_interrupts()
        check_wheel(folder)
        for document in ("README.md", os.path.join("docs", "python.md")):
            check_document(folder, document)
    tap.done()


if __name__ == "__main__":
    main()
