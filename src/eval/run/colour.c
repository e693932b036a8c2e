// Colour phrases: `color rgb <1, 0, 0> filter 0.5`, `Red`, `red 1 green 0.5` and the like.
//
// Reads items from a cursor. Everything is computed in double precision and rounded to single at the end, as POV-Ray
// keeps colours. Knows nothing of what a colour is for.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/run/run.h"

enum { RED, GREEN, BLUE, FILTER, TRANSMIT, COMPONENTS };

// A word that is followed by a value: the fourth component is filter unless `fourth` says otherwise.
typedef struct ColourModel {
    Word word;
    bool is_srgb;
    unsigned width; // components that the word promises
    unsigned fourth;
} ColourModel;

static const ColourModel models[] = {
    {W_rgb, false, 3, FILTER},   {W_rgbf, false, 4, FILTER},   {W_rgbt, false, 4, TRANSMIT},
    {W_rgbft, false, 5, FILTER}, {W_srgb, true, 3, FILTER},    {W_srgbf, true, 4, FILTER},
    {W_srgbt, true, 4, TRANSMIT}, {W_srgbft, true, 5, FILTER},
};

static const struct {
    Word word;
    unsigned component;
} parts[] = {
    {W_red, RED}, {W_green, GREEN}, {W_blue, BLUE}, {W_filter, FILTER}, {W_transmit, TRANSMIT}, {W_alpha, FILTER},
};

static Word word_of(const AstNode *item)
{
    return item != NULL && item->kind == AST_WORD ? (Word)item->symbol : WORD_NONE;
}

static const ColourModel *model_of(Word word)
{
    for (size_t i = 0; i < RT_COUNT_OF(models); i++) {
        if (models[i].word == word) {
            return &models[i];
        }
    }
    return NULL;
}

// COMPONENTS when the word is no component.
static unsigned component_of(Word word)
{
    for (size_t i = 0; i < RT_COUNT_OF(parts); i++) {
        if (parts[i].word == word) {
            return parts[i].component;
        }
    }
    return COMPONENTS;
}

// The decoding of IEC 61966-2-1, in single precision: POV-Ray's own results, to the last bit.
static float srgb_decode(float stored)
{
    return stored <= 0.04045f ? stored / 12.92f : powf((stored + 0.055f) / 1.055f, 2.4f);
}

// From sRGB to the working space that assumed_gamma makes.
static bool decode(Eval *ev, Span span, double v[COMPONENTS])
{
    const Settings *settings = &ev->scene->settings;
    if (settings->gamma_model == GAMMA_NONE) {
        return eval_fault(ev, DIAG_E0218, span, "an sRGB colour needs `assumed_gamma` to be given before it");
    }
    for (unsigned i = RED; settings->gamma_model != GAMMA_SRGB && i <= BLUE; i++) {
        float linear = srgb_decode((float)v[i]);
        v[i] = settings->gamma_model == GAMMA_LINEAR
                   ? linear
                   : copysignf(powf(fabsf(linear), (float)(1.0 / settings->assumed_gamma)), linear);
    }
    return true;
}

// More components than the word promises, or fewer: the words that promise as many are probably meant.
static void warn_of_width(Eval *ev, const ColourModel *model, Span span, unsigned components)
{
    bool is_more = components > model->width;
    const char *fit[2] = {NULL, NULL};
    for (size_t i = 0; i < RT_COUNT_OF(models); i++) {
        if (models[i].is_srgb == model->is_srgb && models[i].width == components) {
            fit[fit[0] != NULL] = eval_text(ev, models[i].word);
        }
    }
    bool is_kept = is_more ? eval_report(ev, DIAG_W0203, span, "`%s` is followed by %u components",
                                         eval_text(ev, model->word), components)
                           : eval_report(ev, DIAG_W0210, span, "`%s` is followed by %u components only: the rest is 0",
                                         eval_text(ev, model->word), components);
    if (is_kept && fit[0] != NULL && fit[1] == NULL) {
        diag_did_you_mean(ev->options.diags, span, fit[0]);
    } else if (is_kept && fit[0] != NULL) {
        diag_suggest(ev->options.diags, "did you mean `%s` or `%s`?", fit[0], fit[1]);
    }
}

static bool read_model(Cursor *cursor, const ColourModel *model, Span span, double v[COMPONENTS])
{
    Eval *ev = cursor->ev;
    Value value;
    const AstNode *item = cursor_peek(cursor);
    Span value_span = item != NULL ? item->span : span;
    if (!cursor_value(cursor, &value)) {
        return false;
    }
    if (value.kind == VALUE_NUMBER) {
        for (unsigned i = RED; i <= BLUE; i++) {
            v[i] = value.number;
        }
        v[model->fourth] = model->width > 3 ? value.number : 0.0;
        v[TRANSMIT] = model->width == 5 ? value.number : v[TRANSMIT];
        return !model->is_srgb || decode(ev, span, v);
    }
    if (!value_is_tuple(&value)) {
        return eval_fault(ev, DIAG_E0202, value_span, "`%s` needs a number or a vector, found %s",
                          eval_text(ev, model->word), value_describe(&value));
    }
    if (value.components != model->width) {
        warn_of_width(ev, model, span, value.components);
    }
    memcpy(v, value.v, value.components * sizeof *v);
    if (model->fourth == TRANSMIT && value.components > 3) {
        v[TRANSMIT] = v[FILTER];
        v[FILTER] = 0.0;
    }
    return !model->is_srgb || decode(ev, span, v);
}

static bool read_plain(Cursor *cursor, Span span, double v[COMPONENTS])
{
    Value value;
    Rgbft colour;
    const AstNode *item = cursor_peek(cursor);
    span = item != NULL ? item->span : span;
    cursor->ev->at_colour = true;
    bool fine = cursor_value(cursor, &value);
    cursor->ev->at_colour = false;
    bool wants_colour = cursor->ev->wants_colour;
    cursor->ev->wants_colour = false;
    if (fine && wants_colour && value.kind != VALUE_COLOUR) {
        return eval_fault(cursor->ev, DIAG_E0254, span,
                          "the colour of a pigment begins with a colour word such as `rgb`, or with the name of a "
                          "colour");
    }
    if (!fine || !value_colour(cursor->ev, &value, span, &colour)) {
        return false;
    }
    memcpy(v, (double[]){colour.red, colour.green, colour.blue, colour.filter, colour.transmit},
           COMPONENTS * sizeof *v);
    return true;
}

static bool read_parts(Cursor *cursor, double v[COMPONENTS], Span *span)
{
    for (;;) {
        const AstNode *item = cursor_peek(cursor);
        unsigned component = component_of(word_of(item));
        if (component == COMPONENTS || cursor->has_comma) {
            return true;
        }
        if (word_of(item) == W_alpha) {
            eval_warn(cursor->ev, DIAG_W0204, item->span, "`alpha` is an old word for `filter`");
        }
        Span number_span;
        cursor_skip(cursor);
        if (!cursor_number(cursor, &v[component], &number_span)) {
            return false;
        }
        *span = span_join(*span, number_span);
    }
}

// What stands behind `color` when that is all of a colour.
static bool is_no_colour(Cursor *cursor, const AstNode *item)
{
    bool is_word = item != NULL && item->kind == AST_WORD && component_of(word_of(item)) == COMPONENTS;
    return item == NULL || cursor->has_comma || is_word || !cursor_at_value(cursor);
}

bool cursor_colour(Cursor *cursor, Rgbft *colour, Span *span)
{
    double v[COMPONENTS] = {0};
    const AstNode *item = cursor_peek(cursor), *first = item;
    *span = item != NULL ? item->span : cursor->span;
    if (item != NULL && !cursor_lacks_comma(cursor, "front of this value")) {
        return false;
    }
    if (word_of(item) == W_color || word_of(item) == W_colour) {
        cursor_skip(cursor);
        item = cursor_peek(cursor);
    }
    const ColourModel *model = cursor->has_comma ? NULL : model_of(word_of(item));
    bool is_alone = model == NULL && item != first && is_no_colour(cursor, item);
    if (is_alone) { // `color` and nothing else is black
        *colour = (Rgbft){0};
        return true;
    }
    if (item != NULL) {
        *span = span_join(*span, item->span);
    }
    bool fine = true;
    if (model != NULL) {
        Span word_span = item->span;
        cursor_skip(cursor);
        item = cursor_peek(cursor);
        *span = item != NULL ? span_join(*span, item->span) : *span;
        fine = read_model(cursor, model, word_span, v);
    } else if (component_of(word_of(item)) == COMPONENTS) {
        fine = read_plain(cursor, *span, v);
    }
    if (!fine || !read_parts(cursor, v, span)) {
        return false;
    }
    if (RT_UNLIKELY(rgb_is_like_bytes(v[RED], v[GREEN], v[BLUE])) &&
        eval_report(cursor->ev, DIAG_W0211, *span, "this colour looks like bytes")) {
        diag_suggest(cursor->ev->options.diags, "components go from 0 to 1: divide by 255");
    }
    *colour = (Rgbft){(float)v[RED], (float)v[GREEN], (float)v[BLUE], (float)v[FILTER], (float)v[TRANSMIT]};
    return true;
}
