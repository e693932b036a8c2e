// Runs that are shared by several processes, or stopped and continued: --part, --join, --checkpoint and --resume.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_SHARE_H
#define CLI_SHARE_H

#include "cli/options.h"
#include "cli/povray.h"
#include "cli/voice.h"

// The words of the command line as text, for share_recall; to be freed, NULL when out of memory.
char *share_command(int argc, char **argv);

// Refuses options that cannot be combined, once all are read, and takes the files of --join out of the scenes.
// OPTIONS_GO or OPTIONS_WRONG, with the complaint in options->reading.
OptionsResult share_settle(Options *options);

// --join: reads the options anew from the command that the first part has, with the output of those given. *status is
// not RT_OK where that part cannot be read, which is reported.
OptionsResult share_recall(rt_session *session, Options *options, Povray *povray, Voice *voice, rt_status *status);

// --mpi: this process becomes a rank, of which those above 0 are silent unless they fail alone; frames are dealt.
rt_status share_begin_ranks(rt_session *session, Options *options, Voice *voice);
// Ends it, after all runs: the worst status of all ranks.
rt_status share_end_ranks(rt_session *session, rt_status status);

// Whether ranks work on one picture.
static inline bool share_has_ranks(const Options *options)
{
    return options->ranks > 0 && options->frames.step == 0;
}
// Of such a picture, when the scene is loaded or could not be: what all do.
rt_status share_agree(rt_session *session, const Options *options, Voice *voice, rt_status status);

// Sets what the session shares of the picture that goes to `output`: nothing for most runs. RT_OK, or what is reported.
rt_status share_set(rt_session *session, const Options *options, const char *output);

// The names of the files that stand next to a picture: that of the part, and the checkpoint. To be freed; NULL when out
// of memory.
char *share_part_name(const Options *options, const char *output);
char *share_checkpoint_name(const Options *options, const char *output);

static inline bool share_keeps(const Options *options)
{
    return options->checkpoint >= 0.0;
}

// When the picture is written: nothing is to be continued.
void share_done(const Options *options, const char *output);

#endif
