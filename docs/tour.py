#!/usr/bin/env python3
"""The tour's commands, and docs/tour.md as one HTML page that needs nothing else.

    tour.py PAGE.html

Blocks of scenes go to the files that their first lines name; then the lines that begin with `$` run in that folder, one block
after the other. The page shows what they print and holds the pictures that they draw; links to other documents become their
names. Wants RTLANG, rtcheck beside it, and python3-markdown. tests/check-tour.py uses `walk` and `html_of`.
SPDX-License-Identifier: MIT
"""
import base64
import html
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.join(HERE, "tour.md")
BLOCK = re.compile(r"^```(scn|console)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PICTURE = re.compile(r"!\[[^\]]*\]\(tour/([\w.]+)\)")
KINDS = {".png": "image/png"}

STYLE = """
:root {
  --page: #fbfaf8; --card: #fff; --text: #1d1c1a; --faint: #625e57; --line: #dcd8d0; --link: #1f5fa8; --code: #f1eee8;
  --command: #14532d;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #161719; --card: #1f2124; --text: #e8e6e2; --faint: #a8a49d; --line: #3a3d42; --link: #86b7f2; --code: #24272b;
    --command: #8fd6a8;
  }
}
* { box-sizing: border-box; }
html { scroll-padding-top: 1rem; }
body { margin: 0; background: var(--page); color: var(--text); font: 1.0625rem/1.6 system-ui, sans-serif; }
main { max-width: 52rem; margin: 0 auto; padding: 1rem; }
nav { padding: .75rem 1rem; background: var(--card); border: 1px solid var(--line); border-radius: .5rem; }
@media (min-width: 74rem) {
  main { margin-left: max(18rem, 50vw - 20rem); padding: 1.5rem 2rem; }
  nav { position: fixed; top: 1.5rem; left: max(1.5rem, 50vw - 37rem); width: 16rem; }
}
nav { font-size: .9375rem; }
nav p { margin: 0 0 .25rem; font-weight: 600; }
nav ul { margin: 0; padding: 0; list-style: none; }
nav a { display: inline-block; padding: .2rem 0; }
a { color: var(--link); }
h1 { margin: 0 0 1rem; font-size: 1.75rem; line-height: 1.25; text-wrap: balance; }
h2 { margin: 2.5rem 0 .75rem; font-size: 1.3rem; line-height: 1.3; }
p { margin: .75rem 0; }
code, pre { font: .875em/1.5 ui-monospace, "DejaVu Sans Mono", monospace; }
:not(pre) > code { padding: .1em .3em; background: var(--code); border-radius: .25rem; white-space: nowrap; }
pre { margin: .75rem 0; padding: .75rem; white-space: pre-wrap; overflow-wrap: anywhere; background: var(--code);
  border: 1px solid var(--line); border-radius: .5rem; font-size: .8125rem; }
pre code { font: inherit; }
pre span { display: block; padding-left: 4ch; text-indent: -4ch; }
pre .command { color: var(--command); font-weight: 600; }
pre i { font-style: normal; white-space: nowrap; }
pre .note { color: var(--faint); }
figure { margin: 1rem 0; }
figure img, figure svg { display: block; width: 100%; height: auto; max-width: 40rem; border: 1px solid var(--line);
  border-radius: .5rem; }
figure svg { background: var(--card); }
figure img { max-width: 30rem; }
@media (max-width: 40rem) { figure .rays text { font-size: 1.375rem; } }
figcaption { margin-top: .25rem; color: var(--faint); font-size: .875rem; }
.row { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 13rem), 1fr)); gap: 1rem; max-width: 52rem; }
.row figure { margin: 0; }
.row img { max-width: none; image-rendering: pixelated; }
:focus-visible { outline: 3px solid var(--link); outline-offset: 2px; }
@media print { nav { display: none; } figure, pre { break-inside: avoid; } }
"""
PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<main>
<h1>{title}</h1>
<nav aria-label="Contents"><p>Contents</p>{contents}</nav>
{body}
</main>
</body>
</html>
"""


def to_debians_python():
    """For which python3-markdown is installed, where another comes first."""
    if sys.executable != "/usr/bin/python3" and os.access("/usr/bin/python3", os.X_OK):
        os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)


# ---- the commands

def run(text, folder):
    """The commands of a block, each with what it prints."""
    shown = ""
    for command in re.findall(r"^\$ (.*)$", text, re.MULTILINE):
        program = os.path.abspath(os.environ["RTLANG"])
        names = "".join(f'{name}() {{ "{os.path.join(os.path.dirname(program), name)}" "$@"; }}\n' for name in ("rtlang", "rtcheck"))
        done = subprocess.run(["sh", "-c", names + command], cwd=folder,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        shown += f"$ {command}\n" + done.stdout.decode("utf-8", "replace")
    return shown


def walk(page, folder, tell=lambda text, shown: None):
    """The page with what its commands print now; `tell` hears of each block what it was and what it is."""
    def one(match):
        kind, text = match.groups()
        if kind == "scn":
            with open(os.path.join(folder, re.match(r"// (\S+)", text).group(1)), "w", encoding="ascii") as out:
                out.write(text)
            return match.group(0)
        shown = run(text, folder)
        tell(text, shown)
        return f"```{kind}\n{shown}```"
    return BLOCK.sub(one, page)


# ---- the page

def figure(words, path):
    """A picture with its words below; a drawing's own text, so that it follows the page's light or dark."""
    with open(path, "rb") as file:
        data = file.read()
    kind = os.path.splitext(path)[1]
    if kind == ".svg":
        shown = re.sub(r"<title>.*?</title>\n?", f"<title>{words}</title>", data.decode("utf-8"), flags=re.DOTALL, count=1)
        shown = shown.replace('color="black" fill="black" style="background: white"', 'color="currentColor" fill="currentColor"')
    else:
        shown = f'<img alt="" src="data:{KINDS[kind]};base64,{base64.b64encode(data).decode("ascii")}">'
    return f"<figure>{shown}<figcaption>{words}</figcaption></figure>"


def figure_of(tag, folder, head=""):
    words, name = (re.search(f'{what}="([^"]*)"', tag).group(1) for what in ("alt", "src"))
    return figure(head + words, os.path.join(folder, os.path.basename(name)))


def row(table, folder):
    """A table of pictures as figures that stand side by side where there is room, each with its column's heading."""
    heads = re.findall(r"<th>(.*?)</th>", table)
    pictures = re.findall(r"<td>(<img .*?>)</td>", table)
    shown = "".join(figure_of(picture, folder, f"<b>{head}</b>: ") for head, picture in zip(heads, pictures))
    return f'<div class="row">{shown}</div>'


def mark(match):
    """Each line of a block by itself, so that what is continued below stands further in; commands and comments."""
    lines = []
    for line in match.group(1).splitlines(keepends=True):
        kind = "command" if line.startswith("$ ") else "note" if line.startswith("//") else "line"
        if kind == "command":
            line = re.sub(r"(?<= )(-\S{,30})(?=\s)", r"<i>\1</i>", line)  # not to be continued behind its own dash
        lines.append(f'<span class="{kind}">{line}</span>')
    return "<pre><code>" + "".join(lines) + "</code></pre>"


def html_of(page, folder):
    """The page as HTML, with the pictures of that folder."""
    import markdown  # python3-markdown

    maker = markdown.Markdown(extensions=["fenced_code", "tables", "toc"], extension_configs={"toc": {"toc_depth": "2-2"}})
    body = maker.convert(page)
    body = re.sub(r'<pre><code class="language-\w+">(.*?)</code></pre>', mark, body, flags=re.DOTALL)
    body = re.sub(r"<table>.*?</table>", lambda table: row(table.group(0), folder), body, flags=re.DOTALL)
    body = re.sub(r"<p>(<img [^>]*>)</p>", lambda tag: figure_of(tag.group(1), folder), body)
    body = re.sub(r'<a href="(?!#)([^":]*)">(.*?)</a>', r"<code>docs/\1</code>", body)
    title = html.escape(re.search(r"^# (.*)$", page, re.MULTILINE).group(1))
    body = re.sub(r"<h1.*?</h1>", "", body)
    return PAGE.format(title=title, style=STYLE, contents=maker.toc, body=body)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: tour.py PAGE.html")
    to_debians_python()
    with open(SOURCE, encoding="utf-8") as file:
        page = file.read()
    with tempfile.TemporaryDirectory() as folder:
        try:
            text = html_of(walk(page, folder), folder)
        except ImportError:
            sys.exit("tour.py: wants python3-markdown (apt-get install python3-markdown)")
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
