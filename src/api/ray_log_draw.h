// A ray log as a drawing: the plane of the first ray, the spheres that it cuts, and every ray laid into it.
//
// SPDX-License-Identifier: MIT
#ifndef API_RAY_LOG_DRAW_H
#define API_RAY_LOG_DRAW_H

#include "base/text.h"
#include "render/inspect/ray_log.h"

// The plane holds the first ray and the normal where it hits, or the nearest sphere's centre: there mirrored and bent
// rays stay in it, and a sphere that is hit is cut through its middle. What leaves it is seen straight from above.
// Writes one <svg> element that has its own style and is read on light pages and on dark ones.
void ray_log_draw(const RayLog *log, int x, int y, TextBuffer *out);

#endif
