// The colours along patterns of which nothing is said.
//
// Constant data only, as measured from POV-Ray.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"

#define AT_VALUE(value, red, green, blue) {.at = (float)(value), .colour = {red, green, blue, 0.0, 0.0}}

static const PatternEntry grey[] = {AT_VALUE(0.0, 0.0, 0.0, 0.0), AT_VALUE(1.0, 1.0, 1.0, 1.0)};
static const PatternEntry radial[] = {AT_VALUE(0.0, 0.0, 1.0, 1.0), AT_VALUE(0.333, 1.0, 1.0, 0.0),
                                      AT_VALUE(0.666, 1.0, 0.0, 1.0), AT_VALUE(1.0, 0.0, 1.0, 1.0)};
static const PatternEntry bozo[] = {AT_VALUE(0.4, 1.0, 1.0, 1.0), AT_VALUE(0.4, 0.0, 1.0, 0.0),
                                    AT_VALUE(0.6, 0.0, 1.0, 0.0), AT_VALUE(0.6, 0.0, 0.0, 1.0),
                                    AT_VALUE(0.8, 0.0, 0.0, 1.0), AT_VALUE(0.8, 1.0, 0.0, 0.0)};
static const PatternEntry agate[] = {AT_VALUE(0.0, 1.0, 1.0, 1.0), AT_VALUE(0.5, 0.95F, 0.75F, 0.5),
                                     AT_VALUE(0.5, 0.9F, 0.7F, 0.5), AT_VALUE(0.6, 0.9F, 0.7F, 0.4F),
                                     AT_VALUE(0.6, 1.0, 0.7F, 0.4F), AT_VALUE(1.0, 0.6F, 0.3F, 0.0)};
static const PatternEntry marble[] = {AT_VALUE(0.0, 0.9F, 0.8F, 0.8F), AT_VALUE(0.9, 0.9F, 0.08F, 0.08F),
                                      AT_VALUE(0.9, 0.0, 0.0, 0.0)};
static const PatternEntry wood[] = {AT_VALUE(0.6, 0.666F, 0.312F, 0.2F), AT_VALUE(0.6, 0.4F, 0.1333F, 0.066F)};

static const PatternEntry mandel[] = {AT_VALUE(0.001, 0.0, 0.0, 0.0), AT_VALUE(0.001, 0.0, 1.0, 1.0),
                                      AT_VALUE(0.012, 1.0, 1.0, 0.0), AT_VALUE(0.015, 1.0, 0.0, 1.0),
                                      AT_VALUE(0.1, 0.0, 1.0, 1.0)};

#define MAP(entries) {entries, RT_COUNT_OF(entries)}

const PatternMap *pattern_default_map(PatternType type)
{
    static const PatternMap otherwise = MAP(grey);
    static const PatternMap maps[PATTERN_COUNT] = {
        [PATTERN_RADIAL] = MAP(radial), [PATTERN_BOZO] = MAP(bozo), [PATTERN_AGATE] = MAP(agate),
        [PATTERN_MARBLE] = MAP(marble), [PATTERN_WOOD] = MAP(wood), [PATTERN_MANDEL] = MAP(mandel),
    };
    return maps[type].count ? &maps[type] : &otherwise;
}
