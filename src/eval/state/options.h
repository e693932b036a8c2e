// What an evaluation is given: by eval/eval.h to clients, and to all rooms of the evaluator.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_STATE_OPTIONS_H
#define EVAL_STATE_OPTIONS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/diag.h"
#include "base/intern.h"
#include "base/library.h"
#include "base/limits.h"
#include "base/source.h"
#include "base/text.h"
#include "math/noise.h"
#include "scene/scene.h"

typedef enum EvalStream {
    EVAL_STREAM_DEBUG,
    EVAL_STREAM_WARNING,
    EVAL_STREAM_ERROR,
    EVAL_STREAM_RENDER,
    EVAL_STREAM_STATISTICS,
} EvalStream;

// A name that is declared before the scene begins, as with -D.
typedef struct EvalDeclaration {
    const char *name;
    const char *text; // the string, or NULL
    double number;    // when text is NULL
} EvalDeclaration;

// Where the whole scene is put: camera, lights and objects, with their textures, and the lengths that the language
// leaves as they are (fading, cylinders of light): p' = scale p + shift.
typedef struct EvalWorld {
    double scale; // > 0
    Vec3 shift;
} EvalWorld;

// The global names that a scene declares, and those of them that nothing asks for.
typedef struct EvalNames {
    size_t declared, unused;
} EvalNames;

// What a ray meets first of the parts of a scene.
typedef struct EvalHit {
    Vec3 point, normal; // of unit length, outward
    uint32_t shape;     // the tracer's own
    uint32_t part;      // Primitive.order
} EvalHit;

// The tracer, which the evaluator itself must not know.
typedef struct EvalTracer {
    void *(*open)(const Scene *parts); // NULL when out of memory; the scene stays as it is until `close`
    // From a point, or continuing from where a surface was met; the direction is of unit length. False: nothing is met.
    bool (*closest)(const void *opened, Vec3 origin, Vec3 direction, const EvalHit *from, EvalHit *hit);
    size_t (*bytes)(const void *opened); // of memory that it takes
    void (*close)(void *opened);
} EvalTracer;

// What patterns and pigments are at points, which the evaluator itself must not know.
typedef struct EvalPainter {
    // A scene of pigments, whose pictures are read; NULL when out of memory. It stays as it is until `close`, and the
    // noise stays valid as long.
    void *(*open)(const Scene *pigments, const Noise *noise);
    // Of a pigment that is a pattern, its value alone. The generator is that of patterns that say nothing else.
    double (*value)(void *opened, const Pigment *pigment, NoiseGenerator generator, Vec3 point);
    Rgbft (*colour)(void *opened, const Pigment *pigment, NoiseGenerator generator, Vec3 point);
    size_t (*bytes)(const void *opened); // of memory that it takes
    void (*close)(void *opened);
} EvalPainter;

// Where several processes read a scene, each keeping a part of its spheres.
typedef struct EvalShare {
    int part, parts; // of `parts`, this process is number `part`
    // Gives all what each has, `length` bytes; false: one of them cannot continue, which is reported.
    bool (*exchange)(void *client, const void *own, void *all, size_t length);
} EvalShare;

// What an evaluation is given. Pointers must stay valid during the call; nothing is owned.
typedef struct EvalOptions {
    SourceMap *sources;
    InternTable *names; // reserved words interned
    DiagSink *diags;
    const Limits *limits;
    const char *const *include_paths; // folders, searched in order after the current one
    size_t include_path_count;
    Library *library; // the folders searched after these, filled when they are needed; NULL: none
    const char *const *read_folders; // where files may be read besides the scene's folder and the include paths
    size_t read_folder_count;
    const char *const *write_folders; // where files may be written, and read
    size_t write_folder_count;
    const EvalDeclaration *declarations;
    size_t declaration_count;
    const char *header;            // a file that is included before the first item; NULL: none
    int image_width, image_height; // for the scene's own arithmetic
    double clock;
    bool clock_on;             // a clock was given
    const EvalWorld *world;    // NULL: where it says
    double version;            // of the language, in force at the beginning; 0: the source says it
    bool is_lenient;           // what rtlang has not is left out, with a warning
    TextBuffer *left_out;      // what was, with commas between; NULL: nobody asks
    bool no_literals;          // nothing is read or evaluated by a faster way than all else is
    int threads;               // for long runs of such statements; 0 and 1: the caller's alone
    size_t literal_piece;      // bytes of text that each of these takes at a time; 0: as is best
    const EvalTracer *tracer;  // for `trace`; NULL: there is none
    const EvalPainter *painter; // for functions of patterns and pigments; NULL: there is none
    bool (*load_pictures)(void *client, Scene *scene); // of these; false after a fault; NULL: none are read
    void (*statement)(void *client, Span span); // each of the text itself, before it is evaluated; NULL: nobody asks
    EvalNames *declared;       // set in the end; may be NULL
    const EvalShare *share;    // NULL: all spheres are kept here
    const atomic_bool *cancel; // when it turns true, evaluation stops soon; may be NULL
    // What the scene says with #debug, #render and #statistics: whole lines, broken at 80 columns as POV-Ray's console
    // does. What #warning and #error say is a diagnostic. May be NULL.
    void (*message)(void *client, EvalStream stream, const char *text, size_t length);
    void *client;
} EvalOptions;

#endif
