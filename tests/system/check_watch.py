#!/usr/bin/env python3
"""The page of --watch: whom it serves, what it draws at each save, and how it ends; then the page in a browser.

A client by urllib stands for the page first: it reads the address from the program's output. What needs a browser is
skipped without chromium, what needs POV-Ray without povray, and all of it in a build without the module. Prints TAP.
SPDX-License-Identifier: MIT
"""
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.parse
import urllib.request

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "povray"))
import chromium  # noqa: E402
import pictures  # noqa: E402
from tap import Tap  # noqa: E402

RTLANG = os.path.abspath(os.environ["RTLANG"])
SCENE = """#version 3.7; global_settings { assumed_gamma 1 }
#include "colour.inc"
camera { location -3*z look_at 0 angle 40 } light_source { <4, 5, -6> rgb 1 }
plane { y, -1 pigment { rgb 0.6 } }
sphere { 0, 0.9 pigment { Colour } }
"""
RED, BLUE = "#declare Colour = rgb <1, 0.05, 0.05>;\n", "#declare Colour = rgb <0.05, 0.05, 1>;\n"
WRONG = SCENE.replace("pigment { Colour }", "pigment { Color }")
LIMIT = 60  # seconds to wait for what should take less than one
tap = Tap()


def write(path, text):
    with open(path, "w", encoding="utf-8") as out:
        out.write(text)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class Watched:
    """The program, and a client of what it serves."""

    def __init__(self, *arguments, **environment):
        self.process = subprocess.Popen([RTLANG, "--watch", *arguments], stdin=subprocess.DEVNULL, text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **environment})
        self.address = self.process.stdout.readline().strip()
        self.state = {"change": 0}

    def ask(self, what, method="GET"):
        """(status, body)."""
        target = what if "://" in what else self.address + what
        try:
            with urllib.request.urlopen(urllib.request.Request(target, method=method), timeout=LIMIT) as answer:
                return answer.status, answer.read()
        except urllib.error.HTTPError as refused:
            return refused.code, refused.read()

    def until(self, holds):
        """The first state in which that holds, by waiting for changes; None when there is none in time."""
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            self.state = json.loads(self.ask(f"state?after={self.state['change']}")[1])
            if holds(self.state):
                return self.state
        return None

    def drawn(self, save):
        return self.until(lambda state: state["save"] >= save and state["state"] == "done")

    def middle(self, folder):
        """The colour of the picture's middle, and its size."""
        path = os.path.join(folder, "seen.png")
        with open(path, "wb") as out:
            out.write(self.ask("picture")[1])
        width, height, values = pictures.read_png(path)
        at = 3 * (height // 2 * width + width // 2)
        return width, height, values[at:at + 3]

    def end(self, by=signal.SIGTERM):
        """(exit code, what it said, seconds that it took)."""
        begun = time.monotonic()
        self.process.send_signal(by)
        try:
            _, said = self.process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            _, said = self.process.communicate()
        return self.process.returncode, said, time.monotonic() - begun


def own_address():
    """One of this machine that is not the loopback's; None: there is none."""
    probe = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        probe.connect(("192.0.2.1", 9))  # sends nothing
        found = probe.getsockname()[0]
    except OSError:
        found = None
    probe.close()
    return found if found and not found.startswith("127.") else None


def can_connect(place, port):
    try:
        socket.create_connection((place, port), timeout=3).close()
    except OSError:
        return False
    return True


def test_served(watched):
    """Who is served, and what with."""
    form = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/([0-9a-f]{32})/", watched.address)
    tap.ok(form, "the program prints an address with a token of 128 bits", watched.address)
    port, token = int(form[1]), form[2]
    root = f"http://127.0.0.1:{port}/"
    wrong = ("0" if token[0] != "0" else "1") + token[1:]
    for path in ["", "favicon.ico", wrong + "/", wrong + "/state", token, token + "x/", token[:-1] + "/", "x" + token + "/",
                 token + "/nothing", token + "/../state", "state", "%00" + token + "/"]:
        status, body = watched.ask(root + path)
        tap.ok(status == 404 and body == b"not found\n", f"nobody is served `/{path.replace(token, 'TOKEN')[:20]}`", status)
    tap.equal(watched.ask("state", "POST")[0], 404, "nor who posts where there is nothing to post")
    tap.equal(watched.ask("state", "DELETE")[0], 405, "nor who wants something else")
    elsewhere = own_address()
    if elsewhere:
        tap.ok(not can_connect(elsewhere, port), f"nor who comes by {elsewhere}")
    else:
        tap.skip("nor who comes by another address", "there is none")
    tap.ok(not can_connect("::1", port), "nor who comes by IPv6")
    status, page = watched.ask("")
    text = page.decode("utf-8")
    tap.ok(status == 200 and text.startswith("<!DOCTYPE html>"), "with the token there is a page", status)
    tap.ok(not re.search(r"(?:src|href)=\"(?!data:,)|https?://|@import|url\(", text), "which names no other address")
    tap.ok("default-src 'none'" in text, "and may ask nobody else")
    with urllib.request.urlopen(watched.address + "state") as answer:
        kept = [answer.headers[name] for name in ("Cache-Control", "Referrer-Policy", "X-Frame-Options")]
    tap.equal(kept, ["no-store", "no-referrer", "DENY"], "no cache keeps it, no other page learns of it or embeds it")
    version = subprocess.run([RTLANG, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
    if "seccomp" in version and "no seccomp" not in version:
        threads = f"/proc/{watched.process.pid}/task"
        modes = [re.search(r"Seccomp:\t(\d)", read(f"{threads}/{thread}/status"))[1] for thread in os.listdir(threads)]
        tap.ok(len(modes) > 2 and set(modes) == {"2"}, f"each of {len(modes)} threads is confined", modes)
    tap.equal(watched.ask("line?file=/etc/passwd&line=1")[0], 404, "files that are not the scene's are not read")
    tap.equal([watched.ask(f"pixel?x={x}&y=1")[0] for x in ("80", "-1", "1e1", "")], [400] * 4, "pixels beside it are none")


def test_saves(watched, folder):
    state = watched.drawn(1)
    tap.ok(state and state["high"] <= state["target"] == 0.004, "the first picture reaches the goal", state)
    tap.ok(len(state["curve"]) >= 1 and all(a[0] < b[0] and a[1] > b[1] for a, b in zip(state["curve"], state["curve"][1:])),
           "its error falls", state["curve"])
    width, height, colour = watched.middle(folder)
    tap.ok((width, height) == (80, 60) and colour[0] > 2 * colour[2], "it is the scene's", (width, height, colour))
    status, body = watched.ask("pixel?x=40&y=30")
    found = json.loads(body) if status == 200 else {}
    hit = found.get("log", {}).get("rays", [{}])[0].get("hit", {})
    tap.equal((hit.get("shape"), hit.get("file"), hit.get("line")), ("sphere", "scene.scn", 5), "a pixel has object and line")
    tap.ok(found.get("text", "").startswith("pixel 40, 30\n") and "normal N" in found["text"], "and the ray's log", found)
    tap.equal(watched.ask("line?file=scene.scn&line=5"), (200, SCENE.splitlines(True)[4].encode()), "and the line's text")

    write("colour.inc", BLUE)
    state = watched.drawn(2)
    _, _, colour = watched.middle(folder)
    tap.ok(state and colour[2] > 2 * colour[0], "a file that is included is saved: it is drawn again", colour)
    tap.ok(0 < state["first_seconds"] < 10, f"first picture {1e3 * state['first_seconds']:.0f} ms after the save was seen")

    picture = watched.ask("picture")[1]
    write("scene.scn", WRONG)
    state = watched.until(lambda now: now["state"] == "fault")
    shown = state["messages"][0]["text"] if state and state["messages"] else ""
    tap.ok("scene.scn:5:" in shown and "error[E0201]" in shown and "sphere { 0, 0.9 pigment { Color } }" in shown and
           re.search(r"\n *\| +\^", shown), "a fault is reported with line and caret", shown or state)
    tap.ok(watched.ask("picture")[1] == picture and state["picture_save"] == 2 and state["save"] == 3, "and the picture stays", state)
    tap.equal(watched.ask("pixel?x=40&y=30")[0], 404, "of which no ray can be followed")

    write("new.scn", SCENE.replace("0.9", "0.5"))
    os.replace("new.scn", "scene.scn")  # as many editors save
    state = watched.drawn(4)
    tap.ok(state and not state["messages"] and state["picture_save"] == state["save"], "another file in its place is a save", state)

    write("scene.scn", SCENE.replace("colour.inc", "other.inc"))
    state = watched.until(lambda now: now["save"] > watched.state["save"] - 1 and now["state"] == "fault")
    tap.ok(state and "other.inc" in state["messages"][0]["text"], "a file that is missing is a fault", state)
    write("other.inc", RED)
    state = watched.until(lambda now: now["state"] == "done")
    tap.ok(state and watched.middle(folder)[2][0] > 2 * watched.middle(folder)[2][2], "and when it appears the scene is drawn", state)


def test_painter(watched):
    if not shutil.which("povray"):
        tap.skip("POV-Ray's picture", "povray is not installed")
        return
    tap.equal(watched.ask("povray")[0], 404, "POV-Ray's picture is not there before it is asked for")
    watched.ask("povray", "POST")
    state = watched.until(lambda now: now["povray"]["state"] in ("done", "fault"))
    status, body = watched.ask("povray")
    tap.ok(state and state["povray"]["state"] == "done" and status == 200 and body[:4] == b"\x89PNG", "then it is drawn", state)
    write("scene.scn", WRONG)
    watched.until(lambda now: now["state"] == "fault")
    watched.ask("povray", "POST")
    state = watched.until(lambda now: now["povray"]["state"] in ("done", "fault"))
    tap.ok(state and "povray ended with status" in state["povray"]["fault"], "what it says of a fault is reported", state)


def wait_for_nothing(watched):
    try:
        watched.ask("state?after=999999")
    except OSError:
        pass  # the connection is closed


def test_end(watched):
    """A page that waits, a connection that says nothing."""
    port = int(watched.address.split(":")[2].split("/")[0])
    silent = socket.create_connection(("127.0.0.1", port))
    waiting = threading.Thread(target=wait_for_nothing, args=[watched])
    waiting.start()
    time.sleep(0.3)
    code, said, seconds = watched.end()
    waiting.join(timeout=10)
    silent.close()
    tap.ok(code == 0 and said == "" and seconds < 10, "SIGTERM ends it at once, with 0 and without a word",
           (code, said, seconds))
    tap.ok(not waiting.is_alive(), "who waits is let go")
    tap.ok(not can_connect("127.0.0.1", port), "and nobody is served any more")
    write("slow.scn", SCENE.replace("colour.inc", "other.inc") + "#for (I, 1, 1e7) #declare A = sin(I); #end\n")
    slow = Watched("-W80", "-H60", "slow.scn")
    time.sleep(0.3)
    code, said, seconds = slow.end(signal.SIGINT)
    tap.ok(code == 0 and said == "" and seconds < 10, "SIGINT ends it while it reads a scene", (code, said, seconds))
    code, said, _ = Watched("--max-time=0.5", "-W80", "-H60", "slow.scn").end(0)
    tap.ok(code == 0 and said == "", "the end of --max-time, too", (code, said))
    left = Watched("-W80", "-H60", "slow.scn")
    with open(f"/proc/{left.process.pid}/task/{left.process.pid}/children", encoding="ascii") as file:
        children = file.read().split()
    left.end(signal.SIGKILL)
    end = time.monotonic() + 10
    while any(os.path.exists(f"/proc/{child}") for child in children) and time.monotonic() < end:
        time.sleep(0.05)
    tap.ok(not any(os.path.exists(f"/proc/{child}") for child in children), "when it is killed, nothing stays", children)


def test_options():
    refused = [(["scene.scn", "slow.scn"], "one scene"), (["-"], "one scene"), (["--frames=1..2", "scene.scn"], "one scene"),
               (["-o", "a.png", "scene.scn"], "writes none"), (["--crop=0,0,9,9", "scene.scn"], "writes none"),
               (["--method=forward", "scene.scn"], "samples to a goal"), (["--sampler=grid", "scene.scn"], "samples to a goal")]
    for words, why in refused:
        done = subprocess.run([RTLANG, "--watch", *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=LIMIT, check=False)
        tap.ok(done.returncode == 2 and "error[E0703]" in done.stderr and why in done.stderr and not done.stdout,
               "not with " + " ".join(words), done)
    strict = Watched("--untrusted", "--max-time=60", "-W80", "-H60", "scene.scn")
    state = strict.until(lambda now: now["state"] in ("done", "fault"))
    tap.ok(state and state["povray"]["state"] == "missing", "POV-Ray is not run on a stranger's scene", state)
    strict.end()


# ---- in a browser

def is_dark(path):
    _, _, values = pictures.read_png(path)
    return sum(values[:3]) < 384


def test_view(browser, watched, width, height, scheme, folder):
    name = f"{width} x {height}, {scheme}: "
    browser.set_view(width, height, scheme)
    browser.open(watched.address)
    tap.ok(browser.wait_for("state && state.state === 'done' && current.naturalWidth === 80"), name + "the picture is there")
    tap.ok(browser.value("document.documentElement.scrollWidth <= innerWidth"), name + "nothing stands out")
    tap.ok(browser.value("document.querySelectorAll('#plot circle').length === state.curve.length"), name + "the error is plotted")
    box = browser.value("(({x, y, width, height}) => [x, y, width, height])(current.getBoundingClientRect())")
    browser.click(box[0] + box[2] / 2, box[1] + box[3] / 2)
    tap.ok(browser.wait_for("/^Pixel (39|40), (29|30): sphere, scene.scn, line 5$/.test($('hit').textContent)") and
           browser.wait_for("$('line').textContent.startsWith('5 | sphere')"), name + "a click shows object and line",
           browser.value("$('hit').textContent + $('line').textContent"))
    tap.ok(browser.value("$('log').textContent.includes('ray 1: camera')"), name + "and the ray's log")
    path = os.path.join(folder, f"{width}-{scheme}.png")
    browser.picture(path)
    tap.ok(is_dark(path) == (scheme == "dark"), name + "it has the reader's colours")


def test_browser(watched, folder):
    if not chromium.PROGRAM:
        tap.skip("the page in a browser", "chromium is not installed")
        return
    write("scene.scn", SCENE.replace("colour.inc", "other.inc"))
    watched.until(lambda now: now["state"] == "done")
    browser = chromium.Chromium()
    try:
        for width, height in (1280, 900), (400, 800):
            for scheme in "light", "dark":
                test_view(browser, watched, width, height, scheme, folder)
        write("scene.scn", WRONG.replace("colour.inc", "other.inc"))
        tap.ok(browser.wait_for("document.querySelector('#messages .error pre')?.textContent.includes('Color } }')") and
               browser.value("$('frame').className === 'stale' && !$('frame').hidden"), "a fault is shown beside the last picture")
        tap.ok(browser.value("document.documentElement.scrollWidth <= innerWidth"), "on a narrow screen, too")
        write("scene.scn", SCENE.replace("colour.inc", "other.inc"))
        tap.ok(browser.wait_for("state.state === 'done' && $('message-card').hidden && $('frame').className === ''"),
               "and goes with the next save")
        if shutil.which("povray"):
            browser.press("p")
            tap.ok(browser.wait_for("current === images.povray && $('whose').textContent === 'POV-Ray'"), "p shows POV-Ray's picture")
            browser.press("p")
            tap.ok(browser.wait_for("current === images.own"), "and back")
            browser.press("f")
            tap.ok(browser.wait_for("current === images.own") and browser.wait_for("current === images.povray"), "f flickers")
            browser.press("f")
        else:
            tap.skip("POV-Ray's picture in the page", "povray is not installed")
        browser.press("z")
        tap.ok(browser.wait_for("$('frame').style.width === '80px'"), "z shows a dot for a pixel")
        browser.value("$('frame').focus(); setMark(40, 30)")
        browser.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowLeft", code="ArrowLeft")
        tap.ok(browser.wait_for("mark.x === 39"), "an arrow moves the mark")
        port = watched.address.split("/")[2]
        strange = [one for one in browser.requests if urllib.parse.urlsplit(one).netloc != port and not one.startswith(("data:", "about:"))]
        tap.ok(len(browser.requests) > 20 and not strange, f"of {len(browser.requests)} requests none goes elsewhere", strange)
        tap.ok(not browser.complaints, "the browser has nothing to complain of", browser.complaints)
        code, _, _ = watched.end()
        tap.ok(code == 0 and browser.wait_for("$('badge').textContent === 'rtlang has ended'"), "the page says when the program has ended")
    finally:
        browser.close()


def test_without_module():
    write("scene.scn", SCENE)
    done = subprocess.run([RTLANG, "--watch", "scene.scn"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=LIMIT, check=False)
    tap.ok(done.returncode == 3 and "error[E0514]: `--watch` cannot serve its page: this rtlang was built without it" in done.stderr,
           "a build without the module says so", done)
    tap.skip("the page of --watch", "built without libmicrohttpd")


def main():
    has_module = os.path.exists(os.path.join(os.path.dirname(RTLANG), ".libs", "rtlang_http.so"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write("colour.inc", RED)
        if not has_module:
            test_without_module()
            tap.done()
        write("scene.scn", SCENE)
        options = ["-W80", "-H60", "--target-error=0.004", "scene.scn"]
        watched = Watched(*options)
        test_served(watched)
        test_saves(watched, folder)
        test_painter(watched)
        test_end(watched)
        test_options()
        test_browser(Watched(*options), folder)
    tap.done()


if __name__ == "__main__":
    main()
