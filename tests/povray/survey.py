#!/usr/bin/env python3
"""How much of POV-Ray's own example scenes rtlang accepts, and what stands in the way of the others.

Each scene is read by `rtlang --check` in a copy of its folder, in which it may write, with POV-Ray's include files. Printed are a line a
scene, the blockers by how many scenes they are the first or any of, and a plan: what to add next to unlock most scenes.
With --render what is accepted is rendered by both programs (rtcheck) and the differences are summed up; with --times it
is drawn by both in turns, one scene at a time, and their processor seconds are compared.
Exit status: 0, or 77 when the scenes are not installed. SPDX-License-Identifier: MIT
"""
import argparse
import collections
import concurrent.futures
import glob
import gzip
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import chance  # noqa: E402
import documents  # noqa: E402
import pictures  # noqa: E402
import survey_times  # noqa: E402

EXAMPLES = "/usr/share/doc/povray/examples"  # of Debian's package povray-examples
SKIPPED = 77
NAMED = {4: "a limit", 3: "a file", 2: "usage"}
# Faults that follow from another one: what was refused before them is not there.
FOLLOWERS = {"E0201", "E0253", "E0254", "E0256"}
# Words of the language that come together. A scene needs a group when rtlang refuses one of its words there, or when
# the scene's own text holds one: after a fault the rest of a declaration is not looked at.
GROUPS = {
    "solids": "box cylinder cone torus disc triangle",
    "csg": "difference intersection merge clipped_by bounded_by inverse cutaway_textures",
    "colour patterns": "agate average bozo brick checker color_map colour_map crackle gradient granite leopard "
                       "marble onion pigment_map quilted radial spherical cylindrical planar boxed spiral1 spiral2 "
                       "spotted wood hexagon wrinkles square triangular tiling pavement cells turbulence warp "
                       "texture_map pigment_pattern mandel julia magnet tiles texture_list facets dents waves "
                       "ripples bumps slope aoi density_file",
    "normals": "normal normal_map slope_map bump_map bump_size no_bump_scale",
    "pictures": "image_map material_map image_pattern uv_mapping",
    "sky and fog": "sky_sphere fog rainbow",
    "lights": "spotlight area_light fade_distance fade_power looks_like projected_through light_group jitter "
              "media_interaction media_attenuation area_illumination",
    "interior": "interior refraction caustics dispersion fade_color fade_colour material interior_texture fresnel ior",
    "object flags": "no_shadow no_image no_reflection double_illuminate hollow",
    "media": "media density scattering absorption density_map",
    "photons": "photons",
    "radiosity": "radiosity",
    "subsurface": "subsurface translucency",
    "mesh": "mesh mesh2 smooth_triangle",
    "text": "text",
    "height_field": "height_field",
    "isosurface": "isosurface parametric",
    "blob": "blob",
    "patches and sweeps": "bicubic_patch lathe prism sor sphere_sweep ovus polygon",
    "polynomials": "quadric cubic quartic poly polynomial",
    "fractals": "julia_fractal",
    "superellipsoid": "superellipsoid",
    "cameras": "fisheye omnimax panoramic ultra_wide_angle mesh_camera focal_point aperture blur_samples",
    "functions and splines": "function spline",
    "tracing": "trace inside min_extent max_extent",
    "old finish words": "crand irid",
    "written files": "#fopen #write #read #fclose",
}
GROUP_OF = {word: group for group, words in GROUPS.items() for word in words.split()}
TOKEN = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\])*\"|#\s*\w+|\w+", re.DOTALL)
LACKING = {"E0210", "E0250", "E0251", "E0252", "E0269"}
MARK = "survey"
# The greatest difference of a pixel, in steps of 1/65535, up to which scenes are counted together.
STEPS = [2, 16, 256, 4096, 65535]
MEETS, BUT_FOR, LARGER, MISSES = "meets", "meets where POV-Ray agrees with itself", "misses, and meets where it is larger", "misses"
SIZE = 160, 120  # of the pictures of --render
ELSEWHERE = 24  # how often POV-Ray draws a scene that differs all but the same, to tell where it does not agree with itself


def size(text):
    """(width, height) of a text like 640x480."""
    width, height = map(int, text.split("x"))
    return width, height


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("scenes", nargs="*", help="scene files, instead of all of the package")
    parser.add_argument("--json", metavar="FILE", help="write all results to FILE")
    parser.add_argument("--docs", metavar="FILE", help="write the table of blockers between its marks in FILE")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="scenes at a time (default: all processors)")
    parser.add_argument("--timeout", type=float, default=30.0, help="seconds a scene and program may take (default 30)")
    parser.add_argument("--render", action="store_true", help="render what is accepted with both programs and compare")
    parser.add_argument("--times", action="store_true", help="compare the processor seconds of both for what is accepted")
    parser.add_argument("--size", type=size, default=(640, 480), metavar="WxH", help="of --times (default 640x480)")
    parser.add_argument("--turns", type=int, default=3, metavar="N", help="of --times (default 3)")
    return parser.parse_args()


def installed():
    """The package's scenes."""
    found = glob.glob(os.path.join(EXAMPLES, "**", "*.pov"), recursive=True)
    return sorted(found + glob.glob(os.path.join(EXAMPLES, "**", "*.pov.gz"), recursive=True))


def unpacked(folder, copies):
    """A copy of the folder with everything in it unpacked; made once."""
    if folder not in copies:
        copy = os.path.join(copies["top"], str(len(copies)))
        shutil.copytree(folder, copy)
        for path in glob.glob(os.path.join(copy, "**", "*.gz"), recursive=True):
            with gzip.open(path) as packed, open(path[:-3], "wb") as plain:
                shutil.copyfileobj(packed, plain)
        copies[folder] = copy
    return copies[folder]


def construct(fault):
    """What a fault is about, in a word or two: `cylinder`, `light_source: media_interaction`."""
    words = re.findall(r"`([^`]*)`", fault["message"])
    within = re.search(r" in ([a-z_]+) by rtlang", fault["message"])
    word = words[0] if words else fault["message"]
    return f"{within.group(1)}: {word}" if within else word


def call(command, scene, seconds):
    """(status, output, messages) of a program run in the scene's folder; None at the time limit, and all is ended."""
    with subprocess.Popen([*command, os.path.basename(scene)], cwd=os.path.dirname(scene), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True) as process:
        try:
            output, messages = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return None
    return process.returncode, output.decode("utf-8", "replace"), messages.decode("utf-8", "replace")


def need(blocker):
    """The group that a fault belongs to, or its own words."""
    code, words = blocker.split(" ", 1)
    word = words.split(": ")[-1]
    return GROUP_OF.get(word.split()[0], "directives that tear items apart" if code == "E0109" else blocker)


def supported():
    """The words of blocks that the reference of the language lists: their tables are printed by rtlang's own schema."""
    reference = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "language.md")
    tables = documents.read(reference, "schema")
    rows = re.findall(r"^\| (`[^|]*) \|", tables, re.MULTILINE)
    return set(re.findall(r"^### (\w+)", tables, re.MULTILINE)).union(*(re.findall(r"`(\w+)`", row) for row in rows))


def needs_of_text(path, seen, known):
    """The groups of which a word that is not known stands in a file, or in the files beside it that it includes."""
    seen.add(path)
    with open(path, encoding="latin-1") as file:
        tokens = [token for token in TOKEN.findall(file.read()) if not token.startswith(("//", "/*"))]
    needs = set()
    for token, following in zip(tokens, tokens[1:] + [""]):
        word = "".join(token.split())
        included = os.path.join(os.path.dirname(path), following.strip('"'))
        if word == "#include" and included not in seen and os.path.isfile(included):
            needs |= needs_of_text(included, seen, known)
        elif word in GROUP_OF and word not in known:
            needs.add(GROUP_OF[word])
    return needs


def first_frame(path):
    """The number of the first frame of the animation that the .ini of a scene's name is for; None: it is for none."""
    settings = path.removesuffix(".pov") + ".ini"
    if not os.path.isfile(settings):
        return None
    with open(settings, encoding="latin-1") as file:
        text = file.read()
    first = re.search(r"^\s*Initial_Frame\s*=\s*(\d+)", text, re.MULTILINE | re.IGNORECASE)
    is_animation = re.search(r"^\s*Final_Frame\s*=", text, re.MULTILINE | re.IGNORECASE)
    return (first.group(1) if first else "1") if is_animation else None


def of_animation(path):
    """What makes a scene the first frame of its animation."""
    frame = first_frame(path)
    return [] if frame is None else [f"-Dframe_number={frame}"]


def frame_scene(path):
    """The scene as that frame, for programs that are not told of it: a text that names its number."""
    frame = first_frame(path)
    with open(path, encoding="latin-1", newline="") as file:
        text = file.read()
    if frame is None or not re.search(r"\bframe_number\b", text):
        return path
    copy = os.path.join(os.path.dirname(path), "frame_of_" + os.path.basename(path))
    with open(copy, "w", encoding="latin-1", newline="") as file:
        file.write(re.sub(r"\bframe_number\b", frame, text))
    return copy


def read(scene, options, folders, known):
    """One scene's record: name, outcome, blockers in the order in which they were met."""
    name, path = scene
    command = [os.environ["RTLANG"], "--check", "-q", "--diagnostics=json", "--allow-write=.", *of_animation(path),
               *(f"-I{place}" for place in folders)]
    record = {"scene": name, "path": path, "outcome": "accepted", "blockers": [], "needs": [], "where": None}
    done = call(command, path, options.timeout)
    status, _, messages = done or (0, "", "")
    if not done:
        record["outcome"] = "time limit"
    elif status < 0:
        record["outcome"] = f"killed by signal {-status}"
    elif status > 0:
        record["outcome"] = NAMED.get(status, "refused")
    for line in messages.splitlines():
        fault = json.loads(line) if line.startswith("{") else {}
        if fault.get("severity") == "error":
            blocker = f"{fault['code']} {construct(fault)}"
            if record["where"] is None:
                record["where"] = f"{fault['file']}:{fault['line']}"
                record["message"] = fault["message"]
            if blocker not in record["blockers"] and (fault["code"] not in FOLLOWERS or not record["blockers"]):
                record["blockers"].append(blocker)
    if record["outcome"] != "accepted":
        record["needs"] = sorted(needs_of_text(path, set(), known) | {need(blocker) for blocker in record["blockers"]})
    return record


def still_text(path):
    """A text without the words that make programs draw numbers by chance, each its own; None when there are none."""
    with open(path, encoding="latin-1", newline="") as file:
        text = file.read()
    plain = chance.without(text)
    return plain if plain != text else None


def still_folder(path, folders, top):
    """A copy of a scene's folder in which no text has such words, nor any include file: those that have stand in it."""
    folder = tempfile.mkdtemp(dir=top)
    for place in (*folders, os.path.dirname(path)):
        for source in glob.glob(os.path.join(place, "*")):
            plain = still_text(source) if source.endswith((".inc", ".pov")) else None
            copy = os.path.join(folder, os.path.basename(source))
            if plain is not None:
                with open(copy, "w", encoding="latin-1", newline="") as file:
                    file.write(plain)
            elif os.path.isfile(source) and place == os.path.dirname(path):
                shutil.copyfile(source, copy)
    return os.path.join(folder, os.path.basename(path))


def judge_chance(record, still, folders):
    """What chance.py says of the scene as it is; `still` is the same without chance."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            if chance.has_lens(record["drawn"]):
                lens = chance.lens_error(record["drawn"], folder, folders, SIZE)
                return {"like": abs(lens) <= chance.LENS_BAR, "lens": lens}
            apart = chance.pixels_apart(still, folder, folders, SIZE)
            return chance.judge(chance.draw_rtlang(record["drawn"], folder, folders, SIZE, apart=apart),
                                chance.draw_povray(record["drawn"], folder, folders, SIZE, apart=apart))
        except pictures.RunFailed as failure:
            return {"like": False, "failed": str(failure)}


def compare(path, options, folders):
    """What rtcheck says of a scene."""
    command = [os.environ["RTCHECK"], "--json", "-j1", "--allow-write=.", f"-W{SIZE[0]}", f"-H{SIZE[1]}",
               f"--elsewhere={ELSEWHERE}", *(f"-I{place}" for place in folders)]
    done = call(command, path, options.timeout * (ELSEWHERE + 2))
    if not done:
        return {"failed": "time limit"}
    _, output, messages = done
    return json.loads(output) if output.startswith("{") else {"failed": messages[-300:]}


def render(record, options, folders):
    """Adds what rtcheck says of an accepted scene; of one with chance, of the scene without it, and what means say. An
    include file is read for chance where pictures differ: most scenes use little of one."""
    path = record["drawn"] = frame_scene(record["path"])
    record["without_chance"] = still_text(path) is not None
    if not record["without_chance"]:
        record["picture"] = compare(path, options, folders)
        if record["picture"].get("agrees", True):
            return record
    with tempfile.TemporaryDirectory() as top:
        still = still_folder(path, folders, top)
        picture = compare(still, options, folders)
        if record["without_chance"] or picture.get("beyond") != record["picture"].get("beyond"):
            record["without_chance"], record["picture"] = True, picture
            record["chance"] = judge_chance(record, still, folders)
    return record


def plan(records):
    """[(what, scenes it unlocks, scenes that it still stands in)]: the greedy order of giving scenes what they need.

    A scene weighs 1 / n^2 where it needs n more: what is taken unlocks scenes, or else brings many close to it."""
    waiting = [set(record["needs"]) for record in records if record["needs"]]
    order = []
    while waiting:
        alone, weight = collections.Counter(), collections.Counter()
        for needs in waiting:
            for each in needs:
                alone[each] += len(needs) == 1
                weight[each] += 1.0 / len(needs) ** 2
        best = max(weight, key=lambda each: (weight[each], each))
        order.append((best, alone[best], sum(best in needs for needs in waiting)))
        waiting = [needs - {best} for needs in waiting if needs != {best}]
    return order


def print_tables(records):
    outcomes = collections.Counter(record["outcome"] for record in records)
    first = collections.Counter(record["blockers"][0] for record in records if record["blockers"])
    every = collections.Counter(blocker for record in records for blocker in record["blockers"])
    print(f"\n{len(records)} scenes: " + ", ".join(f"{count} {outcome}" for outcome, count in outcomes.most_common()))
    print("\nblockers: scenes in which it is the first, is any, is the only one")
    only = collections.Counter(record["blockers"][0] for record in records if len(record["blockers"]) == 1)
    for blocker, count in sorted(every.items(), key=lambda entry: (-entry[1], entry[0])):
        print(f"{first[blocker]:6} {count:6} {only[blocker]:6}  {blocker}")
    accepted = outcomes["accepted"]
    print("\nplan: scenes accepted once it is there, unlocked by it, still in need of it")
    for what, unlocked, stood in plan(records):
        accepted += unlocked
        print(f"{accepted:6} {unlocked:6} {stood:6}  {what}")


def blockers_by_need(records):
    """[(group, scenes in which it is first, is any, is the only one)] of what rtlang lacks."""
    first, every, only = collections.Counter(), collections.Counter(), collections.Counter()
    for record in records:
        lacks = [blocker for blocker in record["blockers"] if blocker.split()[0] in LACKING]
        groups = list(dict.fromkeys(need(blocker).removeprefix(blocker.split()[0] + " ") for blocker in lacks))
        first.update(groups[:1])
        every.update(groups)
        only.update(groups if len(groups) == 1 and len(lacks) == len(record["blockers"]) else [])
    return [(group, first[group], count, only[group]) for group, count in sorted(every.items(), key=lambda e: (-e[1], e[0]))]


def write_table(records, path):
    accepted = sum(record["outcome"] == "accepted" for record in records)
    lines = [f"{accepted} of {len(records)} scenes are accepted. What stands in the way of the others, when it does so in more than one:", "",
             "| | first fault | any fault | the only one |", "|---|---|---|---|"]
    lines += [f"| {group} | {first} | {any_} | {only} |" for group, first, any_, only in blockers_by_need(records) if any_ > 1]
    documents.write(path, MARK, "\n".join(lines) + "\n")


def verdict(record):
    """Whether a scene that was compared meets the bar."""
    picture, by_chance = record["picture"], record.get("chance", {})
    if not picture["agrees"]:
        return LARGER if picture.get("larger", picture["pixels"]) <= pictures.TIE_SHARE * picture["pixels"] else MISSES
    if not by_chance.get("like", True):
        return MISSES
    return BUT_FOR if picture["not_elsewhere"] > 0 else MEETS


def print_pictures(records):
    drawn = [record for record in records if "picture" in record]
    failed = [record for record in drawn if "max" not in record["picture"]]
    print(f"\n{len(drawn)} scenes rendered by both, {len(failed)} of them failed")
    below = 0
    for step in STEPS:
        count = sum(below <= record["picture"]["max"] <= step for record in drawn if record not in failed)
        print(f"{count:6}  greatest difference {below} to {step} of 65535")
        below = step + 1
    judged = [record for record in drawn if record not in failed]
    verdicts = collections.Counter(verdict(record) for record in judged)
    print(f"{verdicts[MEETS]:6}  {MEETS}: within 2 of 65535 in all but 0.01 % of their pixels")
    print(f"{verdicts[BUT_FOR]:6}  {BUT_FOR}: but for at most 0.1 % that change with a billionth of a pixel or with the scene's size")
    print(f"{verdicts[LARGER]:6}  {LARGER}: POV-Ray's own lengths, but for 0.01 % of the pixels, are what is seen")
    print(f"{verdicts[MISSES]:6}  {MISSES}")
    drawn_by_chance = [record["chance"] for record in judged if "chance" in record]
    lenses = sum("lens" in each for each in drawn_by_chance)
    print(f"{len(drawn_by_chance) - lenses:6}  of them with `jitter`: compared without it, and {chance.DRAWS} pictures "
          "of each program with it")
    print(f"{lenses:6}  of them with a lens: compared without it, and the size of the lens")
    for record in drawn:
        picture = record["picture"]
        words = picture.get("failed") or picture.get("fault") or f"{verdict(record)} {json.dumps(picture)}"
        by_chance = record.get("chance", {})
        words += f" lens {100 * by_chance['lens']:+.2f} %" if "lens" in by_chance else " " + by_chance["failed"] if "failed" in by_chance else \
            f" {chance.words(by_chance)}" if by_chance else ""
        print(f"{record['scene']}: " + " ".join(words.split()))


def survey(options, paths, copies):
    folders, known = pictures.include_folders(), supported()
    scenes = []
    for path in paths:
        copy = unpacked(os.path.dirname(os.path.abspath(path)), copies)
        name = os.path.relpath(path, EXAMPLES) if path.startswith(EXAMPLES) else path
        scenes.append((name, os.path.join(copy, os.path.basename(path).removesuffix(".gz"))))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        records = list(pool.map(lambda scene: read(scene, options, folders, known), scenes))
        if options.render:
            accepted = [record for record in records if record["outcome"] == "accepted"]
            list(pool.map(lambda record: render(record, options, folders), accepted))
    if options.times:
        for record in (each for each in records if each["outcome"] == "accepted"):
            record["times"] = survey_times.measure(frame_scene(record["path"]), options.size, options.turns,
                                                   options.timeout, folders)
    return records


def main():
    options = arguments()
    paths = options.scenes or installed()
    if not paths:
        print(f"no scenes in {EXAMPLES}: install povray-examples")
        return SKIPPED
    with tempfile.TemporaryDirectory() as top:
        records = survey(options, paths, {"top": top})
    for record in records:
        record.pop("path")
        record.pop("drawn", None)
        detail = f" {record['where']}: {record['blockers'][0]}" if record["blockers"] else ""
        print(f"{record['scene']}: {record['outcome']}{detail}")
    print_tables(records)
    if options.render:
        print_pictures(records)
    if options.times:
        survey_times.print_times(records)
    if options.docs:
        write_table(records, options.docs)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as out:
            json.dump({"scenes": records, "plan": plan(records)}, out, indent=1)
            out.write("\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
