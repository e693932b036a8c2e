// Text to the places that were chosen for its stream; the bar is wiped before it.
//
// SPDX-License-Identifier: MIT
#include "cli/voice.h"

#include "base/attributes.h"

void voice_say(Voice *voice, VoiceStream stream, const char *text, size_t length)
{
    if (stream == VOICE_WARNING && voice->has_no_warnings) {
        return;
    }
    if (!voice->is_mute[stream]) {
        progress_end(&voice->progress);
        fwrite(text, 1, length, stderr);
    }
    FILE *const files[] = {voice->files[stream], voice->files[VOICE_ALL]};
    for (size_t i = 0; i < RT_COUNT_OF(files); i++) {
        if (files[i]) {
            fwrite(text, 1, length, files[i]);
        }
    }
}

bool voice_close(Voice *voice)
{
    bool fine = true;
    for (int i = 0; i < VOICE_STREAMS; i++) {
        if (voice->files[i]) {
            fine = !ferror(voice->files[i]) && fine;
            fine = fclose(voice->files[i]) == 0 && fine;
        }
        voice->files[i] = NULL;
    }
    return fine;
}
