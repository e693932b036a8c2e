// The choice among the tables of tile_light_kernel.c.
//
// SPDX-License-Identifier: MIT
#include "render/shade/tile_light.h"

#include <string.h>

#include "base/isa.h"

ISA_LIST(TileLights, tile_lights_, tables);

const TileLights *tile_lights_choose(const char *name)
{
    for (size_t i = 0; i < RT_COUNT_OF(tables); i++) {
        if (strcmp(name, tables[i]->name) == 0) {
            return tables[i];
        }
    }
    return NULL;
}
