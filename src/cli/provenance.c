// Options as text and back, and the comparison of two files of pictures.
//
// SPDX-License-Identifier: MIT
#include "cli/provenance.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "cli/option_table.h"

static const char options_note[] = "rtlang:options";

// ---- options as text

void provenance_put_word(FILE *out, const char *word)
{
    if (ftell(out) > 0) {
        putc(' ', out);
    }
    for (const char *at = word; *at; at++) {
        if (*at == ' ' || *at == '\\') {
            putc('\\', out);
        }
        putc(*at, out);
    }
}

// One word, `--name=value`.
__attribute__((format(printf, 2, 3))) static void put(FILE *out, const char *format, ...)
{
    char word[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(word, sizeof word, format, arguments);
    va_end(arguments);
    provenance_put_word(out, word);
}

static void put_text(FILE *out, const char *name, const char *value)
{
    if (value) {
        put(out, "--%s=%s", name, value);
    }
}

static void put_flag(FILE *out, const char *name, bool is_on)
{
    if (is_on) {
        put(out, "--%s", name);
    }
}

static void put_picture(FILE *out, const Options *options)
{
    static const char *const depths[] = {
        [RT_DEPTH_AUTO] = NULL, [RT_DEPTH_8] = "8", [RT_DEPTH_16] = "16", [RT_DEPTH_FLOAT] = "float"};
    const int *crop = options->crop;
    put(out, "--width=%d", options->width);
    put(out, "--height=%d", options->height);
    if (crop[2] > 0) {
        put(out, "--crop=%d,%d,%d,%d", crop[0], crop[1], crop[2], crop[3]);
        put_flag(out, "whole", options->encoding.whole);
    }
    put_text(out, "depth", depths[options->encoding.depth]);
    if (options->encoding.file_gamma > 0.0) {
        put(out, "--file-gamma=%.17g", options->encoding.file_gamma);
    }
    put_flag(out, "alpha", options->has_alpha);
    const struct {
        const char *name;
        double value;
    } light[] = {{"sky-light", options->sky_light}, {"outline", options->outline}, {"depth-cue", options->depth_cue}};
    for (size_t i = 0; i < RT_COUNT_OF(light); i++) {
        if (light[i].value > 0.0) {
            put(out, "--%s=%.17g", light[i].name, light[i].value);
        }
    }
    for (size_t i = 0; i < option_plane_count; i++) {
        if (options->encoding.planes & option_planes[i].plane) {
            put_text(out, "planes", option_planes[i].name);
        }
    }
}

static void put_sampling(FILE *out, const Options *options)
{
    static const char *const methods[] = {
        [RT_METHOD_BACKWARD] = NULL, [RT_METHOD_FORWARD] = "forward", [RT_METHOD_FORWARD_CONNECT] = "forward-connect"};
    static const char *const precisions[] = {[RT_PRECISION_DOUBLE] = NULL,
                                             [RT_PRECISION_FLOAT] = "float",
                                             [RT_PRECISION_QUAD] = "quad",
                                             [RT_PRECISION_REFERENCE] = "reference"};
    const rt_sampling *sampling = &options->sampling;
    const rt_antialias *antialias = &options->antialias;
    const struct {
        const char *name;
        double value; // 0: not given
    } numbers[] = {{"samples", sampling->samples},
                   {"target-error", sampling->target_error},
                   {"time-limit", sampling->time_limit},
                   {"antialias", antialias->method},
                   {"antialias-depth", antialias->method ? antialias->depth : 0},
                   {"antialias-threshold", antialias->method ? antialias->threshold : 0.0},
                   {"antialias-gamma", antialias->method ? antialias->gamma : 0.0},
                   {"photons", options->method != RT_METHOD_BACKWARD ? (double)options->photons : 0.0}};
    for (size_t i = 0; i < RT_COUNT_OF(numbers); i++) {
        if (numbers[i].value > 0.0) {
            put(out, "--%s=%.17g", numbers[i].name, numbers[i].value);
        }
    }
    if (antialias->method && antialias->threshold == 0.0) {
        put(out, "--antialias-threshold=0");
    }
    if (sampling->seed) {
        put(out, "--seed=%llu", (unsigned long long)sampling->seed);
    }
    put_text(out, "sampler", sampling->sampler);
    put_text(out, "filter", sampling->filter);
    put_flag(out, "adaptive", sampling->adaptive);
    put_flag(out, "no-estimate", sampling->no_estimate);
    put_text(out, "method", methods[options->method]);
    put_text(out, "precision", precisions[options->precision]);
}

// A frame is a picture of its own: clock and names are given as they are in it.
static void put_scene(FILE *out, const Options *options)
{
    put_flag(out, "lenient", options->is_lenient);
    put_text(out, "header", options->header);
    if (options->frames.step) {
        char declarations[FRAMES_DECLARATIONS][FRAMES_DECLARATION_SIZE];
        put(out, "--clock=%.17g", frames_clock(&options->frames, options->frame));
        frames_declarations(&options->frames, options->frame, declarations);
        for (size_t i = 0; i < FRAMES_DECLARATIONS; i++) {
            put_text(out, "declare", declarations[i]);
        }
    } else if (options->clock_given) {
        put(out, "--clock=%.17g", options->clock);
    }
    for (int i = 0; i < options->declaration_count; i++) {
        put_text(out, "declare", options->declarations[i]);
    }
}

char *provenance_options(const Options *options, double samples)
{
    Options repeated = *options;
    rt_sampling *sampling = &repeated.sampling;
    if (samples > 0.0 && (sampling->adaptive || sampling->target_error > 0.0 || sampling->time_limit > 0.0)) {
        sampling->samples = samples;
        sampling->adaptive = 1;
        sampling->target_error = sampling->time_limit = 0.0;
    }
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    if (!out) {
        return NULL;
    }
    put_picture(out, &repeated);
    put_sampling(out, &repeated);
    put_scene(out, &repeated);
    bool is_whole = !ferror(out);
    if (fclose(out) != 0 || !is_whole) {
        free(text);
        return NULL;
    }
    return text;
}

// ---- and back

int provenance_split(char *text, char **words)
{
    int count = 0;
    char *to = text;
    for (bool is_inside = false; *text; text++) {
        if (*text == ' ') {
            *to++ = '\0';
            is_inside = false;
            continue;
        }
        if (!is_inside) {
            words[count++] = to;
            is_inside = true;
        }
        text += *text == '\\' && text[1];
        *to++ = *text;
    }
    *to = '\0';
    return count;
}

static rt_status fail(rt_session *session, const char *code, const char *advice, const char *format, const char *name,
                      const char *more)
{
    char message[COMPLAINT_SIZE];
    snprintf(message, sizeof message, format, name, more);
    return rt_report(session, code, message, advice);
}

// "picture.again.png", beside "picture.png". To be freed.
static char *name_again(const char *picture)
{
    const char *slash = strrchr(picture, '/'), *dot = strrchr(slash ? slash : picture, '.');
    int stem = dot ? (int)(dot - picture) : (int)strlen(picture);
    size_t size = strlen(picture) + sizeof ".again";
    char *name = malloc(size);
    if (name) {
        snprintf(name, size, "%.*s.again%s", stem, picture, dot ? dot : "");
    }
    return name;
}

rt_status provenance_recall(rt_session *session, int argc, char **argv, Options *options)
{
    const char *picture = options->rerun, *text;
    rt_status status = rt_read_note(session, picture, options_note, &text);
    if (status || !text) {
        return status ? status
                      : fail(session, "E0710", "pictures of other programs, and formats other than PNG and EXR, do not",
                             "`%s` does not say what it was drawn with%s", picture, "");
    }
    char *copy = strdup(text);
    char **words = copy ? calloc(strlen(copy) + (size_t)argc + 2, sizeof *words) : NULL;
    if (!words) {
        free(copy);
        return rt_report(session, "E0602", "out of memory reading options", NULL);
    }
    words[0] = argv[0];
    int count = 1 + provenance_split(copy, words + 1);
    memcpy(words + count, argv + 1, (size_t)(argc - 1) * sizeof *words);
    options_fini(options);
    OptionsResult result = options_parse(count + argc - 1, words, options);
    options->rerun_text = copy;
    options->rerun_words = words;
    if (result == OPTIONS_GO && !options->output) {
        options->output = options->rerun_output = name_again(picture);
        result = options->output ? result : OPTIONS_NO_MEMORY;
    }
    return result == OPTIONS_GO          ? RT_OK
           : result == OPTIONS_NO_MEMORY ? rt_report(session, "E0602", "out of memory reading options", NULL)
                                         : rt_report(session, "E0703", options->reading.complaint,
                                                     options->reading.advice[0] ? options->reading.advice : NULL);
}

// ---- the comparison

static bool is_note_same(rt_session *session, const char *picture, const char *again, const char *name)
{
    const char *text;
    if (rt_read_note(session, picture, name, &text)) {
        return false;
    }
    char *first = text ? strdup(text) : NULL;
    bool had_one = text != NULL;
    bool is_same = rt_read_note(session, again, name, &text) == RT_OK && (text != NULL) == had_one &&
                   (!text || (first && strcmp(first, text) == 0));
    free(first);
    return is_same;
}

// 1: the same bytes, 0: others, -1: one of them could not be read, which errno tells.
static int compare_files(const char *one, const char *other)
{
    FILE *first = fopen(one, "rbe"), *second = first ? fopen(other, "rbe") : NULL;
    int result = second ? 1 : -1;
    while (result == 1) {
        char a[4096], b[4096];
        size_t got = fread(a, 1, sizeof a, first), more = fread(b, 1, sizeof b, second);
        if (ferror(first) || ferror(second)) {
            result = -1;
        } else if (got != more || memcmp(a, b, got) != 0) {
            result = 0;
        } else if (got < sizeof a) {
            break;
        }
    }
    if (first) {
        fclose(first);
    }
    if (second) {
        fclose(second);
    }
    return result;
}

rt_status provenance_compare(rt_session *session, const char *picture, const char *again)
{
    static const struct {
        const char *note, *reason, *advice;
    } reasons[] = {
        {"Software", ": it is of another version", "that version may draw it again"},
        {"rtlang:scene", ": the scene's text is another one", "`b2sum -l 256` of a scene is what its pictures have"},
        {"rtlang:files", ": a file that the scene includes is another one", NULL},
        {options_note, ": the options are others", NULL},
    };
    errno = 0;
    int is_same = compare_files(picture, again);
    if (is_same < 0) {
        return fail(session, "E0502", NULL, "cannot read `%s`: %s", picture, strerror(errno ? errno : EIO));
    }
    if (is_same) {
        return RT_OK;
    }
    for (size_t i = 0; i < RT_COUNT_OF(reasons); i++) {
        if (!is_note_same(session, picture, again, reasons[i].note)) {
            return fail(session, "E0711", reasons[i].advice, "`%s` drawn again has other bytes%s", picture,
                        reasons[i].reason);
        }
    }
    return fail(session, "E0711", "pictures that a scene reads may have changed, or a run ended by time",
                "`%s` drawn again has other bytes%s", picture, ", of the same scene and options");
}
