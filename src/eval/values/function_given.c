// The functions that POV-Ray has built in and gives to scenes by number, as functions.inc names them.
//
// Turns `function { internal(n) }` into a function of as many numbers as POV-Ray's takes: noise, distances, and
// surfaces for isosurfaces (math/given_surface.h); others are kept as functions that are a fault where they are called.
// Owns nothing.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/values/function.h"
#include "math/given_surface.h"

enum { GIVEN_COUNT = 79 };

static double length_of(const double *p)
{
    return sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

static double run_r(const FunctionNode *node, FunctionRun *run)
{
    (void)node;
    return length_of(run->slots);
}

static double run_sphere(const FunctionNode *node, FunctionRun *run)
{
    (void)node;
    return length_of(run->slots) - run->slots[3];
}

static double run_theta(const FunctionNode *node, FunctionRun *run)
{
    (void)node;
    return atan2(run->slots[0], run->slots[2]);
}

static double run_phi(const FunctionNode *node, FunctionRun *run)
{
    (void)node;
    const double *p = run->slots;
    return atan2(sqrt(p[0] * p[0] + p[2] * p[2]), p[1]);
}

static double noise_at(FunctionRun *run, NoiseGenerator generator)
{
    const Noise *noise = eval_noise(run->ev, run->span);
    return noise ? noise_value(noise, generator, vec3(run->slots[0], run->slots[1], run->slots[2])) : 0.0;
}

static double run_noise(const FunctionNode *node, FunctionRun *run)
{
    (void)node;
    return noise_at(run, eval_noise_generator(run->ev));
}

// As measured: of the number without its fraction the two lowest bits count, and 0 is the first generator.
static double run_noise_generator(const FunctionNode *node, FunctionRun *run)
{
    (void)node;
    return noise_at(run, noise_generator((int)number_to_int(run->slots[3]) & 3));
}

static double run_surface(const FunctionNode *node, FunctionRun *run)
{
    unsigned number = (unsigned)node->number;
    const Noise *noise = given_surface_asks_noise(number) ? eval_noise(run->ev, run->span) : NULL;
    return noise || !given_surface_asks_noise(number) ? given_surface(number, noise, run->slots) : 0.0;
}

typedef struct Given {
    FunctionNodeFn run; // NULL: not supported
    unsigned parameter_count;
} Given;

bool function_given(Eval *ev, const AstNode *internal, Function *function)
{
    static const Given table[GIVEN_COUNT] = {
        [47] = {run_phi, 3},  [57] = {run_r, 3},    [61] = {run_sphere, 4},
        [69] = {run_theta, 3}, [76] = {run_noise, 3}, [78] = {run_noise_generator, 4},
    };
    const AstNode *number = internal->a;
    if (internal->count != 1 || number->kind != AST_NUMBER || number->number != floor(number->number) ||
        number->number >= GIVEN_COUNT) {
        return eval_fault(ev, DIAG_E0261, internal->span, "`internal` needs a whole number from 0 to %d",
                          GIVEN_COUNT - 1);
    }
    const Given surface = {run_surface, given_surface_arguments((unsigned)number->number)};
    const Given *given = surface.parameter_count > 0 ? &surface : &table[(unsigned)number->number];
    FunctionNode *body = arena_alloc(&ev->program, sizeof *body);
    if (body == NULL) {
        return eval_no_memory(ev, internal->span);
    }
    *body = (FunctionNode){.run = given->run, .height = 1, .slot = W_internal, .number = number->number};
    function->body = body;
    function->parameter_count = given->parameter_count;
    if (given->run == NULL) {
        function->kind = FUNCTION_UNSUPPORTED;
        function->word = "internal";
    }
    return true;
}
