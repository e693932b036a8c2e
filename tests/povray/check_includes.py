#!/usr/bin/env python3
"""Each of POV-Ray's standard include files, unchanged: rtlang takes it in, and draws what POV-Ray draws beside it.

Some include files need names of others; the table says which. What an include declares with things that rtlang has not
must not fail a scene that does not use it. Then macros and constants of some of them are called, and the debug streams
of both programs compared. Prints TAP. SPDX-License-Identifier: MIT
"""
import glob
import json
import os
import subprocess
import sys
import tempfile
from itertools import zip_longest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import check_lang  # noqa: E402
import pictures  # noqa: E402

# What must be included before: POV-Ray refuses these alone.
BEFORE = {
    "shapes2.inc": ["shapes.inc"], "shapesq.inc": ["shapes.inc"], "skies.inc": ["colors.inc"],
    "stdcam.inc": ["colors.inc"], "stoneold.inc": ["colors.inc"], "stones.inc": ["colors.inc"],
    "stones1.inc": ["colors.inc"], "stones2.inc": ["colors.inc"],
}
SCENE = """#version 3.7;
global_settings {{ assumed_gamma 1 }}
{includes}
camera {{ location <0, 0, -5> look_at 0 right 4/3*x up y angle 40 }}
light_source {{ <-5, 8, -6>, rgb 1 }}
#default {{ texture {{ pigment {{ rgb <0.8, 0.5, 0.3> }} finish {{ ambient 0.1 diffuse 0.6 }} }} }}
sphere {{ 0, 1 pigment {{ rgb <0.8, 0.5, 0.3> }} }}
"""

# Includes, what is declared first, and expressions that both programs must print alike: of strings, numbers and vectors.
CALLS = [
    ("math.inc", "#declare L = array[3] {1, 2, 6}\n", [], [
        "even(3)", "even(4)", "odd(3)", "Interpolate(0.3, 0, 1, 5, 9, 2)", "Mean(L)", "Std_Dev(L, 3)", "clamp(7, 1, 3)",
        "clip(7, 1, 3)", "adj_range(0.5, 2, 4)", "adj_range2(5, 0, 10, 2, 4)", "sind(30)", "cosd(60)", "tand(45)",
        "asind(0.5)", "acosd(0.5)", "atand(1)", "atan2d(1, 1)", "max3(1, 5, 2)", "min3(4, 2, 9)", "f_sqr(3)", "sgn(-2)",
        "VEq(x, x)", "VEq(x, y)", "VZero(<0, 0, 0>)", "VLength5D(<1,2,3,4,5>)", "VDot5D(<1,2,3,4,5>, <5,4,3,2,1>)",
        "VCos_Angle(x, x + y)", "VAngle(x, y)", "VAngleD(x, x + y)", "VRotation(x, y, z)", "VRotationD(x, y, z)",
        "VDist(x, 3*y)", "VMin(<3, 1, 2>)", "VMax(<3, 1, 2>)"],
     ["VSqr(<1, 2, 3>)", "VPow(<1, 2, 3>, 2)", "VPerp_To_Vector(<1, 2, 3>)", "VPerp_To_Plane(x, y)",
      "VPerp_Adjust(<1, 2, 3>, x)", "VProject_Plane(<1, 2, 3>, y)", "VProject_Axis(<1, 2, 3>, y)",
      "VWith_Len(<1, 2, 2>, 6)"]),
    ("transforms.inc", "#declare T = transform { rotate 90*z translate y }\n", [], [],
     ["vtransform(x, T)", "vinv_transform(x, T)", *(f"vtransform(<1, 2, 3>, transform {{ {call} }})" for call in (
         "Shear_Trans(x, y + x, z)", "Matrix_Trans(x, 2*y, z, x)", "Axial_Scale_Trans(x + y, 2)",
         "Axis_Rotate_Trans(x + y, 40)", "Rotate_Around_Trans(40*z, x)", "Reorient_Trans(x, y + z)",
         "Point_At_Trans(x + y + z)"))]),
    ("rand.inc", "#declare R = seed(7);\n", [], [
        "SRand(R)", "RRand(2, 5, R)", "Prob(0.5, R)", "Rand_Normal(0, 1, R)", "Rand_Gauss(0, 1, R)", "Rand_Cauchy(0, 1, R)",
        "Rand_Exp(1, R)", "Rand_Gamma(2, 1, R)", "Rand_Beta(2, 2, R)", "Rand_Chi_Square(3, R)", "Rand_F_Dist(3, 4, R)",
        "Rand_Triangle(0, 1, 2, R)", "Rand_Erlang(1, 2, R)", "Rand_Lognormal(0, 1, R)", "Rand_Pareto(2, R)",
        "Rand_Poisson(3, R)", "Rand_Geo(0.3, R)", "Rand_Binomial(5, 0.4, R)", "Rand_Student(4, R)", "Rand_Weibull(2, 1, R)",
        "Rand_Bernoulli(0.5, R)"],
     ["VRand(R)", "VRand_In_Box(-x, y, R)", "VRand_In_Sphere(R)", "VRand_On_Sphere(R)"]),
    ("strings.inc", "", ["CRGBStr(<1, 2, 3>, 0, 2)", "CRGBFTStr(<1,2,3,4,5>, 0, 1)", "Triangle_Str(x, y, z)", "Str(3.5)",
                         "VStr2D(<1, 2>)", "VStr(<1, 2, 3>)", "Vstr2D(<1, 2>, 5, 2)", "Vstr(<1, 2, 3>, 5, 2)"], [], []),
    ("arrays.inc", "#declare R = seed(3); #declare L = array[5] {5, 3, 9, 1, 4}\n#declare M = array[5] {5, 3, 9, 1, 4} "
     "Sort_Array(M)\n#declare N = array[5] {5, 3, 9, 1, 4} Reverse_Array(N)\n", [],
     ["Rand_Array_Item(L, R)", "Rand_Array_Item(L, R)", *(f"M[{i}]" for i in range(5)), *(f"N[{i}]" for i in range(5))], []),
    ("consts.inc", "", [], ["e", "Plane_Map", "Torus_Map", "Hex_Blur2", "Diamond_Ior", "Water_Ior", "FoV_45", "FoV_165",
                            "MIE_HAZY_SCATTERING"], ["o", "xy", "yz", "xz"]),
    ("functions.inc", "", [], ["f_noise3d(0.3, 0.7, 0.2)", "f_noise_generator(1.5, -2, 3.25, 3)", "f_r(1, 2, 3)",
                               "f_th(1, 2, 3)", "f_ph(1, 2, 3)", "f_sphere(1, 2, 3, 1.5)", "f_snoise3d(0.1, 5, 7.5)",
                               "f_sine_wave(0.3, 2, 5)", "f_scallop_wave(0.3, 2, 5)"], []),
    ("screen.inc", "Set_Camera(<1, 2, -5>, y, 50)\n", [], ["Camera_Aspect_Ratio", "Camera_Zoom"],
     ["Camera_Location", "Camera_Look_At"]),
    ("debug.inc", "Debug_Message(\"hidden\\n\") Set_Debug(true) Debug_Message(\"seen\\n\")\n", [], [], []),
    ("colors.inc", "", [], [], ["CRGB2HSL(<0.2, 0.5, 0.7>)", "CHSL2RGB(<200, 0.5, 0.7>)", "CRGB2HSV(<0.2, 0.5, 0.7>)",
                                "CHSV2RGB(<200, 0.5, 0.7>)"]),
]


def run(program, arguments, folder):
    done = pictures.call([program, *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120)
    return done.returncode, done.stderr.decode("latin-1")


def check_picture(name, folders):
    """(passed, what happened) of a scene that includes the file and uses nothing of it."""
    includes = "\n".join(f'#include "{file}"' for file in [*BEFORE.get(name, []), name])
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.scn")
        with open(path, "w", encoding="utf-8") as file:
            file.write(SCENE.format(includes=includes))
        try:
            fine, words = pictures.verdict(*pictures.compare_programs(path, folder, folders))
            return fine, "drawn, " + words
        except pictures.RunFailed as failure:
            lines = [line for line in failure.text.splitlines() if "error[" in line]
            return False, f"refused: {lines[0].split('/')[-1]}" if lines else str(failure)


def program_of(name, before, strings, numbers, vectors):
    lines = [f'#include "{name}"\n{before}']
    lines += [f'#debug concat({call}, "\\n")' for call in strings]
    lines += [f'#debug concat(str({call}, 0, 9), "\\n")' for call in numbers]
    # Where an expression ends is different for a declaration, so both forms are tried.
    lines += [f'#declare V = ({call}); #debug concat(vstr(3, V, " ", 0, 9), "\\n")' for call in vectors]
    return "\n".join(lines) + "\n"


def check_calls(case, folders):
    """(passed, lines that differ)."""
    program = program_of(*case)
    theirs, code, errors = check_lang.run_povray(program, {}, [])
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "t.scn"), "w", encoding="latin-1") as file:
            file.write(check_lang.PREFACE + program)
        arguments = ["-q", "--check", "--diagnostics=json", *(f"-I{path}" for path in folders), "t.scn"]
        status, said = run(os.path.abspath(os.environ.get("RTLANG", "./rtlang")), arguments, folder)
    messages = [json.loads(line) for line in said.splitlines() if line.startswith("{")]
    ours = "".join(m["text"] + "\n" for m in messages if m["type"] == "message" and m["stream"] == "debug")
    if code:
        return False, ["POV-Ray: " + line for line in errors[-500:].splitlines()]
    faults = [f"{m['code']} {m['line']}: {m['message']}" for m in messages if m.get("severity") == "error"]
    pairs = zip_longest(ours.rstrip("\n").split("\n"), theirs.rstrip("\n").split("\n"))
    differ = [f"{one} | {other}" for one, other in pairs if one != other]
    return status == 0 and not differ, faults + differ


def main():
    files = sorted(glob.glob("/usr/share/povray-3*/include/*.inc"))
    if pictures.povray() is None or not files:
        print("1..0 # SKIP povray and povray-includes are not installed")
        return 0
    print(f"1..{len(files) + len(CALLS)}")
    folders, failed, number = pictures.include_folders(), 0, 0
    for path in files:
        passed, words = check_picture(os.path.basename(path), folders)
        number, failed = number + 1, failed + (not passed)
        print(f"{'ok' if passed else 'not ok'} {number} - {os.path.basename(path)}: {words}".replace("#", "\\#"), flush=True)
    for case in CALLS:
        passed, lines = check_calls(case, folders)
        number, failed = number + 1, failed + (not passed)
        print(f"{'ok' if passed else 'not ok'} {number} - calls of {case[0]}", flush=True)
        for line in lines[:20]:
            print("# " + line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
