// Which maps of a texture were visited: one that several entries share is visited once, so that k textures that each
// name the one before twice cost k visits and not 2^k.
//
// What was made of a map is kept by the caller's kind: records of the scene, or a changed map. Owns its tables only.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_SHARED_MAPS_H
#define EVAL_SHARED_MAPS_H

#include "base/array.h"
#include "base/attributes.h"
#include "scene/description.h"
#include "scene/unique.h"

enum { COST_MOST = 1 << 30 }; // counts end at about this

// What tracing may meet at one point.
typedef struct MapCost {
    uint64_t ways;     // directions in which bumps send rays
    uint64_t patterns; // that are looked at
} MapCost;

// What was made of one map.
typedef struct SharedMap {
    uint32_t first;            // of the scene's entries
    MapCost most, sum;         // that of the entry that has most, and of all
    const PatternMap *changed; // of take_filters
} SharedMap;

typedef struct SharedMaps {
    UniqueIndex index;
    ARRAY(const PatternMap *) maps;
    ARRAY(SharedMap) made;
} SharedMaps;

// The place of a map in `made`, which is empty when *is_new: the caller fills it. A map never holds itself, so nobody
// meets an empty one. False when out of memory.
bool shared_maps_place(SharedMaps *shared, const PatternMap *map, uint32_t *place, bool *is_new) RT_MUST_CHECK;
void shared_maps_fini(SharedMaps *shared);

#endif
