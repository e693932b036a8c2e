// Plans: what a statement makes of its numbers, once it is known that nothing else about it changes.
//
// A statement that comes again, in a text (grammar/template.h) or by a loop or a macro, is evaluated like any other while
// it is watched. When it gave one shape of a plain colour, and a plan made of its nodes gives the same record, the plan
// stands for it from then on. What is not as usual is refused and evaluated as before, so there is one meaning only.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_PLAN_H
#define EVAL_PLAN_H

#include "eval/build/blocks.h"

enum { PLAN_INPUTS_MOST = 16, PLAN_NUMBERS_MOST = 80, PLAN_STREAMS_MOST = 16 };

// A value that differs from time to time: one number, or as many as a vector or a colour has.
typedef struct PlanInput {
    const AstNode *node;            // the expression that gives it; NULL: numbers of slots
    const SchemaProperty *argument; // of the shape, that it is; NULL: it belongs to a word
    Symbol word;                    // of a transform, or of a colour
    uint8_t slot, width;            // of numbers: the first, and how many
    uint8_t first;                  // place in PlanNumbers
    bool is_number;
    double low, high; // all between them are as usual
} PlanInput;

typedef struct PlanNumbers {
    double items[PLAN_NUMBERS_MOST];
    uint8_t width[PLAN_INPUTS_MOST]; // of each input; a single number for a vector stands in all three
} PlanNumbers;

typedef struct PlanCall PlanCall;

struct GrammarPlan {
    SchemaKind kind;
    unsigned input_count, number_count;
    PlanInput inputs[PLAN_INPUTS_MOST];
    bool has_moves, has_colour;
    bool is_quick;     // expressions are evaluated by quick.c
    Material material; // but for a colour among the inputs
    Desc record;       // but for the arguments among them
    PlanCall *call;    // of a macro, and nothing of the above
    bool is_at_place; // a sphere that is not moved: its inputs are centre, radius and perhaps a colour
    bool is_direct;   // likewise, and all of them are as many numbers in slots
};

// The states of all random numbers.
typedef struct PlanStreams {
    size_t count;
    uint32_t states[PLAN_STREAMS_MOST];
} PlanStreams;

// What a plan makes.
typedef struct PlanMade {
    bool is_sphere;
    Vec3 centre;
    double radius;
    Primitive part; // of any other shape; its material is not set
    Material material;
} PlanMade;

// Whether statements of the kind may have one.
bool plan_is_for(SchemaKind kind);

// Makes a plan of a statement's nodes; of a text's, the numbers in its slots become inputs, and are marked as used; of a
// loop's (`slots` NULL), expressions. False: it is of another form.
bool plan_compile(Eval *ev, const AstNode *item, SchemaKind kind, GrammarSlot *slots, unsigned count, GrammarPlan *plan);

// The inputs, from the slots' numbers or by their expressions. False: one is not as usual; nothing has happened then.
// *kept: what random numbers were before.
bool plan_fetch_slots(const GrammarPlan *plan, const double *slots, PlanNumbers *numbers);
bool plan_fetch(Eval *ev, GrammarPlan *plan, PlanNumbers *numbers, PlanStreams *kept);

// Nothing is reported: false where something would have to be.
bool plan_make(const Eval *ev, const GrammarPlan *plan, const PlanNumbers *numbers, Span span, PlanMade *made);

// Adds it to the scene; false after a fault.
bool plan_add(Eval *ev, PlanMade *made, Span span);

void plan_streams_keep(const Eval *ev, PlanStreams *kept); // count > PLAN_STREAMS_MOST: they are too many
void plan_streams_take_back(Eval *ev, const PlanStreams *kept);

static inline bool plan_colour_is_usual(const double *colour, unsigned width)
{
    bool is_usual = true;
    for (unsigned i = 0; i < width; i++) {
        is_usual = is_usual && fabs(colour[i]) <= (double)COLOUR_USUAL;
    }
    return is_usual;
}

// The numbers of a colour word, as a material has them.
static inline void plan_set_colour(Material *material, Symbol word, const double *colour)
{
    material->red = (float)colour[0];
    material->green = (float)colour[1];
    material->blue = (float)colour[2];
    if (word != W_rgb) {
        material->filter = word == W_rgbt ? 0.0F : (float)colour[3];
        material->transmit = word == W_rgbf ? 0.0F : (float)colour[word == W_rgbt ? 3 : 4];
    }
}

// Of one that is_at_place.
static inline void plan_make_at_place(const GrammarPlan *plan, const PlanNumbers *numbers, PlanMade *made)
{
    // A zero is positive, as it is behind any transform.
    const double *at = numbers->items;
    made->is_sphere = true;
    made->centre = vec3(at[0] + 0.0, at[1] + 0.0, at[2] + 0.0);
    made->radius = at[3];
    made->material = plan->material;
    if (plan->has_colour) {
        plan_set_colour(&made->material, plan->inputs[2].word, at + 4);
    }
}

// That of a sphere that is_direct; false: it is not as usual.
static inline bool plan_direct(const GrammarPlan *plan, const double *slots, Vec3 *centre, double *radius,
                               Material *material)
{
    const PlanInput *inputs = plan->inputs;
    const double *at = slots + inputs[0].slot, *colour = slots + inputs[2].slot;
    // A zero is positive, as it is behind any transform.
    *centre = vec3(at[0] + 0.0, at[1] + 0.0, at[2] + 0.0);
    *radius = slots[inputs[1].slot];
    *material = plan->material;
    if (!plan->has_colour) {
        return *radius > 0.0;
    }
    plan_set_colour(material, inputs[2].word, colour);
    return *radius > 0.0 && plan_colour_is_usual(colour, inputs[2].width);
}

// One statement while it is evaluated.
typedef struct PlanTrial {
    GrammarPlan *plan; // that is being learnt; NULL: none
    GrammarSlot *slots; // of a text's statement
    unsigned slot_count;
    size_t shapes, spheres, parts, messages; // before it
    PlanStreams streams;
} PlanTrial;

// A statement is evaluated next. True: its plan, which a loop or macro has followed before, was followed, with what came
// of it in *is_fine. Else it is to be evaluated; where the trial has a plan, plan_note and plan_try are called.
bool plan_begin(Eval *ev, const AstNode *item, SchemaKind kind, PlanTrial *trial, bool *is_fine) RT_MUST_CHECK;
void plan_note(Eval *ev, PlanTrial *trial, SchemaKind kind, const Desc *record);      // what it was read to
void plan_try(Eval *ev, const PlanTrial *trial, const AstNode *item);                 // it was placed
void plans_fini(Eval *ev); // frees what a statement that did not come to its end was to be

// loop_plan.c: where a loop's or macro's statement has its plan.
PlanPlace *plan_place_of(Eval *ev, const AstNode *item);
bool plan_place_is_known(const Eval *ev, const PlanPlace *place, const AstNode *item);
bool plan_turn(Eval *ev, PlanPlace *place, const AstNode *item, bool *is_fine) RT_MUST_CHECK;
// At the end of a body of a loop that is shapes and names only: continues with its turns as long as they are known. The
// cursor then stands where it would by itself.
void plan_turns(Cursor *cursor);

// plan_text.c: what the grammar asks of plans, put to the other hooks.
void plan_hooks(Eval *ev, GrammarHooks *hooks);
// A call is evaluated next: makes a plan of it when it is the statement that is watched.
void plan_watch_call(Eval *ev, const AstNode *call);

// plan_many.c, see GrammarHooks
extern const size_t plan_record_bytes;
bool plan_prepare(const GrammarPlan *plan, const double *numbers, uint64_t begin, void *record) RT_MUST_CHECK;
bool plan_pass(void *client, size_t count) RT_MUST_CHECK;
bool plan_exchange(void *client, const GrammarRound *own, GrammarRound *all) RT_MUST_CHECK;
bool plan_keep(void *client, const void *list, size_t count, size_t more) RT_MUST_CHECK;

#endif
