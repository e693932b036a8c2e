"""Text of valid expressions of every type, for generate_programs.py. SPDX-License-Identifier: MIT"""
import random

# Types: "1" a number, "2" to "5" a vector of so many, "C" a colour, "S" a string, "R" a random stream.
VECTORS = "2345"
DEPTH = 3        # nesting of expressions
SETTINGS = ("frame_number", "initial_frame", "final_frame", "clock_delta")


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
            point = f"({name}({self.number(depth)})).{self.dice.choice('xy')}"
            # The last bits of a curve differ, which a decimal half would show.
            return point if self.scope.splines[name] == "linear_spline" else f"(pi * {point})"
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
            # POV-Ray fills shorter operands up with what was there before, but for literals (docs/language.md).
            lambda: f"({self.vector(kind, d)}) + {self.components(int(smaller), 0)}", lambda: f"-{self.vector(kind, 0)}",
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
