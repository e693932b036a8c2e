// Sphere sweeps: a word for the curve and balls become a list of segments (scene/sweep.h).
//
// The list is in parts of a power of two, so that it is the same when a dump is read. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"
#include "scene/sweep.h"

static const struct {
    Word word;
    const char *name;
} curves[] = {
    [SWEEP_LINEAR] = {W_linear_spline, "linear_spline"},
    [SWEEP_B_SPLINE] = {W_b_spline, "b_spline"},
    [SWEEP_CUBIC] = {W_cubic_spline, "cubic_spline"},
};

static bool read_curve(Block *block, SweepCurve *curve)
{
    for (unsigned i = 0; i < RT_COUNT_OF(curves); i++) {
        if (cursor_at_word(&block->cursor, curves[i].word)) {
            cursor_skip(&block->cursor);
            *curve = (SweepCurve)i;
            return true;
        }
    }
    return block_fault(block, DIAG_E0488, block_here(block),
                       "`sphere_sweep` begins with `linear_spline`, `b_spline` or `cubic_spline`");
}

static bool read_count(Block *block, SweepCurve curve, uint32_t *count)
{
    double number;
    Span span = block->node->span;
    if (!cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block),
                           "`sphere_sweep` needs a number here: its number of balls");
    }
    if (!cursor_number(&block->cursor, &number, &span) || !block_finite(block, number, span, "number of balls")) {
        return false;
    }
    if (!(number >= sweep_least(curve))) {
        return block_fault(block, DIAG_E0488, span, "a `%s` of a sphere sweep needs at least %u balls",
                           curves[curve].name, sweep_least(curve));
    }
    if (number > SWEEP_BALLS_MOST) {
        return block_fault(block, DIAG_E0488, span, "a sphere sweep has at most %d balls here", SWEEP_BALLS_MOST);
    }
    *count = (uint32_t)number;
    return true;
}

// Whether a ball's middle or radius may stand next; else reports how many balls there are.
static bool is_at_ball(Block *block, uint32_t read, uint32_t count)
{
    cursor_take_comma(&block->cursor);
    if (cursor_at_value(&block->cursor)) {
        return true;
    }
    return !block->ev->stop &&
           block_fault(block, DIAG_E0488, block_here(block),
                       "`sphere_sweep` needs %u balls, a middle and a radius each, and has %u", count, read);
}

static bool read_ball(Block *block, uint32_t i, uint32_t count, SweepBall *ball)
{
    Span span;
    if (!is_at_ball(block, i, count) || !cursor_vector3(&block->cursor, &ball->middle, &span)) {
        return false;
    }
    if (!vec3_is_finite(ball->middle)) {
        return block_fault(block, DIAG_E0340, span, "the middle of a ball has a coordinate that is not finite");
    }
    if (!is_at_ball(block, i, count) || !cursor_number(&block->cursor, &ball->radius, &span) ||
        !block_finite(block, ball->radius, span, "radius of a ball")) {
        return false;
    }
    return ball->radius >= 0.0 ||
           block_fault(block, DIAG_E0341, span, "the radius of a ball cannot be less than 0, as %g is", ball->radius);
}

// Divides all by a power of two that is no less than any of it.
static double scale_balls(SweepBall *balls, uint32_t count)
{
    double most = 0.0;
    int exponent;
    for (uint32_t i = 0; i < count; i++) {
        most = fmax(most, fmax(vec3_max_abs(balls[i].middle), balls[i].radius));
    }
    frexp(most, &exponent);
    for (uint32_t i = 0; i < count; i++) {
        SweepBall *ball = &balls[i];
        ball->middle =
            vec3(ldexp(ball->middle.x, -exponent), ldexp(ball->middle.y, -exponent), ldexp(ball->middle.z, -exponent));
        ball->radius = ldexp(ball->radius, -exponent);
    }
    return ldexp(1.0, exponent);
}

static bool is_within(const SweepBox *inner, const SweepBox *outer)
{
    const double *low = &inner->low.x, *high = &inner->high.x, *least = &outer->low.x, *greatest = &outer->high.x;
    bool is_in = true;
    for (int axis = 0; axis < 3; axis++) {
        double rounding = 0x1p-30 * fmax(fabs(least[axis]), fabs(greatest[axis]));
        is_in = is_in && low[axis] >= least[axis] - rounding && high[axis] <= greatest[axis] + rounding;
    }
    return is_in;
}

// Looked at ball by ball: a part that swings out between them is not seen.
static void check_box(Block *block, const Sweep *sweep)
{
    enum { PLACES = 32 };
    SweepBox given = sweep_given_box(sweep), all = sweep_bounds(sweep);
    bool is_in = is_within(&all, &given);
    for (uint32_t i = 0; i < sweep->segment_count && !is_in; i++) {
        for (int k = 0; k <= PLACES; k++) {
            SweepBall ball = sweep_ball(sweep, i, k * (1.0 / PLACES) - 0.5);
            double radius = fabs(ball.radius);
            Vec3 half = {radius, radius, radius};
            SweepBox own = {vec3_sub(ball.middle, half), vec3_add(ball.middle, half)};
            if (!is_within(&own, &given)) {
                eval_warn(block->ev, DIAG_W0488, block->node->span,
                          "the curve leaves the box that POV-Ray takes for it, which may cut it there");
                return;
            }
        }
    }
}

bool sweep_body(Block *block)
{
    SweepDesc *desc = &block->record->sweep;
    SweepCurve curve = SWEEP_LINEAR;
    uint32_t count = 0;
    if (!read_curve(block, &curve) || !read_count(block, curve, &count)) {
        return false;
    }
    double *list = arena_alloc_array(block->arena, sweep_list_count(curve, count), sizeof *list);
    if (!list) {
        return eval_no_memory(block->ev, block->node->span);
    }
    SweepBall *balls = (SweepBall *)(void *)(list + SWEEP_HEAD);
    for (uint32_t i = 0; i < count; i++) {
        if (!read_ball(block, i, count, &balls[i])) {
            return false;
        }
    }
    desc->size = scale_balls(balls, count);
    sweep_complete(list, curve, count);
    desc->list = (Numbers){list, sweep_list_count(curve, count)};
    Sweep sweep = sweep_of(list);
    if (curve == SWEEP_CUBIC) {
        check_box(block, &sweep);
    }
    return true;
}

const char *sweep_form(const void *object, Primitive *primitive)
{
    const SweepDesc *desc = object;
    Sweep sweep = sweep_of(desc->list.items);
    SweepBox box = sweep_bounds(&sweep);
    double most = 0.0;
    for (uint32_t i = 0; i < sweep.ball_count; i++) {
        most = fmax(most, sweep.balls[i].radius);
    }
    primitive->kind = PRIMITIVE_SWEEP;
    primitive->list = desc->list;
    primitive->fixed[0] = box.low;
    primitive->fixed[1] = box.high;
    primitive->to_world = transform_scale(vec3(desc->size, desc->size, desc->size));
    return most > 0.0 ? NULL : "a sphere sweep with radii of 0 is not drawn";
}

bool sweep_has(const void *object, Vec3 p, bool is_turned)
{
    const SweepDesc *desc = object;
    Sweep sweep = sweep_of(desc->list.items);
    SweepBall ball;
    return (sweep_nearest(&sweep, vec3_scale(1.0 / desc->size, p), &ball) <= 0.0) != is_turned;
}

bool sweep_box(const void *object, OwnBox *own)
{
    const SweepDesc *desc = object;
    Sweep sweep = sweep_of(desc->list.items);
    SweepBox box = sweep_given_box(&sweep);
    own->low = vec3_scale(desc->size, box.low);
    own->high = vec3_scale(desc->size, box.high);
    return false;
}
