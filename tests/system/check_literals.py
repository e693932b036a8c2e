#!/usr/bin/env python3
"""Statements that follow a plan, by their text alone or again and again in a loop or macro, give what they give the usual
way: random texts of shapes and calls, each read in both ways, with files of numbers that they read.

Usage: check_literals.py [COUNT [SEED]]   Prints TAP, a line for each batch of texts; `check_literals.py -SEED` prints one,
and writes the files that it reads.
The scene's dump, every message with its place, and the exit code must be the same. SPDX-License-Identifier: MIT
"""
import concurrent.futures
import os
import random
import re
import subprocess
import sys
import tempfile

COUNT, SEED, BATCH = 400, 1, 50
# What makes a text faulty; one in two has none of it.
FAULTY = {"#macro D(A) box { A, 2 #end", "#undef E", "#declare C = 5;", "#macro E(A) sphere { A, 1 } #end", "<1, 2>", " + 1", ".x", "*2", ", ",
          "<{c}>", "finish { phnog 1 }", "finish { diffuse -1 }", "torus", "3", "alpha 1", "srgb <{c}>", "}", ";", ",", "}\n", "#end",
          "sphere", "5", "sphere { <1, 2, 3", "union { sphere { 0, 1 } ", "0", "-1", "", ",,", "interior { ior 1.5 }",
          "clipped_by { plane { y, 9 } }", "scale 1 > {m}", "translate {m},", "matrix {m}", "translate -{m}",
          "translate <{m}, 1>",
          "matrix <1, 0, 0, 0, 1, 0, 0, 0, 0, {m3}>", "matrix <{m12}>"}
# What stands before the properties of a shape: vectors and numbers.
SHAPES = {"sphere": ["vn"], "box": ["vv"], "cylinder": ["vvn"], "cone": ["vnvn"], "disc": ["vvn", "vvnn"], "triangle": ["vvv"],
          "smooth_triangle": ["vvvvvv"], "plane": ["vn"]}
CALLS = """#macro C(A, B) sphere { A, B pigment { rgb A/9 } } #end
#macro D(X, Y, Z, R) cylinder { <X, Y, Z>, <Z, X, Y>, R pigment { rgb <0.5, X/9, 1> } finish { phong 0.5 } } box { X, <Y, Z, R> } #end
#macro E(A) #debug str(A, 0, 2) #if (A > 1) triangle { A*x, A*y, A*z } #end #end
"""
SCANNER_BLOCK = 256 * 1024
DATA_BLOCK = 64 * 1024
# What a turn of a loop over a file tells of what it has read; nothing, most of the time.
SHOWN = ["", "", "", "#debug concat(str(X, 0, 3), \"\\n\")", "#debug concat(str(defined(F), 0, 0), str(Y, 0, -1), \"\\n\")"]


class Text:
    """Statements of which most are literal spheres of few kinds, and some are nearly so."""

    def __init__(self, seed):
        self.dice = random.Random(seed)
        self.is_sane = self.dice.random() < 0.5
        self.kinds = [(self.head(), self.rest()) for _ in range(self.dice.randrange(1, 6))]
        self.calls = self.dice.choice([0, 0.1, 0.5])  # their share among statements
        self.files = {}  # name -> what #read finds there

    def pick(self, *choices):
        sane = [choice for choice in choices if choice not in FAULTY]
        return self.dice.choice(sane if self.is_sane and sane else choices)

    def number(self):
        dice = self.dice
        return dice.choice([
            lambda: f"{dice.uniform(-5, 5):.{dice.randrange(1, 8)}f}", lambda: str(dice.randrange(-3, 9)),
            lambda: f"{dice.uniform(-1, 1)!r}", lambda: f"{dice.uniform(0, 9):.3e}", lambda: f"{dice.randrange(9)}.",
            lambda: f"-0.{dice.randrange(10)}"])()

    def odd_number(self):
        if self.is_sane:
            return self.pick(".5", "-.25", "+1", "- 2", "1e", "-0", "1e5", "pi", "(1)", "9" * 30, "0." + "3" * 240, "1e-400")
        return self.pick(".5", "-.25", "+1", "- 2", "1e", "1e400", "1.2.3", "2x", "0x10", "1e-400", "-0", "--1", "pi", "1/0",
                         "9" * 30, "0." + "3" * 260, "1" * 256, "(1)", "1 .x", "clock", "A", "x", "\"1\"", "1e5", "5 .5")

    def numbers(self, count, odd=0.0):
        blank = self.pick("", " ", "  ", "\n", "\t")
        return f",{blank}".join(self.odd_number() if self.dice.random() < odd else self.number() for _ in range(count))

    def colour(self):
        return self.pick("color rgb <{c}>", "rgb <{c}>", "colour rgb <{c}>", "rgb <{c}> transmit 0.25", "rgb<{c}>",
                         "rgbf <{c4}>", "rgbt <{c4}>", "rgbft <{c5}>", "rgb <{c}> filter 0.1 transmit .2", "rgb 0.5",
                         "rgb <{c}> red 1", "rgb <0.5, 0, 0> red 0.5", "srgb <{c}>", "<{c}>", "Red", "rgb <{c}> * 2",
                         "color red 1 green 0.5", "rgb <{c4}>", "checker rgb <{c}> rgb 1")

    def rest(self):
        """What follows the radius; {c} are the numbers of a colour."""
        finish = self.pick("finish { ambient 0.1 diffuse 0.7 phong 0.3 phong_size 20 }", "finish { phong 1 reflection 0.1 }",
                           "finish { ambient rgb <0.1, 0.2, 0.3> }", "finish{}", "", "", "finish { diffuse -1 }",
                           "finish { phnog 1 }", "finish { Shiny }", "finish { reflection { 0.1, 0.4 fresnel on } }")
        pigment = f"pigment {{ {self.colour()} }}"
        body = self.pick(f"{pigment} {finish}", f"texture {{ {pigment} {finish} }}", pigment, finish,
                         f"texture {{ {pigment} }} {finish}", f"{pigment} {pigment}", f"texture {{ T }} {pigment}")
        more = self.pick(*[""] * 8, "translate x", "scale 2", "rotate 90*y", "no_shadow", "interior { ior 1.5 }", "hollow",
                         "inverse", "rotate 0", "translate <0, 0, 0>", "// why\n", "/* no */", "clipped_by { plane { y, 9 } }",
                         "#debug \"within\\n\"", "M()", "torus", "texture { pigment { rgbt <1, 1, 1, 0.5> } }", "3", "alpha 1")
        parts = [self.pick(body, body, body, body + ' ' + more)]
        for _ in range(self.pick(0, 0, 1, 1, 2, 2, 3, 5)):
            parts.insert(self.dice.randrange(len(parts) + 1), self.move())
        return f"{self.pick(' ', '  ', chr(10))}{' '.join(parts)} }}"

    def move(self):
        """A transform; {m}, {m3} and {m12} are its numbers."""
        return self.pick("translate <{m3}>", "translate<{m3}>", "scale <{m3}>", "rotate <{m3}>", "scale {m}",
                         "translate {m}", "matrix <{m12}>", "rotate {m}*y", "scale <1,2,1>", "scale 0",
                         "scale <1, 0, {m}>", "translate {m} + 1", "translate <{m3}> * 2", "translate -{m}",
                         "scale <{m3}> / 2", "translate <{m}, 1>", "translate {m},",
                         "matrix <1, 0, 0, 0, 1, 0, 0, 0, 0, {m3}>", "rotate {m}", "scale 1 > {m}", "matrix {m}")

    def head(self):
        kind = self.dice.choice(["sphere", "sphere", *SHAPES])
        return kind, self.dice.choice(SHAPES[kind])

    def vector(self, odd):
        return f"<{self.numbers(3, odd / 8)}>" if self.dice.random() > odd / 8 else \
            self.pick("0", ".5", "-2", "<1, 2>", "<1 2 3>", "x", "<1, 2, 3>", "<0, 0, 0>")

    def size(self, odd):
        return self.pick("0", "-1", "1e-320", self.odd_number()) if self.dice.random() < odd / 4 else \
            f"{self.dice.uniform(0.01, 3):.6f}"

    def shape(self, odd):
        is_known = self.dice.random() > odd
        (kind, arguments), rest = self.dice.choice(self.kinds) if is_known else (self.head(), self.rest())
        for gap, count in ("{m12}", 12), ("{m3}", 3), ("{m}", 1), ("{c5}", 5), ("{c4}", 4), ("{c}", 3):
            rest = rest.replace(gap, self.numbers(count, odd / 4))
        head = ""
        for i, argument in enumerate(arguments):
            between = ", " if self.dice.random() > odd / 8 else self.pick(" ", ",", ",,", "")
            head += (between if i else "") + (self.vector(odd) if argument == "v" else self.size(odd))
        flag = " open" if kind in ("cylinder", "cone") and self.dice.random() < odd else ""
        return f"{kind} {{{self.pick('', ' ', chr(10))}{head}{flag}{rest}"

    def call(self, odd):
        """A call of a macro, most of the time with numbers for its arguments."""
        arguments = {"C": "vn", "D": "nnnn", "E": "n"}
        name = self.dice.choice(sorted(arguments))
        given = [self.vector(odd) if argument == "v" else self.size(odd) for argument in arguments[name]]
        if self.dice.random() < odd / 4:
            given.append(self.pick("1", "A", "x", "(2)", "rgb <1, 0.5, 0>"))
        if self.dice.random() < odd / 4:
            given[self.dice.randrange(len(given))] = self.pick("A", "(1)", "rand(S)", "V", "2*0.5", "1 + 1")
        after = self.pick(" + 1", ".x", ";", "*2", ", ", "// so", "#declare I = 3;") if self.dice.random() < odd / 2 else ""
        return f"{name}({', '.join(given)}){after}"

    def statement(self, odd):
        return self.call(odd) if self.dice.random() < self.calls else self.shape(odd)

    def other(self):
        return self.pick("#default { pigment { rgb <1, 0, 0> } }", "#default { finish { ambient 0.5 } }", "#declare A = 1.5;",
                         "box { 0, 1 }", "#macro M() scale 2 #end", "plane { y, -1 }", "// sphere { <1, 2, 3>, 1 }",
                         "#declare Red = rgb <1, 0, 0>;", "#declare Shiny = finish { phong 1 }", "union { sphere { 0, 1 } ",
                         "light_source { 9, 1 }", "#version 3.6;", "global_settings { assumed_gamma 1 }", ";", ",", "}", "sphere",
                         "#if (A) sphere { <0, 0, 0>, 1 } #end", "#declare T = texture { pigment { rgb 1 } }", "}\n", "#end", "5",
                         "#for (I, 1, 3) sphere { I*x, 1 } #end", "#macro E(A) sphere { A, 1 } #end", "#declare C = 5;",
                         "#macro D(A) box { A, 2 #end", "#undef E", "/* " + "x" * 300 + " */", "sphere { <1, 2, 3", "#local A = 2;")

    def datum(self, odd):
        if self.dice.random() < odd:
            return self.pick(self.odd_number(), "+ 1", "-/* so */2", "<1, 2>", "<1 2 3>", "<1, 2, 3,>", "<1,2,3,4,5>", "\"text\"", "5 6", "x", "", "#",
                             "1\x1a", "1\v", "<1,2,", "1e", "- -1", "3.4.5", "1" * 300, "<" + " " * 700 + "1, 2, 3>")
        return self.pick(self.number(), self.number(), self.number(), f"<{self.numbers(3)}>" if self.dice.random() < 0.2 else self.number())

    def data(self, odd):
        """A file of numbers, most of them with commas, some longer than what is read at a time."""
        blank = self.pick(" ", "", "\n", "\t ", " // why\n", "\r\n")
        text = "".join(f"{self.datum(odd)}{self.pick(',', ',') if self.dice.random() > odd / 8 else self.pick('', ' ', ',,')}{blank}"
                       for _ in range(self.dice.choice([0, 1, 3, 8, 40, 200])))
        text = text.rstrip(" ,\n") if self.dice.random() < 0.3 else text
        if text and self.dice.random() < 0.1:
            text = "/*" + "-" * (DATA_BLOCK - self.dice.randrange(700)) + "*/" + text
        name = f"d{len(self.files)}.txt"
        self.files[name] = text
        return name

    def reading(self, odd):
        """A loop over a file."""
        targets = self.pick("X", "X, Y", "X, Y, Z, R", "V, R", "X, X", "A0[1], X", "A0[0], A0[X]")
        body = f"#read (F, {targets}) {self.dice.choice(SHOWN)}\n{self.loop_body(odd)}"
        again = f"#fopen F \"{self.data(odd)}\" read #declare X = 0; #declare Y = 1; #declare Z = 2; #declare R = 0.5; #declare A0 = array[3] {{1, 2, 0}};\n"
        return again + self.pick(f"#while (defined(F)) {body} #end", f"#for (I, 1, 3) #ifdef (F) {body} #end #end #ifdef (F) #fclose F #end",
                                 f"#macro B(P, Q) sphere {{ P, Q pigment {{ rgb <X, 0, Q>*0.1 }} }} #end #while (defined(F)) #read (F, X, Y) B(<X, Y, X>, abs(Y) + 0.1) #end",
                                 f"#declare N = 0; #while (defined(F) & N < 7) {body} #declare N = N + 1; #end #fclose F")

    def expression(self, number):
        return self.pick(number, "rand(S)", "I", "I*0.5 + 1", "-I", "V.x", "max(I, 2)", "1/(I + 1)", "2*rand(S) - 1", "vlength(V)", "W[I]", "W[mod(I, 2)]",
                         "mod(I, 3)", "pow(I, 2)", "sqrt(I)", "(I > 2)", "(I = 2)", "(I != 1)*2", "int(I/2)", "sin(I)", "2*pi", "defined(I)", "div(7, I)", "min(I, 3, V.y)",
                         "atan2(I, 2)", "abs(-I)", "W[rand(S)*3]", "P[1].y", "(I >= 3 & I < 5)", "rand(S) + vlength(V)", "+I", "!I", "x.x",
                         *([] if self.is_sane else ["1/(I - 2)", "V", "A", "M()", "Red", "I*1e200*1e200", "N", "W[I*2]", "sqrt(2 - I)", "acosh(I - 2)",
                                                    "(I = 1 + 3e-10)", "W", "pow(0, I - 3)", "I = 2", "sin(I = 2)", "max(I < 2, 1)", "V.w", "P[I]", "rand(99)"]))

    def loop_body(self, odd):
        body = "\n".join(self.shape(odd) for _ in range(self.dice.randrange(1, 4)))
        body = re.sub(r"(?<=[<,\s{])-?\d+\.\d+(?=[,>])", lambda found: self.expression(found[0]), body)
        return re.sub(r"(?<={)<[^<>]*>(?=,)", lambda found: self.pick(found[0], found[0], "V", "I*x + V", "rand(S)*y", "P[1]", "-V", "V*<1, 2, I>", "2*P[I - 1]", "I*z/2"), body)

    def loop(self, odd):
        """Spheres that a loop or a macro places again and again."""
        body = self.loop_body(odd)
        return self.pick(f"#for (I, 1, 5) {body} #end", f"#declare I = 0; #while (I < 4) {body} #declare I = I + 1; #end",
                         f"#macro B(I) {body} #end B(1) B(2) B(3) B(rand(S)) B(5)",
                         f"#macro B(I, V) {body} #declare I = I + 1; #end #declare K = 1; B(K, V) B(K, <1, K, 2>) B((K), -x) B(K + 1, P[0]) B(W[1], P[1]) B(pi, 3*<1, 2, K>)",
                         f"#macro B(I) #local J = I*2; #declare I = J + 0.5; {body} #end #declare K = 1; #while (K < 20) B(K) B(W[1]) #end",
                         f"#macro B(J) #local I = I + J; {body} #end #declare I = 1; B(1) B(I) B(2) B(I)",
                         f"#declare I = 3; #while (I > 0.5) {body} #local I = I - 0.5; #end",
                         f"#for (I, 1, 6) {body} #if (I = 4) #default {{ finish {{ ambient 0.3 }} }} #end #end",
                         f"#for (I, 1, 5) {body} #declare V = <I, 1, rand(S)>; #end")

    def write(self):
        odd = self.pick(0.0, 0.05, 0.05, 0.4)
        text = self.pick("0" if self.is_sane else "", "#declare A = 1; #declare Red = rgb x; #declare Shiny = finish { phong 1 }\n"
                             "#declare T = texture { pigment { rgb 1 } } #macro M() scale 2 #end\n")
        text += CALLS + "#declare S = seed(5); #declare V = <1, 2, 3>; #declare W = array[7] {0, 1, 2.5, 3, -4, 5, 6}; #declare P = array[2] {<1, 2, 3>, <0, 0, 4>};\n"
        if self.dice.random() < 0.05:  # statements across the end of the scanner's block
            text += "// " + "-" * (SCANNER_BLOCK - len(text) - self.dice.randrange(600)) + "\n"
        for _ in range(self.dice.randrange(1, 60)):
            text += (self.other() if self.dice.random() < odd else self.loop(odd) if self.dice.random() < 0.05 else
                     self.reading(odd) if self.dice.random() < 0.03 else self.statement(odd)) + self.pick("\n", "\n", " ", "", "\r\n\n")
        return text


def read(folder, name, *options):
    done = subprocess.run([os.environ["RTLANG"], "-Wall", "--dump=scene", "--max-steps=2000", *options, name], cwd=folder, check=False,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return done.returncode, done.stdout, done.stderr


def compare(seeds):
    """The seeds of texts that are not read alike, and how many were read without a fault."""
    wrong, fine = [], 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in seeds:
            name, text = "text.scn", Text(seed)
            for path, content in {name: text.write(), **text.files}.items():
                with open(os.path.join(folder, path), "w", encoding="latin-1", newline="") as file:
                    file.write(content)
            by_text, by_parser = read(folder, name), read(folder, name, "--no-literals")
            fine += by_parser[0] == 0
            wrong += [seed] if by_text != by_parser else []
    return wrong, fine


def main():
    if sys.argv[1:] and sys.argv[1].startswith("-"):
        text = Text(int(sys.argv[1][1:]))
        sys.stdout.write(text.write())
        for name, content in text.files.items():
            with open(name, "w", encoding="latin-1", newline="") as file:
                file.write(content)
        return 0
    count, seed = (int(argument) for argument in (sys.argv[1:] + [COUNT, SEED][len(sys.argv) - 1:])[:2])
    seeds = list(range(seed * 1000000, seed * 1000000 + count))
    batches = [seeds[i:i + BATCH] for i in range(0, count, BATCH)]
    failed = total = 0
    print(f"1..{len(batches) + 1}\n# seed {seed}")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for number, (batch, (wrong, fine)) in enumerate(zip(batches, pool.map(compare, batches)), 1):
            failed += bool(wrong)
            total += fine
            print(f"{'not ok' if wrong else 'ok'} {number} - texts {batch[0]} to {batch[-1]}, {fine} without a fault", flush=True)
            for which in wrong:
                print(f"# check_literals.py -{which}")
    few = total < count // 4
    failed += few
    print(f"{'not ok' if few else 'ok'} {len(batches) + 1} - one text in four has no fault")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
