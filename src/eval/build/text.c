// Text: a font, a string, a thickness and an offset become a union of prisms, a letter each.
//
// As in POV-Ray letters stand side by side along x from 0 on, their outlines in x and y, and reach as far along z as
// the text is thick; the first one's left edge is at 0; and all is turned by a thousandth of a degree about x, y and z.
// Knows nothing of how fonts are read.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"
#include "eval/values/characters.h"
#include "scene/font.h"
#include "scene/outline.h"

// In degrees, about each axis. Measured.
static const double TURN = 0.001;
// How far POV-Ray's box of a text stands off its front and its back. Measured.
static const double BOX_DISTANCE = 1e-6;

typedef struct TextHead {
    const char *path, *real; // of the font; without links
    Span font_span;
    Value text;
    Span span;
    double thickness;
    Vec3 offset;
} TextHead;

static bool read_string(Block *block, const char *what, Value *string, Span *span)
{
    const AstNode *item = cursor_peek(&block->cursor);
    if (!item || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`text` needs a string here: %s", what);
    }
    *span = item->span;
    bool is_string = cursor_lacks_comma(&block->cursor, "front of this string") && eval_string(block->ev, item, string);
    cursor_skip(&block->cursor);
    return is_string;
}

// `internal` and a number: fonts that POV-Ray has within itself, and rtlang in the files that come with its include
// files.
static bool read_internal(Block *block, TextHead *head)
{
    static const char *const names[] = {"povlogo.ttf", "timrom.ttf", "cyrvetic.ttf", "crystal.ttf"};
    static const char *const endings[] = {NULL};
    double number;
    cursor_skip(&block->cursor);
    const AstNode *item = cursor_peek(&block->cursor);
    if (!item || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`internal` needs a number after it");
    }
    if (!cursor_number(&block->cursor, &number, &head->font_span)) {
        return false;
    }
    bool is_one = number >= 1.0 && number < (double)RT_COUNT_OF(names);
    head->path = file_find(block->ev, item, names[is_one ? (size_t)number : 0], FILE_FONT, endings, &head->real);
    cursor_take_comma(&block->cursor);
    return head->path != NULL;
}

static bool read_font(Block *block, TextHead *head)
{
    static const char *const endings[] = {".ttf", ".ttc", NULL};
    Value name;
    if (cursor_at_word(&block->cursor, W_internal)) {
        return read_internal(block, head);
    }
    if (!cursor_at_word(&block->cursor, W_ttf)) {
        return block_fault(block, DIAG_E0253, block_here(block),
                           "`text` begins with `ttf` and the name of a font, or `internal` and a number");
    }
    cursor_skip(&block->cursor);
    const AstNode *item = cursor_peek(&block->cursor);
    if (!read_string(block, "the name of a font", &name, &head->font_span)) {
        return false;
    }
    head->path = file_find(block->ev, item, name.text, FILE_FONT, endings, &head->real);
    cursor_take_comma(&block->cursor);
    return head->path != NULL;
}

static bool read_head(Block *block, TextHead *head)
{
    Span span;
    bool has_font = read_font(block, head);
    if (!has_font && !head->font_span.end) {
        return false;
    }
    if (!read_string(block, "what is written", &head->text, &head->span)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    if (!cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`text` needs a number here: how thick it is");
    }
    if (!cursor_number(&block->cursor, &head->thickness, &span) ||
        !block_finite(block, head->thickness, span, "thickness")) {
        return false;
    }
    if (!(head->thickness > 0.0)) { // POV-Ray draws something else than what its boxes say. Measured.
        return block_fault(block, DIAG_E0341, span, "a text must be thicker than 0, not %g", head->thickness);
    }
    cursor_take_comma(&block->cursor);
    if (!cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block),
                           "`text` needs a vector here: how much farther each letter stands; 0 for none");
    }
    return cursor_vector3(&block->cursor, &head->offset, &span) &&
           (vec3_is_finite(head->offset) ||
            block_fault(block, DIAG_E0340, span, "the offset of a text has a coordinate that is not finite")) &&
           has_font;
}

// ---- letters

static Transform letters_turn(void)
{
    return transform_rotate(vec3(TURN, TURN, TURN));
}

// The outline's z becomes y, and its height z.
static Transform letter_place(double x, double y)
{
    Transform place = {{{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {x, y, 0.0}}};
    return transform_compose(place, letters_turn());
}

// Blanks count as a point.
static void widen(OwnBox *box, const FontLetter *letter, Vec3 pen)
{
    box->low = vec3_least(box->low, vec3(pen.x + letter->low[0], pen.y + letter->low[1], box->low.z));
    box->high = vec3_greatest(box->high, vec3(pen.x + letter->high[0], pen.y + letter->high[1], box->high.z));
}

static bool add_letter(Block *block, const TextHead *head, const Numbers *outline, double x, double y,
                       UnionMember ***end)
{
    PrismDesc *prism = arena_alloc(block->arena, sizeof *prism);
    UnionMember *member = arena_alloc(block->arena, sizeof *member);
    Desc record;
    if (!prism || !member) {
        return eval_no_memory(block->ev, head->span);
    }
    block_defaults(block->ev, KIND_PRISM, &record);
    *prism = record.prism;
    prism->outline = *outline;
    prism->heights[1] = head->thickness;
    prism->part.transform = letter_place(x, y);
    prism->part.span = block->node->span;
    *member = (UnionMember){.object = prism, .kind = KIND_PRISM};
    **end = member;
    *end = &member->next;
    return true;
}

static bool add_letters(Block *block, const TextHead *head, Font *font, OwnBox *box, UnionMember ***end, uint32_t *count)
{
    Vec3 pen = {0.0, 0.0, 0.0};
    uint32_t before = 0;
    const char *text = head->text.text, *text_end = text + head->text.length;
    for (bool is_first = true; text < text_end; is_first = false) {
        size_t bytes;
        FontLetter letter;
        unsigned character = character_at(text, text_end, &bytes);
        text += bytes;
        if (!eval_work(block->ev, 1, head->span)) {
            return false;
        }
        if (font_letter(font, character, block->arena, &letter) != FONT_OK) {
            return eval_no_memory(block->ev, head->span);
        }
        if (letter.is_cut) {
            return block_fault(block, DIAG_E0494, head->span, "a letter of this text has more than %d pieces",
                               OUTLINE_PIECES_MOST);
        }
        pen.x += is_first ? -letter.bearing : font_kerning(font, before, letter.index) + head->offset.x;
        pen.y += is_first ? 0.0 : head->offset.y;
        widen(box, &letter, pen);
        if (letter.outline.count > 0) {
            if (!add_letter(block, head, &letter.outline, pen.x, pen.y, end)) {
                return false;
            }
            ++*count;
        }
        pen.x += letter.advance;
        before = letter.index;
    }
    return true;
}

bool text_body(Block *block)
{
    TextHead head = {.path = NULL};
    UnionDesc *group = &block->record->group;
    UnionMember *first = NULL, **end = &first;
    Font font;
    char why[200] = "";
    if (!read_head(block, &head)) {
        return false;
    }
    switch (font_open(&font, head.real, characters_are_utf8(block->ev), why, sizeof why)) {
    case FONT_NO_MODULE:
        return block_fault(block, DIAG_E0516, block->node->span,
                           "text needs FreeType to read fonts, which this rtlang cannot use: %s", why);
    case FONT_NONE:
        return block_fault(block, DIAG_E0515, head.font_span, "`%s` cannot be used as a font: %s", head.path, why);
    case FONT_NO_MEMORY:
        return eval_no_memory(block->ev, block->node->span);
    case FONT_OK:
        break;
    }
    OwnBox *box = arena_alloc(block->arena, sizeof *box);
    bool is_fine = box != NULL || eval_no_memory(block->ev, block->node->span);
    if (is_fine) {
        *box = (OwnBox){.low = {INFINITY, INFINITY, -BOX_DISTANCE},
                        .high = {-INFINITY, -INFINITY, head.thickness + BOX_DISTANCE},
                        .frame = letters_turn()};
        is_fine = add_letters(block, &head, &font, box, &end, &group->count);
        group->box = box->low.x <= box->high.x ? box : NULL;
    }
    font_close(&font);
    group->members = first;
    group->depth = 1;
    block->is = KIND_UNION;
    return is_fine;
}
