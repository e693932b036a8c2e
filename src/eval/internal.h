// The evaluator's inner interface, shared by the files of src/eval only.
//
//   value.c      values and conversions            scope.c     names and what they stand for
//   expression.c AST expressions to values          operators.c what operators make of them
//   builtins.c   the table of built-in functions and constants
//   array.c      arrays and their elements          strings.c   the built-in functions of strings
//   cursor.c     items of a block, with directives run and macro calls expanded on the way
//   colour.c     colour phrases                     macro.c     definitions, calls and their values
//   function.c and the others of callable.h: functions and splines
//   directive.c  what each directive does           include.c   #include
//   files.c      finding and opening files          datafile.c  #fopen, #read and #fclose
//   splice.c     the evaluator's part in splices    paste.c     expressions with the text of macros in them
//   plan.h       what statements make of the numbers that differ from time to time
//   quick.c      numbers that are worked out at once
//   lint.c       what is suspicious in the text
//   report.c     faults and warnings, once a place  message.c   the text streams of #debug and the like
//   misfit.c     what is said of items that do not fit into a block
//   block.c      a block's properties into a struct, driven by scene/schema.h
//   transforms.c, object.c, texture.c, camera.c, light.c, settings.c: what each kind of block means
//   eval.c       the top level
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_INTERNAL_H
#define EVAL_INTERNAL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "ast/ast.h"
#include "ast/words.h"
#include "base/arena.h"
#include "base/array.h"
#include "base/suggest.h"
#include "base/text.h"
#include "eval/eval.h"
#include "grammar/grammar.h"
#include "math/noise.h"
#include "math/colour.h"
#include "math/vec3.h"
#include "scene/scene.h"
#include "scene/schema.h"

// ---- values

typedef enum ValueKind {
    VALUE_NONE, // an uninitialised array element, or the result of a fault that has been reported
    VALUE_UNSET, // what a name stands for while its first value is worked out
    VALUE_NUMBER,
    VALUE_VECTOR, // 2 to 5 components
    VALUE_COLOUR, // red, green, blue, filter, transmit
    VALUE_STRING,
    VALUE_ARRAY,
    VALUE_MACRO,
    VALUE_FUNCTION,
    VALUE_SPLINE,
    VALUE_FILE,  // the name of a file that is open for #read
    VALUE_BLOCK, // a declared texture, sphere, camera, …: an immutable struct of its kind
} ValueKind;

typedef struct ValueArray ValueArray; // below
typedef struct Macro Macro;           // below
typedef struct Function Function;     // callable.h
typedef struct Spline Spline;
typedef struct DataFile DataFile;     // datafile.c

typedef struct Value {
    uint8_t kind;       // ValueKind
    uint8_t components; // of a vector
    union {
        uint16_t block; // VALUE_BLOCK: its SchemaKind
        struct {
            uint8_t kept; // so many of `v` hold what a vector had whose component this is, or began with; 0: none
            bool is_scaled : 1; // a number times a vector, see operators.c
            bool is_closed : 1; // parentheses stand around it, or around the number that a number begins with
            bool has_third : 1; // a vector of 2: v[4] is its third component where a vector of 3 is wanted
        };
    };
    Symbol name;        // the identifier it was read from, for messages; SYMBOL_NONE
    union {
        double number;
        double v[5];
        struct {
            const char *text;
            size_t length;
        };
        ValueArray *array;
        Macro *macro;
        const Function *function;
        const Spline *spline;
        DataFile *file;
        struct {
            const void *record; // of schema_kind(block)->size bytes, in the scene arena
            const struct UnsupportedDesc *lacks; // what it was read without
        };
    };
} Value;

enum { ARRAY_DIMENSIONS_MAX = 5, ARRAY_ELEMENTS_MAX = 1 << 28 };

// All elements are of one kind, that of the first one that was set.
struct ValueArray {
    unsigned dimension_count;
    uint32_t sizes[ARRAY_DIMENSIONS_MAX];
    size_t count; // the product of the sizes
    Value *elements;
    Value first; // what was set first, for its kind; VALUE_NONE: none ever was
};

// A macro's text lives in the program arena.
struct Macro {
    Symbol name;
    Span span;
    unsigned parameter_count;
    Symbol *parameters;
    AstNode *body;           // the definition; without items when `is_torn`
    const GrammarText *text; // the body's tokens, in the program arena; NULL until a splice needs them
    bool is_unbalanced;      // its braces pair up with those of other text
    bool is_torn;            // holds no whole items: read in a splice at each call
    bool is_loose;           // may give more or less than one value, or one that operators around it may tear apart
};

typedef struct PastedText {
    uint64_t begin, end;
    const GrammarText *text; // in the program arena
} PastedText;

typedef struct Scope Scope;             // scope.c
typedef struct CursorFrame CursorFrame; // cursor.c
typedef struct FileState FileState;     // files.c
typedef struct Lint Lint;               // lint.c
typedef struct ObjectState ObjectState; // object.c: default texture, scratch of the objects

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

typedef struct Eval {
    EvalOptions options;
    Scene *scene;
    MemoryBudget memory; // of all arenas of the evaluation
    Arena parse;   // the AST of the current top-level item
    Arena program; // macros and everything declared, until the end
    Arena scratch; // temporaries of the current top-level item
    Scope *scope;
    ObjectState *objects;
    FileState *files;
    DataFile *data_files; // all that were opened
    Lint *lint; // NULL when nobody asked
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
    unsigned splice_nesting;      // of fragments that are being parsed
    uint64_t steps_reported;         // at the last message that said something new
    ARRAY(struct Probe *) probes; // objects that were traced, see probe.c
    ARRAY(struct Painted *) painted; // functions of patterns and pigments, see painted.c
    size_t painted_bytes;         // of their pictures
    enum { CHARSET_UNSAID, CHARSET_ASCII, CHARSET_UTF8, CHARSET_SYS } charset; // of strings in the text
    bool has_mark;                // which is UTF-8 unless the scene says otherwise
    ARRAY(PastedText) pasted;     // expressions that were read again, by their place
    unsigned call_depth, include_depth, expression_depth, expression_depth_limit;
    PlanWatch watch;
    PlanPlace plan_places[PLAN_PLACES];
    bool is_value_made;  // the last function or spline was written where it is used, and has no name
    unsigned scopes_within; // calls and files that began in the text of a #local and are not over: it is none of theirs
    bool takes_end;      // a `;` may end the text of what is worked out: it is the value of a declaration, or its end
    bool is_value_cut;   // a directive stands behind the value in such a text
    unsigned value_ends; // how many such semicolons stand in the text of the value
    bool has_stray;      // at the top level, reported: the values after it are not reported as well
    bool lacks_brace;    // so is what follows a block's word without its brace, up to an object
    bool explains_steps; // too many steps were reported, and not yet which loop does not end
    bool tells_plan;     // the next statement that is read by a plan is to be told: those after it are not
    bool faulty;         // something was reported, if only before
    size_t errors_before; // that were reported when the evaluation began
    unsigned inner;      // parentheses of any kind around the expression that is being worked out
    unsigned initialiser; // of an array, in braces: 1 + the call_depth at which its elements are worked out; 0: none
    bool at_colour;      // the value that is being worked out stands where a colour word could
    bool stop;           // a limit is exhausted, #error was met or there are too many faults: unwind
} Eval;

// Reports a fault at a span; the return value is false, so that `return eval_fault(…)` reads well. What was reported at
// the same place before is not reported again.
// Tells the client where a statement of the scene's own text begins.
void eval_tell_statement(Eval *ev, Span span);
// What was not read has no fault: it was left out, as a lenient evaluation does with what rtlang has not.
bool eval_leaves_out(const Eval *ev);
// A syntax fault was reported inside of a span: what is missing there may have been in what was not understood.
bool eval_follows_syntax(const Eval *ev, Span whole);
bool eval_fault(Eval *ev, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);
void eval_warn(Eval *ev, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);
// The same; true when the record was kept, so that diag_note and diag_suggest may add to it.
bool eval_report(Eval *ev, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);
// True the first time for this code and symbol.
bool eval_is_first(Eval *ev, DiagCode code, Symbol symbol);
// Whether a word of the language begins a block, supported or not.
bool object_takes_braces(const Eval *ev, Symbol word);
// A loop that ends because there were too many steps: adds to the report why it does not end by itself, where its text
// shows that (endless.c).
void endless_explain(Eval *ev, const AstNode *loop);
// Reports exhausted memory once and sets `stop`; returns false.
bool eval_no_memory(Eval *ev, Span span);

// The tables of noise, made by the first call; NULL when a fault was reported.
const Noise *eval_noise(Eval *ev, Span span);
// That of the scene's settings so far.
NoiseGenerator eval_noise_generator(const Eval *ev);
const char *eval_text(const Eval *ev, Symbol symbol);
// Of a node that begins with its symbol, the symbol alone: `sphere` of a whole block.
Span eval_word_span(const Eval *ev, const AstNode *node);

// As arena_rewind: most of the time the mark is in the same chunk.
static inline void memory_rewind(Arena *arena, ArenaMark mark)
{
    if (RT_LIKELY(arena->chunk == mark.chunk)) {
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

// One top-level item. EVAL_STREAM_DEBUG and the like go to message.c.
void eval_item(Eval *ev, const AstNode *item);
void message_write(Eval *ev, EvalStream stream, const char *text, size_t length, Span span);

// "a number", "a vector of 3", "a colour", "a string", "an array", "a macro", "a texture"
const char *value_describe(const Value *value);

// Conversions with the language's promotions; on failure they report "expected …, found …" at the span. A value of
// VALUE_NONE has been reported already and fails quietly.
bool value_number(Eval *ev, const Value *value, Span span, double *number) RT_MUST_CHECK;
// The components, and behind them what a vector leaves there that the expression began with, then 0; how many.
unsigned value_components(const Value *value, double v[5]);
bool value_vector3(Eval *ev, const Value *value, Span span, Vec3 *vector) RT_MUST_CHECK;
bool value_colour(Eval *ev, const Value *value, Span span, Rgbft *colour) RT_MUST_CHECK;
bool value_string(Eval *ev, const Value *value, Span span) RT_MUST_CHECK;
bool value_array(Eval *ev, const Value *value, Span span) RT_MUST_CHECK;

static inline Value value_of_number(double number)
{
    return (Value){.kind = VALUE_NUMBER, .number = number};
}

static inline void value_set_number(Value *value, double number)
{
    value->kind = VALUE_NUMBER;
    value->components = 0;
    value->block = 0;
    value->name = SYMBOL_NONE;
    value->number = number;
}

static inline bool value_is_tuple(const Value *value)
{
    return value->kind == VALUE_VECTOR || value->kind == VALUE_COLOUR;
}

// A copy that lives as long as the arena: colours in single precision, texts and arrays copied.
bool value_store(Eval *ev, const Value *value, Arena *arena, Span span, Value *copy) RT_MUST_CHECK;

// ---- names

bool scope_init(Eval *ev) RT_MUST_CHECK;
void scope_fini(Eval *ev);

// A level of local names, for a macro call or an included file.
bool scope_push(Eval *ev, Span span) RT_MUST_CHECK;
void scope_pop(Eval *ev);

// What a name stands for, looking from the innermost level outwards, or NULL.
Value *scope_find(const Eval *ev, Symbol name);

// How many global names the scene has declared, and looked for nowhere.
EvalNames scope_count(const Eval *ev);

// #declare changes what the name stands for, or makes a global; #local makes or changes a name of the innermost level.
bool scope_declare(Eval *ev, Symbol name, bool local, const Value *value, Span span) RT_MUST_CHECK;

// Before the value of a #declare or #local is worked out: a name that it will make is there already, without a value.
bool scope_declare_begin(Eval *ev, Symbol name, bool local, Span span) RT_MUST_CHECK;
// Whether the name is to be made, and would hide another or none.
bool scope_is_new(const Eval *ev, Symbol name, bool local);

// Names of the innermost level: a parameter by value, and one that stands for a variable of the caller. `array` is the
// array of which the variable is an element, or NULL.
bool scope_bind_value(Eval *ev, Symbol name, const Value *value, Span span) RT_MUST_CHECK;
bool scope_bind_reference(Eval *ev, Symbol name, Value *variable, ValueArray *array, Span span) RT_MUST_CHECK;
// The array of which a parameter by reference is an element, or NULL.
ValueArray *scope_array(const Eval *ev, Symbol name);
bool scope_is_reference(const Eval *ev, Symbol name);

bool scope_define_macro(Eval *ev, Macro *macro) RT_MUST_CHECK;
bool scope_undef(Eval *ev, Symbol name); // false when it was not declared
// Of the names in scope and the reserved words that could stand in the place of a NAME or CALL, the nearest.
Suggest scope_nearest(const Eval *ev, const AstNode *node);
// The first file of the include folders that declares a name, of NAME_MAX + 1 bytes; false when none does.
bool name_find_include(const Eval *ev, const char *name, char *file);
// The names of the include files that come with POV-Ray; NULL from their number on.
const char *name_standard_file(size_t i);

// ---- arrays

bool array_create(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// The element that an INDEX node means, set or not, and its array.
bool array_locate(Eval *ev, const AstNode *node, Value **element, ValueArray **array) RT_MUST_CHECK;
// Reports the use of a name whose first value is being worked out; returns false.
bool name_fault_unset(Eval *ev, const AstNode *node);
// Reports that `what` of a name is not declared, once for each name; returns false.
bool name_fault_undeclared(Eval *ev, const AstNode *node, const char *what);
// Whether a NAME stands for something, or an INDEX node for an element that is set; false for any other node.
bool name_is_declared(Eval *ev, const AstNode *target);
bool array_takes(Eval *ev, const ValueArray *array, const Value *element, const Value *value, Span span) RT_MUST_CHECK;
bool array_assign(Eval *ev, ValueArray *array, Value *element, const Value *value, Span span) RT_MUST_CHECK;

// ---- expressions

bool eval_expression(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// Any right-hand side: an expression, a SEQUENCE (colour phrase, texture layers), a block, an array, a function.
bool eval_rvalue(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// A right-hand side with no parentheses of its own around it, see ev->inner.
bool eval_open_rvalue(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool eval_number(Eval *ev, const AstNode *node, double *number) RT_MUST_CHECK;
bool eval_vector3(Eval *ev, const AstNode *node, Vec3 *vector) RT_MUST_CHECK;
bool eval_string(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// A condition of a directive.
bool eval_condition(Eval *ev, const AstNode *node, bool *holds) RT_MUST_CHECK;

// Numbers at once (quick.c): false, or 0, where the expression is to be worked out the usual way. `draws`: random
// numbers may be drawn, which the caller takes back after that; else nothing has happened.
bool quick_number_of(Eval *ev, const AstNode *node, bool draws, double *number) RT_MUST_CHECK;
// A vector of three: 3; or a number, which then stands in all three: 1.
unsigned quick_three_of(Eval *ev, const AstNode *node, bool draws, double *three) RT_MUST_CHECK;

// What nests deeply, or where nesting may count, goes the usual way, as does all without literals.
enum { QUICK_DEEPEST = 12 };
static inline bool quick_is_flat(const AstNode *node)
{
    return node->depth <= QUICK_DEEPEST;
}

static inline bool quick_has_room(const Eval *ev)
{
    return ev->expression_depth + 2 * QUICK_DEEPEST <= ev->expression_depth_limit && !ev->options.no_literals;
}

RT_MUST_CHECK static inline bool quick_number(Eval *ev, const AstNode *node, double *number)
{
    return quick_is_flat(node) && quick_has_room(ev) && quick_number_of(ev, node, false, number);
}

// The nodes of operators.
bool operator_unary(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool operator_binary(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool operator_conditional(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;

// As the language compares: numbers that differ by 1e-10 or less are equal, and such a number is false.
bool numbers_equal(double one, double other);
// A #case of a #switch: the same, but for what is infinite or not a number, which no case holds for.
bool number_is_case(double subject, double number);
// The whole number that an index or a size of an array means, as measured: whatever is less than 1e-10 below one is that
// one. Not a number, and what is out of range, stays so.
static inline double number_index(double number)
{
    return floor(number + 1e-10);
}
// A #version said that the text knows 3.7.
bool eval_knows_37(const Eval *ev);
bool number_is_true(double number);

// Warns when a result is not finite; called where all that it is made of is.
void number_fault(Eval *ev, double number, Span span);
static inline void number_check(Eval *ev, double number, Span span)
{
    if (RT_UNLIKELY(!(number - number == 0.0))) {
        number_fault(ev, number, span);
    }
}

#define NUMBER_PI 3.14159265358979323846
enum { EPOCH_2000 = 946684800 };     // seconds from 1970 to the first moment of the year 2000, universal time
double number_to_int(double number); // as a C conversion to int does it on x86: what does not fit is the least int
double number_degrees(double radians);
double number_radians(double degrees);
double number_gray(const double v[3]);

// The place of a component in a tuple of `width` components, COMPONENT_GRAY for `gray`; false when it has none.
enum { COMPONENT_GRAY = 5, COMPONENT_HEIGHT = 6 }; // the last one: `hf`, in the body of a function
bool value_component(Symbol name, unsigned width, unsigned *component);

// ---- the initialisers of arrays (array.c)

// In the initialiser of an array, where no directive and no macro call may stand but inside an expression: reports one.
bool initialiser_fault(Eval *ev, Span span);
static inline bool is_in_initialiser(const Eval *ev)
{
    return RT_UNLIKELY(ev->initialiser != 0) && ev->initialiser == ev->call_depth + 1;
}
// Whether the text of a directive or macro begins the expression.
bool begins_with_call(const Eval *ev, const AstNode *node);

// ---- functions and splines

// True when a CALL is one of a function, a spline or an element of an array, and not of a macro.
bool call_is_value(const Eval *ev, const AstNode *call);
bool call_value(Eval *ev, const AstNode *call, Value *value) RT_MUST_CHECK;
bool function_create(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool spline_create(Eval *ev, const AstNode *block, Value *value) RT_MUST_CHECK;

// The function of a word that takes one number and has a value at each; NULL: it is none.
typedef double (*NumberFn)(double number);
NumberFn builtin_of_number(Symbol word);
// The generator of POV-Ray, as measured: state' = state * 1812433253 + 12345 modulo 2^32, value = state' / (2^32 - 1).
static inline double random_next(uint32_t *state)
{
    *state = *state * 1812433253u + 12345u;
    return *state / 4294967295.0;
}

bool builtin_call(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_constant(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// min_extent and max_extent, see extent.c.
bool builtin_extent(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// Functions of strings, entries of the table in builtins.c.
typedef bool (*BuiltinFn)(Eval *ev, const AstNode *node, Value *value);
bool builtin_str(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_vstr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_concat(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_chr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_asc(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_val(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strlen(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strcmp(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_substr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strupr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strlwr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_datetime(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;

// ---- items of a block

// Walks the items of one block. Directives are run and macro calls expanded on the way, so the user of a cursor sees
// only words, blocks, entries and expressions (an expression that is a bare identifier included).
typedef struct Cursor {
    Eval *ev;
    CursorFrame *frame; // what is being walked, innermost first; NULL at the end
    const AstNode *item; // the item that cursor_peek found; NULL when none is pending
    Span span;           // of the block, for messages
    bool top;            // walks the top level: included text is handed on item by item, and not kept
    bool after_value;    // the last item was an expression
    bool at_call;        // since then the text of a macro began
    bool has_comma;      // one stands before the item that is pending, or before the end
    bool included;       // text was included on the way, and stands in the parse arena since `mark`
    bool counted;        // in expression_depth
    bool is_lossy;       // a call was at fault: what is missing may have been its text
    bool is_cut;         // a directive stands before the item that is pending, or before the end
    bool takes_end;      // a `;` may stand after the last item
    unsigned ends;       // how many do
    ArenaMark mark;
} Cursor;

void cursor_open(Cursor *cursor, Eval *ev, const AstNode *items, Span span);
void cursor_close(Cursor *cursor); // unwinds scopes of macro calls that were not walked to their end

// cursor_peek gives the next item, not consumed; NULL at the end of the block or when evaluation must stop.
// The same when none is pending: on to the next one, with directives run and calls expanded on the way.
const AstNode *cursor_advance(Cursor *cursor);

static inline const AstNode *cursor_peek(Cursor *cursor)
{
    return cursor->item == NULL ? cursor_advance(cursor) : cursor->ev->stop ? NULL : cursor->item;
}

// Consumes the item that cursor_peek returned.
void cursor_skip(Cursor *cursor);

// The last character of the block, where something is missing or too much.
Span cursor_end(const Cursor *cursor);

// Peeks: a comma may stand here, or none may, which is a fault.
void cursor_take_comma(Cursor *cursor);
bool cursor_lacks_comma(Cursor *cursor, const char *where);

bool cursor_at_word(Cursor *cursor, Word word);  // peeks
bool cursor_at_value(Cursor *cursor);            // an expression or a colour word stands next
// Consume and evaluate. `owner` is what the value belongs to, for "expected a number after `radius`".
bool cursor_value(Cursor *cursor, Value *value) RT_MUST_CHECK; // one expression
bool cursor_number(Cursor *cursor, double *number, Span *span) RT_MUST_CHECK;
bool cursor_vector3(Cursor *cursor, Vec3 *vector, Span *span) RT_MUST_CHECK;
// A whole colour phrase: `color rgb <…> filter 0.5`, `Red`, `red 1 green 0.5`, `rgb 1`, …
bool cursor_colour(Cursor *cursor, Rgbft *colour, Span *span) RT_MUST_CHECK;

// What directives do to a cursor, and macro calls.
typedef enum FrameKind { FRAME_ITEMS, FRAME_WHILE, FRAME_FOR, FRAME_SWITCH, FRAME_MACRO, FRAME_INCLUDE } FrameKind;

struct CursorFrame {
    CursorFrame *outer;
    const AstNode *next; // the next item to look at
    const AstNode *node; // the loop, the call, or the case of a #switch that is walked
    FrameKind kind;
    GrammarLoop loop;    // FRAME_FOR
    DiagFrame diag;      // FRAME_MACRO, FRAME_INCLUDE
    struct SpliceStream *stream; // items that are read in a splice, on demand; NULL: `next`
    bool ends_in_comma;  // one stands after the item that was taken last
};

// NULL when out of memory, which stops the evaluation.
CursorFrame *cursor_push(Cursor *cursor, FrameKind kind, const AstNode *items, const AstNode *node);
void cursor_pop(Cursor *cursor);
// Pushes the items of a text that is read in a splice. False when out of memory, which stops the evaluation.
bool cursor_push_text(Cursor *cursor, CursorFrame *frame, const GrammarText *text, GrammarText *owned,
                      bool is_call) RT_MUST_CHECK;
// #break; is_from_file: in a file that was included here. It leaves no macro that is called around the #include.
void cursor_break(Cursor *cursor, Span span, bool is_from_file);
const AstNode *case_items(const AstNode *node); // of a CASE, RANGE or ELSE
bool directive_run(Cursor *cursor, const AstNode *node); // false when the node is no directive
bool loop_continues(Eval *ev, CursorFrame *frame); // at the end of a loop's body: one more turn
void include_run(Cursor *cursor, const AstNode *node);
// Opens the file of an #include and enters it; the frame becomes a FRAME_INCLUDE. NULL after a fault.
Source *include_enter(Eval *ev, CursorFrame *frame, const AstNode *node) RT_MUST_CHECK;
// For splices: what a directive asks, and the turns of a #for.
bool directive_decide(Eval *ev, const AstNode *node, double *subject, bool *holds) RT_MUST_CHECK;
bool directive_begin_for(Eval *ev, const AstNode *node, GrammarLoop *loop, bool *holds) RT_MUST_CHECK;
bool directive_next_for(Eval *ev, const GrammarLoop *loop, bool *holds) RT_MUST_CHECK;

// ---- files

typedef enum FileUse { FILE_INCLUDE, FILE_DATA, FILE_IMAGE } FileUse;

bool files_init(Eval *ev, const Source *scene) RT_MUST_CHECK;
void files_fini(Eval *ev);
// Opens the file whose name the expression gives. What is not found, outside the folders that may be read, or not
// readable is reported.
bool file_open(Eval *ev, const AstNode *name, FileUse use, Source **source) RT_MUST_CHECK;
// Folder number `i`, from 0, of those that are searched after the current one; NULL past the end.
const char *file_folder(const Eval *ev, size_t i);
// Whether there is such a file. False when it may not be asked for; that is reported.
bool file_is_there(Eval *ev, const Value *name, Span span, bool *is_there) RT_MUST_CHECK;

// The path of an image file, kept as long as the names are; NULL after a fault. To a name without an ending each of a
// list that NULL ends is added in turn. `node` is the expression that gave the name.
const char *file_find(Eval *ev, const AstNode *node, const char *name, const char *const *endings) RT_MUST_CHECK;

// #fopen, #fclose, #read and #write
void data_file_run(Cursor *cursor, const AstNode *node);
void data_files_fini(Eval *ev);

// ---- macros

// `text`: the body's, when it was read in a splice, else NULL.
void macro_define(Eval *ev, const AstNode *node, const GrammarText *text);
// The tokens of a macro's body; NULL after a fault.
const GrammarText *macro_text(Eval *ev, Macro *macro) RT_MUST_CHECK;
// Begins a call: a new level of names with the parameters in it. macro_leave ends it.
bool macro_enter(Eval *ev, const AstNode *call, Macro *macro, DiagFrame *frame) RT_MUST_CHECK;
void macro_leave(Eval *ev);
// The macro that a CALL node means.
bool macro_find(Eval *ev, const AstNode *call, Macro **macro) RT_MUST_CHECK;
// The value of a call. `whole`: any right-hand side will do; else an expression.
bool macro_value(Eval *ev, const AstNode *call, bool whole, Value *value) RT_MUST_CHECK;
// The value that a directive in the place of an expression gives.
bool inline_value(Eval *ev, const AstNode *node, bool whole, Value *value) RT_MUST_CHECK;

// ---- splices: text that is read again with its directives resolved (splice.c)

// What grammar needs to parse one text; a splice of it keeps its calls and files in the cursor.
typedef struct Splice {
    GrammarContext context;
    GrammarHooks hooks;
    Cursor cursor;
} Splice;

typedef struct SpliceStream SpliceStream;

void splice_init(Splice *splice, Eval *ev);
void splice_fini(Splice *splice);

// What the grammar asks of plans (plan_text.c), put to the other hooks.
void plan_hooks(Eval *ev, GrammarHooks *hooks);
// A call is evaluated next: makes a plan of it when it is the statement that is watched.
void plan_watch_call(Eval *ev, const AstNode *call);

// Items of a text, on demand, of the top level or not. `owned` (NULL or the text) is freed with it. NULL when out of memory.
SpliceStream *splice_stream_open(Eval *ev, const GrammarText *text, GrammarText *owned, bool top,
                                 bool is_call) RT_MUST_CHECK;
const AstNode *splice_stream_next(SpliceStream *stream, bool top) RT_MUST_CHECK;
bool splice_stream_is_cut(const SpliceStream *stream);
bool splice_stream_ends_in_comma(const SpliceStream *stream);
void splice_stream_close(SpliceStream *stream);

// True when a macro called in the expression may need its text to be pasted, not its value.
bool paste_is_needed(const Eval *ev, const AstNode *node);
// The value of an expression that is read again, with the text of its macros in it.
bool paste_value(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// Whether directives or macro calls stand in a function; then its value is made of its text, read again with them
// resolved.
bool paste_is_needed_in_function(const Eval *ev, const AstNode *function);
bool paste_function(Eval *ev, const AstNode *function, Value *value) RT_MUST_CHECK;
// The same for the arguments of a call: a CALL node in the parse arena, or NULL after a fault.
const AstNode *paste_arguments(Eval *ev, const AstNode *call) RT_MUST_CHECK;

// ---- blocks

// Evaluates `word { items }` to a record in the program arena (block.c and the files of the kinds).
bool eval_block(Eval *ev, const AstNode *block, Value *value) RT_MUST_CHECK;
// Layers: texture{} texture{}.
bool eval_texture_layers(Eval *ev, const AstNode *first, Value *value) RT_MUST_CHECK;
// One more, over `layers`; VALUE_NONE: there are none yet.
bool eval_texture_layer(Eval *ev, const AstNode *node, Value *layers) RT_MUST_CHECK;
// A block, or an identifier of an object, as a statement: adds it to the scene.
bool eval_place(Eval *ev, const AstNode *item) RT_MUST_CHECK;
// #default { items }
bool eval_default(Eval *ev, const AstNode *directive) RT_MUST_CHECK;

// ---- what is suspicious

bool lint_init(Eval *ev) RT_MUST_CHECK; // false when out of memory
void lint_fini(Eval *ev);
// Looks at items that are about to be evaluated, when a warning of this kind is on.
void lint_items(Eval *ev, const AstNode *first);
// Some text is not seen as items, so nothing can be told of unused names.
void lint_give_up(Eval *ev);
void lint_finish(Eval *ev); // after the last item

bool objects_init(Eval *ev) RT_MUST_CHECK;
// When the whole scene is read: places what only the last one of counts.
bool objects_finish(Eval *ev) RT_MUST_CHECK;
void objects_fini(Eval *ev);

// The transform around the whole scene, and the factor of lengths that no transform changes.
Transform world_transform(const Eval *ev);
double world_scale(const Eval *ev);

#endif
