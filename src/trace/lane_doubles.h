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
#define LANE            Doubles
#define LANES(one, some) some
#define LANE_OF(a)      doubles_splat(a)
#define LANE_GE(a, b)   doubles_ge(a, b)
#define LANE_NOT(flags) (~(flags))
