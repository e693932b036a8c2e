# Bad input and bad command lines, case by case: what rtlang is given. What it must answer, word for word, stands in
# expected/NAME.txt: the exit code on the first line, then standard error.
#
# SPDX-License-Identifier: MIT

GOOD = b"""camera { location -5*z look_at 0 }
light_source { <5, 5, -5>, 1 }
sphere { 0, 1 pigment { rgb 1 } }
"""

# Name of the case -> text of its scene, which is NAME.scn.
SCENES = {
    "unclosed_brace": b"sphere { 0, 1 pigment { rgb 1 }\n",
    "unknown_word": b"""camera { location -5*z look_at 0 }
spere { 0, 1 }
sphere { 0, 1 pigmant { rgb 1 } }
#declare Radius = 2;
sphere { 0, Raduis }
""",
    "wrong_type": b"""camera { location "here" }
sphere { 0, <1, 2, 3> }
sphere { 0, 1 pigment { rgb "red" } }
#declare T = 1 + "one";
""",
    "missing_camera": b"light_source { <5, 5, -5>, 1 }\nsphere { 5*z, 1 pigment { rgb 1 } }\n",
    "empty_file": b"",
    "binary_file": bytes(range(256)) * 4,
    "picture_as_scene": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(40),
    "jpeg_as_scene": b"\xff\xd8\xff\xe0\0\x10JFIF\0",
    "exr_as_scene": b"\x76\x2f\x31\x01\x02\0\0\0channels\0",
    "gif_as_scene": b"GIF89a\x40\x01\xf0\0\xf7\0\0",
    "tiff_as_scene": b"II*\0\x08\0\0\0",
    "pdf_as_scene": b"%PDF-1.4\n1 0 obj\n",
    "program_as_scene": b"\x7fELF\x02\x01\x01\0",
    "zip_as_scene": b"PK\x03\x04\x14\0\0\0",
    "gzip_as_scene": b"\x1f\x8b\x08\0\0\0\0\0",
    "page_as_scene": b"<!DOCTYPE html>\n<html>\n",
    "utf_16": "sphere { 0, 1 }\n".encode("utf-16"),
    "utf_16_without_mark": "sphere { 0, 1 }\n".encode("utf-16-le"),
    "utf_16_big_endian": "sphere { 0, 1 }\n".encode("utf-16-be"),
    "picture_included": b'#include "picture.inc"\n',
    "quotes_1252": b"#include \x93colors.inc\x94\n#debug \x91a\x92\n#debug \x84a\x94\n#debug \xaba\xbb\n#debug \x8ba\x9b\n"
                   b"#declare A = \x93;\n",
    "missing_include": b'#include "nowhere.inc"\nsphere { 0, 1 }\n',
    "include_loop": b'#include "loop_a.inc"\n',
    "include_itself": b'#include "include_itself.scn"\n',
    "endless_recursion": b"#macro Again(N)\n  Again(N + 1)\n#end\nAgain(0)\n",
    "endless_loop": b"#while (1)\n#end\n",
    "unclosed_if": b"#if (1)\nsphere { 0, 1 }\n",
    "not_supported": b"scattering { 1, 0.2 }\nsphere { 0, 1 pigment { facets } }\n",
    "not_finite": b"#declare A = 1e308 * 10;\nsphere { <A, 0, 0>, 1 }\n",
    "many_faults": b"".join(b"sphere { Name_%d, 1 }\n" % i for i in range(30)),
    "data_file": b"""#fopen File "data.txt" read
#while (defined(File)) #read (File, X, Y) #end
#fopen File "absent.txt" read
#fopen Out "out.txt" write
""",
    "outside_folders": b"""#include "/etc/passwd"
#include "../outside.txt"
#fopen File "link.txt" read
#if (file_exists("/etc/passwd")) #end
#include "/etc/no such file"
#fopen File "dangling.txt" read
#if (file_exists("/no such folder/x")) #end
""",
    "pipe_included": b'#include "pipe.inc"\n',
    "error_directive": b'#error "stop here"\n',
    "messages": b'#debug "one\\n"\n#warning "two"\n#debug "three\\n"\n' + GOOD,
}

# Files beside the scenes.
FILES = {
    "standard.scn": b'#include "woods.inc"\n#include "shapes"\n#include "wood.inc"\nsphere { 0, 1 }\n',
    "picture.inc": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR",
    "bytes.scn": GOOD.replace(b"rgb 1 }", b"rgb <255, 128, 0> }") + b"sphere { 3, 1 pigment { rgb 255 } }\n"
                 b"sphere { 5, 1 pigment { color red 128 green 64 blue 0 } }\nlight_source { 50, rgb 100 }\n"
                 b"sphere { <1, 5, 5>, 1 pigment { rgb <0, 0, 200> } }\nsphere { 7, 1 pigment { rgbt <1, 0, 0> } }\n",
    "inside.scn": b"camera { location 0 look_at z }\nlight_source { 9, 1 }\nsphere { 0, 1 }\nsphere { 5*z, 1 }\n",
    "inside_glass.scn": b"camera { location 0 look_at z }\nlight_source { 9, 1 }\nsphere { 0, 1 pigment { rgbf 1 } }\n",
    "inside_sky.scn": b"camera { location 0 look_at z }\nlight_source { 9, 1 }\nsphere { 0, 100 }\nsphere { 5*z, 1 }\n",
    "away.scn": b"camera { location -5*z look_at -9*z }\nlight_source { 9, 1 }\nsphere { 0, 1 }\nbox { 1, 2 }\nplane { z, 3 }\n",
    "beside.scn": b"camera { orthographic location <9, 0, -5> right 4*x up 3*y }\nlight_source { 9, 1 }\nsphere { 0, 1 }\n",
    "fixed.scn": GOOD.replace(b"look_at 0", b"look_at 0 right 4/3*x"),
    "talks.scn": b'#while (1) #debug "again\\n" #end\n',
    "good.scn": GOOD,
    "loop_a.inc": b'#include "loop_b.inc"\n',
    "loop_b.inc": b'#include "loop_a.inc"\n',
    "plain_file": b"",
    "data.txt": b"1, 2,\r\n3, 4\r\n5, 6\r\n",
    "many.scn": b"#for (I, 1, 100000)\n  sphere { I, 1 }\n#end\n",
    "deep.scn": b"#declare A = 1 + (2 * (3 + (4 * 5)));\n",
}

# Cases that end with a picture all the same.
DRAWN = {"missing_camera", "empty_file", "messages"}

# Name of the case -> arguments; none of them writes a picture.
COMMANDS = {
    "standard_include": ["--no-povray-includes", "standard.scn"],
    "all_bytes": ["--check", "-Wall", "bytes.scn"],
    "all_inside": ["--check", "-Wall", "inside.scn"],
    "all_inside_glass": ["--check", "-Wall", "inside_glass.scn"],
    "all_inside_sky": ["--check", "-Wall", "inside_sky.scn"],
    "all_away": ["--check", "-Wall", "away.scn"],
    "all_beside": ["--check", "-Wall", "beside.scn"],
    "all_stretched": ["--check", "-Wall", "-W", "800", "-H", "200", "fixed.scn"],
    "all_fits": ["--check", "-Wall", "-W", "800", "-H", "600", "fixed.scn"],
    "without_all": ["--check", "-W", "800", "-H", "200", "fixed.scn"],
    "width_letters": ["-W", "abc", "good.scn"],
    "width_warnings": ["-Wal", "good.scn"],
    "width_long": ["--width=abc", "good.scn"],
    "height_letters": ["-H", "abc", "good.scn"],
    "mistyped_option": ["--witdh=5", "good.scn"],
    "mistyped_option_one_dash": ["-width", "5", "good.scn"],
    "mistyped_letter": ["-w", "5", "good.scn"],
    "mistyped_isa": ["--isa=v33", "good.scn"],
    "mistyped_method": ["--method=forwrd", "good.scn"],
    "mistyped_sampler": ["--sampler=soboll", "good.scn"],
    "mistyped_filter": ["--filter=gausian", "good.scn"],
    "mistyped_dump": ["--dump=tokns", "good.scn"],
    "mistyped_precision": ["--precision=flaot", "good.scn"],
    "mistyped_diagnostics": ["--diagnostics=jsn", "good.scn"],
    "mistyped_color": ["--color=allways", "good.scn"],
    "colored": ["--color=always", "--check", "inside.scn", "-Wall"],
    "colored_json": ["--color=always", "--diagnostics=json", "--check", "-Wall", "inside.scn"],
    "not_laid_out": ["--format", "--check", "good.scn"],
    "scene_is_a_directory": ["folder.png"],
    "scene_not_found": ["nowhere.scn"],
    "mistyped_scene": ["goood.scn"],
    "mistyped_scene_in_folder": ["./god.scn"],
    "scene_read_error": ["/proc/self/mem"],
    "output_folder_missing": ["-o", "/nonexistent/x.png", "good.scn"],
    "output_is_a_directory": ["-o", "folder.png", "good.scn"],
    "output_below_a_file": ["-o", "plain_file/x.png", "good.scn"],
    "output_link_to_full_device": ["-o", "full.png", "good.scn"],
    "output_without_ending": ["-o", "picture", "good.scn"],
    "output_unknown_format": ["-o", "x.foo", "good.scn"],
    "output_depth": ["-o", "x.jpg", "--depth=16", "good.scn"],
    "output_name_empty": ["-o", "", "good.scn"],
    "limit_steps": ["--max-steps=1000", "--check", "many.scn"],
    "limit_depth": ["--max-depth=3", "--check", "deep.scn"],
    "limit_objects": ["--max-objects=1000", "--check", "many.scn"],
    "limit_text": ["--max-text=30", "--check", "many.scn"],
    "limit_memory": ["--max-memory=2M", "--check", "many.scn"],
    "limit_memory_device": ["--max-memory=1M", "--check", "/dev/zero"],
    "limit_messages": ["--max-messages=100", "--check", "talks.scn"],
    "limit_memory_picture": ["-W", "65535", "-H", "65535", "--max-memory=8G", "-o", "x.png", "good.scn"],
    "limit_memory_shapes": ["-W", "8", "-H", "8", "--max-memory=16M", "-o", "x.png", "many.scn"],
    "limit_zero": ["--max-steps=0", "good.scn"],
    "limit_unit": ["--max-memory=1X", "good.scn"],
    "limit_depth_great": ["--max-depth=1001", "good.scn"],
    "clock_not_a_number": ["--clock=noon", "good.scn"],
    "option_ambiguous": ["--d", "good.scn"],
    "unknown_option": ["--what", "good.scn"],
    "unknown_letter": ["-x", "good.scn"],
    "argument_missing": ["good.scn", "-W"],
    "argument_missing_long": ["good.scn", "--output"],
    "argument_not_expected": ["--check=1", "good.scn"],
    "width_zero": ["-W", "0", "good.scn"],
    "height_not_whole": ["-H", "1.5", "good.scn"],
    "threads_zero": ["-t", "0", "good.scn"],
    "depth_unknown": ["--depth", "12", "good.scn"],
    "file_gamma_zero": ["--file-gamma", "0", "good.scn"],
    "antialias_unknown": ["--antialias=3", "good.scn"],
    "antialias_depth_great": ["--antialias=1", "--antialias-depth=10", "good.scn"],
    "antialias_threshold_negative": ["--antialias=1", "--antialias-threshold=-0.1", "good.scn"],
    "antialias_gamma_zero": ["--antialias=1", "--antialias-gamma=0", "good.scn"],
    "antialias_and_samples": ["--antialias=2", "--samples=4", "good.scn"],
    "antialias_and_crop": ["--antialias=2", "--crop=0,0,8,8", "good.scn"],
    "antialias_and_precision": ["--antialias=2", "--precision=float", "good.scn"],
    "method_and_precision": ["--method=forward-connect", "--precision=quad", "good.scn"],
    "method_and_samples": ["--method=forward-connect", "--samples=4", "good.scn"],
    "dump_unknown": ["--dump=trees", "good.scn"],
    "declare_without_value": ["-D", "Size", "good.scn"],
    "declare_reserved_word": ["-D", "sphere=1", "good.scn"],
    "declare_not_a_number": ["-D", "Size=big", "good.scn"],
    "no_scene": [],
    "two_scenes": ["-o", "one.png", "good.scn", "wrong_type.scn"],
}

# Cases whose message is another without OpenImageIO.
WANT_OPENIMAGEIO = {"output_unknown_format", "output_depth"}

# As COMMANDS, with standard output on a full device.
COMMANDS_FULL = {
    "output_full_device": ["-o", "-", "good.scn"],
    "help_full_device": ["--help"],
    "version_full_device": ["--version"],
    "dump_full_device": ["--dump=ast", "good.scn"],
}

# As COMMANDS, by a user who may not; skipped where every user may.
COMMANDS_UNPRIVILEGED = {
    "scene_unreadable": ["secret.scn"],
    "include_unreadable": ["include_secret.scn"],
    "output_read_only": ["-o", "read_only.png", "good.scn"],
    "output_folder_read_only": ["-o", "closed/x.png", "good.scn"],
}
