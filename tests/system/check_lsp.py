#!/usr/bin/env python3
"""rtlang --lsp, as an editor's client sees it: messages, values, definitions, words, layout, and what is broken.

Places are counted here in UTF-16, apart from the server. Prints TAP. SPDX-License-Identifier: MIT
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lsp_client  # noqa: E402
import tap  # noqa: E402
from lsp_client import Client, PROGRAM  # noqa: E402

SCENE = """#version 3.7;
global_settings { assumed_gamma 1 charset utf8 }
#include "names.inc"
#declare Size = 1.5;
#declare Size = Size * 2;
#declare Where = <1, 2, 3>;
#declare Title = "d\u00fcnn \U0001F600";
#macro Ball(P)
    sphere { P, Size }
#end
camera { location -5*z }
light_source { <5, 5, -5> rgb 1 }
Ball(Where)
sphere { 0, Far pigment { rgb 1 } }
#declare Big = Size + 1;
"""
BROKEN = "sphere { 0, 1 raduis 2 }\n/* \U0001F600 */ sphere { Nothing, 1 }\n"


def short(found):
    return [(one["range"]["start"]["line"], one["range"]["start"]["character"], one["range"]["end"]["character"], one["severity"],
             one["code"], one["message"]) for one in found["diagnostics"]]


def check_messages(report, client, uri):
    report.equal(short(client.open(uri, SCENE)), [], "a scene without faults has no messages")
    expected = [(0, 14, 20, 1, "E0250", "unknown property `raduis` in sphere"),
                (1, 18, 25, 1, "E0201", "the name `Nothing` is not declared")]
    found = [one for one in short(client.change(uri, BROKEN)) if one[3] == 1]
    report.equal(found, expected, "faults have their places, in units of UTF-16")
    found = short(client.change(uri, "camera { location -5*z }\n"))
    report.ok(found and all(one[0] == 0 and one[3] == 2 for one in found), "what belongs to no place stands in the first line", found)
    report.equal(short(client.open(uri.replace("s.scn", "part.inc"), "#declare A = 1;\n")), [], "a part of a scene need have no camera")
    report.equal(short(client.change(uri, SCENE)), [], "and the faults go")


def check_questions(report, client, uri, folder):
    def hover(word, which=0):
        found = client.at("textDocument/hover", uri, SCENE, word, which)
        return found and found["contents"]["value"]

    report.equal(hover("Size", 4), "```\n#declare Size = Size * 2;\n```\n\nSize = 3.000000", "the value of a number")
    report.equal(hover("Size", 0), "```\n#declare Size = 1.5;\n```\n\nSize = 1.500000", "which is that of its line")
    report.equal(hover("Where", 1), "```\n#declare Where = <1, 2, 3>;\n```\n\nWhere = <1.000000, 2.000000, 3.000000>", "of a vector")
    report.equal(hover("Title"), "```\n#declare Title = \"d\u00fcnn \U0001F600\";\n```\n\nTitle = \"d nn  \"",
                 "of a string, as #debug prints it")
    report.equal(hover("Ball", 1), "```\n#macro Ball(P)\n```", "the head of a macro")
    report.ok("**location** in camera: " in (hover("location") or ""), "what a word of the language is", hover("location"))
    report.equal(hover("-5"), None, "of a number there is nothing to say")

    found = client.at("textDocument/definition", uri, SCENE, "Where", 1)
    report.equal(found, {"uri": uri, "range": {"start": {"line": 5, "character": 9}, "end": {"line": 5, "character": 14}}}, "a definition")
    found = client.at("textDocument/definition", uri, SCENE, "Far")
    report.equal(found, {"uri": f"file://{folder}/names.inc", "range": {"start": {"line": 1, "character": 9}, "end": {"line": 1, "character": 12}}},
                 "in a file that is included")
    report.equal(client.at("textDocument/definition", uri, SCENE, "sphere"), None, "of a word there is none")

    found = client.at("textDocument/completion", uri, SCENE, "Size", 2)
    labels = [one["label"] for one in found["items"]]
    report.equal(labels, ["Size"], "names that begin so")
    found = client.at("textDocument/completion", uri, SCENE, "camera")
    labels = [one["label"] for one in found["items"]]
    report.ok("camera" in labels and "ceil" in labels and all(label.startswith("c") for label in labels), "words that begin so", labels)

    messy = "sphere{0,1   pigment{rgb 1}}\n"
    client.change(uri, messy)
    found = client.ask("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {}})
    with open(os.path.join(folder, "messy.scn"), "w", encoding="utf-8") as file:
        file.write(messy)
    laid_out = subprocess.run([PROGRAM, "--format", "messy.scn"], cwd=folder, stdout=subprocess.PIPE, check=True).stdout.decode()
    report.equal(found, [{"range": {"start": {"line": 0, "character": 0}, "end": {"line": 1, "character": 0}}, "newText": laid_out}],
                 "the layout is that of --format")


def check_broken(report, client, uri):
    report.equal(client.ask("textDocument/unknown", {})["code"], -32601, "an unknown method")
    client.write(b"{\"jsonrpc\": \"2.0\", ")
    report.equal(client.read()["error"]["code"], -32700, "what is not JSON")
    client.write(b"[" * 5000)
    report.equal(client.read()["error"]["code"], -32700, "what nests too deep")
    client.notify("textDocument/didChange", {"textDocument": {"uri": "file:///none"}, "contentChanges": [{"text": ""}]})
    client.notify("textDocument/didChange", {"contentChanges": []})
    report.equal(client.ask("textDocument/hover", {"textDocument": {"uri": uri}, "position": {"line": 999999, "character": 5}}), None,
                 "a place behind the end")
    report.equal(client.ask("textDocument/hover", {"textDocument": {"uri": uri}, "position": {"line": -1}}), None, "no place")
    report.equal(client.ask("textDocument/formatting", {"textDocument": {"uri": "file:///none"}}), None, "a document that is not open")
    found = short(client.change(uri, "#while (1)\n#end\n"))
    report.ok(any(one[4] == "E0604" or "steps" in one[5] or "turns" in one[5] for one in found), "a loop without an end ends", found)


def check_speed(report, client, uri):
    """bench/lsp.py holds the bar; here the machine may be busy."""
    seconds = lsp_client.seconds_of_changes(client, uri.replace("s.scn", "large.scn"), 15)
    median = statistics.median(seconds)
    print(f"# a change in a scene of 10 000 lines is answered in {1000 * median:.1f} ms at the median of {len(seconds)}")
    report.ok(median < 2.0, "a change in a scene of 10 000 lines is answered", seconds)


def main():
    report = tap.Tap()
    with tempfile.TemporaryDirectory() as folder:
        folder = os.path.realpath(folder)
        with open(os.path.join(folder, "names.inc"), "w", encoding="utf-8") as file:
            file.write("// names\n#declare Far = 6;\n")
        uri = f"file://{folder}/s.scn"
        client = Client(folder)
        found = client.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})
        report.ok(found["capabilities"]["hoverProvider"] and found["serverInfo"]["name"] == "rtlang", "the server says what it does", found)
        client.notify("initialized", {})
        check_messages(report, client, uri)
        check_questions(report, client, uri, folder)
        check_broken(report, client, uri)
        check_speed(report, client, uri)
        client.notify("textDocument/didClose", {"textDocument": {"uri": uri}})
        report.equal(client.ask("shutdown"), None, "shutdown is answered")
        client.notify("exit", None)
        report.equal((client.close(), client.process.stderr.read()), (0, b""), "and exit ends it")
        client = Client(folder)
        report.ok(client.close() != 0, "the end of the pipe without shutdown is no good end")
        done = subprocess.run([PROGRAM, "--lsp", "s.scn"], stderr=subprocess.PIPE, check=False)
        report.ok(done.returncode == 2 and b"`--lsp` wants no scene" in done.stderr, "a scene on the command line", done.stderr)
    report.done()


main()
