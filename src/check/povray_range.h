// The scenes for which POV-Ray's fixed tolerances were made.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_POVRAY_RANGE_H
#define CHECK_POVRAY_RANGE_H

#include <stddef.h>

#include "rtlang/rtlang.h"

// Says in which way a scene is outside of the range in which POV-Ray 3.7 draws it as any other of the same form; ""
// when it is inside. See docs/numerics.md, "POV-Ray's range".
void povray_range_describe(const rt_range *range, char *words, size_t size);

#endif
