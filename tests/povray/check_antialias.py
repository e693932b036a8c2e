#!/usr/bin/env python3
"""--antialias against POV-Ray's +A -J: the same pixels get more rays, through the same places, and the same means.

A few scenes of this folder, small, with both methods and several depths, thresholds and gammas. docs/language.md tells what
was measured between the marks `antialias:begin` and `antialias:end`; `check_antialias.py --update` writes it there. Also that
the number of threads changes nothing. Prints TAP.
SPDX-License-Identifier: MIT
"""
import os
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import documents  # noqa: E402
import images  # noqa: E402
import pictures  # noqa: E402

TOP = os.environ.get("top_srcdir", ".")
DOCUMENT = os.path.join(TOP, "docs", "language.md")
MARK = "antialias"
WIDTH, HEIGHT = 100, 75  # neither is a multiple of the blocks
SCENES = ("light_spot", "pattern_hexagon", "interior_glass", "mapped/image_interpolate_2", "mapped/image_grey", "gamma_assumed_22", "gamma_assumed_srgb", "gamma_version36_no_gamma")
# method, depth, threshold, gamma
WAYS = ((1, 3, 0.3, 2.5), (1, 2, 0.05, 1.0), (1, 1, 0.0, 2.5), (2, 3, 0.3, 2.5), (2, 5, 0.1, 1.8), (2, 1, 0.3, 2.5))
TIES = 2e-3  # pixels that differ by the threshold to the last bits of single precision, and silhouettes


def compare(scene, way, folder, folders):
    ours, theirs = os.path.join(folder, "ours.png"), os.path.join(folder, "theirs.png")
    method, depth, threshold, gamma = way
    pictures.render_rtlang(scene, ours, folders, WIDTH, HEIGHT,
                           [f"--antialias={method}", f"--antialias-depth={depth}", f"--antialias-threshold={threshold}",
                            f"--antialias-gamma={gamma}"])
    pictures.run("povray", [pictures.povray(), f"+I{scene}", f"+O{theirs}", f"+W{WIDTH}", f"+H{HEIGHT}", "+FN16",
                            "File_Gamma=1.0", f"+A{threshold}", f"+AM{method}", f"+R{depth}", f"+AG{gamma}", "-J", "-D",
                            "-P", "+Q9", *[f"+L{name}" for name in folders]])
    return pictures.compare(ours, theirs)


def same_for_threads(scene, folder, folders):
    found = []
    for threads in (1, 5):
        path = os.path.join(folder, "threads.png")
        pictures.render_rtlang(scene, path, folders, WIDTH, HEIGHT, ["--antialias=1", "-t", str(threads)])
        with open(path, "rb") as file:
            found.append(file.read())
    return found[0] == found[1]


def sentence(greatest, beyond, pixels):
    return (f"In {len(SCENES)} scenes with {len(WAYS)} choices each, {beyond} of {pixels} pixels differ from POV-Ray's by more\n"
            f"than 2/65535, the others by at most {greatest}/65535.")


def judge_document(words):
    if "--update" in sys.argv:
        documents.write(DOCUMENT, MARK, words + "\n")
    return documents.read(DOCUMENT, MARK).strip() == words, f"docs/language.md tells what was measured: {words!r}"


def main():
    if not pictures.povray():
        print("1..0 # SKIP povray is not installed")
        return 0
    results, total, all_beyond, greatest_within = [], 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        images.make(folder, os.environ["RTLANG"])
        folders = [folder, *pictures.include_folders()]
        for name in SCENES:
            scene = os.path.join(TOP, "tests", "povray", name + ".scn")
            for way in WAYS:
                greatest, beyond, pixels = compare(scene, way, folder, folders)
                total, all_beyond = total + pixels, all_beyond + beyond
                greatest_within = max(greatest_within, min(greatest, pictures.CODE_BAR))
                words = f"max {greatest}/65535, {beyond} of {pixels} pixels beyond {pictures.CODE_BAR}/65535"
                results.append((beyond <= TIES * pixels, f"{name} with method {way[0]}, depth {way[1]}, threshold {way[2]}, "
                                                         f"gamma {way[3]}: {words}"))
        results.append((same_for_threads(scene, folder, folders), "the same bytes for one thread and five"))
    results.append(judge_document(sentence(greatest_within, all_beyond, total)))
    print(f"1..{len(results)}")
    for number, (passed, words) in enumerate(results, 1):
        print(f"{'ok' if passed else 'not ok'} {number} - {words}")
    return 0 if all(passed for passed, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main())
