#!/usr/bin/env python3
"""Writes dictionaries for fuzzers, text.dict and ini.dict, into FOLDER: the words of the language, from its table and
the printed schema, its marks, and POV-Ray's options.

Usage: make_dictionary.py TOP FOLDER < SCHEMA, with what tests/unit/print_schema prints. SPDX-License-Identifier: MIT
"""
import os
import re
import sys

MARKS = ["{", "}", "<", ">", "[", "]", "(", ")", ",", ";", "=", "!=", "<=", ">=", "&", "|", "!", "?", ":", "/*", "*/",
         "//", '\\"', "1e300", "-1", "0.5", "1e-9", "sphere { 0, 1 ", "#declare A = ", "#end ", "pigment { rgb 1 }"]
DIRECTIVES = ["case", "debug", "declare", "default", "else", "elseif", "end", "error", "fclose", "fopen", "for", "if",
              "ifdef", "ifndef", "include", "local", "macro", "range", "read", "render", "statistics", "switch",
              "undef", "version", "warning", "while", "write", "break"]


def read(top, *names):
    with open(os.path.join(top, *names), encoding="utf-8") as file:
        return file.read()


def write(folder, name, entries):
    with open(os.path.join(folder, name), "w", encoding="ascii") as file:
        file.writelines('"%s"\n' % entry for entry in dict.fromkeys(entries))


def main():
    top, folder = sys.argv[1:3]
    words = re.findall(r"^WORD\((\w+),", read(top, "src", "ast", "words.def"), re.MULTILINE)
    schema = re.findall(r"`([a-z_0-9 ]+)`", sys.stdin.read())
    write(folder, "text.dict", words + schema + ["#" + word for word in DIRECTIVES] + MARKS)
    rows = re.findall(r'^    ([A-Z_]+)\("(\w+)"(?:, "(\w+)")?', read(top, "src", "cli", "povray_table.c"), re.MULTILINE)
    write(folder, "ini.dict", [key + "=" for _, key, _ in rows] + ["+" + letters for _, _, letters in rows if letters] +
          ["=On", "=Off", "[", "]", ";", "\\x00", '\\"', ".ini"])


main()
