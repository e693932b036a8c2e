#!/usr/bin/env python3
"""Tests draw their random numbers in an order that the language fixes, so that a seed means the same with any compiler.

C leaves open in which order the arguments of a call, the operands of an operator and the values of an initialiser are
computed: where two of them draw, each is to be a statement of its own. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import sys

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests/system"))
sys.dont_write_bytecode = True
from tap import Tap  # noqa: E402

SOURCES = ["src/math/random.h", "src/study/*.[ch]", "tests/*/*.[ch]"]
NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\])+\'|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', re.S | re.M)
TOKEN = re.compile(r"\w+|\|\||&&|\s*\{|[^\s\w]")
# What is computed before what comes after it.
SEQUENCED = {"&&", "||", "?", ":", ";"}
STREAMS = {"random", "seed", "rays"}


def blank(found):
    return re.sub(r"[^\n]", " ", found.group())


class Faults:
    """The lines of a text in which two draws have no order."""

    def __init__(self, text):
        self.text = NOISE.sub(blank, text)
        self.tokens = [(found.group(), found.start()) for found in TOKEN.finditer(self.text)]
        self.at, self.lines = 0, set()
        self.group(None, True)

    def group(self, closer, is_block):
        """Up to the closer; whether something in it draws."""
        draws, segment = False, 0
        while self.at < len(self.tokens) and self.tokens[self.at][0].strip() != closer:
            token, place = self.tokens[self.at]
            opener = token.strip()
            if opener in ("(", "[", "{"):
                # A block comes after a space, and the braces of a compound literal do not.
                opens_block = opener == "{" and token != "{" and not self.is_value()
                self.at += 1
                is_draw = opener == "(" and self.is_stream()
                inner = self.group({"(": ")", "[": "]", "{": "}"}[opener], opens_block) or is_draw
                segment = 0 if opens_block else segment + inner
                draws = draws or inner
            elif token in SEQUENCED or (token == "," and is_block):
                segment = 0
            if segment > 1:
                self.lines.add(self.text.count("\n", 0, place) + 1)
            self.at += 1
        return draws

    def is_value(self):
        """Whether what opens here is an initialiser."""
        return self.at > 0 and self.tokens[self.at - 1][0].strip() in {"=", ",", "{", "("}

    def is_stream(self):
        """Whether the first argument is a stream of random numbers."""
        words = [token for token, _ in self.tokens[self.at:self.at + 3]] + [""] * 3
        words = words[1:] if words[0] == "&" else words
        return words[0] in STREAMS and words[1] in (",", ")")


def main():
    tap = Tap()
    for pattern in SOURCES:
        for path in sorted(glob.glob(os.path.join(TOP, pattern))):
            with open(path, encoding="utf-8") as file:
                faults = Faults(file.read()).lines
            tap.ok(not faults, f"{os.path.relpath(path, TOP)}: no two draws in one expression",
                   "".join(f"line {line}\n" for line in sorted(faults)))
    tap.done()


main()
