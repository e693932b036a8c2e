// Text to the places that were chosen for its stream; the bar is wiped before it.
//
// SPDX-License-Identifier: MIT
#include "cli/voice.h"

#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"

static void print(const Voice *voice, const char *text, size_t length)
{
    if (voice->rank > 0) {
        fprintf(stderr, "rank %d: %.*s", voice->rank, (int)length, text);
    } else {
        fwrite(text, 1, length, stderr);
    }
}

void voice_hold(Voice *voice)
{
    voice->is_held = voice->rank > 0;
}

void voice_release(Voice *voice, bool is_said)
{
    if (voice->held && is_said) {
        print(voice, voice->held, strlen(voice->held));
    }
    free(voice->held);
    voice->held = NULL;
    voice->is_held = false;
}

static bool hold(Voice *voice, const char *text, size_t length)
{
    size_t before = voice->held ? strlen(voice->held) : 0;
    char *held = voice->is_held ? realloc(voice->held, before + length + 1) : NULL;
    if (held) {
        memcpy(held + before, text, length);
        held[before + length] = '\0';
        voice->held = held;
    }
    return held != NULL;
}

void voice_say(Voice *voice, VoiceStream stream, const char *text, size_t length)
{
    if (stream == VOICE_WARNING && voice->has_no_warnings) {
        return;
    }
    if (!voice->is_mute[stream] && !(stream == VOICE_FATAL && hold(voice, text, length))) {
        progress_end(&voice->progress);
        print(voice, text, length);
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
