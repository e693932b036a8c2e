// Options of shared runs as the library takes them, and the names of their files.
//
// SPDX-License-Identifier: MIT
#include "cli/share.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "cli/provenance.h"
#include "rtlang/sharing.h"

char *share_command(int argc, char **argv)
{
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    for (int i = 1; out && i < argc; i++) {
        provenance_put_word(out, argv[i]);
    }
    if (!out || fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static bool is_stream(const char *name)
{
    return name && name[0] == '-' && (name[1] == '\0' || name[1] == '.');
}

static OptionsResult settle_mpi(Options *options)
{
    OptionReading *reading = &options->reading;
    bool is_possible = options->action == ACTION_RENDER || (options->action == ACTION_BUDGET && options->shares_scene);
    if (!is_possible || options->rerun || options->joins || options->parts > 0) {
        return option_complain(reading, "`--mpi` is for drawing pictures, without `--part`, `--join` and `--rerun`");
    }
    if (options->is_untrusted) {
        return option_complain(reading, "`--mpi` is not for scenes of strangers: ranks are not confined");
    }
    for (int i = 0; i < options->scene_count; i++) {
        if (is_stream(options->scenes[i])) {
            return option_complain(reading, "`--mpi` wants the scene in a file, which each rank reads");
        }
    }
    if (options->shares_scene && options->frames.step) {
        return option_complain(reading, "`--mpi=scene` is for one picture: frames are dealt by `--mpi`");
    }
    if (options->has_one_reader && (options->shares_scene || options->frames.step)) {
        return option_complain(reading, "`--mpi-read=one` is for one picture, of a scene that each rank holds");
    }
    if (options->frames.step && is_stream(options->output)) {
        return option_complain(reading, "`--mpi` deals frames over ranks: each wants a file of its own");
    }
    options->is_unconfined = true; // the ranks talk by whatever their MPI uses
    return OPTIONS_GO;
}

OptionsResult share_settle(Options *options)
{
    OptionReading *reading = &options->reading;
    if (options->has_one_reader && !options->has_mpi) {
        return option_complain(reading, "`--mpi-read` is of `--mpi`");
    }
    if (options->has_mpi && settle_mpi(options) != OPTIONS_GO) {
        return OPTIONS_WRONG;
    }
    bool is_part = options->parts > 0, keeps = share_keeps(options);
    if (options->joins && (is_part || keeps)) {
        return option_complain(reading, "`--join` puts together what is traced: leave out `--part`, `--checkpoint` and "
                                        "`--resume`");
    }
    if (options->joins) {
        options->joined = options->scenes;
        options->joined_count = options->scene_count;
        return OPTIONS_GO;
    }
    if (!is_part && !keeps) {
        return OPTIONS_GO;
    }
    const char *name = is_part ? "--part" : "--checkpoint";
    if (options->action != ACTION_RENDER || options->rerun) {
        return option_complain(reading, "`%s` is for drawing pictures", name);
    }
    if (is_part && options->frames.step) {
        return option_complain(reading, "`--part` is of one picture: give each job frames of its own by `--frames`");
    }
    if (is_part && (options->scene_count > 1 || options->error_map)) {
        return option_complain(reading, "`--part` is of one picture of one scene: leave out other scenes, and give "
                                        "`--error-map` to `--join`");
    }
    for (int i = 0; i < options->scene_count; i++) {
        if (is_stream(options->scenes[i]) || is_stream(options->output) || options->has_no_output) {
            return option_complain(reading, "`%s` wants scene and picture in files", name);
        }
    }
    return OPTIONS_GO;
}

// ---- --join

static rt_status read_command(rt_session *session, Options *options, Options *given, Povray *povray, Voice *voice,
                              OptionsResult *result)
{
    const char *command;
    rt_status status = rt_read_command(session, given->joined[0], &command);
    char *copy = status ? NULL : strdup(command);
    char **words = copy ? calloc(strlen(copy) + 2, sizeof *words) : NULL;
    if (status || !words) {
        free(copy);
        return status ? status : rt_report(session, "E0602", "out of memory reading options", NULL);
    }
    words[0] = (char *)"rtlang";
    int count = 1 + provenance_split(copy, words + 1);
    if (povray_is_meant(count, words)) {
        *result = povray_parse(session, (CommandLine){count, words}, povray, options, voice, &status);
    } else {
        *result = options_parse(count, words, options);
    }
    options->rerun_text = copy;
    options->rerun_words = words;
    if (!status && *result == OPTIONS_WRONG) {
        status = rt_report(session, "E0703", options->reading.complaint, NULL);
    }
    return status;
}

OptionsResult share_recall(rt_session *session, Options *options, Povray *povray, Voice *voice, rt_status *status)
{
    Options given = *options;
    OptionsResult result = OPTIONS_GO;
    *options = (Options){0};
    *status = read_command(session, options, &given, povray, voice, &result);
    options->joined = given.joined; // argv's, in a list that is this one's now
    options->joined_count = given.joined_count;
    options->owned_joined = given.scenes;
    given.scenes = NULL;
    options->parts = options->part = 0;
    options->checkpoint = -1.0;
    options->resumes = options->continues = false;
    options->output = given.output ? given.output : options->output;
    options->error_map = given.error_map;
    options->threads = given.threads;
    options->format = given.format;
    options->color = given.color;
    options->quiet = given.quiet;
    options_fini(&given);
    return *status ? OPTIONS_WRONG : result;
}

// ---- --mpi

// What those who start ranks call them in the environment; 0: nobody did.
static int rank_of_environment(void)
{
    static const char *const names[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"};
    int rank = 0;
    for (size_t i = 0; i < RT_COUNT_OF(names); i++) {
        const char *text = getenv(names[i]);
        if (text && option_parse_integer(text, 0, INT_MAX, &rank)) {
            return rank;
        }
    }
    return 0;
}

// Where there are no ranks to be had, that is the same for all, and one of them says so.
rt_status share_begin_ranks(rt_session *session, Options *options, Voice *voice)
{
    voice->rank = rank_of_environment();
    voice_hold(voice);
    rt_status status = rt_join_ranks(session, &options->rank, &options->ranks);
    voice_release(voice, false);
    if (status) {
        return status;
    }
    voice->rank = options->rank;
    if (options->rank > 0) {
        options->quiet = true;
        for (int i = 0; i < VOICE_STREAMS; i++) {
            voice->is_mute[i] = i != VOICE_FATAL;
        }
    }
    options->frames.first += options->rank * options->frames.step;
    options->frames.step *= options->ranks;
    return RT_OK;
}

rt_status share_end_ranks(rt_session *session, rt_status status)
{
    int rank, ranks;
    rt_status joined = rt_join_ranks(session, &rank, &ranks);
    status = joined ? joined : rt_worst_of_ranks(session, status);
    rt_leave_ranks(session);
    return status;
}

rt_status share_agree(rt_session *session, const Options *options, Voice *voice, rt_status status)
{
    int first = -1;
    if (!share_has_ranks(options)) {
        return status;
    }
    rt_status agreed = rt_agree_with_ranks(session, status, &first);
    voice_release(voice, status != RT_OK && first != 0);
    return agreed;
}

// ---- the session

char *share_part_name(const Options *options, const char *output)
{
    size_t size = strlen(output) + 64;
    char *name = malloc(size);
    if (name) {
        snprintf(name, size, "%s.part-%d-of-%d", output, options->part, options->parts);
    }
    return name;
}

// Each part has one of its own.
char *share_checkpoint_name(const Options *options, const char *output)
{
    static const char ending[] = ".checkpoint";
    char *name = options->parts > 0 ? share_part_name(options, output) : strdup(output);
    char *longer = name ? realloc(name, strlen(name) + sizeof ending) : NULL;
    if (longer) {
        strcat(longer, ending);
    } else {
        free(name);
    }
    return longer;
}

rt_status share_set(rt_session *session, const Options *options, const char *output)
{
    bool keeps = share_keeps(options);
    if (share_has_ranks(options) && options->rank > 0) {
        return RT_OK; // rank 0 keeps what is done
    }
    if (!keeps && options->parts == 0 && options->joined_count == 0) {
        return RT_OK;
    }
    char *checkpoint = keeps ? share_checkpoint_name(options, output) : NULL;
    rt_sharing sharing = {.part = options->part,
                          .parts = options->parts,
                          .checkpoint = checkpoint,
                          .seconds = keeps ? options->checkpoint : 0.0,
                          .resume = options->resumes,
                          .joined = options->joined,
                          .joined_count = (size_t)options->joined_count,
                          .command = options->command};
    rt_status status =
        keeps && !checkpoint ? rt_report(session, "E0602", "out of memory", NULL) : rt_set_sharing(session, &sharing);
    free(checkpoint);
    return status;
}

void share_done(const Options *options, const char *output)
{
    char *checkpoint = share_keeps(options) ? share_checkpoint_name(options, output) : NULL;
    if (checkpoint) {
        (void)remove(checkpoint);
    }
    free(checkpoint);
}
