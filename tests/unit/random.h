// Random numbers for the unit tests.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_RANDOM_H
#define UNIT_RANDOM_H

#include "math/random.h"

#endif
