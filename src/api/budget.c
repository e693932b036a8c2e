// What a run takes of memory, computed before it is taken.
//
// Turns a loaded session into bytes, and refuses what is above the limit. Takes nothing itself.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"
#include "trace/elsewhere.h"

// What the tree takes for a shape, and the prepared forms of the records as a multiple of these: bounds that hold for
// a million spheres (95 bytes each in all), stretched spheres (370 in the tree), boxes (460) and differences (910).
// Plain spheres and their materials have no other form than that in the tree.
enum { TREE_BYTES_PER_SHAPE = 128, PREPARED_PER_RECORD = 2 };

static rt_budget budget_of(const rt_session *session)
{
    const Scene *records = &session->scene;
    uint64_t scene = scene_bytes(records), pictures = scene_picture_bytes(records);
    uint64_t plain = records->spheres.capacity * sizeof(Sphere) + records->sphere_runs.capacity * sizeof(SphereRun) +
                     records->materials.capacity * sizeof(Material);
    bool is_shared = session->sharing.has_scene;
    uint64_t objects = session->scene.shape_count, held = is_shared ? scene_shapes_in_all(records) : objects;
    uint64_t met = is_shared ? geometry_share_bytes(session->threads) : 0; // of other ranks' shapes
    int width = session_film_width(session), height = session_film_height(session);
    return (rt_budget){
        .objects = objects,
        .scene = scene,
        .prepared = (scene - pictures - plain) * PREPARED_PER_RECORD + held * TREE_BYTES_PER_SHAPE + met,
        .picture = film_bytes(width, height, session_is_sampled(session), session_film_planes(session)) +
                   (session_is_sampled(session) && objects > 0
                        ? small_bytes(width, height, objects) + share_bytes(width, height, objects)
                        : 0) +
                   (session->method != RT_METHOD_BACKWARD ? forward_bytes(width, height) : 0),
        .limit = session->limits.memory_most,
    };
}

rt_status rt_get_budget(rt_session *session, rt_budget *budget)
{
    if (session->sharing.has_scene) {
        return session_scene_budget(session, session->loaded ? budget_of(session) : (rt_budget){0}, budget);
    }
    if (!session->loaded) {
        return RT_FAULT_USAGE;
    }
    *budget = budget_of(session);
    return RT_OK;
}

size_t session_memory_granted(const rt_session *session)
{
    return limits_memory(&session->limits, source_map_bytes(session->sources) + session->array_bytes);
}

bool session_memory_suffices(rt_session *session)
{
    rt_budget budget = budget_of(session);
    uint64_t granted = session_memory_granted(session);
    bool fits = budget.scene + budget.prepared <= granted;
    char needed[LIMITS_BYTES_TEXT], limit[LIMITS_BYTES_TEXT];
    if (fits && budget.picture + budget.scene + budget.prepared <= budget.limit) {
        return true;
    }
    bool is_film = fits && budget.picture > budget.scene + budget.prepared;
    limits_bytes_text(fits ? budget.limit : granted, limit);
    limits_bytes_text(is_film ? budget.picture : budget.scene + budget.prepared, needed);
    bool kept = is_film ? diag_report(&session->diags, DIAG_E0608, SPAN_NONE,
                                      "a picture of %d x %d pixels needs %s of memory, and the limit is %s",
                                      session_film_width(session), session_film_height(session), needed, limit)
                        : diag_report(&session->diags, DIAG_E0607, SPAN_NONE,
                                      "preparing %llu shapes needs %s of memory, and the limit is %s",
                                      (unsigned long long)budget.objects, needed, limit);
    if (kept) {
        diag_suggest(&session->diags, "`--max-memory` allows more");
    }
    return false;
}

const char *rt_scene_file(const rt_session *session, size_t i)
{
    size_t texts = source_map_count(session->sources), pictures = session->scene.picture_sources.count;
    return i < texts              ? source_map_name(session->sources, i)
           : i - texts < pictures ? session->scene.picture_sources.items[i - texts].path
                                  : NULL;
}
