// A scene of which each rank has a part: what cannot be shared, and what all ranks must know before they prepare it.
//
// Turns what each rank knows of its own spheres into what one process would know of all. Called by all ranks at the
// same places, since they wait for each other there.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "scene/primitive_reach.h"
#include "scene/range.h"
#include "scene/recentre.h"

rt_status rt_share_scene(rt_session *session)
{
    if (!session->sharing.has_ranks || session->loaded || session->is_built) {
        return RT_FAULT_USAGE;
    }
    session->sharing.has_scene = true;
    return RT_OK;
}

// ---- reading

enum { ROUND_MOST = 64 }; // bytes that a rank sends in a round

typedef struct ReadRound {
    uint64_t has_ended;
    unsigned char values[ROUND_MOST];
} ReadRound;

void *session_scene_gather(rt_session *session, const void *own, size_t length)
{
    const Ranks *ranks = &session->sharing.ranks;
    void *all = malloc((size_t)ranks->ranks * length);
    if (!all) {
        ranks->module->stop(RT_FAULT_LIMIT); // ends all, this one, too: they would wait
    } else {
        ranks->module->gather(own, all, length);
    }
    return all;
}

// Whether all ranks are where this one is: in a round, or at the end.
static bool read_on(rt_session *session, const ReadRound *own, ReadRound *all)
{
    for (int i = 0; i < session->sharing.ranks.ranks; i++) {
        if (all[i].has_ended != own->has_ended) {
            session->sharing.has_read = true;
            diag_report(&session->diags, DIAG_E0522, SPAN_NONE, "rank %d of %d cannot read its part of the scene",
                        own->has_ended ? session->sharing.ranks.rank : i, session->sharing.ranks.ranks);
            return false;
        }
    }
    return true;
}

static bool exchange(void *client, const void *own, void *all, size_t length)
{
    rt_session *session = client;
    ReadRound round = {0};
    if (length > sizeof round.values) {
        return false;
    }
    memcpy(round.values, own, length);
    ReadRound *rounds = session_scene_gather(session, &round, sizeof round);
    for (int i = 0; i < session->sharing.ranks.ranks; i++) {
        memcpy((unsigned char *)all + (size_t)i * length, rounds[i].values, length);
    }
    bool goes_on = read_on(session, &round, rounds);
    free(rounds);
    return goes_on;
}

const EvalShare *session_scene_reading(rt_session *session)
{
    SessionSharing *sharing = &session->sharing;
    if (!sharing->has_scene || sharing->ranks.ranks == 1) {
        return NULL;
    }
    sharing->share = (EvalShare){.part = sharing->ranks.rank, .parts = sharing->ranks.ranks, .exchange = exchange};
    return &sharing->share;
}

bool session_scene_read(rt_session *session)
{
    ReadRound own = {.has_ended = 1};
    if (session->sharing.has_read) {
        return false;
    }
    ReadRound *all = session_scene_gather(session, &own, sizeof own);
    session->sharing.has_read = true;
    bool are_together = read_on(session, &own, all);
    free(all);
    return are_together;
}

// ---- what cannot be shared

static bool refuse(rt_session *session, Span span, const char *what)
{
    if (diag_report(&session->diags, DIAG_E0714, span, "a scene cannot be shared with %s", what)) {
        diag_suggest(&session->diags,
                     "spheres and planes of plain colours are: else share the picture alone, by `--mpi`");
    }
    return false;
}

// Where the first shape of a texture, or of a finish that is `special`, is written; of spheres, those that are here.
static Span find_shape(const Scene *scene, const bool *special)
{
    for (size_t i = 0; i < scene->planes.count + scene->spheres.count; i++) {
        size_t sphere = i - scene->planes.count;
        bool is_plane = i < scene->planes.count;
        MaterialIndex material = is_plane ? scene->planes.items[i].material : scene->spheres.items[sphere].material;
        if (material & MATERIAL_COMPOUND ? !special : special && special[scene->materials.items[material].finish]) {
            return scene_source_span(is_plane ? scene->planes.items[i].source : scene_sphere_source(scene, sphere));
        }
    }
    return SPAN_NONE;
}

// Finishes whose light depends on more than what a ray has met.
static bool finishes_fit(rt_session *session)
{
    const Scene *scene = &session->scene;
    bool *special = calloc(scene->finishes.count + 1, sizeof *special), has_some = false;
    for (size_t i = 0; special && i < scene->finishes.count; i++) {
        const Finish *finish = &scene->finishes.items[i];
        special[i] = finish->crand > 0.0 || finish->irid > 0.0 || (finish->flags & FINISH_FRESNEL);
        has_some = has_some || special[i];
    }
    bool fits = special && !has_some;
    if (!special) {
        (void)session_no_memory(session);
    } else if (has_some) {
        refuse(session, find_shape(scene, special), "`crand`, `irid` or `fresnel`");
    }
    free(special);
    return fits;
}

static bool run_fits(rt_session *session)
{
    bool is_plain = !session_is_sampled(session) && session->planes == 0 && session->precision == RT_PRECISION_DOUBLE &&
                    !overlay_is_wanted(&session->overlay);
    if (!is_plain && diag_report(&session->diags, DIAG_E0703, SPAN_NONE,
                                 "a scene that ranks share is drawn with one ray a pixel, or `--antialias`")) {
        diag_suggest(&session->diags,
                     "leave out `--samples` and goals, a camera's blur, planes, lines and `--precision`");
    }
    return is_plain;
}

static bool scene_fits(rt_session *session)
{
    const Scene *scene = &session->scene;
    if (scene->primitives.count > 0) {
        char what[128];
        snprintf(what, sizeof what, "this %s", primitive_name(&scene->primitives.items[0]));
        return refuse(session, scene_source_span(scene->primitives.items[0].source), what);
    }
    if (scene->compounds.count > 0) {
        return refuse(session, find_shape(scene, NULL), "patterns, layers and interiors");
    }
    if (scene->rainbows.count > 0) {
        return refuse(session, scene->rainbows.items[0].span, "a rainbow");
    }
    if (scene->fogs.count > 0) {
        return refuse(session, scene->fogs.items[0].span, "fog");
    }
    return finishes_fit(session) && run_fits(session);
}

// ---- what all know

static void share_survey(rt_session *session)
{
    scene_keep_survey(&session->scene, session->threads > 0 ? session->threads : 1);
    SphereSurvey *all = session_scene_gather(session, &session->scene.survey, sizeof *all);
    for (int i = 0; i < session->sharing.ranks.ranks; i++) {
        sphere_survey_add(&session->scene.survey, &all[i]);
    }
    free(all);
}

static bool has_clear(const Scene *scene)
{
    bool found = false;
    for (size_t i = 0; !found && i < scene->materials.count; i++) {
        found = scene->materials.items[i].filter != 0.0F || scene->materials.items[i].transmit != 0.0F;
    }
    return found;
}

bool session_scene_agree(rt_session *session)
{
    const Scene *scene = &session->scene;
    int32_t own = has_clear(scene), *all = session_scene_gather(session, &own, sizeof own);
    session->sharing.has_clear = false;
    for (int i = 0; i < session->sharing.ranks.ranks; i++) {
        session->sharing.has_clear = session->sharing.has_clear || all[i];
    }
    free(all);
    share_survey(session);
    if (!scene_fits(session)) {
        return false;
    }
    if (!scene_range_is_held(scene, &scene->survey)) {
        return refuse(session, scene->whole, "lengths that no scale holds together");
    }
    return session_scene_report(session);
}

rt_status session_scene_budget(rt_session *session, rt_budget own, rt_budget *greatest)
{
    *greatest = own;
    if (!session_scene_read(session)) {
        return session_status(session, false);
    }
    rt_budget *all = session_scene_gather(session, &own, sizeof own);
    bool are_loaded = session->loaded;
    for (int i = 0; i < session->sharing.ranks.ranks; i++) {
        uint64_t needs = all[i].scene + all[i].prepared;
        are_loaded = are_loaded && all[i].limit > 0;
        *greatest = needs > greatest->scene + greatest->prepared ? all[i] : *greatest;
    }
    free(all);
    return are_loaded ? RT_OK : RT_FAULT_USAGE;
}

Vec3 session_scene_recentre(rt_session *session)
{
    if (!session->sharing.has_scene) {
        return scene_recentre(&session->scene);
    }
    RecentreAxis own[3], (*all)[3];
    scene_recentre_measure(&session->scene, own);
    all = session_scene_gather(session, own, sizeof own);
    for (int i = 0; i < session->sharing.ranks.ranks; i++) {
        scene_recentre_join(own, all[i]);
    }
    free(all);
    Vec3 origin = scene_recentre_share(&session->scene, own);
    share_survey(session);
    return origin;
}

void session_scene_ask(rt_session *session, const Prepared *prepared)
{
    SessionSharing *sharing = &session->sharing;
    if (sharing->has_scene && prepared) {
        sharing->asking = prepared_asking(prepared);
        ranks_ask(&sharing->ranks, &sharing->asking);
    }
}
