// Work on a picture that several processes share, or that is stopped and continued: what is traced here, where the rest
// comes from, and what is kept.
//
// Turns settings and files into the table that rendering asks (render/records/tile_share.h), and what is wrong with
// them into messages. Traces nothing.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "base/module.h"

static void sharing_clear(SessionSharing *sharing)
{
    for (size_t i = 0; i < sharing->joined_count; i++) {
        free(sharing->joined[i]);
    }
    free(sharing->joined);
    free(sharing->checkpoint);
    free(sharing->command);
    sharing->joined = NULL;
    sharing->joined_count = 0;
    sharing->checkpoint = sharing->command = NULL;
    sharing->is_on = false;
}

// ---- ranks

rt_status rt_join_ranks(rt_session *session, int *rank, int *ranks)
{
    enum { ROOM = 64 << 20 };
    SessionSharing *sharing = &session->sharing;
    const void *found;
    char why[256];
    ModuleKind kind = {MPI_MODULE_FILE, MPI_MODULE_SYMBOL, MPI_MODULE_VERSION, ROOM};
    *rank = 0;
    *ranks = 1;
    if (sharing->has_ranks) {
        return RT_FAULT_USAGE;
    }
    ModuleResult result = module_load(&kind, &found, why, sizeof why);
    const MpiModule *module = found;
    const char *fault = result == MODULE_NO_MEMORY                            ? "out of memory"
                        : result != MODULE_OK                                 ? why
                        : !module->is_whole                                   ? "this rtlang was built without it"
                        : !module->begin(rank, ranks)                         ? "MPI does not begin"
                        : !ranks_init(&sharing->ranks, module, *rank, *ranks) ? "out of memory"
                                                                              : NULL;
    if (fault) {
        if (diag_report(&session->diags, DIAG_E0521, SPAN_NONE, "`--mpi` needs MPI: %s", fault)) {
            diag_suggest(&session->diags, "install libopenmpi-dev and make rtlang again, or use `--part` and `--join`");
        }
        return session_status(session, false);
    }
    sharing->has_ranks = true;
    return RT_OK;
}

void rt_leave_ranks(rt_session *session)
{
    if (session->sharing.has_ranks) {
        session->sharing.ranks.module->end();
    }
}

void rt_stop_ranks(rt_session *session, int code)
{
    if (session->sharing.has_ranks) {
        session->sharing.ranks.module->stop(code);
    }
}

rt_status rt_worst_of_ranks(rt_session *session, rt_status status)
{
    Ranks *ranks = &session->sharing.ranks;
    long long own = status, worst = status, *all;
    if (!session->sharing.has_ranks) {
        return status;
    }
    all = calloc((size_t)ranks->ranks, sizeof *all);
    if (!all) {
        ranks->module->stop(RT_FAULT_LIMIT);
        return RT_FAULT_LIMIT;
    }
    ranks->module->gather(&own, all, sizeof own);
    for (int i = 0; i < ranks->ranks; i++) {
        worst = all[i] > worst ? all[i] : worst;
    }
    free(all);
    return (rt_status)worst;
}

static void store_close(SessionSharing *sharing)
{
    if (sharing->has_store) {
        store_fini(&sharing->store);
    }
    sharing->has_store = false;
}

void session_sharing_fini(SessionSharing *sharing)
{
    store_close(sharing);
    if (sharing->has_ranks) {
        ranks_fini(&sharing->ranks);
    }
    sharing_clear(sharing);
}

static bool keep_copy(char **copy, const char *text)
{
    *copy = text ? strdup(text) : NULL;
    return !text || *copy;
}

rt_status rt_set_sharing(rt_session *session, const rt_sharing *wanted)
{
    SessionSharing *sharing = &session->sharing;
    store_close(sharing);
    sharing_clear(sharing);
    if (!wanted) {
        return RT_OK;
    }
    bool is_part = wanted->parts > 0;
    if (wanted->part < 0 || wanted->parts < 0 || wanted->part > wanted->parts || (is_part && wanted->part < 1) ||
        !(wanted->seconds >= 0.0) || (is_part && wanted->joined_count > 0) || (wanted->resume && !wanted->checkpoint)) {
        return RT_FAULT_USAGE;
    }
    sharing->part = is_part ? wanted->part : 1;
    sharing->parts = is_part ? wanted->parts : 1;
    sharing->is_part = is_part;
    sharing->seconds = wanted->seconds;
    sharing->resumes = wanted->resume != 0;
    sharing->joined = calloc(wanted->joined_count + 1, sizeof *sharing->joined);
    bool is_whole = sharing->joined && keep_copy(&sharing->checkpoint, wanted->checkpoint) &&
                    keep_copy(&sharing->command, wanted->command ? wanted->command : "");
    for (size_t i = 0; is_whole && i < wanted->joined_count; i++) {
        is_whole = keep_copy(&sharing->joined[sharing->joined_count++], wanted->joined[i]);
    }
    sharing->is_on = is_whole;
    return is_whole ? RT_OK : session_no_memory(session);
}

// ---- what the picture follows from

static void digest_pictures(const Scene *scene, unsigned char out[DIGEST_BYTES])
{
    Digest digest;
    digest_init(&digest);
    for (size_t i = 0; i < scene->pictures.count; i++) {
        const Picture *picture = &scene->pictures.items[i];
        const int numbers[] = {picture->width, picture->height, picture->channels, (int)picture->depth};
        size_t each = picture->depth == PICTURE_DEPTH_8 ? 1 : picture->depth == PICTURE_DEPTH_16 ? 2 : 4;
        size_t samples = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
        digest_add(&digest, numbers, sizeof numbers);
        if (picture->samples) {
            digest_add(&digest, picture->samples, samples * each);
        }
        if (picture->palette) {
            digest_add(&digest, picture->palette, PICTURE_PALETTE * sizeof *picture->palette);
        }
    }
    digest_end(&digest, out);
}

static bool make_head(const rt_session *session, PartialHead *head)
{
    const SessionSharing *sharing = &session->sharing;
    unsigned char digest[DIGEST_BYTES] = {0};
    char text[DIGEST_TEXT], files[DIGEST_TEXT + 32] = "", part[32] = "";
    size_t count = sharing->is_sent ? sharing->file_count : source_map_digest(session->sources, digest);
    if (sharing->is_sent) {
        memcpy(digest, sharing->files, sizeof digest);
    }
    if (count > 0) {
        digest_text(digest, text);
        snprintf(files, sizeof files, "%zu, %s", count, text);
    }
    if (sharing->is_part) {
        snprintf(part, sizeof part, "%d/%d", sharing->part, sharing->parts);
    }
    digest_text(session->scene_digest, text);
    bool is_whole = partial_head_set(head, PARTIAL_SCENE, text);
    digest_pictures(&session->scene, digest);
    digest_text(digest, text);
    return is_whole && partial_head_set(head, PARTIAL_PICTURES, text) && partial_head_set(head, PARTIAL_FILES, files) &&
           partial_head_set(head, PARTIAL_VERSION, rt_version()) &&
           partial_head_set(head, PARTIAL_OPTIONS, session->provenance) &&
           partial_head_set(head, PARTIAL_COMMAND, sharing->command ? sharing->command : "") &&
           partial_head_set(head, PARTIAL_PART, part);
}

// ---- files

// False when it cannot be used, which is reported.
static bool report_read(rt_session *session, PartialResult result, const char *path)
{
    if (result == PARTIAL_NO_MEMORY) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory reading `%s`", path);
    } else if (result == PARTIAL_NO_PARTIAL) {
        diag_report(&session->diags, DIAG_E0520, SPAN_NONE, "`%s` is no file of partial results of this version", path);
    } else if (result != PARTIAL_OK) {
        diag_report(&session->diags, DIAG_E0520, SPAN_NONE, "cannot read `%s`: %s", path,
                    strerror(result == PARTIAL_NONE ? ENOENT
                             : errno                ? errno
                                                    : EIO));
    }
    return result == PARTIAL_OK;
}

// Whether results of `head` are of the picture of `own`; reports why not. They are in the file of that name.
static bool results_fit(rt_session *session, const char *name, const PartialHead *head, const PartialHead *own)
{
    PartialField field = partial_head_differs(head, own);
    if (field == PARTIAL_RESULTS) {
        return true;
    }
    bool is_kept = diag_report(&session->diags, DIAG_E0712, SPAN_NONE, "%s results of another picture: %s", name,
                               partial_difference(field));
    if (is_kept && (field == PARTIAL_OPTIONS || field == PARTIAL_VERSION)) {
        diag_suggest(&session->diags, "there: %s; here: %s", head->fields[field], own->fields[field]);
    }
    return false;
}

static bool file_fits(rt_session *session, const char *path, const PartialHead *head, const PartialHead *own)
{
    TextBuffer name;
    text_init(&name);
    text_printf(&name, "`%s` holds", path);
    bool fits = results_fit(session, text_get(&name), head, own);
    text_fini(&name);
    return fits;
}

// ---- parts

static bool fail_part(rt_session *session, DiagCode code, const char *path, const char *what)
{
    diag_report(&session->diags, code, SPAN_NONE, "`%s` %s", path, what);
    return false;
}

// `paths` has the file of each part that was read, and room for as many as there are files.
static bool part_fits(rt_session *session, const Partial *file, const char *path, int *parts, const char **paths)
{
    int part, all;
    char what[128];
    if (!file->is_complete || file->is_broken) {
        return fail_part(session, DIAG_E0520, path, "is not whole: bytes are missing, or others than were written");
    }
    if (!partial_head_part(&file->head, &part, &all)) {
        return fail_part(session, DIAG_E0520, path, "is a checkpoint, not a part of a picture");
    }
    if (*parts > 0 && all != *parts) {
        snprintf(what, sizeof what, "is a part of %d, where `%.80s` is one of %d", all, session->sharing.joined[0],
                 *parts);
        return fail_part(session, DIAG_E0713, path, what);
    }
    *parts = all;
    if ((size_t)part <= session->sharing.joined_count && paths[part - 1]) {
        snprintf(what, sizeof what, "is part %d, and so is `%.80s`", part, paths[part - 1]);
        return fail_part(session, DIAG_E0713, path, what);
    }
    if ((size_t)part <= session->sharing.joined_count) {
        paths[part - 1] = path;
    }
    return true;
}

static bool parts_are_all(rt_session *session, int parts, const char *const *paths)
{
    TextBuffer missing;
    int count = 0;
    text_init(&missing);
    for (int i = 0; i < parts && count < 16; i++) {
        if ((size_t)i >= session->sharing.joined_count || !paths[i]) {
            text_printf(&missing, count++ ? ", %d" : "%d", i + 1);
        }
    }
    if (count > 0) {
        diag_report(&session->diags, DIAG_E0713, SPAN_NONE, "of %d parts these are missing: %s%s", parts,
                    text_get(&missing), count == 16 ? ", …" : "");
    }
    text_fini(&missing);
    return count == 0;
}

// The parts, into a store that has the head of this picture.
static bool read_parts(rt_session *session, Store *store)
{
    const SessionSharing *sharing = &session->sharing;
    int parts = 0, count = (int)sharing->joined_count, read = 0;
    Partial *files = calloc((size_t)count, sizeof *files);
    const char **paths = calloc((size_t)count, sizeof *paths);
    bool fine = files && paths;
    if (!fine) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory joining parts");
    }
    for (int i = 0; fine && i < count; i++) {
        const char *path = sharing->joined[i];
        fine = report_read(session, partial_read(&files[i], path), path);
        read += fine;
        fine = fine && file_fits(session, path, &files[i].head, &store->head) &&
               part_fits(session, &files[i], path, &parts, paths);
    }
    fine = fine && parts_are_all(session, parts, paths);
    if (fine) {
        fine = store_know(store, files, count);
    } else {
        for (int i = 0; i < read; i++) {
            partial_fini(&files[i]);
        }
    }
    free(paths);
    free(files);
    return fine;
}

// ---- checkpoints

// Takes what a checkpoint has; there may be none, as at the beginning of a job.
static bool read_checkpoint(rt_session *session, Store *store)
{
    const char *path = session->sharing.checkpoint;
    Partial file;
    PartialResult result = partial_read(&file, path);
    if (result == PARTIAL_NONE) {
        return true;
    }
    if (!report_read(session, result, path)) {
        return false;
    }
    if (!file_fits(session, path, &file.head, &store->head)) {
        partial_fini(&file);
        return false;
    }
    if (strcmp(file.head.fields[PARTIAL_PART], store->head.fields[PARTIAL_PART]) != 0) {
        diag_report(&session->diags, DIAG_E0712, SPAN_NONE, "`%s` holds results of another part: `%s`", path,
                    file.head.fields[PARTIAL_PART]);
        partial_fini(&file);
        return false;
    }
    if (file.is_broken) {
        diag_report(&session->diags, DIAG_W0503, SPAN_NONE,
                    "`%s` is not whole: what follows its first %zu results is "
                    "traced again",
                    path, file.records.count);
    }
    return store_know(store, &file, 1);
}

static bool keep_checkpoint(rt_session *session, Store *store)
{
    ImageError error;
    if (store_keep(store, session->sharing.checkpoint, session->sharing.seconds, &error)) {
        return true;
    }
    (void)session_image_fault(session, IMAGE_IO, session->sharing.checkpoint, &error);
    return false;
}

// ---- the picture

// What cannot be made of parts, each of which knows of no other.
static bool part_is_possible(rt_session *session)
{
    const SamplingOptions *sampling = &session->sampling;
    const char *what = !session->sharing.is_part      ? NULL
                       : sampling->target_error > 0.0 ? "the rounds of `--target-error` follow from the whole picture"
                       : sampling->time_limit > 0.0   ? "the rounds of `--time-limit` follow from the whole picture"
                       : sampling->is_adaptive        ? "the rounds of `--adaptive` follow from the whole picture"
                                                      : NULL;
    if (what) {
        diag_report(&session->diags, DIAG_E0703, SPAN_NONE, "`--part` cannot be combined with that: %s", what);
        diag_suggest(&session->diags, "give `--samples=N` alone, or share the picture by `--mpi`");
    }
    return !what;
}

static bool share_is_possible(rt_session *session)
{
    if (session->method != RT_METHOD_BACKWARD) {
        diag_report(&session->diags, DIAG_E0703, SPAN_NONE, "photons of `--method` cannot be shared or kept");
        diag_suggest(&session->diags, "leave out `--method`, or `--part`, `--join`, `--checkpoint` and `--mpi`");
        return false;
    }
    if (!session->provenance || !session->has_digest) {
        diag_report(&session->diags, DIAG_E0709, SPAN_NONE,
                    "rt_set_sharing wants rt_set_provenance before the scene is loaded");
        return false;
    }
    return part_is_possible(session);
}

// The store of the picture that is loaded, with its head. False: out of memory.
static bool open_store(rt_session *session)
{
    SessionSharing *sharing = &session->sharing;
    store_close(sharing);
    sharing->has_store = store_init(&sharing->store);
    return sharing->has_store && make_head(session, &sharing->store.head);
}

static void report_rank(rt_session *session, int rank, PartialField differs, const PartialHead *head)
{
    if (differs == PARTIAL_RESULTS) {
        diag_report(&session->diags, DIAG_E0522, SPAN_NONE, "rank %d of %d cannot draw the scene", rank,
                    session->sharing.ranks.ranks);
    } else if (diag_report(&session->diags, DIAG_E0712, SPAN_NONE, "rank %d of %d would draw another picture: %s", rank,
                           session->sharing.ranks.ranks, partial_difference(differs))) {
        diag_suggest(&session->diags, "rank 0 has rtlang %s", head->fields[PARTIAL_VERSION]);
    }
}

rt_status rt_agree_with_ranks(rt_session *session, rt_status status, int *first)
{
    SessionSharing *sharing = &session->sharing;
    PartialField differs = PARTIAL_FIELDS;
    *first = -1;
    if (!sharing->has_ranks) {
        return status;
    }
    if (sharing->has_scene && !session_scene_read(session)) {
        status = status ? status : session_status(session, false);
    }
    if (!status && !share_is_possible(session)) {
        status = session_status(session, false);
    }
    if (!status && !open_store(session)) {
        status = session_no_memory(session);
    }
    int rank = *first = ranks_agree(&sharing->ranks, status == RT_OK, &sharing->store.head, &differs);
    if (rank > 0 && sharing->ranks.rank == 0) { // where it is rank 0, that has said why
        report_rank(session, rank, differs, &sharing->store.head);
        status = session_status(session, false);
    }
    status = rt_worst_of_ranks(session, status);
    if (!status && sharing->has_scene) {
        status = rt_worst_of_ranks(session, session_status(session, session_scene_agree(session)));
    }
    return status;
}

rt_status session_sharing_begin(rt_session *session)
{
    SessionSharing *sharing = &session->sharing;
    Store *store = &sharing->store;
    if (!sharing->is_on && !sharing->has_ranks) {
        return RT_OK;
    }
    if (!share_is_possible(session)) {
        return session_status(session, false);
    }
    if (!open_store(session)) {
        return session_no_memory(session);
    }
    if (sharing->has_ranks && sharing->ranks.rank > 0) { // which keeps nothing
        ranks_use(&sharing->ranks, store);
        return RT_OK;
    }
    bool fine = (sharing->joined_count == 0 || read_parts(session, store)) &&
                (!sharing->resumes || read_checkpoint(session, store)) &&
                (!sharing->checkpoint || keep_checkpoint(session, store));
    if (sharing->has_ranks) {
        ranks_use(&sharing->ranks, store);
    } else {
        alone_init(&sharing->alone, store, sharing->part, sharing->parts);
        store->keeps_all = sharing->is_part;
    }
    return session_status(session, fine);
}

const TileShare *session_sharing_table(const rt_session *session)
{
    const SessionSharing *sharing = &session->sharing;
    return !sharing->has_store ? NULL : sharing->has_ranks ? &sharing->ranks.table : &sharing->alone.table;
}

void session_sharing_report(rt_session *session)
{
    const SessionSharing *sharing = &session->sharing;
    const Store *store = &sharing->store;
    if (sharing->has_ranks && sharing->ranks.rank > 0) {
        return; // rank 0 knows and reports
    }
    if (store->fault == STORE_NOT_WRITTEN) {
        diag_report(&session->diags, DIAG_E0505, SPAN_NONE, "cannot write `%s`: %s", store->path,
                    strerror(store->error));
    } else if (store->fault == STORE_MISFIT) {
        diag_report(&session->diags, DIAG_E0520, SPAN_NONE, "`%s` holds what no tile of this picture can have left",
                    sharing->joined_count > 0 ? sharing->joined[0] : sharing->checkpoint);
    } else {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory keeping results");
    }
}

rt_status rt_write_part(rt_session *session, const char *path)
{
    SessionSharing *sharing = &session->sharing;
    ImageError error;
    if (!session->rendered || !sharing->has_store || !sharing->is_part) {
        return RT_FAULT_USAGE;
    }
    bool is_written = store_write_part(&sharing->store, path, &error);
    return session_image_fault(session, is_written ? IMAGE_OK : IMAGE_IO, path, &error);
}

rt_status rt_read_command(rt_session *session, const char *path, const char **command)
{
    Partial file;
    text_clear(&session->note);
    *command = "";
    if (!report_read(session, partial_read(&file, path), path)) {
        return session_status(session, false);
    }
    text_append(&session->note, file.head.fields[PARTIAL_COMMAND]);
    partial_fini(&file);
    *command = text_get(&session->note);
    return session->note.failed ? session_no_memory(session) : RT_OK;
}
