// The text of a scene while it runs: names, expressions, the walk through items with directives run and macro calls
// expanded on the way, files.
//
//   items.c      the top level                      scope.c     names and what they stand for
//   expression.c AST expressions to values          quick.c     numbers that are computed at once
//   array.c      arrays and their elements          colour.c    colour phrases
//   cursor.c     items of a block                   directive.c what each directive does
//   macro.c      definitions, calls and their values
//   callable.h   functions and splines              include.c   #include
//   files.c      finding and opening files          datafile.c  #fopen, #read and #fclose
//   control.c    branches, loops and calls          paste.c     expressions with the text of macros in them
//   expansion.h  text with its directives resolved
//   lint.c       what is suspicious in the text     message.c   the text streams of #debug and the like
//   origin.c     which include file declares a name endless.c   why a loop does not end
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_RUN_RUN_H
#define EVAL_RUN_RUN_H

#include "eval/values/values.h"
#include "grammar/grammar.h"

// A macro's text lives in the program arena.
struct Macro {
    Symbol name;
    Span span;
    unsigned parameter_count;
    Symbol *parameters;
    AstNode *body;           // the definition; without items when `is_torn`
    const GrammarText *text; // the body's tokens, in the program arena; NULL until they are needed
    bool is_unbalanced;      // its braces pair up with those of other text
    bool is_torn;            // holds no whole items: its tokens are read at each call
    bool is_loose;           // may give more or less than one value, or one that operators around it may tear apart
};

// ---- the top level

// The interface of the values to the text.
extern const EvalText text_of_scene;

// One top-level item. EVAL_STREAM_DEBUG and the like go to message.c.
void eval_item(Eval *ev, const AstNode *item);
void message_write(Eval *ev, EvalStream stream, const char *text, size_t length, Span span);
// Counts bytes that are written to files among those of messages. False, with a message, when they are too many.
bool message_count_bytes(Eval *ev, size_t bytes, Span span) RT_MUST_CHECK;

// A #version said that the text knows 3.7.
bool eval_knows_37(const Eval *ev);
// A loop that ends because there were too many steps: adds to the report why it does not end by itself, where its text
// shows that (endless.c).
void endless_explain(Eval *ev, const AstNode *loop);

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

// Before the value of a #declare or #local is computed: a name that it will make is there already, without a value.
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
// Between two items of a cursor, see its `since`: gives back what values that are gone owned.
void scope_settle(Eval *ev, uint64_t since);
// Of the names in scope and the reserved words that could stand in the place of a NAME or CALL, the nearest.
Suggest scope_nearest(const Eval *ev, const AstNode *node);
// The first file of the include folders that declares a name, of NAME_MAX + 1 bytes; false when none does.
bool name_find_include(Eval *ev, const char *name, char *file);
void origins_fini(Eval *ev);
// The names of the include files that come with POV-Ray; NULL from their number on.
const char *name_standard_file(size_t i);

// ---- arrays

bool array_create(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// The element that an INDEX node means, set or not, and its array.
bool array_locate(Eval *ev, const AstNode *node, Value **element, ValueArray **array) RT_MUST_CHECK;
// Reports the use of a name whose first value is being computed; returns false.
bool name_fault_unset(Eval *ev, const AstNode *node);
// Reports that `what` of a name is not declared, once for each name; returns false.
bool name_fault_undeclared(Eval *ev, const AstNode *node, const char *what);
// Whether a NAME stands for something, or an INDEX node for an element that is set; false for any other node.
bool name_is_declared(Eval *ev, const AstNode *target);
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

// Numbers at once (quick.c): false, or 0, where the expression is to be computed the usual way. `draws`: random
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

// ---- items of a block

// Walks the items of one block. Directives are run and macro calls expanded on the way, so the user of a cursor sees
// only words, blocks, entries and expressions (an expression that is a bare identifier included).
struct Cursor {
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
    bool is_call;        // the items are those of a macro, which #break leaves
    unsigned ends;       // how many do
    ArenaMark mark;
    uint64_t since; // what was stored later nobody outside of it sees, see values/kept.h
    struct Expansion *expansion; // of the text that the innermost frames walk; NULL: they walk nodes
};

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

bool cursor_at_word(Cursor *cursor, Word word);  // peeks; not where a comma stands before it
bool cursor_at_value(Cursor *cursor);            // an expression or a colour word stands next
// Consume and evaluate; a comma before it is a fault, but where cursor_take_comma took it. `owner` is what the value belongs to, for "expected a number after `radius`".
bool cursor_value(Cursor *cursor, Value *value) RT_MUST_CHECK; // one expression
bool cursor_number(Cursor *cursor, double *number, Span *span) RT_MUST_CHECK;
bool cursor_vector3(Cursor *cursor, Vec3 *vector, Span *span) RT_MUST_CHECK;
// A whole colour phrase: `color rgb <…> filter 0.5`, `Red`, `red 1 green 0.5`, `rgb 1`, …
bool cursor_colour(Cursor *cursor, Rgbft *colour, Span *span) RT_MUST_CHECK;

// What directives do to a cursor, and macro calls.
typedef enum FrameKind {
    FRAME_ITEMS,
    FRAME_LIVE, // of a text: what the scanner of a parse gives
    FRAME_MACRO,
    FRAME_INCLUDE,
    FRAME_WHILE, // of a text: its condition and body
    FRAME_FOR,
    FRAME_BRANCH, // of a text: the branch of an #if that was chosen; no tokens of its own, like the next two
    FRAME_SWITCH,
    FRAME_LEFT, // a text at its end, under directives that began in it: keeps their places
} FrameKind;

// A #for while it runs.
typedef struct ForLoop {
    Symbol counter;
    Span span;
    double end, step;
} ForLoop;

// What a frame has that walks tokens, see expansion.h.
typedef struct FrameText {
    const Token *tokens;
    size_t count, at;
    GrammarText *owned; // freed with the frame
    Token opened_by;
    double subject;  // of a #switch
    ArenaMark begin; // of the outermost one: of the items
    unsigned place;  // 1 is the outermost one
    bool is_found;   // its case
    bool has_cases;  // at least one
    bool is_last;    // the #else of an #if: no other branch may follow
} FrameText;

// Walks nodes, or the tokens of a text.
struct CursorFrame {
    CursorFrame *outer;
    const AstNode *next; // the next item to look at
    const AstNode *node; // the loop, the call, or the case of a #switch that is walked
    FrameKind kind;
    bool ends_in_comma;  // one stands after the item that was taken last
    bool is_text;        // `text`, not `next` and `node`
    ForLoop loop;        // FRAME_FOR
    DiagFrame diag;      // FRAME_MACRO, FRAME_INCLUDE
    FrameText text;
};

// NULL when out of memory, which stops the evaluation.
CursorFrame *cursor_push(Cursor *cursor, FrameKind kind, const AstNode *items, const AstNode *node);
void cursor_pop(Cursor *cursor);
void frame_leave(Cursor *cursor, CursorFrame *frame);
void frame_free(Cursor *cursor, CursorFrame *frame); // it is on no list
// The items of a text become those of the innermost frame. `owned` (NULL or the text) is freed with it. False when out
// of memory, which stops the evaluation.
bool cursor_push_text(Cursor *cursor, CursorFrame *frame, const GrammarText *text, GrammarText *owned) RT_MUST_CHECK;
// The innermost frame (NULL: there was no memory for it) becomes that of a call; NULL after a fault, and it is gone.
CursorFrame *cursor_enter(Cursor *cursor, const AstNode *call, CursorFrame *frame, Macro *macro);
const AstNode *case_items(const AstNode *node); // of a CASE, RANGE or ELSE
bool directive_run(Cursor *cursor, const AstNode *node); // false when the node is no directive
void include_run(Cursor *cursor, const AstNode *node);
// Opens the file of an #include and enters it; the frame becomes a FRAME_INCLUDE. NULL after a fault.
Source *include_enter(Eval *ev, CursorFrame *frame, const AstNode *node) RT_MUST_CHECK;
// control.c
void control_if(Cursor *cursor, const AstNode *node); // an #ifdef, too
void control_switch(Cursor *cursor, const AstNode *node);
void control_while(Cursor *cursor, const AstNode *node);
void control_for(Cursor *cursor, const AstNode *node);
bool loop_continues(Cursor *cursor, CursorFrame *frame); // at the end of a loop's body: one more turn
// At the end of a case: the next one, which is run into; false: there is none, or its head is at fault.
bool case_continues(Eval *ev, CursorFrame *frame);
// #break; is_from_file: in a file that was included here. It leaves no macro that is called around the #include.
void control_break(Cursor *cursor, Span span, bool is_from_file);

// ---- files

typedef enum FileUse { FILE_INCLUDE, FILE_DATA, FILE_IMAGE, FILE_FONT } FileUse;

bool files_init(Eval *ev, const Source *scene) RT_MUST_CHECK;
void files_fini(Eval *ev);
// Opens the file whose name the expression gives. What is not found, outside the folders that may be read, or not
// readable is reported.
bool file_open(Eval *ev, const AstNode *name, FileUse use, Source **source) RT_MUST_CHECK;
// Folder number `i`, from 0, of those that are searched after the current one; NULL past the end.
const char *file_folder(const Eval *ev, size_t i);
// Whether there is such a file. False when it may not be asked for; that is reported.
bool file_is_there(Eval *ev, const Value *name, Span span, bool *is_there) RT_MUST_CHECK;

// Where a file of that name is to be written, all links resolved, in `real` of PATH_MAX bytes. False when it may not
// be; that is reported.
bool file_may_write(Eval *ev, const char *name, Span span, char *real) RT_MUST_CHECK;

// The path of an image file, kept as long as the names are; NULL after a fault. To a name without an ending each of a
// list that NULL ends is added in turn. `node` is the expression that gave the name; *real is the path without links.
const char *file_find(Eval *ev, const AstNode *node, const char *name, FileUse use, const char *const *endings,
                      const char **real) RT_MUST_CHECK;

// #fopen, #fclose, #read and #write
void data_file_run(Cursor *cursor, const AstNode *node);
void data_files_fini(Eval *ev);

// Makes the file whose name the expression gives, or prolongs it. False, with a message, where a scene may not write.
bool written_open(Eval *ev, const AstNode *name, bool appends, Span span, WrittenFile **written) RT_MUST_CHECK;
void written_write(Eval *ev, const AstNode *values, WrittenFile *written);
// Bytes that are lost are reported.
void written_close(Eval *ev, WrittenFile *written);
void written_files_close(Eval *ev);

// ---- macros

// `text`: the body's tokens, where they are known, else NULL.
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

// ---- text that is read with its directives resolved (expansion.h)

// What the grammar is given, ev->grammar; false when out of memory.
bool reading_init(Eval *ev) RT_MUST_CHECK;

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

// ---- what is suspicious

bool lint_init(Eval *ev) RT_MUST_CHECK; // false when out of memory
void lint_fini(Eval *ev);
// Looks at items that are about to be evaluated, when a warning of this kind is on.
void lint_items(Eval *ev, const AstNode *first);
// Some text is not seen as items, so nothing can be reported of unused names.
void lint_give_up(Eval *ev);
void lint_finish(Eval *ev); // after the last item

#endif
