// rtlang: reads a scene, traces it and writes a picture. A client of include/rtlang/rtlang.h and nothing else.
//
// SPDX-License-Identifier: MIT
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cli/options.h"
#include "cli/povray.h"
#include "cli/provenance.h"
#include "cli/run.h"
#include "cli/share.h"
#include "cli/summary.h"
#include "cli/voice.h"
#include "rtlang/rtlang.h"

enum { OUTPUT_BUFFER = 1 << 16 }; // more than --help says

// What an interrupt stops, and which one it was; at file scope, because a signal handler has no other way to them.
static rt_session *volatile interrupted_session;
static volatile sig_atomic_t interrupted_by;

// The timer's signals continue, should one come before the call that it is to end.
static void on_interrupt(int signal_number)
{
    interrupted_by = interrupted_by ? interrupted_by : signal_number;
    if (interrupted_session) {
        rt_cancel(interrupted_session);
    }
}

// Without SA_RESTART, so that waiting for a pipe ends; a second signal ends the program at once, as without a handler.
// A file that `ulimit -f` forbids is an error of writing, which is reported, instead of a signal.
static void hear_signals(void)
{
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    signal(SIGXFSZ, SIG_IGN);
}

static void begin_timer(double seconds)
{
    struct sigaction action = {.sa_handler = on_interrupt};
    struct timeval first = {(time_t)seconds, (suseconds_t)((seconds - (double)(time_t)seconds) * 1e6)};
    struct itimerval timer = {.it_interval = {.tv_usec = 100000}, .it_value = first};
    sigaction(SIGALRM, &action, NULL);
    setitimer(ITIMER_REAL, &timer, NULL);
}

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    VoiceStream stream = diagnostic->severity == RT_ERROR ? VOICE_FATAL : VOICE_WARNING;
    voice_say(client, stream, diagnostic->text, strlen(diagnostic->text));
}

// What #render and #statistics say goes where #debug's goes, as in POV-Ray 3.7.
static void on_message(void *client, rt_stream stream, const char *text, size_t length)
{
    (void)stream;
    voice_say(client, VOICE_DEBUG, text, length);
}

// What a run is at that is sampled; the session is the one that is running.
static void on_progress(void *client, double done)
{
    Progress *progress = &((Voice *)client)->progress;
    char note[160] = "";
    rt_error error;
    if (!progress->enabled) {
        return;
    }
    rt_get_error(interrupted_session, &error);
    if (error.known && error.bias > error.high) {
        snprintf(note, sizeof note, "error %.2g at %.3g rays a pixel; more will not help: %s cuts rays", error.rmse,
                 error.samples, summary_bias_cause(&error));
    } else if (error.known) {
        snprintf(note, sizeof note, "error %.2g at %.3g rays a pixel", error.rmse, error.samples);
    }
    progress_update(progress, done, error.seconds_left, note);
}

// A session that signals interrupt; NULL when out of memory, which is reported.
static rt_session *open_session(const Options *options, Voice *voice)
{
    rt_callbacks callbacks = {voice, on_diagnostic, on_message, on_progress};
    rt_session *session = rt_session_new(&callbacks);
    if (!session) {
        fputs("rtlang: error[E0602]: out of memory\n", stderr);
        return NULL;
    }
    bool is_colored = options->format == RT_FORMAT_TEXT && color_is_on(options->color);
    rt_set_format(session, is_colored ? RT_FORMAT_COLOR : options->format);
    interrupted_session = session;
    return session;
}

// NULL: there is none.
static void close_session(rt_session *session)
{
    interrupted_session = NULL;
    rt_session_free(session);
}

// Whether a picture was written of a run that did not end well: of one that was interrupted, but not by its time.
static bool is_picture_left(rt_session *session, const Options *options, rt_status status)
{
    int width, height;
    bool is_late = status == RT_CANCELLED && interrupted_by == SIGALRM;
    return session && !is_late && !share_keeps(options) && rt_pixels(session, &width, &height) != NULL;
}

// One scene, in a session of its own. *wrote: a picture was written, of a run that was interrupted, too.
static rt_status run_one(Options *options, Voice *voice, bool *wrote)
{
    rt_session *session = open_session(options, voice);
    if (!session) {
        return RT_FAULT_LIMIT;
    }
    options->encoding.continues = *wrote;
    rt_status status = interrupted_by ? RT_CANCELLED : run(session, options, voice);
    *wrote = is_picture_left(session, options, status) || *wrote;
    close_session(session);
    return status;
}

// The frames of a scene. While one differs from the one before it by camera and lights alone, the session stays. A
// scene that is wrong in one frame is not tried in the next.
static rt_status run_frames(Options *options, Voice *voice, bool *wrote)
{
    const Frames *frames = &options->frames;
    FrameCounts counts = {0};
    rt_session *session = NULL;
    rt_status status = RT_OK;
    options->keeps_scene = frames->last - frames->first >= frames->step;
    for (options->frame = frames->first; !status && options->frame <= frames->last; options->frame += frames->step) {
        bool is_drawn = false;
        progress_share(&voice->progress, (options->frame - frames->first) / frames->step,
                       (frames->last - frames->first) / frames->step + 1);
        options->encoding.continues = *wrote;
        if (options->continues && run_has_frame(options)) {
            counts.there++;
            continue;
        }
        if (session && options->keeps_scene && !interrupted_by) {
            status = run_frame(session, options, voice, &is_drawn);
            options->keeps_scene = is_drawn;
        }
        if (!is_drawn && !status) {
            counts.trees += session ? summary_trees(session) : 0;
            close_session(session);
            session = open_session(options, voice);
            status = !session ? RT_FAULT_LIMIT : interrupted_by ? RT_CANCELLED : run(session, options, voice);
            counts.reads++;
        }
        counts.drawn += !status;
        *wrote = *wrote || !status || is_picture_left(session, options, status);
    }
    counts.trees += session ? summary_trees(session) : 0;
    close_session(session);
    if (!status && !options->quiet && options->ranks < 2 && options->format == RT_FORMAT_TEXT) {
        summary_print_frames(voice, &counts);
    }
    return status;
}

static rt_status fail_time(const Options *options, Voice *voice, bool wrote)
{
    char message[COMPLAINT_SIZE];
    snprintf(message, sizeof message, "the run takes more than %g seconds; %s", options->max_time,
             wrote ? "not all pictures were written" : "nothing was written");
    rt_session *session = open_session(options, voice);
    if (session) {
        (void)rt_report(session, "E0612", message, "`--max-time` allows more");
    }
    close_session(session);
    return RT_FAULT_LIMIT;
}

// All scenes and all their frames, one after the other. Returns the greatest status; an interrupt ends it, and so does
// the end of the time for all of them.
static rt_status run_all(Options *options, Voice *voice, bool *wrote)
{
    rt_status worst = RT_OK;
    if (options->max_time > 0.0) {
        begin_timer(options->max_time);
    }
    for (int i = 0; i < options->scene_count && worst != RT_CANCELLED; i++) {
        options->scene = options->scenes[i];
        bool is_animated = options->frames.step > 0 && options->action == ACTION_RENDER;
        rt_status status = is_animated ? run_frames(options, voice, wrote) : run_one(options, voice, wrote);
        worst = status > worst ? status : worst;
    }
    return worst == RT_CANCELLED && interrupted_by == SIGALRM ? fail_time(options, voice, *wrote) : worst;
}

// The same on each rank.
static rt_status run_ranks(Options *options, Voice *voice, bool *wrote)
{
    rt_session *session = open_session(options, voice);
    rt_status status = session ? share_begin_ranks(session, options, voice) : RT_FAULT_LIMIT;
    close_session(session);
    if (status) {
        return status;
    }
    status = run_all(options, voice, wrote);
    session = open_session(options, voice);
    status = session ? share_end_ranks(session, status) : RT_FAULT_LIMIT;
    close_session(session);
    return status;
}

static rt_status fail_parse(rt_session *session, const Options *options)
{
    return rt_report(session, "E0703", options->reading.complaint,
                     options->reading.advice[0] ? options->reading.advice : "rtlang --help lists the options");
}

// Reads the command line; OPTIONS_WRONG and OPTIONS_DONE leave what the program returns in *status.
static OptionsResult read_command_line(int argc, char **argv, Options *options, Povray *povray, Voice *voice,
                                       rt_status *status)
{
    bool is_povray = povray_is_meant(argc, argv);
    OptionsResult result = is_povray ? OPTIONS_GO : options_parse(argc, argv, options);
    *status = RT_OK;
    if (!is_povray && result == OPTIONS_GO && !options->rerun && !options->joins) {
        return OPTIONS_GO; // nothing to report, as for most runs
    }
    rt_session *session = open_session(options, voice);
    *status = session ? RT_OK : RT_FAULT_LIMIT;
    if (session && is_povray) {
        result = povray_parse(session, (CommandLine){argc, argv}, povray, options, voice, status);
    } else if (session && result == OPTIONS_NO_MEMORY) {
        *status = rt_report(session, "E0602", "out of memory", NULL);
    } else if (session && result == OPTIONS_WRONG) {
        *status = fail_parse(session, options);
    } else if (session && result == OPTIONS_GO && options->rerun) {
        *status = provenance_recall(session, argc, argv, options);
    }
    if (session && result == OPTIONS_GO && !*status && options->joins) {
        result = share_recall(session, options, povray, voice, status);
    }
    if (session && result == OPTIONS_DONE) {
        *status = run_print(session, "", RT_OK);
    }
    close_session(session);
    return *status ? OPTIONS_WRONG : result;
}

// What POV-Ray returns: 1 for any fault, 2 when it was interrupted.
static int exit_code(rt_status status, const Options *options)
{
    if (options->is_povray) {
        return status == RT_CANCELLED ? 2 : status != RT_OK;
    }
    return status == RT_CANCELLED ? 128 + (interrupted_by ? (int)interrupted_by : SIGTERM) : (int)status;
}

// What is large is fresh memory of the system each time, which can be huge pages at once: where parts of it were used
// before in small pages, the rest would come in such, too, at a fault each.
static void keep_large_apart(void)
{
#ifdef __GLIBC__
    enum { LARGE = 1 << 21 };
    (void)mallopt(M_MMAP_THRESHOLD, LARGE);
#endif
}

int main(int argc, char **argv)
{
    Options options = {0};
    Povray povray = {0};
    Voice voice = {.interrupted_by = &interrupted_by};
    bool wrote = false;
    rt_status status;
    // --help waits there until `print` can say what went wrong. Never freed: it serves to the end of the program.
    char *buffer = malloc(OUTPUT_BUFFER);
    setvbuf(stdout, buffer, buffer ? _IOFBF : _IONBF, OUTPUT_BUFFER);
    keep_large_apart();
    hear_signals();
    if (read_command_line(argc, argv, &options, &povray, &voice, &status) == OPTIONS_GO) {
        bool has_files = options.parts > 0 || share_keeps(&options);
        options.command = has_files ? share_command(argc, argv) : NULL;
        status = options.has_mpi ? run_ranks(&options, &voice, &wrote) : run_all(&options, &voice, &wrote);
    }
    if (status == RT_CANCELLED && options.format == RT_FORMAT_TEXT && options.rank == 0) {
        const char *text = options.has_kept ? "rtlang: interrupted; what was done is kept, and `--resume` continues\n"
                           : wrote          ? "rtlang: interrupted\n"
                                            : "rtlang: interrupted; nothing was written\n";
        voice_say(&voice, VOICE_FATAL, text, strlen(text));
    }
    if (!voice_close(&voice)) {
        fputs("rtlang: error[E0505]: a file of messages could not be written\n", stderr);
        status = status ? status : RT_FAULT_IO;
    }
    int code = exit_code(status, &options);
    povray_fini(&povray);
    options_fini(&options);
    return code;
}
