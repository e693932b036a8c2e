"""Whole scenes, written at random from POV-Ray's manual: every word in every order, in directives, macros and files.

A scene is a tree of items; what a `Block` holds may be dropped, and a block may be replaced by what it holds, which is
how a scene that fails is made small. Nothing here knows how rtlang reads. What docs/language.md lists as refused, or as
drawn otherwise, is not written. SPDX-License-Identifier: MIT
"""
import random
import string

from whole_looks import AXES, Block, LATER_VERSIONS, PATTERNS, text_of, LookWriter  # noqa: F401


class Writer(LookWriter):
    """Writes one scene."""

    # ---- directives around items

    def torn(self, items, share=0.15):
        """The items, perhaps with some of them in a directive, a macro or an included file, which changes nothing."""
        if not items or not self.chance(share):
            return items
        low = self.dice.randrange(len(items))
        high = self.dice.randint(low + 1, len(items))
        return items[:low] + [self.wrapped(items[low:high])] + items[high:]

    def wrapped(self, items):
        forms = [lambda: Block("#if (1)", items, "#end"), lambda: Block("#if (0) #else", items, "#end"),
                 lambda: Block(f"#ifndef ({self.name('No')})", items, "#end"),
                 lambda: Block("#switch (2) #case (1) #break #range (1.5, 3)", items, "#break #end"),
                 lambda: self.included(items)]
        if self.version in ("", "3.7"):
            forms.append(lambda: Block(f"#for ({self.name('Once')}, 1, 1)", items, "#end"))
        if not self.is_old:
            forms += [lambda: self.in_macro(items)] * 3
        return self.one_of(*forms)

    def included(self, items):
        file = f"whole_{self.number_}_{self.name('part')}.inc"
        return Block(f'#include "{file}"', items, file=file)

    def in_macro(self, items):
        macro = self.name("Macro")
        self.before.append(Block(f"#macro {macro}()", items, "#end"))
        return f"{macro}()"

    # ---- shapes

    def solid(self):
        """The head of a shape that has an inside, about 1 in size."""
        n, v = self.number, self.vector
        whole = lambda: f"box {{ -0.97, <0.98, {self.dice.choice(['0.99', '0.5', '0.75'])}, 0.96>"
        return self.one_of(
            lambda: f"sphere {{ {v(-0.2, 0.2)}, {n(0.6, 1)}", lambda: "sphere { 0 0.97",
            lambda: f"box {{ {v(-0.9, -0.5)}, {v(0.5, 0.9)}", lambda: f"box {{ {v(0.5, 0.9)} {v(-0.9, -0.5)}", whole,
            lambda: f"cylinder {{ <{n(-0.2, 0.2)}, {n(-0.9, -0.5)}, 0>, <0, {n(0.5, 0.9)}, {n(-0.2, 0.2)}>, {n(0.4, 0.7)}",
            lambda: f"cone {{ {n(-0.9, -0.6)} * y, {n(0.6, 0.9)}, {n(0.6, 0.9)} * y, {n(0, 0.4)}",
            lambda: f"torus {{ {n(0.5, 0.8)}, {n(0.15, 0.4)}",
            lambda: f"prism {{ linear_spline {n(-0.8, -0.4)}, {n(0.3, 0.7)}, 4, <-0.8, {n(-0.7, -0.5)}>, <{n(0.4, 0.9)}, -0.7>, "
                    f"<{n(-0.2, 0.8)}, {n(0.3, 0.8)}>, <-0.8, {n(-0.7, -0.5)}>",
            lambda: f"quadric {{ {v(1, 2)}, <{n(-0.5, 0.5)}, 0, {n(-0.5, 0.5)}>, <0, {n(-0.2, 0.2)}, 0>, -0.8",
            self.letters)

    def curved(self):
        """(head, whether it is a sheet) of a shape whose surface POV-Ray finds step by step: rays through glass of it, or
        along its seams with others, end where its tolerances do. No isosurface has an `accuracy` below 0.0002: both ask a
        ray that leaves it from 5 times that on, and POV-Ray's shadows begin at 0.001."""
        n = self.number
        curve = lambda least: ", ".join(f"<{n(least, 0.9)}, {height}>" for height in (-0.83, -0.31, 0.27, 0.79))
        wave = lambda: f"{n(0.2, 0.4)} + {n(0.1, 0.2)} * sin({n(3, 9)} * x) * cos({n(3, 9)} * y)"
        return self.one_of(
            lambda: (f"lathe {{ linear_spline 4, {curve(0.3)}", True),
            lambda: (f"lathe {{ cubic_spline 6, <0.4, -1.1>, {curve(0.4)}, <0.5, 1.1>", True),
            lambda: (f"sor {{ 6, <{n(0.3, 0.5)}, -1.1>, {curve(0.3)}, <0.4, 1.1>", False),
            lambda: (f"superellipsoid {{ <{n(0.3, 1.2)}, {n(0.3, 1.2)}>", False),
            lambda: (f"height_field {{ function {self.dice.randint(5, 20)}, {self.dice.randint(5, 20)} {{ {wave()} }}"
                     + " smooth" * self.chance(0.4) + f" water_level {n(0.1, 0.3)}" * self.chance(0.3)
                     + " translate -0.5 scale 1.6", True),
            lambda: (f"isosurface {{ function {{ x*x + y*y*{n(0.8, 1.6)} + z*z - {n(0.4, 0.7)} + {n(0.05, 0.1)} * sin({n(3, 6)} * x) }} "
                     "contained_by { sphere { 0, 0.97 } } accuracy 0.0003 max_gradient 4", True),
            lambda: (f"blob {{ threshold {n(0.3, 0.6)} sphere {{ <-0.3, 0, 0>, {n(0.7, 0.9)}, 1 }} "
                     f"cylinder {{ <0, -0.3, 0>, <0.4, 0.3, 0.2>, {n(0.5, 0.7)}, {n(0.6, 1)} }}", True),
            lambda: ("bicubic_patch { " + f"type {self.dice.randint(0, 1)} flatness {self.enlarged(n(0.005, 0.1))} u_steps "
                     f"{self.dice.randint(1, 4)} v_steps {self.dice.randint(1, 4)} " + ", ".join(
                         f"<{column / 2 - 0.75}, {n(-0.5, 0.5)}, {row / 2 - 0.75}>" for row in range(4) for column in range(4)), True),
            lambda: ("mesh { " + " ".join(
                f"triangle {{ <-0.8, {n(-0.7, -0.5)}, {layer / 5}>, <0.9, {n(-0.6, 0)}, {layer / 5}>, <{n(-0.2, 0.2)}, 0.8, {layer / 5}> }}"
                for layer in range(4)), True))

    def letters(self):
        font = self.dice.choice(["timrom", "cyrvetic", "crystal"])
        text = "".join(self.dice.choice(string.ascii_letters + string.digits + "!#$%&*+-?@") for _ in range(2))
        return f'text {{ ttf "{font}.ttf" "{text}" {self.number(0.3, 0.7)}, {self.number(-0.1, 0.2)} * x'

    def sheet(self):
        """The head of a shape that has none."""
        n, v = self.number, self.vector
        ends = "" if self.has_fog else " open"  # POV-Ray and the fog in what is open: docs/language.md
        return self.one_of(
            lambda: f"disc {{ {v(-0.2, 0.2)}, {v(0.2, 1)}, {n(0.7, 1)}",
            lambda: f"disc {{ {v(-0.2, 0.2)}, {v(0.2, 1)}, {n(0.7, 1)}, {n(0.2, 0.5)}",
            lambda: f"triangle {{ <{n(-1, -0.7)}, {n(-0.7, -0.5)}, 0>, <{n(0.7, 1)}, {n(-0.5, -0.2)}, 0.3>, <0, {n(0.7, 1)}, -0.2>",
            lambda: f"smooth_triangle {{ <{n(-1, -0.7)}, {n(-0.7, -0.5)}, 0>, {v(0.2, 1)}, <{n(0.7, 1)}, {n(-0.5, -0.2)}, 0.3>, {v(0.2, 1)}, "
                    f"<0, {n(0.7, 1)}, -0.2>, {v(0.2, 1)}",
            lambda: f"cylinder {{ <{n(-0.9, -0.6)}, 0, 0>, <{n(0.6, 0.9)}, 0.1, 0>, {n(0.4, 0.7)}{ends}",
            lambda: f"cone {{ {n(-0.9, -0.6)} * y, {n(0.6, 0.9)}, {n(0.6, 0.9)} * y, {n(0.2, 0.4)}{ends}")

    def member(self, share, is_cut=False, depth=0):
        """A solid of a group that cuts it with others, or not, with or without a surface of its own."""
        if depth < 2 and self.chance(0.15):
            return self.inner_group(share, is_cut, depth)
        items = self.solid_of(lambda: self.surface(False, True)) if self.chance(share) else []
        return Block(self.solid(), self.shuffled_in([f"translate {self.vector(-0.5, 0.5)}"], items))

    def inner_group(self, share, is_cut, depth):
        """language.md: POV-Ray shows a union of what is inside out in the boxes of its members."""
        head = self.dice.choice(["union {", "merge {", "difference {", "intersection {"])
        items = [self.member(share, head in ("difference {", "intersection {"), depth + 1) for _ in range(2)]
        items += self.solid_of(lambda: self.surface(False, True)) if self.chance(share) else []
        return Block(head, items + [f"translate {self.vector(-0.3, 0.3)}"] + ["inverse"] * (is_cut and self.chance(0.1)))

    def clip(self):
        """What clips an object: something that no ray meets along a surface of the object's."""
        return Block("clipped_by {", self.one_of(
            lambda: [f"plane {{ {self.vector(0.1, 1)}, {self.number(0.1, 0.3)} }}"],
            lambda: [f"sphere {{ {self.vector(-0.2, 0.2)}, {self.number(0.7, 0.9)}" + " inverse" * self.chance(0.3) + " }"],
            lambda: [f"box {{ {self.vector(-0.9, -0.4)}, {self.vector(0.4, 0.9)}" + " inverse" * self.chance(0.3) + " }"],
            lambda: [f"plane {{ {self.vector(0.1, 1)}, {self.number(0.1, 0.3)} }}",
                     f"plane {{ {self.vector(-1, -0.1)}, {self.number(0.1, 0.3)} }}"]))

    def shuffled_in(self, some, items):
        """`items` in their order with `some` put somewhere among them."""
        items = list(items)
        for one in some:
            items.insert(self.dice.randint(0, len(items)), one)
        return items

    def shape(self):
        """(head, items that come first, tail, is simple, is flat)."""
        choice = self.dice.random()
        if choice < 0.03:  # with its sign it is seen where it is stretched
            return f"sphere {{ 0, {self.number(-0.95, -0.7)}", [f"scale <1, 1.1, {self.number(0.8, 1)}>"], "}", False, False
        if choice < 0.45:
            return self.solid(), [], "}", True, False
        if choice < 0.55:
            return self.sheet(), [], "}", False, True
        if choice < 0.62:
            return "object {", [Block(self.solid(), self.surface(below=True)
                                      if self.chance(0.3) else [])], "}", False, False
        if choice < 0.7 and self.names["object"]:
            return self.dice.choice(self.names["object"])[0], [], "}", False, True
        if choice < 0.8:
            head = self.dice.choice(["union {", "union {", "#if (1) union { #else merge { #end", "merge {"])
            return head, self.torn([self.member(0.4) for _ in self.some(3, 2)], 0.3), "}", False, False
        if choice < 0.9:
            other = Block(self.one_of(self.solid, lambda: f"sphere {{ 0, {self.number(-1, -0.8)}"),
                          ["scale 0.7", f"translate {self.vector(0.2, 0.6)}"])
            return "difference {", [self.member(0.3, True), other], "}", False, False
        other = self.dice.choice([Block(f"plane {{ {self.vector(0.1, 1)}, {self.number(0.1, 0.3)}", []),
                                  self.member(0.3, True)])
        return "intersection {", self.shuffled([self.member(0.3, True), other]), "}", False, False

    def interior_items(self):
        items = [f"ior {self.number(1, 1.6)}"] * self.chance(0.8) + [f"caustics {self.number(0.1, 0.5)}"] * self.chance(0.2)
        if self.chance(0.4):
            items += [f"fade_distance {self.enlarged(self.number(0.3, 2))}", f"fade_power {self.number(0.5, 3)}"]
            items += [f"fade_color {self.colour()}"] * self.chance(0.3)
        return self.shuffled(items)

    def interior(self):
        known = self.known("interior")
        return Block("interior {", ([known] if known else []) + (self.interior_items() if not known or self.chance(0.3) else []))

    def curved_object(self, place):
        head, is_sheet = self.curved()
        items = self.surface() if head.startswith(("mesh", "bicubic", "height")) else self.solid_of(self.surface)
        items = self.shuffled_in([self.transform(0.2) for _ in self.some(2)], items)
        early = [self.clip()] * (not is_sheet and self.chance(0.15))
        flags = [word for word in ("no_shadow", "no_reflection", "hollow", "no_image") if self.chance(0.05)]
        items = early + self.shuffled_in([f"translate <{place[0]}, {place[1]}, {place[2]}>"] + flags, items)
        return Block(head, self.torn(items) + self.growth())

    def object(self, place):
        if self.chance(0.2):
            return self.curved_object(place)
        head, first, tail, is_simple, is_flat = self.shape()
        # Light through clear letters depends on the unit of length in POV-Ray, in some pixels; so letters are opaque.
        items = self.solid_of(self.surface) if head.startswith("text") else self.surface()
        if self.chance(0.2):
            items = self.shuffled_in([self.interior()], items)
        # A matrix that stretches a smooth triangle: docs/language.md, "Stretched smooth triangles".
        move = (lambda: f"rotate {self.vector(-180, 180)}") if head.startswith("smooth") else lambda: self.transform(0.2)
        items = self.shuffled_in([move() for _ in self.some(2)], items)
        early = []
        if is_simple and self.chance(0.15):
            early = [self.clip()]
        flags = [word for word in ("no_shadow", "no_reflection", "hollow", "bounded_by { sphere { 0, 9 } }", "no_image",
                                   "inverse", "no_radiosity") if self.chance(0.05) and not (word == "inverse" and is_flat)]
        if "inverse" in flags or head.startswith("intersection"):  # which may have no end
            flags = [word for word in flags if not word.startswith("bounded_by")]
        if head.startswith("Object_"):
            head, first = "object {", [head]
        items = first + early + self.shuffled_in([f"translate <{place[0]}, {place[1]}, {place[2]}>"] + flags, items)
        items = items if is_flat else self.torn(items[:len(first)], 0) + self.torn(items[len(first):])
        return Block(head, items + self.growth(), tail)

    # ---- the rest of a scene

    def camera(self):
        kind = self.dice.choice(["", "", "", "perspective", "orthographic", "fisheye", "ultra_wide_angle",
                                 "panoramic"] +
                                ["spherical"] * (self.version not in ("3.0", "3.1")))
        far = {"panoramic": 3, "spherical": 5}.get(kind, 7)
        away = [self.dice.uniform(-1, 1) for _ in range(3)]
        size = max(sum(c * c for c in away) ** 0.5, 0.3)
        place = [far * c / size + 0.0371 for c in away]
        # Some kinds draw another picture when their vectors are longer; of others these are the size of what is seen.
        growth = self.growth() if kind == "orthographic" else []
        grown = lambda text: text if growth else self.enlarged(text)
        moved = f" + {self.shift} * <1, 0.7, -0.4>" if self.shift else ""
        words = [f"location {grown('<' + ', '.join(self.literal(c) for c in place) + '>')}{moved}"]
        vector = lambda: self.dice.choice(AXES +
                                          [f"<{self.number(-1, 1)}, {self.number(-1, 1)}, {self.number(0.2, 1)}>"])
        vectors = {"direction": lambda: f"{self.number(0.7, 1.5)} * {vector()}", "up": vector,
                   "right": lambda: self.dice.choice(["x * image_width / image_height", "-4/3 * x", vector(),
                                                      "1.33 * x"])}
        words += [f"{word} {make()}" for word, make in vectors.items() if self.chance(0.4)]
        if self.chance(0.4):
            words.append(f"sky {self.dice.choice([vector(), 'z', '-y'])}")
        words.append(f"look_at {grown(self.vector(-0.3, 0.3))}")
        if self.chance(0.5):
            wide = self.number(160, 350) if kind == "spherical" and self.chance(0.5) else self.number(45, 90)
            words.append(f"angle {wide}" + f" {self.number(40, 90)}" * (kind == "spherical" and self.chance(0.5)))
        moves = [f"translate {grown(self.vector(-0.3, 0.3))}", f"rotate {self.vector(-20, 20)}",
                 f"scale {self.number(0.9, 1.1)}",
                 f"scale <1, {self.number(0.8, 1.2)}, 1>"]
        words = self.torn(self.shuffled(words), 0.3) + [move for move in self.shuffled(moves) if self.chance(0.15)]
        items = ([kind] if kind else []) + words
        if self.chance(0.2):
            camera = self.name("Camera")
            return [Block(f"#declare {camera} = camera {{", items), Block("camera {", [camera] +
                                                                          [move for move in moves if self.chance(0.1)] + growth)]
        return [Block("camera {", items + growth)]

    def light(self):
        place = f"<{self.number(3, 6) if self.chance(0.5) else self.number(-6, -3)}, {self.number(3, 7)}, {self.number(-7, -2)}>"
        words = self.one_of(
            list, list, lambda: ["shadowless"],
            lambda: ["spotlight"] + self.shuffled([f"radius {self.number(10, 25)}", f"falloff {self.number(30, 45)}",
                                                   f"tightness {self.number(0, 10)}",
                                                   f"point_at {self.vector(-1, 1)}"]),
            lambda: ["cylinder"] + self.shuffled([f"radius {self.enlarged(self.number(1, 3))}",
                                                  f"falloff {self.enlarged(self.number(3, 5))}",
                                                  "point_at 0"]),
            lambda: ["parallel", f"point_at {self.vector(-1, 1)}"],
            lambda: [f"looks_like {{ sphere {{ 0, {self.number(0.2, 0.5)} pigment {{ {self.colour()} }} }} }}"],
            lambda: [f"area_light {self.vector(0.3, 1)}, {self.vector(-1, -0.3)}, {self.dice.randint(1, 4)}, 3"] +
            self.shuffled([f"adaptive {self.dice.randint(0, 2)}"] * self.chance(0.5) + ["circular"] * self.chance(0.3)),
            lambda: self.shuffled([f"fade_distance {self.enlarged(self.number(3, 8))}", f"fade_power {self.number(1, 2)}"]))
        moves = [f"rotate {self.vector(-30, 30)}", f"translate {self.vector(-0.5, 0.5)}"]
        items = words[:1] + self.torn(words[1:], 0.1) + [move for move in moves if self.chance(0.15)]
        colour = f"{self.dice.choice([',', ''])} {self.dice.choice(['color ', ''])}rgb {self.number(0.5, 1)}"
        return Block(f"light_source {{ {place}{colour}", items + self.growth())

    def sky(self):
        colours = [f"[{at} {self.colour()}]" for at in self.positions()]
        layers = [Block("pigment {", [self.dice.choice(["gradient x", "gradient y", "gradient <1, 1, 1>", "bozo",
                                                        "onion", "checker"])] +
                        self.shuffled([Block("color_map {", colours), f"scale {self.number(0.4, 2.1)}",
                                       self.transform(1)]))]
        if "checker" in layers[0].items:
            layers[0].items = self.list_pattern(self.colour)
        sphere = Block("sky_sphere {", layers)
        if not self.has_fog:
            return self.one_of(lambda: [Block("sky_sphere {", layers + [self.transform(1) for _ in self.some(1)])],
                               lambda: [sphere], lambda: [f"background {{ {self.colour()} }}"])
        return [sphere] + [self.fog() for _ in self.some(2, 1)]

    def fog(self):
        words = [f"distance {self.enlarged(self.number(10, 30))}",
                 self.dice.choice(["", "color "]) + self.dice.choice(["rgb ", "rgb ", "rgbt <0.2, 0.1, 0.1, 0.1> + "]) +
                 self.number(0, 1)]
        if self.chance(0.4):
            words += ["fog_type 2", f"fog_alt {self.enlarged(self.number(0.5, 2))}",
                      f"fog_offset {self.enlarged(self.number(-2, 1))}"]
            words += [f"up {self.vector(0.1, 1)}"] * self.chance(0.3)
        return Block("fog {", self.shuffled(words))

    def floor(self):
        is_whole = self.chance(0.4)
        at = f"-{self.literal(self.dice.uniform(2.6, 4))}"
        head = self.dice.choice([f"plane {{ y, {at}", f"plane {{ <0, 1, 0>, {at}",
                                 f"plane {{ {self.vector(-0.1, 0.1)} + y, {at}",
                                 f"box {{ <-9, {at} - 1, -9>, <9, {at}, 9>", f"plane {{ -z, {at}",
                                 f"plane {{ -x, {at}"])
        if is_whole:
            return self.whole_floor()
        return Block(head, self.surface() + ["hollow"] * self.chance(0.3) + self.growth())

    def whole_floor(self):
        """Blocks on a floor in whole numbers, where other patterns jump as the last bits fall, but blocks end before."""
        word, count = self.dice.choice([("checker", 2), ("brick", 2)])
        blocks = Block("pigment {", [word] + self.list_of(lambda: self.colour(True), count) +
                       ["brick_size <1, 1, 0.5> mortar 0.1"] * (word == "brick") + ["scale 0.5"] * self.chance(0.3))
        down = self.dice.randint(2, 4)
        floor = self.one_of(
            lambda: Block(f"plane {{ y, -{down}", [blocks]),
            lambda: Block("plane { y, 0", [blocks, f"translate -{down} * y"]),
            lambda: Block(f"box {{ <-9, -{down} - 1, -9>, <9, -{down}, 9>", [blocks,
                                                                             f"rotate {self.number(-180, 180)} * y"]),
            lambda: Block(f"plane {{ z, {down}", [blocks, "rotate 90 * x"]),
            lambda: Block("plane { y, 0", [f"rotate {self.number(-180, 180)} * y", f"translate -{down} * y", blocks]))
        floor.items += self.growth()
        return floor

    def declaration(self):
        """Something with a name, of which the rest may be made."""
        kind = self.dice.choice(["number", "vector", "colour", "pigment", "normal", "finish", "texture", "map",
                                 "transform", "object", "interior", "material"])
        name = self.name(kind.capitalize())
        make = {
            "vector": lambda: f"#declare {name} = {self.vector(-1, 1)};",
                "colour": lambda: f"#declare {name} = {self.colour_value()};",
            "pigment": lambda: Block(f"#declare {name} = pigment {{", self.pigment_items()),
            "normal": lambda: Block(f"#declare {name} = normal {{", self.normal_items()),
            "finish": lambda: Block(f"#declare {name} = finish {{", self.finish().items),
            "texture": lambda: Block(f"#declare {name} = texture {{", self.texture_parts()),
            "interior": lambda: Block(f"#declare {name} = interior {{", self.interior_items()),
            "material": lambda: Block(f"#declare {name} = material {{", self.material_items()),
            "map": lambda: Block(f"#declare {name} = color_map {{",
                                 [f"[{at} {self.colour(True)}]" for at in self.positions()]),
            "transform": lambda: Block(f"#declare {name} = transform {{", [self.transform(0.2) for _ in self.some(2,
                                                                                                                  1)]),
            "object": lambda: Block(f"#declare {name} = union {{", [self.member(0.6), self.member(0.3)] +
                                    (self.surface(below=True) if self.chance(0.5) else [])),
        }
        if kind == "number":
            value = float(self.literal(self.dice.uniform(0, 1)))
            made, entry = f"#declare {name} = {self.literal(value)};", (name, value)
        else:
            made, entry = make[kind](), (name, None)
        self.names[kind].append(entry)
        return made

    def colour_value(self):
        """A colour on the right of `=`."""
        return f"{self.dice.choice(['', 'color '])}rgb <{self.number(0, 1)}, {self.number(0, 1)}, {self.number(0, 1)}>"

    def solid_of(self, make):
        """What is made, without anything that lets light through."""
        before, self.is_solid = self.is_solid, True
        made = make()
        self.is_solid = before
        return made

    def default(self):
        """Nothing clear: of a clear surface in an opaque whole POV-Ray's shadows depend on what it drew before."""
        return Block("#default {", [self.solid_of(lambda: self.one_of(
            lambda: self.finish(False), self.pigment, lambda: Block("texture {", [
                part for part in self.texture_parts(False) if not str(getattr(part, "head", "")).startswith("normal")]),
            lambda: Block("normal {", [f"{self.dice.choice(PATTERNS[3:20])}, {self.number(0.1, 0.7)}"])))])

    def settings(self):
        words = ["assumed_gamma " + self.dice.choice(["1", "1.0", "2.2", "srgb"])] * self.chance(0.8
                                                                                                 if self.version == "3.7" else 0.3)
        words += [f"ambient_light {self.colour()}"] * self.chance(0.2) + [f"max_trace_level {self.dice.randint(3, 7)}"] * self.chance(0.3)
        words += [f"noise_generator {self.dice.randint(1, 3)}"] * self.chance(0.1)
        words += [f"number_of_waves {self.dice.randint(1, 12)}"] * self.chance(0.1)
        # POV-Ray follows a ray for each texture of a map and for each mirror of a layer, and gives up each by its own weight.
        return [Block("global_settings {", self.shuffled(words + ["adc_bailout 0.00001"]))]

    def scene(self):
        begin = [f"#version {self.version};"] * bool(self.version) + self.settings()
        statements = []

        def add(*made):
            statements.extend(self.before + list(made))
            self.before = []

        if self.chance(0.2):
            add(self.default())
        for _ in self.some(6):
            add(self.declaration())
        parts = [self.camera] + [lambda: [self.light()] for _ in self.some(3, 1)] + [self.sky] * self.chance(0.8)
        parts += [lambda: [self.floor()]] * self.chance(0.8)
        places = [(f"{x}13", f"{y}17", f"{z}11") for x in (-1.4, 1.4) for y in (-1.2, 1.2)
                  for z in (-1.4, 1.4)]
        parts += [lambda place=place: [self.object(place)] for place in self.dice.sample(places, self.dice.randint(2,
                                                                                                                   4))]
        parts += [lambda: [self.default()]] * self.chance(0.3) + [lambda: [self.declaration()]] * self.dice.randint(0,
                                                                                                                    2)
        for make in self.shuffled(parts):
            if not self.is_old and self.chance(0.05):
                self.version = self.dice.choice(LATER_VERSIONS)
                add(f"#version {self.version};")
            made = make()
            add(*(self.torn(made, 0.1)))
        return Block("", begin + statements, "")


def scene_of(seed, number, size=1, shift=0):
    return Writer(seed, number, size, shift).scene()
