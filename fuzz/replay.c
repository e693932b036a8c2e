// Gives a fuzz target the files named on the command line without a fuzzer: each as it is, then FUZZ_MUTATIONS times
// with bytes changed by a fixed sequence and cut short. Prints TAP.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "fuzz/fuzz.h"
#include "unit/tap.h"

typedef struct Text {
    uint8_t *bytes;
    size_t size;
} Text;

static Text read_file(const char *path)
{
    Text text = {NULL, 0};
    FILE *file = fopen(path, "rb");
    if (!file) {
        return text;
    }
    enum { LIMIT = 1 << 20 };
    text.bytes = malloc(LIMIT);
    text.size = text.bytes ? fread(text.bytes, 1, LIMIT, file) : 0;
    fclose(file);
    return text;
}

// SplitMix64 (Steele, Lea, Flood 2014): the same sequence everywhere.
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

// Changes a few bytes: to those that mean most to the language, or by moving a piece over another.
static void mutate(Text *text, uint64_t *state)
{
    static const char bytes[] = "{}()<>[],;#\"/*.-+0e9x\n\0\xff";
    for (uint64_t edits = 1 + next_random(state) % 4; edits > 0; edits--) {
        size_t at = next_random(state) % text->size;
        size_t from = next_random(state) % text->size;
        size_t length = next_random(state) % 12;
        if (next_random(state) % 2) {
            text->bytes[at] = (uint8_t)bytes[next_random(state) % (sizeof bytes - 1)];
        } else if (at + length <= text->size && from + length <= text->size) {
            memmove(text->bytes + at, text->bytes + from, length);
        }
    }
}

static void replay(const char *path, int mutations)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    Text original = read_file(path);
    Text copy = {malloc(original.size + 1), original.size};
    uint64_t state = original.size;
    if (!original.bytes || !copy.bytes) {
        tap_ok(false, "%s can be read", path);
    } else {
        LLVMFuzzerTestOneInput(original.bytes, original.size);
        for (int i = 0; i < mutations && original.size > 0; i++) {
            memcpy(copy.bytes, original.bytes, original.size);
            mutate(&copy, &state);
            LLVMFuzzerTestOneInput(copy.bytes, copy.size);
            LLVMFuzzerTestOneInput(original.bytes, next_random(&state) % original.size);
        }
        tap_ok(true, "%s: %d bytes, %d times changed and cut", name, (int)original.size, mutations);
    }
    free(original.bytes);
    free(copy.bytes);
}

int main(int argc, char **argv)
{
    const char *mutations = getenv("FUZZ_MUTATIONS");
    for (int i = 1; i < argc; i++) {
        replay(argv[i], mutations ? atoi(mutations) : 0);
    }
    return tap_done();
}
