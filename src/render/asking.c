// How threads ask other processes of spheres, in the form of bytes: trace/elsewhere.h as render/records/tile_share.h
// wants it.
//
// SPDX-License-Identifier: MIT
#include "trace/elsewhere.h"

#include "render/records/prepared.h"
#include "render/render.h"

static size_t questions(void *client, const void **list)
{
    const SphereQuestion *first;
    size_t count = geometry_questions(client, &first);
    *list = first;
    return count;
}

static void learn(void *client, const void *answers, size_t lists)
{
    geometry_learn(client, answers, lists);
}

static bool forget(void *client)
{
    return geometry_forget(client);
}

static bool answer(void *client, const void *list, size_t count, void *answers)
{
    return geometry_answer(client, list, count, answers);
}

TileAsking prepared_asking(const Prepared *prepared)
{
    return (TileAsking){.client = prepared->geometry,
                        .question_bytes = sizeof(SphereQuestion),
                        .answer_bytes = sizeof(SphereAnswer),
                        .questions = questions,
                        .learn = learn,
                        .forget = forget,
                        .answer = answer};
}
