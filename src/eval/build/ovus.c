// Eggs: two radii become a fixed shape (scene/ovus.h).
//
// Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"
#include "scene/ovus.h"

// POV-Ray makes a ball of it then. Measured.
static bool is_ball(const OvusDesc *desc)
{
    return !(desc->top < 2.0 * desc->bottom);
}

static Vec3 middle_of(const OvusDesc *desc)
{
    return vec3(0.0, is_ball(desc) ? desc->bottom : 0.5 * desc->top, 0.0);
}

// Half of POV-Ray's box: across it is the whole arc's, which the egg may not come to. Measured.
static Vec3 half_of(const OvusDesc *desc)
{
    Ovus ovus = ovus_make(desc->bottom, desc->top);
    double across = is_ball(desc) ? desc->top : ovus.arc - ovus.beyond;
    return vec3(across, is_ball(desc) ? desc->top : desc->bottom + 0.5 * desc->top, across);
}

const char *ovus_form(const void *object, Primitive *primitive)
{
    const OvusDesc *desc = object;
    Vec3 half = half_of(desc);
    double size = fmax(half.x, half.y);
    if (!(size > 0.0)) {
        return "an ovus with radii of 0 is not drawn";
    }
    primitive->to_world =
        transform_compose(transform_scale(vec3(size, size, size)), transform_translate(middle_of(desc)));
    primitive->kind = is_ball(desc) ? PRIMITIVE_SPHERE : PRIMITIVE_OVUS;
    if (!is_ball(desc)) {
        Ovus ovus = ovus_make(desc->bottom / size, desc->top / size);
        primitive->data[0] = vec3(ovus.bottom, ovus.top, ovus.low);
        primitive->data[1] = vec3(ovus.high, ovus.arc, ovus.beyond);
        primitive->data[2] = vec3(ovus.at, 0.0, 0.0);
    }
    return NULL;
}

bool ovus_has(const void *object, Vec3 point, bool is_turned)
{
    const OvusDesc *desc = object;
    Vec3 p = vec3_sub(point, middle_of(desc)), normal;
    Ovus ovus = ovus_make(desc->bottom, desc->top);
    bool is_in = is_ball(desc) ? vec3_length(p) <= desc->top : ovus_distance(&ovus, p, &normal) <= 0.0;
    return is_in != is_turned;
}

bool ovus_box(const void *object, OwnBox *own)
{
    const OvusDesc *desc = object;
    own->low = vec3_sub(middle_of(desc), half_of(desc));
    own->high = vec3_add(middle_of(desc), half_of(desc));
    return false;
}
