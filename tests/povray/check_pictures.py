#!/usr/bin/env python3
"""The same scenes given to rtlang and to POV-Ray by rtcheck: the pictures must agree in every pixel but silhouette ties.

All of tests/povray/*.scn, tests/povray/mapped/*.scn (whose image files are made first) and examples/*.scn at 320x240
without anti-aliasing; a scene's line tells the greatest difference and how many pixels are beyond 2/65535. A scene that
says nothing of gamma is compared as stored codes, which both programs then write as they are. Prints TAP.
SPDX-License-Identifier: MIT
"""
import concurrent.futures
import glob
import json
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import images  # noqa: E402
import pictures  # noqa: E402

TOP = os.environ.get("top_srcdir", ".")
MISSING_TOOL = 3  # rtcheck's exit code when it cannot run POV-Ray or cannot read pictures


def scenes():
    return [scene for folder in ("tests/povray", "tests/povray/mapped", "examples") for scene in sorted(glob.glob(f"{TOP}/{folder}/*.scn"))]


def run_rtcheck(names, povray, folders):
    """Scene -> what rtcheck says of it; and its greatest exit code and its messages."""
    count = min(pictures.POVRAY_AT_ONCE, len(names))
    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        parts = list(pool.map(lambda first: run_part(names[first::count], povray, folders), range(count)))
    answers = {scene: answer for part, _, _ in parts for scene, answer in part.items()}
    return answers, max(status for _, status, _ in parts), "".join(messages for _, _, messages in parts)


def run_part(names, povray, folders):
    """The same by one run."""
    done = subprocess.run([os.environ["RTCHECK"], f"--width={pictures.WIDTH}", f"--height={pictures.HEIGHT}", "--json",
                           f"--threshold={pictures.CODE_BAR}/65535", f"--ties={pictures.TIE_SHARE}",
                           f"--povray={povray}", *[f"-I{folder}" for folder in folders], *names],
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          timeout=1800, check=False)
    lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    return {line["scene"]: line for line in lines}, done.returncode, done.stderr


def judge(answer):
    """(passed, words) of one scene. The bar is worked out here again, so that rtcheck cannot be too kind."""
    if answer is None:
        return False, "rtcheck said nothing"
    if "E0507" in answer.get("fault", ""):
        return True, "not compared: its image files # SKIP built without OpenImageIO"
    if "fault" in answer:
        return False, answer["fault"].replace("\n", " | ")
    met, words = pictures.verdict(round(answer["max"]), answer["beyond"], answer["pixels"])
    return met and answer["agrees"], words


def judge_rtcheck(scene, answer, folders):
    """rtcheck's numbers against those of another reader of pictures."""
    with tempfile.TemporaryDirectory() as folder:
        greatest, beyond, pixels = pictures.compare_programs(scene, folder, folders)
    same = answer and (greatest, beyond, pixels) == (round(answer.get("max", -1)), answer.get("beyond"),
                                                     answer.get("pixels"))
    return bool(same), f"{os.path.basename(scene)} by a second reader: " + pictures.verdict(greatest, beyond, pixels)[1]


def compare(names, povray, folders):
    """(TAP results, rtcheck's messages), or None and why it cannot be run."""
    answers, status, messages = run_rtcheck(names, povray, folders)
    if status == MISSING_TOOL:
        return None, messages
    results = [(os.path.relpath(name, TOP), *judge(answers.get(name))) for name in names]
    # The scene that differs most says most about the one who measures.
    hardest = max(names, key=lambda name: (answers.get(name) or {}).get("max", -1.0))
    results.append(("rtcheck", *judge_rtcheck(hardest, answers.get(hardest), folders)))
    passed_all = all(passed for _, passed, _ in results)
    skipped = any("# SKIP" in words for _, _, words in results)
    results.append(("rtcheck's exit code", skipped or (status == 0) == passed_all, str(status)))
    return results, messages


def main():
    names, povray = scenes(), pictures.povray()
    if not povray:
        print("1..0 # SKIP povray is not installed")
        return 0
    with tempfile.TemporaryDirectory() as made:
        images.make(made, os.environ["RTLANG"])
        results, messages = compare(names, povray, [made, *pictures.include_folders()])
    if results is None:
        print("1..0 # SKIP " + messages.strip().splitlines()[0])
        return 0
    print(f"1..{len(results)}")
    for number, (name, passed, words) in enumerate(results, 1):
        print(f"{'ok' if passed else 'not ok'} {number} - {name}: {words}")
    for line in messages.splitlines():
        print("# " + line)
    return 0 if all(passed for _, passed, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main())
