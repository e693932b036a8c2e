// What a text that is written once for numbers and for vectors of them (*.inc) is compiled with: here a lane is a
// double. trace/lane_doubles.h is the other.
//
// Such a text calls a lane's type LANE, and what has a name of its own for each of the two LANES(one, some). A header
// of single numbers includes this and then the text, one of vectors the other and then the text: both have the same
// operations in the same order, and so the same bits. That is why this has no guard of its own.
//
// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "base/attributes.h"

#undef LANE
#undef LANES
#undef LANE_OF
#undef LANE_GE
#undef LANE_NOT
#undef LANE_MASK
#undef LANE_CHOOSE
#undef LANE_MIN
#undef LANE_MAX
#define LANE                    double
#define LANE_MASK               bool
#define LANES(one, some)        one
#define LANE_OF(a)              (a)
#define LANE_GE(a, b)           ((a) >= (b))
#define LANE_NOT(flags)         (!(flags))
#define LANE_CHOOSE(mask, a, b) ((mask) ? (a) : (b))
// No number is NaN.
#define LANE_MIN(a, b) ((a) < (b) ? (a) : (b))
#define LANE_MAX(a, b) ((a) > (b) ? (a) : (b))
