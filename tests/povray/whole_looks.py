"""How surfaces of whole_scenes.py look: values, transforms, patterns, pigments, normals, finishes and textures at random.

SPDX-License-Identifier: MIT
"""
import random
import string

VERSIONS = ["3.7"] * 8 + ["", "", "3.6", "3.6", "3.5", "3.1", "3.1", "3.0", "3.62"]
LATER_VERSIONS = ["3.7", "3.6", "3.5", "3.1"]
AXES = ["x", "y", "z", "-x", "-y", "-z"]
WAVES = ["ramp_wave", "triangle_wave", "sine_wave", "scallop_wave", "cubic_wave", "poly_wave", "poly_wave 2"]
PATTERNS = ["gradient x", "gradient -y", "gradient <1, 2, -1>", "onion", "radial", "leopard", "spherical", "boxed",
            "planar", "cylindrical", "bozo", "spotted", "bumps", "granite", "agate", "marble", "wood", "wrinkles",
            "dents", "ripples", "waves", "cells", "crackle", "spiral1 3", "mandel 9", "julia <0.353, 0.288>, 8"]
PATTERN_WORDS = {"crackle": ["form <-1, 1, 0>", "form <0.4, 0.2, -0.1>", "metric 1.3", "metric 3", "offset 0.3", "solid"],
                 "agate": ["agate_turb 0.4"], "bozo": ["noise_generator 1"], "wood": ["noise_generator 3"],
                 "granite": ["noise_generator 2"]}
FINISH = {"ambient": (0, 0.4), "diffuse": (0.3, 1), "phong": (0, 1), "phong_size": (3, 60), "specular": (0, 1),
          "roughness": (0.02, 0.3), "brilliance": (0.5, 3), "metallic": (0, 1), "diffuse albedo": (0.3, 1),
          "emission": (0, 0.2), "phong albedo": (0, 0.2), "specular albedo": (0, 0.2), "diffuse 0.6,": (0, 0.5)}


class Block:
    """`head`, then items that may be dropped, then `tail`. With a file's name in `file`, the text of that file."""

    def __init__(self, head, items, tail="}", file=None):
        self.head, self.items, self.tail, self.file = head, items, tail, file

    def write(self, files, depth=0):
        """The text; texts of included files go into `files`."""
        if self.file:
            files[self.file] = "".join(written(item, files, 0) for item in self.items)
            return "    " * depth + self.head + "\n"
        margin = "    " * depth
        inner = depth + 1 if self.head else depth
        text = "".join(written(item, files, inner) for item in self.items)
        return f"{margin}{self.head}\n{text}{margin}{self.tail}\n" if self.head else text


def written(item, files, depth):
    return item.write(files, depth) if isinstance(item, Block) else "    " * depth + item + "\n"


def text_of(scene):
    """(text, {name: text of an included file})."""
    files = {}
    return scene.write(files), files


class LookWriter:
    """Writes what makes a surface's look. `names` hold what is declared, by kind: (name, value where it is a number)."""

    def __init__(self, seed, number, size=1, shift=0):
        """`size`: how many times as large all lengths are. The picture is the same. `shift`: how far the camera is moved."""
        self.size, self.shift = size, shift
        self.dice = random.Random(f"{seed} {number}")
        self.number_ = number
        self.count = 0
        self.names = {kind: [] for kind in ("number", "vector", "colour", "pigment", "normal", "finish", "texture",
                                            "map", "transform", "object", "interior", "material", "loop")}
        self.has_fog = self.chance(0.2)
        self.is_solid = False  # what is written lets no light through
        self.before = []  # definitions that must stand before the statement that is being written
        self.version = self.dice.choice(VERSIONS)
        self.is_old = self.version not in ("", "3.7") and float(self.version) < 3.1

    # ---- choices

    def chance(self, share):
        return self.dice.random() < share

    def name(self, kind):
        self.count += 1
        return f"{kind}_{self.count}"

    def one_of(self, *makers):
        return self.dice.choice(makers)()

    def shuffled(self, items):
        items = list(items)
        self.dice.shuffle(items)
        return items

    def some(self, most, least=0):
        return range(self.dice.randint(least, most))

    def known(self, kind):
        """The name of something declared, or None."""
        # Up to 3.1 POV-Ray makes `transmit` of the filters of what lies over something, of a name's own map, too.
        if (self.is_solid or self.version in ("3.0", "3.1")) and kind in ("pigment", "texture", "map", "material"):
            return None
        return self.dice.choice(self.names[kind])[0] if self.names[kind] and self.chance(0.4) else None

    def enlarged(self, length):
        """The text of a length that no transform changes."""
        return length if self.size == 1 else f"{length} * {self.size}"

    def growth(self):
        """The last item of what transforms make larger."""
        return [] if self.size == 1 else [f"scale {self.size}"]

    # ---- values

    def literal(self, value):
        """Never a round one unless it is whole, and hardly ever the same twice: where faces meet, rounding decides."""
        if value == int(value):
            return str(int(value))
        text = f"{value:.5f}"
        return text + "7" if text.endswith("00") else text

    def number(self, low, high):
        value = float(self.literal(self.dice.uniform(low, high)))
        if self.chance(0.75):
            return self.literal(value)
        beside = self.dice.choice(self.names["number"] or [("0.25", 0.25)])
        rest = round(value - beside[1], 6)
        return self.one_of(
            lambda: f"({beside[0]} {'-' if rest < 0 else '+'} {abs(rest)})",
            lambda: f"({rest} + {beside[0]})",
            lambda: f"({self.literal(value * 2)} / 2)",
            lambda: f"max({self.literal(value)}, -100)",
            lambda: f"(<7, {self.literal(value)}, 3>.y)",
            lambda: f"(1 > 2 ? 9 : {self.literal(value)})",
            lambda: f"({self.literal(value)} + 0.01 * {self.names['loop'][-1][0]})" if self.names["loop"] else
            self.literal(value))

    def vector(self, low, high):
        a, b, c = (self.number(low, high) for _ in range(3))
        return self.one_of(
            lambda: f"<{a}, {b}, {c}>", lambda: f"<{a}, {b}, {c}>", lambda: f"<{a}, {b}, {c}>",
            lambda: f"<{a}, {b} {self.dice.choice([',', ''])} {c}>" if not c.startswith("-") else f"<{a}, {b}, {c}>",
            lambda: f"({a} * x + {b} * y + {c} * z)", lambda: f"(<{a}, {b}> + z * {c})",
            lambda: f"vrotate(<{a}, {b}, {c}>, 0)")

    def colour(self, clear=False, word=None):
        """Written as a pigment may have it, with filter or transmit where `clear`."""
        word = word or self.dice.choice(["", "", "color ", "colour "])
        clear = clear and not self.is_solid
        r, g, b = (self.number(0, 1) for _ in range(3))
        f, t = (self.number(0, 0.5) for _ in range(2))
        known = self.known("colour")
        if known:
            return word + known + self.dice.choice(
                ["", "", f" * {self.number(0.3, 1)}"] + [f" filter {f}", f" transmit {t}"] * clear)
        forms = [f"rgb <{r}, {g}, {b}>"] * 3 + [f"rgb {self.vector(0, 1)}", f"rgb {r}", f"rgb <{r}, {g}, {b}> * {g}"]
        if clear:
            forms += [f"rgbf <{r}, {g}, {b}, {f}>", f"rgbt <{r}, {g}, {b}, {t}>", f"rgbft <{r}, {g}, {b}, {f}, {t}>",
                      f"rgb <{r}, {g}, {b}> filter {f}", f"rgb <{r}, {g}, {b}> transmit {t}"] * 2
        if word:
            forms += [f"red {r} green {g} blue {b}", f"blue {b} red {r}", f"<{r}, {g}, {b}>"]
        return word + self.dice.choice(forms)

    # ---- transforms

    def transform(self, size=0.3, turn=180):
        known = self.known("transform")
        if known:
            return f"transform {self.dice.choice([known, '{ ' + known + ' }'])}"
        return self.one_of(
            lambda: f"translate {self.vector(-size, size)}",
            lambda: f"rotate {self.dice.choice(['x', 'y', 'z'])} * {self.number(-turn, turn)}",
            lambda: f"rotate {self.vector(-turn, turn)}",
            lambda: f"scale {self.number(0.7, 1.2)}", lambda: f"scale {self.vector(0.7, 1.2)}",
            lambda: f"scale <-1, {self.number(0.8, 1.2)}, 1>",
            lambda: f"matrix <1, {self.number(-0.2, 0.2)}, 0, 0, 1, {self.number(-0.2, 0.2)}, 0.1, 0, 1, 0, {size}, 0>",
            lambda: Block("transform {", [self.transform(size, turn) for _ in self.some(2, 1)] +
                          ["inverse"] * self.chance(0.3)))

    def pattern_transform(self):
        return self.one_of(lambda: f"scale {self.number(0.2, 2.5)}", lambda: self.transform(1),
                           lambda: self.transform(1))

    # ---- patterns and maps

    def modifiers(self, shares):
        """Words of a pattern, in any order, with transforms among them."""
        words = {"frequency": lambda: f"frequency {self.number(0.5, 3)}",
                 "phase": lambda: f"phase {self.number(-1, 1)}",
                 "wave": lambda: self.dice.choice(WAVES),
                 "turbulence": lambda: f"turbulence {self.one_of(lambda: self.number(0, 0.6), lambda: self.vector(0, 0.6))}",
                 "octaves": lambda: f"octaves {self.dice.randint(2, 5)}",
                 "omega": lambda: f"omega {self.number(0.3, 0.7)}",
                 "lambda": lambda: f"lambda {self.number(1.5, 2.5)}"}
        return [make() for word, make in words.items() if self.chance(shares)] + [self.pattern_transform()
                                                                                  for _ in self.some(2)]

    def positions(self):
        """The values of a map's entries."""
        count = self.dice.choice([1, 2, 2, 2, 3, 3, 4])
        values = sorted(self.dice.uniform(0, 1) for _ in range(count))
        if self.chance(0.6):
            values[0], values[-1] = 0, 1 if count > 1 else 0
        if count > 2 and self.chance(0.2):
            values[1] = values[2]
        return [self.literal(value) for value in values]

    def color_map(self):
        known = self.known("map")
        if known:
            return f"color_map {{ {known} }}"
        entries = [f"[{at} {self.colour(True)}]" for at in self.positions()]
        if self.chance(0.2):
            entries = [f"[{low} {high} {self.colour(True)} {self.colour(True, 'color ')}]" for low, high in
                       self.dice.choice([[("0", "0.4"), ("0.4", "1")], [("0.1", "0.3"), ("0.5", "0.9")], [("0", "1")]])]
        return Block(self.dice.choice(["color_map {", "colour_map {"]), self.torn(entries, 0.1))

    def list_of(self, make, count, is_whole=False):
        """None, some or all of the parts of a list."""
        parts = [make() for _ in range(self.dice.choice([count, count, count if is_whole else self.dice.randint(0,
                                                                                                                count)]))]
        return [part + "," * self.chance(0.5) if isinstance(part, str) and i + 1 < len(parts) else part
                for i, part in enumerate(parts)]

    def list_pattern(self, parts, is_whole=False):
        """checker, hexagon or brick with a list that may lack something; what follows may be in any order."""
        word, count = self.dice.choice([("checker", 2), ("checker", 2), ("hexagon", 3), ("brick", 2)])
        found = self.list_of(parts, count, is_whole)
        more = self.modifiers(0.1)
        if word == "brick":
            more += [text for text in (f"mortar {self.number(0.05, 0.2)}",
                                       f"brick_size <{self.number(0.5, 1)}, 0.31, 0.5>")
                     if self.chance(0.5)]
        return [word] + found + self.shuffled(more)

    def value_pattern(self, maps):
        pattern = self.dice.choice(PATTERNS)
        own = [word for word in PATTERN_WORDS.get(pattern, []) if self.chance(0.25)]
        return [pattern] + self.shuffled(self.modifiers(0.15) + own + maps)

    def entries(self, make):
        """Entries `[value items]` of a map of blocks."""
        return [Block(f"[{at}", make(), "]") for at in self.positions()]

    # ---- pigments

    def pigment_items(self, depth=0):
        known = self.known("pigment")
        begin = [known] if known else []
        if known and self.chance(0.4):
            return begin + [self.pattern_transform() for _ in self.some(2)]
        choice = self.dice.random()
        if known or choice < 0.3 or depth > 1:
            if known:
                return begin + self.shuffled([self.pattern_transform() for _ in self.some(2)])
            return [self.colour(self.chance(0.4))] + [self.pattern_transform()] * self.chance(0.2)
        if choice < 0.5:
            return self.list_pattern(lambda: self.colour(True))
        if choice < 0.6:
            return self.list_pattern(lambda: Block("pigment {", self.pigment_items(depth + 1)))
        if choice < 0.68:
            return self.value_pattern([Block("pigment_map {", self.entries(lambda: self.pigment_items(depth + 1)))])
        if choice < 0.72:
            weighed = [Block(f"[{self.number(0.5, 2)}", self.pigment_items(depth + 1), "]") for _ in self.some(3, 1)]
            return ["average"] + self.shuffled([Block("pigment_map {", weighed)] + self.modifiers(0))
        return self.value_pattern([self.color_map()] * self.chance(0.85))

    def pigment(self, depth=0):
        return Block("pigment {", self.torn(self.pigment_items(depth)))

    # ---- normals

    def normal_items(self, depth=0):
        known = self.known("normal")
        if known:
            return [known] + [self.pattern_transform() for _ in self.some(2)]
        amount = self.dice.choice(["", " " + self.number(0.1, 0.7)])
        choice = self.dice.random()
        # In POV-Ray it changes the maps of declared normals wherever they stand: see docs/language.md.
        more = self.modifiers(0.1) + [f"bump_size {self.number(0.1, 0.7)}"] * self.chance(0.2) + \
            [f"accuracy {self.number(0.01, 0.1)}"] * self.chance(0.1) + ["no_bump_scale"] * (self.chance(0.1) and not self.names["normal"])
        if choice < 0.2:
            word = self.dice.choice(["quilted"] * (not self.names["texture"]) + ["bumps", "dents", "wrinkles",
                                                                                 "ripples", "waves"])
            mapped = [Block("normal_map {", self.entries(lambda: self.normal_items(depth + 1)))] * \
                (word == "quilted" and depth < 2 and self.chance(0.3))
            # On whole numbers the last bits of a point tell to which cushion it belongs.
            return [word + amount] + mapped + ["translate 0.123"] * (word == "quilted") + self.shuffled(more)
        if choice < 0.32 and depth < 2:
            return self.list_pattern(lambda: Block("normal {", self.normal_items(depth + 1)), True)
        if choice < 0.36 and depth < 2:
            weighed = [Block(f"[{self.number(0.5, 2)}", self.normal_items(depth + 1), "]") for _ in self.some(3, 1)]
            return ["average"] + self.shuffled([Block("normal_map {", weighed)] + more)
        if choice < 0.45:
            return [f"{self.dice.choice(['checker', 'hexagon', 'brick'])} {self.number(0.1, 0.7)}"] + self.shuffled(more)
        if choice < 0.6 and depth < 2:
            return self.value_pattern([Block("normal_map {", self.entries(lambda: self.normal_items(depth + 1)))])
        slopes = Block("slope_map {",
                       [f"[{at} <{self.number(0, 1)}, {self.number(-1, 1)}>]" for at in self.positions()])
        pattern = self.dice.choice([pattern for pattern in PATTERNS
                                    if "mandel" not in pattern and "julia" not in pattern])
        amount = amount and ("," if pattern[-1] in ">xyz" else "") + amount
        return [pattern + amount] + self.shuffled(more + [slopes] * self.chance(0.2))

    def normal(self):
        return Block("normal {", self.torn(self.normal_items()))

    # ---- finishes and textures

    def finish(self, mirrors=True):
        words = [f"{word} {'+' * (word == 'metallic')}{self.number(*FINISH[word])}"
                 for word in self.dice.sample(list(FINISH), self.dice.randint(0, 4))]
        if mirrors and self.chance(0.2):
            words.append(self.one_of(
                lambda: f"reflection {self.number(0.1, 0.6)}", lambda: f"reflection {self.colour()}",
                lambda: Block("reflection {", [f"{self.number(0, 0.2)}, {self.number(0.4, 0.9)}"] + self.shuffled(
                    [word for word in (f"falloff {self.number(0.5, 3)}", f"metallic {self.number(0, 1)}",
                                       f"exponent {self.number(0.7, 1.5)}") if self.chance(0.4)]))))
            words += ["conserve_energy"] * self.chance(0.2)
        known = self.known("finish") if mirrors else None
        return Block("finish {", ([known] if known else []) + self.torn(self.shuffled(words)))

    def texture_parts(self, mirrors=True):
        """pigment, normal and finish, each of them or not, with transforms anywhere."""
        is_bumpy = self.chance(0.35)  # and no mirror then, in which a last bit becomes many
        parts = [self.pigment()] * self.chance(0.9) + [self.normal()] * is_bumpy
        parts += [self.finish(mirrors and not is_bumpy)] * self.chance(0.5)
        parts += [self.pattern_transform() for _ in self.some(2)]
        return self.shuffled(parts)

    def texture_items(self, depth=0, mirrors=True):
        known = self.known("texture")
        if known and depth == 0:
            return [known] + self.texture_parts(mirrors)[:self.dice.randint(0, 3)]
        choice = self.dice.random()
        plain = lambda: Block("texture {", self.texture_items(depth + 1, mirrors))
        if choice < 0.12 and depth < 1:
            return self.list_pattern(plain)
        if choice < 0.25 and depth < 1:
            return self.value_pattern([Block("texture_map {", self.entries(lambda: self.texture_items(1, mirrors)))])
        return self.torn(self.texture_parts(mirrors))

    def texture(self, mirrors=True):
        return Block("texture {", self.texture_items(0, mirrors))

    def layer(self):
        """A texture that lets see what is below."""
        clear = Block("color_map {",
                      [f"[{at} rgbt <{self.number(0, 1)}, {self.number(0, 1)}, 0.3, {self.number(0.2, 1)}>]"
                                      for at in self.positions()])
        return Block("texture {", self.shuffled([Block("pigment {", self.value_pattern([clear]))] +
                                                [self.pattern_transform() for _ in self.some(1)] +
                                                [self.finish(False)] * self.chance(0.3)))

    def surface(self, mirrors=True, below=False):
        """What an object says of its surface, in order; no pattern of textures where others may be laid over it."""
        choice = 1 if below else self.dice.random()
        if choice < 0.35:
            return [self.texture(mirrors)]
        if choice < 0.5:
            return [Block("texture {", self.texture_parts(False))] + [self.layer() for _ in self.some(2, 1)]
        if choice < 0.6:
            known = self.known("material")
            return [Block("material {", [known] if known else self.material_items(mirrors))]
        return self.texture_parts(mirrors)

    def material_items(self, mirrors=True):
        interior = [Block("interior {", self.interior_items())] * (not self.is_solid and self.chance(0.3))
        return self.shuffled([self.texture(mirrors)] + interior) + [self.transform(1) for _ in self.some(1)]
