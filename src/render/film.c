// The film: storage of a picture while it is traced.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "base/pages.h"
#include "render/render.h"

bool film_init(Film *film, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;
    *film = (Film){width, height, calloc(pixels, 3 * sizeof(float))};
    pages_prefer_huge(film->rgb, 3 * sizeof(float) * pixels);
    return film->rgb != NULL;
}

void film_fini(Film *film)
{
    free(film->rgb);
    *film = (Film){0};
}
