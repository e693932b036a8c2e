#!/usr/bin/env python3
"""Generated scenes that together hold pairs of everything the language has, given to rtlang and to POV-Ray.

Usage: check_pairs.py [COUNT [SEED]]   Prints TAP, a line for each scene. `generate_scenes.py COUNT SEED NUMBER` prints one again.

The pictures are small, and each silhouette tie is a large part of one: the bar for ties holds for the pixels of all pictures
together, and no picture may have more than a thousandth. With $KEEP set, scenes that miss it are written into that folder.
Skips where there is no POV-Ray. SPDX-License-Identifier: MIT
"""
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import documents  # noqa: E402
import generate_scenes  # noqa: E402
import pictures  # noqa: E402

COUNT, SEED = 60, 1
WIDTH, HEIGHT = 80, 60
SHARE_OF_ONE = 1e-3
# Lights of many points: see "No absolute tolerances" in docs/language.md.
FORGIVEN_CODES, FORGIVEN_SHARE = 0.004 * 65535, 0.02
# Words of the schema that no generated scene has, and why.
LEFT_OUT = {
    "max_intersections mm_per_unit quick_color quick_colour media_interaction media_attenuation area_illumination": "they change no picture",
    "blob threshold component hierarchy": "POV-Ray's roots of blobs have too few digits behind glass; tests/povray/*.scn"
    " have them",
    "sor": "POV-Ray's roots of it have too few digits where rays are nearly at right angles to its axis; tests/povray/*.scn"
    " have them",
    "charset": "of strings; tests/lang/strings.test asks POV-Ray",
    "pattern": "a value; tests/lang/functions.test asks POV-Ray",
    "colour_map fade_colour": "other spellings",
    "jitter aperture blur_samples confidence focal_point variance": "random in both",
    "image_pattern bump_map material_map density_file use_alpha use_index image_map exr hdr jpeg map_type once interpolate pgm png ppm premultiplied tga tiff use_color use_colour": "need a file;"
    " tests/povray/image_*.scn have them",
    "bumps spotted dents ripples waves wrinkles noise_generator number_of_waves turb_depth": "tests/povray/*.scn have"
    " them",
    "crand": "random in both; check_jitter.py asks POV-Ray",
    "hf_gray_16 irid_wavelength irid thickness": "tests/povray/finish_irid*.scn have them",
    "omnimax cylinder": "tests/povray/camera_*.scn have them",
    "function pigment_pattern spiral2 warp repeat flip black_hole strength orientation dist_exp major_radius toroidal":
    "tests/povray/pattern_*.scn and warp_*.scn have them",
    "height_field smooth water_level bicubic_patch": "tests/povray/shape_height_field*.scn and shape_bicubic*.scn have"
    " them",
    "uv_mapping": "tests/povray/uv_*.scn have it",
    "tiles": "tests/povray/texture_tiles*.scn have them",
    "isosurface contained_by accuracy max_gradient max_trace all_intersections evaluate": "tests/povray/shape_isosurface*.scn"
    " have them",
    "rainbow arc_angle falloff_angle width": "tests/povray/rainbow*.scn have them",
    "slope aoi altitude": "tests/povray/pattern_slope.scn, pattern_aoi.scn and pattern_facing*.scn have them",
    "parametric precompute": "tests/povray/shape_parametric*.scn have them",
    "polynomial xyz": "tests/povray/shape_polynomial.scn has them",
    "ovus": "tests/povray/shape_ovus*.scn have it",
    "julia_fractal quaternion sqr cube max_iteration precision slice": "tests/povray/shape_julia_fractal*.scn have them",
    "magnet exterior": "tests/povray/pattern_fractal_*.scn have them",
    "interior_texture": "tests/povray/texture_interior*.scn have it",
    "light_group global_lights double_illuminate": "tests/povray/light_group.scn and light_double_illuminate.scn have them",
    "perspective split_union": "on unless something else is said; tests/povray/*.scn have them",
    "camera light_source sphere global_settings declare": "in every scene",
}


def write(path, text):
    with open(path, "w", encoding="ascii") as out:
        out.write(text)


def run(scene):
    """What rtcheck says of a scene, with any number of ties allowed."""
    done = subprocess.run([os.environ["RTCHECK"], f"-W{WIDTH}", f"-H{HEIGHT}", "-j1", "--json", "--ties=1",
                           f"--threshold={pictures.CODE_BAR}/65535", f"--povray={pictures.povray()}", scene],
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          timeout=300, check=False)
    return json.loads(done.stdout) if done.stdout.startswith("{") else {"fault": done.stderr}


def judge(choices, answer):
    """(passed, pixels that count as ties, words)."""
    if "fault" in answer:
        return False, 0, answer["fault"].strip().replace("\n", " | ")
    beyond, pixels = answer["beyond"], answer["pixels"]
    words = f"max {answer['max']:.0f}/65535, {beyond} of {pixels} pixels beyond {pictures.CODE_BAR}/65535"
    if choices["light"] in generate_scenes.FORGIVING:
        return beyond <= FORGIVEN_SHARE * pixels, 0, words + " (an area light)"
    return beyond <= SHARE_OF_ONE * pixels, beyond, words


def words_without_scenes(texts):
    """Words of the reference of the language that none of the scenes holds."""
    tables = documents.read(os.path.join(os.environ.get("top_srcdir", "."), "docs/language.md"), "schema")
    words = set(re.findall(r"^### ([a-z_]+)$", tables, re.MULTILINE))
    words.update(re.findall(r"^\| `(\w+)` \|", tables, re.MULTILINE))
    held = set(re.findall(r"\w+", " ".join(texts)))
    return sorted(words - held - set(" ".join(LEFT_OUT).split()))


def main():
    if not pictures.povray():
        print("1..0 # SKIP povray is not installed")
        return 0
    count, seed = (int(argument) for argument in (sys.argv[1:] + [COUNT, SEED][len(sys.argv) - 1:])[:2])
    scenes, missing = generate_scenes.plan(count, seed)
    texts = [generate_scenes.scene_text(*scene, seed, number) for number, scene in enumerate(scenes)]
    failed, ties, pixels = 0, 0, 0
    print(f"1..{count + 2}\n# seed {seed}: {len(missing)} pairs are in no scene", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, f"{number}.scn") for number in range(count)]
        for path, text in zip(paths, texts):
            write(path, text)
        with concurrent.futures.ThreadPoolExecutor(2 * (os.cpu_count() or 1)) as pool:
            for number, answer in enumerate(pool.map(run, paths)):
                passed, tied, words = judge(scenes[number][0], answer)
                failed += not passed
                ties += tied
                pixels += answer.get("pixels", 0)
                print(f"{'ok' if passed else 'not ok'} {number + 1} - {words.replace('#', chr(92) + '#')}", flush=True)
                if not passed:
                    print(f"# generate_scenes.py {count} {seed} {number}")
                if "KEEP" in os.environ and (tied or not passed):
                    write(os.path.join(os.environ["KEEP"], f"pair_{seed}_{number}.scn"), texts[number])
    pooled = ties <= pictures.TIE_SHARE * pixels
    print(f"{'ok' if pooled else 'not ok'} {count + 1} - {ties} of {pixels} pixels of all scenes are beyond the bar")
    lacking = words_without_scenes(texts) if count >= COUNT else []
    print(f"{'not ok' if lacking else 'ok'} {count + 2} - every word of the language occurs {' '.join(lacking)}")
    return 1 if failed or not pooled or lacking else 0


if __name__ == "__main__":
    sys.exit(main())
