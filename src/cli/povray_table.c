// Each row says in its help what becomes of the option; docs/povray-options.md is made of it.
//
// SPDX-License-Identifier: MIT
#include "cli/povray_table.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/attributes.h"

#define FIELD(name) offsetof(PovraySettings, name)

// Rows of options that are followed; ones that change no picture; and ones that would.
#define FLAG(key, letters, name, help) {key, letters, NULL, POVRAY_BOOL, true, FIELD(name), 0, 0, NULL, help}
#define WHOLE(key, letters, low, high, name, help) \
    {key, letters, NULL, POVRAY_INTEGER, true, FIELD(name), low, high, NULL, help}
#define NUMBER(key, letters, low, high, name, help) \
    {key, letters, NULL, POVRAY_NUMBER, true, FIELD(name), low, high, NULL, help}
#define TEXT(key, letters, kind, name, help) {key, letters, NULL, kind, true, FIELD(name), 0, 0, NULL, help}
#define PAIR(key, letters, value_key, name, help) \
    {key, letters, value_key, POVRAY_BOOL, true, FIELD(name), 0, 0, NULL, help}
#define NOTHING(key, letters, kind, help) {key, letters, NULL, kind, false, 0, -HUGE_VAL, HUGE_VAL, NULL, help}
#define NOTHING_PAIR(key, letters, value_key, help) \
    {key, letters, value_key, POVRAY_BOOL, false, 0, 0, 0, NULL, help}
#define REFUSED(key, letters, kind, refusal, help) \
    {key, letters, NULL, kind, false, 0, -HUGE_VAL, HUGE_VAL, refusal, help}
#define COMMAND(key) REFUSED(key, NULL, POVRAY_TEXT, "rtlang runs no programs", "no program is run")

static const char shown[] = "there is no preview";
static const char bounded[] = "shapes are always bounded, which changes no picture";
static const char radiosity[] = "radiosity is refused, or left out by --lenient";
static const char timed[] = "for the order of work only";
static const char quality[] = "rtlang always draws shadows, textures, reflection and refraction";
static const char returned[] = "no program is run";

static const PovrayRow rows[] = {
    // Animation
    NUMBER("Clock", "K", -HUGE_VAL, HUGE_VAL, clock, "the scene's clock, without an animation"),
    WHOLE("Initial_Frame", "KFI", 0, 999999999, initial_frame, "number of the first frame (default 1)"),
    WHOLE("Final_Frame", "KFF", -1, 999999999, final_frame, "number of the last frame; makes an animation"),
    NUMBER("Initial_Clock", "KI", -HUGE_VAL, HUGE_VAL, initial_clock, "clock of the first frame (default 0)"),
    NUMBER("Final_Clock", "KF", -HUGE_VAL, HUGE_VAL, final_clock, "clock of the last frame (default 1)"),
    NUMBER("Subset_Start_Frame", "SF", 0, 999999999, subset_start, "draw from this frame on; below 1 a share of them"),
    NUMBER("Subset_End_Frame", "EF", 0, 999999999, subset_end, "draw up to this frame; below 1 a share of them"),
    WHOLE("Frame_Step", "STP", 1, 999999999, frame_step, "draw each so many-th frame"),
    FLAG("Cyclic_Animation", "KC", is_cyclic, "the last frame is one step before the first again"),
    REFUSED("Field_Render", "UF", POVRAY_BOOL, "rtlang draws whole frames, not fields of every other row",
            "frames are whole"),
    REFUSED("Clockless_Animation", NULL, POVRAY_BOOL, "frames have the clock that their numbers say", "frames have a clock"),
    NOTHING("Odd_Field", "UO", POVRAY_BOOL, "for Field_Render only"),
    // Size and part
    WHOLE("Height", "H", 1, 65535, height, "height of the picture (default 120; Debian's povray.ini says 600)"),
    WHOLE("Width", "W", 1, 65535, width, "width of the picture (default 160; Debian's povray.ini says 800)"),
    NOTHING("Max_Image_Buffer_Memory", "MI", POVRAY_INTEGER, "`--max-memory` is the limit"),
    NUMBER("Start_Column", "SC", 0, 65535, start_column, "draw from this column on, from 1; below 1 a share of them"),
    NUMBER("Start_Row", "SR", 0, 65535, start_row, "draw from this row on, from 1; below 1 a share of them"),
    NUMBER("End_Column", "EC", 0, 65535, end_column, "draw up to this column; 1 and below a share of them"),
    NUMBER("End_Row", "ER", 0, 65535, end_row, "draw up to this row; 1 and below a share of them"),
    // Interrupting and resuming
    NOTHING_PAIR("Test_Abort", "X", "Test_Abort_Count", "signals interrupt, keys do not"),
    NOTHING("Test_Abort_Count", NULL, POVRAY_INTEGER, "signals interrupt, keys do not"),
    NOTHING("Continue_Trace", "C", POVRAY_BOOL, "the picture is drawn from its beginning"),
    TEXT("Create_Ini", "GI", POVRAY_FILE, create_ini, "write the options that are in force to this file"),
    // Display
    NOTHING_PAIR("Display", "D", "Video_Mode", shown),
    NOTHING("Video_Mode", NULL, POVRAY_TEXT, shown),
    NOTHING("Palette", NULL, POVRAY_TEXT, shown),
    NOTHING("Display_Gamma", NULL, POVRAY_GAMMA, shown),
    NOTHING("Pause_When_Done", "P", POVRAY_BOOL, shown),
    FLAG("Verbose", "V", verbose, "a progress bar, on a terminal"),
    NOTHING("Draw_Vistas", "UD", POVRAY_BOOL, shown),
    NOTHING("Preview_Start_Size", "SP", POVRAY_INTEGER, shown),
    NOTHING("Preview_End_Size", "EP", POVRAY_INTEGER, shown),
    REFUSED("Real_Time_Raytracing", "RTR", POVRAY_BOOL, "rtlang draws pictures into files only", shown),
    // Picture file
    PAIR("Output_to_File", "F", "Output_File_Type", has_output, "write a picture file (default on)"),
    TEXT("Output_File_Type", NULL, POVRAY_TYPE, type,
         "N: PNG (default), T, C: Targa, P: PPM, J: JPEG, B: BMP, E: OpenEXR,\n"
         "H: Radiance"),
    FLAG("Output_Alpha", "UA", has_alpha, "with alpha; N, T and E only"),
    TEXT("Bits_Per_Color", NULL, POVRAY_BITS, bits, "8 or 16 bits a value, of N and P; with the switch: +FN16"),
    TEXT("Bits_Per_Colour", NULL, POVRAY_BITS, bits, "the same"),
    REFUSED("Grayscale_Output", NULL, POVRAY_BOOL, "rtlang writes pictures in colour", "pictures are in colour"),
    NOTHING("Compression", NULL, POVRAY_INTEGER, "JPEG is written at the quality of OpenImageIO"),
    TEXT("Output_File_Name", "O", POVRAY_TEXT, output,
         "the picture's name, to which the format's ending is added if it lacks;\n"
         "with / at its end a folder; - is standard output (default: the scene's\n"
         "name, in the scene's folder)"),
    NOTHING_PAIR("Buffer_Output", "B", "Buffer_Size", "POV-Ray ignores it, too"),
    NOTHING("Buffer_Size", NULL, POVRAY_INTEGER, "POV-Ray ignores it, too"),
    {"Dither", "TH", "Dither_Method", POVRAY_BOOL, false, 0, 0, 0, "rtlang does not dither", "values are rounded"},
    NOTHING("Dither_Method", NULL, POVRAY_TEXT, "for Dither only"),
    TEXT("File_Gamma", NULL, POVRAY_GAMMA, file_gamma, "how values are stored: sRGB (default) or a number"),
    // Scene
    TEXT("Declare", NULL, POVRAY_DECLARE, declarations, "NAME=NUMBER: declare a name before the scene begins"),
    TEXT("Input_File_Name", "I", POVRAY_TEXT, input, "the scene; .pov may be left out"),
    TEXT("Include_Header", "HI", POVRAY_TEXT, header, "include this file before the scene's first statement"),
    TEXT("Library_Path", "L", POVRAY_LIBRARY, libraries,
         "look here, too, for scenes, .ini files and #include; adds up"),
    TEXT("Include_Ini", NULL, POVRAY_INI, texts, "read this file of options here"),
    {"Version", "MV", NULL, POVRAY_NUMBER, false, 0, 3.7, 3.7, NULL, "3.7 only: older ones are said by #version"},
    // Commands
    COMMAND("Pre_Scene_Command"),
    COMMAND("Pre_Frame_Command"),
    COMMAND("Post_Scene_Command"),
    COMMAND("Post_Frame_Command"),
    COMMAND("User_Abort_Command"),
    COMMAND("Fatal_Error_Command"),
    NOTHING("Pre_Scene_Return", NULL, POVRAY_TEXT, returned),
    NOTHING("Pre_Frame_Return", NULL, POVRAY_TEXT, returned),
    NOTHING("Post_Scene_Return", NULL, POVRAY_TEXT, returned),
    NOTHING("Post_Frame_Return", NULL, POVRAY_TEXT, returned),
    NOTHING("User_Abort_Return", NULL, POVRAY_TEXT, returned),
    NOTHING("Fatal_Error_Return", NULL, POVRAY_TEXT, returned),
    // Text
    PAIR("Debug_Console", "GD", "Debug_File", consoles[POVRAY_DEBUG], "what #debug says, on stderr"),
    PAIR("Fatal_Console", "GF", "Fatal_File", consoles[POVRAY_FATAL], "errors, on stderr"),
    PAIR("Render_Console", "GR", "Render_File", consoles[POVRAY_RENDER], "what is drawn, on stderr"),
    PAIR("Statistic_Console", "GS", "Statistic_File", consoles[POVRAY_STATISTICS], "the summary, on stderr"),
    PAIR("Warning_Console", "GW", "Warning_File", consoles[POVRAY_WARNING], "warnings, on stderr"),
    {"All_Console", "GA", "All_File", POVRAY_ALL_ON, true, FIELD(consoles), 0, 0, NULL, "all of these, on stderr"},
    TEXT("Debug_File", NULL, POVRAY_FILE, files[POVRAY_DEBUG], "the same into a file; `true` is debug.out"),
    TEXT("Fatal_File", NULL, POVRAY_FILE, files[POVRAY_FATAL], "the same into a file; `true` is fatal.out"),
    TEXT("Render_File", NULL, POVRAY_FILE, files[POVRAY_RENDER], "the same into a file; `true` is render.out"),
    TEXT("Statistic_File", NULL, POVRAY_FILE, files[POVRAY_STATISTICS], "the same into a file; `true` is stats.out"),
    TEXT("Warning_File", NULL, POVRAY_FILE, files[POVRAY_WARNING], "the same into a file; `true` is warning.out"),
    TEXT("All_File", NULL, POVRAY_FILE, files[POVRAY_ALL], "all of these into a file; `true` is alltext.out"),
    FLAG("Append_File", "GP", appends, "append to these files"),
    WHOLE("Warning_Level", "WL", 0, 10, warning_level, "0: no warnings; others: all"),
    // Tracing
    WHOLE("Work_Threads", "WT", 0, 1024, threads, "threads to use; the picture does not depend on it"),
    NOTHING("Render_Block_Size", "BS", POVRAY_INTEGER, timed),
    NOTHING("Render_Pattern", "RP", POVRAY_INTEGER, timed),
    NOTHING("Render_Block_Step", "RS", POVRAY_INTEGER, timed),
    {"Quality", "Q", NULL, POVRAY_INTEGER, true, FIELD(quality), 8, 11, quality,
     "8 to 11, which differ in what rtlang does not have; lower ones are refused"},
    NOTHING_PAIR("Bounding", "MB", "Bounding_Threshold", bounded),
    NOTHING("Bounding_Threshold", NULL, POVRAY_INTEGER, bounded),
    NOTHING("Bounding_Method", "BM", POVRAY_INTEGER, bounded),
    NOTHING("BSP_MaxDepth", NULL, POVRAY_INTEGER, bounded),
    NOTHING("BSP_BaseAccessCost", NULL, POVRAY_NUMBER, bounded),
    NOTHING("BSP_ChildAccessCost", NULL, POVRAY_NUMBER, bounded),
    NOTHING("BSP_IsectCost", NULL, POVRAY_NUMBER, bounded),
    NOTHING("BSP_MissChance", NULL, POVRAY_NUMBER, bounded),
    NOTHING("Light_Buffer", "UL", POVRAY_BOOL, "for speed only"),
    NOTHING("Vista_Buffer", "UV", POVRAY_BOOL, "for speed only"),
    {"Remove_Bounds", "UR", NULL, POVRAY_BOOL, false, 0, 1, 1, "rtlang has no bounds that could cut an object",
     bounded},
    NOTHING("Split_Unions", "SU", POVRAY_BOOL, bounded),
    // Anti-aliasing and radiosity
    PAIR("Antialias", "A", "Antialias_Threshold", antialias, "more rays where colours differ"),
    WHOLE("Sampling_Method", "AM", 1, 2, method, "1: pixels that differ from a neighbour, 2: squares whose corners do"),
    NUMBER("Antialias_Threshold", NULL, 0, 3, threshold,
           "by how much red, green and blue differ together (default 0.3)"),
    NOTHING_PAIR("Jitter", "J", "Jitter_Amount",
                 "samples stay in their places, which POV-Ray moves at random"),
    NOTHING("Jitter_Amount", NULL, POVRAY_NUMBER, "see Jitter"),
    WHOLE("Antialias_Depth", "R", 1, 9, depth, "rows and columns of samples, or partings (default 3)"),
    NUMBER("Antialias_Gamma", "AG", 1e-6, 1e6, antialias_gamma,
           "colours are compared after this power's root (default 2.5)"),
    NOTHING("High_Reproducibility", "HR", POVRAY_BOOL, "pictures always are the same"),
    NOTHING("Radiosity_File_Name", "RF", POVRAY_TEXT, radiosity),
    NOTHING("Radiosity_From_File", "RFI", POVRAY_BOOL, radiosity),
    NOTHING("Radiosity_To_File", "RFO", POVRAY_BOOL, radiosity),
    NOTHING("Radiosity_Vain_Pretrace", "RVP", POVRAY_BOOL, radiosity),
};
_Static_assert(RT_COUNT_OF(rows) < POVRAY_ROWS_MOST, "enlarge POVRAY_ROWS_MOST");

const PovrayRow *povray_row(size_t i)
{
    return i < RT_COUNT_OF(rows) ? &rows[i] : NULL;
}

const PovrayRow *povray_row_of_key(const char *key, size_t length)
{
    for (size_t i = 0; i < RT_COUNT_OF(rows); i++) {
        if (strncasecmp(rows[i].key, key, length) == 0 && rows[i].key[length] == '\0') {
            return &rows[i];
        }
    }
    return NULL;
}
