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
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "povray"))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import chromium  # noqa: E402
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
VOID = {"meta", "link", "img", "br", "rect", "line", "path", "circle", "input"}
# Appended to a copy of the page: does what a reader does and leaves what was seen in the title.
READER = """<script>
"use strict";
window.addEventListener("load", async () => { // all pictures are there
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
const viewer = pictures.closest("article").querySelector("details.viewer");
viewer.open = true;
await new Promise((resolve) => setTimeout(resolve, 300));
const stage = viewer.querySelector(".stage");
const visible = () => Array.from(stage.children, (each) => each.style.visibility);
const choose = (list, value) => { list.value = value; list.dispatchEvent(new Event("change")); };
seen.shown = [visible()];
choose(viewer.querySelector(".shown"), "1");
seen.shown.push(visible());
choose(viewer.querySelector(".zoom"), "8");
seen.zoom = stage.children[0].getBoundingClientRect().width;
const flicker = viewer.querySelector(".flicker");
flicker.click();
await new Promise((resolve) => setTimeout(resolve, 600));
seen.flicker = [flicker.ariaPressed, visible()];
flicker.click();
const point = (x, y) => {
  const place = stage.children[0].getBoundingClientRect();
  stage.children[0].dispatchEvent(new MouseEvent("click", { bubbles: true,
    clientX: place.left + (x + 0.5) * 8, clientY: place.top + (y + 0.5) * 8 }));
};
point(0, 0);
seen.command = viewer.querySelector(".command").textContent;
point(AT_X, AT_Y);
seen.ray = [viewer.querySelector(".pixel").textContent, pictures.closest("article").querySelector("details.ray[open]").id];
const heat = pictures.querySelector("img.difference");
const logarithmic = heat.src;
choose(document.querySelector(".scale-choice"), "257");
await heat.decode();
const canvas = document.createElement("canvas");
canvas.width = WIDE; canvas.height = HIGH;
canvas.getContext("2d").drawImage(heat, 0, 0);
seen.even = Array.from(canvas.getContext("2d").getImageData(0, 0, WIDE, HIGH).data);
seen.marks = Array.from(document.querySelectorAll(".scale .mark"), (mark) => mark.textContent);
choose(document.querySelector(".scale-choice"), "0");
seen.back = heat.src === logarithmic;
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


def luminance(colour):
    """WCAG 2.1's relative luminance of #rgb or #rrggbb."""
    digits = colour[1:] if len(colour) == 7 else "".join(2 * digit for digit in colour[1:])
    values = [int(digits[i:i + 2], 16) / 255 for i in (0, 2, 4)]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in values]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def check_access(tap, text):
    """What a reader who does not see, or not well, needs of the page."""
    themes = [dict(re.findall(r"--([a-z-]+): (#[0-9a-f]+)", part)) for part in re.findall(r":root \{(.*?)\}", text, re.S)]
    poor = [(name, ground) for theme in themes for name in ("text", "faint", "link", "good", "bad")
            for ground in ("page", "card", "bad-card") if contrast(theme[name], theme[ground]) < 4.5]
    tap.ok(len(themes) == 2 and not poor, "letters stand out from what is behind them, light and dark", poor)
    levels = [int(level) for level in re.findall(r"<h(\d)", text)]
    tap.ok(levels[0] == 1 and levels.count(1) == 1 and all(b <= a + 1 for a, b in zip(levels, levels[1:])), "headings go down one by one", levels)
    tap.ok('<html lang="en">' in text and not re.search(r"<img(?![^>]* alt=)", text), "the page has a language, each picture words")
    boxes = re.findall(r"<(?:select|input)\b[^>]*>", text)
    labelled = re.findall(r"<label>[^<]*<(?:select|input)\b", text)
    tap.ok(len(boxes) == len(labelled), "each field has a label", (len(boxes), len(labelled)))
    regions = re.findall(r'role="region" aria-label="([^"]*)"', text)
    tap.ok(len(regions) == len(set(regions)), "regions have names of their own", regions)


def check_about(tap, text):
    about = text[text.index('<section id="about">'):]
    version = subprocess.run([os.environ["RTCHECK"], "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    terms = dict(re.findall(r"<dt>([^<]*)</dt><dd>(.*?)</dd>", about))
    tap.ok(terms.get("rtlang") == version and "stand_in --json" in terms.get("Command", "") and "processor" in terms.get("Machine", "") and
           terms.get("System", "").startswith("Linux") and terms.get("POV-Ray"), "versions, command, machine and system are told", terms)
    tap.ok("'a&lt;b&gt;&amp;'\\''&quot;c.scn'" in terms.get("Command", ""), "as a shell reads them", terms.get("Command"))
    sources = re.findall(r'<details class="source">.*?<pre tabindex="0">(.*?)</pre>', text, re.S)
    tap.ok(len(sources) == 3 and sources[0].startswith("    1  #version 3.7;") and "    3  sphere { 0, 1 pigment" in sources[0],
           "each scene's text with the numbers of its lines", sources[:1])
    rays = re.findall(r'<details class="ray" id="ray-2-(\d+)-(\d+)".*?<pre tabindex="0">(.*?)</pre>', text, re.S)
    tap.ok(1 < len(rays) <= 6 and all(log.startswith(f"pixel {x}, {y}\n") and "h = b² - 4 a c" in log for x, y, log in rays) and
           text.count('<svg class="rays"') == len(re.findall('<details class="ray"', text)), "the rays of pixels that differ most, drawn and told", rays[:1])


def read_by(browser, page, width):
    """What the reader in the page saw, in a window of that width."""
    browser.set_view(width, 900, "light")
    browser.open("file://" + page)
    browser.wait_for("document.title.startsWith('{')")
    return json.loads(browser.value("document.title") or "{}")


def even_colour(steps, most):
    """A colour of the scale, told anew."""
    stops = [(0.0, (10, 10, 20)), (0.06, (44, 22, 92)), (0.25, (118, 28, 118)), (0.5, (212, 62, 78)), (0.7, (245, 140, 40)),
             (0.88, (252, 216, 96)), (1.0, (255, 255, 240))]
    place = min(steps / most, 1)
    (low, a), (high, b) = next(pair for pair in zip(stops, stops[1:]) if place <= pair[1][0])
    share = (place - low) / (high - low)
    return [p + share * (q - p) for p, q in zip(a, b)]


def check_viewer(tap, seen, steps, at, scene):
    first, second = ["visible", "hidden", "hidden"], ["hidden", "visible", "hidden"]
    tap.ok(seen.get("shown") == [first, second], "one picture lies above the other", seen.get("shown"))
    tap.ok(seen.get("zoom") == 8 * WIDTH, "enlarged as asked for", seen.get("zoom"))
    tap.ok(seen.get("flicker") == ["true", first], "and they flicker", seen.get("flicker"))
    tap.ok(seen.get("command") == f"rtlang -W{WIDTH} -H{HEIGHT} --trace-pixel=0,0 '" + scene.replace("'", "'\\''") + "'",
           "a pixel's ray is told by a command that a shell reads", seen.get("command"))
    tap.ok(seen.get("ray") == [f"pixel {at % WIDTH}, {at // WIDTH}: {steps[at]}/65535 apart. Its ray is below.",
                               f"ray-2-{at % WIDTH}-{at // WIDTH}"], "or by the log that is there", seen.get("ray"))
    even = seen.get("even", [])
    off = max((abs(even[4 * i + c] - value) for i, step in enumerate(steps) for c, value in enumerate(even_colour(step, 257))), default=999) \
        if len(even) == 4 * len(steps) else 999
    tap.ok(off <= 1 and seen.get("marks") == ["0", "64", "129", "193", "257"] and seen.get("back"),
           "the difference on another scale, and back", (off, seen.get("marks"), seen.get("back")))


def check_browser(tap, text, answers, folder):
    report = os.path.join(folder, "out", "index.html")
    steps, _, _ = steps_between(folder)
    at = max(range(len(steps)), key=lambda i: steps[i])
    values = {"AT_X": at % WIDTH, "AT_Y": at // WIDTH, "WIDE": WIDTH, "HIGH": HEIGHT}
    reader = re.sub("|".join(values), lambda match: str(values[match.group()]), READER)
    copy = os.path.join(folder, "read.html")
    write(copy, text.replace("</body>", reader + "</body>"))
    browser = chromium.Chromium()
    seen, narrow = (read_by(browser, copy, width) for width in (900, 400))
    browser.set_view(1000, 1500, "light")
    browser.open("file://" + report)
    browser.wait_for("document.readyState === 'complete' && document.title === 'rtcheck report'")
    browser.picture(os.path.join(folder, "shot.png"))
    browser.close()
    tap.ok(not browser.complaints, "a browser has nothing to complain of", "\n".join(browser.complaints))
    outside = [one for one in browser.requests if not one.startswith(("file://" + folder, "data:", "about:"))]
    tap.ok(len(browser.requests) > 2 and not outside, "of its requests none leaves the page", outside)
    names = list(SCENES)
    by_max = sorted((answer for answer in answers if "max" in answer), key=lambda answer: answer["max"])
    rising = [answer["scene"] for answer in by_max]
    falling = [answer["scene"] for answer in sorted(by_max, key=lambda answer: -answer["max"])]
    tap.ok(seen.get("before") == names and seen.get("links") == 4, "the scenes stand in their order", seen)
    tap.ok(seen.get("rising") == [rising + ["wrong.scn"], "ascending"], "one click sorts", seen.get("rising"))
    tap.ok(seen.get("falling") == [falling + ["wrong.scn"], "descending"], "another one turns it", seen.get("falling"))
    tap.ok(seen.get("byName") == [sorted(names), None], "by text, too", seen.get("byName"))
    tap.ok(seen.get("focus") == 0, "headings can be reached with the keyboard", seen.get("focus"))
    tap.ok(seen.get("probe") == f"pixel {at % WIDTH}, {at // WIDTH}: {steps[at]}/65535 apart",
             "the pointer tells the difference", seen.get("probe"))
    tap.ok(seen.get("large") == ["pictures large", True], "a click on a picture makes it large", seen.get("large"))
    tap.ok(seen.get("wide") is True, "a small screen is wide enough")
    check_viewer(tap, seen, steps, at, names[1])
    tap.ok(narrow.get("wide") is True, "and so is a smaller one")
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
        check_about(tap, text)
        check_access(tap, text)
        if chromium.PROGRAM:
            check_browser(tap, text, answers, folder)
        else:
            tap.skip("the page in a browser", "chromium is not installed")
    tap.done()


if __name__ == "__main__":
    main()
