#!/usr/bin/env python3
"""The same words given to povray and to rtlang in its place: the same files, pictures, debug text and exit status.

Anti-aliasing is without jitter, which POV-Ray draws at random. Prints TAP. SPDX-License-Identifier: MIT
"""
import concurrent.futures
import glob
import os
import struct
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures  # noqa: E402

PROGRAM = os.path.abspath(os.environ["RTLANG"])
BAR = {8: 1, 16: 2}  # codes
SCENE = """#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0.03, 1.07, -4.01> look_at 0 } // so that no ray is tangent
light_source { <-5, 8, -6>, rgb 1 }
background { rgbt <0.2, 0.4, 0.9, 1> }
sphere { <clock, 0, 0>, 1 pigment { rgb <0.8, 0.2, 0.1> } finish { phong 0.6 reflection 0.1 } }
#ifdef (Tint) sphere { <-1, 1, 0>, 0.5 pigment { rgb Tint } } #end
#ifdef (From_Header) sphere { <1, 1, 0>, 0.5 pigment { rgb From_Header } } #end
#debug concat(str(clock, 0, 4), " ", str(clock_delta, 0, 4), " ", str(initial_clock, 0, 2), " ", str(final_clock, 0, 2),
  " ", str(initial_frame, 0, 0), " ", str(final_frame, 0, 0), " ", str(frame_number, 0, 0), " ", str(image_width, 0, 0),
  " ", str(image_height, 0, 0), "\\n")
"""
FILES = {
    "s.pov": SCENE, "sub/t.pov": SCENE, "bare": SCENE, "UPPER.POV": SCENE, "with blank.pov": SCENE,
    "lib/l.pov": SCENE, "lib/l.ini": "+Is.pov +W9 +H7\n", "lib/h.inc": "#declare From_Header = 0.5;\n", "dir/keep": "",
    "povray.ini": "Width=16\nHeight=12\n",
    "r.ini": "; sizes\n+W20 +H10 ; by default\n[Low]\nWidth=8.9\n[ Rather High ]\n+H14\n[low]\n+H5",
    "n.ini": "# two\nr.ini[LOW]\nInput_File_Name = \"with blank.pov\"\n",
    "d.ini": "s.pov\r\nDeclare=Tint=0.25\r\nAntialias=1\r\nJitter=off\r\nAntialias_Threshold = 0.1 ; low\r\n",
    "q.ini": "Input_File_Name='s.pov'\n+O\"a b.png\" +W9 Height = 7\n",
}
# what is run; each word list is the whole command line but for -D
CASES = [
    ["s.pov"], ["+Is.pov"], ["-Is.pov"], ["+Is"], ["+Ibare"], ["+IUPPER"], ["+Isub/t.pov"], ["+Isub/t"],
    ["Input_File_Name=s.pov"], ["input_file_name=s.pov"], ['+I"with blank.pov"'], ["s.pov", "+Isub/t.pov"],
    ["missing.pov"], ["s.pov", "+W20", "+H10"], ["s.pov", "-W20", "-H10"], ["s.pov", "Width=20.9", "Height=10.2"],
    ["s.pov +W9", "+H5"], ["s.pov", "+Ofoo"], ["s.pov", "+Ofoo.png"], ["s.pov", "+Ofoo.tga"], ["s.pov", "+Ofoo.x.y"],
    ["s.pov", "+Odir/"], ["s.pov", "+Odir"], ["sub/t.pov", "+Ofoo"], ["sub/t.pov", "+Odir/"],
    ["sub/t.pov", "+Odir/-"], ["s.pov", "+Onone/x"], ["s.pov", "+Ofoo.PNG"], ["s.pov", "+O'foo bar.png'"],
    ["s.pov", "+Ofoo.jpeg", "+FJ"], ["s.pov", "+FN"], ["s.pov", "+FN8"], ["s.pov", "+FN16"], ["s.pov", "+FT"],
    ["s.pov", "+FC"], ["s.pov", "+FT16"], ["s.pov", "+FP"], ["s.pov", "+FP16"], ["s.pov", "+FJ"], ["s.pov", "+FB"],
    ["s.pov", "+FE"], ["s.pov", "+FH"], ["s.pov", "-F"], ["s.pov", "-FT"], ["s.pov", "Output_to_File=off"],
    ["s.pov", "Output_File_Type=T"], ["s.pov", "Output_File_Type=png"],
    ["s.pov", "Output_File_Type=N", "Bits_Per_Color=16"], ["s.pov", "+FX"], ["s.pov", "+O-"],
    ["s.pov", "+O-", "+FP"], ["s.pov", "+O-", "+FT"], ["s.pov", "+O-", "+FN16"], ["s.pov", "+O-", "+FP16"],
    ["s.pov", "+UA"], ["s.pov", "+UA", "+FT"], ["s.pov", "+UA", "+FN16"], ["s.pov", "+UA", "-UA"],
    ["s.pov", "File_Gamma=1.8"], ["s.pov", "File_Gamma=1.8", "+FT"], ["s.pov", "File_Gamma=1", "+FN16"],
    ["s.pov", "File_Gamma=srgb", "+FP"], ["s.pov", "+SC3", "+EC7"], ["s.pov", "+SR3", "+ER7"], ["s.pov", "+SC0.25"],
    ["s.pov", "+EC0.5"], ["s.pov", "+SC0.3", "+EC0.77", "+SR.26", "+ER.99"], ["s.pov", "+EC1"], ["s.pov", "+SC1"],
    ["s.pov", "+SC0"], ["s.pov", "+SC5.7"], ["s.pov", "Start_Row=0.5", "End_Row=1.0"], ["s.pov", "+EC100"],
    ["s.pov", "+SC17"], ["s.pov", "+SC3", "+EC7", "+UA"], ["s.pov", "+A", "-J"], ["s.pov", "+A0.1", "-J"],
    ["s.pov", "+A0.05", "-J", "+R4"], ["s.pov", "+A0.1", "+AM2", "-J"], ["s.pov", "+A0.1", "+AM2", "+R2", "-J"],
    ["s.pov", "-A0.1", "-J", "+A"], ["s.pov", "+A0.1", "-J", "+AG1"], ["s.pov", "+A0.0", "-J", "+R2"],
    ["s.pov", "Antialias=yes", "Jitter=no", "Antialias_Depth=2"], ["s.pov", "-A0.1"], ["s.pov", "+K0.25"],
    ["s.pov", "Clock=-0.5"], ["s.pov", "Declare=Tint=0.5"], ["s.pov", "Declare=Tint=1", "Declare=Tint=0"],
    ["s.pov", "+HIlib/h.inc"], ["s.pov", "+Llib", "+HIh.inc"], ["+Llib", "+Il"], ["l.pov", "+Llib"],
    ["+Llib", "l.ini"], ["+Llib", "l"], ["l.ini", "+Llib"], ["r.ini", "s.pov"], ["s.pov", "r.ini"],
    ["s.pov", "+W5", "r.ini"], ["s.pov", "r.ini", "+W5"], ["s.pov", "r.ini[LOW]"], ["s.pov", "r[low]"],
    ["s.pov", "r.ini[none]"], ["n.ini"], ["d.ini"], ["q.ini"], ["n"], ["s"], ["s.pov", "none.ini"],
    ["s.pov", "Include_Ini=r.ini"], ["s.pov", "+KFF3"], ["s.pov", "+KFF12", "+SF11"],
    ["s.pov", "+KFI5", "+KFF7", "+SF6"], ["s.pov", "+KFF10", "+SF0.25", "+EF0.55"],
    ["s.pov", "+KFI11", "+KFF20", "+SF0.5", "+EF0.7"], ["s.pov", "+KFF3", "+KC"], ["s.pov", "+KFF9", "+KC"],
    ["s.pov", "+KFF3", "+KI0.2", "+KF.5"], ["s.pov", "+KFF7", "+STP3"], ["s.pov", "+KFF3", "+Ofoo2.png"],
    ["s.pov", "+KFI0", "+KFF2"], ["s.pov", "+KFF3", "+EF5"], ["s.pov", "+KFF3", "+K0.5"],
    ["s.pov", "Final_Frame=2", "+Odir/", "+FT"], ["s.pov", "+KFF3", "+EF2", "+Ofoo.x"],
    ["s.pov", "+KFF2", "+O-", "+FP"],
    # what changes nothing
    ["s.pov", "+Q8"],
    ["s.pov", "+Q9", "+MB5", "+BM2", "+WT1", "+BS16", "+RP2", "+RS3", "+SP8", "+EP2", "+X", "+P", "+C", "-V"],
    ["s.pov", "+UL", "+UV", "+SU", "+UR", "+HR", "+RVP", "+B", "+MI64", "+X100", "Display_Gamma=2", "Test_Abort=on"],
    ["s.pov", "Pause_When_Done=off", "Light_Buffer=on", "Video_Mode=1", "Palette=G", "BSP_MaxDepth=64",
     "Compression=40"],
    # what is wrong
    ["s.pov", "+Zfoo"], ["s.pov", "Foo=3"], ["s.pov", "+Wabc"], ["s.pov", "Width=abc"], ["s.pov", "+W", "10"],
    ["s.pov", "-Px"], ["s.pov", "File_Gamma=abc"], ["s.pov", "+A5"], ["s.pov", "+MBx"], ["s.pov", "+H0"], ["+W5"],
    ["s.pov", "+K"],
]


def values(data, name):
    """(bits, width, height, channels, codes) of what both write alike; other formats are known by their first bytes."""
    if data[:2] == b"P6":
        lines, at = [], 0
        while len(lines) < 3:
            end = data.index(b"\n", at)
            lines += [data[at:end]] if data[at:at + 1] != b"#" else []
            at = end + 1
        (width, height), bits = map(int, lines[1].split()), 8 if lines[2] == b"255" else 16
        count = 3 * width * height
        codes = struct.unpack(">%d%s" % (count, "BH"[bits == 16]), data[at:at + count * bits // 8])
        return bits, width, height, 3, codes
    if name.endswith("tga") and data[2] in (2, 10) or data[:3] == b"\0\0\2":
        return targa(data)
    return None


def targa(data):
    width, height, bits = struct.unpack("<HHB", data[12:17])
    step, at, pixels = bits // 8, 18 + data[0], b""
    while data[2] == 10 and len(pixels) < width * height * step:
        count, at = (data[at] & 127) + 1, at + 1
        if data[at - 1] & 128:
            pixels, at = pixels + count * data[at:at + step], at + step
        else:
            pixels, at = pixels + data[at:at + count * step], at + count * step
    pixels = pixels or data[at:at + width * height * step]
    codes = [pixels[i + k] for i in range(0, len(pixels), step) for k in ((2, 1, 0, 3) if step == 4 else (2, 1, 0))]
    assert data[17] & 32, "rows from the top"
    return 8, width, height, step, codes


def png(path):
    """The same of a PNG file."""
    with open(path, "rb") as file:
        head = file.read(26)
    channels = {2: 3, 6: 4}[head[25]]
    width, height, codes = pictures.read_png(path, channels)
    return head[24], width, height, channels, list(codes)


def contents(folder, name):
    path = os.path.join(folder, name)
    with open(path, "rb") as file:
        data = file.read()
    return png(path) if data[:4] == b"\x89PNG" else values(data, name) or data[:2]


def run(program, words):
    """(status, {file of debug text: what is in it}, {picture: its codes}, stderr) of a run in a fresh folder."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in FILES.items():
            os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
            with open(os.path.join(folder, name), "w", encoding="ascii", newline="") as file:
                file.write(text)
        environment = dict(os.environ, HOME=os.path.join(folder, "dir"), POVINI="")
        done = subprocess.run([*program, *words, "-D", "+GDdebug.txt"], cwd=folder, env=environment, timeout=120,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
        with open(os.path.join(folder, "standard output"), "wb") as file:
            file.write(done.stdout)
        made = {}
        for top, _, names in os.walk(folder):
            for name in names:
                relative = os.path.relpath(os.path.join(top, name), folder)
                if relative not in FILES and not relative.endswith(("debug.txt", "pov-state")):
                    made[relative] = contents(folder, relative)
        said = {}
        for debug in glob.glob(f"{glob.escape(folder)}/**/debug.txt", recursive=True):
            with open(debug, encoding="utf-8") as file:
                said[os.path.relpath(debug, folder)] = file.read()
        return done.returncode, said, made, done.stderr.decode("utf-8", "replace")


def difference(ours, theirs):
    """What differs, or None."""
    if ours[0] != theirs[0]:
        return f"exit status {ours[0]}, POV-Ray {theirs[0]}: {ours[3][-300:]}"
    if ours[0] == 0 and ours[1] != theirs[1]:
        return f"debug text {ours[1]!r}, POV-Ray {theirs[1]!r}"
    if sorted(ours[2]) != sorted(theirs[2]):
        return f"files {sorted(ours[2])}, POV-Ray {sorted(theirs[2])}"
    for name, found in ours[2].items():
        expected = theirs[2][name]
        if found[:4] != expected[:4]:
            return f"{name}: {found[:4]}, POV-Ray {expected[:4]}"
        if len(found) == 5:
            # Where alpha is 0, colours mean nothing.
            far = max((abs(a - b) for a, b in zip(*visible(found, expected))), default=0)
            if far > BAR[found[0]]:
                return f"{name}: pixels differ by {far} codes"
    return None


def visible(found, expected):
    if found[3] != 4:
        return found[4], expected[4]
    seen = [i for i in range(len(found[4])) if i % 4 == 3 or (found[4][i | 3] and expected[4][i | 3])]
    return [found[4][i] for i in seen], [expected[4][i] for i in seen]


def main():
    povray = pictures.povray()
    print(f"1..{len(CASES)}" if povray else "1..0 # SKIP povray is not installed")
    if not povray:
        return 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        ours = pool.map(lambda words: run([PROGRAM, "--povray"], words), CASES)
        theirs = pool.map(lambda words: run([povray], words), CASES)
        failed = 0
        for number, (words, own, other) in enumerate(zip(CASES, ours, theirs), 1):
            found = difference(own, other)
            failed += found is not None
            print(f"{'not ok' if found else 'ok'} {number} - {' '.join(words)}", flush=True)
            if found:
                print("# " + found, flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
