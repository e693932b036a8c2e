// The table of built-in functions and constants.
//
// A function of one number is an entry with its C function; any other is an entry with an evaluator of the call. Adding
// one is a line. Functions of strings are in strings.c. Knows nothing of blocks.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <time.h>

#include "base/number.h"
#include "eval/values/values.h"
#include "math/transform.h"

static bool give_number(Value *value, double number)
{
    *value = value_of_number(number);
    return true;
}

// `is_checked`: the arguments are finite, so the result should be.
static bool give_result(Eval *ev, const AstNode *node, Value *value, double number, bool is_checked)
{
    if (is_checked) {
        number_check(ev, number, node->span);
    }
    return give_number(value, number);
}

static bool give_vector(Value *value, Vec3 vector)
{
    *value = (Value){.kind = VALUE_VECTOR, .components = 3, .v = {vector.x, vector.y, vector.z}};
    return true;
}

// The first arguments of a call as numbers. All are computed, so that each has its message.
static bool numbers(Eval *ev, const AstNode *node, double *out, unsigned count)
{
    bool fine = true;
    const AstNode *argument = node->a;
    for (unsigned i = 0; i < count && argument != NULL; i++, argument = argument->next) {
        out[i] = 0.0;
        fine = ask_number(ev, argument, &out[i]) && fine;
    }
    return fine;
}

static bool vectors(Eval *ev, const AstNode *node, Vec3 *out, unsigned count)
{
    bool fine = true;
    const AstNode *argument = node->a;
    for (unsigned i = 0; i < count && argument != NULL; i++, argument = argument->next) {
        fine = ask_vector3(ev, argument, &out[i]) && fine;
    }
    return fine;
}

static bool fault_domain(Eval *ev, const AstNode *node, double argument)
{
    return eval_fault(ev, DIAG_E0302, node->span, "`%s` has no value at %g", eval_text(ev, node->symbol), argument);
}

// ---- functions of numbers

static bool positive_only(Eval *ev, const AstNode *node, Value *value)
{
    double a;
    if (!numbers(ev, node, &a, 1)) {
        return false;
    }
    if (a < 0.0 || (a == 0.0 && node->symbol != W_sqrt)) {
        return fault_domain(ev, node, a);
    }
    return give_number(value, node->symbol == W_sqrt ? sqrt(a) : node->symbol == W_ln ? log(a) : log10(a));
}

static bool inverse_sine(Eval *ev, const AstNode *node, Value *value)
{
    double a;
    if (!numbers(ev, node, &a, 1)) {
        return false;
    }
    if (fabs(a) > 1.0) {
        eval_warn(ev, DIAG_W0302, node->span, "`%s` is asked for %g, and answers for %g", eval_text(ev, node->symbol),
                  a, copysign(1.0, a));
        a = copysign(1.0, a);
    }
    return give_number(value, node->symbol == W_asin ? asin(a) : acos(a));
}

static bool two_numbers(Eval *ev, const AstNode *node, Value *value)
{
    double a[2];
    if (!numbers(ev, node, a, 2)) {
        return false;
    }
    bool is_finite = isfinite(a[0]) && isfinite(a[1]);
    switch (node->symbol) {
    case W_atan2:
        return !number_is_true(a[0]) && !number_is_true(a[1]) ? fault_domain(ev, node, 0.0) : give_number(value, atan2(a[0], a[1]));
    case W_pow:
        return a[0] == 0.0 && a[1] == 0.0 ? fault_domain(ev, node, 0.0)
                                            : give_result(ev, node, value, pow(a[0], a[1]), is_finite);
    case W_mod: return give_result(ev, node, value, fmod(a[0], a[1]), is_finite);
    default: return give_number(value, number_to_int(a[0] / a[1])); // div
    }
}

// Those of any number of numbers take no blank for a comma.
static bool next_of_many(Eval *ev, const AstNode *call, const AstNode *argument, double *number)
{
    *number = 0.0;
    if (argument->flags & AST_WITHOUT_COMMA) {
        return eval_fault(ev, DIAG_E0203, argument->span, "a comma is missing before this argument of `%s`",
                          eval_text(ev, call->symbol));
    }
    return ask_number(ev, argument, number);
}

static bool least_or_greatest(Eval *ev, const AstNode *node, Value *value)
{
    double best = 0.0;
    bool fine = true, is_max = node->symbol == W_max;
    for (const AstNode *argument = node->a; argument != NULL; argument = argument->next) {
        double number;
        fine = next_of_many(ev, node, argument, &number) && fine;
        bool is_better = argument == node->a || (is_max ? number > best : number < best);
        best = is_better ? number : best;
    }
    return fine && give_number(value, best);
}

static bool bitwise(Eval *ev, const AstNode *node, Value *value)
{
    int32_t bits = 0;
    bool fine = true;
    for (const AstNode *argument = node->a; argument != NULL; argument = argument->next) {
        double number;
        fine = next_of_many(ev, node, argument, &number) && fine;
        int32_t next = (int32_t)number_to_int(number);
        bits = argument == node->a ? next
               : node->symbol == W_bitwise_and ? bits & next
               : node->symbol == W_bitwise_or  ? bits | next
                                               : bits ^ next;
    }
    return fine && give_number(value, bits);
}

static bool select_by_sign(Eval *ev, const AstNode *node, Value *value)
{
    double a[4] = {0};
    if (!numbers(ev, node, a, node->count)) {
        return false;
    }
    double not_negative = node->count == 3 || a[0] == 0.0 ? a[2] : a[3];
    return give_number(value, a[0] < 0.0 ? a[1] : not_negative);
}

// ---- random numbers

static bool new_stream(Eval *ev, const AstNode *node, Value *value)
{
    double seed;
    if (!numbers(ev, node, &seed, 1)) {
        return false;
    }
    if (!ARRAY_PUSH(&ev->streams, (uint32_t)(int32_t)number_to_int(seed))) {
        return eval_no_memory(ev, node->span);
    }
    return give_number(value, (double)(ev->streams.count - 1));
}

static bool next_random(Eval *ev, const AstNode *node, Value *value)
{
    double handle;
    if (!numbers(ev, node, &handle, 1)) {
        return false;
    }
    if (!(handle > -1.0 && handle < (double)ev->streams.count)) {
        return eval_fault(ev, DIAG_E0303, node->a->span, "`rand` needs what `seed` gave, and %g is not that", handle);
    }
    return give_number(value, random_next(&ev->streams.items[(size_t)fmax(handle, 0.0)]));
}

// ---- noise

const Noise *eval_noise(Eval *ev, Span span)
{
    if (ev->noise == NULL) {
        Noise *noise = arena_alloc(&ev->program, sizeof *noise);
        if (noise == NULL) {
            eval_no_memory(ev, span);
            return NULL;
        }
        noise_init(noise, NULL);
        ev->noise = noise;
    }
    return ev->noise;
}

NoiseGenerator eval_noise_generator(const Eval *ev)
{
    int said = ev->scene->settings.noise_generator;
    return said != 0 ? noise_generator(said) : ev->version < 3.5 ? NOISE_ORIGINAL : NOISE_CORRECTED;
}

// vturbulence(lambda, omega, octaves, point)
static bool vector_turbulence(Eval *ev, const AstNode *node, Value *value)
{
    double a[3];
    Vec3 point;
    if (!numbers(ev, node, a, 3) || !ask_vector3(ev, node->a->next->next->next, &point)) {
        return false;
    }
    const Noise *noise = eval_noise(ev, node->span);
    // As measured: in single precision, as where textures have them.
    Octaves octaves = {number_single(a[0]), number_single(a[1]), (unsigned)fmin(fmax(a[2], 1.0), 10.0)};
    return noise && give_vector(value, noise_vector_sum(noise, &octaves, point));
}

// ---- functions of vectors

static bool vector_number(Eval *ev, const AstNode *node, Value *value)
{
    Vec3 a[2];
    if (!vectors(ev, node, a, node->count)) {
        return false;
    }
    return give_number(value, node->symbol == W_vlength ? vec3_length(a[0]) : vec3_dot(a[0], a[1]));
}

// With the sine of 180 degrees that is not quite 0, as the function gives it and transforms do not.
static Transform rotation_as_povray(Vec3 degrees)
{
    Vec3 r = vec3(number_radians(degrees.x), number_radians(degrees.y), number_radians(degrees.z));
    Transform about_x = {{{1, 0, 0}, {0, cos(r.x), sin(r.x)}, {0, -sin(r.x), cos(r.x)}}};
    Transform about_y = {{{cos(r.y), 0, -sin(r.y)}, {0, 1, 0}, {sin(r.y), 0, cos(r.y)}}};
    Transform about_z = {{{cos(r.z), sin(r.z), 0}, {-sin(r.z), cos(r.z), 0}, {0, 0, 1}}};
    return transform_compose(transform_compose(about_x, about_y), about_z);
}

static bool vector_vector(Eval *ev, const AstNode *node, Value *value)
{
    Vec3 a[2];
    if (!vectors(ev, node, a, node->count)) {
        return false;
    }
    if (node->symbol == W_vcross) {
        return give_vector(value, vec3_cross(a[0], a[1]));
    }
    if (node->symbol == W_vrotate) {
        Transform rotation = rotation_as_povray(a[1]);
        return give_vector(value, transform_point(&rotation, a[0])); // whose sums have no negative zero, as POV-Ray's
    }
    double length = vec3_length(a[0]);
    if (length == 0.0) {
        eval_warn(ev, DIAG_W0303, node->span, "a vector of length zero has no direction; it stays zero");
        return give_vector(value, a[0]);
    }
    return give_vector(value, vec3_scale(1.0 / length, a[0]));
}

// The rotation matrix of Rodrigues' formula, in the order of operations that gives POV-Ray's digits.
static bool rotate_about_axis(Eval *ev, const AstNode *node, Value *value)
{
    Vec3 a[2];
    double angle = 0.0;
    bool fine = vectors(ev, node, a, 2);
    if (!ask_number(ev, node->a->next->next, &angle) || !fine) {
        return false;
    }
    Vec3 n = vec3_scale(1.0 / vec3_length(a[1]), a[1]);
    double s = sin(number_radians(angle)), c = cos(number_radians(angle)), u = 1.0 - c;
    Transform rotation = {{
        {n.x * n.x + c * (1.0 - n.x * n.x), n.x * n.y * u + n.z * s, n.x * n.z * u - n.y * s},
        {n.x * n.y * u - n.z * s, n.y * n.y + c * (1.0 - n.y * n.y), n.y * n.z * u + n.x * s},
        {n.x * n.z * u + n.y * s, n.y * n.z * u - n.x * s, n.z * n.z + c * (1.0 - n.z * n.z)},
    }};
    return give_vector(value, transform_point(&rotation, a[0])); // whose sums have no negative zero, as POV-Ray's
}

// ---- names, arrays, files

static bool is_defined(Eval *ev, const AstNode *node, Value *value)
{
    // One token, whatever it is, or an element of an array.
    bool is_name = node->a->kind <= AST_CONSTANT || node->a->kind == AST_INDEX;
    if (!is_name || (node->a->flags & AST_IN_PARENTHESES)) {
        return eval_fault(ev, DIAG_E0202, node->a->span, "`defined` takes a name or an element of an array");
    }
    return give_number(value, ev->text->is_declared(ev, node->a) ? 1.0 : 0.0);
}

static bool array_dimensions(Eval *ev, const AstNode *node, Value *value)
{
    Value array;
    double dimension = 0.0;
    if (!ask_expression(ev, node->a, &array) || !value_array(ev, &array, node->a->span)) {
        return false;
    }
    if (node->symbol == W_dimensions) {
        return give_number(value, array.array->dimension_count);
    }
    const AstNode *second = node->a->next;
    if (!ask_number(ev, second, &dimension)) {
        return false;
    }
    // As POV-Ray: a dimension that the array does not have has no elements.
    bool is_there = dimension >= 1.0 && trunc(dimension) <= array.array->dimension_count;
    return give_number(value, is_there ? array.array->sizes[(unsigned)dimension - 1] : 0.0);
}

static bool file_exists(Eval *ev, const AstNode *node, Value *value)
{
    Value name;
    bool is_there;
    return ask_string(ev, node->a, &name) && ev->text->has_file(ev, &name, node->a->span, &is_there) &&
           give_number(value, is_there ? 1.0 : 0.0);
}

// Of declared objects.
static bool of_object(Eval *ev, const AstNode *node, Value *value)
{
    switch (node->symbol) {
    case W_trace: return ev->builder->trace(ev, node, value);
    case W_inside: return ev->builder->inside(ev, node, value);
    default: return ev->builder->extent(ev, node, value);
    }
}

static bool not_supported(Eval *ev, const AstNode *node, Value *value)
{
    (void)value;
    return eval_fault(ev, DIAG_E0210, node->span, "`%s` is not supported", eval_text(ev, node->symbol));
}

// ---- the table

enum { ANY_COUNT = 255 };

typedef struct Builtin {
    BuiltinFn evaluate;      // NULL when `of_number` is set
    double (*of_number)(double);
    uint8_t least, greatest; // number of arguments
} Builtin;

#define OF_NUMBER(function) {NULL, function, 1, 1}

static const Builtin builtins[WORD_COUNT] = {
    [W_abs] = OF_NUMBER(fabs),       [W_sin] = OF_NUMBER(sin),       [W_cos] = OF_NUMBER(cos),
    [W_tan] = OF_NUMBER(tan),        [W_atan] = OF_NUMBER(atan),     [W_sinh] = OF_NUMBER(sinh),
    [W_cosh] = OF_NUMBER(cosh),      [W_tanh] = OF_NUMBER(tanh),     [W_asinh] = OF_NUMBER(asinh),
    [W_acosh] = OF_NUMBER(acosh),    [W_atanh] = OF_NUMBER(atanh),   [W_exp] = OF_NUMBER(exp),
    [W_floor] = OF_NUMBER(floor),    [W_ceil] = OF_NUMBER(ceil),     [W_int] = OF_NUMBER(number_to_int),
    [W_degrees] = OF_NUMBER(number_degrees), [W_radians] = OF_NUMBER(number_radians),
    [W_sqrt] = {positive_only, NULL, 1, 1},
    [W_ln] = {positive_only, NULL, 1, 1},
    [W_log] = {positive_only, NULL, 1, 1},
    [W_asin] = {inverse_sine, NULL, 1, 1},
    [W_acos] = {inverse_sine, NULL, 1, 1},
    [W_atan2] = {two_numbers, NULL, 2, 2},
    [W_pow] = {two_numbers, NULL, 2, 2},
    [W_mod] = {two_numbers, NULL, 2, 2},
    [W_div] = {two_numbers, NULL, 2, 2},
    [W_min] = {least_or_greatest, NULL, 1, ANY_COUNT},
    [W_max] = {least_or_greatest, NULL, 1, ANY_COUNT},
    [W_bitwise_and] = {bitwise, NULL, 2, ANY_COUNT},
    [W_bitwise_or] = {bitwise, NULL, 2, ANY_COUNT},
    [W_bitwise_xor] = {bitwise, NULL, 2, ANY_COUNT},
    [W_select] = {select_by_sign, NULL, 3, 4},
    [W_seed] = {new_stream, NULL, 1, 1},
    [W_rand] = {next_random, NULL, 1, 1},
    [W_vlength] = {vector_number, NULL, 1, 1},
    [W_vdot] = {vector_number, NULL, 2, 2},
    [W_vcross] = {vector_vector, NULL, 2, 2},
    [W_vrotate] = {vector_vector, NULL, 2, 2},
    [W_vnormalize] = {vector_vector, NULL, 1, 1},
    [W_vaxis_rotate] = {rotate_about_axis, NULL, 3, 3},
    [W_min_extent] = {of_object, NULL, 1, 1},
    [W_max_extent] = {of_object, NULL, 1, 1},
    [W_trace] = {of_object, NULL, 3, 4},
    [W_inside] = {of_object, NULL, 2, 2},
    [W_defined] = {is_defined, NULL, 1, 1},
    [W_dimensions] = {array_dimensions, NULL, 1, 1},
    [W_dimension_size] = {array_dimensions, NULL, 2, 2},
    [W_file_exists] = {file_exists, NULL, 1, 1},
    [W_str] = {builtin_str, NULL, 3, 3},
    [W_vstr] = {builtin_vstr, NULL, 5, 5},
    [W_concat] = {builtin_concat, NULL, 1, ANY_COUNT},
    [W_chr] = {builtin_chr, NULL, 1, 1},
    [W_asc] = {builtin_asc, NULL, 1, 1},
    [W_val] = {builtin_val, NULL, 1, 1},
    [W_strlen] = {builtin_strlen, NULL, 1, 1},
    [W_strcmp] = {builtin_strcmp, NULL, 2, 2},
    [W_substr] = {builtin_substr, NULL, 3, 3},
    [W_strupr] = {builtin_strupr, NULL, 1, 1},
    [W_strlwr] = {builtin_strlwr, NULL, 1, 1},
    [W_datetime] = {builtin_datetime, NULL, 1, 2},
    // Words of the language that rtlang does not have.
    [W_vturbulence] = {vector_turbulence, NULL, 4, 4},
    [W_sum] = {not_supported, NULL, 0, ANY_COUNT},
    [W_prod] = {not_supported, NULL, 0, ANY_COUNT},
};

NumberFn builtin_of_number(Symbol word)
{
    return builtins[word].of_number;
}

static bool fault_count(Eval *ev, const AstNode *node, const Builtin *builtin)
{
    unsigned bound = node->count < builtin->least ? builtin->least : builtin->greatest;
    const char *which = builtin->least == builtin->greatest ? "" : node->count < bound ? "at least " : "at most ";
    return eval_fault(ev, DIAG_E0203, node->span, "`%s` takes %s%u argument%s, and %u %s given",
                      eval_text(ev, node->symbol), which, bound, bound == 1 ? "" : "s", (unsigned)node->count,
                      node->count == 1 ? "is" : "are");
}

static bool is_open_relation(const AstNode *node)
{
    bool is_relation = node != NULL && (node->kind == AST_CONDITIONAL ||
                                        (node->kind == AST_BINARY && node->op < AST_OP_ADD));
    return is_relation && !(node->flags & AST_IN_PARENTHESES);
}

// The parentheses of a function of one number are parentheses as any other.
static bool takes_relation(const AstNode *call)
{
    return call->count == 1 && call->symbol != W_vlength && call->symbol != W_vnormalize;
}

static bool fault_relation(Eval *ev, const AstNode *node)
{
    if (eval_report(ev, DIAG_E0225, node->span, "comparisons and choices stand in parentheses of their own here")) {
        diag_suggest(ev->options.diags, "put parentheses around it");
    }
    return false;
}

bool builtin_call(Eval *ev, const AstNode *node, Value *value)
{
    const Builtin *builtin = &builtins[node->symbol];
    if (RT_UNLIKELY(node->count < builtin->least ||
                    (node->count > builtin->greatest && builtin->greatest != ANY_COUNT))) {
        return fault_count(ev, node, builtin);
    }
    if (RT_UNLIKELY(is_open_relation(node->a)) && !takes_relation(node)) {
        return fault_relation(ev, node->a);
    }
    bool fine;
    ev->inner++;
    if (builtin->of_number != NULL) {
        double argument;
        fine = ask_number(ev, node->a, &argument) &&
               give_result(ev, node, value, builtin->of_number(argument), isfinite(argument));
    } else {
        fine = builtin->evaluate != NULL ? builtin->evaluate(ev, node, value) : not_supported(ev, node, value);
    }
    ev->inner--;
    return fine;
}

// ---- constants

static const struct {
    Word word;
    uint8_t components; // 0: a number
    double v[4];
} constants[] = {
    {W_x, 3, {1, 0, 0}},    {W_y, 3, {0, 1, 0}},   {W_z, 3, {0, 0, 1}},   {W_u, 2, {1, 0}},
    {W_v, 2, {0, 1}},       {W_t, 4, {0, 0, 0, 1}}, {W_pi, 0, {NUMBER_PI}},
    {W_true, 0, {1}},       {W_yes, 0, {1}},       {W_on, 0, {1}},        {W_false, 0, {0}},
    {W_no, 0, {0}},         {W_off, 0, {0}},
};

// Days since the first moment of the year 2000, universal time.
static double days_since_2000(void)
{
    return ((double)time(NULL) - EPOCH_2000) / 86400.0;
}

bool builtin_constant(Eval *ev, const AstNode *node, Value *value)
{
    for (size_t i = 0; i < RT_COUNT_OF(constants); i++) {
        if (constants[i].word != (Word)node->symbol) {
            continue;
        }
        *value = value_of_number(constants[i].v[0]);
        if (constants[i].components > 0) {
            value->kind = VALUE_VECTOR;
            value->components = constants[i].components;
            for (unsigned j = 0; j < 4; j++) {
                value->v[j] = constants[i].v[j];
            }
        }
        return true;
    }
    return node->symbol == W_version    ? give_number(value, ev->version)
           : node->symbol == W_clock    ? give_number(value, ev->options.clock)
           : node->symbol == W_clock_on ? give_number(value, ev->options.clock_on ? 1.0 : 0.0)
           : node->symbol == W_now      ? give_number(value, days_since_2000())
                                        : not_supported(ev, node, value);
}
