#!/usr/bin/env python3
"""Writes programs in the scene language that are valid and print what they work out: all types, operators and functions,
scopes, directives, macros by value and by reference, arrays, strings.

The same seed gives the same program. Names begin with `P` and the program's number, so that many programs can stand in one
file. Usage: generate_programs.py SEED [NUMBER]   Prints one. SPDX-License-Identifier: MIT
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
from generate_expressions import Expressions, Scope, VECTORS  # noqa: E402

BLOCK_DEPTH = 3  # nesting of directives

# Functions and constants that the programs leave out: of objects, of patterns, and of the clock on the wall.
LEFT_OUT = {"trace", "inside", "min_extent", "max_extent", "vturbulence", "datetime", "now", "internal"}


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
        blocks = [self.if_, self.ifdef, self.switch, self.for_, self.while_, self.call_statement, self.torn_value]
        if not self.in_macro:  # which may stand for a value
            blocks += [self.object, self.torn_object]
        top = [self.macro, self.macro, self.array, self.array, self.include, self.redeclare, self.recursion,
               self.version, self.function, self.spline, self.data_file, self.default, self.torn_macro]
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

    # ---- blocks, and statements that directives tear apart

    def say(self):
        """A line that is printed while something else is read."""
        self.printed += 1
        return f'#debug concat("{self.printed}: ", str({self.number(1)}, 0, 9), "\\n")'

    def point(self):
        return f"<{self.number(0)}, {self.number(0)}, {self.number(0)}>"

    def item(self):
        """What may stand among the properties of an object."""
        return self.dice.choice([
            lambda: self.say(), lambda: f"translate {self.point()}", lambda: f"rotate {self.literal()} * y",
            lambda: "scale 2", lambda: f"pigment {{ {self.say()} rgb {self.point()} }}",
            lambda: f"finish {{ ambient {self.literal()} #if ({self.condition()}) diffuse {self.literal()} #end }}",
            lambda: f"#if ({self.condition()}) {self.say()} translate {self.point()} #else {self.say()} #end",
            lambda: f"#ifndef ({self.name('U')}) scale <1, 2, 1> #end",
        ])()

    def sphere(self):
        return f"sphere {{ {self.point()}, 1 + abs({self.literal()}) {' '.join(self.items(2))} }}"

    def items(self, most):
        return [self.item() for _ in range(self.dice.randrange(most + 1))]

    def object(self):
        counter = self.name("I")
        body = self.dice.choice([
            lambda: self.sphere(),
            lambda: f"union {{ {self.sphere()} #for ({counter}, 1, 2) {self.sphere()} {self.say()} #end {' '.join(self.items(2))} }}",
            lambda: f"box {{ {self.point()}, {self.point()} {' '.join(self.items(3))} }}",
        ])()
        if self.chance(0.4) and self.level == 0:
            name = self.name("O")
            self.add(f"#declare {name} = {body}")
            self.add(f"object {{ {name} {' '.join(self.items(1))} }}")
            self.scope.fixed.add(name)
        else:
            self.add(body)

    def torn_value(self):
        """A value of which a directive's branch holds a part that begins or ends with an operator."""
        counter = self.name("I")
        name, condition = self.name("V"), self.condition()
        text = self.dice.choice([
            lambda: f"({self.atom()} #if ({condition}) + {self.atom()} #else - {self.atom()} #end)",
            lambda: f"({self.atom()} #if ({condition}) * #else + #end ({self.number(1)}))",
            lambda: f"(0 #for ({counter}, 1, 3) + {counter} * {self.atom()} #end)",
            lambda: f"<{self.atom()}, {self.atom()} #if ({condition}) * 2, #else - 1, #end {self.literal()}>.y",
            lambda: f"(#switch ({self.dice.randrange(3)}) #case (0) {self.say()} 1 + #case (1) 2 #break #else -3 #end)",
            lambda: f"min({self.atom()}, #if ({condition}) {self.atom()}, #end {self.literal()})",
        ])()
        self.add(f"#declare {name} = {text};")
        self.add(f'#debug concat("{name} ", str({name}, 0, 9), "\\n")')

    def torn_object(self):
        condition = self.condition()
        self.add(self.dice.choice([
            lambda: f"#if ({condition}) union {{ #else merge {{ #end {self.sphere()} {self.say()} {self.sphere()} }}",
            lambda: f"sphere {{ {self.point()}, 1 #if ({condition}) translate {self.point()} }} {self.say()} #else scale 2 }} #end",
            lambda: f"#ifdef ({self.name('U')}) sphere {{ 9, #else {self.say()} sphere {{ {self.point()}, #end 0.5 }}",
            lambda: f"box {{ #if ({condition}) {self.point()}, #else -1, {self.say()} #end 9 {' '.join(self.items(2))} }}",
        ])())

    def torn_macro(self):
        """A macro that opens a block, or holds the rest of an expression."""
        name, parameter = self.name("M"), self.name("Q")
        if self.chance(0.5):
            self.add(f"#macro {name}({parameter}) union {{ sphere {{ {parameter} * x, 1 }} {self.say()} #end")
            self.add(f"{name}({self.atom()}) {self.sphere()} }}")
        else:
            value = self.name("V")
            self.add(f"#macro {name}({parameter}) + {parameter} * {self.literal()} #end")
            self.add(f"#declare {value} = ({self.atom()} {name}({self.atom()}) {name}(2));")
            self.add(f'#debug concat("{value} ", str({value}, 0, 9), "\\n")')

    def default(self):
        self.add(self.dice.choice([
            lambda: f"#default {{ finish {{ ambient {self.literal()} {self.say()} phong 1 }} }}",
            lambda: f"#default {{ pigment {{ rgb {self.point()} }} }}",
            lambda: f"#default {{ texture {{ pigment {{ rgb 1 }} finish {{ #if ({self.condition()}) diffuse 1 #end }} }} }}",
        ])())

    # ---- data files

    def data_file(self):
        """Numbers, vectors and strings that are read back; the number of values is known or asked for."""
        file, data = self.name("D"), f"{self.prefix}_{len(self.files)}.txt"
        kinds = [self.dice.choice("113S") for _ in range(self.dice.randrange(1, 7))]
        signed = lambda: self.dice.choice(["", "-", "+"]) + self.literal()
        values = {"1": signed, "3": lambda: f"<{signed()}, {signed()}, {signed()}>",
                  "S": lambda: self.quoted(f"s{self.dice.randrange(100)}")}
        shown = {"1": 'str({0}, 0, 9)', "3": 'vstr(3, {0}, " ", 0, 9)', "S": "{0}"}
        blank = self.dice.choice([" ", "\n", "  // why not\n", "\t"])
        self.files[data] = ("," + blank).join(values[kind]() for kind in kinds) + self.dice.choice(["", ",", ",\n"])
        self.add(f"#fopen {file} {self.quoted(data)} read")
        if len(set(kinds)) == 1 and self.chance(0.6):
            value, count = self.name("V"), self.name("N")
            self.add(f"#declare {count} = 0;")
            self.add(f"#while (defined({file}))")
            self.add(f"    #read ({file}, {value})")
            self.add(f'    #debug concat("{value} ", {shown[kinds[0]].format(value)}, "\\n")')
            self.add(f"    #declare {count} = {count} + 1; #if ({count} > {len(kinds)}) #break #end")
            self.add("#end")
        else:
            names = [self.name("V") for _ in kinds]
            split = self.dice.randrange(len(kinds) + 1)
            for part in filter(None, (names[:split], names[split:])):
                self.add(f"#read ({file}, {', '.join(part)})")
            for name, kind in zip(names, kinds):
                self.add(f'#debug concat("{name} ", {shown[kind].format(name)}, "\\n")')
        self.add(f"#fclose {file}")

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
        self.scope.splines[name] = kind

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
