// The choice among the tables of tile_light_kernel.c.
//
// SPDX-License-Identifier: MIT
#include "render/tile_light.h"

#include <string.h>

extern const TileLights tile_lights_plain;
#ifdef __x86_64__
extern const TileLights tile_lights_v2, tile_lights_v3, tile_lights_v4;
static const TileLights *const tables[] = {&tile_lights_plain, &tile_lights_v2, &tile_lights_v3, &tile_lights_v4};
#else
static const TileLights *const tables[] = {&tile_lights_plain};
#endif

const TileLights *tile_lights_choose(const char *name)
{
    for (size_t i = 0; i < RT_COUNT_OF(tables); i++) {
        if (strcmp(name, tables[i]->name) == 0) {
            return tables[i];
        }
    }
    return NULL;
}
