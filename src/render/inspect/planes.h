// The planes of a film that say what surface is seen. Part of render/render.h.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_INSPECT_PLANES_H
#define RENDER_INSPECT_PLANES_H

#include "base/attributes.h"
#include "render/records/film.h"
#include "render/records/options.h"

// Fills those of FILM_SURFACE_PLANES that the film has. Its rays are not counted.
RenderResult render_surface_planes(const Prepared *prepared, const RenderOptions *options, Film *film) RT_MUST_CHECK;

#endif
