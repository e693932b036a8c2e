// Rainbows; see rainbow.h.
//
// A ray's angle to the light's direction says which colour it meets. Of several rainbows that a ray meets the mean
// counts. All of it was measured.
//
// SPDX-License-Identifier: MIT
#include "render/shade/rainbow.h"

#include <math.h>
#include <string.h>

#include "math/extreme.h"
#include "math/random.h"

static const double degrees = 57.29577951308232;

// From -1 to 1, by the ray.
static double jitter_of(const Prepared *p, const Ray *ray, size_t number)
{
    Random random = {p->seed + number};
    uint64_t bits[3];
    memcpy(bits, &ray->direction, sizeof bits);
    for (int i = 0; i < 3; i++) {
        random.state = random_bits(&random) ^ bits[i];
    }
    return random_between(&random, -1.0, 1.0);
}

// Where an arc ends it fades out: 1 within the falloff, 0 beyond.
static double arc_share(const Rainbow *rainbow, Vec3 direction)
{
    if (rainbow->falloff >= 180.0) {
        return 1.0;
    }
    double turned = degrees * fabs(atan2(vec3_dot(direction, rainbow->across), vec3_dot(direction, rainbow->top)));
    double share = turned <= rainbow->falloff ? 1.0
                   : turned >= rainbow->arc   ? 0.0
                                              : (rainbow->arc - turned) / (rainbow->arc - rainbow->falloff);
    return share * share * (3.0 - 2.0 * share);
}

static bool is_met(const Prepared *p, size_t number, const Ray *ray, double way, FogShare *share)
{
    const Rainbow *rainbow = &p->scene->rainbows.items[number];
    double angle = degrees * acos(less_of(greater_of(vec3_dot(ray->direction, rainbow->ahead), -1.0), 1.0));
    double index = (angle - (rainbow->angle - rainbow->width / 2.0)) / rainbow->width;
    if (rainbow->jitter != 0.0) {
        index += rainbow->jitter * jitter_of(p, ray, number);
    }
    if (!(index >= 0.0 && index <= 1.0)) {
        return false;
    }
    double weight = arc_share(rainbow, ray->direction);
    Rgbft found = texture_pigment(&p->textures, &(Pigment){.pattern = rainbow->pattern}, vec3(index, 0.0, 0.0));
    double left = greater_of(exp(-way / rainbow->distance), 1.0 - weight * (1.0 - found.transmit));
    double filter = found.filter * (1.0 - left);
    Rgb colour = rgbft_rgb(found);
    share->own = rgb_scale(1.0 - left, colour);
    share->through = rgb_scale(left, rgb_add(rgb_grey(1.0 - filter), rgb_scale(filter, colour)));
    return weight > 0.0;
}

FogShare rainbow_between(const Prepared *p, const Ray *ray, double way)
{
    FogShare sum = {rgb_grey(0.0), rgb_grey(0.0)}, one;
    int count = 0;
    for (size_t i = 0; i < p->scene->rainbows.count; i++) {
        if (is_met(p, i, ray, way, &one)) {
            sum.own = rgb_add(sum.own, one.own);
            sum.through = rgb_add(sum.through, one.through);
            count++;
        }
    }
    return count == 0 ? (FogShare){rgb_grey(1.0), rgb_grey(0.0)}
                      : (FogShare){rgb_scale(1.0 / count, sum.through), rgb_scale(1.0 / count, sum.own)};
}
