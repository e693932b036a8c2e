#!/usr/bin/env python3
"""Writes programs in the scene language that are valid and print what they work out: all types, operators and functions,
scopes, directives, macros by value and by reference, arrays, strings.

The same seed gives the same program. Names begin with `P` and the program's number, so that many programs can stand in one
file. Usage: generate_programs.py SEED [NUMBER]   Prints one. SPDX-License-Identifier: MIT
"""
import random
import sys

# Types: "1" a number, "2" to "5" a vector of so many, "C" a colour, "S" a string, "R" a random stream.
VECTORS = "2345"
DEPTH = 3        # nesting of expressions
BLOCK_DEPTH = 3  # nesting of directives
SETTINGS = ("frame_number", "initial_frame", "final_frame", "clock_delta")

# Functions and constants that the programs leave out: of objects, of patterns, and of the clock on the wall.
LEFT_OUT = {"trace", "inside", "min_extent", "max_extent", "vturbulence", "datetime", "now", "internal"}


class Scope:
    """Names that may be read: name -> type; those that may not be given a value; arrays: name -> (type, sizes)."""

    def __init__(self, outer=None):
        self.types = dict(outer.types) if outer else {}
        self.fixed = set(outer.fixed) if outer else set()
        self.arrays = dict(outer.arrays) if outer else {}
        self.macros = dict(outer.macros) if outer else {}      # name -> ([(type, by reference)], result type or "")
        self.functions = dict(outer.functions) if outer else {}  # name -> number of arguments
        self.splines = dict(outer.splines) if outer else {}      # name -> type

    def of(self, kind, writable=False):
        return [name for name, type_ in self.types.items()
                if type_ == kind and not (writable and name in self.fixed)]


class Expressions:
    """Text of expressions. Everything random comes from `self.dice`."""

    def __init__(self, seed, prefix):
        self.dice = random.Random(seed)
        self.prefix = prefix
        self.count = 0
        self.scope = Scope()
        self.unused = []  # names that were never declared, or are gone
        # POV-Ray ends with a segmentation fault at some directives inside the parentheses of another, and takes no macro
        # for a string in the list of an array.
        self.has_inline = self.has_string_calls = True

    def one_of(self, *choices):
        return self.dice.choice(choices)()

    def chance(self, share):
        return self.dice.random() < share

    def name(self, hint):
        self.count += 1
        return f"{self.prefix}_{hint}{self.count}"

    def variable(self, kind, otherwise):
        names = self.scope.of(kind)
        return self.dice.choice(names) if names else otherwise()

    # ---- numbers

    def literal(self):
        dice = self.dice
        return dice.choice([
            lambda: str(dice.randrange(0, 10)), lambda: str(dice.randrange(0, 1000)),
            lambda: f"{dice.uniform(0, 10):.{dice.randrange(1, 7)}f}", lambda: f".{dice.randrange(1, 99)}",
            lambda: f"{dice.randrange(1, 9)}.", lambda: f"{dice.uniform(1, 9):.2f}e{dice.randrange(-4, 4)}",
            lambda: f"{dice.randrange(1, 9)}E+{dice.randrange(0, 3)}"])()

    def constant(self):
        return self.dice.choice(["pi", "true", "false", "yes", "no", "on", "off", "clock", "clock_on", "version",
                                 self.dice.choice(SETTINGS)])

    def atom(self):
        return self.dice.choice([self.literal, self.literal, self.constant,
                                 lambda: self.variable("1", self.literal), lambda: self.variable("1", self.literal)])()

    def number(self, depth=DEPTH):
        if depth <= 0:
            return self.atom()
        d = depth - 1
        choices = [
            self.atom, lambda: self.arithmetic(d), lambda: self.arithmetic(d), lambda: self.arithmetic(d),
            lambda: f"({self.arithmetic(d)})", lambda: self.sign(d), lambda: self.truth(d), lambda: self.choice("1", d),
            lambda: self.of_number(d), lambda: self.of_number(d), lambda: self.of_numbers(d), lambda: self.of_vector(d),
            lambda: self.of_string(d), lambda: self.component(d), lambda: self.element("1"), lambda: self.call("1", d),
            self.of_name, self.random_number, *([lambda: self.inline(d)] if self.has_inline else [])]
        return self.one_of(*choices, lambda: self.function_call(d))

    def arithmetic(self, depth):
        if self.chance(0.25):
            divisor = self.dice.choice([self.literal_above_zero, lambda: f"(abs({self.number(depth)}) + 0.5)"])()
            return f"{self.factor(depth)} / {divisor}"
        operator = self.dice.choice(["+", "-", "*", "+", "-"])
        space = self.dice.choice([" ", " ", ""])
        return f"{self.factor(depth)}{space}{operator}{space}{self.factor(depth)}"

    def factor(self, depth):
        return self.one_of(self.atom, lambda: f"({self.number(depth)})", lambda: self.of_number(depth),
                           lambda: self.sign(depth), lambda: self.component(depth))

    def literal_above_zero(self):
        return self.dice.choice(["2", "3.5", ".25", "1e2", "(2*pi)", "7"])

    def sign(self, depth):
        operator = self.dice.choice(["-", "+", "!", "-", "- -", "!!", "-!"])
        return f"{operator}{self.dice.choice([self.atom(), f'({self.number(depth)})'])}"

    def relation(self, depth):
        operator = self.dice.choice(["<", "<=", "=", "!=", ">=", ">"])
        if self.chance(0.15):
            return f"{self.string(depth - 1)} {operator} {self.string(depth - 1)}"
        if self.chance(0.15):
            same = self.atom()
            return f"{same} {operator} {same} + {self.dice.choice(['0', '1e-11', '1e-9', '-1e-11', '0.5e-10'])}"
        return f"{self.number(depth - 1)} {operator} {self.number(depth - 1)}"

    def truth(self, depth):
        """A number in parentheses that is mostly 0 or 1."""
        parts = [self.relation(depth) for _ in range(self.dice.choice([1, 1, 1, 2, 3]))]
        text = parts[0]
        for part in parts[1:]:
            text += self.dice.choice([" & ", " | "]) + self.dice.choice([part, f"!({part})", f"({part})"])
        return f"({text})"

    def choice(self, kind, depth):
        """C ? A : B in parentheses, also of three."""
        condition = self.dice.choice([self.truth(depth), self.atom(), self.relation(depth)])
        first, second = self.value(kind, depth), self.value(kind, depth)
        if self.chance(0.2):
            second = f"{self.truth(depth)} ? {self.value(kind, 0)} : {second}"
        return f"({condition} ? {first} : {second})"

    def of_number(self, depth):
        a = self.number(depth)
        return self.dice.choice([
            f"abs({a})", f"sin({a})", f"cos({a})", f"tan({a})", f"asin(sin({a}))", f"acos(cos({a}))", f"atan({a})",
            f"sinh(sin({a}))", f"cosh(cos({a}))", f"tanh({a})", f"asinh({a})", f"acosh(abs({a}) + 1)",
            f"atanh(sin({a}) * 0.9)", f"exp(sin({a}))", f"ln(abs({a}) + 0.01)", f"log(abs({a}) + 0.01)",
            f"sqrt(abs({a}))", f"floor({a})", f"ceil({a})", f"int({a})", f"degrees({a})", f"radians({a})",
            f"abs({self.relation(depth)})"])

    def of_numbers(self, depth):
        a, b, c = self.number(depth), self.number(depth), self.number(0)
        comma = self.dice.choice([", ", ","])
        return self.dice.choice([
            f"atan2({a}{comma}abs({b}) + 0.1)", f"pow(abs({a}) + 0.1{comma}2 * sin({b}))", f"div({a}, abs({b}) + 1)",
            f"pow({self.atom()}, {self.dice.choice('123')})", f"mod({a}{comma}abs({b}) + 0.5)", f"min({a}, {b})",
            f"max({a}, {b}{comma}{c})", f"min({a}, {b}, {c}, 4)", f"select({a}, {b}, {c})",
            f"select({a}{comma}{b}, {c}, {self.atom()})", f"max({a})",
            f"bitwise_and(int({a}), {self.dice.randrange(999)})", f"bitwise_or(int({a}), int({b}), 4)",
            f"bitwise_xor(int({a}){comma}int({b}))"])

    def of_vector(self, depth):
        v, w = self.vector3(depth), self.vector3(depth)
        return self.dice.choice([f"vlength({v})", f"vdot({v}, {w})", f"vdot({v} {self.number(0)})"
                                 if self.chance(0.1) else f"vdot({w}, {v})"])

    def of_string(self, depth):
        s = self.string(depth)
        return self.dice.choice([f"strlen({s})", f"asc({s})", f"strcmp({s}, {self.string(depth)})",
                                 f"val(str({self.number(depth)}, 0, 3))", f"val({self.quoted('12.5abc')})"])

    def of_name(self):
        names = list(self.scope.types) + self.unused[-5:] + ["image_width"]
        choices = [f"defined({self.dice.choice(names)})", 'file_exists("nowhere.inc")']
        for array, (_, sizes) in self.scope.arrays.items():
            choices += [f"dimensions({array})", f"dimension_size({array}, {self.dice.randrange(len(sizes)) + 1})"]
        return self.dice.choice(choices)

    def component(self, depth):
        kind = self.dice.choice("2345C")
        items = ["x", "y", "u", "v", "red", "green"]
        if kind != "2":
            items += ["z", "blue"]
        if kind in "45C":
            items += ["t", "filter"]
        if kind in "5C":
            items += ["transmit", "gray"]
        base = self.variable(kind, lambda: f"({self.vector('5' if kind == 'C' else kind, depth)})")
        return f"{base}{self.dice.choice(['.', '.', ' .', ' . '])}{self.dice.choice(items)}"

    def index(self, size):
        return self.dice.choice([str(self.dice.randrange(size)), f"mod(abs(int({self.number(1)})), {size})",
                                 f"{self.dice.randrange(size)}.7"])

    def element(self, kind):
        names = [name for name, (type_, _) in self.scope.arrays.items() if type_ == kind]
        if not names:
            return self.value(kind, 0)
        name = self.dice.choice(names)
        return name + "".join(f"[{self.index(size)}]" for size in self.scope.arrays[name][1])

    def random_number(self):
        return f"rand({self.variable('R', lambda: '')})" if self.scope.of("R") else self.literal()

    def function_call(self, depth):
        if self.scope.splines and self.chance(0.3):
            name = self.dice.choice(list(self.scope.splines))
            return f"({name}({self.number(depth)})).{self.dice.choice('xy')}"
        if not self.scope.functions:
            return self.of_number(depth)
        name = self.dice.choice(list(self.scope.functions))
        return f"{name}({', '.join(self.number(depth) for _ in range(self.scope.functions[name]))})"

    def inline(self, depth):
        """A directive that stands for a value, in parentheses."""
        self.has_inline = False
        condition = f"#if ({self.relation(depth)})"
        self.has_inline = True
        return f"({condition} {self.number(depth)} #else {self.number(depth)} #end)"

    # ---- vectors and colours

    def components(self, count, depth):
        parts = [self.number(depth) for _ in range(count)]
        text = parts[0]
        for part in parts[1:]:
            # Without a comma, what could go on the component before would do so.
            text += (" " if part[0] not in "+-(!" and self.chance(0.2) else self.dice.choice([", ", ","])) + part
        return f"<{text}{', ' if count < 5 and self.chance(0.05) else ''}>"

    def vector(self, kind, depth=DEPTH):
        size = 5 if kind == "C" else int(kind)
        d = depth - 1
        unit = {"2": ["u", "v"], "3": ["x", "y", "z"], "4": ["(t)"]}.get(kind)
        if depth <= 0:
            simple = lambda: self.dice.choice(unit) if unit and self.chance(0.5) else self.components(size, 0)
            return self.variable(kind, simple)
        smaller = str(self.dice.randrange(2, size + 1))
        return self.one_of(
            lambda: self.components(size, d), lambda: self.vector(kind, 0), lambda: self.choice(kind, d),
            # In a longer sum POV-Ray fills shorter operands up with what an operand before had (docs/language.md).
            lambda: f"({self.vector(kind, d)}) + {self.vector(smaller, 0)}", lambda: f"-{self.vector(kind, 0)}",
            lambda: f"{self.vector(kind, 0)} * {self.factor(d)}", lambda: f"{self.factor(d)} * {self.vector(kind, 0)}",
            lambda: f"({self.vector(kind, d)}) - {self.vector(kind, 0)}", lambda: self.element(kind),
            lambda: f"{self.vector(kind, 0)} / <{', '.join(['2', '3.5', '-4', '.5', '8'][:size])}>",
            lambda: f"{self.vector(smaller, 0)} + {self.vector(kind, 0)}", lambda: self.call(kind, d),
            lambda: self.rotated(d) if kind == "3" else f"{self.vector(kind, 0)} + 1")

    def rotated(self, depth):
        v, w = self.vector3(depth), self.vector3(depth)
        return self.dice.choice([f"vcross({v}, {w})", f"vnormalize({v} + <7, .3, .1>)", f"vrotate({v}, {w})",
                                 f"vaxis_rotate({v}, {w} + <.1, 7, 0>, {self.number(depth)})",
                                 f"vrotate({v}, 90 * {self.dice.choice('xyz')})"])

    def vector3(self, depth):
        """What a vector of three can be given as."""
        kind = self.dice.choice("3333321")
        # A component times a vector of two has a third component for POV-Ray (docs/language.md).
        return self.vector(kind, depth - 1 if kind == "3" else 0) if kind != "1" else self.number(0)

    def colour(self, depth):
        """The right side of a declaration that makes a colour; no operand."""
        v3 = self.components(3, depth)
        forms = [f"rgb {v3}", f"color rgb {v3}", f"colour {self.vector('5', 0)}", f"rgbf {self.components(4, depth)}",
                 f"rgbt {self.components(4, depth)}", f"rgbft {self.components(5, depth)}", f"rgb {self.atom()}",
                 f"color red {self.number(depth)} blue {self.atom()}", f"rgb {v3} * {self.atom()}",
                 f"color rgb {v3} transmit {self.atom()}", f"srgb {v3}", f"srgbt {self.components(4, depth)}"]
        names = self.scope.of("C")
        if names:
            name = self.dice.choice(names)
            forms += [f"{name} * {self.factor(depth)}", f"{name} + {self.dice.choice(names)}", f"{name}",
                      f"color {name} filter {self.atom()}", f"color {name} green {self.atom()}"]
        return self.dice.choice(forms)

    # ---- strings

    def quoted(self, text):
        return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'

    def text(self):
        letters = "abcxyzABCXYZ0189 .,;:-+*/#{}()<>_'\\\""
        return self.quoted("".join(self.dice.choice(letters) for _ in range(self.dice.randrange(0, 7))))

    def digits(self):
        return self.dice.choice(["0", "1", "2", "3", "6", "9", "-1"])

    def string(self, depth=DEPTH):
        if depth <= 0:
            return self.variable("S", self.text) if self.chance(0.6) else self.text()
        d = depth - 1
        start = self.dice.randrange(1, 5)
        return self.one_of(
            self.text, lambda: self.string(0), lambda: f"concat({self.string(d)}, {self.string(0)})",
            lambda: f"concat({self.string(d)}, {self.string(0)} {self.text()})", lambda: self.element("S"),
            lambda: f"str({self.number(d)}, {self.dice.randrange(-9, 10)}, {self.digits()})",
            lambda: self.vector_text(d), lambda: f"chr({self.dice.randrange(32, 127)})",
            lambda: f"substr(concat({self.string(d)}, \"abcdef\"), {start}, {self.dice.randrange(0, 8 - start)})",
            lambda: f"strupr({self.string(d)})", lambda: f"strlwr({self.string(d)})", lambda: self.call("S", d))

    def vector_text(self, depth):
        kind = self.dice.choice(VECTORS)
        return (f"vstr({kind}, {self.vector(kind, depth)}, {self.text()}, {self.dice.randrange(-8, 9)}, "
                f"{self.digits()})")

    # ---- any type

    def value(self, kind, depth=DEPTH):
        """An operand or expression; of a colour one that begins with a colour's name."""
        if kind == "1":
            return self.number(depth)
        if kind == "S":
            return self.string(depth)
        if kind == "R":
            return f"seed({self.dice.randrange(0, 99999)})"
        return self.vector(kind, depth) if kind in VECTORS else self.variable("C", lambda: "<1, .5, .25, 0, 0>")

    def call(self, kind, depth):
        """A macro's value; in parentheses, unless it is a string."""
        names = [name for name, (_, result) in self.scope.macros.items() if result == kind]
        if not names or (kind == "S" and not self.has_string_calls):
            return self.value(kind, 0)
        call = self.call_of(self.dice.choice(names), depth)
        return call if kind == "S" else f"({call})"

    def call_of(self, name, depth):
        arguments = []
        for type_, by_reference in self.scope.macros[name][0]:
            names = self.scope.of(type_, writable=True)
            if by_reference and names and self.chance(0.7):
                arguments.append(self.dice.choice(names))
            elif type_ == "1":
                arguments.append(f"({self.number(depth)})")
            elif type_ == "C":
                arguments.append(self.colour(0))
            else:
                arguments.append(self.value(type_, depth))
        return f"{name}({', '.join(arguments)})"


class Program(Expressions):
    """Statements. `self.files` are the texts of what it includes."""

    def __init__(self, seed, number=0):
        super().__init__(seed, f"P{number}")
        self.lines, self.files = [], {}
        self.level = 0     # of directives around the present statement
        self.in_loop = self.in_macro = False
        self.printed = 0

    def add(self, text):
        self.lines.append("    " * self.level + text)

    def assigned(self, kind):
        """A right side; in loops and macros one that does not grow from turn to turn."""
        if kind == "C":
            return self.colour(1)
        if self.level == 0 or kind == "R":
            return self.value(kind)
        if kind == "S":
            return f'substr(concat({self.string(2)}, "0123456789"), 1, {self.dice.randrange(1, 9)})'
        if kind == "1":
            return f"mod({self.number(2)}, 1000)"
        return "<" + ", ".join(f"mod({self.number(1)}, 100)" for _ in range(int(kind))) + ">"

    def some_type(self):
        return self.dice.choice("11112334455CCSS")

    # ---- statements

    def statement(self):
        simple = [self.declare, self.declare, self.assign, self.assign, self.print, self.print, self.print,
                  self.set_element, self.undefine]
        blocks = [self.if_, self.ifdef, self.switch, self.for_, self.while_, self.call_statement]
        top = [self.macro, self.macro, self.array, self.array, self.include, self.redeclare, self.recursion,
               self.version, self.function, self.spline]
        choices = simple + (blocks if self.level < BLOCK_DEPTH else []) + (top if self.level == 0 else [])
        self.dice.choice(choices)()

    def statements(self, least, most):
        for _ in range(self.dice.randrange(least, most + 1)):
            self.statement()

    def body(self, least=1, most=4):
        """Statements of a directive, whose new names are not known behind it."""
        outer, self.scope = self.scope, Scope(self.scope)
        self.level += 1
        self.statements(least, most)
        self.level -= 1
        self.unused += [name for name in self.scope.types if name not in outer.types]
        self.scope = outer

    def print(self):
        self.printed += 1
        kind = self.dice.choice("111123345CCSSS")
        if kind == "1":
            text = f'str({self.number()}, 0, {self.dice.choice(["9", "6"])})'
        elif kind == "S":
            text = self.string()
        elif kind == "C" or kind in self.scope.arrays:
            text = f'vstr(5, {self.value("C")} * 1, " ", 0, 9)'
        else:
            text = f'vstr({kind}, {self.vector(kind)}, " ", 0, {self.dice.choice(["9", "6"])})'
        self.add(f'#debug concat("{self.printed}: ", {text}, "\\n")')

    def define(self, kind, hint):
        name = self.name(hint)
        word = "local" if self.chance(0.3) or self.in_macro else "declare"
        self.add(f"#{word} {name} = {self.assigned(kind)};")
        self.scope.types[name] = kind

    def declare(self):
        kind = self.some_type() if self.chance(0.93) else "R"
        self.define(kind, {"S": "S", "C": "C", "R": "R"}.get(kind, "V"))

    def assign(self):
        names = [name for name in self.scope.types if name not in self.scope.fixed]
        if names:
            name = self.dice.choice(names)
            if self.scope.types[name] != "R":
                self.add(f"#declare {name} = {self.assigned(self.scope.types[name])};")

    def redeclare(self):
        """Another type for a name; macros that use the name as it was are forgotten."""
        names = [name for name in self.scope.types if name not in self.scope.fixed]
        if names and not self.scope.macros:
            name, kind = self.dice.choice(names), self.some_type()
            self.add(f"#declare {name} = {self.assigned(kind)};")
            self.scope.types[name] = kind

    def version(self):
        self.add(f"#version {self.dice.choice(['3.7', '3.7', '3.6 + 0.1'])};")

    def undefine(self):
        names = [name for name in self.scope.types if name.startswith(self.prefix + "_V")
                 and name not in self.scope.fixed]
        if names and self.level == 0 and not self.scope.macros:
            name = self.dice.choice(names)
            self.add(f"#undef {name}")
            del self.scope.types[name]
            self.unused.append(name)

    def array(self):
        name, kind = self.name("A"), self.dice.choice("11123345CSS")
        sizes = [self.dice.randrange(1, 5) for _ in range(self.dice.choice([1, 1, 2, 3]))]

        def rows(sizes):
            if not sizes:
                return self.colour(0) if kind == "C" else self.value(kind, 1)
            return "{ " + ", ".join(rows(sizes[1:]) for _ in range(sizes[0])) + " }"

        size_text = "".join(f"[{size}]" for size in sizes)
        if self.chance(0.7) or len(sizes) > 1:
            self.has_string_calls = False
            self.add(f"#declare {name} = array{size_text} {rows(sizes)};")
            self.has_string_calls = True
        else:
            self.add(f"#declare {name} = array{size_text};")
            self.add(f"#ifdef ({name}[0]) #debug \"set\\n\" #else #debug \"not set\\n\" #end")
            for i in range(sizes[0]):
                self.add(f"#declare {name}[{i}] = {self.assigned(kind)};")
        self.scope.arrays[name] = (kind, sizes)

    def set_element(self):
        if self.scope.arrays:
            name = self.dice.choice(list(self.scope.arrays))
            kind, sizes = self.scope.arrays[name]
            index = "".join(f"[{self.index(size)}]" for size in sizes)
            self.add(f"#declare {name}{index} = {self.assigned(kind)};")

    # ---- directives

    def condition(self):
        self.has_inline = False
        text = self.dice.choice([self.relation(2), self.truth(2), self.number(2), f"!{self.truth(2)}"])
        self.has_inline = True
        return text

    def if_(self):
        self.add(f"#if ({self.condition()})")
        self.body()
        while self.chance(0.3):
            self.add(f"#elseif ({self.condition()})")
            self.body()
        if self.chance(0.6):
            self.add("#else")
            self.body()
        self.add("#end")

    def ifdef(self):
        names = list(self.scope.types) + self.unused[-5:] + list(self.scope.macros) + ["image_height"]
        names += [f"{array}{'[0]' * len(sizes)}" for array, (_, sizes) in self.scope.arrays.items()]
        self.add(f"#{self.dice.choice(['ifdef', 'ifndef'])} ({self.dice.choice(names)})")
        self.body()
        if self.chance(0.6):
            self.add("#else")
            self.body()
        self.add("#end")

    def switch(self):
        self.has_inline = False
        subject = self.dice.choice([f"mod(int({self.number(1)}), 5)", self.number(1), str(self.dice.randrange(4))])
        self.has_inline = True
        self.add(f"#switch ({subject})")
        loop, self.in_loop = self.in_loop, False
        for _ in range(self.dice.randrange(1, 4)):
            low = self.dice.randrange(-2, 5)
            self.add(f"#case ({low})" if self.chance(0.6) else f"#range ({low}, {low} + {self.atom()})")
            self.body(0, 2)
            if self.chance(0.7):
                self.add("    #break")
        if self.chance(0.6):
            self.add("#else")
            self.body(0, 2)
        self.in_loop = loop
        self.add("#end")

    def turn(self, counter):
        """The body of a loop."""
        outer, loop = self.scope, self.in_loop
        self.scope, self.in_loop = Scope(outer), True
        self.scope.types[counter] = "1"
        self.scope.fixed.add(counter)
        if self.chance(0.3):
            self.add(f"    #if ({self.condition()}) #break #end")
        self.body(1, 3)
        self.scope, self.in_loop = outer, loop

    def for_(self):
        counter = self.name("I")
        low, count = self.dice.randrange(-3, 4), self.dice.randrange(0, 4)
        step = self.dice.choice(["", ", 1", ", 0.5", ", 2", ", 0.1 * 7", f", {1 + count} / 3"])
        if self.chance(0.2):
            self.add(f"#for ({counter}, {low + count}, {low}, -{self.dice.choice(['1', '0.75'])})")
        else:
            self.add(f"#for ({counter}, {low}, {low} + {count}{step})")
        self.turn(counter)
        self.add("#end")

    def while_(self):
        counter = self.name("W")
        self.add(f"#{self.dice.choice(['local', 'declare'])} {counter} = 0;")
        self.add(f"#while ({counter} < {self.dice.randrange(0, 4)})")
        self.add(f"    #declare {counter} = {counter} + 1;")
        self.turn(counter)
        self.add("#end")
        self.scope.types[counter] = "1"
        self.scope.fixed.add(counter)

    # ---- macros

    def macro(self):
        name = self.name("M")
        parameters = [(self.name("Q"), self.dice.choice("11123345CS"), self.chance(0.5))
                      for _ in range(self.dice.randrange(0, 4))]
        result = self.dice.choice(["", "", "1", "1", "2", "3", "4", "5", "S", "S"])
        outer, self.scope = self.scope, Scope(self.scope)
        comma = self.dice.choice([", ", ", ", " "])
        self.add(f"#macro {name} ({comma.join(parameter for parameter, _, _ in parameters)})")
        for parameter, kind, by_reference in parameters:
            self.scope.types[parameter] = kind
            if not by_reference:
                self.scope.fixed.add(parameter)
        self.scope.macros = {} if self.chance(0.5) else self.scope.macros
        self.in_macro, self.level = True, self.level + 1
        self.statements(0 if result else 1, 4)
        if result:
            text = self.value(result, 2)
            # A sign at the beginning would go on with what stands before.
            self.add(f"({text})" if result in "12345" and (text[0] in "+-" or self.chance(0.7)) else text)
        elif self.chance(0.2):
            self.add("#break")
            self.add(f"#debug \"not reached\\n\"")
        self.in_macro, self.level = False, self.level - 1
        self.add("#end")
        self.unused += [local for local in self.scope.types if local not in outer.types]
        self.scope = outer
        # What stands for a value may print, but not be a part of what is printed: the order is the same for both.
        self.scope.macros[name] = ([(kind, by_reference) for _, kind, by_reference in parameters], result)
        # The macro reads these as they are now: they keep their types from here on.

    def recursion(self):
        name, depth, value, local = (self.name(hint) for hint in ("M", "N", "X", "L"))
        self.add(f"#macro {name}({depth}, {value})")
        self.add(f"    #local {local} = {depth} * {self.literal()};")
        self.add(f"    #if ({depth} > 0)")
        if self.chance(0.5):
            self.add(f"        #declare {value} = {value} + {local};")
            self.add(f"        {name}({depth} - 1, {value})")
            self.add(f'        #debug concat("back ", str({local}, 0, 6), " ", str({value}, 0, 6), "\\n")')
            self.add("    #end")
            self.add("#end")
            total = self.name("V")
            self.add(f"#declare {total} = {self.number(1)};")
            self.add(f"{name}({self.dice.randrange(6)}, {total})")
            self.scope.types[total] = "1"
        else:
            self.add(f"        #local {local} = {local} + {name}({depth} - 1, {value} * 0.5);")
            self.add("    #end")
            self.add(f"    ({local} + {value})")
            self.add("#end")
            self.add(f'#debug concat("{name} ", str({name}({self.dice.randrange(7)}, {self.number(0)}), 0, 12), "\\n")')

    def call_statement(self):
        names = [name for name, (_, result) in self.scope.macros.items() if result == ""]
        if names:
            self.add(self.call_of(self.dice.choice(names), 1))

    def include(self):
        file = f"{self.prefix}_{len(self.files)}.inc"
        spliced = f"concat({self.quoted(file[:-4])}, {self.quoted(file[-4:])})"
        self.add(f"#include {self.dice.choice([self.quoted(file), spliced])}")
        before, self.lines, outer = self.lines, [], self.scope
        self.scope = Scope(outer)
        inner = self.name("L")
        self.add(f"#local {inner} = {self.number(1)};")
        self.scope.types[inner] = "1"
        self.level += 1  # no definitions of macros or arrays, and values that do not grow
        self.statements(1, 4)
        self.level -= 1
        self.files[file], self.lines = "\n".join(self.lines) + "\n", before
        self.unused += [name for name in self.scope.types if name not in outer.types]
        self.scope = outer

    # ---- functions and splines

    def function(self):
        name = self.name("F")
        parameters = self.dice.choice([["x"], ["a"], ["a", "b"], ["x", "y", "z"], []])
        arguments = parameters or ["x", "y", "z"]

        def term(depth):
            if depth <= 0:
                return self.dice.choice(arguments + [self.literal()])
            a, b = term(depth - 1), term(depth - 1)
            return self.dice.choice([
                f"{a} + {b}", f"({a}) * ({b})", f"({a}) - {b}", f"sin({a})", f"cos({b})", f"abs({a})", f"-({a})",
                f"sqrt(abs({a}))", f"max({a}, {b})", f"min({a}, {b})", f"select({a}, {b}, 1)", f"floor({a})",
                f"pow(abs({a}) + 1, 2)", f"({a}) / (abs({b}) + 1)", f"({a} < {b})", f"exp(sin({a}))", f"mod({a}, 7)",
                f"sum(i, 1, 3, i * ({a}))", f"prod(i, 1, 2, i + sin({a}))"])

        head = f"({', '.join(parameters)})" if parameters else ""
        self.add(f"#declare {name} = function{head} {{ {term(2)} }}")
        self.scope.functions[name] = len(arguments)

    def spline(self):
        name = self.name("G")
        kind = self.dice.choice(["linear_spline", "cubic_spline", "natural_spline", "quadratic_spline"])
        points = ", ".join(f"{i * 0.5}, <{self.literal()}, {self.literal()}, {self.dice.randrange(-5, 5)}>"
                           for i in range(self.dice.randrange(4, 7)))
        self.add(f"#declare {name} = spline {{ {kind} {points} }}")
        self.scope.splines[name] = "3"

    def write(self, length):
        """The text of the program, `length` statements and at least one line of output."""
        for _ in range(length):
            self.statement()
        for name, kind in self.scope.types.items():
            if kind == "1":
                self.add(f'#debug concat("{name} ", str({name}, 0, 9), "\\n")')
            elif kind in VECTORS + "C":
                self.add(f'#debug concat("{name} ", vstr(5, {name}, " ", 0, 9), "\\n")')
            elif kind == "S":
                self.add(f'#debug concat("{name} ", {name}, "\\n")')
        return "\n".join(self.lines) + "\n"


def generate(seed, number=0):
    """(text, {name of an included file: its text}) of one program."""
    program = Program(seed, number)
    text = program.write(12 + program.dice.randrange(20))
    return text, program.files


def main():
    text, files = generate(int(sys.argv[1]), int(sys.argv[2]) if sys.argv[2:] else 0)
    print(text, end="")
    for name, part in files.items():
        print(f"// ---- {name}\n{part}", end="")


if __name__ == "__main__":
    main()
