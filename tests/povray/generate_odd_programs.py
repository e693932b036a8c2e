#!/usr/bin/env python3
"""Writes short programs from where the language is odd, which POV-Ray may take or refuse.

Loops and chains of numbers in the bodies of functions, indices that are not whole, scopes of macros and includes, splines of few points, strings
with characters 0 and 10, infinities, vectors of different lengths, versions, semicolons in the text of macros, arguments by
reference and from directives, colours, arrays of arrays, data files, functions of blocks. Most programs are then torn, a piece of a
statement standing in a directive, a macro or an included file, or get a near miss: a token more, less or in another place.

The same seed gives the same program. Usage: generate_odd_programs.py SEED   Prints one. SPDX-License-Identifier: MIT
"""
import random
import re
import sys

NUMBERS = ["0", "1", "2", "3", ".5", "-1", "2.5", "-.25", "7", "10", "1/3"]
NEARLY = ["1e-10", "-1e-10", "1e-11", "-1e-11", "9e-11", "-9e-11", "2e-10", "-2e-10", ".5", "-.5", ".999999", "0"]
VECTORS = ["<1, 2, 3>", "<-1, .5>", "<4, 5, 6, 7>", "<1, 2, 3, 4, 5>", "x", "y", "z", "<0, 1, 0>", "<3, 1>", "u", "v",
           "2*z", "<2, 3, 5>"]
TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|#\s*\w+|\d+\.?\d*(?:e[-+]?\d+)?|\.\d+(?:e[-+]?\d+)?|\w+|[<>!]=|\S')
SPLINES = ["linear_spline", "cubic_spline", "natural_spline", "quadratic_spline"]
SHAPES = ["sphere { 0, 1 }", "box { -1, <1, 2, 3> }", "sphere { x, .5 translate y }", "box { <0, 0, 0>, <1, 1, 1> }"]
NOT_CODE = ["don't", "}", ")", "> < ,", "@ ~ $", "1 2 3", "#foo", "sphere {", "' \\ `", "union", "0x10", "# not a word"]
STRAY = [";", ",", "(", ")", "{", "}", "<", ">", "1", "-", "+", "x", "#end", "#else", "A", "=", "[", "]", ".", "*", "!",
         "\"s\"", "rgb", "0", "#break", "&", "?", ":", "N1", "V1", "#local", "#debug", "sphere", "#if(1)", "#declare"]


class OddProgram:
    """`statements` are pieces of text that can be dropped one by one; `files` what is included."""

    def __init__(self, seed):
        self.dice = random.Random(seed)
        self.count, self.lines = 10, 0
        self.knows_chains = False
        self.statements, self.files = [], {}

    # ---- small things

    def one(self, *choices):
        return self.dice.choice(choices)

    def chance(self, share):
        return self.dice.random() < share

    def name(self, hint):
        self.count += 1
        return f"{hint}{self.count}"

    def number(self):
        return self.one(self.dice.choice(NUMBERS), self.dice.choice(NUMBERS), "N1", "N2", "A1[1]", "V1.y", "V2.x",
                        "(N1 + N2)", "F1(2)", "M1(3)", "C1.green", "W1.t", "(A1[2])", "int(N2)", "vdot(V1, x)")

    def vector(self):
        return self.one(self.dice.choice(VECTORS), self.dice.choice(VECTORS), "V1", "V2", "W1", "C1", "V1*2", "G1(.5)", "B1[0]",
                        f"<{self.number()}, {self.number()}>", f"<{self.number()}, {self.number()}, {self.number()}>")

    def add(self, *texts):
        self.statements += texts

    def shown(self, number, digits=9):
        self.lines += 1
        return f'#debug concat("{self.lines}: ", str({number}, 0, {digits}), "\\n")'

    def shown_vector(self, vector, count=3):
        self.lines += 1
        return f'#debug concat("{self.lines}: ", vstr({count}, {vector}, " ", 0, 6), "\\n")'

    def shown_string(self, string):
        self.lines += 1
        return f'#debug concat("{self.lines}: ", {string}, "\\n")'

    def show(self, number):
        self.add(self.shown(number))

    def show_vector(self, vector, count=3):
        self.add(self.shown_vector(vector, count))

    def defined_names(self):
        self.add("#declare N1 = 3;", "#declare N2 = -.5;", "#declare V1 = <1, 2, 3>;", "#declare V2 = <4, -5>;",
                 "#declare W1 = <1, 2, 3, 4>;", "#declare C1 = rgb <.25, .5, .75>;",
                 "#declare A1 = array[5] { 1, 10, 100, 1000, 10000 };", "#declare B1 = array[2] { <1, 2, 3>, <4, 5, 6> };",
                 "#declare F1 = function(x) { x*x + 1 }", "#macro M1(P) (P*2) #end", '#declare S1 = "abc";',
                 "#declare G1 = spline { 0, <1, 2, 3> 1, <4, 4, 4> }", "#declare O1 = sphere { 0, 1 }")

    # ---- loops in functions

    def term(self, i, x):
        return self.one(f"{i}*{x}", f"pow({x}, {i})", f"A1[{i}]*{x}", f"sin({i}*{x})", f"F1({i}*{x})", f"{i}",
                        f"sum(i, 1, {i}, i*{x})", f"select({x} - {i}, {i}, 2, 3)", f"prod(k, 1, {i} + 1, k + {x})",
                        f"max({i}, {x})", f"({x} > {i})", f"{i}/2*{x}*{x}", f"N1*{i}", f"V1.y*{i}", f"A1[{i} + 1]",
                        f"atan2({i}, {x} + 9)", f"mod({x}, {i} + 1)")

    def loop(self, x, depth=0):
        i, local = self.name("I"), self.name("L")
        inner = self.one(f"+ {self.term(i, x)}", f"+ {self.term(i, x)}", f"+ {self.term(i, x)} - {i}",
                         f"#if ({i} = 2) - {self.term(i, x)} #else + {self.term(i, x)} #end",
                         f"#local {local} = {i}*2; + {local}*{x} #local {local} = {local} + 1; + {local}",
                         f"#declare {local} = {i}; + {self.term(local, x)}",
                         f"+ {self.term(i, x)} {self.loop(x, 1) if depth == 0 else ''}")
        if self.chance(.3):
            return f"#local {i} = 0; #while ({i} < {self.dice.randrange(4)}) {inner} #local {i} = {i} + 1; #end"
        return f"#for ({i}, {self.one('0', '1')}, {self.dice.randrange(1, 4)}{self.one('', '', ', 1', ', .5')}) {inner} #end"

    def function_of_loops(self):
        f = self.name("F")
        x, head = self.one(("x", "(x)"), ("a", "(a)"), ("x", "(x, y)"), ("x", ""), ("z", "(z)"))
        count = head.count(",") + 1 if head else 3
        body = self.one(f"0 {self.loop(x)}", f"{self.number()} {self.loop(x)}", f"({x} {self.loop(x)})*2", f"1 {self.loop(x)}",
                        f"abs(0 {self.loop(x)}) + {x}", f"0 {self.loop(x)} {self.loop(x)}", f"max({x}, 0 {self.loop(x)})")
        if self.chance(.35):
            maker, n = self.name("M"), self.name("Q")
            body = body if self.chance(.3) else f"0 #for (J, 1, {n}) + {self.term('J', x)} + {n} #end"
            self.add(f"#macro {maker}({n}) function{head} {{ {body} }} #end", f"#declare {f} = {maker}({self.dice.randrange(4)})")
        else:
            self.add(f"#declare {f} = function{head} {{ {body} }}")
        for _ in range(2):
            self.show(f"{f}({', '.join(self.one('1', '2', '.5', '-3', 'N1') for _ in range(count))})")

    # ---- chains of operators in functions, whose numbers POV-Ray joins

    def chain(self, operators, depth=2):
        def part():
            inner = self.chain(operators, depth - 1) if depth > 0 and self.chance(.35) else self.one("b", "3", ".7", "a*2")
            call = self.one("sin({0})", "abs({0})", "max({0}, a)", "min(b, {0})", "pow(2, {0})", "select({0}, a, 5)", "F1({0})",
                            "F2({0}, {0})", "mod({0}, 7)", "atan2({0}, 3)", "sum(i, 1, 2, i + {0})", "T1({0}, 1, 2).x", "({0})", "({0})")
            if "<" in operators:
                inner = f"({inner})"  # among arguments it must have its own
            number = self.one("3", "2", ".1", "7", "11", "pi", "N1", "N2", "A1[1]", ".3", "10", "5")
            return self.one("", "", "", "", "", "", "-", "+") + self.one("a", "b", number, number, number, number, f"({number})",
                                                                        call.format(inner))

        text = part()
        for _ in range(self.one(1, 2, 2, 3, 4)):
            text += f" {self.one(*operators)} {part()}"
        return text

    def function_of_chains(self):
        f = self.name("F")
        if not self.knows_chains:
            self.knows_chains = True
            self.add("#declare F2 = function(x, y) { x*2 + y }", "#declare T1 = function { transform { scale 2 } }")
        for _ in range(4):
            operators = self.one(("*", "/"), ("+", "-"), ("+", "-", "*", "/"), ("+", "-", "-", "*"), ("<", ">=", "=", "!=", "+", "-", "*", "&", "|"))
            text = self.chain(operators)
            self.add(f"#declare {f} = function(a, b) {{ {text} }}")
            for at in ("1.25, .7", "-3, 2"):
                self.add(self.shown(f"min(max({f}({at}), -1e6), 1e6)", 12))
            f = self.name("F")

    # ---- numbers that are nearly whole

    def nearly(self):
        base = self.one("0", "1", "2", "3", "4", "5", "-1", "N1")
        return self.one(f"{base} + {self.dice.choice(NEARLY)}", f"{base} + {self.dice.choice(NEARLY)}", ".1*30", ".6/.2", ".7/.1",
                        f"{base}", "1 - 1e-10", "3 - 1e-11", "-1e-11", "-.5", "1/3*3", ".3/.1", "(.1 + .2)*10", "1.15*100 - 112")

    def inexact(self):
        def indices():
            t = self.name("T")
            step = self.one(".1", ".2", ".05", ".25", "1/3")
            self.add(f"#for ({t}, 0, {self.one('.4', '.3', '1/3', '.39999999999')}, {step}) " +
                     self.shown(f"A1[{t}*{self.one('10', '10', '5', '3')}]") + " #end")

        def sizes():
            a = self.name("A")
            self.add(f"#declare {a} = array[{self.nearly()}];")
            self.show(f"dimension_size({a}, {self.one('1', '1', '1 - 1e-11', self.nearly())})")
            self.add(f"#declare {a}[{self.nearly()}] = 7;")
            self.add(f"#for (I, 0, dimension_size({a}, 1) - 1) #ifdef ({a}[I]) {self.shown('I')} #end #end")

        def two():
            a = self.name("A")
            self.add(f"#declare {a} = array[2][{self.one('2', '.2/.1', '1.99999999999')}] {{ {{1, 2}}, {{3, 4}} }};")
            self.show(f"{a}[{self.one('0', '1', '1e-11', self.nearly())}][{self.one('1', '0', self.nearly())}]")

        def other():
            n = self.nearly()
            self.add(self.one(
                f"#for (I, {self.nearly()}, {self.nearly()}) {self.shown('I')} #end",
                f"#for (I, 0, {n}, {self.one('.1', '.5', '1', '1e-1*3', '.7')}) #end {self.shown('N1')}",
                f"#switch ({n}) #case ({self.nearly()}) {self.shown('1')} #break #range (1, {self.nearly()}) {self.shown('2')} #break"
                f" #else {self.shown('3')} #end",
                f"#if ({n} = {self.nearly()}) {self.shown('1')} #else {self.shown('2')} #end",
                f"#if ({self.dice.choice(NEARLY)}) {self.shown('1')} #else {self.shown('2')} #end",
                self.shown(f"({n} {self.one('<', '<=', '=', '!=', '>', '>=')} {self.nearly()})"),
                self.shown_string(f"substr(\"abcdef\", {n}, {self.one('1', '2', self.nearly())})"),
                self.shown_string(f"concat(chr(65 + {n}), str({n}, {self.nearly()}, {self.nearly()}))"),
                self.shown(f"{self.one('int', 'floor', 'ceil', 'abs')}({n})"),
                self.shown(f"{self.one('div', 'mod')}({n}, {self.one('1', '2', '.1')})"),
                self.shown_vector("V1", f"{self.one('3', '2')} + {self.dice.choice(NEARLY)}"),
                self.shown(f"A1[{n}]"), self.shown(f"A1[{n}]"), f"#ifdef (A1[{n}]) {self.shown('1')} #else {self.shown('2')} #end",
                self.shown(f"rand(seed({n}))"), self.shown(f"bitwise_and({n}, 3)")))

        self.one(indices, sizes, two, other, other, other)()

    # ---- scopes

    def scope_statement(self, names):
        x, a, p = names
        word = self.one("#local", "#declare")
        return self.one(f"{word} {x} = {self.number()};", f"{word} {a}[{self.one('0', '1')}] = {self.number()};", self.shown(x),
                        self.shown(f"{a}[{self.one('0', '1')}]"), f"{word} {p} = {self.number()};", self.shown(p),
                        f"#ifdef ({x}) {self.shown(x)} #else {self.shown('0')} #end", f"#undef {p}",
                        f"#for ({x}, 1, 2) {word} {p} = {x}; #end", f"#ifndef ({p}) {self.shown('1')} #end",
                        f"#local {a} = array[2] {{ {self.number()}, 5 }};", f"{word} {x} = {x} + 1;",
                        f"#local {a} = array[2];")

    def scopes(self):
        x, a = self.name("X"), self.name("Y")
        if self.chance(.95):
            self.add(f"#declare {x} = {self.dice.randrange(9)};")
        if self.chance(.95):
            self.add(f"#declare {a} = array[2] {{ 3, 4 }};" if self.chance(.9) else f"#declare {a} = array[2];")
        macros = []
        for _ in range(self.dice.randrange(1, 3)):
            macro, parameter = self.name("M"), self.name("P")
            body = [self.scope_statement((x, a, parameter)) for _ in range(self.dice.randrange(1, 5))]
            if macros and self.chance(.6):
                body.insert(self.dice.randrange(len(body) + 1), f"{self.one(*macros)}({self.one(x, parameter, a + '[0]', '3')})")
            if self.chance(.3):
                file = self.name("part") + ".inc"
                self.files[file] = " ".join(body) + "\n"
                body = [f'#include "{file}"']
            self.add(f"#macro {macro}({parameter}) {' '.join(body)} #end")
            macros.append(macro)
        for _ in range(self.dice.randrange(1, 4)):
            if self.chance(.3):
                file = self.name("part") + ".inc"
                self.files[file] = " ".join(self.scope_statement((x, a, x)) for _ in range(3)) + "\n"
                self.add(f'#include "{file}"')
            else:
                self.add(f"{self.one(*macros)}({self.one(x, x, a + '[0]', a + '[1]', f'({x})', '7', 'N1')})")
        self.add(f"#ifdef ({x}) {self.shown(x)} #end",
                 f"#ifdef ({a}) #for (I, 0, 1) #ifdef ({a}[I]) {self.shown(a + '[I]')} #end #end #end")

    # ---- splines, strings, infinities, vectors

    def spline(self):
        s, kinds = self.name("S"), SPLINES + [""]
        size = self.dice.randrange(1, 6)
        points = [f"{self.one(str(i), str(i / 2), self.one('-1', '0', '.3', '2'))}, "
                  f"{self.one('<1, 2, 3>', '<.3, -1, 4>', '<2, 5, 1>', 'V1', '<7, .25, -3>', self.vector(), self.number())}"
                  for i in range(size)]
        self.add(f"#declare {s} = spline {{ {self.one(*kinds)} {self.one(' ', ', ').join(points)} }}")
        for _ in range(3):
            at = self.one("0", ".25", ".5", "1", "-2", "9", "1.3", ".7", "N1")
            kind = self.one("", "", ", " + self.one(*SPLINES))
            self.show_vector(f"(pi*({s}({at}{kind})))")
        if self.chance(.3):
            copy = self.name("S")
            self.add(f"#declare {copy} = spline {{ {s} {self.one(*kinds)} {self.one('', '3, <1, 1, 1>')} }}")
            self.show_vector(f"(pi*({copy}(.4)))")

    def string(self, depth=2):
        if depth == 0:
            return self.one("S1", '"abc"', '"x"', '""', "chr(0)", "chr(10)", "chr(65)", "str(N1, 0, 1)", '"Hello"', '"a\\tb"')
        s, t, n = self.string(depth - 1), self.string(0), self.one("0", "1", "1", "2", "1")
        return self.one(f"concat({s}, {t})", f"concat({s}, chr(0), {t})", f"substr({s}, {n}, {self.one('0', '1', '1', '2', '-1')})",
                        f"strupr({s})", f"strlwr({s})", s, f"concat({t})", f"str({self.number()}, {n}, {self.one('0', '2', '-1')})",
                        f"vstr({self.one('2', '3')}, {self.vector()}, {t}, {n}, 1)", f"concat({t} {s})")

    def strings(self):
        s = self.string()
        if self.chance(.4):
            name = self.name("S")
            self.add(f"#declare {name} = {s};")
            s = name
        self.add(self.one(self.shown_string(s), self.shown(f"strlen({s})"), self.shown(f"asc({s})"), self.shown(f"val({s})"),
                          self.shown(f"strcmp({s}, {self.string(1)})"), self.shown(f"({s} {self.one('=', '<', '!=')} {self.string(1)})"),
                          self.shown(f"strlen({s})"), self.shown_string(f"concat(\"[\", {s}, \"]\")")))

    def infinities(self):
        i, n = self.name("I"), self.name("N")
        self.add(f"#declare {i} = {self.one('1/0', '-1/0', '1e200*1e200', 'N1/0')};", f"#declare {n} = {i} - {i};")
        for _ in range(3):
            a, b = (self.one(i, n, "0", "1", f"-{i}", f"{i}*0", "1e308", f"({n} + 1)") for _ in range(2))
            self.add(self.one(
                self.shown(f"({a} {self.one('=', '!=', '<', '<=', '>', '>=')} {b})"), self.shown(f"!{a}"),
                f"#if ({a}) {self.shown('1')} #else {self.shown('2')} #end", self.shown(f"({a} ? 1 : 2)"),
                self.shown(f"({a} {self.one('&', '|')} {b})"), self.shown(f"min({a}, {b})"), self.shown(f"max({b}, {a})"),
                self.shown(f"select({a}, 1, 2, 3)"), self.shown(f"abs({a})"), self.shown(f"pow({a}, 0)"),
                self.shown_vector(f"<{a}, 1, 2>*0 + y"), self.shown(f"select({a}, 1, 2)"), self.shown(f"F1({a})"),
                f"#for (J, 0, 2) #if (J > {a}) #break #end {self.shown('J')} #end"))

    def mixed(self):
        a, b, c = self.vector(), self.vector(), self.one(self.vector(), self.number())
        component = self.one("x", "y", "x", "y", "z", "red", "u", "green", "t")
        wanted = self.one(f"{a}", f"{a}.{component}", f"{a}.{component}*2", f"V1.y", f"V1.{component}", f"V1.y*{self.one('2', 'x', 'V2')}",
                          f"-{a}.x", f"(V1.y)", f"V2.x + {b}", f"{a} + {b}", f"{a}*{b}", "W1.t", "C1.red*3", f"A1[1]", f"N1*{a}")
        name = self.name("O")
        count = self.one("2", "3", "4", "5")
        self.one(lambda: self.show_vector(f"{a} {self.one('+', '*')} {b}", count), lambda: self.show_vector(f"{a} - {b}", 3),
                 lambda: self.show_vector(f"{a} {self.one('+', '-', '*')} {b} {self.one('+', '*')} {c}", 3),
                 lambda: self.show(f"{a}.{component}"), lambda: self.show(f"{a}.{component}.{self.one('x', 'y')}"),
                 lambda: self.show(f"({a} {self.one('+', '*')} {c}).{component}"), lambda: self.show(f"vlength({wanted})"),
                 lambda: self.show(f"vdot({wanted}, {b})"), lambda: self.show_vector(f"vcross({wanted}, V1)"),
                 lambda: self.show_vector(f"vrotate({wanted}, {wanted})"), lambda: self.show_vector(wanted, count),
                 lambda: (self.add(f"#declare {name} = box {{ -1, <1, 2, 3> {self.one('scale', 'translate', 'rotate')} {wanted} }}"),
                          self.show_vector(f"max_extent({name}) + <0, 0, 0>")),
                 lambda: (self.add(f"#declare {name} = {self.one('', '', 'rgb ', 'color ', 'rgbt ')}{wanted};"),
                          self.show_vector(f"({name} + <0, 0>)", count)),
                 lambda: self.show_vector(f"({self.one('N1 > 2', '0', '1')} ? {a} : {b})", 2),
                 lambda: (self.add(f"#declare {name} = box {{ {wanted}, <9, 9, 9> }}"), self.show_vector(f"min_extent({name}) + <0, 0, 0>")))()

    # ---- blocks, torn ones, versions

    def blocks(self):
        name, macro, n = self.name("O"), self.name("M"), self.one("0", "1", "N1 = 3", "N2 > 0")
        self.one(
            lambda: self.add(f"#declare {name} = {self.one(*SHAPES)}", self.shown_vector(f"max_extent({name})")),
            lambda: self.add(f"#macro {macro}() {self.one('union', 'merge', 'intersection')} #end",
                             f"{macro}() {{ sphere {{ 0, 1 }} box {{ -1, 1 }} }}"),
            lambda: self.add(f"#if ({n}) union #else merge #end {{ sphere {{ 0, 1 }} box {{ -1, 1 }} }}"),
            lambda: self.add(f"#macro {macro}() 2, 3> #end", self.shown_vector(f"<1, {macro}()")),
            lambda: self.add(f"#declare {name} = #if ({n}) 1; #else 2; #end", self.shown(name)),
            lambda: self.add(f"#macro {macro}(R) sphere {{ 0, R #end", f"{macro}(1) translate x }}", f"{macro}(2) }}"),
            lambda: self.add(f"#macro {macro}() }} #end", f"box {{ -1, 1 {macro}()"),
            lambda: self.add(f"#macro {macro}(P) + P*2 #end", self.shown(f"(1 {macro}(3))"), self.shown(f"(1 {macro}(N1) {macro}(2))")),
            lambda: self.add(f"#if (0) {' '.join(self.one(*NOT_CODE) for _ in range(2))} #else {self.shown('1')} #end"),
            lambda: self.add(f"#macro {macro}() {self.one(*NOT_CODE)} #end", self.shown("1")),
            lambda: self.add(f"#switch ({n}) #case (1) {self.shown('1')} {self.one('#break', '')} #case (0) {self.shown('2')} #else "
                             f"{self.shown('3')} #end"),
            lambda: self.add(f"#declare {name} = union {{ #for (I, 1, 2) sphere {{ I*x, .5 }} #end "
                             f"#if ({n}) translate y #else scale 2 #end }}", self.shown_vector(f"max_extent({name})")),
            lambda: self.add(f"sphere {{ 0, 1 pigment {{ rgb {self.vector()} }} finish {{ ambient {self.number()} }} }}"),
            lambda: self.add(f"#declare {name} = texture {{ pigment {{ C1 }} finish {{ phong 1 }} }}",
                             f"sphere {{ 0, 1 texture {{ {name} }} }}"),
            lambda: self.add(f"#macro {macro}(P, Q) {self.shown('P + Q')} #end", f"{macro}({self.number()}, {self.number()})"),
            lambda: self.add(f"object {{ O1 {self.one('', 'translate x', 'scale 2', 'pigment { C1 }')} }}"),
            lambda: self.add(f"#default {{ {self.one('finish { ambient 0 }', 'pigment { rgb 1 }', 'texture { pigment { C1 } }')} }}"),
            lambda: self.add(f"light_source {{ {self.vector()}, {self.one('1', 'C1', 'rgb 1', 'color rgb x')} }}"),
            lambda: self.add(f"background {{ {self.one('C1', 'rgb 1', 'color rgb x', 'rgb x + y')} }}"),
            lambda: self.add(f"#macro {macro}(P) #local R = P*2; R #end", self.shown(f"{macro}(3)"), self.shown(f"({macro}(N1)) + 1")),
            lambda: self.add(f"#undef {name}", f"#ifdef ({name}) {self.shown('1')} #else {self.shown('2')} #end"),
        )()

    def version(self):
        name = self.name("D")
        value = self.one("N1", "A1", "G1", "F1", "V1", "C1", "S1", "1", "x", "rgb 1", "O1", "1 + 2")
        self.add(f"#version {self.one('3.0', '3.1', '3.5', '3.6', '3.7', '3.7')}{self.one(';', ';', '')}",
                 f"#{self.one('declare', 'local')} {name} = {value}{self.one(';', ';', ';', '')}")
        if value in ("N1", "1"):
            self.show(name)
        self.add("#version 3.7;")

    # ---- semicolons and values that macros and branches give

    def given(self):
        """(what a value is declared as, how to show the name)."""
        return self.one((self.number(), "number"), (self.vector(), "vector"), (f"rgb {self.vector()}", "vector"), ('"abc"', "string"),
                        ("S1", "string"), ("F1", "function"), ("function(x) { x*2 }", "function"), ("G1", "spline"),
                        ("array[2] { 7, 8 }", "array"), ("A1", "array"), ("sphere { 0, 2 }", "object"), ("O1", "object"),
                        ("texture { pigment { C1 } }", ""), ("texture { pigment { C1 } } texture { pigment { rgbt 1 } }", ""),
                        ("C1", "vector"), (f"{self.number()} + {self.number()}", "number"), ("concat(S1, \"x\")", "string"))

    def show_given(self, name, kind):
        self.add({"number": lambda: self.shown(name), "vector": lambda: self.shown_vector(f"({name} + <0, 0, 0>)"),
                  "string": lambda: self.shown_string(name), "function": lambda: self.shown(f"{name}(3)"),
                  "spline": lambda: self.shown_vector(f"{name}(.25)"), "array": lambda: self.shown(f"{name}[1]"),
                  "object": lambda: self.shown_vector(f"max_extent({name}) + 0"),
                  "": lambda: f"sphere {{ 0, 1 texture {{ {name} }} }}"}[kind]())

    def ends(self):
        value, kind = self.given()
        name, macro = self.name("E"), self.name("M")
        is_expression = kind in ("number", "vector")
        quiet = self.chance(.6)
        before, after = ("" if quiet else self.one("", "", "#local L = 1;", "#if (0) 1 #end", '#debug "x\\n"', "#undef Q9") for _ in range(2))
        body = self.one("V", "V", "V", "#if (N1 = 3) V #else 1; #end", "#if (0) x #elseif (1) V #end", "#switch (N1) #case (3) V #break #end",
                        "#for (I, 1, 1) V #end")
        inner, outer = ("", ";") if is_expression and body == "V" else (";", "") if is_expression else ("", "")
        if not quiet:
            inner, outer = self.one("", inner, inner, ";", ";;"), self.one("", outer, outer, ";", ";;")
        body = f"{before} {body.replace('V', value + inner, 1)} {after}"
        if self.chance(.3):
            self.add(f"#declare {name} = {body}{outer}")
        else:
            self.add(f"#macro {macro}() {body} #end", f"#{self.one('declare', 'local')} {name} = {macro}(){outer}")
        self.show_given(name, kind)
        if kind == "number" and self.chance(.5):
            first, last = self.one(("", ";"), ("", ";"), (";", ""), (";", ";"))
            self.add(f"#macro {macro}2() {self.number()}{first} #end", f"#declare {name}2 = 2*{macro}2(){last}", self.shown(f"{name}2"))
            if self.chance(.3):
                self.add(self.one(self.shown(f"{macro}2()"), f"#if ({macro}2()) {self.shown('1')} #end"))

    # ---- arguments

    def argument(self):
        n = self.number()
        return self.one(n, n, f"#if (1) {n} #end", f"#if (0) 7 #end {n}", f"#if (0) 7 #else {n} #end", f"{n} #if (1) + 1 #end",
                        f"#if (1) {n}, #end {self.number()}", f"({n})", f"#local L = 1; {n}", f"#ifdef (N1) ({n}) #end", f"M1({n})")

    def arguments(self):
        f, m, a, b = self.argument(), self.name("M"), self.argument(), self.argument()
        comma = self.one(", ", ", ", ", ", " ")
        self.one(lambda: self.show(f"F1({f})"), lambda: self.show(f"max({a}{comma}{b})"), lambda: self.show(f"sin({a})"),
                 lambda: self.show(f"select({a}, 1, 2)"), lambda: self.show_vector(f"G1({a}{self.one('', ', linear_spline')})"),
                 lambda: self.add(f"#macro {m}(P, Q) {self.shown('P')} {self.shown('Q')} #end", f"{m}({a}{comma}{b})"),
                 lambda: self.add(f"#macro {m}(P) {self.shown_string('P')} #end",
                                  f"{m}({self.one('#if (1) S1 #end', 'S1 #if (0) 1 #end', '#if (0) x #end S1', '#if (1) chr(65) #end')})"),
                 lambda: self.add(f"#macro {m}(P) {self.shown_vector('max_extent(P)')} #end",
                                  f"{m}({self.one('#if (1) O1 #end', 'O1', 'object { O1 }', 'sphere { 0, 2 } #if (0) 1 #end')})"),
                 lambda: self.add(f"#macro {m}() {self.one('F1', '(2)', 'G1', 'A1', '[1]')} #end",
                                  self.shown(f"{self.one(f'{m}()(2)', f'F1 {m}()', f'{m}()[1]', f'A1 {m}()')}")),
                 lambda: self.show_vector(f"<{a}{comma}{b}, 3>"))()

    def references(self):
        x, a, m, k = self.name("X"), self.name("Y"), self.name("M"), self.name("K")
        word = self.one("#declare", "#declare", "#local")
        value, element = self.one("1", "<1, 2, 3>", "2"), self.one("3", "4", "<1, 2, 3>")
        self.add(f"#declare {x} = {value};", f"#declare {a} = array[2] {{ {element}, {element} }}")
        change = self.one(f"{word} P = 5;", f"{word} P = P + 1;", f"{word} P = P*2; {word} Q = P;", f"#local Q = P; {word} P = Q + 7;",
                          f"#ifdef (P) {self.shown('1')} #end", f"{word} P = <4, 5, 6>;", "#undef P", f"{word} P[0] = 9;",
                          "#for (P, 1, 2) #end", f"{word} P = \"b\";") if self.chance(.5) else f"{word} P = P + {self.number()};"
        self.add(f"#macro {m}(P) {change} #end", f"#macro {k}(P, Q) {m}(P) {self.one(f'{m}(Q)', f'{word} Q = Q + 2;', f'#undef Q')} #end",
                 self.one(f"{m}({x})", f"{m}({a}[0])", f"{m}({x} + 0)", f"{k}({x}, {x})", f"{k}({x}, {a}[1])", f"{m}(({x}))",
                          f"{k}({a}[0], {x})", f"{m}({a})" if self.chance(.3) else f"{m}({x})"),
                 f"#ifdef ({x}) {self.shown_vector(f'({x} + <0, 0, 0>)')} #else {self.shown('2')} #end",
                 f"#for (I, 0, 1) #ifdef ({a}[I]) {self.shown_vector(f'({a}[I] + <0, 0, 0>)')} #end #end")

    # ---- colours, arrays of arrays, data files, functions of blocks

    def colours(self):
        part = lambda: self.one("red", "green", "blue", "filter", "transmit") + " " + self.number()  # noqa: E731
        colour = self.one(f"rgb {self.vector()}", f"rgb {self.number()}", f"rgbf {self.vector()}", f"rgbt {self.vector()}", f"C1 {part()}",
                          f"color {part()} {part()}", f"rgb {self.vector()} {part()}", f"color C1*{self.number()}", f"C1 + {self.vector()}",
                          f"colour rgbft {self.vector()} {part()}", f"color {self.vector()}", f"rgb {self.vector()}*{self.number()}",
                          f"C1*{self.vector()} {part()}", f"color C1 {part()}", f"-C1", f"(C1)", f"{self.number()}*C1", f"rgb C1.{self.one('x', 'gray')}")
        name = self.name("C")
        self.add(f"#declare {name} = {colour};")
        self.one(lambda: self.show_vector(name, 5), lambda: self.show_vector(f"{name} + 0", 3), lambda: self.show(f"{name}.{part().split()[0]}"),
                 lambda: self.show(f"{name}.gray"), lambda: self.show_vector(f"{name}*{self.number()} + <1, 1, 1>", 5),
                 lambda: self.add(f"sphere {{ 0, 1 pigment {{ {name} }} finish {{ ambient {name} }} }}"))()

    def nested_arrays(self):
        a, b = self.name("A"), self.name("B")
        n, i, j = (self.one("0", "1", self.nearly() if self.chance(.2) else "1") for _ in range(3))
        held, shown = self.one(("A1", self.shown(f"{b}[1][{j}]")), ("S1", self.shown_string(f"{b}[{j}]")), ("F1", self.shown(f"{b}[0](2)")),
                               ("V1", self.shown_vector(f"({b}[1] + <0, 0, 0>)")), ("O1", self.shown_vector(f"max_extent({b}[{j}])")),
                               ("C1", self.shown(f"{b}[1].green")), ("G1", self.shown_vector(f"{b}[1](.5)")))
        other = held if self.chance(.8) else self.one("A1", "V1", "C1", "N1")
        self.add(f"#declare {b} = array[2] {{ {held}, {other} }}", shown,
                 f"#declare {a} = array[{self.one('2', '3')}][2]{self.one('', '', ' { { 1, 2 }, { 3, 4 } }') if self.chance(.4) else ''};",
                 f"#declare {a}[{n}][{i}] = {self.number()};")
        self.add(self.one(self.shown(f"{a}[{n}][{i}]"), self.shown(f"dimensions({a})"), self.shown(f"dimension_size({a}, {self.one('1', '2', '3')})"),
                          f"#ifdef ({a}[{n}][{j}]) {self.shown('1')} #else {self.shown('2')} #end", f"#undef {a}[{n}][{i}]",
                          f"#declare {b}[0] = {held}", f"#declare {b} = {a}") if self.chance(.8) else
                 self.one(f"#declare {b}[0] = {self.number()};", self.shown(f"{b}[1].y"), f"#declare {b}[0][1] = 5; {self.shown('A1[1]')}",
                          f"#local {a} = {b}", f"#declare {a}[0] = 1;"))

    def data(self):
        file, f, x = self.name("data") + ".csv", self.name("F"), self.name("X")
        values = [self.one("1", "-2.5", "<1, 2, 3>", '"text"', "+3", "1e2", ".5", "<-1, 2>", "// comment\n4", "- 7") for _ in range(self.dice.randrange(1, 5))]
        self.files[file] = ", ".join(values) + self.one("", ",", ",\n", "\n")
        reads = self.one(f"{x}", f"{x}", f"{x}, N1", f"{x}, {x}", f"A1[0], {x}", f"{x}, A1[1]")
        self.add(f'#fopen {f} "{file}" read', f"#while (defined({f})) "
                 f"#read ({f}, {reads}) {self.shown(f'defined({f})')} #end", f"#ifdef ({x}) {self.shown('1')} #end", f"#ifdef (A1[0]) {self.shown('A1[0] + A1[1]')} #end")
        if self.chance(.4):
            self.add(self.one(self.shown(x), self.shown_string(x), self.shown_vector(f"({x} + <0, 0, 0>)")))

    def made_functions(self):
        f, at = self.name("F"), f"({self.one('1', '.5', 'N1', '-2')}, {self.one('0', '.25', '3')}, {self.one('1', '-.5')})"
        made, kind = self.one(("transform { translate x scale 2 rotate 90*z }", 3), (f"transform {{ matrix <1,0,0, 0,2,0, 0,0,3, 1,2,3> }}", 3),
                              ("pattern { checker }", 1), ("pattern { gradient x sine_wave frequency 2 }", 1), ("pigment { C1 }", 5),
                              ("pattern { spherical scale 2 }", 1), ("pigment { gradient y color_map { [0 rgb 0] [1 rgbt 1] } }", 5),
                              ("pattern { onion phase .25 }", 1), ("pigment { checker C1, rgb x }", 5))
        self.add(f"#declare {f} = function {{ {made} }}")
        self.add(self.one(self.shown(f"{f}{at}", 6) if kind == 1 else self.shown_vector(f"{f}{at}", min(kind, 5)),
                          self.shown(f"{f}{at}{'' if kind == 1 else self.one('.x', '.y', '.red', '.gray')}", 6),
                          self.shown(f"{'abs' if kind == 1 else 'vlength'}({f}{at}{'.x*y' if kind == 5 else ''})", 6)))
        if self.chance(.5):
            part = "" if kind == 1 else "." + self.one(*(("x", "y", "gray") if kind == 3 else ("red", "gray", "hf", "t", "transmit")))
            self.add(f"#declare {f}2 = function(x, y) {{ {f}(x, y, {self.one('0', 'x + y')}){part}*2 + F1(x) }}", self.shown(f"{f}2(.5, 2)", 6))

    # ---- what makes of a program another one

    def tokens_of(self):
        """A statement and its tokens: where each begins and ends."""
        at = self.dice.randrange(len(self.statements))
        return at, [match.span() for match in TOKEN.finditer(self.statements[at])]

    def tear(self):
        """A piece of a statement stands in a directive, a macro or a file of its own."""
        at, spans = self.tokens_of()
        text = self.statements[at]
        first = self.dice.randrange(len(spans))
        last = min(len(spans) - 1, first + self.one(0, 0, 1, 2, 3, 5, 9))
        before, piece, after = text[:spans[first][0]], text[spans[first][0]:spans[last][1]], text[spans[last][1]:]
        other = self.one("7", "", "x", "don't", "1 +", "}")
        macro, file = self.name("T"), self.name("torn") + ".inc"
        form = self.dice.randrange(9)
        if form == 0:
            self.statements.insert(at, f"#macro {macro}() {piece} #end")
            at, piece = at + 1, f"{macro}()"
        elif form == 1:
            self.statements.insert(at, f"#macro {macro}(P) {piece} #end")
            at, piece = at + 1, f"{macro}({self.number()})"
        elif form == 2:
            self.files[file] = piece + "\n"
            piece = f'#include "{file}"'
        else:
            piece = self.one(f"#if (1) {piece} #end", f"#if (0) {other} #else {piece} #end", f"#if (N1) {piece} #else {other} #end",
                             f"#for (Z, 1, 1) {piece} #end", f"#while (1) {piece} #break #end", f"#ifdef (N1) {piece} #end",
                             f"#switch (1) #case (1) {piece} #break #else {other} #end", f"#if (0) {other} #end {piece}",
                             f"{piece} #declare Z9 = 1;", f"#debug \"in\\n\" {piece}", f"#local Z9 = 1; {piece}")
        self.statements[at] = f"{before} {piece} {after}"

    def miss(self):
        """One token less, more, or elsewhere."""
        at, spans = self.tokens_of()
        text = self.statements[at]
        i = self.dice.randrange(len(spans))
        (begin, end), form = spans[i], self.dice.randrange(8)
        if form <= 1:
            text = text[:begin] + " " + text[end:]
        elif form == 2:
            text = text[:end] + " " + text[begin:end] + text[end:]
        elif form <= 4:
            text = text[:begin] + f" {self.one(*STRAY)} " + text[begin:]
        elif form <= 6:
            text = text[:begin] + f" {self.one(*STRAY)} " + text[end:]
        elif i + 1 < len(spans):
            (second, last) = spans[i + 1]
            text = f"{text[:begin]}{text[second:last]} {text[begin:end]}{text[last:]}"
        self.statements[at] = text

    def write(self):
        self.defined_names()
        for _ in range(self.dice.randrange(2, 7)):
            self.one(self.function_of_loops, self.inexact, self.inexact, self.scopes, self.spline, self.strings, self.infinities,
                     self.mixed, self.mixed, self.blocks, self.blocks, self.version, self.ends, self.arguments, self.references,
                     self.colours, self.nested_arrays, self.data, self.made_functions, self.function_of_chains)()
        kind = self.dice.random()
        if kind > .45:
            for _ in range(self.one(1, 1, 2)):
                self.one(self.tear, self.tear, self.miss)()


def generate(seed):
    """([statement], {name of an included file: its text}) of one program."""
    program = OddProgram(seed)
    program.write()
    return program.statements, program.files


def main():
    statements, files = generate(int(sys.argv[1]))
    print("\n".join(statements))
    for name, part in files.items():
        print(f"// ---- {name}\n{part}", end="")


if __name__ == "__main__":
    main()
