// Splines as text: `spline { … }` becomes points in rising order.
//
// Knows nothing of the curves through them.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/run/callable.h"

typedef ARRAY(SplinePoint) PointList;

typedef struct SplineReader {
    Eval *ev;
    Cursor cursor;
    PointList points;
    SplineType type;
    unsigned components;
    double carry[5]; // of the point that was read last
} SplineReader;

// Keeps the points in rising order. As in POV-Ray one at a place that is taken replaces what is there, unless that is the
// last of several: then the new one is left out.
static bool insert(SplineReader *reader, const SplinePoint *point)
{
    PointList *list = &reader->points;
    size_t at = list->count;
    while (at > 0 && list->items[at - 1].t >= point->t) {
        at--;
    }
    if (at < list->count && list->items[at].t == point->t) {
        if (at == 0 || at + 1 < list->count) {
            list->items[at] = *point;
        }
        return true;
    }
    if (!ARRAY_PUSH(list, *point)) {
        return false;
    }
    memmove(list->items + at + 1, list->items + at, (list->count - 1 - at) * sizeof *list->items);
    list->items[at] = *point;
    return true;
}

static bool copy_spline(SplineReader *reader, const Spline *from)
{
    for (unsigned i = 0; i < from->count; i++) {
        if (!ARRAY_PUSH(&reader->points, from->points[i])) {
            return eval_no_memory(reader->ev, reader->cursor.span);
        }
    }
    reader->type = from->type;
    reader->components = from->components;
    return true;
}

// The name of another spline, then a type, both of which may be missing.
static bool read_head(SplineReader *reader)
{
    const AstNode *item = cursor_peek(&reader->cursor);
    Value value;
    if (item != NULL && (item->kind == AST_NAME || item->kind == AST_INDEX)) {
        if (!ask_expression(reader->ev, item, &value)) {
            return false;
        }
        if (value.kind == VALUE_SPLINE) {
            cursor_skip(&reader->cursor);
            if (!copy_spline(reader, value.spline)) {
                return false;
            }
            item = cursor_peek(&reader->cursor);
        }
    }
    if (item != NULL && item->kind == AST_WORD && spline_type((Word)item->symbol, &reader->type)) {
        cursor_skip(&reader->cursor);
        item = cursor_peek(&reader->cursor);
    }
    return item == NULL || !reader->cursor.has_comma ||
           eval_fault(reader->ev, DIAG_E0259, item->span, "no comma may stand before the first point of a spline");
}

// A number is two equal components. As in POV-Ray, what a point does not say is as in the point read before it, 0 in
// the first.
static bool read_point(SplineReader *reader)
{
    Eval *ev = reader->ev;
    SplinePoint point = {0};
    Span span;
    Value value;
    cursor_take_comma(&reader->cursor);
    if (!cursor_number(&reader->cursor, &point.t, &span)) {
        return false;
    }
    if (!isfinite(point.t)) {
        return eval_fault(ev, DIAG_E0340, span, "the number of a spline's point is not finite");
    }
    const AstNode *item = cursor_peek(&reader->cursor);
    if (item == NULL) {
        return !ev->stop && eval_fault(ev, DIAG_E0263, span, "this number needs a point of the spline after it");
    }
    span = item->span;
    cursor_take_comma(&reader->cursor);
    if (!cursor_value(&reader->cursor, &value)) {
        return false;
    }
    if (value.kind != VALUE_NUMBER && !value_is_tuple(&value)) {
        return eval_fault(ev, DIAG_E0202, span, "a point of a spline is a vector, not %s", value_describe(&value));
    }
    double v[5];
    memcpy(reader->carry, v, value_components(&value, v) * sizeof *v);
    if (value.kind == VALUE_NUMBER) {
        reader->carry[1] = value.number;
    } else if (value.components > reader->components) {
        reader->components = value.components;
    }
    memcpy(point.v, reader->carry, sizeof point.v);
    return insert(reader, &point) || eval_no_memory(ev, span);
}

static bool read_points(SplineReader *reader)
{
    Eval *ev = reader->ev;
    bool fine = true;
    const AstNode *item;
    while (fine && (item = cursor_peek(&reader->cursor)) != NULL) {
        fine = cursor_at_value(&reader->cursor) && item->kind != AST_WORD
                   ? read_point(reader)
                   : eval_fault(ev, DIAG_E0263, item->span, "a spline holds numbers, each with a point after it");
    }
    return fine && !ev->stop;
}

static bool make_spline(SplineReader *reader, Span span, Value *value)
{
    Eval *ev = reader->ev;
    unsigned count = (unsigned)reader->points.count;
    if (count == 0) {
        return eval_fault(ev, DIAG_E0263, span, "a spline needs at least one point");
    }
    Spline *spline = arena_alloc(&ev->program, sizeof *spline);
    SplinePoint *points = arena_copy(&ev->program, reader->points.items, count * sizeof *points);
    double *pivots = arena_alloc_array(&ev->scratch, count, sizeof *pivots);
    if (spline == NULL || points == NULL || pivots == NULL) {
        return eval_no_memory(ev, span);
    }
    spline_bend(points, count, pivots);
    *spline = (Spline){.type = reader->type, .components = reader->components, .count = count, .points = points};
    *value = (Value){.kind = VALUE_SPLINE, .spline = spline};
    return true;
}

bool spline_create(Eval *ev, const AstNode *block, Value *value)
{
    SplineReader reader = {.ev = ev, .type = SPLINE_LINEAR, .components = 2};
    ev->inner++;
    cursor_open(&reader.cursor, ev, block->a, block->span);
    bool fine = read_head(&reader) && read_points(&reader) && make_spline(&reader, block->span, value);
    cursor_close(&reader.cursor);
    ev->inner--;
    ARRAY_FREE(&reader.points);
    return fine && !ev->stop;
}
