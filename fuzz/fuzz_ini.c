// Any bytes are a file of POV-Ray's options, and after a NUL a word of a command line each, that are read or refused;
// what was read is written as a file that says the same.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "cli/povray_read.h"
#include "fuzz/fuzz.h"

enum { WORDS_MOST = 8, PATH_BYTES = 128 };

static char folder[PATH_BYTES];

static void leave(void)
{
    rmdir(folder);
}

// A folder for files with the ending that those of options have.
static bool has_folder(void)
{
    if (!folder[0]) {
        const char *temporary = getenv("TMPDIR");
        snprintf(folder, sizeof folder, "%.80s/rtlang-fuzz-XXXXXX", temporary ? temporary : "/tmp");
        if (!mkdtemp(folder)) {
            folder[0] = '\0';
            return false;
        }
        setenv("POVINI", "/dev/null", 1); // none of the machine's
        (void)atexit(leave);
    }
    return true;
}

// Reads bytes as a file, then words; true when all was right.
static bool read_options(PovraySettings *settings, const char *text, size_t size, char **words, size_t count)
{
    char path[PATH_BYTES + 16], *all[WORDS_MOST + 1] = {path};
    snprintf(path, sizeof path, "%s/fuzz.ini", folder);
    rt_session *session = rt_session_new(NULL);
    FILE *file = fopen(path, "we");
    bool is_written = file && fwrite(text, 1, size, file) == size;
    is_written = file && fclose(file) == 0 && is_written;
    for (size_t i = 0; i < count; i++) {
        all[i + 1] = words[i];
    }
    bool is_fine = session && is_written && povray_read(session, settings, all, count + 1) == RT_OK;
    rt_session_free(session);
    unlink(path);
    return is_fine;
}

// The file that says the settings again, to be freed.
static char *written(const PovraySettings *settings, size_t *length)
{
    char path[FUZZ_PATH], *text = NULL;
    int fd = fuzz_file(NULL, 0, path);
    off_t size = fd >= 0 && povray_write_ini(settings, path) ? lseek(fd, 0, SEEK_END) : -1;
    if (size >= 0) {
        text = calloc((size_t)size + 1, 1);
        FUZZ_HOLDS(text && pread(fd, text, (size_t)size, 0) == size);
        *length = (size_t)size;
    }
    if (fd >= 0) {
        close(fd);
    }
    return text;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *copy = malloc(size + 1), *words[WORDS_MOST];
    size_t count = 0, first = 0, again = 0;
    PovraySettings settings, other;
    if (!copy || !has_folder()) {
        free(copy);
        return 0;
    }
    memcpy(copy, data, size);
    copy[size] = '\0';
    for (size_t at = strlen(copy) + 1; at < size && count < WORDS_MOST; at += strlen(copy + at) + 1) {
        words[count++] = copy + at;
    }
    povray_settings_init(&settings);
    if (read_options(&settings, copy, strlen(copy), words, count)) {
        povray_settings_init(&other);
        char *once = written(&settings, &first);
        FUZZ_HOLDS(!once || read_options(&other, once, first, NULL, 0)); // there are words that no file can say
        char *twice = once ? written(&other, &again) : NULL;
        FUZZ_HOLDS(!once || (twice && first == again && memcmp(once, twice, first) == 0));
        free(once);
        free(twice);
        povray_settings_fini(&other);
    }
    povray_settings_fini(&settings);
    free(copy);
    return 0;
}
