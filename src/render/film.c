// The film: storage of a picture while it is traced.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "render/render.h"

bool film_init(Film *film, int width, int height)
{
    *film = (Film){width, height, calloc((size_t)width * (size_t)height, 3 * sizeof(float))};
    return film->rgb != NULL;
}

void film_fini(Film *film)
{
    free(film->rgb);
    *film = (Film){0};
}
