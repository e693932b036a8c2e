/* rtlang: read a scene in the rtlang language, trace it, write the picture.
 *
 * The pipeline is rt_session_new, rt_load_file, rt_render, rt_write. All functions may be called from any thread, one
 * thread at a time per session; 128 kB of stack are enough. Where a thread has less than 4 MB left, what may nest deep is
 * done on a thread of the library's own, which makes the callbacks while the call waits. The library never prints and
 * never exits: messages go to the callbacks of the session.
 * Nothing here depends on the locale.
 *
 * SPDX-License-Identifier: MIT
 */
#ifndef RTLANG_H
#define RTLANG_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define RT_API __attribute__((visibility("default")))
#else
#define RT_API
#endif

/* The result of a call; also the exit code of the program rtlang. */
typedef enum rt_status {
    RT_OK = 0,
    RT_FAULT_SCENE = 1, /* the scene is wrong; diagnostics say where */
    RT_FAULT_USAGE = 2, /* an argument is out of range or a call out of order */
    RT_FAULT_IO = 3,    /* a file could not be read or written */
    RT_FAULT_LIMIT = 4, /* memory or another limit is exhausted */
    RT_CANCELLED = 5    /* rt_cancel was called */
} rt_status;

/* A note reports messages that were only counted. */
typedef enum rt_severity { RT_WARNING, RT_ERROR, RT_NOTE } rt_severity;

/* One message about the scene or the run. All pointers are valid during the callback only. */
typedef struct rt_diagnostic {
    rt_severity severity;
    const char *code;    /* "E0201"; "" for a note without one */
    const char *message; /* one line */
    const char *file;    /* NULL when the message belongs to no place */
    uint64_t line;       /* from 1; 0 when unknown */
    uint64_t column;     /* from 1, in characters */
    const char *text;    /* the whole printable form: location, source line, caret, notes, help; ends with a newline.
                          * With RT_FORMAT_JSON one JSON object on one line */
} rt_diagnostic;

/* What the scene itself says with #debug, #warning, #error, #render and #statistics. */
typedef enum rt_stream {
    RT_STREAM_DEBUG,
    RT_STREAM_WARNING,
    RT_STREAM_ERROR,
    RT_STREAM_RENDER,
    RT_STREAM_STATISTICS
} rt_stream;

/* Callbacks; each may be NULL. `client` is handed back. */
typedef struct rt_callbacks {
    void *client;
    void (*diagnostic)(void *client, const rt_diagnostic *diagnostic);
    void (*message)(void *client, rt_stream stream, const char *text, size_t length);
    void (*progress)(void *client, double done); /* 0 to 1, while rendering, from one thread at a time */
} rt_callbacks;

typedef struct rt_session rt_session;

/* Version of the library, "1.0.0". */
RT_API const char *rt_version(void);

/* A new session, or NULL when out of memory. The callbacks are copied. */
RT_API rt_session *rt_session_new(const rt_callbacks *callbacks);
RT_API void rt_session_free(rt_session *session);

/* Settings; call before rt_load_*. */
RT_API rt_status rt_add_include_path(rt_session *session, const char *folder);
/* Whether the include files of an installed POV-Ray are found (1, the default): in its usual folders and where its
 * povray.ini says. rtlang's own are always found; both after the folders above. */
RT_API rt_status rt_set_povray_includes(rt_session *session, int on);
/* Folder number `i`, from 0, of those that are searched after the current one; NULL past the end. Valid until the next
 * of these calls. */
RT_API const char *rt_include_path(rt_session *session, size_t i);
/* Let the scene read files below this folder too. It reads below its own folder and those of rt_include_path. */
RT_API rt_status rt_allow_read(rt_session *session, const char *folder);
/* Let the scene write files below this folder, and read them: `#fopen` with `write` or `append`. At first it writes
 * nowhere. */
RT_API rt_status rt_allow_write(rt_session *session, const char *folder);
/* A file that is included before the scene's first statement, as POV-Ray's Include_Header; "" for none. */
RT_API rt_status rt_set_header(rt_session *session, const char *path);
/* The scene's `clock`, 0 by default; `clock_on` is then true. */
RT_API rt_status rt_set_clock(rt_session *session, double clock);

/* How far a scene may go; beyond, a message says where it was, and the status is RT_FAULT_LIMIT. */
typedef enum rt_limit {
    RT_LIMIT_STEPS,   /* turns of loops and macro calls, 30 000 000; 256 bytes of a string that are worked on count as one */
    RT_LIMIT_DEPTH,   /* nesting of expressions, blocks, calls and includes, 1 to 1000; calls and includes nest less */
    RT_LIMIT_OBJECTS, /* shapes, 1 000 000 000 */
    RT_LIMIT_TEXT,    /* bytes of text in all files, 64 GiB */
    RT_LIMIT_MEMORY,  /* bytes of what is read, declared and prepared, and of the picture; by default 1 GiB and 16 bytes
                         for each byte of text, the picture apart, and together no more than what the machine, its
                         container and the process's limits leave */
    RT_LIMIT_MESSAGES /* bytes of what #debug and its like write, 16 MiB */
} rt_limit;
/* Sets a limit, at least 1; the defaults stand above. */
RT_API rt_status rt_set_limit(rt_session *session, rt_limit limit, uint64_t value);
/* For the scene of a stranger: small limits (3 000 000 steps, 1 000 000 shapes, 64 MiB of text, 256 MiB of memory
 * besides the picture, 512 MiB with it, 64 KiB of messages), pictures of the scene in PNG only, and no include files
 * but those of the scene's folders. rt_set_limit may follow. How long a run takes is the client's: rt_cancel. */
RT_API void rt_set_untrusted(rt_session *session);
/* Whether pictures of a scene in formats other than PNG, which large libraries decode, are read in a process of its own
 * that may do nothing but that (0, the default): a copy of the client's, made by fork while a scene is loaded. One that
 * crashes over a file is a fault of the scene. Costs a millisecond where such pictures are read. */
RT_API void rt_set_readers(rt_session *session, int on);
/* NAME=VALUE, as POV-Ray's Declare=: the value is a number. Of two declarations of a name the first holds. */
RT_API rt_status rt_declare(rt_session *session, const char *name_value);
/* Which warnings are reported, in the words of the program's -W: "all", "error", "W0201", "error=W0201", each also with
 * "no-" before it. */
RT_API rt_status rt_set_warning(rt_session *session, const char *what);
/* Which of some names, of which the last is NULL, a mistyped one most likely stands for; NULL: none is near. */
RT_API const char *rt_nearest(const char *mistyped, const char *const *names);
/* The form of the messages' text. With RT_FORMAT_JSON also what the scene itself says is handed over as one JSON object
 * a line. docs/diagnostics.md lists the members. RT_FORMAT_COLOR is RT_FORMAT_TEXT with the escape sequences of a
 * terminal, which what the scene itself says does not get. */
typedef enum rt_format { RT_FORMAT_TEXT, RT_FORMAT_JSON, RT_FORMAT_COLOR } rt_format;
RT_API void rt_set_format(rt_session *session, rt_format format);
/* An animation: a scene that is loaded once and rendered at several clocks. Before rt_load_*: */
RT_API rt_status rt_expect_frames(rt_session *session);
/* After it, and after rt_render: the clock is another one, and so are numbers that were declared with rt_declare, as
 * NAME=VALUE, always the same names. What depends on these, camera, lights, settings and shapes, is read again with the
 * shapes behind the first that does. The rest of the scene stays as it is, with its tree where no shapes depend on
 * them, and *is_set turns 1: rt_render draws the frame. Else it turns 0, and the scene is to be loaded in a new
 * session. The picture is the same, byte for byte; messages that do not depend on the frame come once. */
RT_API rt_status rt_set_frame(rt_session *session, double clock, const char *const *declarations, size_t count, int *is_set);
/* For study: the scene is put elsewhere, p' = scale p + shift for its camera, lights, shapes and textures, and the
 * lengths of fading scale along, so that the picture would be the same but for rounding. scale > 0. Skies stay. */
RT_API rt_status rt_set_world(rt_session *session, double scale, const double shift[3]);
/* Size of the picture in pixels, 1 to 65535 each; the scene may ask for it as image_width and image_height. Default 320
 * x 240. */
RT_API rt_status rt_set_size(rt_session *session, int width, int height);
/* Trace a part of that picture only: the film is then of the part's size, and its pixels are those of the whole picture
 * there, bit for bit, unless sampling is adaptive, which then chooses among the part's pixels. RT_FAULT_USAGE when the
 * part does not lie in the picture; rt_set_size takes the whole again. */
RT_API rt_status rt_set_crop(rt_session *session, int left, int top, int width, int height);

/* Read and evaluate a scene: the first step. A session loads one scene, or after rt_begin_scene its parts. The path "-"
 * is standard input. */
RT_API rt_status rt_load_file(rt_session *session, const char *path);
RT_API rt_status rt_load_text(rt_session *session, const char *name, const char *text, size_t length);

/* Number `i`, from 0, of the files that the scene was read from, as far as it came: its text, what that included and
 * opened, and pictures. A file may come more than once. NULL past the end. Valid until the session's end. */
RT_API const char *rt_scene_file(const rt_session *session, size_t i);

/* ---- a scene without text: arrays of numbers become its shapes
 *
 *     rt_begin_scene(session);
 *     rt_add_spheres(session, &spheres, NULL);    any number of times, with rt_load_text before, between and behind
 *     rt_add_light(session, &light);
 *     rt_set_camera(session, &camera);
 *     rt_render(session, 0);                      any number of times: what changed between is built again
 *
 * The scene begins as the text "#version 3.7; global_settings { assumed_gamma 1 }" does: colours are linear light,
 * lengths have the scene's own unit, angles are in degrees. The same numbers as text give the same picture, byte for
 * byte. Arrays are read where they are, during the call only, and stay the caller's; of each sphere the scene keeps 40 bytes,
 * and 24 of a colour that differs. Numbers are checked before any is taken: after a fault of
 * rt_add_*, rt_set_* or rt_update_spheres the scene is as it was, and the message says "spheres[17]" where element 17,
 * from 0, is wrong; after one of rt_load_* it is lost, and all that needs it returns RT_FAULT_USAGE. What can only be
 * reported for the whole scene, rt_render reports. */

/* `count` is not here: element i stands at (const char *)data + i * stride, and its numbers follow each other `step`
 * bytes apart. */
typedef enum rt_number { RT_FLOAT64, RT_FLOAT32 } rt_number;
typedef struct rt_array {
    const void *data; /* NULL: not given */
    rt_number number;
    ptrdiff_t stride; /* 0: one element for all; may be negative */
    ptrdiff_t step;   /* of arrays with several numbers an element */
} rt_array;

/* What shapes look like. */
typedef struct rt_look {
    rt_array colors;     /* not given: white */
    int color_numbers;   /* 3: red, green, blue; 4: and transmit; 5: red, green, blue, filter, transmit */
    const char *finish;  /* what stands in finish { } of the language, "phong 0.5 ambient 0.2"; NULL: the default */
} rt_look;

typedef struct rt_spheres {
    const char *name; /* for messages; NULL: "spheres" */
    size_t count;
    rt_array centers; /* 3 numbers */
    rt_array radii;   /* 1, at least 0; spheres of radius 0 are not drawn, with a warning */
    rt_look look;
} rt_spheres;

/* Round rods between two points: cylinders, or cones where the ends have radii of their own. */
typedef struct rt_rods {
    const char *name; /* NULL: "rods" */
    size_t count;
    rt_array bases, caps;           /* 3 numbers each: the middles of the ends, which may not be one point */
    rt_array base_radii, cap_radii; /* 1, at least 0; cap_radii not given: those of the bases */
    int open;                       /* without the discs at the ends */
    rt_look look;
} rt_rods;

typedef struct rt_triangles {
    const char *name; /* NULL: "triangles" */
    size_t count;
    rt_array corners; /* 9 numbers: three points. Those on one line are not drawn, with a warning */
    rt_array normals; /* 9: of the corners, all on one side; not given: the triangles are flat */
    rt_look look;
} rt_triangles;

/* The scene of this session is built by calls. Before rt_load_*, which then may be called any number of times, for a
 * further part of the scene; what a part declares ends with it. Not together with rt_set_world. */
RT_API rt_status rt_begin_scene(rt_session *session);
/* Adds shapes. *group, unless NULL, names them for rt_update_spheres. */
RT_API rt_status rt_add_spheres(rt_session *session, const rt_spheres *spheres, size_t *group);
RT_API rt_status rt_add_rods(rt_session *session, const rt_rods *rods);
RT_API rt_status rt_add_triangles(rt_session *session, const rt_triangles *triangles);
/* Other numbers for spheres first to first + count - 1 of a group: those arrays that are given. Finish and name are not
 * looked at. RT_FAULT_USAGE for a group of which spheres of radius 0 were left out. Colours alone build no tree;
 * spheres that move keep theirs, whose boxes are made to fit, as long as it stays about as good as a new one:
 * rt_summary tells. */
RT_API rt_status rt_update_spheres(rt_session *session, size_t group, size_t first, const rt_spheres *spheres);

/* A camera; the same as the text that stands at the right, with 0 for what is left at 0. */
typedef struct rt_camera {
    double location[3], look_at[3];
    double up[3];        /* sky; all 0: y */
    double angle;        /* across the picture, degrees, less than 180; 0: as of direction 1 */
    double width;        /* above 0: orthographic, and so many units wide */
    double aspect;       /* width / height of the picture; 0: that of rt_set_size as it is now */
    int right_handed;    /* coordinates are right-handed: right -aspect*x; 0: left-handed, as the language's */
    double aperture;     /* above 0: a lens of this `aperture`, in focus at look_at */
} rt_camera;
/* Instead of the one that there is, of whatever kind. After rt_load_* of any session, too. It costs no tree, unless the
 * range of numbers that the scene is traced in changes by it. */
RT_API rt_status rt_set_camera(rt_session *session, const rt_camera *camera);

typedef struct rt_light {
    double position[3];
    double color[3];
    double point_at[3]; /* parallel only */
    int parallel;       /* rays are parallel, from position to point_at */
    int shadowless;
    double radius;      /* above 0: a round area light of `size` by `size` lights that faces what it lights */
    int size;           /* 2 to 64; 0: 4 */
} rt_light;
RT_API rt_status rt_add_light(rt_session *session, const rt_light *light);
RT_API rt_status rt_clear_lights(rt_session *session);
/* Red, green, blue, and how much of it is clear where pictures have alpha (rt_set_alpha): `rgbt`. */
RT_API rt_status rt_set_background(rt_session *session, const double color[4]);

/* The box around all shapes of the scene but planes. RT_FAULT_USAGE when there are none. */
RT_API rt_status rt_get_box(const rt_session *session, double low[3], double high[3]);

/* For study: the camera of the loaded scene goes away from the middle of its shapes, to `factor` times their distance,
 * and zooms along, so that what stands there has the same size in the picture. factor > 0. */
RT_API rt_status rt_move_camera(rt_session *session, double factor);

/* Printable forms of each stage. Tokens and AST are made from a file that need not be a whole scene; the dump of the
 * scene needs rt_load_*. AST and scene are valid scene text again. *text is valid until the next call on the session,
 * and is set also when there were faults: it then holds what could be read. */
typedef enum rt_syntax { RT_SYNTAX_TOKENS, RT_SYNTAX_AST } rt_syntax;
RT_API rt_status rt_dump_syntax(rt_session *session, rt_syntax stage, const char *path, const char **text);
RT_API rt_status rt_dump_scene(rt_session *session, const char **text);

/* What a message's code means, at length: "E0201". *text is valid until the next call on the session. RT_FAULT_USAGE
 * when there is no such code. */
RT_API rt_status rt_explain(rt_session *session, const char *code, const char **text);
/* What the loaded scene takes and what it does not: what is left out at each stage and why, and what the rest costs in
 * rays and time, which is found by tracing without it. `threads` is as for rt_render. *text is valid until the next
 * call. */
RT_API rt_status rt_explain_scene(rt_session *session, int threads, const char **text);

/* Hands the client a fault of its own in the form of all others, with a code of this library, a message and a
 * suggestion (or NULL). Returns the status that the code means. */
RT_API rt_status rt_report(rt_session *session, const char *code, const char *message, const char *suggestion);
/* The same for a fault in a text that the client has read itself, as a file of options: `name` is what the text is
 * called, and the fault stands in its bytes from `begin` up to `end`. */
RT_API rt_status rt_report_in(rt_session *session, const char *code, const char *name, const char *text, size_t begin,
                              size_t end, const char *message, const char *suggestion);

/* The text of a file in the canonical layout (docs/language.md, "Layout"), with its comments. The file need not be a
 * whole scene: any text whose tokens can be read has a layout. *text is "" when there were faults, else valid until the
 * next call on the session. */
RT_API rt_status rt_format_file(rt_session *session, const char *path, const char **text);
/* The same of a text. */
RT_API rt_status rt_format_text(rt_session *session, const char *name, const char *text, size_t length, const char **laid_out);
/* A word of the language, for editors: number `i` from 0; 0 past the end. A word may come more than once. */
typedef struct rt_word {
    const char *word;
    const char *place; /* the block that it is a property of; "" for what stands alone */
    const char *doc;   /* what it is, a line */
} rt_word;
RT_API int rt_get_word(size_t i, rt_word *word);
/* Whether the file is in the canonical layout: RT_FAULT_SCENE, and a diagnostic at the first place where it is not. */
RT_API rt_status rt_check_format(rt_session *session, const char *path);
/* Write what the last rt_dump_*, rt_format_file or rt_trace_pixel made; the file appears whole or not at all. "-" is
 * standard output. */
RT_API rt_status rt_write_text(rt_session *session, const char *path);

/* Whether what POV-Ray has and rtlang has not is left out with a warning, W0409, instead of being a fault (0, the
 * default). The files of pictures then say what was. */
RT_API void rt_set_lenient(rt_session *session, int on);

/* Before rt_load_*, and with another text any time after it: the files of pictures, PNG and EXR, say what they were
 * drawn from. `options` is the client's text for what it set, ASCII. PNG has it as text under "rtlang:options", beside
 * "rtlang:scene", the digest of the scene's text (BLAKE2b with 256 bits), and "rtlang:files", the number and the digest
 * of the digests of all files that it included or opened; EXR as attributes. "Software" always says program and
 * version. There is no date: the same run makes the same file. */
RT_API rt_status rt_set_provenance(rt_session *session, const char *options);
/* One of these texts of a file; NULL: it has none. *text is valid until the next call on the session. */
RT_API rt_status rt_read_note(rt_session *session, const char *path, const char *name, const char **text);

/* Whether usual text is read and evaluated by faster ways than the general one, as is the default (1). With 0 nothing
 * is; the scene and its messages are the same. */
RT_API void rt_set_literals(rt_session *session, int on);

/* Threads that long runs of such spheres are read with, and that large scenes are looked through with when they have
 * been read; 0 (the default) for as many as the machine has. A scene and its messages do not depend on it. */
RT_API rt_status rt_set_load_threads(rt_session *session, int threads);

/* Names of the instruction sets that the tracer can use on this machine, from plain C to the best, and NULL past the
 * end. */
RT_API const char *rt_isa(size_t i);
/* Use one of them; the best is used if nothing is said. The picture does not depend on it. */
RT_API rt_status rt_set_isa(rt_session *session, const char *name);
/* The precision that the next rt_render works in. All but RT_PRECISION_DOUBLE use a reference kernel for study, which
 * tests each shape for each ray and refuses what it does not know. It samples as the usual ones do. RT_FAULT_USAGE when
 * the library was built without it. */
typedef enum rt_precision {
    RT_PRECISION_DOUBLE,
    RT_PRECISION_FLOAT,
    RT_PRECISION_QUAD,
    RT_PRECISION_REFERENCE /* double, by the reference kernel */
} rt_precision;
RT_API rt_status rt_set_precision(rt_session *session, rt_precision precision);
/* Several rays a pixel; docs/sampling.md. Names are those of the program's options; all zero is one ray a pixel. */
typedef struct rt_sampling {
    const char *sampler; /* "sobol", "halton", "jittered", "grid" or "random"; NULL for the first */
    const char *filter;  /* "box", "tent", "gaussian" or "mitchell"; NULL for the first */
    double samples;      /* a pixel; 0: as many as the goals below want, or 1 if there are none */
    uint64_t seed;
    int adaptive;        /* more where the error is, `samples` in the mean; goals imply it */
    double target_error; /* root mean square in linear light, at which the run ends; 0: none */
    double time_limit;   /* seconds of tracing; 0: none */
    int no_estimate;     /* do not compute the error; the picture is the same */
    int no_pixel_errors; /* errors of single pixels are not asked for, so that of a large picture some tell the error */
    int max_trace_level; /* instead of the scene's; 0: the scene's */
} rt_sampling;
/* RT_FAULT_USAGE for an unknown name, a number out of range, or goals with "jittered" or "grid". */
RT_API rt_status rt_set_sampling(rt_session *session, const rt_sampling *sampling);

/* How light is followed: from the eye; or, for study, photons from the lights, counted where they pass the lens, or
 * with each hit connected to it. The latter two know few scenes (docs/sampling.md) and take `photons` instead of
 * samples. */
typedef enum rt_method { RT_METHOD_BACKWARD, RT_METHOD_FORWARD, RT_METHOD_FORWARD_CONNECT } rt_method;
RT_API rt_status rt_set_method(rt_session *session, rt_method method, uint64_t photons);

/* POV-Ray's anti-aliasing, to compare with its pictures: more rays where colours differ. Without rt_set_sampling. */
typedef struct rt_antialias {
    int method;       /* 0: none, 1: pixels that differ from a neighbour, 2: squares whose corners differ */
    int depth;        /* 1 to 9; 0: 3 */
    double threshold; /* 0 or more: by how much red, green and blue differ together */
    double gamma;     /* above 0; 0: 2.5. Colours are compared after their 1/gamma-th power */
} rt_antialias;
/* RT_FAULT_USAGE for a number out of range. */
RT_API rt_status rt_set_antialias(rt_session *session, const rt_antialias *antialias);

/* Light from all sides, as of an even sky: red, green and blue of what a surface gets that nothing covers, 0 or
 * more; all 0, the default: none. What is in the way dims corners and pockets: ambient occlusion. It has no
 * highlights, the background stays what it is, and scenes do not know of it. It is sampled as area lights are; with
 * one ray a pixel each surface asks in 16 directions. RT_FAULT_USAGE for other numbers; rt_render refuses it with
 * RT_PRECISION_FLOAT, QUAD and REFERENCE and with the forward methods. Call it before rt_load_*, else a scene
 * without lights is warned of. */
RT_API rt_status rt_set_sky_light(rt_session *session, const double color[3]);

/* Lines of a color (linear light) around shapes, `width` pixels wide, 0 to 16; 0, the default: none. They go where a
 * shape ends before another one or before nothing, and where two objects meet at an angle: neighbours of one mesh and
 * the halves of a rod have none between them. They are drawn over the light, where the middle of a lens sees shapes,
 * and stand before the background of pictures with alpha. RT_FAULT_USAGE for other numbers. */
RT_API rt_status rt_set_outline(rt_session *session, double width, const double color[3]);
/* Far things turn to one color (depth cue): from nothing of it at `near` to `strength` of it at `far` and beyond, along
 * the camera's direction. What meets nothing stays as it is. */
typedef struct rt_depth_cue {
    double strength; /* 0 to 1; 0: none */
    int has_color;   /* 0: the color of the scene's background */
    double color[3]; /* linear light */
    double near, far; /* 0 or more, far above near; both 0: as far as the shapes of the scene but planes reach */
} rt_depth_cue;
/* RT_FAULT_USAGE for other numbers. */
RT_API rt_status rt_set_depth_cue(rt_session *session, const rt_depth_cue *cue);

/* Whether pictures tell, beside their light, how much each pixel shows of what is behind the scene: of the clear part
 * of its background, or of all of it in scenes of before version 3.7. 0, the default: the background is light like all
 * else. RT_FAULT_USAGE from rt_render with another precision than double or a forward method. */
RT_API void rt_set_alpha(rt_session *session, int on);

/* What a picture may tell of each pixel beside its light, a bit each, and the channels of it that an EXR has. The last
 * four are of the first surface that the ray through the pixel's middle meets, without a lens: the same with and
 * without samples, by any method. */
typedef enum rt_plane {
    RT_PLANE_ERROR = 1,   /* `error`: float, what the pixel is off by, root mean square, linear; sampled pictures */
    RT_PLANE_SAMPLES = 2, /* `samples`: uint32_t, those that it has; of adaptive runs 1: its corners only */
    RT_PLANE_DEPTH = 4,   /* `Z`: float, distance from the eye; infinity where nothing is met */
    RT_PLANE_NORMAL = 8,  /* `normal.X`, `.Y`, `.Z`: floats, unit normal without bumps, of the side that is seen; or 0 */
    RT_PLANE_OBJECT = 16, /* `object`: uint32_t, its place in the order of declaration, from 1; 0 where nothing is met */
    RT_PLANE_ALBEDO = 32, /* `albedo.R`, `.G`, `.B`: floats, the pigment's colour as far as it is opaque, linear */
    RT_PLANES_ALL = 63
} rt_plane;
/* The planes of pictures from now on, bits of rt_plane; 0, the default: none, and they cost nothing. rt_render reports
 * E0703 for the first two where the picture is not sampled. RT_FAULT_USAGE for other bits. */
RT_API rt_status rt_set_planes(rt_session *session, unsigned planes);
/* Copies one plane of the rendered picture: its numbers pixel by pixel, from the top row. `bytes` is the room at
 * `values`; RT_FAULT_USAGE unless it is what the plane takes, 4 bytes a number, and unless rt_set_planes asked for
 * it. */
RT_API rt_status rt_get_plane(rt_session *session, rt_plane plane, void *values, size_t bytes);

/* Nobody asks for the scene after the next rt_render, which may free parts of it as it continues: with very many
 * spheres it takes a tenth less memory. From then on no scene is loaded, and the session does not load another. */
RT_API void rt_discard_scene(rt_session *session);

/* Trace the loaded scene with `threads` threads, 0 for as many as the machine has: the second step. May be repeated,
 * with other settings of size, crop, sampling and the like: what was built for shapes that did not change serves again,
 * and the new picture takes the place of the old one. */
RT_API rt_status rt_render(rt_session *session, int threads);
/* The life of the ray through the middle of pixel x, y (from 0, the top left one) of the loaded scene: what it meets,
 * the quadratic of each sphere and the root that is used, the hit and its light, and the same for the rays that
 * continue. Its colour is the picture's. Text, or with RT_FORMAT_JSON one object on one line. *text is valid until the
 * next call on the session. RT_FAULT_USAGE when the pixel is not in the picture. */
RT_API rt_status rt_trace_pixel(rt_session *session, int x, int y, const char **text);
/* What rt_trace_pixel makes: the log (the default), or a drawing of it as an <svg> element, in the plane that holds the
 * camera's ray and the normal where it hits. Numbers of the log have at most so many digits, 1 to 17; 0, the default:
 * as many as tell them apart. The drawing of a pixel that was asked for can be written by rt_write_text. */
typedef enum rt_trace_form { RT_TRACE_LOG, RT_TRACE_SVG } rt_trace_form;
RT_API rt_status rt_set_trace_form(rt_session *session, rt_trace_form form, int digits);

/* Why a sampled run ended. */
typedef enum rt_end { RT_END_DONE, RT_END_TARGET, RT_END_TIME, RT_END_INTERRUPTED } rt_end;

/* What sampling leaves of error in the picture, computed from the samples themselves. May be asked for while rendering,
 * from the progress callback. */
typedef struct rt_error {
    int known;              /* 0: one ray a pixel, or no estimate; only `samples` then means something */
    double rmse, low, high; /* root mean square over all values, in linear light; ends of the 95 % interval */
    double samples;         /* a pixel, in the mean; 0: not every pixel has one */
    double slope;           /* of log rmse in log samples, as far as it is known */
    double bias;            /* what rays cut by max_trace_level or adc_bailout would add in the mean, at the least */
    double bias_by_level;   /* of it: by max_trace_level */
    rt_end end;
    double seconds_left;    /* while rendering: predicted, or negative */
    /* Shapes, and highlights, of no more than a few pixels that can be seen and that no sample met, and their area in
     * pixels. What they would bring is in rmse and its interval. */
    double unmet_shapes, unmet_shape_area, unmet_highlights, unmet_highlight_area;
    int unmet_are_about; /* there are about so many: not all were looked at */
    /* A detail of any other kind that may have been missed: how much of a pixel it is at the most, with 95 %
     * confidence, and the rmse that it would bring were it as far from what is around it as the picture's values are from each
     * other. */
    double missed_area, missed_error;
} rt_error;
RT_API void rt_get_error(const rt_session *session, rt_error *error);
/* What became of the photons of a forward run: emitted, that met a surface, and how often one counted on the film. */
typedef struct rt_photons {
    uint64_t emitted, met, arrived;
} rt_photons;
RT_API void rt_get_photons(const rt_session *session, rt_photons *photons);
/* Write the error of each pixel as a grey picture in linear light. RT_FAULT_USAGE when there is none. */
RT_API rt_status rt_write_error(rt_session *session, const char *path);
/* Makes a running rt_load_*, rt_dump_syntax or rt_render stop soon. The only call that may be made from another thread
 * or a signal handler. */
RT_API void rt_cancel(rt_session *session);
/* Takes that back, so that the session may continue. */
RT_API void rt_resume(rt_session *session);

/* How the picture is written. */
typedef enum rt_depth {
    RT_DEPTH_AUTO = 0, /* what suits the format: float for EXR and HDR, else 8 */
    RT_DEPTH_8 = 8,
    RT_DEPTH_16 = 16,
    RT_DEPTH_FLOAT = 32
} rt_depth;

typedef struct rt_output {
    rt_depth depth;
    double file_gamma; /* 0: sRGB; otherwise the power, 1 writes linear values */
    unsigned planes;   /* of rt_plane, that the file has as channels beside its light; only EXR has room for them */
    int whole;         /* 1: after rt_set_crop, a picture of rt_set_size that is black around the part */
    int continues;     /* 1: of Y4M, a further frame of the film that was begun on standard output */
} rt_output;

/* Whether a picture of this size fits the memory limit and could be written to this path, asked before a long run.
 * RT_FAULT_USAGE for planes in another format than EXR or beyond those of rt_set_planes, and for alpha in one that has
 * none. */
RT_API rt_status rt_check_output(rt_session *session, const char *path, const rt_output *output);
/* Write the rendered picture, the format by the ending of the path; "-" writes PNG to standard output, "-.ppm" PPM, and
 * so on; "-.y4m" is a film, of which each call writes a frame. RT_FAULT_USAGE for a plane that was not wanted when the
 * picture was rendered. */
RT_API rt_status rt_write(rt_session *session, const char *path, const rt_output *output);

/* The rendered picture (after RT_CANCELLED, too, when rt_get_error reports samples): width * height * 3 floats (red,
 * green, blue) from the top row, in linear light, not clamped; of a scene that says nothing of gamma (docs/language.md,
 * "Gamma"), the values as they are stored in the file. Valid until the next rt_render and the session's end; NULL
 * before rt_render. */
RT_API const float *rt_pixels(const rt_session *session, int *width, int *height);

/* The same, handed over without a copy: from now on it is the caller's, until rt_free_pixels, also after the session's
 * end, and the session has no picture: ask for planes and rt_transparency before. */
RT_API float *rt_take_pixels(rt_session *session, int *width, int *height);
RT_API void rt_free_pixels(float *pixels);

/* With rt_set_alpha: width * height numbers, the share of what is behind the scene: 1 - alpha. It is not in the light
 * of rt_pixels, which so is multiplied with alpha. NULL otherwise and before rt_render. */
RT_API const float *rt_transparency(const rt_session *session);

/* The picture's numbers, encoded as output says (RT_DEPTH_AUTO: 8 bits; floats are linear): rows from the top, red,
 * green, blue and with rt_set_alpha alpha each, in the machine's byte order, of uint8_t, uint16_t or float. Colours are
 * not multiplied with alpha. `bytes` is the room at `pixels`; RT_FAULT_USAGE unless it is what the picture takes, and
 * before rt_render. */
RT_API rt_status rt_get_pixels(rt_session *session, const rt_output *output, void *pixels, size_t bytes);
/* A picture from elsewhere, as if it had been rendered: width * height * 3 floats of linear light, and transparency (as
 * of rt_transparency) or NULL. They are copied. What is known of errors is forgotten. */
RT_API rt_status rt_set_pixels(rt_session *session, int width, int height, const float *rgb, const float *transparency);
/* The PNG file that rt_write would write, 8 or 16 bits. *bytes is valid until the next call of it and until the session
 * is freed. */
RT_API rt_status rt_get_png(rt_session *session, const rt_output *output, const unsigned char **bytes, size_t *size);

/* The memory of a scene that is loaded, in bytes. */
typedef struct rt_budget {
    uint64_t objects;  /* shapes */
    uint64_t scene;    /* the records of the scene, held now */
    uint64_t prepared; /* at most what rendering adds for tree and prepared records */
    uint64_t picture;  /* the film */
    uint64_t limit;    /* of all together: RT_LIMIT_MEMORY */
} rt_budget;
/* What rt_render will need, reported before it is spent. RT_FAULT_USAGE when no scene is loaded. Of a scene that ranks
 * share: what the one needs that needs most; called by all, also where it could not be loaded. */
RT_API rt_status rt_get_budget(rt_session *session, rt_budget *budget);

/* What was done and how long it took. */
typedef struct rt_summary {
    int width, height;
    uint64_t objects, lights;
    uint64_t camera_rays, shadow_rays, reflected_rays, transmitted_rays;
    double parse_seconds, prepare_seconds, trace_seconds, write_seconds; /* wall time */
    uint64_t errors, warnings;
    const char *kernel; /* name of the kernel that traced the picture, "" before rt_render */
    uint64_t trees;  /* that were built of the scene's shapes, in all calls of rt_render */
    uint64_t refits; /* and how often that of the spheres stayed for others, its boxes made to fit */
    uint64_t out_of_range; /* of the warnings, those of shapes, lights and cameras beyond the range of numbers */
} rt_summary;
RT_API void rt_get_summary(const rt_session *session, rt_summary *summary);

/* How large and how far the shapes of a loaded scene are, all but its planes: for programs with fixed tolerances, of
 * which rtlang has none. Where there is no such shape, what is least is infinite and the rest 0. */
typedef struct rt_range {
    double eye_offset;  /* greatest coordinate of the camera's place */
    double least_size;  /* radius of the smallest shape, or of the ball around its box */
    double reach;       /* from the camera to the farthest point of any shape */
    double nearest_far; /* from the camera to the nearest point of the shape for which this is greatest */
    double least_angle; /* least ratio of a shape's radius to its distance from the camera */
} rt_range;
RT_API void rt_get_range(const rt_session *session, rt_range *range);

#ifdef __cplusplus
}
#endif
#endif
