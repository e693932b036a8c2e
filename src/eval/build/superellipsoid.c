// Superellipsoids: two exponents become a fixed shape (scene/superellipsoid.h).
//
// Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"
#include "scene/superellipsoid.h"

// Half of POV-Ray's box. Measured.
static const double BOX = 1.0001;

bool superellipsoid_body(Block *block)
{
    SuperellipsoidDesc *shape = &block->record->superellipsoid;
    double exponents[2];
    Span span = block_here(block);
    if (!block_pair(block, "its exponents", exponents)) {
        return false;
    }
    shape->about = exponents[0];
    shape->along = exponents[1];
    double least = fmin(shape->about, shape->along);
    return least > 0.0 || block_fault(block, DIAG_E0341, span,
                                      "the exponents of a superellipsoid must be greater than 0, not %g", least);
}

const char *superellipsoid_form(const void *object, Primitive *primitive)
{
    const SuperellipsoidDesc *shape = object;
    primitive->kind = PRIMITIVE_SUPERELLIPSOID;
    primitive->data[0] = vec3(shape->about, shape->along, 0.0);
    primitive->to_world = transform_identity();
    return NULL;
}

bool superellipsoid_has(const void *object, Vec3 p, bool is_turned)
{
    const SuperellipsoidDesc *shape = object;
    return (superellipsoid_size(vec3(shape->about, shape->along, 0.0), p) <= 1.0) != is_turned;
}

bool superellipsoid_box(const void *object, OwnBox *own)
{
    (void)object;
    own->high = vec3(BOX, BOX, BOX);
    own->low = vec3_neg(own->high);
    return false;
}
