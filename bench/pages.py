#!/usr/bin/env python3
"""Each page that rtlang and rtcheck make, in Chromium: pictures to look at, axe-core's faults, and where it connects to.

Usage: pages.py [--axe=FOLDER] [--only=PAGE]... [OUTPUT]: a cross-check, a study, a stability report, a watched scene and the
tour are made and opened 1280 and 400 pixels wide, light and dark. Their pictures (PAGE-WIDTH-SCHEME.png, the whole page)
are left in OUTPUT (default: pages). axe-core is of npm: `npm install axe-core` in FOLDER; without it pages are not
checked by it. Chromium's own log of the network is read at the end: no page may have asked for anything but itself and 127.0.0.1.
Exit status 1 when axe-core finds a serious fault, when something stands out of a page, or when a request leaves.
SPDX-License-Identifier: MIT
"""
import argparse
import base64
import json
import os
import subprocess
import sys
import tempfile
import urllib.parse

sys.dont_write_bytecode = True
TOP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
import chromium  # noqa: E402

RTLANG = os.path.abspath(os.environ.get("RTLANG", os.path.join(TOP, "rtlang")))
RTCHECK = os.path.join(os.path.dirname(RTLANG), "rtcheck")
EXAMPLES = os.path.join(TOP, "examples")
FLAKE = os.path.join(EXAMPLES, "10_sphere_flake.scn")
GLASS = os.path.join(EXAMPLES, "05_glass_and_filters.scn")
SHELLS = os.path.join(EXAMPLES, "gallery", "shells.scn")
FAULTY = "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\nspheer { 0, 1 }\n"
# What a reader would do before the page is judged: all that is folded away is opened.
OPENED = "document.querySelectorAll('details').forEach((each) => { each.open = true; }); true"
STANDS_OUT = "document.documentElement.scrollWidth > innerWidth"
RULES = "({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] })"


def make(command, folder):
    subprocess.run(command, cwd=folder, env={**os.environ, "RTLANG": RTLANG}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)


def report(folder, name, *arguments):
    make([RTCHECK, "--report=" + name, *arguments], folder)
    return "file://" + os.path.join(folder, name, "index.html")


class Watched:
    """A scene that is watched, with a pixel clicked."""

    def __init__(self, folder, fault):
        self.path, self.fault = os.path.join(folder, "fault.scn" if fault else "flake.scn"), fault
        with open(FLAKE, encoding="utf-8") as file:
            self.text = file.read()
        with open(self.path, "w", encoding="utf-8") as out:
            out.write(self.text)
        self.process = subprocess.Popen([RTLANG, "--watch", "--target-error=0.004", self.path], text=True,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
        self.address = self.process.stdout.readline().strip()

    def settle(self, browser):
        if self.fault:
            browser.wait_for("state && current.naturalWidth > 0")
            with open(self.path, "w", encoding="utf-8") as out:
                out.write(self.text.replace("sphere {", "spheer {", 1))
            browser.wait_for("state.state === 'fault' && !$('message-card').hidden")
            return
        browser.wait_for("state && state.state === 'done'")
        browser.value("$('frame').focus(); setMark(160, 120)")
        browser.call("Input.dispatchKeyEvent", type="keyDown", key="Enter", code="Enter", windowsVirtualKeyCode=13)
        browser.wait_for("$('log').textContent.includes('ray 1')")

    def end(self):
        self.process.terminate()
        self.process.wait()


def pages(folder, only):
    """(name, address, what settles it, what ends it) of each page, made when it is asked for."""
    def wanted(name):
        return not only or name in only
    if wanted("cross-check"):
        yield "cross-check", report(folder, "cross-check", FLAKE, SHELLS, GLASS), None, None
    if wanted("study"):
        yield "study", report(folder, "study", "--study", "--budget=20", GLASS), None, None
    if wanted("stability"):
        yield "stability", report(folder, "stability", "--stability"), None, None
    if wanted("tour"):
        make([sys.executable, os.path.join(TOP, "docs", "tour.py"), "tour.html"], folder)
        yield "tour", "file://" + os.path.join(folder, "tour.html"), None, None
    for name, fault in ("watch", False), ("watch-fault", True):
        if wanted(name):
            watched = Watched(folder, fault)
            yield name, watched.address, watched.settle, watched.end


def picture(browser, width, path):
    """The whole page, as high as it is."""
    size = browser.call("Page.getLayoutMetrics")["cssContentSize"]
    clip = {"x": 0, "y": 0, "width": width, "height": min(size["height"], 16000), "scale": 1}
    data = browser.call("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)["data"]
    with open(path, "wb") as out:
        out.write(base64.b64decode(data))


def faults_of(browser, axe):
    """axe-core's violations, as (impact, rule, where)."""
    browser.value(axe + "; true")
    found = browser.value(f"axe.run(document, {RULES}).then((result) => JSON.stringify(result.violations))")
    return [(one["impact"], one["id"], [node["target"][0] for node in one["nodes"]]) for one in json.loads(found)]


def asked_elsewhere(path):
    """What Chromium's log of the network says was asked of others than the loopback: by pages, and by Chromium itself."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    log = json.loads(text if text.rstrip().endswith("}") else text.rstrip().rstrip(",") + "]}")
    begin = log["constants"]["logEventTypes"]["URL_REQUEST_START_JOB"]
    by_page, by_browser = set(), set()
    for event in log["events"]:
        request = event.get("params", {})
        address = urllib.parse.urlsplit(request.get("url", ""))
        if event["type"] == begin and address.scheme not in ("file", "data", "blob") and address.hostname != "127.0.0.1":
            (by_browser if request.get("initiator") == "not an origin" else by_page).add(address.netloc)
    return by_page, by_browser


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--axe", default="", help="folder in which `npm install axe-core` was said")
    parser.add_argument("--only", action="append", help="this page only")
    parser.add_argument("output", nargs="?", default="pages")
    options = parser.parse_args()
    axe = ""
    if options.axe:
        with open(os.path.join(options.axe, "node_modules", "axe-core", "axe.min.js"), encoding="utf-8") as file:
            axe = file.read()
    os.makedirs(options.output, exist_ok=True)
    bad = 0
    with tempfile.TemporaryDirectory(prefix="rtlang-pages-") as folder:
        log = os.path.join(folder, "net.json")
        browser = chromium.Chromium("--log-net-log=" + log, "--net-log-capture-mode=Everything")
        for name, address, settle, end in pages(folder, options.only):
            browser.set_view(1280, 900, "light")
            browser.open(address)
            browser.wait_for("document.readyState === 'complete'")
            if settle:
                settle(browser)
            for opened in False, True:
                if opened:
                    browser.value(OPENED)
                for width in 1280, 400:
                    for scheme in "light", "dark":
                        browser.set_view(width, 900, scheme)
                        label = f"{name}-{width}-{scheme}" + ("-opened" if opened else "")
                        browser.value("new Promise((done) => setTimeout(done, 300))")
                        picture(browser, width, os.path.join(options.output, label + ".png"))
                        found = faults_of(browser, axe) if axe else []
                        wide = browser.value(STANDS_OUT)
                        bad += wide + sum(impact in ("serious", "critical") for impact, _, _ in found)
                        print(f"{label}: {'stands out' if wide else 'fits'}, {len(found)} faults", flush=True)
                        for impact, rule, where in found:
                            print(f"    {impact}: {rule}: {len(where)} times, as at {where[0]}", flush=True)
            if end:
                end()
        asked = len(browser.requests)
        browser.close()
        away, own = asked_elsewhere(log)
    print(f"{asked} requests by pages; elsewhere: {', '.join(sorted(away)) or 'none'} (Chromium's own: {', '.join(sorted(own)) or 'none'})")
    return 1 if bad or away else 0


if __name__ == "__main__":
    sys.exit(main())
