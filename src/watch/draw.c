// The steps of a save: the scene is read, a small picture shows that it was, and whole ones follow, each with half the
// error of the one before, until the goal or the time is reached.
//
// Each picture is drawn from its beginning; half the error takes up to four times the time, so that all before it took
// no more than a third of its time where it is long.
//
// SPDX-License-Identifier: MIT
#include "watch/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "base/json.h"

// A small picture has so many pixels, whatever the whole one has, so that it is there at once.
enum { COARSE_PIXELS = 5000, COARSE_SAMPLES = 2, SAID_MOST = 1 << 16, MESSAGES_MOST = 50 };
static const double REPORT_SECONDS = 0.1;         // between reports of progress
static const double GOAL = 0.002, LIMIT = 60.0; // where nothing was said
static const double FIRST_GOAL = 16.0;          // times the last one, of the first whole picture

typedef struct Draw {
    const WatchJob *job;
    Board *board;
    Sentry *sentry;
    rt_session *session;
    uint64_t save;
    double begun, reported; // by the clock
    bool is_first;      // warnings come with the first picture; later ones would repeat them
    bool is_whole;      // progress is reported of whole pictures
    int message_count;
} Draw;

// ---- what a session says

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    static const char *const severities[] = {[RT_WARNING] = "warning", [RT_ERROR] = "error", [RT_NOTE] = "note"};
    Draw *draw = client;
    if ((diagnostic->severity != RT_ERROR && !draw->is_first) || draw->message_count == MESSAGES_MOST) {
        return;
    }
    board_lock(draw->board);
    TextBuffer *out = &draw->board->messages;
    text_printf(out,
                "%s{\"severity\":\"%s\",\"code\":\"%s\",\"line\":%llu,\"file\":", draw->message_count++ > 0 ? "," : "",
                severities[diagnostic->severity], diagnostic->code, (unsigned long long)diagnostic->line);
    json_string(out, diagnostic->file ? diagnostic->file : "", diagnostic->file ? strlen(diagnostic->file) : 0);
    text_append(out, ",\"text\":");
    json_string(out, diagnostic->text, strlen(diagnostic->text));
    text_append(out, "}");
    board_unlock(draw->board);
}

static void on_message(void *client, rt_stream stream, const char *text, size_t length)
{
    Draw *draw = client;
    TextBuffer *said = &draw->board->said;
    (void)stream;
    board_lock(draw->board);
    size_t room = SAID_MOST - said->length;
    text_append_n(said, text, length < room ? length : room);
    board_unlock(draw->board);
}

static void on_progress(void *client, double done)
{
    Draw *draw = client;
    double now = clock_seconds();
    rt_error error;
    if (!draw->is_whole || now - draw->reported < REPORT_SECONDS) {
        return;
    }
    draw->reported = now;
    rt_get_error(draw->session, &error);
    board_lock(draw->board);
    draw->board->done = done;
    draw->board->seconds_left = error.seconds_left;
    board_change(draw->board);
}

// ---- files

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

// The scene's files; after a fault the folders of these and of include files, too, where one that was missed may come.
static bool watch_files(Draw *draw, bool has_fault, int64_t begun)
{
    ARRAY(const char *) paths = {0};
    const char *path, *slash = strrchr(draw->job->scene, '/');
    char *folder = slash ? strndup(draw->job->scene, (size_t)(slash - draw->job->scene) + 1) : strdup(".");
    bool fine = folder && ARRAY_PUSH(&paths, draw->job->scene);
    for (size_t i = 0; fine && (path = rt_scene_file(draw->session, i)); i++) {
        fine = ARRAY_PUSH(&paths, path);
    }
    for (size_t i = 0; fine && has_fault && (path = rt_include_path(draw->session, i)); i++) {
        fine = ARRAY_PUSH(&paths, path);
    }
    fine = fine && (!has_fault || ARRAY_PUSH(&paths, folder));
    size_t count = 0;
    if (fine) {
        qsort(paths.items, paths.count, sizeof *paths.items, compare_paths);
    }
    for (size_t i = 0; fine && i < paths.count; i++) {
        if (count == 0 || strcmp(paths.items[count - 1], paths.items[i]) != 0) {
            paths.items[count++] = paths.items[i];
        }
    }
    fine = fine && sentry_set_files(draw->sentry, paths.items, count, begun);
    ARRAY_FREE(&paths);
    free(folder);
    return fine;
}

// ---- pictures

// Puts what was rendered on the board. A coarse one says nothing of its error.
static rt_status show(Draw *draw, bool is_coarse)
{
    const unsigned char *bytes;
    size_t length;
    rt_status status = rt_get_png(draw->session, &(rt_output){.depth = RT_DEPTH_8}, &bytes, &length);
    Board *board = draw->board;
    if (status) {
        return status;
    }
    board_lock(board);
    bool fine = board_set_picture(&board->picture, bytes, length, draw->save);
    double seconds = clock_seconds() - draw->begun;
    board->is_coarse = is_coarse;
    board->first_seconds = board->first_seconds > 0.0 ? board->first_seconds : seconds;
    rt_get_error(draw->session, &board->error);
    if (!is_coarse && board->error.known && board->point_count < BOARD_POINTS) {
        board->points[board->point_count++] = (BoardPoint){seconds, board->error.rmse, board->error.samples};
    }
    board_change(board);
    return fine ? RT_OK : RT_FAULT_LIMIT;
}

static rt_status draw_coarse(Draw *draw)
{
    const WatchJob *job = draw->job;
    double shrink = fmax(sqrt((double)job->width * job->height / COARSE_PIXELS), 1.0);
    int width = (int)fmax(job->width / shrink, 1.0), height = (int)fmax(job->height / shrink, 1.0);
    rt_sampling sampling = {.sampler = job->sampling.sampler,
                            .filter = job->sampling.filter,
                            .seed = job->sampling.seed,
                            .samples = COARSE_SAMPLES,
                            .no_estimate = 1};
    rt_status status = rt_set_size(draw->session, width, height);
    status = status ? status : rt_set_sampling(draw->session, &sampling);
    status = status ? status : rt_render(draw->session, job->threads);
    return status ? status : show(draw, true);
}

// Seconds that drawing may still take.
static double seconds_left(const Draw *draw)
{
    double limit = draw->job->sampling.time_limit > 0.0 ? draw->job->sampling.time_limit : LIMIT;
    return limit - (clock_seconds() - draw->begun);
}

static rt_status draw_whole(Draw *draw, double goal)
{
    rt_sampling sampling = draw->job->sampling;
    sampling.adaptive = 1;
    sampling.no_pixel_errors = 1;
    sampling.target_error = goal;
    sampling.time_limit = fmax(seconds_left(draw), REPORT_SECONDS);
    rt_status status = rt_set_sampling(draw->session, &sampling);
    status = status ? status : rt_render(draw->session, draw->job->threads);
    return status ? status : show(draw, false);
}

// A picture that would be broken off with hardly more samples than the last has is not begun.
static rt_status draw_better(Draw *draw)
{
    const double target = draw->board->target;
    rt_status status = rt_set_size(draw->session, draw->job->width, draw->job->height);
    bool is_enough = false;
    draw->is_whole = true;
    for (double goal = FIRST_GOAL * target, last = 0.0; !status && !is_enough && 1.5 * last < seconds_left(draw);) {
        rt_error error;
        double begun = clock_seconds();
        status = draw_whole(draw, goal);
        last = clock_seconds() - begun;
        rt_get_error(draw->session, &error);
        is_enough = error.end != RT_END_TARGET || (error.known && error.high <= target);
        goal = fmax(fmin(goal, error.high) / 2.0, target);
    }
    return status;
}

// ---- a save

// Nothing of an older save stays but its picture.
static void begin(Draw *draw)
{
    Board *board = draw->board;
    board_lock(board);
    draw->save = ++board->save;
    board->begun = draw->begun;
    board->state = BOARD_READING;
    board->first_seconds = board->done = 0.0;
    board->seconds_left = -1.0;
    board->point_count = 0;
    text_clear(&board->messages);
    text_clear(&board->said);
    board_change(board);
}

static void set_state(Draw *draw, BoardState state)
{
    board_lock(draw->board);
    draw->board->state = state;
    board_change(draw->board);
}

static void draw_save(Draw *draw)
{
    const WatchJob *job = draw->job;
    rt_callbacks callbacks = {draw, on_diagnostic, on_message, on_progress};
    rt_session *session = draw->session = rt_session_new(&callbacks);
    int64_t begun = sentry_wall_clock();
    draw->begun = sentry_begin(draw->sentry, session);
    draw->is_first = true;
    draw->is_whole = false;
    draw->message_count = 0;
    begin(draw);
    rt_status status = session ? job->configure(session, job->client) : RT_FAULT_LIMIT;
    if (!status) {
        status = rt_load_file(session, job->scene);
        status = watch_files(draw, status != RT_OK, begun) ? status : RT_FAULT_LIMIT;
    }
    if (!status) {
        set_state(draw, BOARD_DRAWING);
        status = draw_coarse(draw);
        draw->is_first = false;
    }
    status = status ? status : draw_better(draw);
    if (status != RT_CANCELLED) {
        set_state(draw, status ? BOARD_FAULT : BOARD_DONE);
    }
    sentry_end(draw->sentry);
    rt_session_free(session);
    draw->session = NULL;
}

void draw_until_end(const WatchJob *job, Board *board, Sentry *sentry)
{
    Draw draw = {.job = job, .board = board, .sentry = sentry};
    board->target = job->sampling.target_error > 0.0 ? job->sampling.target_error : GOAL;
    do {
        draw_save(&draw);
    } while (sentry_wait(sentry));
}
