#!/usr/bin/env python3
# Scenes that were made to take for ever, or all memory, or the program down: each ends by itself within two seconds, or
# at a limit with a message that names the place, and takes no more than 1 GiB. Then, long runs of many kinds that are
# interrupted at any moment end within a moment. Prints TAP.
#
# Wants RTLANG. CHECK_LONG=1 takes the default number of steps instead of a tenth of it. The seconds are of processor
# time, times a slowness that is measured once, for slow builds and machines.
#
# SPDX-License-Identifier: MIT
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
from tap import Tap

RTLANG = os.path.abspath(os.environ["RTLANG"])
SECONDS, SECONDS_AT_LIMIT, BYTES = 2.0, 10.0, 1 << 30
MOMENT = 0.2  # of an interrupt, on a quiet machine; a busy one gets five times as much, since clocks decide no test
KILLED = 30  # seconds of processor time
# The default, 30 000 000, takes some seconds a scene.
STEPS = [] if os.environ.get("CHECK_LONG") else ["--max-steps=3000000"]
tap = Tap()
HEAD = "camera { location <0, 1, -6> look_at 0 }\nlight_source { <5, 9, -5>, 1 }\n"
BALL = "sphere { 0, 1 pigment { rgb 1 } }\n"


def doubled(first, step, use, times=40):
    """A declaration that names the one before twice, again and again."""
    return HEAD + "#declare T = %s;\n#for (I, 1, %d) #declare T = %s; #end\n%s\n" % (first, times, step, use)


def forever(body):
    return "#declare I = 0;\n#while (1) %s #end\n" % body


def nested(opening, closing, times=100000, middle=""):
    return HEAD + opening * times + middle + closing * times


def named(kind, make, count, last):
    """Functions or macros that call the one before twice."""
    return "".join("#%s F%d %s\n" % (kind, i, make % ((i - 1,) * make.count("%d"))) for i in range(1, count)) + last


def sum_of(depth):
    """2^depth terms that nest no deeper than that."""
    return "x*x" if depth == 0 else "(%s + %s)" % (sum_of(depth - 1), sum_of(depth - 1))


SCENES = {
    # loops and calls
    "an empty loop": forever(""),
    "a #for that steps by nothing": "#for (I, 0, 1, 1e-300) #end\n",
    "a #for to the greatest number": "#for (I, 0, 1e300) #end\n",
    "a macro that calls itself": "#macro M() M() #end M()\n",
    "two macros that call each other": "#macro A() B() #end #macro B() A() #end A()\n",
    "macros that double": "#macro F0() #end\n" + named("macro", "() F%d() F%d() #end", 90, "F89()\n"),
    "functions that double": "#declare F0 = function (x) { x }\n" +
                             named("declare", "= function (x) { F%d(x) + F%d(x) }", 60, "#debug str(F59(1), 0, 0)\n"),
    "a file that includes itself": '#include "SELF"\n',
    "a loop of includes": forever('#include "empty.inc"'),
    "a loop in a loop in a loop": "#for (A, 1, 1e5) #for (B, 1, 1e5) #for (C, 1, 1e5) #end #end #end\n",
    "a large file of comments again and again": forever('#include "comments.inc"'),
    "a large file of statements again and again": forever('#include "statements.inc"'),
    "a large file of shapes again and again": HEAD + forever('#include "shapes.inc"'),
    "a large macro again and again": forever('#include "macro.inc"'),
    "a turn of many statements": forever("#declare A = I*I + 1;\n" * 100000),
    "a turn of many torn statements": "#declare N = 0;\n" + forever("sphere { 0, #if (N) 1 } #else 2 } #end\n" * 10000),
    "a macro of many statements": "#macro M()\n" + "#declare A = I*I + 1;\n" * 100000 + "#end\n" + forever("M()"),
    "a function of many terms": "#declare F = function (x) { " + sum_of(17) + " }\n" + forever("#declare A = F(I);"),
    "a data file of comments": forever('#fopen F "comments.txt" read #read (F, A) #fclose F'),
    "a loop of random numbers": forever("#declare R = rand(seed(I));"),
    "a loop that declares new names": "#macro N(K) #declare I = I + 1; #end\n" + forever("N(I)"),
    # strings and messages
    "a string that doubles": '#declare S = "ab";\n' + forever("#declare S = concat(S, S);"),
    "a string that is compared": '#declare S = "ab"; #for (K, 1, 20) #declare S = concat(S, S); #end\n' +
                                 forever("#declare C = strcmp(S, S);"),
    "strings that are compared by a sign": '#declare S = "ab"; #for (K, 1, 21) #declare S = concat(S, S); #end\n' +
                                            forever("#declare C = (S = S);"),
    "the length of a string": '#declare S = "ab"; #for (K, 1, 21) #declare S = concat(S, S); #end\n' +
                              forever("#declare C = strlen(S);"),
    "a file of a name of megabytes": '#declare S = "ab"; #for (K, 1, 21) #declare S = concat(S, S); #end\n' +
                                     forever("#declare C = file_exists(S);"),
    "a text that is copied": '#declare S = "ab"; #for (K, 1, 20) #declare S = concat(S, S); #end\n' +
                             forever("#declare C = S;"),
    "a string in capitals": '#declare S = "ab"; #for (K, 1, 20) #declare S = concat(S, S); #end\n' +
                            forever("#declare C = strupr(S);"),
    "a number of a million digits": '#debug str(1, 0, 1000000)\n' * 3,
    "messages for ever": forever('#debug "again\\n"'),
    "warnings for ever": forever('#warning "again\\n"'),
    "a message without an end of line": forever('#debug "again"'),
    # arrays and values
    "an array as large as can be": "#declare A = array[2147483647];\n",
    "an array of five dimensions": "#declare A = array[1000][1000][1000][1000][1000];\n",
    "an array of the one before": "#declare A = array[2] { 1, 2 };\n" + forever("#declare A = array[2] { A, A };"),
    "an array that is copied": "#declare A = array[100000];\n#for (K, 0, 99999) #declare A[K] = K; #end\n" +
                               forever("#declare B = A;"),
    "a spline of many points": "#declare S = spline { cubic_spline " +
                               ",".join("%d, %d" % (i, i) for i in range(50000)) +
                               " }\n#for (K, 1, 1e9) #declare V = S(K/100); #end\n",
    "prod and sum in functions":
        "#declare F = function (n) { sum(i, 1, n, sum(j, 1, n, i*j)) }\n#debug str(F(1e6), 0, 0)\n",
    "a tower of powers": "#declare X = 2;\n" + forever("#declare X = pow(X, 1.0000001);"),
    # depth
    "parentheses": "#declare A = " + "(" * 100000 + "1" + ")" * 100000 + ";\n",
    "open parentheses": "#declare A = " + "(" * 1000000,
    "a sum of a million terms": "#declare A = 1" + " + 1" * 1000000 + ";\n",
    "minus signs": "#declare A = " + "-" * 100000 + "1;\n",
    "unions in unions": nested("union { ", "}", middle=BALL),
    "open braces": HEAD + "union { " * 1000000,
    "#if in #if": nested("#if (1) ", "#end ", middle=BALL),
    "#while in #while": nested("#while (1) ", "#end ", times=1000),
    "macros in macros": nested("#macro A() ", "#end ", times=5000),
    "vectors in vectors": "#declare A = " + "<" * 10000 + "1" + ">" * 10000 + ";\n",
    "textures in maps": HEAD + "sphere { 0, 1 texture { " +
                        "gradient x texture_map { [0 " * 5000 + "]}" * 5000 + "}}\n",
    "transforms": HEAD + "sphere { 0, 1 " + "rotate 1 " * 200000 + "}\n",
    # shapes
    "spheres for ever": HEAD + forever("sphere { I, 1 }"),
    "boxes for ever": HEAD + forever("box { I, I + 1 }"),
    "unions that double": doubled("sphere { 0, 1 }", "union { object { T } object { T translate x } }", "object { T }"),
    "differences that double": doubled("sphere { 0, 1 }", "difference { object { T } object { T translate x } }",
                                       "object { T }"),
    "merges that double": doubled("sphere { 0, 1 }", "merge { object { T } object { T translate x } }", "object { T }"),
    "a hundred thousand spheres in one place": HEAD + BALL * 100000,
    "a hundred thousand spheres around one point": HEAD + "#for (I, 1, 100000) sphere { 0, I/1000 } #end\n",
    "coordinates as large as can be": HEAD + "sphere { 1e300, 1e300 } sphere { <1e307, 1, 1>, 1e-300 }\n",
    "a cone that ends in nothing": HEAD + "cone { 0, 1e-320, y*1e-320, 0 } cylinder { 0, 1e-310*y, 1e300 }\n",
    "quadrics of the greatest and the least numbers": HEAD + "".join(
        "quadric { <1, %s, 3>, <1, 0.5, -1>, <%s, 1, 0>, %s rotate 20 pigment { rgb 1 } }\n" % numbers
        for numbers in (("1", "1.79e308", "-0.7"), ("1e308", "1", "5e-324"), ("-1e-300", "0", "-1e300"))),
    "polynomials of the greatest and the least numbers": HEAD + "".join(
        "poly { 4, <1, %s> rotate 20 pigment { rgb 1 } }\n" % ", ".join(["0"] * 15 + ["1.7e308", number] * 9 + ["-1"])
        for number in ("1", "-1.7e308", "5e-324")),
    "blobs of the greatest and the least numbers": HEAD + "".join(
        "blob { threshold %s sphere { 0, 1, %s } cylinder { 0, y, 1, -%s } pigment { rgb 1 } }\n" % (few, much, few)
        for few, much in (("1e-300", "1e308"), ("1e-320", "1e-310"), ("1e300", "1.7e308"))),
    "prisms of the greatest and the least numbers": HEAD + "".join(
        "prism { %s %s, 1, 4, <-%s, 0>, <%s, 1>, <0, %s>, <-%s, 0> pigment { rgb 1 } }\n" % (words, low, *[size] * 4)
        for words in ("linear_sweep", "conic_sweep") for low in ("0", "-1e3") for size in ("1e300", "1e-9")),
    "lathes of the greatest and the least numbers": HEAD + "".join(
        "lathe { %s 4, <0, 0>, <%s, 1>, <%s, %s>, <%s, 4> pigment { rgb 1 } }\n" % (words, size, size, high, size)
        for words in ("linear_spline", "quadratic_spline", "cubic_spline", "bezier_spline")
        for high in ("2", "1e300") for size in ("1e300", "1e-9", "1e-320")),
    "surfaces of revolution of the greatest and the least numbers": HEAD + "".join(
        "sor { 5, <0, -1>, <%s, 0>, <0, 1>, <%s, %s>, <%s, 1e305> %s pigment { rgb 1 } }\n" % (*[size] * 2, high, size, words)
        for words in ("", "open") for high in ("2", "1e300") for size in ("1e300", "1e-9", "1e-320")),
    "sphere sweeps of the greatest and the least numbers": HEAD + "".join(
        "sphere_sweep { %s 5, 0, %s, y, %s, <1, 1, %s>, 0, %s*x, %s, z, 1 pigment { rgb 1 } }\n" % (curve, low, high, low, high, low)
        for curve in ("linear_spline", "b_spline", "cubic_spline")
        for low in ("1", "1e-320", "1e150") for high in ("1", "1.7e308", "1e-9")),
    "Julia fractals of the greatest and the least numbers": HEAD + "".join(
        "julia_fractal { <%s, 0, %s, 0> %s max_iteration 3 slice <%s, 0, 0, 1e-300>, %s pigment { rgb 1 } }\n" % (a, b, words, b, a)
        for words in ("sqr", "cube") for a in ("0.1", "1e300", "1e-320") for b in ("0", "1e300", "-0.4")),
    "parametric surfaces of the greatest and the least numbers": HEAD + "".join(
        "parametric { function { %s*u } function { v/%s } function { %s } <0, 0>, <%s, %s> accuracy %s max_gradient %s pigment { rgb 1 } }\n"
        % (a, a, c, b, b, b, a) for a in ("1", "1e300", "1e-300") for b in ("1", "1e300", "1e-320") for c in ("u*v", "1/(0*u)", "ln(-u)")),
    "eggs of the greatest and the least numbers": HEAD + "".join(
        "ovus { %s, %s pigment { rgb 1 } }\n" % (a, b) for a in ("1", "1e300", "1e-320", "0") for b in ("0", "0.5", "1.7e308", "1e-9")),
    "a sphere sweep of ten thousand balls in one place": HEAD + "sphere_sweep { b_spline 10000" + ", 0, 1" * 10000 + " }\n",
    "superellipsoids of the greatest and the least numbers": HEAD + "".join(
        "superellipsoid { <%s, %s> pigment { rgb 1 } }\n" % (about, along)
        for about in ("1e300", "1e-9", "1e-320", "3") for along in ("1e300", "1e-9", "1e-320", "0.2")),
    "a mesh of the greatest and the least numbers": HEAD +
        "mesh { triangle { -3e38, <3e38, 0, 1>, <0, 3e38, 1> } triangle { 0, 1e-44*x, 1e-44*y }\n"
        "smooth_triangle { 0, 1e300*x, x, 1e-160*y, y, 1e-300*z } inside_vector 1e300*y }\n",
    "a mesh in a composite that is as thin as can be": "camera { location -3*z look_at 0 } light_source { -4*z, 1 }\n"
        "merge { mesh { triangle { <0, 0.9, 0>, <0.8, 0, 0>, <0, 0, 0.8> }\n"
        "triangle { <0, 0.9, 0>, <0, 0, 0.8>, <-0.8, 0, 0> } triangle { <0, 0.9, 0>, <-0.8, 0, 0>, <0.8, 0, 0> }\n"
        "triangle { <0.8, 0, 0>, <0, 0, 0.8>, <-0.8, 0, 0> } inside_vector y scale <1e-308, 1e-300, 1> }\n"
        "sphere { 0, 1 } pigment { rgbt 0.5 } }\n",
    "clips in clips": doubled("sphere { 0, 1 }", "object { T clipped_by { object { T } } }", "object { T }"),
    "a mesh of a hundred thousand faces in one place": HEAD + "mesh { " + "triangle { 0, x, y }\n" * 100000 + "}\n",
    "meshes that double": doubled("mesh { triangle { 0, x, y } }", "union { object { T } object { T translate x } }",
                                  "object { T }"),
    "a mesh of more corners than there are": HEAD + "mesh2 { vertex_vectors { 2147483647, 0 } }\n",
    "a mesh of corners without end": HEAD + "mesh2 { vertex_vectors { 1e9, " + "0, " * 200000 + "} }\n",
    "a mesh of faces without corners": HEAD + "mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 3, <0, 1, 2>, "
                                       "<0, -1, 2>, <0, 1, 3e9> } }\n",
    "a mesh in a loop": HEAD + forever("mesh { triangle { I, x, y } }"),
    "a blob of components in one place": HEAD + "blob { threshold 0.5 " + "sphere { 0, 1, 0.001 }\n" * 4000 +
                                         "pigment { rgb 1 } }\n",
    "a blob of components without end": HEAD + "blob { threshold 0.5 " + forever("sphere { I, 1, 1 }") + "}\n",
    "a blob of strengths that cancel": HEAD + "blob { threshold 1e-9 " +
                                       "sphere { 0, 1, 1 } sphere { 0, 1, -1 } cylinder { 0, y, 1, 1e-9 }\n" * 1000 +
                                       "}\n",
    "blobs that double": doubled("blob { sphere { 0, 1, 2 } }", "union { object { T } object { T translate x } }",
                                 "object { T }"),
    "a text of a million letters": '#declare S = "ab"; #for (K, 1, 19) #declare S = concat(S, S); #end\n' + HEAD +
                                   'text { ttf "timrom.ttf" S 1, 0 pigment { rgb 1 } }\n',
    "texts for ever": HEAD + forever('text { ttf "timrom.ttf" "Wide" 1, 0 }'),
    "a text of a font that is none": HEAD + 'text { ttf "data.txt" "a" 1, 0 }\n',
    "texts that double": doubled('text { ttf "timrom.ttf" "a" 1, 0 }', "merge { object { T } object { T rotate 1 } }",
                                 "object { T }"),
    "a prism of all points that may be": HEAD + "prism { 0, 1, 10000, " +
                                         ", ".join("<%d, %d>" % (i * i % 9973, i * 7919 % 9967) for i in range(9999)) +
                                         ", <0, 0> pigment { rgb 1 } }\n",
    "prisms of curves that cross": HEAD + "prism { cubic_spline 0, 1, 1000, " +
                                   ", ".join("<%d, %d>" % (i % 3 % 2, i % 7) for i in range(1000)) + "}\n",
    "a prism of points in one place": HEAD + "prism { bezier_spline 0, 1, 8000, " + ", ".join(["<1, 1>"] * 8000) + "}\n",
    "a polygon of points without end": HEAD + "polygon { 1e9, " + "<1, 2>, " * 100000 + "}\n",
    "polynomials of the highest order": HEAD + ("poly { 35, <" + ", ".join(str(i % 3 - 1) for i in range(8436)) +
                                                "> pigment { rgbt 0.9 } }\n") * 4,
    "a polynomial of more coefficients": HEAD + "poly { 35, <" + "1, " * 100000 + "1> }\n",
    "toruses that double": doubled("torus { 1, 0.5 }", "difference { object { T } object { T rotate 9 } }",
                                   "object { T }"),
    # light and surfaces
    "a pattern of a sum without end": HEAD + "sphere { 0, 1 pigment { function { sum(i, 1, 1e300, i) } } }\n",
    "a pattern of functions that double": "#declare F0 = function (x, y, z) { x }\n" +
        named("declare", "= function (x, y, z) { F%d(x, y, z) + F%d(y, z, x) }", 60,
              HEAD + "sphere { 0, 1 pigment { function { F59(x, y, z) } } }\n"),
    "patterns in functions in patterns": HEAD + "#declare F0 = function { pattern { bozo } }\n" +
        "".join("#declare F%d = function { pattern { function { F%d(x, y, z) + F%d(y, z, x) } } }\n" % (i, i - 1, i - 1)
                for i in range(1, 40)) + "sphere { 0, 1 pigment { function { F39(x, y, z) } } }\n",
    "functions of pigments in a loop": "#declare F = function { pigment { bozo turbulence 1 octaves 10 } }\n" +
                                       forever("#declare A = F(I, 1, 2);"),
    "warps without end": HEAD + "sphere { 0, 1 pigment { bozo " + "warp { turbulence 1 octaves 10 }\n" * 20000 + "} }\n",
    "warps of the greatest and the least numbers": HEAD + "".join(
        "sphere { 0, 1 pigment { bozo warp { repeat x*%s offset %s } warp { black_hole %s, %s strength %s falloff %s } "
        "warp { turbulence %s } warp { toroidal major_radius %s } } translate %d }\n" % (*[size] * 8, i)
        for i, size in enumerate(("1e-300", "1e300", "1.7e308", "1e-320"))),
    "pigments of warps that double": doubled("pigment { bozo }", "pigment { gradient x pigment_map { [0 T] [1 T] } "
                                             "warp { turbulence 1 } }", "sphere { 0, 1 pigment { T } }"),
    "fogs without end": HEAD + forever("fog { distance 1 turbulence 1 turb_depth 1 }"),
    "ten thousand fogs": HEAD + "fog { fog_type 2 distance 9 fog_alt 1 fog_offset 1 turbulence 1 turb_depth 1 "
                         "octaves 10 rgbt 0.9 }\n" * 10000 + BALL,
    "fogs of the greatest and the least numbers": HEAD + BALL + "".join(
        "fog { fog_type 2 distance %s fog_alt %s fog_offset %s turbulence %s up %s*y rgbt 0.9 }\n" % ((size,) * 5)
        for size in ("1e-300", "1e300", "1.7e308", "1e-320")),
    "textures that double": doubled("texture { pigment { rgb 1 } }",
                                    "texture { gradient x texture_map { [0 T] [1 T] } }",
                                    "sphere { 0, 1 texture { T } }"),
    "pigments that double": doubled("pigment { rgb 1 }", "pigment { gradient x pigment_map { [0 T] [1 T] } }",
                                    "sphere { 0, 1 pigment { T } }"),
    "bumps that double": doubled("normal { bumps 1 }", "normal { gradient x normal_map { [0 T] [1 T] } }",
                                 "sphere { 0, 1 pigment { rgb 1 } normal { T } }"),
    "skies that double": doubled("pigment { rgb 1 }", "pigment { gradient x pigment_map { [0 T] [1 T] } }",
                                 "sky_sphere { pigment { T } }"),
    "layers that double": HEAD + "#declare T = texture { pigment { rgbt 0.9 } }\n#for (I, 1, 40)\n"
                          "#declare T = texture { T } texture { T }\n#end\nsphere { 0, 1 texture { T } }\n",
    "a hundred thousand layers": HEAD + "sphere { 0, 1 " + "texture { pigment { rgbt 0.9 } }\n" * 100000 + "}\n",
    "a map of too many entries": HEAD + "sphere { 0, 1 pigment { gradient x color_map { " +
                                 "".join("[%d rgb 1]" % i for i in range(100000)) + "}}}\n",
    "lights without end": HEAD + forever("light_source { I, 1 }"),
    "turbulence without end": HEAD + "sphere { 0, 1 pigment { bozo turbulence 1e300 octaves 10 lambda 1e300 } }\n",
    "a pattern of huge frequency": HEAD + "plane { y, 0 pigment { ripples frequency 1e300 phase 1e300 } }\n",
    "an ior of nothing": HEAD + "sphere { 0, 1 pigment { rgbt 1 } interior { ior 1e-300 } }\n",
    # bytes
    "no text at all": "",
    "zeros": "\0" * 1000000,
    "an open string": '#debug "' + "a" * 1000000,
    "an open comment": "/*" * 1000000,
    "comments in comments": "/*" * 100000 + "*/" * 100000,
    "one name of a million letters": "a" * 1000000,
    "a number of a million digits in text": "#declare A = 0." + "1" * 1000000 + ";\n",
    "a million faults": "sphere { 0, Raduis }\n" * 100000,
    "only closing braces": "}" * 1000000,
    "directives without a sense": "#else #end #case #range #break " * 50000,
    "a data file that is the scene": '#fopen F "SELF" read\n#while (defined(F)) #read (F, A) #end\n',
    "a data file for ever": forever('#fopen F "data.txt" read #fclose F'),
    "a file that is written without end": '#fopen F "written.txt" write\n' + forever('#write (F, "again", I)'),
    "files that are written without end": forever('#fopen F "written.txt" write #fclose F'),
    "a file that includes what it wrote": '#fopen F "grown.inc" append #write (F, "#declare A = 1;\\n") #fclose F\n' +
        forever('#include "grown.inc" #fopen F "grown.inc" append #write (F, "#declare B = 1;\\n") #fclose F'),
    "a picture that is none": HEAD + 'sphere { 0, 1 pigment { image_map { png "data.txt" } } }\n',
}


def write(path, text):
    with open(path, "w", encoding="latin-1") as file:
        file.write(text)


def processor_seconds(pid):
    with open("/proc/%d/stat" % pid, encoding="latin-1") as file:
        ticks = file.read().rpartition(")")[2].split()[11:13]
    return sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")


def run(*arguments, stop=None):
    """Exit code, standard error, processor seconds, bytes at most."""
    with open("err", "wb+") as err:
        process = subprocess.Popen([RTLANG, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=err,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (KILLED, KILLED)))
        timer = time.monotonic()
        while stop is None or time.monotonic() - timer < stop:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            time.sleep(0.002)
        else:
            pid = 0
        if not pid:
            before = processor_seconds(process.pid)
            os.kill(process.pid, signal.SIGTERM)  # send_signal would reap one that has just ended
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = 0
            return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime - before
        process.returncode = 0
        err.seek(0)
        said = err.read().decode("utf-8", "replace")
    return os.waitstatus_to_exitcode(status), said, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def slowness():
    """How much slower than the machine and build that the seconds were set for, which takes 0.15 of them."""
    write("measure.scn", "#for (I, 1, 1000000) #declare A = sin(I)*I; #end\n")
    return max(1.0, run("--check", "measure.scn")[2] / 0.15)


def test_ends(name, text, slow):
    write("hostile.scn", text.replace("SELF", "hostile.scn"))
    code, said, seconds, peak = run("-q", "-W4", "-H3", "-t1", *STEPS, "--allow-write=.", "-o", "x.png", "hostile.scn")
    located = re.search(r"(?m)^\S+:\d+:\d+: error\[E(049[04]|036\d|06\d\d)\]|^rtlang: error\[E06\d\d\]", said)
    ends = code in (0, 1, 3) and seconds <= SECONDS * slow
    at_limit = code == 4 and located and seconds <= SECONDS_AT_LIMIT * slow
    tap.ok((ends or at_limit) and peak <= BYTES * 1.2, name,
           "exit %d after %.1f s with %d MiB\n%s" % (code, seconds, peak >> 20, said[:400]))


def mesh_text(count):
    """A mesh of which the first face alone has normals."""
    places = ",".join("<%d,%d,%d>" % (i % 200, i // 200, i % 7) for i in range(count))
    faces = ",".join("<%d,%d,%d>" % (i, (i + 1) % count, (i + 200) % count) for i in range(count))
    return HEAD + "mesh2 { vertex_vectors { %d, %s } normal_vectors { 2, z, y } face_indices { %d, %s } " \
        "normal_indices { 1, <0, 1, 0> } pigment { rgb 1 } }\n" % (count, places, count, faces)


def test_memory_ends():
    write("mesh.scn", mesh_text(40000))
    outcomes = {kib: run("--check", "-q", "--max-memory=%dK" % kib, "mesh.scn") for kib in range(3000, 4800, 75)}
    codes = {outcome[0] for outcome in outcomes.values()}
    tap.ok(codes == {0, 4}, "a mesh for which there is not enough memory, at any place",
           ", ".join("%d KiB: exit %d" % (kib, outcome[0]) for kib, outcome in outcomes.items()))


LONG = {
    "evaluation": (forever(""), ["--check", "--max-steps=1000000000000"]),
    "functions": ("#declare F0 = function (x) { x }\n" +
                  named("declare", "= function (x) { F%d(x) + F%d(x) }", 60, "#debug str(F59(1), 0, 0)\n"),
                  ["--check", "--max-steps=1000000000000"]),
    "text": (BALL * 500000, ["--check", "--no-literals"]),
    "many shapes": (HEAD + "#for (I, 1, 3000000) sphere { <I, sin(I), cos(I)>, 1 } #end\n", ["-q", "-o", "x.png"]),
    "spheres around one point": (HEAD + "#for (I, 1, 1000000) sphere { 0, I/1000 } #end\n", ["-q", "-o", "x.png"]),
    "large composites": (HEAD + "difference { box { -9, 9 } #for (I, 1, 90000) sphere { <I, 0, 0>/9999, 0.1 } #end }\n",
                         ["-q", "-o", "x.png"]),
    "tracing": (HEAD + BALL, ["-q", "-W20000", "-H9000", "-o", "x.png"]),
    "sampling": (HEAD + BALL, ["-q", "-W900", "-H900", "--samples=100000", "-o", "x.png"]),
    "adaptive sampling": (HEAD + BALL, ["-q", "-W500", "-H500", "--target-error=1e-9", "-o", "x.png"]),
    "area lights": (HEAD + "light_source { 9, 1 area_light x, z, 1000, 1000 }\n" * 50 + BALL,
                    ["-q", "-W900", "-H900", "-o", "x.png"]),
    "a tree of rays": ("global_settings { max_trace_level 40 adc_bailout 0 }\n" + HEAD +
                       "#for (I, 0, 29) sphere { <mod(I, 5) - 2, mod(int(I/5), 3) - 1, int(I/15)>/2, 0.5 pigment { "
                       "rgbt 0.9 } finish { reflection 0.9 } interior { ior 1.5 } } #end\n",
                       ["-q", "-W4", "-H4", "-o", "x.png"]),
    # Nothing of it is met by the picture's own samples.
    "a tree of rays that is looked at beside": (
        "global_settings { max_trace_level 256 adc_bailout 0 }\n" + HEAD +
        "#for (I, 0, 29) box { <mod(I, 5) - 2, mod(int(I/5), 3) - 1, int(I/15)>/2 - 0.3, <mod(I, 5) - 2, "
        "mod(int(I/5), 3) - 1, int(I/15)>/2 + 0.35 rotate I pigment { rgbt 0.99 } finish { reflection 0.99 } "
        "interior { ior 1.3 } } #end\n", ["-q", "-W2", "-H2", "-t1", "--samples=4", "-o", "x.png"]),
    "a large picture of a scene": (HEAD + 'box { -1, 1 pigment { image_map { png "large.png" } } }\n',
                                   ["-q", "-W9", "-H9", "-o", "x.png"]),
    "a tree of many spheres": ("".join("sphere { <%d, %d, %d>, %g pigment { rgb <1, 0, %g> } }\n" %
                                       (i % 97, i % 89, i, 0.3 + i*1e-7, i % 7/7) for i in range(400000)) + HEAD,
                               ["-q", "-W9", "-H9", "-o", "x.png"]),
    "patterns": (HEAD + "plane { y, 0 pigment { average pigment_map { " + "[1 bozo turbulence 1 octaves 10]" * 200 +
                 "}}}\n", ["-q", "-W900", "-H900", "-o", "x.png"]),
    "quadruple precision": (HEAD + BALL, ["-q", "-W900", "-H900", "--samples=1000", "--precision=quad", "-o", "x.png"]),
    "photons": (HEAD + BALL, ["-q", "--method=forward", "--photons=1e12", "-o", "x.png"]),
    "--format": (BALL * 500000, ["--format"]),
    "meshes that are cut a thousand times": (HEAD + "#declare M = mesh { " +
        "".join("triangle { <%d, 0, 0>, <0, %d, 0>, <0, 0, 1> }\n" % (i, i) for i in range(1, 2000)) +
        "inside_vector <1, 2, 3> }\nintersection { " + "object { M } " * 1000 + "pigment { rgbt 0.9 } }\n",
        ["-q", "-W9", "-H9", "-o", "x.png"]),
    "polynomials that are seen through": (HEAD + ("poly { 35, <" + ", ".join(str(i % 3 - 1) for i in range(8436)) +
                                                 "> translate 0.1*z pigment { rgbt 0.9 } }\n") * 40,
                                          ["-q", "-W900", "-H900", "-o", "x.png"]),
    "many meshes": (HEAD + "#for (I, 1, 60000) mesh { triangle { <I, 0, 1>, x, y } } #end\n",
                    ["-q", "-W9", "-H9", "-o", "x.png"]),
    "texts": (HEAD + '#for (I, 1, 30000) text { ttf "timrom.ttf" "Wide" 1, 0 translate I*x } #end\n',
              ["-q", "-W9", "-H9", "-o", "x.png"]),
    "fogs": (HEAD + BALL + "fog { fog_type 2 distance 9 fog_alt 1 fog_offset 1 turbulence 1 turb_depth 1 octaves 10 "
             "rgbt 0.9 }\n" * 1000, ["-q", "-W900", "-H900", "-o", "x.png"]),
    "functions as patterns": (HEAD + "plane { y, 0 pigment { function { " + "sin(x)*cos(y*" * 200 + "z" + ")" * 200 +
                              " } } }\n", ["-q", "-W2000", "-H2000", "-o", "x.png"]),
    "layers": (HEAD + "sphere { 0, 1 " + "texture { pigment { rgbt 0.9 } }\n" * 100000 + "}\n", ["--check"]),
}


def test_interrupts(name, scene, slow):
    text, options = scene
    write("long.scn", text)
    chance = random.Random(name)
    late, codes = [], set()
    for _ in range(int(os.environ.get("HOSTILE_INTERRUPTS", "4"))):
        outcome = run(*options, "long.scn", stop=0.02 + chance.random() * 1.5)
        codes.add(outcome[0])
        if len(outcome) == 2:
            late.append(outcome[1])
    if max(late, default=0.0) > MOMENT * slow:
        print("# %s: %.2f s after the interrupt" % (name, max(late)))
    if codes == {3} and "ttf" in text:
        tap.skip("interrupted at any moment: " + name, "no FreeType, or none of POV-Ray's fonts")
        return
    # Seconds of the processors, all threads together: on an idle machine no more passes on the wall.
    tap.ok(codes <= {0, 1, 4, 143, -signal.SIGTERM} and max(late, default=0.0) <= 5 * MOMENT * slow * os.cpu_count(),
           "interrupted at any moment: " + name, "exit %s, seconds %s" % (codes, late))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write("empty.inc", "")
        write("data.txt", "1, 2, 3\n")
        write("comments.inc", "// nothing is said here\n" * 130000)
        write("comments.txt", "// nothing is said here\n" * 130000 + "1\n")
        write("statements.inc", "#declare A = 1;\n" * 200000)
        write("shapes.inc", "sphere { 0, 1 }\n" * 200000)
        write("macro.inc", "#macro M()\n" + "sphere { 0, 1 }\n" * 200000 + "#end\n")
        slow = slowness()
        print("# slowness %.2f" % slow)
        for name, text in SCENES.items():
            test_ends(name, text, slow)
        test_memory_ends()
        write("ball.scn", HEAD + BALL)
        run("-q", "-W9000", "-H7000", "-o", "large.png", "ball.scn")
        for name, scene in LONG.items():
            test_interrupts(name, scene, slow)
        os.chdir("/")
    tap.done()


main()
