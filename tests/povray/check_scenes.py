#!/usr/bin/env python3
"""Whole scenes of `whole_scenes.py` given to rtlang and to POV-Ray: the pictures must agree in every pixel.

Usage: check_scenes.py [COUNT [SEED [NUMBER …]]]   Prints TAP. Without a seed (nor $SCENES_SEED) it is 1, and for more
scenes than `make check` draws a fresh one. With numbers only those scenes are drawn. The first scenes that are not equal ($SCENES_SHOWN, 3)
are made small by dropping what does not matter, and printed.

One pixel of a thousand, that is one of a picture, may differ where POV-Ray does not agree with itself, as
`rtcheck --elsewhere` tells. In two scenes of a hundred more may, if each is equal in a larger copy of the scene, in which
POV-Ray's absolute tolerances are less; and in one of a hundred up to a hundredth of the pixels, if POV-Ray changes each
when its camera is moved by 1e-8 or less, and rtlang none of them. Of all pixels of a run one of ten thousand may differ,
but no two of a picture. What one program takes and the other refuses is a failure, too. Skips where there is no POV-Ray.
SPDX-License-Identifier: MIT
"""
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402
import whole_scenes  # noqa: E402
from tap import Tap  # noqa: E402
from whole_scenes import Block  # noqa: E402

COUNT = 200
BATCH = 20
WIDTH, HEIGHT = 48, 36
MOST_TIES = WIDTH * HEIGHT // 1000
LARGER = (8, 64, 1024)  # times: POV-Ray's absolute tolerances are as much less
MOST_TOLERANCES = 0.02  # of the scenes: along the edges and seams of glass
SHIFTS = tuple(f"{sign}1e-{digits}" for digits in (13, 12, 11, 10, 9, 8) for sign in ("", "-"))  # of the camera
MOST_UNSETTLED, MOST_UNSETTLED_PIXELS = 0.01, WIDTH * HEIGHT // 100  # of the scenes: POV-Ray's roots of a sor
REFUSED_BY_BOTH = 0.1  # at most: such a scene says nothing
JUDGED_LATER = ("", "tie", "tolerance", "unsettled", "both refuse")  # by their number in a run
SHOWN = int(os.environ.get("SCENES_SHOWN", 3))  # scenes that are made small, of a run: each takes half a minute


def write(folder, scene):
    text, files = whole_scenes.text_of(scene)
    for name, part in {"scene.scn": text, **files}.items():
        with open(os.path.join(folder, name), "w", encoding="ascii") as out:
            out.write(part)


def first_fault(text):
    found = re.search(r"^.*error[^:]*:.*$|^Fatal error.*$", text, re.MULTILINE | re.IGNORECASE)
    words = found.group() if found else " ".join(text.split())[-60:]
    return re.sub(r"'?\S*/scene\.scn'?", "scene.scn", words)


def excused(folder, beyond):
    """Whether POV-Ray disagrees with itself in the pixels that differ."""
    if beyond > MOST_TIES:
        return False
    done = subprocess.run([os.environ["RTCHECK"], f"-W{WIDTH}", f"-H{HEIGHT}", "-j1", "--json", "--elsewhere=8",
                           f"--threshold={pictures.CODE_BAR}/65535", f"--povray={pictures.povray()}", f"-I{folder}",
                           "scene.scn"],
                          cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          text=True,
                          timeout=300, check=False)
    answer = json.loads(done.stdout) if done.stdout.startswith("{") else {}
    return answer.get("beyond", beyond) <= answer.get("not_elsewhere", 0)


def draw(program, folder):
    """What the program says where it does not make its picture, else None."""
    try:
        if program == "rtlang":
            pictures.render_rtlang("scene.scn", "rtlang.png", [], WIDTH, HEIGHT, ["--threads=1"], folder)
        else:
            pictures.render_povray("scene.scn", "povray.png", [], WIDTH, HEIGHT, folder)
    except pictures.RunFailed as failed:
        return f"{failed.status} {first_fault(failed.text)}"
    return None


def is_tolerance(seed, number):
    """Whether the pixels differ for POV-Ray's lengths of 1e-3 and less alone, which language.md lists: each is right in a
    copy of the scene that is larger, while rtlang's value there is what it was."""
    first = drawn_scene(seed, number, 1)
    left = differing(*first) if first else {0}
    for size in LARGER:
        larger = drawn_scene(seed, number, size) if left else None
        left &= differing(*larger) | differing(first[0], larger[0]) if larger else left
    return not left


def is_unsettled(seed, number):
    """Whether POV-Ray changes each pixel that differs when its camera is moved by next to nothing, and rtlang none."""
    first = drawn_scene(seed, number, 1)
    left = differing(*first) if first else {0}
    wanted = set(left)
    if len(left) > MOST_UNSETTLED_PIXELS:
        return False
    for shift in SHIFTS:
        moved = drawn_scene(seed, number, 1, shift) if left else None
        if moved and differing(first[0], moved[0]) & wanted:
            return False
        left -= differing(first[1], moved[1]) if moved else set()
    return not left


def drawn(folder, scene):
    """The values of both pictures, or None."""
    write(folder, scene)
    if draw("rtlang", folder) or draw("povray", folder):
        return None
    return [pictures.read_png(os.path.join(folder, f"{program}.png"))[2] for program in ("rtlang", "povray")]


def differing(one, other):
    return {i // 3 for i, (a, b) in enumerate(zip(one, other)) if abs(a - b) > pictures.CODE_BAR}


def drawn_scene(seed, number, size, shift=0):
    with tempfile.TemporaryDirectory() as folder:
        return drawn(folder, whole_scenes.scene_of(seed, number, size, shift))


def compare(scene):
    """(what kind of difference there is, words), the kind being "" where there is none."""
    with tempfile.TemporaryDirectory() as folder:
        write(folder, scene)
        ours, theirs = draw("rtlang", folder), draw("povray", folder)
        if ours and theirs:
            return ("rtlang fails", ours) if ours[0] not in "1" else ("both refuse", f"{ours} | {theirs}")
        if ours or theirs:
            kind = "rtlang refuses: " if ours else "POV-Ray refuses: "
            return kind + re.sub(r"\d+|,? \S+ found.*", "", ours or theirs), ours or theirs
        greatest, beyond, pixels = pictures.compare(os.path.join(folder, "rtlang.png"), os.path.join(folder,
                                                                                                     "povray.png"))
        words = pictures.verdict(greatest, beyond, pixels)[1]
        if beyond == 0 or excused(folder, beyond):
            return "", words
        return ("tie" if beyond <= MOST_TIES else "pictures differ"), words


def paths_of(block, depth, path=()):
    """Where the items stand that are so deep."""
    for i, item in enumerate(block.items):
        if depth == 0:
            yield path + (i,)
        elif isinstance(item, Block):
            yield from paths_of(item, depth - 1, path + (i,))


def without(block, dropped, path=()):
    """A copy of the block without the items at some paths; instead of one of them stand items, where there are any."""
    items = []
    for i, item in enumerate(block.items):
        here = path + (i,)
        if here in dropped:
            items += dropped[here]
        else:
            items.append(without(item, dropped, here) if isinstance(item, Block) else item)
    return Block(block.head, items, block.tail, block.file)


def lessened(scene, changes, kind, pool):
    """The scene with as many of the changes as leave the difference: first each by itself, then together."""
    done = [change for change, (now, _) in
            zip(changes, pool.map(lambda change: compare(without(scene, dict([change]))), changes)) if now == kind]
    kept = {}
    while done:  # all of them, or a half, a quarter, … of what remains
        size = len(done)
        while size > 1 and compare(without(scene, {**kept, **dict(done[:size])}))[0] != kind:
            size = (size + 1) // 2
        if size > 1 or not kept or compare(without(scene, {**kept, **dict(done[:1])}))[0] == kind:
            kept.update(done[:size])
        done = done[size:]
    return without(scene, kept) if kept else scene


def is_shell(item):
    """Whether what is in it may stand without it."""
    return isinstance(item, Block) and (item.head.startswith(("#if", "#for", "#switch", "#include")) or bool(item.file))


def is_needed(item):
    """Without a camera or its place the eye is in the origin, where rounding decides on much."""
    return (item.head if isinstance(item, Block) else item).startswith(("camera", "location", "look_at",
                                                                        "global_settings", "adc_bailout", "#version"))


def item_at(scene, path):
    for i in path:
        scene = scene.items[i]
    return scene


def smallest(scene, kind, pool):
    """The scene with all dropped that the difference does not need, from large things to small ones."""
    size = None
    while size != (size := len(told(scene))):
        depth = 0
        while paths := list(paths_of(scene, depth)):
            scene = lessened(scene, [(path, []) for path in paths if not is_needed(item_at(scene, path))], kind, pool)
            shells = [path for path in paths_of(scene, depth) if is_shell(item_at(scene, path))]
            scene = lessened(scene, [(path, item_at(scene, path).items) for path in shells], kind, pool)
            depth += 1
    return scene


def told(scene):
    """The text of a scene and of its included files."""
    text, files = whole_scenes.text_of(scene)
    return text + "".join(f"// ---- {name}\n{part}" for name, part in files.items())


def main():
    tap = Tap()
    if not pictures.povray():
        tap.skip("whole scenes", "povray is not installed")
        return tap.done()
    count = int(sys.argv[1]) if len(sys.argv) > 1 else COUNT
    own_seed = str(time.time_ns() % 1000000007) if count > COUNT else "1"
    seed = sys.argv[2] if len(sys.argv) > 2 else os.environ.get("SCENES_SEED", own_seed)
    numbers = [int(number) for number in sys.argv[3:]] if len(sys.argv) > 3 else list(range(count))
    print(f"# seed {seed}", flush=True)
    with (concurrent.futures.ThreadPoolExecutor(pictures.POVRAY_AT_ONCE) as pool,
          concurrent.futures.ThreadPoolExecutor(pictures.POVRAY_AT_ONCE) as trials):
        def judged(number):
            kind, words = compare(whole_scenes.scene_of(seed, number))
            if kind == "pictures differ":
                kind = "tolerance" if is_tolerance(seed, number) else "unsettled" if is_unsettled(seed, number) else kind
            return (number, kind, words)

        refused, ties, tolerances, unsettled, batch, shown = [], [], [], [], [], []
        for number, kind, words in pool.map(judged, numbers):
            batch.append((number, kind, words))
            tolerances += [f"{number}: {words}"] if kind == "tolerance" else []
            unsettled += [f"{number}: {words}"] if kind == "unsettled" else []
            refused += [(number, words)] if kind == "both refuse" else []
            ties += [f"{number}: {words}"] if kind == "tie" else []
            if len(batch) == BATCH or number == numbers[-1]:
                report(tap, seed, batch, trials, shown)
                batch = []
    tap.ok(len(refused) <= REFUSED_BY_BOTH * max(len(numbers), BATCH), f"{len(refused)} scenes are refused by both",
           "\n".join(f"{number}: {words}" for number, words in refused))
    tap.ok(len(tolerances) <= max(MOST_TOLERANCES * len(numbers), 2),
           f"{len(tolerances)} scenes are equal when they are larger only", "\n".join(tolerances))
    tap.ok(len(unsettled) <= max(MOST_UNSETTLED * len(numbers), 2),
           f"{len(unsettled)} scenes are not settled in POV-Ray", "\n".join(unsettled))
    most = max(pictures.TIE_SHARE * WIDTH * HEIGHT * len(numbers), MOST_TIES)
    tap.ok(len(ties) <= most, f"{len(ties)} pixels differ in all that POV-Ray draws as before", "\n".join(ties))
    return tap.done()


def report(tap, seed, batch, pool, shown):
    faults = [(number, kind, words) for number, kind, words in batch if kind not in JUDGED_LATER]
    name = f"scenes {batch[0][0]} to {batch[-1][0]}"
    tap.ok(not faults, name)
    for number, kind, words in faults:
        print(f"# check_scenes.py 1 {seed} {number}: {kind.split(':')[0]}: {words}", flush=True)
        if len(shown) < SHOWN:
            shown.append(number)
            small = told(smallest(whole_scenes.scene_of(seed, number), kind, pool))
            print("".join(f"#     {line}\n" for line in small.splitlines()), end="", flush=True)


if __name__ == "__main__":
    sys.exit(main())
