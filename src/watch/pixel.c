// A second session, loaded when somebody asks, so that no picture waits for a click and no click for a picture.
//
// SPDX-License-Identifier: MIT
#include "watch/pixel.h"

#include <string.h>

#include "base/json.h"

void pixel_init(Pixel *pixel, const WatchJob *job)
{
    *pixel = (Pixel){.job = job};
    pthread_mutex_init(&pixel->lock, NULL);
    pthread_mutex_init(&pixel->guard, NULL);
}

void pixel_fini(Pixel *pixel)
{
    rt_session_free(pixel->session);
    pthread_mutex_destroy(&pixel->lock);
    pthread_mutex_destroy(&pixel->guard);
}

void pixel_cancel(Pixel *pixel)
{
    pthread_mutex_lock(&pixel->guard);
    pixel->is_over = true;
    if (pixel->session) {
        rt_cancel(pixel->session);
    }
    pthread_mutex_unlock(&pixel->guard);
}

static rt_session *open_session(Pixel *pixel)
{
    static const rt_callbacks none = {0};
    pthread_mutex_lock(&pixel->guard);
    rt_session_free(pixel->session);
    pixel->session = pixel->is_over ? NULL : rt_session_new(&none);
    pthread_mutex_unlock(&pixel->guard);
    return pixel->session;
}

static rt_status load(Pixel *pixel, uint64_t save)
{
    const WatchJob *job = pixel->job;
    rt_session *session = open_session(pixel);
    pixel->save = save;
    rt_status status = session ? job->configure(session, job->client) : RT_FAULT_LIMIT;
    return status ? status : rt_load_file(session, job->scene);
}

bool pixel_trace(Pixel *pixel, uint64_t save, int x, int y, TextBuffer *out)
{
    const char *text;
    pthread_mutex_lock(&pixel->lock);
    if (!pixel->session || pixel->save != save) {
        pixel->status = load(pixel, save);
    }
    rt_session *session = pixel->session;
    bool fine = !pixel->status;
    if (fine) {
        rt_set_format(session, RT_FORMAT_JSON);
        fine = rt_trace_pixel(session, x, y, &text) == RT_OK;
    }
    if (fine) {
        text_append(out, "{\"log\":");
        text_append(out, text);
        rt_set_format(session, RT_FORMAT_TEXT);
        fine = rt_trace_pixel(session, x, y, &text) == RT_OK;
    }
    if (fine) {
        text_append(out, ",\"text\":");
        json_string(out, text, strlen(text));
        text_append(out, "}");
    }
    pthread_mutex_unlock(&pixel->lock);
    return fine && !out->failed;
}
