// Functions of patterns and pigments: the evaluator's records as the renderer's textures.
//
// SPDX-License-Identifier: MIT
#include "api/painter.h"

#include <stdlib.h>

#include "render/surface/texture.h"

static void *painter_open(const Scene *pigments, const Noise *noise)
{
    TextureTable *table = malloc(sizeof *table);
    if (table && !texture_table_init(table, pigments, noise, 0, NULL)) {
        free(table);
        return NULL;
    }
    return table;
}

static double painter_value(void *opened, const Pigment *pigment, NoiseGenerator generator, Vec3 point)
{
    TextureTable *table = opened;
    table->source.generator = generator;
    return texture_pattern_value(table, pigment->pattern, point);
}

static Rgbft painter_colour(void *opened, const Pigment *pigment, NoiseGenerator generator, Vec3 point)
{
    TextureTable *table = opened;
    table->source.generator = generator;
    return texture_pigment(table, pigment, point);
}

static void painter_close(void *opened)
{
    texture_table_fini(opened);
    free(opened);
}

static size_t painter_bytes(const void *opened)
{
    return texture_table_bytes(opened);
}

const EvalPainter painter = {painter_open, painter_value, painter_colour, painter_bytes, painter_close};
