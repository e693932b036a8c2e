// Words of eight bytes are added as eight sums that stand side by side, and so are those sums after each word.
//
// SPDX-License-Identifier: MIT
#include "image/adler.h"

#include <endian.h>
#include <string.h>

enum {
    BASE = 65521, // the greatest prime below 2^16
    WORD = 8,
    WORDS_MOST = 22, // whose sums of sums of bytes, 255 n (n + 1) / 2, stay below 2^16
};

typedef struct Adler {
    uint64_t sum, sums; // of bytes, and of `sum` after each of them; not reduced
} Adler;

static void add_byte(Adler *adler, unsigned char byte)
{
    adler->sum += byte;
    adler->sums += adler->sum;
}

// With n words, byte l of word j is in n * 8 - (j * 8 + l) of the sums: eight times in those after each word from its
// own on, and l times too often.
static void add_words(Adler *adler, const unsigned char *bytes, unsigned words)
{
    const uint64_t every_other = UINT64_C(0x00ff00ff00ff00ff);
    uint64_t sum[2] = {0}, sums[2] = {0}; // of bytes at even places, and odd; four lanes each
    for (unsigned j = 0; j < words; j++) {
        uint64_t word;
        memcpy(&word, bytes + WORD * j, sizeof word);
        word = le64toh(word);
        sum[0] += word & every_other;
        sum[1] += word >> 8 & every_other;
        sums[0] += sum[0];
        sums[1] += sum[1];
    }
    adler->sums += WORD * (uint64_t)words * adler->sum;
    for (unsigned l = 0; l < WORD; l++) {
        uint64_t own = sum[l % 2] >> (16 * (l / 2)) & 0xffff;
        adler->sum += own;
        adler->sums += WORD * (sums[l % 2] >> (16 * (l / 2)) & 0xffff) - l * own;
    }
}

uint32_t adler_of(const unsigned char *bytes, size_t size)
{
    Adler adler = {1, 0};
    for (unsigned words; size >= WORD; bytes += WORD * words, size -= WORD * words) {
        words = size / WORD < WORDS_MOST ? (unsigned)(size / WORD) : WORDS_MOST;
        add_words(&adler, bytes, words);
        adler = (Adler){adler.sum % BASE, adler.sums % BASE};
    }
    for (; size > 0; bytes++, size--) {
        add_byte(&adler, *bytes);
    }
    return (uint32_t)(adler.sums % BASE << 16 | adler.sum % BASE);
}
