#!/usr/bin/env python3
"""share/rtlang's finish.inc and transforms.inc against those of an installed POV-Ray: the same names, values, effect.

The names are read out of the installed files when the test runs. What a finish means is seen in a picture, with
POV-Ray's default finish and with one in which everything is said, so that it is also seen what a finish leaves alone;
what a macro means is what it makes of the origin and the unit vectors, printed by #debug. POV-Ray reads both files, and
rtlang too.
Prints TAP; skips what needs a program that is not there. SPDX-License-Identifier: MIT
"""
import os
import re
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import check_colors  # noqa: E402
import pictures  # noqa: E402

OURS = check_colors.OURS
START = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
BAR = 1e-12  # rounding of doubles: of lengths of some units
SAID = ("ambient 0.3 diffuse 0.4 brilliance 2 phong 0.2 phong_size 7 specular 0.1 roughness 0.02 metallic 0.3"
        " reflection { 0.05, 0.3 falloff 2 exponent 1.2 metallic 0.5 } emission 0.05")
MOVED = """#declare Solid = union { box { <1, 2, 3>, <4, 6, 9> } sphere { <0, 1, 2>, 0.5 } }
#declare Way = spline { cubic_spline -1, <0, 0, 0> 0, <1, 2, 3> 0.5, <4, 4, 1> 1, <6, 3, -2> 2, <0, 0, 0> }
#declare Bent = spline { linear_spline 0, <0, 0, 0> 0.5, <1, 0.3, 0.2> 1, <0.8, 1.2, -1> 1.5, <-1, 0, 0.5> }
"""
VECTORS = ("x", "y", "z", "-y", "-z", "<1,2,3>", "<-3,0.2,-1>", "<1e-9,1,0>", "<1,1,2>", "<2,1,1>", "<1,2,1>",
           "<1,1,1>", "<1,-3,2>")
SKIES = ("y", "z", "<1,2,0>", "<-1,0.2,0.7>", "<0,-3,0>")
ENDS = ("Way,-1", "Way,2", "Bent,0", "Bent,1.5")  # no way before, or none ahead
CALLS = (
    ["Shear_Trans(<1,2,3>,<0,1,0.5>,<-0.25,0,2>)", "Matrix_Trans(<1,2,3>,<0,1,0.5>,<-0.25,0,2>,<5,6,7>)",
     "Rotate_Around_Trans(<10,20,30>,<1,2,3>)", "Rotate_Around_Trans(-90*y,x)"] +
    [f"Axial_Scale_Trans({axis},{amount})" for axis in ("<1,2,-0.5>", "-2*z") for amount in ("3", "0.25", "-1")] +
    [f"Axis_Rotate_Trans({axis},{angle})" for axis in ("<1,2,-0.5>", "3*z") for angle in ("30", "-120")] +
    [f"Point_At_Trans({axis})" for axis in VECTORS] +
    [f"Reorient_Trans({one},{other})" for one in VECTORS for other in ("x", f"3*{one}", f"-{one}", "<-2,0.5,1>")] +
    [f"Center_Trans(Solid,{axis})" for axis in ("x", "y+z", "2*x", "-x+0.5*y", "0*x")] +
    [f"Align_Trans(Solid,{axis},<5,6,7>)" for axis in ("x", "-y", "<1,-1,0>", "<0.5,-3,0.51>", "<-0.5,-0.51,0.001>")] +
    [f"Spline_Trans({spline},{sky},0.3,{banking})" for spline in ("Way,0.6", "Way,0.4", "Bent,0.5", "Bent,1", *ENDS)
     for sky in SKIES for banking in ("0", "0.5", "-1.2")])
POINTS = ("<0,0,0>", "<1,0,0>", "<0,1,0>", "<0,0,1>")


def parameters(folder, name):
    """Each macro of a file with the number of its parameters."""
    with open(os.path.join(folder, name), encoding="latin-1") as file:
        found = re.findall(r"^\s*#\s*macro\s+(\w+)\s*\(([^)]*)\)", file.read(), re.M)
    return sorted((macro, len(inside.split(","))) for macro, inside in found)


def show(value):
    parts = ', " ", '.join(f"str(Shown.{c}, 0, 15)" for c in "xyz")
    return f'#declare Shown = {value};\n#debug concat({parts}, "\\n")\n'


def transforms_program():
    """Also by a declared transformation, and by the two macros that move a vector, forth and back."""
    lines = [START, '#include "transforms.inc"\n', MOVED]
    for number, call in enumerate(CALLS):
        lines.append(f"#declare T{number} = {call}\n")
        lines += [show(f"vtransform({point}, T{number})") for point in POINTS]
        lines.append(show(f"vtransform(<1,2,3>, transform {{ scale 2 {call} }})"))
    lines += [show(f"vinv_transform({point}, {call})") for call in CALLS[:8] for point in POINTS]
    return "".join(lines)


def close(one, other):
    a, b = [[float(word) for word in text.split()] for text in (one, other)]
    return len(a) == len(b) > 4 * 3 * len(CALLS) and all(abs(x - y) <= BAR for x, y in zip(a, b))


def differences(got, want):
    pairs = zip(got.splitlines(), want.splitlines())
    return f"{got.count(chr(10))} lines for {want.count(chr(10))}\n" + "".join(
        f"line {i}, {CALLS[i // 5] if i < 5 * len(CALLS) else 'inverse'}: {a} for {b}\n"
        for i, (a, b) in enumerate(pairs)
        if len(a.split()) != 3 or any(abs(float(x) - float(y)) > BAR for x, y in zip(a.split(), b.split())))[:3000]


def finish_scene(names, default, folder):
    row = "".join(f"sphere {{ <{2.2 * (i % 4) - 3.3}, {1.2 - 2.4 * (i // 4)}, 0>, 1 pigment {{ rgb <0.8, 0.5, 0.3> }}"
                  f" finish {{ {name} }} }}\n" for i, name in enumerate(names))
    return (START + (f"#default {{ finish {{ {default} }} }}\n" if default else "") + f'#include "{folder}/finish.inc"\n'
            "camera { location -9*z look_at 0 right 4/3*x up y angle 55 }\nbackground { rgb <0.2, 0.3, 0.5> }\n"
            "light_source { <-6, 7, -9>, rgb 1 }\n" + row +
            "plane { y, -3.1 pigment { checker rgb 0.2, rgb 0.7 } finish { ambient 0.1 diffuse 0.6 } }\n")


def finish_cases(theirs, folder):
    names = [name for name in check_colors.words(theirs, "declare", "finish.inc") if name != "Finish_Inc_Temp"]
    for words, default in (("over the default finish", ""), ("over one in which all is said", SAID)):
        files = ("f.scn", "their.png", "our.png", "rtlang.png")
        scene, their, our, rtlang = (os.path.join(folder, name) for name in files)
        with open(scene, "w", encoding="ascii") as file:
            file.write(finish_scene(names, default, folder))
        for include, render, picture in ((theirs, pictures.render_povray, their), (OURS, pictures.render_povray, our),
                                         (OURS, pictures.render_rtlang, rtlang)):
            check_colors.bring(include, folder, "finish.inc")
            render(scene, picture, [])
        apart = pictures.compare(our, their)
        yield f"finishes {words}: POV-Ray, our file", apart[0] == 0, str(apart)
        met, told = pictures.verdict(*pictures.compare(rtlang, their))
        yield f"finishes {words}: rtlang, our file", met, told


def transforms_cases(theirs, folder):
    program = transforms_program()
    want = check_colors.povray_prints(program, folder, theirs, "transforms.inc")
    for reader, prints, include in (("POV-Ray, our file", check_colors.povray_prints, OURS),
                                    ("rtlang, our file", check_colors.rtlang_prints, OURS),
                                    ("rtlang, POV-Ray's file", check_colors.rtlang_prints, theirs)):
        got = prints(program, folder, include, "transforms.inc")
        yield f"{len(CALLS)} transformations: {reader}", close(got, want), differences(got, want)


def cases(theirs):
    """Yields (name, passed, what to show when it did not)."""
    for name, guard in (("finish.inc", "Finish_Inc_Temp"), ("transforms.inc", "TRANSFORMS_INC_TEMP")):
        a, b = check_colors.words(OURS, "declare", name), check_colors.words(theirs, "declare", name)
        yield f"{name}: the same names", a == b, f"differ: {sorted(set(a) ^ set(b))}"
        a, b = parameters(OURS, name), parameters(theirs, name)
        yield f"{name}: the same macros", a == b, f"differ: {sorted(set(a) ^ set(b))}"
        with tempfile.TemporaryDirectory() as folder:
            for words, program in check_colors.effects(name, guard).items():
                want = check_colors.povray_prints(program, folder, theirs, name)
                for reader, prints in (("POV-Ray", check_colors.povray_prints), ("rtlang", check_colors.rtlang_prints)):
                    got = prints(program, folder, OURS, name)
                    yield f"{name}, {words}: {reader}, our file", got.split() == want.split(), f"{got!r} for {want!r}"
            got, want = (check_colors.gamma_pixels(folder, include, name) for include in (OURS, theirs))
            yield f"{name}: the gamma of a scene without #version", got == want, f"{got} for {want}"
            yield from (finish_cases if name == "finish.inc" else transforms_cases)(theirs, folder)


def main():
    folders = pictures.include_folders()
    if not pictures.povray() or not folders:
        print("1..0 # SKIP POV-Ray and its include files are not installed")
        return 0
    number = failed = 0
    for name, passed, detail in cases(folders[0]):
        number += 1
        failed += not passed
        print(f"{'ok' if passed else 'not ok'} {number} - {name}".replace("#", "\\#"), flush=True)
        if not passed:
            print("".join(f"# {line}\n" for line in detail.splitlines()), end="")
    print(f"1..{number}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
