# A client of rtlang --lsp: what an editor writes, and what it reads. Knows nothing of what is tested.
#
# SPDX-License-Identifier: MIT
import json
import os
import statistics
import subprocess
import time

PROGRAM = os.path.abspath(os.environ.get("RTLANG", "./rtlang"))


class Client:
    def __init__(self, folder, *options):
        self.process = subprocess.Popen([PROGRAM, "--lsp", *options], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE)
        self.count = 0

    def write(self, body):
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self.process.stdin.flush()

    def read(self):
        length = 0
        while True:
            line = self.process.stdout.readline()
            if line in (b"\r\n", b""):
                break
            length = int(line.split(b":")[1])
        return json.loads(self.process.stdout.read(length))

    def notify(self, method, params):
        self.write(json.dumps({"jsonrpc": "2.0", "method": method, "params": params}).encode())

    def ask(self, method, params=None):
        self.count += 1
        self.write(json.dumps({"jsonrpc": "2.0", "id": self.count, "method": method, "params": params}).encode())
        found = self.read()
        assert found["id"] == self.count, found
        return found.get("result") if "result" in found else found["error"]

    def open(self, uri, text):
        self.notify("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "rtlang", "version": 1, "text": text}})
        return self.read()["params"]

    def change(self, uri, text):
        self.notify("textDocument/didChange", {"textDocument": {"uri": uri, "version": 2}, "contentChanges": [{"text": text}]})
        return self.read()["params"]

    def at(self, method, uri, text, word, which=0):
        """Asks about a word's place in a text."""
        begin = -1
        for _ in range(which + 1):
            begin = text.index(word, begin + 1)
        line = text.count("\n", 0, begin)
        before = text[text.rfind("\n", 0, begin) + 1:begin]
        position = {"line": line, "character": len(before.encode("utf-16-le")) // 2 + 1}
        return self.ask(method, {"textDocument": {"uri": uri}, "position": position})

    def close(self):
        self.process.stdin.close()
        return self.process.wait(timeout=60)


def seconds_of_changes(client, uri, count):
    """How long each of so many changes in a scene of 10 000 lines takes until its messages are there."""
    lines = ["#version 3.7;", "global_settings { assumed_gamma 1 }", "camera { location -9*z }", "light_source { -9*z rgb 1 }"]
    lines += [f"sphere {{ <{i % 100}, {i // 100}, 0>, 0.4 pigment {{ rgb <{i % 7 / 7:.3f}, 0.5, 0.2> }} }}" for i in range(9996)]
    client.open(uri, "\n".join(lines))
    seconds = []
    for i in range(count):
        lines[5000] = f"sphere {{ <0, 0, {i}>, 0.4 }}"
        begin = time.monotonic()
        client.change(uri, "\n".join(lines))
        seconds.append(time.monotonic() - begin)
    return sorted(seconds)
