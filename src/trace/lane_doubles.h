// What a text that is written once for numbers and for vectors of them (*.inc) is compiled with: here a lane is one of
// a vector's numbers. math/lane_double.h is the other, and says more. No guard, as there.
//
// SPDX-License-Identifier: MIT
#include "base/attributes.h"
#include "trace/simd.h"

#undef LANE
#undef LANES
#undef LANE_OF
#undef LANE_GE
#undef LANE_NOT
#undef LANE_MASK
#undef LANE_CHOOSE
#undef LANE_MIN
#undef LANE_MAX
#define LANE                    Doubles
#define LANE_MASK               DoublesMask
#define LANES(one, some)        some
#define LANE_OF(a)              doubles_splat(a)
#define LANE_GE(a, b)           doubles_ge(a, b)
#define LANE_NOT(flags)         (~(flags))
#define LANE_CHOOSE(mask, a, b) ((__typeof__(a))(((mask) & (DoublesMask)(a)) | (~(mask) & (DoublesMask)(b))))
#define LANE_MIN(a, b)          doubles_min(a, b)
#define LANE_MAX(a, b)          doubles_max(a, b)
