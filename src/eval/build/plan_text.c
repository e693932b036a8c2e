// Plans that are learnt: a statement is watched while it is evaluated, and its plan compared with what it gave.
//
// Here, too, is what the grammar asks of plans: statements of a text are run by them, and calls of macros with numbers
// for arguments, which need no parser. Knows nothing of how templates are made and matched.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "eval/build/plan.h"
#include "eval/run/scope.h"

// A call with arguments that are numbers or vectors of numbers: its nodes, which take the next ones.
struct PlanCall {
    AstNode call;
    unsigned count;                    // of numbers
    AstNode *numbers[GRAMMAR_SLOTS_MOST];
    AstNode nodes[2 * GRAMMAR_SLOTS_MOST];
};

static Eval *eval_of(void *client)
{
    return client;
}

static size_t message_count(const Eval *ev)
{
    return ev->options.diags->error_count + ev->options.diags->warning_count;
}

static void drop(GrammarPlan *plan)
{
    if (plan) {
        free(plan->call);
        free(plan);
    }
}

// ---- shapes

static bool is_watched(const Eval *ev, const AstNode *item)
{
    const PlanWatch *watch = &ev->watch;
    return watch->statement.end > 0 && watch->statement.begin == item->span.begin &&
           watch->statement.end == item->span.end && !watch->plan;
}

// The plan of the trial is made of the item; it is none when that has another form.
static void begin_trial(Eval *ev, const AstNode *item, SchemaKind kind, PlanTrial *trial)
{
    if (!trial->plan || !plan_compile(ev, item, kind, trial->slots, trial->slot_count, trial->plan)) {
        trial->plan = NULL;
        return;
    }
    scene_end_share(ev->scene); // else the next sphere takes the place of another process's
    trial->shapes = ev->scene->shape_count;
    trial->spheres = ev->scene->spheres.count;
    trial->parts = ev->scene->primitives.count;
    trial->messages = message_count(ev);
    plan_streams_keep(ev, &trial->streams);
}

bool plan_begin(Eval *ev, const AstNode *item, SchemaKind kind, PlanTrial *trial, bool *is_fine)
{
    if (RT_UNLIKELY(is_watched(ev, item))) {
        trial->slots = ev->watch.slots;
        trial->slot_count = ev->watch.slot_count;
        trial->plan = ev->watch.plan = calloc(1, sizeof *trial->plan);
        begin_trial(ev, item, kind, trial);
        return false;
    }
    PlanPlace *place = plan_place_of(ev, item);
    if (plan_place_is_known(ev, place, item)) {
        return plan_turn(ev, place, item, is_fine);
    }
    bool is_here = place->node == item && place->begin == item->span.begin && place->state == ev->watch.state;
    if (!is_here) {
        *place = (PlanPlace){.node = item, .begin = item->span.begin, .state = ev->watch.state, .plan = place->plan};
    } else if (!place->is_tried && !ev->options.world && ev->streams.count <= PLAN_STREAMS_MOST) {
        place->is_tried = true;
        place->plan = place->plan ? place->plan : arena_alloc(&ev->program, sizeof *place->plan);
        trial->plan = place->plan;
        begin_trial(ev, item, kind, trial);
    }
    return false;
}

// Whether nothing is said of an object but its place and its texture.
void plan_note(Eval *ev, PlanTrial *trial, SchemaKind kind, const Desc *record)
{
    const ObjectPart *part = &record->part;
    const TextureDesc *texture = part->texture ? part->texture : ev->objects->defaults;
    bool is_plain = kind == trial->plan->kind && !part->is_inverse && !part->no_shadow && !part->no_image &&
                    !part->no_reflection && !part->is_double && !part->interior && !part->clips && !part->bounds &&
                    texture->ior == 0.0;
    memcpy(&trial->plan->record, record, is_plain ? schema_kind(kind)->size : 0);
    trial->plan = is_plain ? trial->plan : NULL;
}

static bool parts_equal(const Primitive *one, const Primitive *other)
{
    return one->kind == other->kind && one->flags == other->flags && one->hidden == other->hidden &&
           one->node == other->node && one->body == other->body && one->source == other->source &&
           memcmp(&one->to_world, &other->to_world, sizeof one->to_world) == 0 &&
           memcmp(&one->to_object, &other->to_object, sizeof one->to_object) == 0 &&
           memcmp(one->data, other->data, sizeof one->data) == 0;
}

// Whether the last record of the scene, the only one that the statement gave, is what the plan makes.
static bool is_made(const Scene *scene, const PlanTrial *trial, const PlanMade *made, Span span)
{
    if (!made->is_sphere) {
        return scene->primitives.count == trial->parts + 1 &&
               parts_equal(&scene->primitives.items[trial->parts], &made->part);
    }
    const Sphere *sphere = &scene->spheres.items[trial->spheres];
    return scene->spheres.count == trial->spheres + 1 && memcmp(&sphere->centre, &made->centre, sizeof made->centre) == 0 &&
           sphere->radius == made->radius && scene_sphere_source(scene, trial->spheres) == span.begin;
}

static bool take_material(const Scene *scene, const PlanTrial *trial)
{
    bool is_sphere = scene->spheres.count == trial->spheres + 1, is_part = scene->primitives.count == trial->parts + 1;
    MaterialIndex index = is_sphere ? scene->spheres.items[trial->spheres].material
                          : is_part ? scene->primitives.items[trial->parts].material
                                    : MATERIAL_COMPOUND;
    if (index & MATERIAL_COMPOUND) {
        return false;
    }
    trial->plan->material = scene->materials.items[index];
    return true;
}

// The numbers of the slots that are used, in their order.
static const double *slot_numbers(const PlanTrial *trial, double *numbers)
{
    unsigned count = 0;
    for (unsigned i = 0; i < trial->slot_count; i++) {
        numbers[count] = trial->slots[i].number;
        count += trial->slots[i].is_used;
    }
    return numbers;
}

// Once more by the plan. Random numbers are as they were then before, and must be as they are now behind it.
static bool follows(Eval *ev, const PlanTrial *trial, Span span)
{
    double slots[GRAMMAR_SLOTS_MOST + 1];
    PlanStreams now, again;
    PlanNumbers numbers;
    PlanMade made;
    Material material = trial->plan->material;
    plan_streams_keep(ev, &now);
    if (now.count != trial->streams.count) {
        return false;
    }
    plan_streams_take_back(ev, &trial->streams);
    bool is_fetched = trial->slots ? plan_fetch_slots(trial->plan, slot_numbers(trial, slots), &numbers)
                                   : plan_fetch(ev, trial->plan, &numbers, &again);
    plan_streams_keep(ev, &again);
    plan_streams_take_back(ev, &now);
    return is_fetched && memcmp(again.states, now.states, now.count * sizeof *now.states) == 0 &&
           plan_make(ev, trial->plan, &numbers, span, &made) && is_made(ev->scene, trial, &made, span) &&
           memcmp(&made.material, &material, sizeof material) == 0;
}

void plan_try(Eval *ev, const PlanTrial *trial, const AstNode *item)
{
    bool holds = !ev->stop && message_count(ev) == trial->messages && ev->scene->shape_count == trial->shapes + 1 &&
                 take_material(ev->scene, trial) && follows(ev, trial, item->span);
    if (trial->slots) {
        ev->watch.is_known = holds && message_count(ev) == trial->messages;
    } else {
        plan_place_of(ev, item)->is_known = holds;
    }
}

// ---- calls

static AstNode *add_number(PlanCall *call, AstNode *node, const GrammarSlot *slot)
{
    *node = (AstNode){.kind = AST_NUMBER, .depth = 1, .span = slot->span, .number = slot->number};
    call->numbers[call->count++] = node;
    return node;
}

// Whether the node is the number in the next slot, or that of a sign and such a number.
static bool is_slot(const AstNode *node, const GrammarSlot *slot)
{
    bool is_number = node->kind == AST_NUMBER ||
                     (node->kind == AST_UNARY && node->op == AST_OP_NEG && node->a->kind == AST_NUMBER);
    return is_number && !node->flags && node->span.begin == slot->span.begin && node->span.end == slot->span.end;
}

static bool add_argument(PlanCall *call, const AstNode *argument, AstNode **node, const GrammarSlot *slots, unsigned count)
{
    AstNode *to = (*node)++;
    const AstNode *part = argument->kind == AST_VECTOR ? argument->a : argument;
    AstNode **link = &to->a;
    if (argument->kind == AST_VECTOR) {
        *to = *argument;
        to->next = NULL;
    }
    for (; part; part = argument->kind == AST_VECTOR ? part->next : NULL) {
        if (call->count == count || !is_slot(part, &slots[call->count])) {
            return false;
        }
        AstNode *number = add_number(call, argument->kind == AST_VECTOR ? (*node)++ : to, &slots[call->count]);
        if (argument->kind == AST_VECTOR) {
            *link = number;
            link = &number->next;
        }
    }
    return !argument->flags;
}

static bool call_compile(PlanCall *plan, const AstNode *call, GrammarSlot *slots, unsigned count)
{
    AstNode *node = plan->nodes, **link = &plan->call.a;
    plan->call = *call;
    plan->call.next = plan->call.a = NULL;
    for (const AstNode *argument = call->a; argument; argument = argument->next) {
        *link = node;
        if (!add_argument(plan, argument, &node, slots, count)) {
            return false;
        }
        link = &(*link)->next;
    }
    for (unsigned i = 0; i < count; i++) {
        slots[i].is_used = true;
    }
    return plan->count == count && !call->b && !call->flags;
}

void plan_watch_call(Eval *ev, const AstNode *call)
{
    GrammarPlan *plan = is_watched(ev, call) ? calloc(1, sizeof *plan) : NULL;
    if (plan) {
        ev->watch.plan = plan;
        plan->call = calloc(1, sizeof *plan->call);
        ev->watch.is_known = plan->call && call_compile(plan->call, call, ev->watch.slots, ev->watch.slot_count);
    }
}

// What such a call means is asked each time.
static GrammarTaken run_call(Eval *ev, PlanCall *plan, const GrammarStatement *statement)
{
    const Binding *binding = scope_binding(ev, plan->call.symbol);
    const Macro *macro = binding && binding->variable->kind == VALUE_MACRO ? binding->variable->macro : NULL;
    if (!macro || macro->parameter_count != plan->call.count || macro->is_unbalanced) {
        return GRAMMAR_LEFT;
    }
    for (unsigned i = 0; i < plan->count; i++) {
        plan->numbers[i]->number = statement->numbers[i];
    }
    plan->call.span = statement->span;
    lint_items(ev, &plan->call);
    eval_item(ev, &plan->call);
    return eval_cancelled(ev) ? GRAMMAR_STOP : GRAMMAR_TAKEN;
}

// ---- what the grammar asks

void plans_fini(Eval *ev)
{
    drop(ev->watch.plan); // of a statement that did not come to its end
    ev->watch.plan = NULL;
}

static bool is_for(void *client, Symbol word)
{
    const Eval *ev = eval_of(client);
    const Binding *binding = word < WORD_COUNT ? NULL : scope_binding(ev, word);
    return word < WORD_COUNT ? plan_is_for((SchemaKind)ev->objects->kinds[word])
                             : binding && binding->variable->kind == VALUE_MACRO;
}

static void watch(void *client, Span statement, GrammarSlot *slots, unsigned count)
{
    Eval *ev = eval_of(client);
    drop(ev->watch.plan); // of a call that is not over
    ev->watch = (PlanWatch){.state = ev->watch.state, .statement = statement, .slots = slots, .slot_count = count};
}

static const GrammarPlan *learn(void *client, Span statement, bool *is_batched)
{
    Eval *ev = eval_of(client);
    PlanWatch *watched = &ev->watch;
    if (watched->statement.begin != statement.begin || watched->statement.end != statement.end) {
        return NULL;
    }
    GrammarPlan *plan = watched->is_known ? watched->plan : NULL;
    if (!plan) {
        drop(watched->plan);
    }
    *watched = (PlanWatch){.state = watched->state};
    *is_batched = plan && plan->is_direct && !plan->call;
    return plan;
}

static void drop_plan(void *client, const GrammarPlan *plan)
{
    (void)client;
    drop((GrammarPlan *)plan);
}

static GrammarTaken run(void *client, const GrammarStatement *statement)
{
    Eval *ev = eval_of(client);
    GrammarPlan *plan = (GrammarPlan *)statement->plan;
    PlanNumbers numbers;
    PlanMade made = {.is_sphere = true};
    if (ev->tells_plan || plan->call) {
        eval_tell_statement(ev, statement->span);
    }
    if (plan->call) {
        return run_call(ev, plan->call, statement);
    }
    bool is_usual = plan->is_direct
                        ? plan_direct(plan, statement->numbers, &made.centre, &made.radius, &made.material)
                        : plan_fetch_slots(plan, statement->numbers, &numbers) &&
                              plan_make(ev, plan, &numbers, statement->span, &made);
    if (!is_usual) {
        return GRAMMAR_LEFT;
    }
    ev->faulty = !plan_add(ev, &made, statement->span) || ev->faulty;
    return eval_cancelled(ev) ? GRAMMAR_STOP : GRAMMAR_TAKEN;
}

void plan_hooks(Eval *ev, GrammarHooks *hooks)
{
    hooks->plan_state = &ev->watch.state;
    hooks->plan_is_for = is_for;
    hooks->plan_watch = watch;
    hooks->plan_learn = learn;
    hooks->plan_drop = drop_plan;
    hooks->plan_run = ev->options.no_literals ? NULL : run;
    hooks->plan_record_bytes = plan_record_bytes;
    hooks->plan_prepare = plan_prepare;
    hooks->plan_keep = plan_keep;
    hooks->plan_threads = ev->options.threads;
    hooks->plan_piece = ev->options.literal_piece;
    if (ev->options.share) {
        hooks->plan_part = ev->options.share->part;
        hooks->plan_parts = ev->options.share->parts;
        hooks->plan_pass = plan_pass;
        hooks->plan_exchange = plan_exchange;
    }
}
