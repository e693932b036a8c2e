"""What a test writes into a document, between the marks `<!-- MARK:begin -->` and `<!-- MARK:end -->`.

SPDX-License-Identifier: MIT
"""


def parts(path, mark):
    """The document up to the text between the marks, that text, and what is behind it."""
    begin, end = f"<!-- {mark}:begin -->\n", f"<!-- {mark}:end -->"
    with open(path, encoding="utf-8") as file:
        head, rest = file.read().split(begin)
    said, tail = rest.split(end)
    return head + begin, said, end + tail


def read(path, mark):
    return parts(path, mark)[1]


def write(path, mark, text):
    head, _, tail = parts(path, mark)
    with open(path, "w", encoding="utf-8") as file:
        file.write(head + text + tail)
