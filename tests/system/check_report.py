#!/usr/bin/env python3
"""The report of rtcheck: what is in the page, that it needs nothing but itself, and how it behaves in a browser.

A stand-in for POV-Ray hands out the picture of another scene, so that there are differences to show. FLIP is computed
here a second time, straight from the paper's formulas. What needs a browser is skipped without chromium. Prints TAP.
SPDX-License-Identifier: MIT
"""
import base64
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "povray"))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import flip  # noqa: E402
import pictures  # noqa: E402
from tap import Tap  # noqa: E402

WIDTH, HEIGHT = 40, 30
HEAD = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location -3*z look_at 0 } light_source { <4, 5, -6> rgb 1 }
"""
SCENES = {  # the first one's picture is what the stand-in makes of all of them
    "plain.scn": HEAD + "sphere { 0, 1 pigment { rgb <1, 0.5, 0.2> } }\n",
    "a<b>&'\"c.scn": HEAD + "sphere { 0.2*x, 1 pigment { rgb <0.9, 0.5, 0.25> } }\n",
    "far.scn": HEAD + "sphere { 0, 1 pigment { rgb <1, 0.5, 0.2> } } sphere { 4e6*z, 1 }\n",
    "wrong.scn": "nonsense\n",
}
STAND_IN = """#!/bin/sh
for a; do case $a in +O*) output=${a#+O?}; output=${output%?};; esac; done
cp "${output%/*}/01-plain.scn.rtlang.png" "$output"
"""
EXPECTED = {"plain.scn": "agrees", "a<b>&'\"c.scn": "differs", "far.scn": "agrees, out of range", "wrong.scn": "failed"}
VOID = {"meta", "link", "img", "br", "rect", "line", "path"}
CHROMIUM = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
            "--disable-background-networking", "--disable-component-update", "--enable-logging=stderr"]
# Appended to a copy of the page: does what a reader does and leaves what was seen in the title.
READER = """<script>
"use strict";
window.addEventListener("load", () => { // all pictures are there
const table = document.querySelector("table.sortable");
const names = () => Array.from(table.tBodies[0].rows, (row) => row.cells[0].textContent);
const heading = Array.from(table.tHead.rows[0].cells).findIndex((cell) => cell.textContent === "max");
const button = table.tHead.rows[0].cells[heading].querySelector("button");
const seen = { links: document.querySelectorAll("nav a").length, before: names(), focus: button.tabIndex };
button.click();
seen.rising = [names(), button.parentElement.ariaSort];
button.click();
seen.falling = [names(), button.parentElement.ariaSort];
table.tHead.rows[0].cells[0].querySelector("button").click();
seen.byName = [names(), button.parentElement.ariaSort];
const pictures = document.querySelectorAll(".pictures")[1];
const picture = pictures.querySelector("figure img");
const box = picture.getBoundingClientRect();
picture.dispatchEvent(new PointerEvent("pointermove", { bubbles: true,
  clientX: box.left + (AT_X + 0.5) * box.width / WIDE,
  clientY: box.top + (AT_Y + 0.5) * box.height / HIGH }));
seen.probe = pictures.parentElement.querySelector(".probe").textContent;
pictures.querySelector("button").click();
seen.large = [pictures.className, picture.getBoundingClientRect().width > box.width];
seen.wide = document.documentElement.scrollWidth <= window.innerWidth;
document.title = JSON.stringify(seen);
});
</script>
"""


class Page(html.parser.HTMLParser):
    """What a page holds: its elements, its addresses, the text of table cells, and whether all that opens closes."""

    def __init__(self, text):
        super().__init__()
        self.open, self.mismatched, self.addresses, self.counts, self.ids = [], [], [], {}, []
        self.rows, self.policy, self.titles = [], "", []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.counts[tag] = self.counts.get(tag, 0) + 1
        self.addresses += [(tag, attributes[name]) for name in ("src", "href", "srcset", "action", "data", "poster")
                           if name in attributes]
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if attributes.get("http-equiv") == "Content-Security-Policy":
            self.policy = attributes["content"]
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_startendtag(self, tag, attrs):
        self.counts[tag] = self.counts.get(tag, 0) + 1

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.mismatched.append((tag, self.getpos()))

    def handle_data(self, data):
        if self.open and ("td" in self.open or "th" in self.open):
            self.rows[-1][-1] += data
        if self.open[1:] == ["head", "title"]:
            self.titles.append(data)


def write(path, text):
    with open(path, "w", encoding="utf-8") as out:
        out.write(text)


def make_report(folder, *more):
    """Runs rtcheck; its exit code and lines of JSON."""
    for name, text in SCENES.items():
        write(os.path.join(folder, name), text)
    stand_in = os.path.join(folder, "stand_in")
    write(stand_in, STAND_IN)
    os.chmod(stand_in, 0o755)
    done = subprocess.run([os.environ["RTCHECK"], f"-W{WIDTH}", f"-H{HEIGHT}", "--povray", stand_in, "--json",
                           "--report=out", "--keep=kept", *more, *SCENES], cwd=folder, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120, check=False)
    return done.returncode, [json.loads(line) for line in done.stdout.splitlines()], done.stderr


def embedded(text, index, folder):
    """The values of the picture with that number in the page."""
    data = re.findall(r'src="data:image/png;base64,([^"]*)"', text)[index]
    path = os.path.join(folder, "embedded.png")
    with open(path, "wb") as out:
        out.write(base64.b64decode(data, validate=True))
    return pictures.read_png(path)


def steps_between(folder):
    """For each pixel of the second scene how far the pictures are apart."""
    name = "02-" + list(SCENES)[1]
    _, _, ours = pictures.read_png(os.path.join(folder, "kept", name + ".rtlang.png"))
    _, _, theirs = pictures.read_png(os.path.join(folder, "kept", name + ".povray.png"))
    apart = [abs(a - b) for a, b in zip(ours, theirs)]
    return [max(apart[i:i + 3]) for i in range(0, len(apart), 3)], ours, theirs


def check_page(tap, text, page, answers, folder):
    outside = [address for tag, address in page.addresses
               if not (address.startswith("data:") or (tag == "a" and address.startswith("#")))]
    tap.ok(not outside, "all addresses are within the page", outside[:3])
    tap.ok(not re.search(r"https?://|url\(|@import|fetch\(|XMLHttpRequest", re.sub(r"base64,[^\"]*", "", text)),
             "and it asks for nothing else")
    tap.ok(page.policy.startswith("default-src 'none'; img-src data:;"), "nor would the browser let it", page.policy)
    targets = {address[1:] for tag, address in page.addresses if tag == "a"}
    tap.ok(targets <= set(page.ids) and len(page.ids) == len(set(page.ids)), "its links lead somewhere", targets)
    tap.ok(not page.mismatched and not page.open, "what opens closes", page.mismatched + page.open)
    verdicts = {row[0]: row[1] for row in page.rows[1:]}
    tap.ok(verdicts == EXPECTED, "a row for each scene, with its verdict", verdicts)
    widths = {len(row) for row in page.rows}
    tap.ok(len(widths) == 1, "rows are of one length", widths)
    rows = {row[0]: row for row in page.rows[1:]}
    told = answers[1]
    row = rows[told["scene"]]
    tap.ok(row[2] == f"{told['max']:.0f}" and row[6:9] == [str(told[name]) for name in
                                                            ("beyond", "beyond_code_16", "beyond_code_8")],
             "the table says what JSON says", (row, told))
    steps, ours, theirs = steps_between(folder)
    tap.ok((told["beyond"], told["beyond_code_16"], told["beyond_code_8"]) ==
             tuple(sum(step > bar for step in steps) for bar in (2, 1, 257)), "pixels beyond are counted", told)
    width, height, exact = embedded(text, 7, folder)
    tap.ok((width, height) == (WIDTH, HEIGHT) and
             [256 * exact[i] + exact[i + 1] for i in range(0, len(exact), 3)] == steps,
             "the hidden picture holds every difference")
    bars = [int(count) for count in re.findall(r"65535: (\d+) pixels", text)]
    tap.ok(len(bars) == 4 * 18 and sum(bars[:18]) == 3 * WIDTH * HEIGHT, "the histogram holds every pixel", bars)
    expected = [0] * 18
    for step in steps:
        expected[next(i for i in range(18) if step <= (2 ** (i - 1) if i else 0))] += 1
    second = bars[36:54]  # the first 18 are those of all scenes
    tap.ok(second == expected, "in the right bins", (second, expected))
    direct = flip.flip(WIDTH, HEIGHT, *([value / 65535 for value in values] for values in (ours, theirs)))
    tap.ok(abs(direct - told["flip"]) < 1e-6 and direct > 0.001,
           f"FLIP: {told['flip']}, computed directly {direct:.9f}")


def browse(page, more, folder):
    """(what the browser prints, what it complains of)."""
    with tempfile.TemporaryDirectory() as profile:
        done = subprocess.run([CHROMIUM_PROGRAM, *CHROMIUM, f"--user-data-dir={profile}", *more, "file://" + page],
                              cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=120, check=False)
    messages = done.stderr.decode("utf-8", "replace").splitlines()
    return done.stdout.decode("utf-8", "replace"), [line for line in messages if "CONSOLE" in line]


CHROMIUM_PROGRAM = shutil.which("chromium") or shutil.which("chromium-browser")


def check_browser(tap, text, answers, folder):
    report = os.path.join(folder, "out", "index.html")
    steps, _, _ = steps_between(folder)
    at = max(range(len(steps)), key=lambda i: steps[i])
    values = {"AT_X": at % WIDTH, "AT_Y": at // WIDTH, "WIDE": WIDTH, "HIGH": HEIGHT}
    reader = re.sub("|".join(values), lambda match: str(values[match.group()]), READER)
    copy = os.path.join(folder, "read.html")
    write(copy, text.replace("</body>", reader + "</body>"))
    dump, complaints = browse(copy, ["--dump-dom", "--window-size=900,900"], folder)
    tap.ok(not complaints, "a browser has nothing to complain of", "\n".join(complaints))
    seen = json.loads("".join(Page(dump).titles) or "{}")
    names = list(SCENES)
    by_max = sorted((answer for answer in answers if "max" in answer), key=lambda answer: answer["max"])
    rising = [answer["scene"] for answer in by_max]
    falling = [answer["scene"] for answer in sorted(by_max, key=lambda answer: -answer["max"])]
    tap.ok(seen.get("before") == names and seen.get("links") == 3, "the scenes stand in their order", seen)
    tap.ok(seen.get("rising") == [rising + ["wrong.scn"], "ascending"], "one click sorts", seen.get("rising"))
    tap.ok(seen.get("falling") == [falling + ["wrong.scn"], "descending"], "another one turns it", seen.get("falling"))
    tap.ok(seen.get("byName") == [sorted(names), None], "by text, too", seen.get("byName"))
    tap.ok(seen.get("focus") == 0, "headings can be reached with the keyboard", seen.get("focus"))
    tap.ok(seen.get("probe") == f"pixel {at % WIDTH}, {at // WIDTH}: {steps[at]}/65535 apart",
             "the pointer tells the difference", seen.get("probe"))
    tap.ok(seen.get("large") == ["pictures large", True], "a click on a picture makes it large", seen.get("large"))
    tap.ok(seen.get("wide") is True, "a small screen is wide enough")
    browse(report, [f"--screenshot={folder}/shot.png", "--window-size=1000,1500"], folder)
    width, height, values = pictures.read_png(os.path.join(folder, "shot.png"))
    colours = {tuple(values[i:i + 3]) for i in range(0, len(values), 3)}
    tap.ok((width, height) == (1000, 1500) and len(colours) > 200, f"it is drawn, in {len(colours)} colours")


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        status, answers, messages = make_report(folder)
        tap.ok(status == 1 and not messages, f"rtcheck ends with {status}", messages)
        with open(os.path.join(folder, "out", "index.html"), encoding="utf-8") as file:
            text = file.read()
        with open(os.path.join(folder, "out", "results.json"), encoding="utf-8") as file:
            tap.ok(json.load(file) == answers, "results.json holds what is printed")
        tap.ok(sorted(os.listdir(os.path.join(folder, "out"))) == ["index.html", "results.json"],
               "and nothing is left over")
        tap.ok("4e+06" in answers[2].get("range", "") and "range" not in answers[0],
                 "a scene out of POV-Ray's range is told", answers[2])
        check_page(tap, text, Page(text), answers, folder)
        if CHROMIUM_PROGRAM:
            check_browser(tap, text, answers, folder)
        else:
            tap.skip("the page in a browser", "chromium is not installed")
    tap.done()


if __name__ == "__main__":
    main()
