#!/usr/bin/env python3
"""docs/tour.md: each command prints what stands there, and draws the picture that stands there; and its HTML page.

docs/tour.py runs the commands (with UPDATE_DOCS=1 the page and docs/tour are written anew). The HTML page must need nothing
but itself and hold all commands, their output, and a picture for each; without python3-markdown that is skipped. Prints TAP.
SPDX-License-Identifier: MIT
"""
import base64
import html.parser
import os
import re
import shutil
import sys
import tempfile

sys.dont_write_bytecode = True  # the folders are distributed as they are
TOP = os.path.abspath(os.environ.get("top_srcdir", "."))
for folder in "docs", "tests/povray", "tests/system":
    sys.path.insert(0, os.path.join(TOP, folder))
import pictures  # noqa: E402
import tour  # noqa: E402
from tap import Tap  # noqa: E402

UPDATE = bool(os.environ.get("UPDATE_DOCS"))
tap = Tap()


def words_of(drawing):
    """Of a drawing of times: its words and errors; what slope in time a curve has is not the same in each run."""
    drawing = re.sub(rb": \S+ s, ", b": ", drawing).replace(b" (biased)", b"")
    return re.findall(rb">([^<>]*[a-z]{4}[^<>]*)<", drawing)


def apart(name, found, expected):
    """What differs, if anything: drawings to the letter, pictures to the pixel: their files also say which version drew them."""
    if not name.endswith(".svg"):
        return None if pictures.read_png(found) == pictures.read_png(expected) else "pixels"
    with open(found, "rb") as one, open(expected, "rb") as other:
        texts = one.read(), other.read()
    if name != "study.svg":
        return None if texts[0] == texts[1] else "letters"
    words = [words_of(text) for text in texts]
    return None if words[0] == words[1] else sorted(set(words[0]) ^ set(words[1]))


def check_pictures(names, folder):
    kept = os.path.join(TOP, "docs", "tour")
    if UPDATE:
        shutil.rmtree(kept, ignore_errors=True)
        os.mkdir(kept)
    for name in names:
        drawn, there = os.path.join(folder, name), os.path.join(kept, name)
        if UPDATE:
            shutil.copy(drawn, there)
        wrong = apart(name, drawn, there) if os.path.exists(drawn) and os.path.exists(there) else "no file"
        tap.ok(not wrong, f"docs/tour/{name} is what the commands draw", f"`make update-docs` draws it anew: {wrong}")
    tap.equal(sorted(os.listdir(kept)), sorted(names), "docs/tour holds no other files")


class Reader(html.parser.HTMLParser):
    """What a page asks for, what it shows as text, and whether its elements are closed in order."""
    VOID = {"meta", "link", "img", "br"}

    def __init__(self, text):
        super().__init__()
        self.open, self.faults, self.asked, self.images, self.ids, self.blocks = [], [], [], [], [], []
        self.feed(text)
        self.close()
        self.faults += self.open

    def handle_starttag(self, tag, attrs):
        if tag not in self.VOID:
            self.open.append(tag)
        if tag == "pre":
            self.blocks.append("")
        for name, value in attrs:
            if name in ("src", "href", "xlink:href", "srcset", "data", "action", "poster"):
                self.asked.append((tag, value))
            if name == "id":
                self.ids.append(value)
            if name == "src":
                self.images.append(value)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(tag)

    def handle_data(self, data):
        if "pre" in self.open:
            self.blocks[-1] += data


def check_html(page, names, folder):
    try:
        text = tour.html_of(page, folder)
    except ImportError:
        tap.skip("the tour as one HTML page", "python3-markdown is not installed")
        return
    reader = Reader(text)
    tap.equal(reader.faults, [], "the HTML page closes what it opens")
    outside = [(tag, value) for tag, value in reader.asked if not value.startswith(("data:", "#"))]
    tap.equal(outside + re.findall(r"@import.*|url\(.*", text), [], "it asks for nothing but itself")
    tap.equal([value for tag, value in reader.asked if tag == "a" and value[1:] not in reader.ids], [],
              "its links lead to its headings")
    tap.equal([title for title in re.findall(r"^## (.*)$", page, re.MULTILINE) if f">{title}</a>" not in text], [],
              "its contents name all headings")
    wanted = [block for _, block in tour.BLOCK.findall(page)]
    tap.equal(reader.blocks, wanted, "its blocks are the scenes, commands and output of tour.md")
    commands = [line for block in reader.blocks for line in block.splitlines() if line.startswith("$ ")]
    tap.equal(commands, re.findall(r"^\$ .*$", page, re.MULTILINE), "no command is missing")
    found = [base64.b64decode(value.partition(",")[2]) for value in reader.images]
    drawn = []
    for name in names:
        if name.endswith(".png"):
            with open(os.path.join(folder, name), "rb") as file:
                drawn.append(file.read())
    tap.ok(found == drawn, "it holds the pictures that the commands drew")
    tap.equal(text.count("<svg "), sum(name.endswith(".svg") for name in names), "it holds the drawings of rays")
    tap.equal(text.count("<figcaption>"), len(names), "there are words for each")


def main():
    tour.to_debians_python()
    with open(tour.SOURCE, encoding="utf-8") as file:
        page = file.read()
    names = tour.PICTURE.findall(page)
    with tempfile.TemporaryDirectory() as folder:
        def tell(text, shown):
            tap.ok(shown == text or UPDATE, text.splitlines()[0], "it prints now:\n" + shown)
        now = tour.walk(page, folder, tell)
        if UPDATE:
            with open(tour.SOURCE, "w", encoding="utf-8") as file:
                file.write(now)
        check_pictures(names, folder)
        check_html(now, names, folder)
    tap.done()


if __name__ == "__main__":
    main()
