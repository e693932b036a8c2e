// The state of an evaluation, its limits and its reports: what all rooms of the evaluator share.
//
// Rooms, from the ground up: state, values (what there is to compute with), run (the text: names, directives, macros,
// files), build (blocks to descriptions and scene records). Each knows those before it.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_STATE_STATE_H
#define EVAL_STATE_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "ast/ast.h"
#include "ast/words.h"
#include "base/arena.h"
#include "base/array.h"
#include "base/hidden.h"
#include "base/suggest.h"
#include "base/text.h"
#include "eval/state/options.h"
#include "math/colour.h"
#include "math/noise.h"
#include "math/vec3.h"
#include "scene/scene.h"
#include "scene/schema.h"

typedef struct Eval Eval;
typedef struct Value Value;             // values/value.h
typedef struct ValueArray ValueArray;
typedef struct Scope Scope;             // run/scope.h
typedef struct Cursor Cursor;           // run/run.h
typedef struct CursorFrame CursorFrame;
typedef struct FileState FileState;     // run/files.c
typedef struct DataFile DataFile;       // run/datafile.c
typedef struct WrittenFile WrittenFile; // run/written.c
typedef struct Lint Lint;               // run/lint.c
typedef struct Origins Origins;         // run/origin.c
typedef struct KeptBlock KeptBlock;     // values/kept.c
typedef struct ObjectState ObjectState; // build/blocks.h: default texture, scratch of the objects
typedef struct Painted Painted;         // build/painted.c
typedef struct GrammarText GrammarText; // grammar/grammar.h
typedef struct GrammarSlot GrammarSlot;
typedef struct GrammarPlan GrammarPlan;
typedef struct GrammarHooks GrammarHooks;
typedef struct GrammarContext GrammarContext;

// A room calls what lies above it through one of these two tables only.

// What values ask of the text that they stand in (run/expression.c).
typedef struct EvalText {
    bool (*expression)(Eval *ev, const AstNode *node, Value *value);
    bool (*number)(Eval *ev, const AstNode *node, double *number);
    bool (*vector3)(Eval *ev, const AstNode *node, Vec3 *vector);
    bool (*string)(Eval *ev, const AstNode *node, Value *value);
    bool (*is_declared)(Eval *ev, const AstNode *target);
    bool (*has_file)(Eval *ev, const Value *name, Span span, bool *is_there);
} EvalText;

// What running text asks of those who build of its blocks (build/object.c).
typedef struct EvalBuilder {
    bool (*place)(Eval *ev, const AstNode *item);                // a statement: adds it to the scene
    bool (*block)(Eval *ev, const AstNode *block, Value *value); // a right-hand side
    bool (*texture_layers)(Eval *ev, const AstNode *first, Value *value);
    bool (*texture_layer)(Eval *ev, const AstNode *node, Value *layers);
    bool (*set_default)(Eval *ev, const AstNode *directive);
    bool (*is_statement)(const Eval *ev, const AstNode *item);   // what the item's word begins
    bool (*takes_braces)(const Eval *ev, Symbol word);
    bool (*trace)(Eval *ev, const AstNode *node, Value *value);  // built-in functions of objects
    bool (*inside)(Eval *ev, const AstNode *node, Value *value);
    bool (*extent)(Eval *ev, const AstNode *node, Value *value);
    bool (*painted_create)(Eval *ev, const AstNode *block, Painted **painted, const char **unsupported);
    bool (*painted_at)(Eval *ev, Painted *painted, const double point[3], Span span, double v[5]);
    void (*plan_hooks)(Eval *ev, GrammarHooks *hooks);
    void (*plan_watch_call)(Eval *ev, const AstNode *call);
    void (*plan_turns)(Cursor *cursor);
} EvalBuilder;

typedef struct PastedText {
    uint64_t begin, end;
    const GrammarText *text; // in the program arena
} PastedText;

// The statement of a text that is evaluated next as any other item, to make a plan of it (plan_text.c).
typedef struct PlanWatch {
    uint64_t state; // changed by whatever changes what such a statement gives
    Span statement; // empty: none
    GrammarSlot *slots;
    unsigned slot_count;
    GrammarPlan *plan; // NULL: there is none yet
    bool is_known;     // it holds
} PlanWatch;

// The plan of a statement that a loop or a macro comes to again and again (loop_plan.c).
typedef struct PlanPlace {
    const AstNode *node;
    uint64_t begin, state; // where it stands; of PlanWatch
    GrammarPlan *plan;     // in the program arena
    bool is_tried, is_known;
} PlanPlace;
enum { PLAN_PLACES = 32 };

// What variables own, see values/kept.h.
enum { KEPT_CLASSES = 80 };
typedef struct KeptStore {
    KeptBlock *free[KEPT_CLASSES];
    KeptBlock *retired;       // nobody owns them any more, but somebody may see them
    struct LargeBlock *large; // in use
    size_t retired_bytes, settle_at;
    uint64_t births;          // how often something was stored
} KeptStore;

struct Eval {
    EvalOptions options;
    const EvalText *text;
    const EvalBuilder *builder;
    const GrammarContext *grammar; // what texts are parsed with
    Scene *scene;
    MemoryBudget memory; // of all arenas of the evaluation
    Arena parse;   // the AST of the current top-level item
    Arena program; // macros and everything declared, until the end
    Arena scratch; // temporaries of the current top-level item
    KeptStore kept; // texts and arrays of variables
    Scope *scope;
    ObjectState *objects;
    FileState *files;
    DataFile *data_files; // all that were opened
    WrittenFile *written_files; // likewise, for writing
    Lint *lint; // NULL when nobody asked
    Origins *origins; // NULL before a name was looked for in files that are not included
    const DiagFrame *frame; // also in options.diags->frame
    double version;
    bool version_given;           // a #version was run
    ARRAY(uint32_t) streams;      // the states of rand, by handle
    const Noise *noise;           // NULL before the first call that needs it
    ARRAY(uint64_t) reported;     // a hash table of what was reported, see report.c
    size_t reported_count;
    Span break_at; // of a #break that leaves the included file that is read, and more; else SPAN_NONE
    bool include_is_missing; // a name that is not declared may be one that it declares
    bool macro_is_missing;   // so may a macro that is not declared be one whose head was not understood
    bool file_is_missing; // an #fopen had no file: what it should have opened is not open
    TextBuffer line;              // of #debug, not ended yet
    CursorFrame *free_frames;     // for reuse, in the program arena
    uint64_t steps;
    uint64_t message_bytes; // that were passed on
    uint64_t clear_count; // shapes that some light may go through
    Span inside_out;      // a sphere of a negative radius that was not drawn for its box, or SPAN_NONE
    // As POV-Ray counts: of a union each member, unless it is one object. Spheres that were read quickly come on top.
    uint64_t object_count, slow_spheres;
    bool has_unbalanced;          // a macro that is_unbalanced was defined
    unsigned fragment_nesting;    // of fragments that are being parsed
    uint64_t steps_reported;         // at the last message that said something new
    ARRAY(struct Probe *) probes; // objects that were traced, see probe.c
    InternTable *probed;          // the address of each, by the same numbers from 1; NULL as long as there is none
    ARRAY(Painted *) painted; // functions of patterns and pigments, see painted.c
    size_t opened_bytes;      // of what tracer and painter hold for both
    enum { CHARSET_UNSAID, CHARSET_ASCII, CHARSET_UTF8, CHARSET_SYS } charset; // of strings in the text
    bool has_mark;                // which is UTF-8 unless the scene says otherwise
    ARRAY(PastedText) pasted;     // expressions that were read again, by their place
    unsigned call_depth, include_depth, expression_depth, expression_depth_limit;
    PlanWatch watch;
    PlanPlace plan_places[PLAN_PLACES];
    bool is_value_made;  // the last function or spline was written where it is used, and has no name
    unsigned scopes_within; // calls and files that began in the text of a #local and are not over: it is none of theirs
    bool takes_end;         // a `;` may end the text of what is computed: it is the value of a declaration, or its end
    bool is_value_cut;   // a directive stands behind the value in such a text
    unsigned value_ends; // how many such semicolons stand in the text of the value
    bool has_stray;      // at the top level, reported: the values after it are not reported as well
    bool lacks_brace;    // so is what follows a block's word without its brace, up to an object
    bool explains_steps; // too many steps were reported, and not yet which loop does not end
    bool faulty;         // something was reported, if only before
    bool tells_plan;     // the next statement that is read by a plan is to be noted: those after it are not
    size_t errors_before; // that were reported when the evaluation began
    unsigned inner;       // parentheses of any kind around the expression that is being computed
    unsigned initialiser; // of an array, in braces: 1 + the call_depth at which its elements are computed; 0: none
    bool at_colour;       // the value that is being computed stands where a colour word could
    bool wants_colour;    // the next value for a colour, which begins with a macro's text, is to be one by itself
    bool stop;           // a limit is exhausted, #error was met or there are too many faults: unwind
};

// A syntax fault was reported inside of a span: what is missing there may have been in what was not understood.
bool eval_follows_syntax(const Eval *ev, Span whole);
// Tells the client where a statement of the scene's own text begins.
void eval_tell_statement(Eval *ev, Span span);
// What was not read has no fault: it was left out, as a lenient evaluation does with what rtlang has not.
bool eval_leaves_out(const Eval *ev);
// Reports a fault at a span; the return value is false, so that `return eval_fault(…)` reads well. What was reported at
// the same place before is not reported again.
bool eval_fault(Eval *ev, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);
void eval_warn(Eval *ev, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);
// The same; true when the record was kept, so that diag_note and diag_suggest may add to it.
bool eval_report(Eval *ev, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);
// True the first time for this code and symbol.
bool eval_is_first(Eval *ev, DiagCode code, Symbol symbol);
// Reports exhausted memory once and sets `stop`; returns false.
bool eval_no_memory(Eval *ev, Span span);

const char *eval_text(const Eval *ev, Symbol symbol);
// Of a node that begins with its symbol, the symbol alone: `sphere` of a whole block.
Span eval_word_span(const Eval *ev, const AstNode *node);

// As arena_rewind: most of the time the mark is in the same chunk.
static inline void memory_rewind(Arena *arena, ArenaMark mark)
{
    if (RT_LIKELY(arena->chunk == mark.chunk)) {
        hidden_put(mark.next, (size_t)(arena->next - mark.next));
        arena->next = mark.next;
    } else {
        arena_rewind(arena, mark);
    }
}

static inline ArenaMark scratch_mark(const Eval *ev)
{
    return (ArenaMark){ev->scratch.chunk, ev->scratch.next};
}

static inline void scratch_rewind(Eval *ev, ArenaMark mark)
{
    memory_rewind(&ev->scratch, mark);
}

// Enter and leave what is on the call stack of messages. The frame must live until it is left.
void eval_frame_enter(Eval *ev, DiagFrame *frame, const char *what, const char *name, Span span);
void eval_frame_leave(Eval *ev);

// True when evaluation must stop: something said so before, or the client has asked for it.
bool eval_cancelled(Eval *ev);
// Counts a turn of a loop or a call; false, with `stop` set, when there were too many.
bool eval_step(Eval *ev, Span span) RT_MUST_CHECK;
// The same of a turn or call that runs through so much of the scene's text.
bool eval_turn(Eval *ev, Span text, Span span) RT_MUST_CHECK;
// Counts work on so many bytes of strings as steps that take as long; false as eval_step.
bool eval_work(Eval *ev, size_t bytes, Span span) RT_MUST_CHECK;
// Reports that evaluation nests too deeply and sets `stop`; returns false.
bool eval_too_deep(Eval *ev, Span span);

// Count levels of native recursion, `weight` each; eval_deepen is false when there are too many, and then nothing was
// counted.
RT_MUST_CHECK static inline bool eval_deepen(Eval *ev, unsigned weight, Span span)
{
    if (RT_UNLIKELY(ev->expression_depth + weight > ev->expression_depth_limit)) {
        return eval_too_deep(ev, span);
    }
    ev->expression_depth += weight;
    return true;
}

static inline void eval_shallow(Eval *ev, unsigned weight)
{
    ev->expression_depth -= weight;
}

#endif
