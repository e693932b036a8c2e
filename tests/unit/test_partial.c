// Checkpoints with bytes that nothing wrote: a run that continues from one makes the same picture or is refused, and
// never ends in a signal. Also those whose checks are right: what a record holds is then as wrong as it can be.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "rtlang/sharing.h"
#include "share/partial.h"
#include "tests/unit/tap.h"

enum { WIDTH = 40, HEIGHT = 33, PATH = 64 };

static const char scene[] =
    "#version 3.7; global_settings { assumed_gamma 1 }\n"
    "camera { location <0, 1, -6> look_at 0 }\n"
    "light_source { <5, 8, -6> rgb 1 area_light x, y, 2, 2 }\n"
    "sphere { <0.6, 0, 0>, 1 pigment { rgbt <1, 1, 1, 0.8> } interior { ior 1.5 } finish { specular 1 roughness 0.001 "
    "} }\n"
    "#declare I = 0; #while (I < 30) sphere { <mod(I * 0.37, 4) - 2, mod(I * 0.61, 2) - 0.9, 1>, 0.02\n"
    "  pigment { rgb <1, 0.6, 0.3> } } #declare I = I + 1; #end\n"
    "plane { y, -1 pigment { rgb 0.7 } }\n";

typedef struct Way {
    const char *name;
    rt_sampling sampling;
    rt_antialias antialias;
} Way;

static const Way ways[] = {
    {.name = "one ray"},
    {.name = "anti-aliasing", .antialias = {.method = 1, .depth = 2, .threshold = 0.1, .gamma = 2.5}},
    {.name = "samples", .sampling = {.samples = 16.0}},
    {.name = "a goal", .sampling = {.target_error = 0.03, .samples = 40.0}},
    {.name = "adaptive", .sampling = {.samples = 6.0, .adaptive = 1, .filter = "tent"}},
};
enum { WAYS = RT_COUNT_OF(ways) };

static void forget(void *client, const rt_diagnostic *diagnostic)
{
    (void)client, (void)diagnostic;
}

// The PNG of a run that keeps a checkpoint, to be freed; NULL and *status: it was refused.
static unsigned char *draw(const Way *way, const char *path, bool resumes, size_t *size, rt_status *status)
{
    rt_callbacks callbacks = {.diagnostic = forget};
    rt_session *session = rt_session_new(&callbacks);
    rt_sharing sharing = {.checkpoint = path, .resume = resumes};
    const unsigned char *png;
    unsigned char *copy = NULL;
    *status = rt_set_size(session, WIDTH, HEIGHT);
    *status = *status ? *status : rt_set_sampling(session, &way->sampling);
    *status = *status ? *status : rt_set_antialias(session, &way->antialias);
    *status = *status ? *status : rt_set_provenance(session, way->name);
    *status = *status ? *status : rt_load_text(session, "scene.scn", scene, sizeof scene - 1);
    *status = *status ? *status : rt_set_sharing(session, &sharing);
    *status = *status ? *status : rt_render(session, 1);
    if (!*status && rt_get_png(session, &(rt_output){.depth = RT_DEPTH_16}, &png, size) == RT_OK) {
        copy = malloc(*size);
        memcpy(copy, png, *size);
    }
    rt_session_free(session);
    return copy;
}

static uint32_t next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static void change(unsigned char *bytes, size_t size, uint32_t *state)
{
    static const unsigned char odd[] = {0, 1, 0x7f, 0x80, 0xff};
    for (uint32_t i = next(state) % 4 + 1; i > 0 && size > 0; i--) {
        size_t at = next(state) % size;
        bytes[at] = next(state) % 2 ? odd[next(state) % sizeof odd] : (unsigned char)next(state);
    }
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        abort();
    }
}

// Some bytes of the file, or its end.
static void break_bytes(const char *path, const Partial *whole, const char *bytes, size_t size, uint32_t *state)
{
    unsigned char *copy = malloc(size);
    (void)whole;
    memcpy(copy, bytes, size);
    bool is_cut = next(state) % 2;
    if (!is_cut || next(state) % 2) {
        change(copy, size, state);
    }
    write_file(path, copy, is_cut ? next(state) % size : size);
    free(copy);
}

// What a record says, under a check that is right.
static void break_records(const char *path, const Partial *whole, const char *bytes, size_t size, uint32_t *state)
{
    TextBuffer file;
    size_t chosen = next(state) % whole->records.count;
    (void)bytes, (void)size;
    text_init(&file);
    partial_append_head(&file, &whole->head);
    for (size_t i = 0; i < whole->records.count; i++) {
        PartialRecord record = whole->records.items[i];
        unsigned char *copy = malloc(record.length + 64);
        memcpy(copy, record.bytes, record.length);
        if (i == chosen || next(state) % 16 == 0) {
            uint32_t what = next(state) % 8;
            record.pass += what == 0 ? next(state) % 3 - 1 : 0;
            record.tile = what == 1 ? (next(state) % 2 ? next(state) : next(state) % 8) : record.tile;
            record.length = what == 2 ? next(state) % (record.length + 1) : record.length;
            if (what > 2) {
                change(copy, record.length, state);
            }
        }
        record.bytes = copy;
        partial_append(&file, &record);
        free(copy);
    }
    write_file(path, file.text, file.length);
    text_fini(&file);
}

static unsigned char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = malloc(1 << 24);
    *size = file ? fread(bytes, 1, 1 << 24, file) : 0;
    if (file) {
        fclose(file);
    }
    return bytes;
}

typedef void Breaks(const char *path, const Partial *whole, const char *bytes, size_t size, uint32_t *state);

// Of files that are broken in some way: how many were refused, and how many gave another picture.
static void try_broken(const Way *way, Breaks *breaks, const char *path, int turns, int *refused, int *others)
{
    size_t size, whole_size, file_size;
    rt_status status;
    uint32_t state = 12345;
    unsigned char *expected = draw(way, path, false, &size, &status);
    unsigned char *bytes = read_file(path, &file_size);
    Partial whole;
    if (!expected || partial_read(&whole, path) != PARTIAL_OK) {
        abort();
    }
    for (int i = 0; i < turns; i++) {
        breaks(path, &whole, (const char *)bytes, file_size, &state);
        unsigned char *png = draw(way, path, true, &whole_size, &status);
        *refused += png == NULL;
        *others += png && (whole_size != size || memcmp(png, expected, size) != 0);
        free(png);
    }
    partial_fini(&whole);
    free(bytes);
    free(expected);
}

int main(void)
{
    char path[PATH];
    snprintf(path, sizeof path, "test_partial.%ld", (long)getpid());
    const char *turns_text = getenv("TURNS");
    int turns = turns_text ? atoi(turns_text) : 200;
    for (int i = 0; i < WAYS; i++) {
        size_t size = 0, again = 0;
        rt_status status, second;
        int refused = 0, others = 0;
        unsigned char *one = draw(&ways[i], path, false, &size, &status),
                      *other = draw(&ways[i], path, true, &again, &second);
        tap_ok(one && other && size == again && memcmp(one, other, size) == 0, "%s: continued from its end",
               ways[i].name);
        free(one);
        free(other);
        try_broken(&ways[i], break_bytes, path, turns, &refused, &others);
        tap_ok(others == 0 && refused < turns, "%s: %d files with other bytes, %d of them refused: the same picture",
               ways[i].name, turns, refused);
        refused = 0;
        try_broken(&ways[i], break_records, path, turns, &refused, &others);
        tap_ok(refused > 0, "%s: %d files with wrong records and right checks, %d of them refused", ways[i].name, turns,
               refused);
    }
    unlink(path);
    return tap_done();
}
