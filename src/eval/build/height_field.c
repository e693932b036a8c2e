// `height_field { picture or function … }` becomes a mesh over a grid, a vertex for each height.
//
// Heights are the 16 bits that POV-Ray makes of a picture: places of a palette are their high bytes, red and green of
// 8 bits high and low byte, all else is how light it is; gamma is none unless it is said. Of a function's values whole
// ones are left out, as where numbers of 16 bits overflow. All measured. Knows nothing of how pictures are read.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"
#include "eval/values/function.h"
#include "scene/mesh_field.h"
#include "scene/room.h"

// Room for an error of single precision where a value is cut to a whole number.
static const double SLACK = 1.0 / 128.0;

// What is beyond whole numbers of 32 bits, or none, is 0.
static uint16_t code_of(double scaled)
{
    double most = (double)INT32_MAX;
    return scaled > -most && scaled < most ? (uint16_t)(uint32_t)(int32_t)scaled : 0;
}

// How light a colour is, as POV-Ray has it.
static double grey_of(double red, double green, double blue)
{
    return 0.297 * red + 0.589 * green + 0.114 * blue;
}

// ---- the field

static bool begin(Block *block, double columns, double rows, Span span)
{
    Eval *ev = block->ev;
    double faces = mesh_field_faces(columns, rows);
    if (!(columns >= 2.0 && rows >= 2.0)) {
        return block_fault(block, DIAG_E0475, span, "a height field needs at least 2 x 2 heights, not %.10g x %.10g",
                           columns, rows);
    }
    if (!(faces <= MESH_FACES_MOST)) {
        return block_fault(block, DIAG_E0475, span, "%.10g x %.10g heights are more than a height field may have",
                           columns, rows);
    }
    if (!scene_has_room(ev->scene, (uint64_t)faces, ev->options.limits, ev->options.diags, span)) {
        ev->stop = true;
        return false;
    }
    if (!memory_has(ev, mesh_field_bytes((uint32_t)columns, (uint32_t)rows, true))) {
        ev->memory.refused = true;
        return eval_no_memory(ev, span);
    }
    Mesh *mesh = mesh_field_new((uint32_t)columns, (uint32_t)rows);
    if (!mesh || !scene_add_mesh(ev->scene, mesh)) {
        mesh_free(mesh);
        return eval_no_memory(ev, span);
    }
    mesh->source = block->node->span.begin;
    block->record->mesh.mesh = mesh;
    return true;
}

// ---- pictures

static double sample_of(const Picture *picture, size_t i)
{
    switch (picture->depth) {
    case PICTURE_DEPTH_8:
        return (double)picture->decoded[((const uint8_t *)picture->samples)[i]];
    case PICTURE_DEPTH_16:
        return (double)picture->decoded[((const uint16_t *)picture->samples)[i]];
    default:
        return (double)((const float *)picture->samples)[i];
    }
}

static uint16_t picture_height(const Picture *picture, size_t pixel)
{
    size_t at = pixel * (size_t)picture->channels;
    if (picture->places > 0) {
        return (uint16_t)(((const uint8_t *)picture->samples)[at] << 8);
    }
    double first = sample_of(picture, at);
    if (picture->channels < 3) {
        return code_of(floor(first * 65535.0 + SLACK));
    }
    double green = sample_of(picture, at + 1);
    return picture->depth == PICTURE_DEPTH_16 ? code_of(grey_of(first, green, sample_of(picture, at + 2)) * 65535.0)
                                              : code_of(floor(first * 65280.0 + green * 255.0 + SLACK));
}

// The top row is the last one of the field.
static bool take_picture(Block *block, const Picture *picture, Span span)
{
    if (!begin(block, (double)picture->width, (double)picture->height, span)) {
        return false;
    }
    MeshField *field = block->record->mesh.mesh->field;
    for (uint32_t row = 0; row < field->rows; row++) {
        for (uint32_t column = 0; column < field->columns; column++) {
            size_t pixel = (size_t)(field->rows - 1 - row) * field->columns + column;
            field->heights[(size_t)row * field->columns + column] = picture_height(picture, pixel);
        }
    }
    return true;
}

static bool load_picture(Block *block, const PictureSource *source, Span span)
{
    Eval *ev = block->ev;
    Scene scene;
    uint32_t index;
    if (!ev->options.load_pictures) {
        return block_fault(block, DIAG_E0210, span, "a height field of a picture is not supported");
    }
    scene_init(&scene);
    bool is_fine = scene_add_picture(&scene, source, span, &index) || eval_no_memory(ev, span);
    if (is_fine && !ev->options.load_pictures(ev->options.client, &scene)) {
        ev->stop = true;
        is_fine = false;
    }
    is_fine = is_fine && take_picture(block, &scene.pictures.items[index], span);
    scene_fini(&scene);
    return is_fine;
}

// No gamma but one that is said counts, and then as if light were wanted.
static bool read_picture(Block *block, PictureFormat format)
{
    PictureSource source = {.path = NULL};
    Span span;
    if (!image_read_source(block, format, &source, &span)) {
        return false;
    }
    source.is_modern = false;
    source.space = GAMMA_NONE;
    source.space_gamma = 0.0;
    return load_picture(block, &source, span);
}

// ---- functions

static double kept_of(double colour)
{
    return (double)(float)((double)code_of((double)((float)colour * 65535.0F)) / 65535.0);
}

static bool function_height(Block *block, const Function *function, const double place[3], Span span, uint16_t *height)
{
    double v[5] = {0.0};
    if (!eval_step(block->ev, span) || function_apply(block->ev, function, place, span, v) == 0) {
        return false;
    }
    if (function->kind == FUNCTION_PIGMENT) { // a picture of 16 bits is made of it
        *height = code_of(grey_of(kept_of(v[0]), kept_of(v[1]), kept_of(v[2])) * 65535.0);
    } else {
        *height = code_of((double)((float)v[0] * 65535.0F));
    }
    return true;
}

// y rises from the last row of the field to the first one, as it does in pictures.
static bool take_function(Block *block, const Function *function, double columns, double rows, Span span)
{
    if (!begin(block, columns, rows, span)) {
        return false;
    }
    MeshField *field = block->record->mesh.mesh->field;
    for (uint32_t row = 0; row < field->rows; row++) {
        for (uint32_t column = 0; column < field->columns; column++) {
            double place[3] = {(double)column / (double)(field->columns - 1),
                               (double)(field->rows - 1 - row) / (double)(field->rows - 1), 0.0};
            if (!function_height(block, function, place, span,
                                 &field->heights[(size_t)row * field->columns + column])) {
                return false;
            }
        }
    }
    return true;
}

// A function that stands alone, with its sizes.
static bool read_function(Block *block, const AstNode *item)
{
    double sizes[2];
    AstNode alone = *item;
    Value value;
    cursor_skip(&block->cursor);
    if (!item->c) {
        return block_fault(block, DIAG_E0253, item->span,
                           "the function of a height field begins with two numbers: how many heights there are along "
                           "x and z");
    }
    alone.c = NULL;
    if (!eval_number(block->ev, item->c, &sizes[0]) || !eval_number(block->ev, item->c->next, &sizes[1]) ||
        !function_create(block->ev, &alone, &value)) {
        return false;
    }
    const Function *function = value.function;
    if (function->kind == FUNCTION_TRANSFORM || function->kind == FUNCTION_SPLINE) {
        return block_fault(block, DIAG_E0258, item->span, "the function of a height field must give a number");
    }
    return take_function(block, function, floor(sizes[0] + 0.5), floor(sizes[1] + 0.5), item->span);
}

// ---- the block

static bool is_unreadable(const Block *block, const AstNode *item)
{
    static const char *const words[] = {"gif", "iff", "pot", "sys"};
    for (size_t i = 0; item->kind == AST_WORD && i < RT_COUNT_OF(words); i++) {
        if (strcmp(eval_text(block->ev, item->symbol), words[i]) == 0) {
            return true;
        }
    }
    return false;
}

bool height_field_body(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    if (item && item->kind == AST_FUNCTION) {
        return read_function(block, item);
    }
    if (item && is_unreadable(block, item)) {
        cursor_skip(&block->cursor);
        block->has_unsupported = block->is_lost = true;
        block_unsupported(block->ev, eval_text(block->ev, item->symbol), item->span, block->kind);
        return false;
    }
    PictureFormat format =
        item && item->kind == AST_WORD ? image_format(eval_text(block->ev, item->symbol)) : PICTURE_FORMATS;
    if (format != PICTURE_FORMATS) {
        cursor_skip(&block->cursor);
    } else if (!item || item->kind == AST_WORD || item->kind == AST_BLOCK || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, item ? item->span : block->node->span,
                           "a height field begins with a picture or a `function`");
    }
    return read_picture(block, format);
}

bool height_field_close(Block *block)
{
    MeshDesc *desc = &block->record->mesh;
    if (block->has_name || !desc->mesh) {
        return true;
    }
    Mesh *mesh = desc->mesh;
    mesh->field->water = desc->water;
    mesh_field_build(mesh);
    block->ev->scene->mesh_bytes -= mesh_bytes(mesh);
    bool is_fine = !desc->is_smooth || mesh_field_smooth(mesh) || eval_no_memory(block->ev, block->node->span);
    block->ev->scene->mesh_bytes += mesh_bytes(mesh);
    return is_fine;
}
