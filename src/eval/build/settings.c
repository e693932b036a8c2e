// The scene's settings: global_settings and background.
//
// Several blocks are merged; the last value counts, of assumed_gamma the first. Knows nothing of pictures.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"

#include <stddef.h>

bool settings_read_gamma(Block *block, const char *name, Span word, GammaModel *model, double *gamma)
{
    if (cursor_at_word(&block->cursor, W_srgb)) {
        cursor_skip(&block->cursor);
        *model = GAMMA_SRGB;
        return true;
    }
    const AstNode *item = cursor_peek(&block->cursor);
    if (!item || item->kind == AST_WORD || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, word, "`%s` needs a number or `srgb` after it", name);
    }
    Span span = item->span;
    if (!cursor_number(&block->cursor, gamma, &span) || !block_finite(block, *gamma, span, name)) {
        return false;
    }
    if (!(*gamma > 0.0)) {
        return block_fault(block, DIAG_E0341, span, "`%s` must be greater than 0, not %g", name, *gamma);
    }
    *model = *gamma == 1.0 ? GAMMA_LINEAR : GAMMA_POWER;
    return true;
}

bool settings_gamma_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Settings *settings = &block->ev->scene->settings;
    GammaModel model = GAMMA_NONE;
    double gamma = 1.0;
    if (!settings_read_gamma(block, property->word, item->span, &model, &gamma)) {
        return false;
    }
    if (settings->gamma_model != GAMMA_NONE) {
        eval_warn(block->ev, DIAG_W0404, item->span, "`assumed_gamma` was given before; the first one counts");
        return true;
    }
    settings->gamma_model = model;
    settings->assumed_gamma = gamma;
    return true;
}

// Once said it is 1, 2 or 3, as in POV-Ray; unsaid, the version decides.
bool settings_generator_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty number = {.word = "noise_generator",
                                          .type = TYPE_INTEGER,
                                          .range = {RANGE_FAULT, false, 1.0, 3.0},
                                          .at = offsetof(SettingsDesc, noise_generator)};
    (void)property;
    return block_value(block, &number, item->span);
}

bool settings_charset_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    Eval *ev = block->ev;
    if (cursor_at_word(&block->cursor, W_ascii)) {
        ev->charset = CHARSET_ASCII;
    } else if (cursor_at_word(&block->cursor, W_utf8)) {
        ev->charset = CHARSET_UTF8;
    } else if (cursor_at_word(&block->cursor, W_sys)) {
        ev->charset = CHARSET_SYS;
    } else {
        return block_fault(block, DIAG_E0253, item->span, "`charset` needs `ascii`, `utf8` or `sys` after it");
    }
    cursor_skip(&block->cursor);
    return true;
}

bool settings_place(Eval *ev, SchemaKind kind, const Desc *record)
{
    if (kind == KIND_BACKGROUND) {
        // Nothing of it was clear before version 3.7. Measured.
        bool is_clear = eval_knows_37(ev);
        ev->scene->background = record->background.colour;
        ev->scene->background.filter = is_clear ? record->background.colour.filter : 0.0;
        ev->scene->background.transmit = is_clear ? record->background.colour.transmit : 0.0;
        return true;
    }
    Settings *settings = &ev->scene->settings;
    settings->ambient_light = record->settings.ambient_light;
    settings->adc_bailout = record->settings.adc_bailout;
    settings->max_trace_level = record->settings.max_trace_level;
    settings->noise_generator = record->settings.noise_generator;
    settings->number_of_waves = record->settings.number_of_waves;
    settings->irid_wavelength = record->settings.irid_wavelength;
    return true;
}
